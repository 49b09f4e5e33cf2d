#include "tools/bench/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

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

void write_whole(const std::filesystem::path& path,
                 const std::function<void(const std::filesystem::path&)>& write) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status there = fs::status(path, error);
  if (fs::exists(there) && !fs::is_regular_file(there)) return write(path);

  fs::path beside = fs::exists(there) ? fs::canonical(path) : path;
  const fs::path target = beside;
  beside += fmt::format(".{}.partial", ::getpid());
  try {
    write(beside);
    fs::rename(beside, target, error);
    if (error)
      throw OutputError(fmt::format("cannot write {}: {}", path.string(), error.message()));
  } catch (...) {
    fs::remove(beside, error);
    throw;
  }
}

}  // namespace lcs::bench
