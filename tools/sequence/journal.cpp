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
#include "tools/sequence/text_file.h"

namespace lcs::sequence {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kJournal = ".generate";
constexpr const char* kPlan = "plan.json";
constexpr const char* kUnfinished = ".partial";

/// What two plans differ in, for people; "" if in nothing.
std::string difference(const Json& there, const Json& asked) {
  for (const auto& [key, value] : asked.items()) {
    if (!there.contains(key) || there.at(key) != value) {
      return fmt::format("its {} is {}, not {}", key,
                         there.contains(key) ? there.at(key).dump() : "unknown", value.dump());
    }
  }
  return "";
}

/// Anything in a folder but a journal without a plan; "" if there is nothing.
std::string first_stranger(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename() != kJournal) return entry.path().filename().string();
  }
  return "";
}

}  // namespace

Journal::Journal(const fs::path& folder, const std::string& plan,
                 const std::function<void(const fs::path&)>& before_it_is_read)
    : folder_(bench::output_path(folder)) {
  try {
    if (fs::exists(folder_) && !fs::is_directory(folder_)) {
      throw bench::OutputError(folder_.string() +
                               " is not a folder; choose another one with --out");
    }
    fs::create_directories(folder_);
    if (before_it_is_read) before_it_is_read(folder_);
    take_over(plan);
  } catch (const fs::filesystem_error& error) {
    throw bench::OutputError(fmt::format("cannot use {}: {}; choose another folder with --out",
                                         folder_.string(), error.code().message()));
  }
}

void Journal::take_over(const std::string& plan) {
  const bool is_begun = fs::exists(plan_file());
  const bool is_finished = !is_begun && fs::exists(folder_ / kManifestFile);
  if (!is_begun && !is_finished) {
    if (const std::string stranger = first_stranger(folder_); !stranger.empty()) {
      throw bench::OutputError(fmt::format(
          "{} holds {}, which is no part of a generated sequence; choose another folder "
          "with --out, or move it away",
          folder_.string(), stranger));
    }
    replace(plan_file(), plan);
    return;
  }
  const Json there = is_begun ? read_plan(plan_file()) : plan_in_manifest(folder_ / kManifestFile);
  const std::string differs = there.is_object() ? difference(there, bench::parse_json<Json>(plan))
                                                : "its plan cannot be read";
  if (!differs.empty()) {
    throw bench::OutputError(
        fmt::format("{} holds another sequence: {}; choose another folder with --out, or remove it",
                    folder_.string(), differs));
  }
  complete_ = is_finished;
  if (is_finished && fs::exists(folder_ / kJournal)) close();  // a process was killed at that
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
    return false;  // it is made again
  }
}

int Journal::recorded() const {
  std::error_code error;
  int count = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / kJournal, error)) {
    const std::string name = entry.path().filename().string();
    count += name.starts_with("frame-") && name.ends_with(".json");
  }
  return count;
}

void Journal::add(int frame, const FrameOutput& output, const Agreements& checks) const {
  if (!fs::exists(plan_file())) return;
  Json files = Json::array();
  std::map<std::string, std::pair<Json, std::string_view>> by_path;
  for (const FrameFile& file : output.files) {
    Json record;
    std::string_view bytes = file.bytes;
    if (file.same_as.empty()) {
      write(file.path, bytes);
      record = {{"path", file.path}, {"bytes", bytes.size()}, {"sha256", bench::sha256(bytes)}};
    } else {
      std::tie(record, bytes) = by_path.at(file.same_as);
      link_or_copy(file.same_as, file.path, bytes);
      record["path"] = file.path;
    }
    by_path[file.path] = {record, bytes};
    files.push_back(std::move(record));
  }
  Json agreements = Json::object();
  for (const auto& [name, agreement] : checks) {
    agreements[name] = {{"worst", agreement.worst}, {"compared", agreement.compared}};
  }
  const Json record = {{"files", files}, {"rows", output.rows}, {"checks", agreements}};
  replace(record_file(frame), record.dump());
  if (!fs::exists(plan_file())) close();  // it was just put together
}

FrameRecordEntry Journal::read(int frame) const {
  const auto json = bench::parse_json<Json>(read_file(record_file(frame)));
  FrameRecordEntry record;
  for (const Json& file : json.at("files")) {
    record.files.push_back({file.at("path").get<std::string>(),
                            file.at("bytes").get<std::uint64_t>(),
                            file.at("sha256").get<std::string>()});
  }
  record.rows = json.at("rows").get<Rows>();
  for (const auto& [name, agreement] : json.at("checks").items()) {
    record.checks[name] = {agreement.at("worst").get<double>(),
                           agreement.at("compared").get<std::int64_t>()};
  }
  return record;
}

void Journal::require_own(const fs::path& within, std::string_view bytes) const {
  const fs::path path = folder_ / within;
  const auto refuse = [&](const std::string& place, const char* what) {
    throw bench::OutputError(
        fmt::format("{} {}, and would be lost; move it away, or choose another folder with --out",
                    place, what));
  };
  fs::path above = folder_;
  for (const fs::path& name : within.parent_path()) {
    above /= name;
    if (fs::is_symlink(above)) refuse(above.string(), "is a link, which is not followed");
  }
  const fs::file_status status = fs::symlink_status(path);
  if (!fs::exists(status)) return;
  if (!fs::is_regular_file(status)) refuse(path.string(), "is not a file");
  if (fs::file_size(path) > bytes.size() || !bytes.starts_with(read_file(path))) {
    refuse(path.string(), "is not a file that lcs has written");
  }
}

void Journal::require_unwritten(const std::vector<fs::path>& within, int frame) const {
  for (const fs::path& path : within) {
    if (!fs::exists(fs::symlink_status(folder_ / path))) continue;
    // Another process may have put the sequence together meanwhile.
    if (is_whole(frame) || !fs::exists(plan_file())) return;
    throw bench::OutputError(fmt::format(
        "{} is not a file that lcs has written, and would be lost; move it away, or choose "
        "another folder with --out",
        (folder_ / path).string()));
  }
}

void Journal::write(const fs::path& within, std::string_view bytes) const {
  require_own(within, bytes);
  replace(folder_ / within, bytes);
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
    throw bench::OutputError(fmt::format("cannot write {}: {}; {}", path.string(),
                                         failure.code().message(), bench::remedy(failure.code())));
  } catch (...) {
    fs::remove(unfinished, error);
    throw;
  }
}

void Journal::link_or_copy(const fs::path& from, const fs::path& to, std::string_view bytes) const {
  require_own(to, bytes);
  std::error_code error;
  fs::create_directories((folder_ / to).parent_path(), error);
  fs::remove(folder_ / to, error);
  fs::create_hard_link(folder_ / from, folder_ / to, error);
  if (error) write(to, bytes);  // a file system without links
}

void Journal::close() const {
  fs::remove(plan_file());  // first: without it the sequence is finished
  std::vector<fs::path> own;
  for (const auto& entry : fs::directory_iterator(folder_ / kJournal)) {
    const std::string name = entry.path().filename().string();
    const bool is_record = name.starts_with("frame-") && name.ends_with(".json");
    if (is_record || name.ends_with(kUnfinished)) own.push_back(entry.path());
  }
  for (const fs::path& path : own) fs::remove(path);
  std::error_code holds_something_else;
  fs::remove(folder_ / kJournal, holds_something_else);
}

}  // namespace lcs::sequence
