/// \file
/// The output files of a search besides its journal: the preset and the record of its origin.
#pragma once

#include <string>
#include <vector>

#include "tools/tune/search.h"

namespace lcs::tune {

inline constexpr const char* kPresetFile = "learnt.h";
inline constexpr const char* kRecordFile = "record.md";

/// The figures of the values before and after the search on one suite.
struct Stated {
  std::string suite;  ///< such as "out/train, 60 runs, corridor_1 to yard_10"
  Worth before, after;
};

/// Date, program version and command of a search.
struct Circumstances {
  std::string date, program;
  std::vector<std::string> command;  ///< its words after `lcs`
};

/// The text of `filter/types/learnt.h`, which gives the preset `default` these parameters.
std::string preset_text(const Found& found, const Circumstances& circumstances);

std::string record_text(const Found& found, const std::vector<Stated>& stated,
                        const Circumstances& circumstances);

}  // namespace lcs::tune
