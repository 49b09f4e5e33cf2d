#include "sim/camera/gl_context.h"

#include <dlfcn.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "sim/base/trial.h"

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

/// A context, and the library that made it. Libraries stay loaded until the process ends.
class GlContext::Library {
 public:
  virtual ~Library() = default;
  virtual void make_current() = 0;
  virtual void* function(const char* name) const = 0;
};

namespace {

[[noreturn]] void fail(const std::string& step) {
  throw std::runtime_error(
      "off-screen GL does not start: " + step +
      " failed; install Mesa's software renderer (Debian: libosmesa6, or libegl1 and LCS_GL=egl)");
}

/// The first library of these names; nullptr if none is installed.
void* load(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    // global, as MuJoCo looks for the library of the current context among all symbols
    if (void* library = ::dlopen(name, RTLD_NOW | RTLD_GLOBAL)) return library;
  }
  return nullptr;
}

/// A function of a loaded library, from the first symbol of all, as a linker would take.
template <typename Function>
Function* symbol(const char* name) {
  void* found = ::dlsym(RTLD_DEFAULT, name);
  if (!found) fail(name);
  return reinterpret_cast<Function*>(found);
}

void* load_osmesa() {
  return load({"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"});
}

/// Signatures and constants as in GL/osmesa.h, which newer systems lack.
class Osmesa : public GlContext::Library {
 public:
  Osmesa() {
    if (!load_osmesa()) fail("loading libOSMesa.so.8");
    constexpr unsigned kRgba = 0x1908;
    constexpr int kDepthBits = 24, kStencilBits = 8;
    context_ = symbol<void*(unsigned, int, int, int, void*)>("OSMesaCreateContextExt")(
        kRgba, kDepthBits, kStencilBits, 0, nullptr);
    if (!context_) fail("OSMesaCreateContextExt");
  }
  ~Osmesa() override { symbol<void(void*)>("OSMesaDestroyContext")(context_); }

  void make_current() override {
    if (symbol<void*()>("OSMesaGetCurrentContext")() == context_) return;
    constexpr unsigned kUnsignedByte = 0x1401;
    const auto make = symbol<unsigned char(void*, void*, unsigned, int, int)>("OSMesaMakeCurrent");
    if (!make(context_, buffer_.data(), kUnsignedByte, kSide, kSide)) fail("OSMesaMakeCurrent");
  }
  void* function(const char* name) const override {
    return symbol<void*(const char*)>("OSMesaGetProcAddress")(name);
  }

 private:
  static constexpr int kSide = 16;  // px; the smallest size that works everywhere
  void* context_ = nullptr;
  std::array<unsigned char, kSide * kSide * 4> buffer_{};
};

/// Signatures and constants as in EGL/egl.h and EGL/eglext.h. A context without a surface.
class Egl : public GlContext::Library {
 public:
  explicit Egl(bool is_software) {
    if (is_software) ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    if (!load({"libEGL.so.1"})) fail("loading libEGL.so.1");
    constexpr unsigned kSurfaceless = 0x31DD, kDevice = 0x313F, kOpengl = 0x30A2;
    void* const device = is_software ? nullptr : graphics_card();
    const auto display_of =
        extension<void*(unsigned, void*, const int*)>("eglGetPlatformDisplayEXT");
    display_ = display_of(is_software ? kSurfaceless : kDevice, device, nullptr);
    if (!display_ ||
        !symbol<unsigned(void*, int*, int*)>("eglInitialize")(display_, nullptr, nullptr)) {
      fail("eglInitialize");
    }
    constexpr int kNone = 0x3038;
    if (symbol<unsigned(unsigned)>("eglBindAPI")(kOpengl)) {
      context_ = symbol<void*(void*, void*, void*, const int*)>("eglCreateContext")(
          display_, nullptr, nullptr, &kNone);
    }
    if (!context_) fail("eglCreateContext");
  }
  ~Egl() override {
    if (symbol<void*()>("eglGetCurrentContext")() == context_) {
      symbol<unsigned(void*, void*, void*, void*)>("eglMakeCurrent")(display_, nullptr, nullptr,
                                                                     nullptr);
    }
    symbol<unsigned(void*, void*)>("eglDestroyContext")(display_, context_);
  }

  void make_current() override {
    if (symbol<void*()>("eglGetCurrentContext")() == context_) return;
    const auto make = symbol<unsigned(void*, void*, void*, void*)>("eglMakeCurrent");
    if (!make(display_, nullptr, nullptr, context_)) fail("eglMakeCurrent");
  }
  void* function(const char* name) const override {
    return symbol<void*(const char*)>("eglGetProcAddress")(name);
  }

 private:
  /// The first device that is no software.
  void* graphics_card() const {
    std::array<void*, 16> devices{};
    int count = 0;
    extension<unsigned(int, void**, int*)>("eglQueryDevicesEXT")(static_cast<int>(devices.size()),
                                                                 devices.data(), &count);
    const auto text = extension<const char*(void*, int)>("eglQueryDeviceStringEXT");
    constexpr int kExtensions = 0x3055;
    for (int i = 0; i < count; ++i) {
      const char* extensions = text(devices[static_cast<std::size_t>(i)], kExtensions);
      const std::string_view words = extensions ? extensions : "";
      if (words.find("EGL_MESA_device_software") == words.npos) {
        return devices[static_cast<std::size_t>(i)];
      }
    }
    throw std::runtime_error(
        "LCS_GL is gpu, and EGL finds no graphics card; set it to osmesa or egl");
  }

  template <typename Function>
  Function* extension(const char* name) const {
    void* found = function(name);
    if (!found) fail(name);
    return reinterpret_cast<Function*>(found);
  }

  void* display_ = nullptr;
  void* context_ = nullptr;
};

std::unique_ptr<GlContext::Library> chosen_library() {
  const char* named = std::getenv("LCS_GL");
  const std::string_view choice = named ? named : load_osmesa() ? "osmesa" : "egl";
  if (choice == "osmesa") return std::make_unique<Osmesa>();
  if (choice == "egl" || choice == "gpu") return std::make_unique<Egl>(choice == "egl");
  throw std::runtime_error("LCS_GL is '" + std::string(choice) + "'; set it to osmesa, egl or gpu");
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
  throw std::runtime_error(
      "off-screen GL does not start with GALLIUM_DRIVER=" + std::string(driver) + " (" + how +
      "); unset it, or set it to llvmpipe or softpipe");
}

}  // namespace

GlContext::GlContext() {
  check_driver();
  library_ = chosen_library();
  make_current();
}

GlContext::~GlContext() = default;

void GlContext::make_current() {
  library_->make_current();
}

void* GlContext::address(const char* name) const {
  void* found = library_->function(name);
  if (!found) fail(name);
  return found;
}

std::string GlContext::renderer() const {
  auto* const get = function<const unsigned char*(unsigned)>("glGetString");
  const auto text = [&](unsigned name) {
    const unsigned char* value = get(name);
    return std::string(value ? reinterpret_cast<const char*>(value) : "");
  };
  constexpr unsigned kRenderer = 0x1F01, kVersion = 0x1F02;
  // "4.5 (Compatibility Profile) Mesa 22.3.6" says which Mesa
  const std::string version = text(kVersion);
  const std::size_t mesa = version.find("Mesa");
  return text(kRenderer) + ", " + (mesa == std::string::npos ? version : version.substr(mesa));
}

}  // namespace lcs::sim
