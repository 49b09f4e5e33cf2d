#include "filter/filter.h"

#include <stdexcept>
#include <string>

#include "filter/stages.h"

namespace lcs {

struct Filter::Impl {
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& motion) {
    stages.line(corners_px, signatures, motion, frame);
    stages.circle(frame);
    stages.square(frame);
    return frame.result;
  }

  Stages stages;
  Frame frame = {};  // carried on in place
};

Filter::Filter(const Intrinsics& camera, const Parameters& parameters)
    : impl_(new Impl{Stages(camera, parameters)}) {}
Filter::~Filter() = default;
Filter::Filter(Filter&&) noexcept = default;
Filter& Filter::operator=(Filter&&) noexcept = default;

const FrameResult& Filter::step(std::span<const Eigen::Vector2f> corners_px,
                                const EgoMotion& motion) {
  return impl_->step(corners_px, {}, motion);
}

const FrameResult& Filter::step(std::span<const Eigen::Vector2f> corners_px,
                                std::span<const Signature> signatures, const EgoMotion& motion) {
  if (signatures.size() != corners_px.size()) {
    throw std::invalid_argument("the filter was given " + std::to_string(signatures.size()) +
                                " signatures for " + std::to_string(corners_px.size()) +
                                " corners; give one for each");
  }
  return impl_->step(corners_px, signatures, motion);
}

const Diagnostics& Filter::diagnostics() const {
  return impl_->stages.diagnostics();
}

}  // namespace lcs
