/// \file
/// The paper's filter with its rules and tables: presets `lab` and `cars`. filter/EQUATIONS.md
/// lists each equation and its place in this folder.
#pragma once

#include <memory>
#include <span>

#include "filter/filter.h"
#include "filter/paper/parameters.h"

namespace lcs::paper {

/// Like `lcs::Filter`, with the same guarantees.
class PaperFilter {
 public:
  explicit PaperFilter(const Intrinsics& camera, const PaperParameters& parameters = {});
  ~PaperFilter();
  PaperFilter(PaperFilter&&) noexcept;
  PaperFilter& operator=(PaperFilter&&) noexcept;

  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px, const EgoMotion& motion);

  /// \param signatures used only to order corners at the same place: the paper has no descriptors.
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& motion);

  const Diagnostics& diagnostics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lcs::paper
