#include "scenarios/shipped.h"

#include <system_error>

namespace lcs::scenario {

namespace fs = std::filesystem;

fs::path shipped_folder(const fs::path& name) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = (program.parent_path() / LCS_DATA / name).lexically_normal();
  if (!error && fs::is_directory(installed, error)) return installed;
  return fs::path(LCS_SOURCES) / name;
}

}  // namespace lcs::scenario
