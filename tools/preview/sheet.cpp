#include "tools/preview/sheet.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "scenarios/load.h"
#include "scenes/worlds/families.h"
#include "scenes/worlds/kit.h"
#include "scenes/worlds/worlds.h"
#include "sim/simulation.h"
#include "sim/world/actor.h"

namespace lcs::preview {
namespace {

using worlds::Body;
using worlds::Part;
using worlds::RoverPath;
using worlds::Stand;
using worlds::towards;
using worlds::TurnedBox;
using worlds::Vector2d;
using worlds::Vector3d;
using worlds::way_of;

constexpr std::array<std::pair<int, int>, 4> kCorners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
constexpr int kWidth = 480, kHeight = 360;
const cv::Scalar kMoves(255, 0, 255), kStands(0, 200, 0), kRover(220, 80, 0), kWall(120, 120, 120),
    kThing(225, 225, 225), kInk(0, 0, 0), kPaper(255, 255, 255);

void write_on(cv::Mat3b& tile, const std::string& text, const cv::Point& at) {
  for (const auto& [colour, width] : {std::pair{kPaper, 3}, {kInk, 1}}) {
    cv::putText(tile, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, colour, width, cv::LINE_AA);
  }
}

/// Scales the picture to fit, centred.
void paint_shot(const Shot& shot, cv::Mat3b tile) {
  const double zoom = std::min(static_cast<double>(tile.cols) / shot.picture.cols,
                               static_cast<double>(tile.rows) / shot.picture.rows);
  const cv::Size size(cvRound(shot.picture.cols * zoom), cvRound(shot.picture.rows * zoom));
  const cv::Point corner((tile.cols - size.width) / 2, (tile.rows - size.height) / 2);
  cv::Mat3b inside = tile(cv::Rect(corner, size));
  cv::resize(shot.picture, inside, size, 0, 0, zoom < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  const double scale = shot.scale * zoom;
  for (const bool moving : {false, true}) {  // movers on top
    for (const sim::ObjectTruth& object : shot.objects) {
      if (object.moving != moving) continue;
      cv::rectangle(inside, {cvRound(object.left * scale), cvRound(object.top * scale)},
                    {cvRound(object.right * scale) - 1, cvRound(object.bottom * scale) - 1},
                    moving ? kMoves : kStands, 1);
    }
  }
  write_on(inside, fmt::format("frame {}", shot.frame), {6, size.height - 8});
}

/// Puts the place of a part or body into its box.
TurnedBox at_place(TurnedBox box, const Vector3d& position_m, const Eigen::Quaterniond& rotation) {
  const Vector2d ahead = (rotation * Vector3d::UnitX()).head<2>();
  box.centre_m = position_m.head<2>();
  box.heading_rad = std::atan2(ahead.y(), ahead.x());
  return box;
}

/// Static parts of a world, in plan view.
std::vector<TurnedBox> walls_of(const worlds::DrawnWorld& world) {
  std::vector<TurnedBox> boxes;
  for (const Part& part : world.setting) {
    if (part.is_solid) continue;
    Part own = part;
    own.position_m.setZero();
    own.rotation.setIdentity();
    const TurnedBox box = bounds(world, {own});
    const double foot = box.foot_m + part.position_m.z();
    if (foot > 1.2 || box.head_m - box.foot_m < 0.2) continue;  // ceilings and floor marks
    boxes.push_back(at_place(box, part.position_m, part.rotation));
  }
  return boxes;
}

/// Positions of a mover in each frame.
std::vector<Vector2d> path_of(const scenario::Actor& actor, const TurnedBox& at_rest,
                              const RoverPath& way) {
  std::vector<Vector2d> path;
  for (const Stand& stand : way.frames) {
    path.push_back(sim::pose_on(actor.trajectory, {at_rest.centre_m, at_rest.heading_rad},
                                stand.t_s - actor.start.at_s)
                       .position_m);
  }
  return path;
}

/// Draws a scale bar of a round length, at most a fifth of the tile.
void paint_scale(cv::Mat3b& tile, double pixels_per_m) {
  double length_m = 0.1;
  for (const double next_m : {0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
    if (next_m * pixels_per_m <= 0.2 * kWidth) length_m = next_m;
  }
  const cv::Point end(kWidth - 10, kHeight - 10);
  const cv::Point begin(end.x - cvRound(length_m * pixels_per_m), end.y);
  cv::line(tile, begin, end, kInk, 2);
  write_on(tile, fmt::format("{} m", length_m), {begin.x, begin.y - 6});
}

}  // namespace

cv::Mat3b plan(const worlds::DrawnWorld& world) {
  constexpr double kMargin_px = 8, kAhead_m = 6, kAround_m = 2;
  const RoverPath way = way_of(world.scenario);
  const scenario::Camera& camera = world.scenario.camera;
  const std::vector<TurnedBox> walls = walls_of(world);

  Eigen::AlignedBox2d all, shown;
  const auto add_box = [&](const TurnedBox& box) {
    for (const auto& [x, y] : kCorners) all.extend(point_of(box, x, y, 0).head<2>());
  };
  for (const TurnedBox& wall : walls) add_box(wall);
  for (const Stand& stand : way.frames) {
    shown.extend(stand.at_m);
    shown.extend(stand.at_m + kAhead_m * towards(stand.heading_rad));
  }
  struct Standing {
    TurnedBox box;
    std::vector<Vector2d> path;  // of a mover
  };
  const std::vector<scenario::Actor>& actors = world.scenario.actors;
  std::vector<Standing> things;
  for (const Body& body : world.bodies) {
    Standing& thing = things.emplace_back();
    thing.box = at_place(bounds(world, body.parts), body.position_m, body.rotation);
    add_box(thing.box);
    const auto actor = std::ranges::find(actors, body.name, &scenario::Actor::body);
    if (actor != actors.end()) thing.path = path_of(*actor, thing.box, way);
    for (const Vector2d& point : thing.path) shown.extend(point);
  }
  all.extend(shown);
  shown.min().array() -= kAround_m;
  shown.max().array() += kAround_m;
  shown.clamp(all);

  cv::Mat3b tile(kHeight, kWidth, cv::Vec3b(255, 255, 255));
  const Vector2d middle = shown.center(), size = shown.sizes();
  const double scale = std::min((kWidth - 2 * kMargin_px) / std::max(size.x(), 1.0),
                                (kHeight - 2 * kMargin_px) / std::max(size.y(), 1.0));
  const auto pixel = [&](const Vector2d& p) {
    return cv::Point(cvRound(kWidth / 2.0 + scale * (p.x() - middle.x())),
                     cvRound(kHeight / 2.0 - scale * (p.y() - middle.y())));
  };
  const auto outline = [&](const TurnedBox& box) {
    std::vector<cv::Point> corners;
    for (const auto& [x, y] : kCorners) {
      corners.push_back(pixel(point_of(box, x, y, 0).head<2>()));
    }
    return corners;
  };
  for (const TurnedBox& wall : walls)
    cv::polylines(tile, outline(wall), true, kWall, 1, cv::LINE_AA);
  for (const Standing& thing : things) {
    if (thing.path.empty()) cv::fillConvexPoly(tile, outline(thing.box), kThing);
    cv::polylines(tile, outline(thing.box), true, thing.path.empty() ? kWall : kMoves, 1,
                  cv::LINE_AA);
  }
  const double half_fov_rad =
      std::atan(std::tan(camera.fovy_rad / 2) * camera.width_px / camera.height_px);
  for (const Stand* stand : {&way.frames.front(), &way.frames.back()}) {
    const Vector2d eye = camera_at(camera, *stand, 0).head<2>();
    for (const double side : {-1.0, 1.0}) {
      cv::line(tile, pixel(eye),
               pixel(eye + 1.5 * towards(stand->heading_rad + side * half_fov_rad)), kRover, 1,
               cv::LINE_AA);
    }
  }
  for (const Stand& stand : way.frames) {
    cv::circle(tile, pixel(camera_at(camera, stand, 0).head<2>()), 2, kRover, cv::FILLED);
  }
  for (const Standing& thing : things) {
    for (std::size_t k = 0; k + 1 < thing.path.size(); ++k) {
      if ((thing.path[k + 1] - thing.path[k]).norm() < 1e-4) continue;
      cv::circle(tile, pixel(thing.path[k]), 2, kMoves, cv::FILLED);
    }
  }
  paint_scale(tile, scale);
  write_on(tile,
           fmt::format("{}: {}x{}, {} Hz, {} frames", name_of(world), camera.width_px,
                       camera.height_px, camera.rate_hz, world.scenario.frames),
           {8, 14});
  return tile;
}

std::array<int, 3> frames_shown(int frames) {
  return {0, frames / 2, frames - 1};
}

cv::Mat3b contact_sheet(const Shots& shots, const cv::Mat3b& plan, int columns) {
  const int tiles = static_cast<int>(shots.size()) + 1;
  cv::Mat3b sheet((tiles + columns - 1) / columns * kHeight, columns * kWidth,
                  cv::Vec3b(255, 255, 255));
  const auto tile = [&](int place) {
    return cv::Mat3b(
        sheet(cv::Rect(place % columns * kWidth, place / columns * kHeight, kWidth, kHeight)));
  };
  int place = 0;
  for (const Shot& shot : shots) paint_shot(shot, tile(place++));
  if (plan.size() == cv::Size(kWidth, kHeight)) plan.copyTo(tile(place));
  return sheet;
}

Shots simulated_shots(const std::filesystem::path& file) {
  const scenario::Scenario scenario = scenario::load(file);
  const std::array<int, 3> shown = frames_shown(scenario.frames);
  sim::Simulation simulation(scenario);
  Shots shots;
  int k = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    for (; k < shown[i]; ++k) simulation.skip();
    const sim::Observation o = *simulation.next();
    ++k;
    shots[i] = {shown[i], o.image.clone(), 1, o.objects};
  }
  return shots;
}

}  // namespace lcs::preview
