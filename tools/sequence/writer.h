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

/// Added to the simulation's times, which begin at 0: all times have 19 digits then, like times of
/// a clock. Files sorted by name are in time order, and tools that build names from numbers find
/// them.
inline constexpr std::int64_t kEpoch_ns = 1'000'000'000'000'000'000;

/// Data common to all frames of one camera. The references must outlive the writers.
struct SequenceInfo {
  const scenario::Scenario& scenario;  ///< as the camera sees it
  const sim::Calibration& calibration;
  const std::vector<sim::Object>& objects;
  const std::optional<scenario::Origin>& origin;
  const std::vector<const sim::Calibration*>& rig;  ///< of all cameras of the sequence, cam0 first
  std::size_t place = 0;                            ///< of the camera in `rig`

  /// Whether it is cam0, whose writers have the files of the other sensors, too.
  bool is_first() const { return place == 0; }
};

/// The name of a camera's folder in EuRoC's layout. \param place in the rig, from 0.
std::string camera_name(std::size_t place);

/// T_ab between two cameras of the rig, by their poses in the rover's frame.
inline sim::Pose between(const sim::Calibration& a, const sim::Calibration& b) {
  return a.T_BC.inverse() * b.T_BC;
}

struct FrameView {
  const sim::Observation& now;
  std::int64_t stamp_ns;             ///< of the picture, by the clock of the camera
  const cv::Mat1w& mask;             ///< of objects, `object_mask`
  const TrueFlow* motion = nullptr;  ///< to the next frame; null if not requested, or last
};

class Writer {
 public:
  explicit Writer(const SequenceInfo& info) : info_(info) {}
  virtual ~Writer() = default;

  /// A pure function of the frame, so that frames may be written in any order and by any process.
  virtual void write(const FrameView&, FrameOutput&) const {}
  /// Files that contain the rows of all frames. Their paths, and the paths of a frame's files, are
  /// for cam0; `of_camera` moves the files of another camera.
  virtual std::vector<Document> documents() const { return {}; }

 protected:
  SequenceInfo info_;
};

using MakeWriter = std::unique_ptr<Writer>(const SequenceInfo& info);

/// A format that `lcs generate` writes.
struct Format {
  std::string_view name;
  std::string_view purpose;  ///< one readable line
  std::string_view readme;   ///< its files, as list items for a sequence's README
  MakeWriter* make;
  double bytes_a_pixel = 0;    ///< of its files, for `estimated_bytes`
  double bytes_a_reading = 0;  ///< likewise, for each reading of the IMU
  bool is_usual = true;        ///< written if no formats are named
  int pictures = 0;            ///< copies of the pictures that it has
};

/// All formats, in the order in which they are written.
const std::vector<Format>& formats();

/// \throws std::invalid_argument with the names of all formats.
const Format& format(std::string_view name);

/// A use of sequences, and the formats that it takes.
struct Use {
  std::string_view name;
  std::vector<std::string> formats;
};
const std::vector<Use>& uses();

/// The bytes of a sequence, to a factor of two, by the number of its pixels and readings.
double estimated_bytes(const scenario::Scenario& scenario, const std::vector<std::string>& formats);

/// Path of the picture with a stamp, which is written for any formats.
std::string picture_path(std::int64_t stamp_ns, std::size_t place = 0);

}  // namespace lcs::sequence
