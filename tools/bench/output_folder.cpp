#include "tools/bench/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

namespace lcs::bench {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(std::string_view what, const fs::path& path, const std::error_code& error) {
  throw OutputError(fmt::format("cannot {} {}: {}; choose another folder with --out", what,
                                path.string(), error.message()));
}

/// Absolute, links resolved, without a trailing slash.
fs::path resolved(const fs::path& target) {
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(target), error);
  if (error) fail("use", target, error);
  path = path.lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

constexpr std::string_view kStaging = ".partial-", kOld = ".old-";

fs::path beside(const fs::path& target, std::string_view suffix) {
  fs::path path = target;
  path += fmt::format("{}{}", suffix, ::getpid());
  return path;
}

/// Exchanges two folders, so that there is no moment without either. False where the file system
/// knows of no such thing.
bool exchange(const fs::path& a, const fs::path& b) {
  return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
}

bool name_fits(std::string_view name, std::string_view pattern) {
  if (pattern == "*") return true;
  if (pattern.ends_with('*')) return name.starts_with(pattern.substr(0, pattern.size() - 1));
  if (pattern.starts_with('*')) return name.ends_with(pattern.substr(1));
  return name == pattern;
}

/// A file fits a pattern as a whole, a folder the beginning of one.
bool fits(const fs::path& within, bool is_folder, const fs::path& pattern) {
  auto part = pattern.begin();
  for (const fs::path& name : within) {
    if (part == pattern.end() || !name_fits(name.native(), part->native())) return false;
    ++part;
  }
  return (part != pattern.end()) == is_folder;
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder, bool wait)
    : file_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)) {
  if (file_ < 0) return;
  const int how = wait ? LOCK_EX : LOCK_EX | LOCK_NB;
  int result = ::flock(file_, how);
  while (result != 0 && errno == EINTR) result = ::flock(file_, how);
  is_held_ = result == 0;
}

FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

bool FolderLock::is_of(const fs::path& folder) const {
  struct stat here = {}, there = {};
  return file_ >= 0 && ::fstat(file_, &here) == 0 && ::lstat(folder.c_str(), &there) == 0 &&
         here.st_ino == there.st_ino && here.st_dev == there.st_dev;
}

void remove_abandoned(const fs::path& target) {
  std::error_code ignored;
  const std::string begin = target.filename().string() + std::string(kStaging);
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(target.parent_path(), ignored)) {
    if (entry.path().filename().string().starts_with(begin)) found.push_back(entry.path());
  }
  for (const fs::path& path : found) {
    const FolderLock lock(path, /*wait=*/false);
    if (lock.is_held()) fs::remove_all(path, ignored);
  }
}

OutputFolder::OutputFolder(const fs::path& target, std::vector<std::string> files)
    : files_(std::move(files)), target_(resolved(target)), staging_(beside(target_, kStaging)) {
  require_replaceable();
  make_parents();
  remove_abandoned(target_);
  make_staging();
}

OutputFolder::~OutputFolder() {
  if (committed_) return;
  remove_staging();
  std::error_code ignored;  // there is nobody left to tell
  // `remove` leaves folders that are not empty alone.
  std::for_each(made_parents_.rbegin(), made_parents_.rend(),
                [&](const fs::path& parent) { fs::remove(parent, ignored); });
}

void OutputFolder::require_replaceable() const {
  std::error_code error;
  const fs::file_status status = fs::status(target_, error);
  if (status.type() == fs::file_type::not_found) return;
  if (status.type() == fs::file_type::none) fail("use", target_, error);
  if (status.type() != fs::file_type::directory) {
    throw OutputError(target_.string() + " is not a folder; choose another one with --out");
  }
  bool is_empty = true;
  for (fs::recursive_directory_iterator entry(target_, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    is_empty = false;
    const fs::path within = entry->path().lexically_relative(target_);
    const bool is_folder = entry->symlink_status().type() == fs::file_type::directory;
    if (is_own(within, is_folder)) continue;
    throw OutputError(fmt::format(
        "{} holds {}, which is not a result of an earlier run and would be lost; choose another "
        "folder with --out, or move it away",
        target_.string(), within.string()));
  }
  if (error) fail("read", target_, error);
  if (!is_empty && !fs::exists(target_ / files_.front())) {
    throw OutputError(fmt::format(
        "{} has no {}, so it is not a result of an earlier run, and is not replaced; choose "
        "another folder with --out",
        target_.string(), files_.front()));
  }
}

bool OutputFolder::is_own(const fs::path& within, bool is_folder) const {
  return std::any_of(files_.begin(), files_.end(),
                     [&](const std::string& pattern) { return fits(within, is_folder, pattern); });
}

void OutputFolder::make_parents() {
  std::vector<fs::path> missing;
  for (fs::path parent = target_.parent_path(); !fs::exists(parent);
       parent = parent.parent_path()) {
    missing.push_back(parent);
  }
  std::for_each(missing.rbegin(), missing.rend(), [&](const fs::path& parent) {
    std::error_code error;
    if (fs::create_directory(parent, error)) made_parents_.push_back(parent);
    if (error) fail("create", parent, error);
  });
}

/// Another process may take a folder for abandoned that is not locked yet.
void OutputFolder::make_staging() {
  do {
    std::error_code error;
    fs::create_directory(staging_, error);
    if (error) fail("create", staging_, error);
    lock_.emplace(staging_, /*wait=*/true);
  } while (lock_->is_held() && !lock_->is_of(staging_));
}

void OutputFolder::remove_staging() const {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

void OutputFolder::commit() {
  require_replaceable();  // it may have changed since
  std::error_code error;
  fs::rename(staging_, target_, error);  // where there is nothing, or an empty folder
  if (!error) {
    committed_ = true;
    return;
  }
  const bool is_there = error == std::errc::directory_not_empty || error == std::errc::file_exists;
  if (!is_there) fail("create", target_, error);
  if (exchange(staging_, target_)) {
    remove_staging();  // what was there
  } else {
    const fs::path old = beside(target_, kOld);
    fs::rename(target_, old, error);
    if (error) fail("replace", target_, error);
    fs::rename(staging_, target_, error);
    if (error) {
      std::error_code ignored;
      fs::rename(old, target_, ignored);
      fail("create", target_, error);
    }
    fs::remove_all(old, error);
  }
  committed_ = true;
}

}  // namespace lcs::bench
