/// \file
/// The writers, one for each format; those of like formats share a file.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "tools/sequence/writer.h"

namespace lcs::sequence {

MakeWriter picture_writer, euroc_writer, kalibr_writer, kitti_writer, tum_writer, mcap_writer,
    rpg_writer, dsec_writer, mot_writer, coco_writer, davis_writer, flow_writer, depth_writer,
    landmarks_writer;

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
inline constexpr const char *kBagFile = "rosbag/rosbag.mcap", *kDsecFile = "dsec/events.h5";
inline constexpr std::array<Scripted, 2> kScripted{
    {{"mcap", "rosbags", kBagFile, "write_bag.py", true},
     {"dsec", "h5py", kDsecFile, "write_events.py", false}}};

/// Runs the script. \return its standard output. \throws std::runtime_error with its message if it
/// failed, as without the library.
std::string run_script(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace lcs::sequence
