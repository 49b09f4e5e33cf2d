/// \file
/// An off-screen GL context that MuJoCo renders with, without a display.
///
/// The environment's LCS_GL chooses the library, which is loaded at the first context:
///   osmesa  Mesa's software renderer, by OSMesa; the default where it is installed
///   egl     the same renderer, by EGL without a surface: the same bits; the default elsewhere
///   gpu     the first graphics card that EGL offers; its bits are not promised
#pragma once

#include <memory>
#include <string>

namespace lcs::sim {

/// Current in the constructing thread from construction on. MuJoCo renders into its own frame
/// buffer object.
class GlContext {
 public:
  /// \throws std::runtime_error with a remedy.
  GlContext();
  ~GlContext();

  /// Makes the context current again, after another context was. \throws std::runtime_error
  void make_current();

  /// For example "llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6".
  std::string renderer() const;

  /// A function of GL. \throws std::runtime_error if missing.
  void* address(const char* name) const;
  /// The same with its type: `function<void(unsigned)>("glEnable")`.
  template <class Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(address(name));
  }

  class Library;  ///< of one kind of context

 private:
  std::unique_ptr<Library> library_;
};

}  // namespace lcs::sim
