#include "sim/pictures/media.h"

#include <dlfcn.h>

#include <stdexcept>

namespace lcs::sim {
namespace {

/// The functions in a variable of a library in the program's run path (`CMAKE_BUILD_RPATH`,
/// `INSTALL_RPATH`).
template <class Functions>
const Functions& loaded(const char* library, const char* name) {
  void* const handle = ::dlopen(library, RTLD_NOW | RTLD_LOCAL);
  const void* const found = handle != nullptr ? ::dlsym(handle, name) : nullptr;
  if (found != nullptr) return *static_cast<const Functions*>(found);
  throw std::runtime_error(std::string("cannot load ") + ::dlerror() +
                           "; install this program anew, with all of its files");
}

}  // namespace

const Media& media() {
  static const auto& all = loaded<Media>("liblcs_media.so", "lcs_media_functions");
  return all;
}

const Windows& windows() {
  static const auto& all = loaded<Windows>("liblcs_windows.so", "lcs_windows_functions");
  return all;
}

const OpticalFlow& optical_flow() {
  static const auto& all = loaded<OpticalFlow>("liblcs_flow.so", "lcs_flow_functions");
  return all;
}

}  // namespace lcs::sim
