#include "tools/worlds/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

#include "scenarios/load.h"
#include "sim/drive.h"
#include "sim/simulation.h"
#include "tools/worlds/kit.h"
#include "tools/worlds/worlds.h"

namespace lcs::worlds {
namespace {

using Eigen::Vector2d;
constexpr std::array<std::pair<int, int>, 4> kCorners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
constexpr int kWidth = 480, kHeight = 360;
const cv::Scalar kMoves(255, 0, 255), kStands(0, 200, 0), kRover(220, 80, 0);

void fit(const cv::Mat3b& picture, cv::Mat3b tile) {
  const double scale = std::min(static_cast<double>(tile.cols) / picture.cols,
                                static_cast<double>(tile.rows) / picture.rows);
  const cv::Size size(static_cast<int>(picture.cols * scale),
                      static_cast<int>(picture.rows * scale));
  cv::resize(picture, tile(cv::Rect({0, 0}, size)), size, 0, 0, cv::INTER_AREA);
}

cv::Mat3b with_boxes(const sim::Observation& o) {
  cv::Mat3b picture = o.image.clone();
  for (const sim::ObjectTruth& object : o.objects) {
    cv::rectangle(picture, {object.left, object.top}, {object.right - 1, object.bottom - 1},
                  object.moving ? kMoves : kStands, 1);
  }
  return picture;
}

cv::Mat3b plan(const World& world, const sim::Drive& drive) {
  constexpr double kMargin_px = 8;
  std::vector<std::pair<Box, bool>> boxes;  // and whether it moves
  Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  const auto add = [&](Box box, const Vector2d& at, const Eigen::Quaterniond& rotation,
                       bool moves) {
    const Vector2d ahead = (rotation * Eigen::Vector3d::UnitX()).head<2>();
    box.centre_m = at;
    box.heading_rad = std::atan2(ahead.y(), ahead.x());
    boxes.emplace_back(box, moves);
    for (const auto& [x, y] : kCorners) {
      const Vector2d corner = point_of(box, x, y, 0).head<2>();
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  };
  for (const Part& part : world.setting) {
    if (part.is_solid) continue;
    Part own = part;
    own.position_m.setZero();
    own.rotation.setIdentity();
    const Box box = bounds(world, {own});
    const double foot = box.foot_m + part.position_m.z();
    if (foot > 1.2 || box.head_m - box.foot_m < 0.2) continue;  // ceilings and marks
    add(box, part.position_m.head<2>(), part.rotation, false);
  }
  for (const Body& body : world.bodies) {
    const bool moves =
        std::any_of(world.scenario.actors.begin(), world.scenario.actors.end(),
                    [&](const scenario::Actor& actor) { return actor.body == body.name; });
    add(bounds(world, body.parts), body.position_m.head<2>(), body.rotation, moves);
  }
  cv::Mat3b tile(kHeight, kWidth, cv::Vec3b(255, 255, 255));
  const double scale = std::min((kWidth - 2 * kMargin_px) / (high.x() - low.x() + 1),
                                (kHeight - 2 * kMargin_px) / (high.y() - low.y() + 1));
  const auto pixel = [&](const Vector2d& p) {
    return cv::Point(static_cast<int>(kMargin_px + scale * (p.x() - low.x() + 0.5)),
                     static_cast<int>(kHeight - kMargin_px - scale * (p.y() - low.y() + 0.5)));
  };
  for (const auto& [box, moves] : boxes) {
    std::vector<cv::Point> corners;
    for (const auto& [x, y] : kCorners) {
      corners.push_back(pixel(point_of(box, x, y, 0).head<2>()));
    }
    cv::polylines(tile, corners, true, moves ? kMoves : cv::Scalar(120, 120, 120), 1);
  }
  for (const sim::Observation& o : drive.frames) {
    cv::circle(tile, pixel(o.truth.now.T_WC.p.head<2>()), 2, kRover, cv::FILLED);
    for (std::size_t i = 1; i < o.truth.now.T_WO.size(); ++i) {
      if (!sim::moved(o.truth.now.T_WO[i], o.truth.next.T_WO[i])) continue;
      cv::circle(tile, pixel(o.truth.now.T_WO[i].p.head<2>()), 2, kMoves, cv::FILLED);
    }
  }
  for (const std::size_t k : {std::size_t{0}, drive.frames.size() - 1}) {  // where it looks
    const sim::Pose& T_WC = drive.frames[k].truth.now.T_WC;
    cv::arrowedLine(tile, pixel(T_WC.p.head<2>()),
                    pixel(T_WC.p.head<2>() + 0.8 * T_WC.R.col(2).head<2>()), kRover, 1);
  }
  return tile;
}

}  // namespace

cv::Mat3b contact_sheet(const World& world, const std::filesystem::path& file) {
  const scenario::Scenario scenario = scenario::load(file);
  cv::Mat3b sheet(2 * kHeight, 2 * kWidth, cv::Vec3b(255, 255, 255));
  sim::Simulation simulation(scenario);
  int tile = 0;
  for (int k = 0; k < scenario.frames; ++k) {
    if (k != 0 && k != scenario.frames / 2 && k != scenario.frames - 1) {
      simulation.skip();
      continue;
    }
    fit(with_boxes(*simulation.next()),
        sheet(cv::Rect(tile % 2 * kWidth, tile / 2 * kHeight, kWidth, kHeight)));
    ++tile;
  }
  cv::Mat3b above = plan(world, sim::drive(scenario));
  cv::putText(above,
              fmt::format("{}: {}x{}, {} Hz, {} frames", name_of(world), scenario.camera.width_px,
                          scenario.camera.height_px, scenario.camera.rate_hz, scenario.frames),
              {8, 14}, cv::FONT_HERSHEY_SIMPLEX, 0.45, {0, 0, 0}, 1, cv::LINE_AA);
  above.copyTo(sheet(cv::Rect(kWidth, kHeight, kWidth, kHeight)));
  return sheet;
}

}  // namespace lcs::worlds
