/// \file
/// What a search leaves beside its journal: the preset, and where its numbers come from.
#pragma once

#include <string>
#include <vector>

#include "tools/tune/search.h"

namespace lcs::tune {

inline constexpr const char* kPresetFile = "learnt.h";
inline constexpr const char* kPresetSign = "/// Written by `lcs tune`";
inline constexpr const char* kRecordFile = "record.md";
inline constexpr const char* kRecordSign = "# What `lcs tune` found";

/// How the values before and after did on one suite.
struct Stated {
  std::string suite;  ///< "train: /tmp/train, 60 runs of corridor_1 to yard_10"
  Worth before, after;
};

/// When, by which program and by which command it was done.
struct Circumstances {
  std::string date, program;
  std::vector<std::string> command;  ///< its words behind `lcs`
};

/// `filter/learnt.h`: what the preset `default` takes these parameters from.
std::string preset_text(const Found& found, const Circumstances& circumstances);

std::string record_text(const Found& found, const std::vector<Stated>& stated,
                        const Circumstances& circumstances);

}  // namespace lcs::tune
