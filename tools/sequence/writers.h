/// \file
/// The writers, one a format; each is in a file of its own.
#pragma once

#include <memory>

#include "tools/sequence/writer.h"

namespace lcs::sequence {

/// The pictures and their list, which belong to every sequence.
class PictureWriter : public Writer {
 public:
  void write(const FrameView& frame, FrameOutput& output) const override;
  std::vector<Document> documents() const override;
};

std::unique_ptr<Writer> make_euroc_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_tum_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_mot_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_coco_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_davis_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_flow_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_depth_writer(const SequenceInfo& info);
std::unique_ptr<Writer> make_landmarks_writer(const SequenceInfo& info);

}  // namespace lcs::sequence
