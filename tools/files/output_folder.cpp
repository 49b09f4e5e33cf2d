#include "tools/files/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <string_view>
#include <system_error>

namespace lcs::bench {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(std::string_view what, const fs::path& path, const std::error_code& error) {
  throw OutputError(
      fmt::format("cannot {} {}: {}; {}", what, path.string(), error.message(), remedy(error)));
}

/// Absolute, links resolved, without a trailing slash.
fs::path resolved(const fs::path& target) {
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(target), error);
  if (error) fail("use", target, error);
  path = path.lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

/// Beside a target there may be `TARGET.partial-PROCESS/`, with the marker, and with one folder for
/// the result on its way in and one for the result on its way out.
constexpr std::string_view kPartial = ".partial-";
constexpr std::string_view kMarker = ".lcs-partial", kIn = "in", kOut = "out";

std::string marker_text(std::string_view folder_name) {
  return fmt::format("lcs writes its results here, and takes this folder away: {}\n", folder_name);
}

/// Whether a process of this program made the folder. It may live.
bool has_marker(const fs::path& folder) {
  const std::string text = marker_text(folder.filename().string());
  return beginning(folder / kMarker, text.size() + 1) == text;
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

bool is_of_result(const fs::path& within, const fs::directory_entry& entry,
                  const ResultFiles& files) {
  const fs::file_type type = entry.symlink_status().type();
  const bool is_folder = type == fs::file_type::directory;
  if (!is_folder && type != fs::file_type::regular) return false;
  return std::any_of(files.names.begin(), files.names.end(),
                     [&](const std::string& name) { return fits(within, is_folder, name); });
}

/// Whether this program put an entry into its folder beside a target. A suite has such folders of
/// its runs inside: `in/runs/NAME/seed-1.partial-PROCESS/in/metrics.json`.
bool is_of_staging(const fs::path& within, const fs::directory_entry& entry,
                   const ResultFiles& files) {
  fs::path of_result;
  bool is_beside = true;  // right in a folder beside a target
  for (const fs::path& name : within) {
    if (is_beside && name == kMarker)
      return entry.symlink_status().type() == fs::file_type::regular;
    if (!is_beside || (name != kIn && name != kOut)) of_result /= name;
    is_beside = name.native().find(kPartial) != std::string::npos;
  }
  if (of_result.empty()) return entry.symlink_status().type() == fs::file_type::directory;
  if (of_result.extension() == kUnfinished) of_result = finished_name(of_result);
  return is_of_result(of_result, entry, files);
}

/// Of a folder beside a target takes away what this program put there; then, if that was all, the
/// folder.
void remove_own(const fs::path& folder, const ResultFiles& files) {
  std::error_code ignored;  // what cannot be taken away stays
  std::vector<fs::path> own{folder};
  // One folder at a time is open: there may be no more descriptors than that.
  for (std::size_t i = 0; i < own.size(); ++i) {
    for (fs::directory_iterator entry(own[i], ignored), end; entry != end;
         entry.increment(ignored)) {
      const fs::path within = entry->path().lexically_relative(folder);
      if (within != kMarker && is_of_staging(within, *entry, files)) own.push_back(entry->path());
    }
  }
  // What is in a folder comes after it. The marker goes last.
  for (std::size_t i = own.size(); i-- > 1;) fs::remove(own[i], ignored);
  fs::remove(folder / kMarker, ignored);
  fs::remove(folder, ignored);
}

/// Exchanges two folders, so that there is no moment without either. False where the file system
/// knows of no such thing.
bool exchange(const fs::path& a, const fs::path& b) {
  return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
}

void rename_or_fail(std::string_view what, const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) fail(what, to, error);
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder)
    : file_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)) {
  is_held_ = file_ >= 0 && ::flock(file_, LOCK_EX | LOCK_NB) == 0;
  is_of_another_ = file_ >= 0 && !is_held_ && errno == EWOULDBLOCK;
}

FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

void remove_abandoned(const fs::path& target, const ResultFiles& files) {
  std::error_code ignored;
  const std::string begin = target.filename().string() + std::string(kPartial);
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(target.parent_path(), ignored), end; entry != end;
       entry.increment(ignored)) {
    if (entry->path().filename().string().starts_with(begin)) found.push_back(entry->path());
  }
  for (const fs::path& path : found) {
    const FolderLock lock(path);  // its process holds it from before it writes the marker
    if (!lock.is_held() || !has_marker(path)) continue;
    if (!fs::exists(target)) fs::rename(path / kOut, target, ignored);
    remove_own(path, files);
  }
}

