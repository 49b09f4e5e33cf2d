#include "sim/camera/gl_context.h"

#include <GL/osmesa.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "sim/scene/trial.h"

// gcc's and clang's ways to say that AddressSanitizer is on
#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
// Mesa leaks some hundred bytes of each context until the process ends.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa";
}
#endif

namespace lcs::sim {
namespace {

constexpr int kSide = 16;  // px; the smallest size that works everywhere

[[noreturn]] void fail(const char* step) {
  throw std::runtime_error(std::string("software GL does not start: ") + step +
                           " failed; install Mesa's off-screen renderer (Debian: libosmesa6)");
}

/// Mesa ends the program by a signal if it lacks the driver that GALLIUM_DRIVER names.
/// \throws std::runtime_error. Checks at the first context of the process only.
void check_driver() {
  static std::atomic<bool> checked = false;
  const char* driver = std::getenv("GALLIUM_DRIVER");
  if (!driver || checked.exchange(true)) return;
  const Trial trial = try_in_child([] { GlContext context; });
  if (trial.fine) return;
  checked = false;
  const std::string how = trial.crash.empty() ? trial.refused : trial.crash;
  throw std::runtime_error("software GL does not start with GALLIUM_DRIVER=" + std::string(driver) +
                           " (" + how + "); unset it, or set it to llvmpipe or softpipe");
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
  check_driver();
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
