#include "tools/files/output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include "scenarios/input/inputs_read.h"
#include "scenarios/input/message.h"
#include "scenarios/input/sha256.h"
#include "tools/files/written.h"

namespace lcs::files {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytesOfDigest = 100;
constexpr const char* kAnother = "choose another place, or move it away";

/// The absolute path without a trailing slash. Links are resolved except in the last component.
fs::path resolved(const fs::path& target) {
  std::error_code error;
  fs::path path = fs::absolute(target, error).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  if (!error) path = fs::weakly_canonical(path.parent_path(), error) / path.filename();
  if (error) fail_to("use", target, error);
  return path;
}

/// All `Output` objects of this process.
std::vector<const Output*>& under_way() {
  static std::vector<const Output*> all;
  return all;
}

/// The staging folder of a target is `TARGET.partial-PROCESS/`, or `TARGET.unfinished/` if it is
/// kept. It contains the marker, the folder "in" for the new result, the folder "out" for the
/// earlier result, the folder "work" for what is no part of the result, and from the commit on the
/// file "commit" with the digest of the new result's record.
constexpr std::string_view kPartial = ".partial-", kUnfinished = ".unfinished";
constexpr std::string_view kMarker = ".lcs-partial", kIn = "in", kOut = "out", kWork = "work",
                           kCommit = "commit";

std::string marker_text(std::string_view folder_name) {
  return fmt::format("lcs writes its results here, and takes this folder away: {}\n", folder_name);
}

/// Whether a process of this program made the folder. The process may still run.
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

/// A file must match a whole pattern, a folder the beginning of a pattern.
bool fits(const fs::path& within, bool is_folder, const fs::path& pattern) {
  auto part = pattern.begin();
  for (const fs::path& name : within) {
    if (part == pattern.end() || !name_fits(name.native(), part->native())) return false;
    ++part;
  }
  return (part != pattern.end()) == is_folder;
}

bool is_of_result(const fs::path& within, const fs::directory_entry& entry,
                  const ResultNames& names) {
  const fs::file_type type = entry.symlink_status().type();
  const bool is_folder = type == fs::file_type::directory;
  return (is_folder || type == fs::file_type::regular) && is_name_of(within, names, is_folder);
}

/// Whether an entry of a staging folder is this program's. The staging folder of a suite contains
/// its runs' folders: `in/runs/NAME/seed-1.partial-PROCESS/in/metrics.json`.
bool is_of_staging(const fs::path& within, const fs::directory_entry& entry,
                   const ResultNames& names) {
  fs::path of_result;
  bool is_beside = true;  // directly in a staging folder
  for (const fs::path& name : within) {
    if (is_beside && (name == kMarker || name == kCommit)) {
      return entry.symlink_status().type() == fs::file_type::regular;
    }
    if (!is_beside || (name != kIn && name != kOut && name != kWork)) of_result /= name;
    is_beside = name.native().find(kPartial) != std::string::npos;
  }
  if (of_result.empty()) return entry.symlink_status().type() == fs::file_type::directory;
  return is_of_result(of_result, entry, names);
}

/// Removes this program's files from a staging folder, and the folder if it is empty then. The
/// marker and the note of the commit stay until all of these files are gone, so that another
/// process can finish.
void remove_own(const fs::path& folder, const ResultNames& names) {
  bool is_done = true;
  std::error_code error;
  const auto look = [&] { is_done = is_done && !std::exchange(error, {}); };
  std::vector<fs::path> own{folder};
  // Opens one folder at a time, as there may be no descriptors for more.
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (!fs::is_directory(fs::symlink_status(own[i], error))) continue;
    fs::directory_iterator entry(own[i], error);
    for (const fs::directory_iterator end; !error && entry != end; entry.increment(error)) {
      const fs::path within = entry->path().lexically_relative(folder);
      const bool is_last = within == kMarker || within == kCommit;
      if (!is_last && is_of_staging(within, *entry, names)) own.push_back(entry->path());
    }
    look();
  }
  // Backwards, as the contents of a folder come after it. The marker is removed last.
  for (std::size_t i = own.size(); i-- > 1;) {
    fs::remove(own[i], error);
    if (error == std::errc::directory_not_empty) error.clear();  // it holds a file of the user
    look();
  }
  if (!is_done) return;
  fs::remove(folder / kCommit, error);
  if (!error) fs::remove(folder / kMarker, error);
  if (!error) fs::remove(folder, error);
}

