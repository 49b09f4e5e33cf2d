#include "sim/gl_context.h"

#include <GL/osmesa.h>

#include <array>
#include <stdexcept>
#include <string_view>

#ifdef __SANITIZE_ADDRESS__
// Mesa keeps some hundred bytes of each context until the process ends.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa";
}
#endif

namespace lcs::sim {
namespace {

constexpr int kSide = 16;  // px; the least that is sure to work

[[noreturn]] void fail(const char* step) {
  throw std::runtime_error(std::string("software GL does not start: ") + step +
                           " failed; install Mesa's off-screen renderer (Debian: libosmesa6)");
}

}  // namespace

struct GlContext::Impl {
  OSMesaContext context = nullptr;
  std::array<unsigned char, kSide * kSide * 4> buffer{};

  ~Impl() {
    if (context) OSMesaDestroyContext(context);
  }
};

GlContext::GlContext() : impl_(std::make_unique<Impl>()) {
  impl_->context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, nullptr);
  if (!impl_->context) fail("OSMesaCreateContextExt");
  make_current();
}

GlContext::~GlContext() = default;

void GlContext::make_current() {
  if (OSMesaGetCurrentContext() == impl_->context) return;
  if (!OSMesaMakeCurrent(impl_->context, impl_->buffer.data(), GL_UNSIGNED_BYTE, kSide, kSide)) {
    fail("OSMesaMakeCurrent");
  }
}

std::string GlContext::renderer() const {
  const auto text = [](GLenum name) {
    const GLubyte* value = glGetString(name);
    return std::string(value ? reinterpret_cast<const char*>(value) : "");
  };
  // "4.5 (Compatibility Profile) Mesa 22.3.6" says which Mesa
  const std::string version = text(GL_VERSION);
  const std::size_t mesa = version.find("Mesa");
  return text(GL_RENDERER) + ", " + (mesa == std::string::npos ? version : version.substr(mesa));
}

}  // namespace lcs::sim
