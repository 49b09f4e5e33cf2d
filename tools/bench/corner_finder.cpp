#include "tools/bench/corner_finder.h"

namespace lcs::bench {

std::vector<Eigen::Vector2f> CornerFinder::find(const cv::Mat1b& grey,
                                                std::span<const sim::Event> events) {
  if (!is_by_events_) return fast_.detect(grey);
  if (!events_) events_.emplace(grey.cols, grey.rows);
  for (const sim::Event& event : events) events_->add(event.x, event.y, event.t_ns, event.is_on);
  return events_->step();
}

std::optional<cv::Mat1b> CornerFinder::surface() const {
  if (!events_) return std::nullopt;
  return events_->arc_star().picture();
}

}  // namespace lcs::bench
