/// \file
/// The page of a suite's worlds, by family: a contact sheet of each world with the figures of all
/// detectors. Plain HTML; there may be thousands of pictures, so they are in a separate folder.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "tools/suite/suite_result.h"

namespace lcs::report {

inline constexpr const char* kWorldsFile = "worlds.html";
inline constexpr const char* kSheetsFolder = "worlds";

/// The path of a scenario's contact sheet, relative to the suite's folder.
std::filesystem::path sheet_path(const suite::ScenarioResult& scenario);

/// \param about a line that describes these worlds to the reader.
/// \param others results of other detectors on the same worlds.
/// \param suite_folder receives the page, which shows the sheets that exist there.
/// \throws files::OutputError
void write_worlds_page(const std::filesystem::path& suite_folder, const std::string& about,
                       const suite::SuiteResult& suite, std::span<const suite::SuiteResult> others);

}  // namespace lcs::report
