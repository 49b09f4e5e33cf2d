#include "tools/sequence/journal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>
#include <tuple>
#include <utility>

#include "tools/files/json_node.h"
#include "tools/files/output.h"
#include "tools/files/sha256.h"
#include "tools/sequence/manifest.h"
#include "tools/sequence/readme.h"
#include "tools/sequence/text_file.h"

namespace lcs::sequence {

// The keys of a frame's record.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FileRecord, path, bytes, sha256)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Agreement, worst, compared)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FrameRecordEntry, files, rows, checks)

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kJournal = ".generate";
constexpr const char* kPlan = "plan.json";
constexpr const char* kUnfinished = ".partial";
constexpr const char* kFormats = "formats";
constexpr const char* kBagLibrary = "rosbags";

/// A readable line on the first difference of two plans; "" if they are equal.
std::string difference(const Json& there, const Json& asked) {
  for (const auto& [key, value] : asked.items()) {
    if (!there.contains(key) || there.at(key) != value) {
      return fmt::format("its {} is {}, not {}", key,
                         there.contains(key) ? there.at(key).dump() : "unknown", value.dump());
    }
  }
  return "";
}

bool is_record(const std::string& name) {
  return name.starts_with("frame-") && name.ends_with(".json");
}

[[noreturn]] void refuse_to_replace(const fs::path& place, const char* what) {
  throw bench::OutputError(
      fmt::format("{} {}, and would be lost; move it away, or choose another folder with --out",
                  place.string(), what));
}

}  // namespace

Journal::Journal(const fs::path& folder, const std::function<std::string(const fs::path&)>& plan_in,
                 bool adds)
    : folder_(bench::output_path(folder)) {
  try {
    if (fs::exists(folder_) && !fs::is_directory(folder_)) {
      throw bench::OutputError(folder_.string() +
                               " is not a folder; choose another one with --out");
    }
    for (fs::path path = folder_; !fs::exists(path); path = path.parent_path()) {
      made_.insert(made_.begin(), path);
    }
    fs::create_directories(folder_);
    plan_ = plan_in(folder_);
    take_over(adds);
  } catch (const fs::filesystem_error& error) {
    remove_made();
    throw bench::OutputError(fmt::format("cannot use {}: {}; choose another folder with --out",
                                         folder_.string(), error.code().message()));
  } catch (...) {
    remove_made();
    throw;
  }
}

Journal::~Journal() {
  remove_made();
}

void Journal::remove_made() const {
  std::error_code is_in_use;
  for (auto path = made_.rbegin(); path != made_.rend(); ++path) fs::remove(*path, is_in_use);
}

void Journal::take_over(bool adds) {
  begun_ = fs::exists(plan_file());
  const bool is_finished = fs::exists(folder_ / kManifestFile);
  if (adds && !is_finished) {
    throw bench::OutputError(
        fmt::format("{} holds no finished sequence to add formats to; leave --add out to make one, "
                    "or name another folder with --out",
                    folder_.string()));
  }
  if (!begun_ && !is_finished) {
    for (const auto& entry : fs::directory_iterator(folder_)) {
      if (entry.path().filename() == kJournal) continue;
      throw bench::OutputError(fmt::format(
          "{} holds {}, which is no part of a generated sequence; choose another folder "
          "with --out, or move it away",
          folder_.string(), entry.path().filename().string()));
    }
    return;
  }
  const Json asked = bench::parse_json<Json>(plan_);
  Json there = begun_ ? read_plan(plan_file()) : plan_in_manifest(folder_ / kManifestFile);
  complete_ = is_finished && !begun_;
  if (adds && complete_ && there.is_object() && there.value(kFormats, Json()) != asked[kFormats]) {
    there[kFormats] = asked[kFormats];
    if (asked.contains(kBagLibrary)) there.emplace(kBagLibrary, asked[kBagLibrary]);
    complete_ = false;
  }
  const std::string differs =
      there.is_object() ? difference(there, asked) : "its plan cannot be read";
  if (!differs.empty()) {
    throw bench::OutputError(
        fmt::format("{} holds another sequence: {}; choose another folder with --out, or remove it",
                    folder_.string(), differs));
  }
  if (complete_ && fs::exists(folder_ / kJournal)) close();  // a killed process began to close it
  if (!adds || complete_) return;
  for (const std::string& path : files_in_manifest(folder_ / kManifestFile)) earlier_.insert(path);
  earlier_.insert(kManifestFile);
}

/// Puts the plan into the folder. \return false if another process has finished the sequence.
bool Journal::begin() {
  if (begun_) return fs::exists(plan_file());
  const fs::path manifest = folder_ / kManifestFile;
  if (fs::exists(manifest) && plan_in_manifest(manifest) == bench::parse_json<Json>(plan_)) {
    return false;
  }
  replace(plan_file(), plan_);
  return begun_ = true;
}

fs::path Journal::plan_file() const {
  return folder_ / kJournal / kPlan;
}

fs::path Journal::record_file(int frame) const {
  return folder_ / kJournal / fmt::format("frame-{:06}.json", frame);
}

bool Journal::is_whole(int frame) const {
  if (!fs::exists(record_file(frame))) return false;
  try {
    const FrameRecordEntry record = read(frame);
    return std::all_of(record.files.begin(), record.files.end(), [&](const FileRecord& file) {
      const fs::path path = folder_ / file.path;
      return fs::exists(path) && fs::file_size(path) == file.bytes;
    });
  } catch (const std::exception&) {
    return false;  // an unreadable record: the frame is made again
  }
}

