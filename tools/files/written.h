/// \file
/// The record by which this program knows the files that it wrote: their SHA-256, in the format of
/// `sha256sum`. A folder of results holds the record of all its files, `.lcs-written`; a single
/// file NAME has one beside it, `.NAME.lcs-written`. A file that was changed since no longer
/// matches its record, and counts as the user's own.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace lcs::files {

inline constexpr const char* kRecordName = ".lcs-written";

/// The path of a single file's record.
std::filesystem::path record_beside(const std::filesystem::path& file);

/// SHA-256 by path. The paths are relative to the folder of the record.
using WrittenFiles = std::map<std::string, std::string>;

/// Reads a record; empty if it is missing or invalid.
WrittenFiles read_record(const std::filesystem::path& record);

/// Writes the record of all files in a folder and below, and waits until all are on the disk.
/// \throws OutputError
void write_record_of_folder(const std::filesystem::path& folder);
/// Writes the record of one file, beside it, and waits likewise. \throws OutputError
void write_record_of_file(const std::filesystem::path& file);

/// The fault of a file, such as "was changed since lcs wrote it"; "" if its bytes match the record.
/// \param name the file's name in the record.
std::string difference(const WrittenFiles& written, const std::string& name,
                       const std::filesystem::path& file);

/// The first file of a folder's record that is missing or was changed, with its fault; "" if there
/// is none. Files outside the record are ignored.
std::string first_difference(const std::filesystem::path& folder);

}  // namespace lcs::files
