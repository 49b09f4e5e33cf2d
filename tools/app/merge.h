/// \file
/// Joins the parts of a suite that were made with `SuiteRequest::shard`.
#pragma once

#include <string>
#include <vector>

#include "tools/app/option.h"
#include "tools/app/suite_end.h"

namespace lcs::app {

struct MergeRequest {
  std::vector<std::string> parts;  ///< folders
  SuitePlace place;
};

Options options_of(MergeRequest& request);

/// \throws files::OutputError, std::exception; then nothing is written.
SuiteMade merge(const MergeRequest& request, Caller& caller);

}  // namespace lcs::app
