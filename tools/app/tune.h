/// \file
/// Learns the filter's parameters from recorded runs of the split `train`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/app/caller.h"
#include "tools/app/option.h"
#include "tools/tune/search.h"

namespace lcs::app {

struct TuneRequest {
  std::vector<std::string> suites;
  std::vector<std::string> validate;  ///< suites on which the result is only stated
  std::vector<std::string> keys;
  std::vector<std::string> sets;
  int evaluations = 300;
  std::uint64_t seed = 1;
  std::string out = "out/tune";
};

Options options_of(TuneRequest& request);

struct TuneMade {
  tune::Found found;
  std::vector<tune::Stated> stated;  ///< on the request's suites, and on those to validate
  std::string record;                ///< the text of record.md
  std::filesystem::path folder;
};

/// \throws std::exception, and an exception of `caller.check`. All finished evaluations are kept.
TuneMade tune(const TuneRequest& request, Caller& caller);

}  // namespace lcs::app
