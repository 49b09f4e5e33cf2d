#include "tools/files/written.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <vector>

#include "scenarios/input/error.h"
#include "scenarios/input/message.h"
#include "scenarios/input/sha256.h"
#include "tools/files/output_file.h"

namespace lcs::files {
namespace {

constexpr std::size_t kDigits = 64;
constexpr std::size_t kLargestRecord = std::size_t{256} << 20;

/// A line in the format of sha256sum: in names, backslashes and line ends are escaped, and such a
/// line begins with a backslash.
std::string line_of(const std::string& digest, const std::string& name) {
  std::string escaped;
  for (const char c : name) {
    if (c == '\\' || c == '\n') escaped += '\\';
    escaped += c == '\n' ? 'n' : c;
  }
  return fmt::format("{}{}  {}\n", escaped == name ? "" : "\\", digest, escaped);
}

/// Parses a line of `line_of`. \return false if its format differs.
bool read_line(std::string_view line, WrittenFiles& files) {
  const bool is_escaped = line.starts_with('\\');
  if (is_escaped) line.remove_prefix(1);
  if (line.size() < kDigits + 3 || line.substr(kDigits, 2) != "  ") return false;
  const std::string digest(line.substr(0, kDigits));
  if (digest.find_first_not_of("0123456789abcdef") != std::string::npos) return false;
  std::string name;
  for (std::size_t i = kDigits + 2; i < line.size(); ++i) {
    const bool is_mark = is_escaped && line[i] == '\\' && i + 1 < line.size();
    if (is_mark) ++i;
    name += is_mark && line[i] == 'n' ? '\n' : line[i];
  }
  return files.emplace(name, digest).second;
}

std::string digest_of(const fs::path& file) {
  std::optional<std::string> digest;
  try {
    digest = input::sha256_of_file(file);
  } catch (const std::exception& error) {  // of a file that this process has written
    throw OutputError(input::message_of(error));
  }
  if (!digest) throw OutputError(file.string() + " is gone; try again");
  return *digest;
}

}  // namespace

fs::path record_beside(const fs::path& file) {
  return file.parent_path() / fmt::format(".{}{}", file.filename().string(), kRecordName);
}

WrittenFiles read_record(const fs::path& record) {
  const std::string text = beginning(record, kLargestRecord);
  WrittenFiles files;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    if (end == rest.npos || !read_line(rest.substr(0, end), files)) return {};
    rest.remove_prefix(end + 1);
  }
  return files;
}

void write_record_of_folder(const fs::path& folder) {
  std::vector<std::string> names;
  WrittenFiles files;
  for (const fs::directory_entry& entry : entries_below(folder)) {
    if (entry.path() == folder / kRecordName) continue;  // of a commit that failed
    flush_to_disk(entry.path());
    if (entry.is_directory()) continue;
    names.push_back(entry.path().lexically_relative(folder).string());
    if (entry.path().filename() != kRecordName) continue;
    // Reuse the digests of a nested folder's record, which this command has just written.
    const fs::path within = fs::path(names.back()).parent_path();
    for (const auto& [name, digest] : read_record(entry.path())) {
      files.emplace((within / name).string(), digest);
    }
  }
  for (const std::string& name : names) {
    if (!files.contains(name)) files.emplace(name, digest_of(folder / name));
  }
  std::string text;
  for (const auto& [name, digest] : files) text += line_of(digest, name);
  write_file(folder / kRecordName, text);
  flush_to_disk(folder / kRecordName);
  flush_to_disk(folder);
}

void write_record_of_file(const fs::path& file) {
  write_file(record_beside(file), line_of(digest_of(file), file.filename().string()));
  for (const fs::path& written : {file, record_beside(file), file.parent_path()}) {
    flush_to_disk(written);
  }
}

std::string difference(const WrittenFiles& written, const std::string& name, const fs::path& file) {
  const auto record = written.find(name);
  if (record == written.end()) return "is not a file that lcs has written";
  return input::sha256_of_file(file) == record->second ? "" : "was changed since lcs wrote it";
}

std::string first_difference(const fs::path& folder) {
  const WrittenFiles written = read_record(folder / kRecordName);
  if (written.empty()) return fmt::format("{} is missing or was changed", kRecordName);
  for (const auto& [name, digest] : written) {
    std::error_code error;
    if (!fs::exists(folder / name, error)) return name + " is missing";
    const std::string what = difference(written, name, folder / name);
    if (!what.empty()) return fmt::format("{} {}", name, what);
  }
  return "";
}

}  // namespace lcs::files
