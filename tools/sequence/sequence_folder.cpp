#include "tools/sequence/sequence_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

#include "scenarios/input/sha256.h"
#include "tools/files/json_node.h"
#include "tools/files/written.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {

// The keys of a frame's entry.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FileRecord, path, bytes, sha256)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Agreement, worst, compared)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FrameEntry, files, rows, checks)

namespace {

constexpr input::FileKind kManifestDocument{
    4 * input::kGibibyte,  // one file of each kind per frame, for a million frames
    "choose another folder with --out, or remove this one to make the sequence anew"};

constexpr const char* kFrames = "frames-";
constexpr const char* kSign = "# Written by `lcs generate`: the frames that are finished";
constexpr const char* kRemedy = "remove this file to have its frames made again";
constexpr const char* kFormats = "formats";
/// Facts by which a sequence may differ from the one that formats are added to: the formats, and
/// the libraries that write some of them.
constexpr auto kOfFormats = [] {
  std::array<std::string_view, 1 + kScripted.size()> names{kFormats};
  std::ranges::transform(kScripted, names.begin() + 1, &Scripted::library);
  return names;
}();

/// Formats decide the names of a sequence's files.
files::ResultNames sequence_files() {
  return {"*", "*/*", "*/*/*", "*/*/*/*", "*/*/*/*/*", "*/*/*/*/*/*"};
}

/// Moves a finished file to its place, in a folder that may be missing.
void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  if (!error) fs::rename(from, to, error);
  if (!error) return;
  std::error_code ignored;
  fs::remove(from, ignored);
  files::fail_to("write", to, error);
}

/// A name that no other process has, also on another machine.
std::string own_name() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return fmt::format("{}-{}", host.data(), ::getpid());
}

std::string manifest_text(const files::Provenance& plan, const Agreements& checks,
                          std::vector<FileRecord> files) {
  std::ranges::sort(files, {}, &FileRecord::path);
  files::Json manifest;
  manifest["plan"] = plan.json();
  for (const auto& [name, agreement] : checks) {
    manifest["checks"][name] = {{"worst", agreement.worst}, {"compared", agreement.compared}};
  }
  for (const FileRecord& file : files) {
    manifest["files"][file.path] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
  }
  return files::json_text(manifest, 1) + "\n";
}

/// The provenance in a manifest, or in a file of its own. \throws input::Error
files::Provenance provenance_in(const fs::path& file) {
  return files::read_json(file, kManifestDocument, [&](const files::JsonNode& node) {
    const bool is_manifest = file.filename() == kManifestFile;
    return files::Provenance::from(is_manifest ? node["plan"].json() : node.json());
  });
}

/// The paths of the files of a finished sequence, without the manifest. \throws input::Error, also
/// for a path that leads out of the sequence.
std::vector<std::string> files_in_manifest(const fs::path& manifest) {
  std::vector<std::string> paths;
  files::read_json(manifest, kManifestDocument, [&](const files::JsonNode& node) {
    node["files"].each_entry([&](const std::string& path, const files::JsonNode& record) {
      record.require(files::is_inner(path), "of a file inside of the sequence");
      paths.push_back(path);
    });
  });
  return paths;
}

}  // namespace

SequenceFolder::SequenceFolder(const fs::path& target, const fs::path& base, bool adds,
                               bool is_part, std::function<void()> wait)
    : output_(target, sequence_files(),
              is_part ? files::Unfinished::shared : files::Unfinished::kept, std::move(wait)),
      base_(base),
      adds_(adds) {
  if (fs::exists(output_.target() / kManifestFile)) {
    finished_ = provenance_in(output_.target() / kManifestFile);
  }
}

std::vector<std::string> SequenceFolder::formats() const {
  if (!finished_ || !finished_->facts.contains(kFormats)) return {};
  return files::JsonNode(finished_->facts, "")[kFormats].texts();
}