/// \return 0, or the error.
int rename_by(const fs::path& from, const fs::path& to, unsigned flags) {
  return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), flags) == 0 ? 0 : errno;
}

/// Finishes the moves of a process that was killed among them, or puts the earlier result back.
void settle(const fs::path& own, const fs::path& target, const ResultNames& names, bool is_folder) {
  if (is_folder) {
    rename_by(own / kOut, target, RENAME_NOREPLACE);
    return;
  }
  // The new file may be in its place already, and its record not yet.
  const fs::path record = own / kIn / record_beside(target).filename();
  if (difference(read_record(record), target.filename(), target).empty()) {
    rename_by(record, record_beside(target), 0);
  }
  for (const std::string& name : names) {
    rename_by(own / kOut / name, target.parent_path() / name, RENAME_NOREPLACE);
  }
}

/// Whether the folder is empty, or has only the beginning of a marker, of a killed process.
bool is_just_begun(const fs::path& folder) {
  const std::string text = marker_text(folder.filename().string());
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const bool is_marker = entry->path().filename() == kMarker;
    if (!is_marker || entry->symlink_status().type() != fs::file_type::regular) return false;
    if (!text.starts_with(beginning(entry->path(), text.size() + 1))) return false;
  }
  const std::string name = folder.filename().string();
  if (error || name.ends_with(kUnfinished)) return !error;
  const std::string process = name.substr(name.rfind(kPartial) + kPartial.size());
  return process.find_first_not_of("0123456789-") == std::string::npos;
}

void rename_or_fail(std::string_view what, const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) fail_to(what, to, error);
}

/// Runs `work` in a second process, which does not end by signals to this process.
/// \throws OutputError with the message of an exception of `work`.
void in_second_process(const std::function<void()>& work) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_to("write", "the results", errno);
  const pid_t process = ::fork();
  if (process < 0) fail_to("write", "the results", errno);
  if (process == 0) {
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, nullptr);
    ::setsid();
    std::string problem;
    try {
      work();
    } catch (const std::exception& error) {
      problem = input::message_of(error);
    }
    // A message is shorter than the buffer of a pipe, so that this does not wait.
    const ssize_t written = ::write(ends[1], problem.data(), problem.size());
    ::_exit(written == static_cast<ssize_t>(problem.size()) ? 0 : 1);
  }
  ::close(ends[1]);
  std::string problem;
  std::array<char, 4096> block;
  ssize_t got = 0;
  while ((got = ::read(ends[0], block.data(), block.size())) > 0 || (got < 0 && errno == EINTR)) {
    problem.append(block.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  }
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (problem.empty() && status != 0) {
    problem = "the process that puts the results in their places was ended; look at both of them";
  }
  if (!problem.empty()) throw OutputError(problem);
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder, bool is_shared)
    : file_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)),
      problem_(file_.is_open() ? 0 : errno) {
  is_held_ = file_.is_open() && (is_shared || ::flock(file_.get(), LOCK_EX | LOCK_NB) == 0);
  is_of_another_ = file_.is_open() && !is_held_ && errno == EWOULDBLOCK;
  is_possible_ =
      !file_.is_open() || is_held_ || (errno != ENOSYS && errno != ENOTSUP && errno != ENOLCK);
  // Until it was locked, its holder may have removed it, and another have made one of its name.
  struct stat locked {
  }, named{};
  is_held_ = is_held_ && ::fstat(file_.get(), &locked) == 0 &&
             ::lstat(folder.c_str(), &named) == 0 && locked.st_dev == named.st_dev &&
             locked.st_ino == named.st_ino;
}

void remove_abandoned(const fs::path& target, const ResultNames& names, bool is_folder) {
  std::error_code ignored;
  const std::string begin = target.filename().string() + std::string(kPartial);
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(target.parent_path(), ignored), end; entry != end;
       entry.increment(ignored)) {
    if (entry->path().filename().string().starts_with(begin)) found.push_back(entry->path());
  }
  for (const fs::path& path : found) {
    const FolderLock lock(path);  // the process of the folder locks it before it writes the marker
    if (!lock.is_held() || !(has_marker(path) || is_just_begun(path))) continue;
    settle(path, target, names, is_folder);
    remove_own(path, names);
  }
}

