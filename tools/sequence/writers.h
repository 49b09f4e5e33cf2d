/// \file
/// The writers, one for each format and each in its own file.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "tools/sequence/writer.h"

namespace lcs::sequence {

/// Writes the pictures and their list, which every sequence has, and their exposures if these
/// change.
class PictureWriter : public Writer {
 public:
  explicit PictureWriter(const SequenceInfo& info) : info_(info) {}
  void write(const FrameView& frame, FrameOutput& output) const override;
  std::vector<Document> documents() const override;

 private:
  SequenceInfo info_;
};

std::unique_ptr<Writer> make_euroc_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_kalibr_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_kitti_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_tum_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_mcap_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_rpg_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_dsec_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_mot_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_coco_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_davis_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_flow_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_depth_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_landmarks_writer(const SequenceInfo& info);

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

}  // namespace lcs::sequence
