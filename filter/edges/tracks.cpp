#include "filter/edges/tracks.h"

namespace lcs {

Eigen::Matrix2d Tracks::static_spread(std::size_t track, double noise2_px2) const {
  Eigen::Matrix2d spread;
  spread << at(kGivenXx, track), at(kGivenXy, track), at(kGivenXy, track), at(kGivenYy, track);
  const Vec2 g = point(kByDepthX, track);
  return spread + double{at(kDepthVariance, track)} * g * g.transpose() +
         noise2_px2 * Eigen::Matrix2d::Identity();
}

void Tracks::append(const Tracks& from, std::size_t track) {
  for (std::size_t column = 0; column < kTrackColumns; ++column) {
    columns[column][size()] = from.columns[column][track];
  }
  records.push_back(from.records[track]);
}

TrackFrame track_frame(const Intrinsics& camera, const MotionField& field,
                       const EdgeParameters& parameters) {
  TrackFrame frame;
  const auto narrow = [](double value) { return static_cast<float>(value); };
  frame.focal_px = narrow(camera.focal_px);
  frame.centre_x_px = narrow(camera.centre_px.x());
  frame.centre_y_px = narrow(camera.centre_px.y());
  const Eigen::Vector3d d = field.displacement_C_m();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      frame.R[row][column] = narrow(field.R_cur_prev()(row, column));
    frame.displacement_m[row] = narrow(d[row]);
  }
  frame.dt_s = narrow(field.dt_s());
  frame.most_pm = narrow(field.max_ratio() / field.reference_depth_m());
  const auto& known = field.ground();
  frame.ground[0] = known ? narrow(-known->up_C.z() / known->height_m) : 0;
  frame.ground[1] = known ? narrow(-known->up_C.x() / known->height_m) : 0;
  frame.ground[2] = known ? narrow(-known->up_C.y() / known->height_m) : 0;
  frame.slack_pm = narrow(field.ground_slack() / field.reference_depth_m());
  frame.ego_share = narrow(parameters.ego_share);
  frame.turnover_ps = narrow(parameters.turnover_ps);
  frame.turnover = narrow(parameters.turnover(field.dt_s()));
  frame.kind_turnover = narrow(parameters.kind_turnover(field.dt_s()));
  frame.prior = narrow(parameters.prior);
  frame.first_odds =
      narrow(parameters.prior / (1 - parameters.prior) * std::exp(parameters.newcomer));
  frame.most_log_odds = narrow(parameters.most_log_odds(field.dt_s()));
  frame.usual_weight = narrow(parameters.neighbours);
  frame.max_speed_pxps = narrow(parameters.max_speed_pxps);
  frame.reach_area_px2 = narrow(parameters.reach_area_px2(field.dt_s()));
  frame.crossings = narrow(parameters.crossings);
  frame.slide = narrow(parameters.slide);
  return frame;
}

}  // namespace lcs
