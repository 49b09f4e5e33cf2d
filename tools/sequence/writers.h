/// \file
/// The writers, one for each format; those of like formats share a file.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "tools/sequence/writer.h"

namespace lcs::sequence {

/// Makes a writer. \throws input::Error if the sequence cannot have the format.
extern const MakeWriter make_picture_writer, make_euroc_writer, make_kalibr_writer,
    make_kitti_writer, make_tum_writer, make_mcap_writer, make_rpg_writer, make_dsec_writer,
    make_mot_writer, make_coco_writer, make_davis_writer, make_flow_writer, make_depth_writer,
    make_landmarks_writer;

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
