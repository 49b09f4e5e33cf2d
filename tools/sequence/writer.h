/// \file
/// Interface of a format's writer, which turns simulated frames into files and rows.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/simulation.h"
#include "tools/sequence/frame_output.h"
#include "tools/sequence/true_flow.h"

namespace lcs::sequence {

/// Added to the simulation's times, which begin at 0: all times have 19 digits then, like those of
/// a clock. Files sorted by name are in time order, and tools that build names from numbers find
/// them.
inline constexpr std::int64_t kEpoch_ns = 1'000'000'000'000'000'000;

/// Data common to all frames. The references must outlive the writers.
struct SequenceInfo {
  const scenario::Scenario& scenario;
  const sim::Calibration& calibration;
  const std::vector<sim::Object>& objects;
  const std::optional<scenario::Origin>& origin;
};

struct FrameView {
  const sim::Observation& now;
  std::int64_t stamp_ns;             ///< of the picture, by the clock of the camera
  const cv::Mat1w& mask;             ///< of objects, `object_mask`
  const TrueFlow* motion = nullptr;  ///< to the next frame; null if not requested, or last
};

class Writer {
 public:
  virtual ~Writer() = default;

  /// A pure function of the frame, so that frames may be written in any order and by any process.
  virtual void write(const FrameView& frame, FrameOutput& output) const = 0;
  /// Files that contain the rows of all frames.
  virtual std::vector<Document> documents() const = 0;
};

/// A format that `lcs generate` writes.
struct Format {
  std::string_view name;
  std::string_view purpose;  ///< one readable line
  std::string_view readme;   ///< its files, as list items for a sequence's README
  std::unique_ptr<Writer> (*make)(const SequenceInfo& info);
};

/// All formats, in the order in which they are written.
const std::vector<Format>& formats();

/// \throws std::invalid_argument with the names of all formats.
const Format& format(std::string_view name);

/// Path of the picture with a stamp, which is written for any formats.
std::string picture_path(std::int64_t stamp_ns);

}  // namespace lcs::sequence
