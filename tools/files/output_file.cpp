#include "tools/files/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace lcs::bench {

std::string remedy(const std::error_code& error) {
  if (error == std::errc::no_space_on_device || error.value() == EDQUOT) {
    return "make room there, or choose another folder with --out";
  }
  if (error == std::errc::file_too_large) return "raise the limit of a file's size (ulimit -f)";
  if (error == std::errc::too_many_files_open ||
      error == std::errc::too_many_files_open_in_system) {
    return "raise the limit of open files (ulimit -n)";
  }
  if (error == std::errc::broken_pipe) return "let all of it be read, or give --quiet";
  return "choose another folder with --out";
}

/// The first bytes of a plain file; "" for anything else.
std::string beginning(const std::filesystem::path& file, std::size_t bytes) {
  std::string text;
  const int opened = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (opened < 0) return text;
  struct stat status = {};
  if (::fstat(opened, &status) == 0 && S_ISREG(status.st_mode)) {
    text.resize(bytes);
    const ssize_t got = ::read(opened, text.data(), bytes);
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  }
  ::close(opened);
  return text;
}

bool has_sign(const std::filesystem::path& file, std::string_view sign) {
  constexpr std::size_t kReach = 1 << 16;
  return beginning(file, kReach).find(sign) != std::string::npos;
}

OutputFile::OutputFile(const std::filesystem::path& path)
    : path_(path), file_(std::fopen(path.c_str(), "wb")) {
  if (!file_) fail(errno);
}

void OutputFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail(errno);
}

void OutputFile::flush() {
  if (std::fflush(file_.get()) != 0) fail(errno);
}

void OutputFile::close() {
  if (std::fclose(file_.release()) != 0) fail(errno);
}

void OutputFile::fail(int error) const {
  const std::error_code code(error, std::generic_category());
  throw OutputError(
      fmt::format("cannot write {}: {}; {}", path_.string(), code.message(), remedy(code)));
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  OutputFile file(path);
  file.write(bytes);
  file.close();
}

std::filesystem::path finished_name(const std::filesystem::path& unfinished) {
  return unfinished.parent_path() / unfinished.stem().stem();
}

void write_whole(const std::filesystem::path& path,
                 const std::function<void(const std::filesystem::path&)>& write,
                 std::string_view sign) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status there = fs::status(path, error);
  if (fs::exists(there) && !fs::is_regular_file(there)) return write(path);

  if (fs::exists(there) && fs::file_size(path) > 0 && !has_sign(path, sign)) {
    throw OutputError(
        fmt::format("{} holds something else than lcs writes there, which would be lost; choose "
                    "another file, or move it away",
                    path.string()));
  }
  const fs::path target = fs::exists(there) ? fs::canonical(path) : path;
  fs::path beside;
  for (int attempt = 0; beside.empty() || fs::exists(fs::symlink_status(beside)); ++attempt) {
    beside = target;  // under a name that nobody has
    beside += fmt::format(".{}-{}{}", ::getpid(), attempt, kUnfinished);
  }
  try {
    write(beside);
    fs::rename(beside, target, error);
    if (error) {
      throw OutputError(
          fmt::format("cannot write {}: {}; {}", path.string(), error.message(), remedy(error)));
    }
  } catch (...) {
    fs::remove(beside, error);
    throw;
  }
}

void write_whole(const std::filesystem::path& path, std::string_view bytes, std::string_view sign) {
  write_whole(
      path, [&](const std::filesystem::path& beside) { write_file(beside, bytes); }, sign);
}

}  // namespace lcs::bench
