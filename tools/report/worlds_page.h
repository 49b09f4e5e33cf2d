/// \file
/// The worlds of a suite to look at, family by family: a contact sheet of each, with the figures of
/// all detectors. Plain HTML, with its pictures in a folder beside it, as there may be thousands.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "tools/suite/suite_result.h"

namespace lcs::report {

inline constexpr const char* kWorldsFile = "worlds.html";
inline constexpr const char* kSheetsFolder = "worlds";

/// Where the contact sheet of a scenario is in the suite's folder.
std::filesystem::path sheet_path(const suite::ScenarioResult& scenario);

/// \param about a line for people on what these worlds are.
/// \param others the same worlds by other detectors.
/// \param suite_folder gets the page; sheets are shown where they are there.
/// \throws bench::OutputError
void write_worlds_page(const std::filesystem::path& suite_folder, const std::string& about,
                       const suite::SuiteResult& suite, std::span<const suite::SuiteResult> others);

}  // namespace lcs::report
