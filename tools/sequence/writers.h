/// \file
/// The writers, one for each format and each in its own file.
#pragma once

#include <memory>

#include "tools/sequence/writer.h"

namespace lcs::sequence {

/// Writes the pictures and their list, which every sequence has.
class PictureWriter : public Writer {
 public:
  void write(const FrameView& frame, FrameOutput& output) const override;
  std::vector<Document> documents() const override;
};

std::unique_ptr<Writer> make_euroc_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_kalibr_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_tum_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_mot_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_coco_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_davis_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_flow_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_depth_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_landmarks_writer(const SequenceInfo& info);

}  // namespace lcs::sequence
