#include "sim/pictures/media.h"

#include <dlfcn.h>

#include <stdexcept>

namespace lcs::sim {
namespace {

/// \return a variable of a library in the program's run path (`CMAKE_BUILD_RPATH`,
/// `INSTALL_RPATH`).
const void* variable(const char* library, const char* name) {
  void* const handle = ::dlopen(library, RTLD_NOW | RTLD_LOCAL);
  const void* const found = handle != nullptr ? ::dlsym(handle, name) : nullptr;
  if (found != nullptr) return found;
  throw std::runtime_error(std::string("cannot load ") + ::dlerror() +
                           "; install this program anew, with all of its files");
}

}  // namespace

const Media& media() {
  static const auto& loaded =
      *static_cast<const Media*>(variable("liblcs_media.so", "lcs_media_functions"));
  return loaded;
}

const Windows& windows() {
  static const auto& loaded =
      *static_cast<const Windows*>(variable("liblcs_windows.so", "lcs_windows_functions"));
  return loaded;
}

const OpticalFlow& optical_flow() {
  static const auto& loaded =
      *static_cast<const OpticalFlow*>(variable("liblcs_flow.so", "lcs_flow_functions"));
  return loaded;
}

}  // namespace lcs::sim
