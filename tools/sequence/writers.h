/// \file
/// The writers, one for each format and each in its own file.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tools/sequence/writer.h"

namespace lcs::sequence {

/// Writes the pictures and their list, which every sequence has, and their exposures if these
/// change.
class PictureWriter : public Writer {
 public:
  using Writer::Writer;
  void write(const FrameView& frame, FrameOutput& output) const override;
  std::vector<Document> documents() const override;
};

/// Makes a writer. \throws input::Error if the sequence cannot have the format.
MakeWriter make_euroc_writer, make_kalibr_writer, make_kitti_writer, make_tum_writer,
    make_mcap_writer, make_rpg_writer, make_dsec_writer, make_mot_writer, make_coco_writer,
    make_davis_writer, make_flow_writer, make_depth_writer, make_landmarks_writer;

/// \name The bag of `make_mcap_writer`, whose document has JSON in place of its bytes.
///@{
inline constexpr const char* kBagFile = "rosbag/rosbag.mcap";
/// The version of the library that writes it. \throws std::runtime_error with its installation if
/// it is missing.
std::string bag_library();
/// \param messages the document. \param sequence folder of the pictures.
/// \param out new folder: `kBagFile` with its metadata. \throws std::runtime_error
void write_bag(const std::filesystem::path& messages, const std::filesystem::path& sequence,
               const std::filesystem::path& out);
///@}

/// \name The HDF5 of `make_dsec_writer`, whose document has text in place of its bytes.
///@{
inline constexpr const char* kDsecFile = "dsec/events.h5";
/// As `bag_library`.
std::string hdf5_library();
/// \param rows the document. \param out new folder, which gets the file.
/// \throws std::runtime_error
void write_hdf5(const std::filesystem::path& rows, const std::filesystem::path& out);
///@}

/// Runs a Python script of this folder, by which formats with libraries for Python are written.
/// \param name of the script's file. \return its standard output.
/// \throws std::runtime_error with the message of a script that failed.
std::string run_script(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace lcs::sequence
