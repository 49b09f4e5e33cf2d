/// \file
/// The filter with its experts side by side: Line on the caller's thread, Circle and Square on one
/// of their own each, so that three frames are under way at once and the caller has the time to
/// find the corners of the next one. The same bits as `Filter`, two frames later.
///
/// For recordings, and where frames come faster than one core can take them; a single frame is not
/// done any sooner. Where regions are ignored (`line.ignore`), the Line expert waits for the frame
/// before, and only what the caller does between frames runs beside the filter.
/// What it is worth: `tests/bench/README.md`.
#pragma once

#include <memory>
#include <span>

#include "filter/filter.h"

namespace lcs {

class FilterPipeline {
 public:
  /// By how many frames the results lag.
  static constexpr int kLag = 2;

  /// \throws std::invalid_argument as `Filter` does.
  FilterPipeline(const Intrinsics& camera, const Parameters& parameters);
  /// Frames under way are given up.
  ~FilterPipeline();
  FilterPipeline(FilterPipeline&&) noexcept;
  FilterPipeline& operator=(FilterPipeline&&) noexcept;

  /// The next frame, as for `Filter::step`.
  /// \return what is to be said of the frame `kLag` before, null where there is none; valid until
  ///   the next call of either. What an expert throws (memory that runs out) is thrown on, by this
  ///   and every later call.
  const FrameResult* push(std::span<const Eigen::Vector2f> corners_px, const EgoMotion& motion);

  /// The next of the frames that are still under way, null after the last.
  const FrameResult* drain();

  /// What was wrong with the data of all frames so far.
  const Diagnostics& diagnostics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lcs
