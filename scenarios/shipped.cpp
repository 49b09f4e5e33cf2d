#include "scenarios/shipped.h"

#include <system_error>
#include <utility>

namespace lcs::scenario {

namespace fs = std::filesystem;

namespace {

fs::path& program_file() {
  static fs::path file = "/proc/self/exe";  // also after a rebuild
  return file;
}

}  // namespace

const fs::path& program() {
  return program_file();
}

void set_program(fs::path file) {
  program_file() = std::move(file);
}

fs::path shipped_folder(const fs::path& name) {
  std::error_code error;
  const fs::path file = fs::canonical(program(), error);
  const fs::path installed = (file.parent_path() / LCS_DATA / name).lexically_normal();
  if (!error && fs::is_directory(installed, error)) return installed;
  return fs::path(LCS_SOURCES) / name;
}

}  // namespace lcs::scenario
