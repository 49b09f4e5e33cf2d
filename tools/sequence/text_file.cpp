#include "tools/sequence/text_file.h"

#include <system_error>

#include "scenarios/input_file.h"
#include "tools/files/output_file.h"

namespace lcs::sequence {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  // The longest is a table of all frames. Half of a sequence cannot be used.
  constexpr scenario::FileKind kSequenceFile{16 * scenario::kGibibyte,
                                             "generate the sequence again"};
  return scenario::read_file(path, kSequenceFile);
}

void write_file(const fs::path& path, std::string_view bytes) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);  // what fails here fails again in a moment
  bench::write_whole(path, bytes);
}

}  // namespace lcs::sequence