OutputFolder::OutputFolder(const fs::path& target, ResultFiles files)
    : files_(std::move(files)), target_(resolved(target)) {
  require_replaceable(target_);
  make_parents();
  remove_abandoned(target_, files_);
  try {
    make_staging();
  } catch (const OutputError&) {
    remove_all_made();
    throw;
  }
}

OutputFolder::~OutputFolder() {
  if (!committed_) remove_all_made();
}

void OutputFolder::remove_all_made() const {
  if (lock_) remove_own(own_, files_);
  std::error_code ignored;  // there is nobody left to tell
  // `remove` leaves folders that are not empty alone.
  std::for_each(made_parents_.rbegin(), made_parents_.rend(),
                [&](const fs::path& parent) { fs::remove(parent, ignored); });
}

/// \throws OutputError where `folder` is there, and neither empty nor an earlier result.
void OutputFolder::require_replaceable(const fs::path& folder) const {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (status.type() == fs::file_type::not_found) return;
  if (status.type() == fs::file_type::none) fail("use", target_, error);
  if (status.type() != fs::file_type::directory) {
    throw OutputError(target_.string() + " is not a folder; choose another one with --out");
  }
  const fs::path here = fs::current_path(error);
  if (!error &&
      std::mismatch(folder.begin(), folder.end(), here.begin(), here.end()).first == folder.end()) {
    throw OutputError(fmt::format(
        "{} is the folder that this runs in, or holds it, and replacing it would leave you in a "
        "folder that is gone; choose another one with --out",
        target_.string()));
  }
  bool is_empty = true;
  error.clear();
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    is_empty = false;
    const fs::path within = entry->path().lexically_relative(folder);
    if (is_of_result(within, *entry, files_)) continue;
    throw OutputError(fmt::format(
        "{} holds {}, which is not a result of an earlier run and would be lost; choose another "
        "folder with --out, or move it away",
        target_.string(), within.string()));
  }
  if (error) fail("read", target_, error);
  if (is_empty) return;
  const std::string& first = files_.names.front();
  if (!fs::exists(folder / first)) {
    throw OutputError(fmt::format(
        "{} has no {}, so it is not a result of an earlier run, and is not replaced; choose "
        "another folder with --out",
        target_.string(), first));
  }
  if (!has_sign(folder / first, files_.sign)) {
    throw OutputError(fmt::format(
        "{} holds a {} that lcs has not written, and is not replaced; choose another folder with "
        "--out",
        target_.string(), first));
  }
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

/// Under the first name that is free: the process may have had its number before, and what is there
/// need not be this program's.
void OutputFolder::make_staging() {
  std::error_code error;
  for (int attempt = 0; !lock_; ++attempt) {
    own_ = target_;
    own_ += fmt::format("{}{}", kPartial, ::getpid());
    if (attempt > 0) own_ += fmt::format("-{}", attempt);
    if (fs::create_directory(own_, error)) lock_.emplace(own_);
    if (error) fail("create", own_, error);
  }
  write_file(own_ / kMarker, marker_text(own_.filename().string()));
  staging_ = own_ / kIn;
  fs::create_directory(staging_, error);
  if (error) fail("create", staging_, error);
}

void OutputFolder::commit() {
  require_replaceable(target_);  // it may have changed since
  std::error_code error;
  fs::rename(staging_, target_, error);  // where there is nothing, or an empty folder
  const bool is_there = error == std::errc::directory_not_empty || error == std::errc::file_exists;
  if (error && !is_there) fail("create", target_, error);
  if (error) replace_target();
  committed_ = true;
  remove_own(own_, files_);
}

/// Looks at the earlier result once more when nobody can reach it by its name any longer.
void OutputFolder::replace_target() {
  const fs::path out = own_ / kOut;
  const bool is_exchanged = exchange(staging_, target_);
  rename_or_fail("replace", is_exchanged ? staging_ : target_, out);
  try {
    require_replaceable(out);
    if (!is_exchanged) rename_or_fail("create", staging_, target_);
  } catch (const OutputError&) {
    std::error_code ignored;
    if (!is_exchanged) fs::rename(out, target_, ignored);
    if (is_exchanged) exchange(out, target_);
    throw;
  }
}

}  // namespace lcs::bench
