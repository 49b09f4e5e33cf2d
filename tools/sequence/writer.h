/// \file
/// A format's writer, which turns simulated frames into files of their own, and rows
/// of the files that all frames share.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/simulation.h"
#include "tools/sequence/true_flow.h"

namespace lcs::sequence {

/// Added to the simulation's times, which begin at 0: all times have 19 digits then, like times of
/// a clock. Files sorted by name are in time order, and tools that build names from numbers find
/// them.
inline constexpr std::int64_t kEpoch_ns = 1'000'000'000'000'000'000;

/// A file of one frame only. Paths are relative to the sequence's folder.
struct FrameFile {
  std::string path;
  std::string bytes;
  std::string same_as;  ///< path of an identical file of this frame; `bytes` is empty then
};

/// Rows of one frame by stream name.
using Rows = std::map<std::string, std::string>;

struct FrameOutput {
  std::vector<FrameFile> files;
  Rows rows;
};

/// A piece of a document: fixed text, or the rows of all frames in order.
struct DocumentPart {
  std::string text = {};       ///< fixed, or the rows so far
  std::string stream = {};     ///< "" for fixed text
  std::string separator = {};  ///< between the rows of two frames, if neither is empty
  /// Of rows that begin with t x y z and a quaternion: the character between fields; 0: others.
  char poses_between = 0;
  Eigen::Vector4d last_quaternion = Eigen::Vector4d::Zero();  ///< as written; 0 before the first
};

/// A file of the whole sequence.
struct SequenceDocument {
  std::string path;
  std::vector<DocumentPart> parts;
};

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
  /// A time of the simulation by the clock of the camera.
  std::int64_t stamp_ns(std::int64_t t_ns) const {
    return kEpoch_ns + t_ns - std::llround(1e9 * scenario.camera.time_offset_s);
  }
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

struct Writer {
  /// A pure function of the frame, so that frames may be written in any order and by any process.
  std::function<void(const FrameView&, FrameOutput&)> write = [](const auto&, auto&) {};
  /// Files that contain the rows of all frames. Their paths, and the paths of a frame's files, are
  /// for cam0; the generator moves the files of another camera.
  std::vector<SequenceDocument> documents = {};
};

/// \throws input::Error if the sequence cannot have the format.
using MakeWriter = Writer(const SequenceInfo& info);
/// The writers, one for each format; those of like formats share a file.
MakeWriter picture_writer, euroc_writer, kalibr_writer, kitti_writer, tum_writer, mcap_writer,
    rrd_writer, rpg_writer, dsec_writer, mot_writer, coco_writer, davis_writer, flow_writer,
    depth_writer, landmarks_writer;

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

/// A format that a Python script writes by a library. Its document has text in place of the bytes.
struct Scripted {
  std::string_view format;
  std::string_view library;  ///< as a fact of the sequence
  std::string_view file;     ///< path of the document, in a folder that the script makes
  /// The script of this folder. Arguments: the document, the folder of the pictures if it
  /// `takes_pictures`, the folder to make; or --version, to print the version of the library.
  const char* script;
  bool takes_pictures;
};
inline constexpr const char *kBagFile = "rosbag/rosbag.mcap", *kRerunFile = "rerun/sequence.rrd",
                            *kDsecFile = "dsec/events.h5", *kLayoutFile = "foxglove.json";
inline constexpr std::array<Scripted, 3> kScripted{
    {{"mcap", "rosbags", kBagFile, "write_bag.py", true},
     {"rrd", "rerun-sdk", kRerunFile, "write_rrd.py", true},
     {"dsec", "h5py", kDsecFile, "write_events.py", false}}};

/// Runs the script. \return its standard output. \throws std::runtime_error with its message if it
/// failed, as without the library.
std::string run_script(const std::string& name, const std::vector<std::string>& arguments);

/// \name Objects in the formats of data sets
///@{
inline constexpr std::uint16_t kVoid = 65535;  ///< in a mask: the rover itself, not counted

/// Ids of objects by pixel; 0 is the static scene and the sky.
cv::Mat1w object_mask(const sim::FrameTruth& truth);

struct ObjectKind {
  std::string category;  ///< the actor's class, or its shape's class; object for all others
  int coco = 0;          ///< category_id
  int mot = 0;           ///< MOTChallenge's class; 8, distractor, for a category that it lacks
  bool moves = false;    ///< an actor with a motion
};

ObjectKind kind_of(const scenario::Scenario& scenario, const sim::Object& object);

/// The categories of a scenario by their ids, from 1: five that any scenario has, and the other
/// classes of its actors in their order.
std::vector<std::string> categories_of(const scenario::Scenario& scenario);
///@}

/// A use of sequences, and the formats that it takes.
struct Use {
  std::string_view name;
  std::vector<std::string> formats;
};
const std::vector<Use>& uses();

/// The bytes of a sequence, to a factor of two, by the number of its pixels and readings.
double estimated_bytes(const scenario::Scenario& scenario, const std::vector<std::string>& formats);

/// The README.md of a sequence: every file, unit, frame and axis.
std::string readme_text(const SequenceInfo& info, const std::vector<std::string>& formats);
inline constexpr const char* kReadmeFile = "README.md";

/// Path of the picture with a stamp, which is written for any formats.
std::string picture_path(std::int64_t stamp_ns, std::size_t place = 0);

}  // namespace lcs::sequence
