#include "tools/sequence/text_file.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "tools/bench/output_file.h"

namespace lcs::sequence {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file || !fs::is_regular_file(path)) {
    throw std::runtime_error(fmt::format("cannot read {}", path.string()));
  }
  return bytes;
}

void write_file(const fs::path& path, std::string_view bytes) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);  // what fails here fails again in a moment
  bench::write_whole(path, [&](const fs::path& beside) {
    bench::OutputFile file(beside);
    file.write(bytes);
    file.close();
  });
}

}  // namespace lcs::sequence