int Journal::recorded() const {
  std::error_code error;
  int count = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / kJournal, error)) {
    count += is_record(entry.path().filename().string());
  }
  return count;
}

void Journal::add(int frame, const FrameOutput& output, const Agreements& checks) {
  if (!begin()) return;
  FrameRecordEntry frame_record{.files = {}, .rows = output.rows, .checks = checks};
  std::map<std::string, std::pair<FileRecord, std::string_view>> written;  // with the bytes
  for (const FrameFile& file : output.files) {
    auto& [record, bytes] = written[file.path];
    if (file.same_as.empty()) {
      bytes = file.bytes;
      write(file.path, bytes);
      record = {file.path, bytes.size(), bench::sha256(bytes)};
    } else {
      std::tie(record, bytes) = written.at(file.same_as);
      link_or_copy(file.same_as, file.path, bytes);
      record.path = file.path;
    }
    frame_record.files.push_back(record);
  }
  replace(record_file(frame), Json(frame_record).dump());
  if (!fs::exists(plan_file())) close();  // another process has just finished the sequence
}

FrameRecordEntry Journal::read(int frame) const {
  return bench::parse_json<Json>(read_file(record_file(frame))).get<FrameRecordEntry>();
}

/// Whether the file has these bytes. \throws bench::OutputError for any other file at its place,
/// unless it may be replaced.
bool Journal::is_there(const fs::path& within, std::string_view bytes) const {
  const fs::path path = folder_ / within;
  fs::path above = folder_;
  for (const fs::path& name : within.parent_path()) {
    above /= name;
    if (fs::is_symlink(above)) refuse_to_replace(above, "is a link, which is not followed");
  }
  const fs::file_status status = fs::symlink_status(path);
  if (!fs::exists(status)) return false;
  if (!fs::is_regular_file(status)) refuse_to_replace(path, "is not a file");
  if (earlier_.contains(within) && (within == kReadmeFile || within == kManifestFile)) return false;
  const std::uintmax_t size = fs::file_size(path);
  if (size > bytes.size() || !bytes.starts_with(read_file(path))) {
    refuse_to_replace(path, "is not a file that lcs has written");
  }
  return size == bytes.size();
}

void Journal::require_unwritten(const std::vector<fs::path>& within, int frame) const {
  for (const fs::path& path : within) {
    if (earlier_.contains(path) || !fs::exists(fs::symlink_status(folder_ / path))) continue;
    // Another process may have finished the sequence meanwhile.
    if (is_whole(frame) || !fs::exists(plan_file())) return;
    refuse_to_replace(folder_ / path, "is not a file that lcs has written");
  }
}

void Journal::write(const fs::path& within, std::string_view bytes) const {
  if (!is_there(within, bytes)) replace(folder_ / within, bytes);
}

std::vector<FileRecord> Journal::add_folder(
    const fs::path& within, const std::function<void(const fs::path&)>& make) const {
  const fs::path work = folder_ / kJournal / fmt::format("folder{}", kUnfinished);
  fs::remove_all(work);
  fs::create_directories(work);
  make(work / within.filename());
  std::vector<FileRecord> records;
  for (const auto& entry : fs::directory_iterator(work / within.filename())) {
    const fs::path path = within / entry.path().filename();
    records.push_back(
        {path.string(), entry.file_size(), bench::sha256_of_file(entry.path()).value()});
    if (!fs::exists(fs::symlink_status(folder_ / path))) {
      fs::create_directories(folder_ / within);
      fs::rename(entry.path(), folder_ / path);
    } else if (bench::sha256_of_file(folder_ / path) != records.back().sha256) {
      refuse_to_replace(folder_ / path, "is not a file that lcs has written");
    }
  }
  fs::remove_all(work);
  return records;
}

void Journal::replace(const fs::path& path, std::string_view bytes) const {
  const fs::path unfinished = folder_ / kJournal / fmt::format("{}{}", ::getpid(), kUnfinished);
  std::error_code error;
  try {
    fs::create_directories(unfinished.parent_path());
    bench::write_file(unfinished, bytes);
    fs::create_directories(path.parent_path());
    fs::rename(unfinished, path);
  } catch (const fs::filesystem_error& failure) {
    fs::remove(unfinished, error);
    bench::fail_to("write", path, failure.code());
  } catch (...) {
    fs::remove(unfinished, error);
    throw;
  }
}

void Journal::link_or_copy(const fs::path& from, const fs::path& to, std::string_view bytes) const {
  if (is_there(to, bytes)) return;
  std::error_code error;
  fs::create_directories((folder_ / to).parent_path(), error);
  fs::remove(folder_ / to, error);
  fs::create_hard_link(folder_ / from, folder_ / to, error);
  if (error) write(to, bytes);  // for file systems without links
}

void Journal::close() const {
  fs::remove(plan_file());  // first: without it the sequence is finished
  std::vector<fs::path> own;
  for (const auto& entry : fs::directory_iterator(folder_ / kJournal)) {
    const std::string name = entry.path().filename().string();
    if (is_record(name) || name.ends_with(kUnfinished)) own.push_back(entry.path());
  }
  for (const fs::path& path : own) fs::remove(path);
  std::error_code holds_something_else;
  fs::remove(folder_ / kJournal, holds_something_else);
}

}  // namespace lcs::sequence
