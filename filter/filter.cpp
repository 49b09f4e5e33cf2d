#include "filter/filter.h"

#include "filter/stages.h"

namespace lcs {

struct Filter::Impl {
  Stages stages;
  Frame frame;  // carried on in place
};

Filter::Filter(const Intrinsics& camera, const Parameters& parameters)
    : impl_(new Impl{Stages(camera, parameters), {}}) {}
Filter::~Filter() = default;
Filter::Filter(Filter&&) noexcept = default;
Filter& Filter::operator=(Filter&&) noexcept = default;

const FrameResult& Filter::step(std::span<const Eigen::Vector2f> corners_px,
                                const EgoMotion& motion) {
  Frame& frame = impl_->frame;
  impl_->stages.line(corners_px, motion, frame);
  impl_->stages.circle(frame);
  impl_->stages.square(frame);
  return frame.result;
}

const Diagnostics& Filter::diagnostics() const {
  return impl_->stages.diagnostics();
}

}  // namespace lcs
