/// \file
/// A comparison of two suites for the discussion of a merge request: Markdown and two pictures.
#pragma once

#include <filesystem>
#include <string>

#include "tools/suite/comparison.h"
#include "tools/suite/verdict.h"

namespace lcs::suite {

inline constexpr const char *kSummaryFile = "summary.md", *kBeforePicture = "before.jpg",
                            *kAfterPicture = "after.jpg";

/// Writes the verdict, the means, the worst scenarios with their reasons, and the event that grew
/// most since `before`, with a picture of it in each suite that has the event in these frames.
/// \param folder exists; gets `kSummaryFile` and the pictures.
/// \param pictures_at address of a folder that will have the pictures, in which the Markdown looks
///   for them; "": beside the Markdown.
/// \throws std::runtime_error for a file of events that cannot be read. \throws OutputError
void write_merge_request(const std::filesystem::path& folder, const SuiteInFolder& before,
                         const SuiteInFolder& after, const Comparison& comparison,
                         const SuiteVerdict& verdict, const std::string& pictures_at);

/// Markdown of a frame's picture. \param pictures_at as above.
std::string picture_link(int frame, const std::string& name, const std::string& pictures_at);

}  // namespace lcs::suite
