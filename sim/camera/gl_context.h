/// \file
/// An OSMesa context: the software GL that MuJoCo renders with, without a display.
#pragma once

#include <memory>
#include <string>

namespace lcs::sim {

/// Current in the constructing thread from construction on. Its own buffer is tiny, because MuJoCo
/// renders into its own frame buffer object.
class GlContext {
 public:
  /// \throws std::runtime_error with a remedy.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Makes the context current again, after another context was. \throws std::runtime_error
  void make_current();

  /// For example "llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6".
  std::string renderer() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lcs::sim
