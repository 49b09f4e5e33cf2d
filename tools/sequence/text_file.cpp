#include "tools/sequence/text_file.h"

#include "scenarios/input_file.h"

namespace lcs::sequence {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  // The longest is a table of all frames. Half of a sequence cannot be used.
  constexpr scenario::FileKind kSequenceFile{16 * scenario::kGibibyte,
                                             "generate the sequence again"};
  return scenario::read_file(path, kSequenceFile);
}

}  // namespace lcs::sequence
