/// \file
/// A suite's result for people and other programs: text for a terminal, tables that compare its
/// detector with others on the same runs, JUnit XML for Jenkins, GitLab and others, and a
/// comparison of two suites for the discussion of a merge request, in Markdown with two pictures.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tools/scoring/table.h"
#include "tools/suite/comparison.h"
#include "tools/suite/suite_result.h"
#include "tools/suite/verdict.h"

namespace lcs::suite {

/// A row per scenario (mean over seeds, and half the range of several) and a row per group (for
/// worlds with the 95 % interval); as text also a legend.
/// \param worst_first sorts by F1, errors first; otherwise in the suite's order.
std::string suite_table(const SuiteResult& suite, bool worst_first,
                        scoring::Format format = scoring::Format::text);

/// A line per error and unmet criterion. Equal messages of several seeds share a line.
std::vector<std::string> problems(const SuiteResult& suite);

/// The runs' warnings, a line per scenario and kind of warning, with the seeds; the text is the
/// first seed's.
std::vector<std::string> warnings(const SuiteResult& suite);

/// F1 of rebel corners (mean over seeds): a row per scenario with a figure by every detector, and
/// the means over each group and over all. As text also a line per other detector: the number of
/// scenarios in which the suite's detector is ahead, the scenario with the least lead, and the
/// ratio of the step times (mean over scenarios of the ratio of medians). For worlds, the means
/// have 95 % intervals, and further tables follow: the lead over each other detector, paired by
/// world; and false corners and objects in static worlds and in all worlds.
std::string beside_table(const SuiteResult& suite, std::span<const SuiteResult> others,
                         scoring::Format format = scoring::Format::text);

inline constexpr const char* kStandingFile = "standing.md";

/// A row per detector: F1 and recall of rebel corners, recall of movers' boxes, false objects, and
/// times of a frame. Each is a mean over the scenarios that have the figure, for worlds (times
/// apart) with the 95 % interval.
std::string standing_table(const SuiteResult& suite, std::span<const SuiteResult> others,
                           scoring::Format format);

/// `standing_table` in Markdown, with a line that says over how many scenarios.
std::string standing_page(const SuiteResult& suite, std::span<const SuiteResult> others);

inline constexpr const char* kJunitFile = "junit.xml";

/// Writes one test suite per scenario and one test case per judged criterion (`judgements_of`). A
/// `failure` is a required criterion that is not met, `skipped` one that is not required, an
/// `error` a run without figures. Each of these names its place in report.html. Against a baseline
/// a further test suite, `baseline`, has one test case: a `failure` if it regressed, an `error` if
/// nothing was judged. \param others results of other detectors on the same scenarios. \param
/// verdict of the suite. \throws files::OutputError
void write_junit(const std::filesystem::path& file, const SuiteResult& suite,
                 std::span<const SuiteResult> others, const SuiteVerdict& verdict);

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
