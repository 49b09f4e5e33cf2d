/// \file
/// Selects a filter by its preset's name: `default`, or the paper's `lab` and `cars`.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "filter/paper/paper_filter.h"

namespace lcs {

using AnyParameters = std::variant<Parameters, paper::PaperParameters>;

std::vector<std::string> preset_names();
/// \throws std::invalid_argument naming the known presets.
AnyParameters preset(std::string_view name);

/// Like the functions for `lcs::Parameters`.
///@{
void set(AnyParameters& parameters, std::string_view key, std::string_view value);
void validate(const AnyParameters& parameters);
std::vector<ParameterInfo> describe(const AnyParameters& parameters);
const FieldParameters& field_of(const AnyParameters& parameters);
///@}

/// Like `lcs::Filter`. The paper's filter uses no `view`.
class AnyFilter {
 public:
  AnyFilter(const Intrinsics& camera, const AnyParameters& parameters);

  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& motion,
                          GapView* view = nullptr);
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px, const EgoMotion& motion,
                          GapView* view = nullptr);
  const Diagnostics& diagnostics() const;
  /// Null if it is the paper's.
  const Filter* plain() const { return std::get_if<Filter>(&filter_); }

 private:
  std::variant<Filter, paper::PaperFilter> filter_;
};

}  // namespace lcs