/// The first difference from the asked sequence; "" if there is none.
/// \param but names of facts that may differ.
std::string SequenceFolder::other_than(const files::Provenance& there,
                                       std::span<const std::string_view> but) const {
  const std::string what = files::difference(there, {.facts = facts_, .read = {}}, but);
  return what.empty() ? files::changed_since(there, base_) : what;
}

bool SequenceFolder::is_complete(const files::Json& facts) {
  facts_ = facts;
  if (finished_) {
    const auto may_differ = adds_ ? std::span(kOfFormats) : std::span<const std::string_view>();
    if (const std::string what = other_than(*finished_, may_differ); !what.empty()) {
      throw files::OutputError(fmt::format(
          "{} holds another sequence: {}; choose another folder with --out, or remove it",
          target().string(), what));
    }
    if (const std::string damage = files::first_difference(target()); !damage.empty()) {
      throw files::OutputError(
          fmt::format("{}: {}; remove the folder to make it anew", target().string(), damage));
    }
    if (files::difference(*finished_, {.facts = facts_, .read = {}}).empty()) return true;
  } else if (adds_) {
    throw files::OutputError(
        fmt::format("{} holds no finished sequence to add formats to; leave --add out to make one, "
                    "or name another folder with --out",
                    target().string()));
  }
  if (!fs::exists(plan_file())) return false;
  const std::string what = other_than(provenance_in(plan_file()));
  if (what.empty()) return false;
  throw files::OutputError(fmt::format(
      "{} holds frames of another sequence that is not finished: {}; finish it by its own command, "
      "or remove that folder",
      staging().parent_path().string(), what));
}

/// Puts the plan beside the frames, and opens the journal.
void SequenceFolder::begin() {
  if (journal_) return;
  const files::Provenance own = files::provenance_of(facts_, base_);
  if (fs::exists(plan_file())) {
    if (const auto what = files::difference(provenance_in(plan_file()), own); !what.empty()) {
      throw files::OutputError(fmt::format(
          "{}: {} from the frames that are there; give the same command again for its remedy",
          target().string(), what));
    }
  } else {
    put(plan_file(), files::json_text(own.json()));
  }
  if (finished_) take_earlier();
  journal_.emplace(output_.work() / (kFrames + own_name()), kSign, own, "frame", kRemedy,
                   [](const std::string&, int) {});
  output_.keep();
}

/// Takes the files of the sequence that formats are added to, as they are.
void SequenceFolder::take_earlier() const {
  for (const std::string& path : files_in_manifest(target() / kManifestFile)) {
    std::error_code error;
    const fs::path to = staging() / path;
    if (path == kReadmeFile || fs::exists(to)) continue;
    fs::create_directories(to.parent_path(), error);
    if (error) files::fail_to("write", to, error);
    files::link_or_copy(target() / path, to);
  }
}

/// Reads the entries that were added since the last call, by any process.
void SequenceFolder::refresh() {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(output_.work(), error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kFrames)) continue;
    journals_.try_emplace(entry.path(), entry.path(), kSign, kRemedy);
  }
  for (auto& [path, journal] : journals_) {
    journal.read([&, &journal = journal](const std::string& row, int line) {
      try {
        const nlohmann::json json = files::parse_json<nlohmann::json>(row);
        entries_[json.at("frame").get<int>()] = json.at("entry").get<FrameEntry>();
      } catch (const std::exception&) {
        journal.refuse(line, "the row is no entry of a frame");
      }
    });
  }
}

/// The entry of a frame, by any process; null if there is none yet.
const FrameEntry* SequenceFolder::find(int frame) {
  if (!entries_.contains(frame)) refresh();
  const auto found = entries_.find(frame);
  return found == entries_.end() ? nullptr : &found->second;
}

bool SequenceFolder::is_whole(int frame) {
  const FrameEntry* const entry = find(frame);
  return entry && std::ranges::all_of(entry->files, [&](const FileRecord& file) {
           return input::sha256_of_file(staging() / file.path) == file.sha256;
         });
}

