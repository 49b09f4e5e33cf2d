#include "tools/bench/output_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

namespace lcs::bench {

OutputFile::OutputFile(const std::filesystem::path& path)
    : path_(path), file_(std::fopen(path.c_str(), "wb")) {
  if (!file_) fail(errno);
}

void OutputFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail(errno);
}

void OutputFile::close() {
  if (std::fclose(file_.release()) != 0) fail(errno);
}

void OutputFile::fail(int error) const {
  throw OutputError(
      fmt::format("cannot write {}: {}; make room there, or choose another folder with --out",
                  path_.string(), std::generic_category().message(error)));
}

}  // namespace lcs::bench