fs::path output_path(const fs::path& named) {
  const fs::path path = resolved(named);
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (status.type() == fs::file_type::none) fail_to("use", named, error);
  if (fs::is_symlink(status)) {
    throw OutputError("{} is a link, which is not followed; name the place itself", named.string());
  }
  for (const auto& [input, digest] : input::inputs_read()) {
    const fs::path read = fs::weakly_canonical(input, error);
    if (is_within(read, path)) {
      throw OutputError("{} {} {}, which is read; choose another place", named.string(),
                        read == path ? "is" : "holds", input.string());
    }
    if (is_within(path, read)) {
      throw OutputError("{} lies inside of {}, which is read; choose another place", named.string(),
                        input.string());
    }
  }
  return path;
}

struct Output::Move {
  fs::path made, place, earlier;

  /// \return whether an earlier result was at the place.
  bool put() const {
    const int error = rename_by(made, place, RENAME_NOREPLACE);
    if (error == 0) return false;
    const bool is_there = fs::exists(fs::symlink_status(place));
    if (is_there && rename_by(made, place, RENAME_EXCHANGE) == 0) {
      const int problem = rename_by(made, earlier, 0);
      if (problem == 0) return true;
      rename_by(made, place, RENAME_EXCHANGE);
      fail_to("replace", place, problem);
    }
    const bool is_unknown = error == EINVAL || error == ENOSYS;  // unsupported flag
    if (!is_there && !is_unknown) fail_to("create", place, error);
    if (is_there) rename_or_fail("replace", place, earlier);
    try {
      rename_or_fail("create", made, place);
    } catch (const OutputError&) {
      if (is_there) rename_or_fail("put back", earlier, place);
      throw;
    }
    return is_there;
  }

  void take_back(bool was_there) const {
    if (was_there && rename_by(earlier, place, RENAME_EXCHANGE) == 0) {
      rename_or_fail("take back", earlier, made);
      return;
    }
    rename_or_fail("take back", place, made);
    if (was_there) rename_or_fail("put back", earlier, place);
  }
};

bool is_name_of(const fs::path& within, const ResultNames& names, bool is_folder) {
  if (!is_folder && within.filename() == kRecordName) return true;
  return std::ranges::any_of(
      names, [&](const std::string& name) { return fits(within, is_folder, name); });
}

std::vector<fs::path> folders_under_way() {
  std::vector<fs::path> all;
  for (const Output* output : under_way()) {
    all.insert(all.end(), {output->own_, output->target_});
  }
  return all;
}

Output::Output(const fs::path& target, ResultNames names, Unfinished unfinished,
               std::function<void()> wait)
    : names_(std::move(names)), unfinished_(unfinished), wait_(std::move(wait)) {
  target_ = output_path(target);
  prepare();
}

