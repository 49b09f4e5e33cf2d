/// \file
/// What a writer of one format is: it turns frames of a simulation into files and rows.
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

/// Added to the times of a simulation, which begin at 0: with it all of them have 19 digits, as
/// those of a clock have, so that files in the order of their names are in the order of time, and
/// tools that make a name of a number find the file.
inline constexpr std::int64_t kEpoch_ns = 1'000'000'000'000'000'000;

/// What is the same for all frames. Refers to what outlives the writers.
struct SequenceInfo {
  const scenario::Scenario& scenario;
  const sim::Calibration& calibration;
  const std::vector<sim::Object>& objects;
  const std::optional<scenario::Origin>& origin;
};

struct FrameView {
  const sim::Observation& now;
  const cv::Mat1b& mask;  ///< of objects, `object_mask`
  const TrueFlow* motion = nullptr;  ///< to the next frame; none where nobody asked, or it is last
};

class Writer {
 public:
  virtual ~Writer() = default;

  /// A pure function of the frame: frames may come in any order, each in any process.
  virtual void write(const FrameView& frame, FrameOutput& output) const = 0;
  /// Files that are made of the rows of all frames.
  virtual std::vector<Document> documents() const = 0;
};

/// A format that `lcs generate` writes.
struct Format {
  std::string_view name;
  std::string_view purpose;  ///< one line for people
  std::string_view readme;   ///< its files, for the README of a sequence: items of a list
  std::unique_ptr<Writer> (*make)(const SequenceInfo& info);
};

/// All there are, in the order in which they are written.
const std::vector<Format>& formats();

/// \throws std::invalid_argument naming those that there are.
const Format& format(std::string_view name);

/// File of a frame's picture, which is written whatever the formats are.
std::string picture_path(std::int64_t t_ns);

}  // namespace lcs::sequence