int SequenceFolder::recorded() {
  refresh();
  return static_cast<int>(entries_.size());
}

const FrameEntry& SequenceFolder::read(int frame) {
  if (const FrameEntry* const entry = find(frame)) return *entry;
  throw std::runtime_error(fmt::format("{}: frame {} is not finished", target().string(), frame));
}

void SequenceFolder::add(int frame, const FrameOutput& output, const Agreements& checks) {
  try {
    begin();
    FrameEntry entry{.files = {}, .rows = output.rows, .checks = checks};
    std::map<std::string, std::pair<FileRecord, std::string_view>> written;  // with the bytes
    for (const FrameFile& file : output.files) {
      auto& [record, bytes] = written[file.path];
      if (file.same_as.empty()) {
        bytes = file.bytes;
        write(file.path, bytes);
        record = {file.path, bytes.size(), input::sha256(bytes)};
      } else {
        std::tie(record, bytes) = written.at(file.same_as);
        record.path = file.path;
        std::error_code error;
        fs::create_directories((staging() / file.path).parent_path(), error);
        fs::create_hard_link(staging() / file.same_as, staging() / file.path, error);
        if (error) write(file.path, bytes);  // it is there, or the file system has no links
      }
      entry.files.push_back(record);
    }
    journal_->add(files::json_text(nlohmann::json{{"frame", frame}, {"entry", entry}}));
  } catch (const files::OutputError&) {
    const fs::path manifest = target() / kManifestFile;
    const bool is_finished_by_another = !fs::exists(staging()) && fs::exists(manifest) &&
                                        other_than(provenance_in(manifest)).empty();
    if (!is_finished_by_another) throw;
  }
}

void SequenceFolder::write(const fs::path& within, std::string_view bytes) const {
  const fs::path path = staging() / within;
  std::error_code error;
  if (fs::is_regular_file(fs::symlink_status(path, error)) &&
      fs::file_size(path, error) == bytes.size() && read_file(path) == bytes) {
    return;
  }
  put(path, bytes);
}

/// Writes a file beside the sequence, then moves it to its place.
void SequenceFolder::put(const fs::path& path, std::string_view bytes) const {
  const fs::path beside = output_.work() / (own_name() + ".partial");
  files::write_file(beside, bytes);
  move(beside, path);
}

std::vector<FileRecord> SequenceFolder::add_folder(
    const fs::path& within, const std::function<void(const fs::path&)>& make) const {
  const fs::path work = output_.work() / "folder";
  fs::remove_all(work);
  fs::create_directories(work);
  make(work / within.filename());
  std::vector<FileRecord> records;
  for (const auto& entry : fs::directory_iterator(work / within.filename())) {
    const fs::path path = within / entry.path().filename();
    records.push_back(
        {path.string(), entry.file_size(), input::sha256_of_file(entry.path()).value()});
    if (input::sha256_of_file(staging() / path) == records.back().sha256) continue;
    move(entry.path(), staging() / path);
  }
  fs::remove_all(work);
  return records;
}

void SequenceFolder::finish(const Agreements& checks, std::vector<FileRecord> files) {
  std::set<fs::path> own{kManifestFile, files::kRecordName};
  for (const FileRecord& file : files) own.insert(file.path);
  write(kManifestFile, manifest_text(provenance_in(plan_file()), checks, std::move(files)));
  for (const fs::directory_entry& entry : files::entries_below(staging())) {
    const fs::path within = entry.path().lexically_relative(staging());
    if (entry.symlink_status().type() == fs::file_type::directory || own.contains(within)) continue;
    throw files::OutputError(
        fmt::format("{} is no file of the sequence; move it away, and give the same command again",
                    entry.path().string()));
  }
  output_.commit();
}

}  // namespace lcs::sequence