Output::Output(const fs::path& target, Overwrite overwrite) : overwrite_(overwrite) {
  std::error_code error;
  const fs::file_status status = fs::status(target, error);  // /dev/stdout is a link
  is_direct_ = fs::is_character_file(status) || fs::is_fifo(status);
  if (is_direct_) {
    pipe_ = input::Descriptor(::open(target.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    if (!pipe_.is_open() && errno == ENXIO) {
      throw OutputError("{} is a pipe that nobody reads; start its reader first", target.string());
    }
    target_ = staging_ = target;
    return;
  }
  target_ = output_path(target);
  names_ = {target_.filename(), record_beside(target_).filename()};
  prepare();
}

void Output::prepare() {
  for (const Output* other : under_way()) {
    if (!is_within(other->target_, target_) && !is_within(target_, other->target_)) continue;
    throw OutputError("{} and {}: results would go into each other; give each a place of its own",
                      other->target_.string(), target_.string());
  }
  remove_abandoned(target_, names_, is_folder());
  require_replaceable();
  make_parents();
  try {
    make_staging();
  } catch (...) {
    if (!is_kept_) remove_all_made();
    throw;
  }
  under_way().push_back(this);
}

Output::~Output() {
  std::erase(under_way(), this);
  if (!committed_ && !is_kept_) remove_all_made();
}

void Output::empty() {
  remove_own(own_, names_);
  if (fs::exists(own_)) {
    throw OutputError("{} holds files that lcs did not write; move them away", own_.string());
  }
  lock_.reset();
  make_staging();
  is_kept_ = false;
}

void Output::remove_all_made() const {
  std::error_code ignored;  // a destructor cannot report it; `remove` keeps folders with contents
  if (unfinished_ == Unfinished::shared) {
    for (const std::string_view folder : {kIn, kWork}) fs::remove(own_ / folder, ignored);
    const bool is_empty = !fs::exists(own_ / kIn, ignored) && !fs::exists(own_ / kWork, ignored);
    if (is_empty) remove_own(own_, names_);
  } else if (lock_) {
    try {
      // The process of `commit_all` may have been killed.
      settle(own_, target_, names_, is_folder());
      remove_own(own_, names_);
    } catch (const std::exception&) {  // the next command does it
    }
  }
  std::for_each(made_parents_.rbegin(), made_parents_.rend(),
                [&](const fs::path& parent) { fs::remove(parent, ignored); });
}

/// \throws OutputError if the target is a file or folder that must not be lost.
void Output::require_replaceable() const {
  for (const Move& move : moves()) require_own(move.place);
}

/// \param place of the output, or the place to which its earlier content was moved.
void Output::require_own(const fs::path& place) const {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(place, error);
  if (status.type() == fs::file_type::not_found) return;
  if (status.type() == fs::file_type::none) fail_to("use", target_, error);
  if (is_folder()) return require_own_folder(place, status.type());
  if (status.type() != fs::file_type::regular) {
    throw OutputError("{} is not a file; choose another place", target_.string());
  }
  const WrittenFiles written = read_record(record_beside(place.parent_path() / names_.front()));
  if (place.filename() != names_.front()) {
    if (written.size() == 1 && written.contains(names_.front())) return;
    throw OutputError("{} is not a record that lcs has written; {}", place.string(), kAnother);
  }
  if (overwrite_ == Overwrite::any_file || fs::file_size(place, error) == 0) return;
  const std::string what = difference(written, names_.front(), place);
  if (what.empty()) return;
  throw OutputError("{} {}, and would be lost; {}{}", target_.string(), what, kAnother,
                    overwrite_ == Overwrite::own ? "" : ", or give --force");
}

void Output::require_own_folder(const fs::path& folder, fs::file_type type) const {
  if (type != fs::file_type::directory) {
    throw OutputError(target_.string() + " is not a folder; choose another place");
  }
  std::error_code error;
  const fs::path here = fs::current_path(error);
  if (!error && is_within(here, folder)) {
    throw OutputError(
        "{} is the folder that this runs in, or holds it, and replacing it would leave you in a "
        "folder that is gone; choose another place",
        target_.string());
  }
  const WrittenFiles written = read_record(folder / kRecordName);
  for (const fs::directory_entry& entry : entries_below(folder)) {
    const std::string within = entry.path().lexically_relative(folder);
    std::string what = "is not a file of such a result";
    if (is_of_result(within, entry, names_)) {
      if (within == kRecordName || entry.is_directory()) continue;
      what = difference(written, within, entry.path());
    }
    if (what.empty()) continue;
    throw OutputError("{}: {} {}, and would be lost; {}", target_.string(), within, what, kAnother);
  }
}

std::vector<Output::Move> Output::moves() const {
  if (is_folder()) return {{staging_, target_, own_ / kOut}};
  std::vector<Move> all;
  for (const std::string& name : names_) {
    all.push_back({own_ / kIn / name, target_.parent_path() / name, own_ / kOut / name});
  }
  return all;
}

void Output::make_parents() {
  std::vector<fs::path> missing;
  for (fs::path parent = target_.parent_path(); !fs::exists(parent);
       parent = parent.parent_path()) {
    missing.push_back(parent);
  }
  std::for_each(missing.rbegin(), missing.rend(), [&](const fs::path& parent) {
    std::error_code error;
    if (fs::create_directory(parent, error)) made_parents_.push_back(parent);
    if (error) fail_to("create", parent, error);
  });
}

/// Takes a name beside the target for `own_`, and its lock. Leaves `lock_` empty if another process
/// took the new folder for an abandoned one, and may have removed it, before it was locked.
void Output::take_free_name(int attempt) {
  own_ = target_;
  own_ += fmt::format("{}{}", kPartial, ::getpid());
  if (attempt > 0) own_ += fmt::format("-{}", attempt);
  std::error_code error;
  // Another process may have had the same number, or the user may have a file of that name.
  if (fs::create_directory(own_, error)) lock_.emplace(own_);
  if (error && error != std::errc::file_exists) fail_to("create", own_, error);
  if (lock_ && (lock_->is_of_another() || !fs::exists(own_))) lock_.reset();
}

/// Takes TARGET.unfinished for `own_`, and its lock. Leaves `lock_` empty if another process has
/// just removed the folder.
void Output::take_unfinished() {
  own_ = target_;
  own_ += kUnfinished;
  std::error_code error;
  fs::create_directory(own_, error);
  if (error) fail_to("create", own_, error);
  is_kept_ = true;  // whatever fails: until the folder is known as ours, nothing in it is removed
  const auto take_lock = [&] { lock_.emplace(own_, unfinished_ == Unfinished::shared); };
  for (take_lock(); wait_ && lock_->is_of_another(); take_lock()) wait_();
  if (lock_->is_of_another()) {
    throw OutputError("{}: another process writes it; wait for it, or choose another place",
                      target_.string());
  }
  const int problem = lock_->problem();
  const bool is_other = problem == ELOOP || problem == ENOTDIR;  // a link
  if (problem == ENOENT || (problem == 0 && !lock_->is_held() && lock_->is_possible())) {
    return lock_.reset();
  }
  if (problem != 0 && !is_other) fail_to("use", own_, problem);
  if (is_other || (!has_marker(own_) && !is_just_begun(own_))) {
    throw OutputError("{} is in the way, and lcs did not make it; {}", own_.string(), kAnother);
  }
  if (unfinished_ == Unfinished::shared) return;
  // A process was killed while it moved its result: before the end, or after. If the new result is
  // in its place, "in" may have the earlier one.
  settle(own_, target_, names_, is_folder());
  const std::string committed = beginning(own_ / kCommit, kMostBytesOfDigest);
  const bool is_done =
      !committed.empty() && input::sha256_of_file(target_ / kRecordName) == committed;
  if (is_done || fs::exists(own_ / kOut)) {
    remove_own(own_, names_);
    lock_.reset();
  }
}

void Output::make_staging() {
  constexpr int kMostAttempts = 1000;
  for (int attempt = 0; !lock_; ++attempt) {
    if (attempt == kMostAttempts) {
      throw OutputError("{} cannot be made or locked; {}", own_.string(), kAnother);
    }
    unfinished_ == Unfinished::removed ? take_free_name(attempt) : take_unfinished();
  }
  staging_ = own_ / kIn;
  is_kept_ = fs::exists(staging_);
  // A marker that is there is not written again: a kill would leave a part of it.
  if (!has_marker(own_)) write_file(own_ / kMarker, marker_text(own_.filename().string()));
  std::error_code error;
  fs::create_directory(staging_, error);
  if (!error && !is_folder()) fs::create_directory(own_ / kOut, error);
  if (error) fail_to("create", staging_, error);
  if (!is_folder()) staging_ /= names_.front();
}

fs::path Output::work() const {
  const fs::path folder = own_ / kWork;
  std::error_code error;
  if (!fs::is_directory(folder, error)) fs::create_directory(folder, error);
  if (error) fail_to("create", folder, error);
  return folder;
}

void Output::commit() {
  Output* const self = this;
  commit_all({&self, 1});
}

/// Checks each earlier result again after it is moved away, when nobody can change it by its name.
void put_in_place(std::span<Output* const> outputs) {
  std::vector<std::pair<Output::Move, bool>> done;
  try {
    for (const Output* output : outputs) {
      if (!output->is_folder()) continue;
      write_file(output->own_ / kCommit,
                 input::sha256_of_file(output->staging_ / kRecordName).value_or(""));
      flush_to_disk(output->own_ / kCommit);
    }
    for (const Output* output : outputs) {
      for (const Output::Move& move : output->moves()) done.emplace_back(move, move.put());
    }
    for (const Output* output : outputs) {
      for (const Output::Move& move : output->moves()) output->require_own(move.earlier);
    }
  } catch (const OutputError&) {
    for (auto move = done.rbegin(); move != done.rend(); ++move)
      move->first.take_back(move->second);
    throw;
  }
  for (const Output* output : outputs) {
    flush_to_disk(output->target_.parent_path());
    remove_own(output->own_, output->names_);
  }
}

void commit_all(std::span<Output* const> outputs) {
  std::vector<Output*> all(outputs.begin(), outputs.end());
  std::erase_if(all, [](const Output* output) { return output->is_direct_; });
  std::size_t moves = 0;
  for (const Output* output : all) {
    output->require_replaceable();                           // the target may have changed since
    if (!output->is_folder()) output_path(output->target_);  // or may have been read
    output->is_folder() ? write_record_of_folder(output->staging_)
                        : write_record_of_file(output->staging_);
    moves += output->moves().size();
  }
  // A single rename needs no second process.
  const auto put = [&] { put_in_place(all); };
  moves > 1 ? in_second_process(put) : put();
  for (Output* output : all) output->committed_ = true;
}

}  // namespace lcs::files
