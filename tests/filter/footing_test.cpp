/// What stands on nothing moves: bodies that no two frames tell from static ones.
#include "filter/footing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "filter/filter.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector3d;
using testing::Random;
using testing::steady_motion;
using testing::vga;
using testing::World;

constexpr double kHeight_m = 0.45;

/// A level camera that drives ahead over a floor. C has y down: the floor lies at y = height.
class Drive {
 public:
  using Settings = std::vector<std::pair<const char*, const char*>>;

  explicit Drive(const Settings& settings = {}, const Ground& told = {.height_m = kHeight_m}) {
    Parameters parameters = preset("default");
    for (const auto& [key, value] : settings) set(parameters, key, value);
    filter_ = Filter(vga(), parameters);
    motion_.ground = told;
  }

  /// Corners all over an upright patch of 0.5 m whose foot is `foot_m` above the floor; `scale`
  /// times as wide, and the corners as far apart.
  void stand(double x_m, double z_m, double foot_m, double top_m,
             const Vector3d& velocity = Vector3d::Zero(), double scale = 1) {
    const int first = static_cast<int>(world_.points.size());
    const double jitter = 0.03 * scale;
    for (double y = foot_m; y <= top_m + 1e-9; y += 0.12 * scale) {
      for (double x = -0.25 * scale; x <= 0.25 * scale; x += 0.12 * scale) {
        // The lowest row stands on the foot itself.
        const double up = y == foot_m ? y : y + random_.uniform(-jitter, jitter);
        world_.points.push_back(
            {{x_m + x + random_.uniform(-jitter, jitter), kHeight_m - up, z_m}, velocity});
      }
    }
    bodies_.push_back({first, static_cast<int>(world_.points.size())});
  }

  /// A corner by itself.
  void corner(double x_m, double z_m, double up_m) {
    world_.points.push_back({{x_m, kHeight_m - up_m, z_m}});
  }

  void stop(std::size_t body) {
    for (int i = bodies_[body].first; i < bodies_[body].second; ++i) {
      world_.points[i].velocity_C.setZero();
    }
  }

  void frames(int count) {
    for (int k = 0; k < count; ++k) {
      if (started_) world_.advance(motion_);
      verdicts_ = filter_.step(world_.corners(), started_ ? motion_ : EgoMotion{}).verdicts;
      started_ = true;
    }
  }

  /// Share of a body's corners in view that are rebels now.
  double rebels(std::size_t body) const {
    int corner = 0, seen = 0, rebel = 0;
    for (int i = 0; i < static_cast<int>(world_.points.size()); ++i) {
      if (!world_.image(world_.points[i])) continue;
      if (i >= bodies_[body].first && i < bodies_[body].second) {
        ++seen;
        rebel += verdicts_[corner] == Verdict::rebel;
      }
      ++corner;
    }
    return seen == 0 ? 0 : static_cast<double>(rebel) / seen;
  }

 private:
  Random random_{1};
  World world_;
  std::vector<std::pair<int, int>> bodies_;
  EgoMotion motion_ = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
  Filter filter_{vga(), preset("default")};
  std::vector<Verdict> verdicts_;
  bool started_ = false;
};

TEST(Footing, ABodyThatComesHeadOnIsToldByItsFeetAlone) {
  for (const char* ground : {"true", "false"}) {
    Drive drive(Drive::Settings{{"field.ground", ground}});
    drive.stand(0, 6, 0, 1.6, {0, 0, -0.7});
    drive.frames(15);
    if (std::string(ground) == "true") {
      EXPECT_GT(drive.rebels(0), 0.9);
    } else {
      EXPECT_EQ(drive.rebels(0), 0) << "its image is that of a static body at 0.3 of its distance";
    }
  }
}

TEST(Footing, ABodyThatRunsAheadIsFartherThanTheGroundThatItHides) {
  for (const char* ground : {"true", "false"}) {
    Drive drive(Drive::Settings{{"field.ground", ground}});
    drive.stand(0, 4, 0, 1, {0, 0, 0.3});  // as fast as the camera: its image stands still
    drive.frames(25);
    if (std::string(ground) == "true") {
      // But for the corners about the focus of expansion: they show no depth.
      EXPECT_GT(drive.rebels(0), 0.6);
    } else {
      EXPECT_EQ(drive.rebels(0), 0);
    }
  }
}

TEST(Footing, ABodyThatGoesAheadMoreSlowlyThanTheCameraIsFartherThanTheGroundThatItHides) {
  for (const char* ground : {"true", "false"}) {
    Drive drive(Drive::Settings{{"field.ground", ground}});
    drive.stand(0.3, 2.5, 0, 1.4, {0, 0, 0.2});
    drive.frames(15);
    if (std::string(ground) == "true") {
      EXPECT_GT(drive.rebels(0), 0.9);
    } else {
      EXPECT_EQ(drive.rebels(0), 0) << "its image is that of a static body at 3 times its distance";
    }
  }
}

TEST(Footing, WhatIsFarBeyondARunnerDoesNotRunWithIt) {
  // Both seem to be infinitely far; the runner's feet alone are below the ground.
  for (const char* overhang : {"0.3", "1000"}) {
    Drive drive(Drive::Settings{{"footing.overhang", overhang}});
    drive.stand(0, 4, 0, 1, {0, 0, 0.3});
    drive.stand(27, 200, 0, 27, Vector3d::Zero(), 27);
    drive.frames(25);
    EXPECT_GT(drive.rebels(0), 0.6);
    if (std::string(overhang) == "0.3") {
      EXPECT_LT(drive.rebels(1), 0.05);
    } else {
      EXPECT_GT(drive.rebels(1), 0.2);
    }
  }
}

TEST(Footing, WhatStandsIsNoRebelWhereverItStands) {
  Drive drive;
  for (int i = 0; i < 7; ++i) drive.stand(-3 + i, 3 + 0.7 * (i % 4), 0, 0.5 + 0.2 * i);
  for (int k = 0; k < 25; ++k) {
    drive.frames(1);
    for (std::size_t body = 0; body < 7; ++body) EXPECT_EQ(drive.rebels(body), 0) << k;
  }
}

TEST(Footing, NorIsItWhereTheGroundIsOffByHalfADegree) {
  for (const double tilt_rad : {-0.009, 0.009}) {
    const Vector3d up = testing::rotation({tilt_rad, 0, 0}) * Vector3d(0, -1, 0);
    Drive drive({}, {.up_C = up, .height_m = kHeight_m});
    for (int i = 0; i < 5; ++i) drive.stand(-2 + i, 3 + 0.5 * i, 0, 1);
    for (int k = 0; k < 25; ++k) {
      drive.frames(1);
      for (std::size_t body = 0; body < 5; ++body) EXPECT_EQ(drive.rebels(body), 0) << k;
    }
  }
}

TEST(Footing, WhatHangsAboveTheHorizonHasNoFootToSee) {
  Drive drive;
  drive.stand(0, 3, 0.6, 1.2);  // a picture on a wall
  for (int k = 0; k < 20; ++k) {
    drive.frames(1);
    EXPECT_EQ(drive.rebels(0), 0);
  }
}

TEST(Footing, WhatIsSeenBelowAGroupMayBearIt) {
  // A box on a shelf whose foot alone stands on the floor; the shelf is somewhat deeper, so that it
  // is a group of its own.
  for (const bool borne : {true, false}) {
    Drive drive;
    drive.stand(0, 2.5, 0.3, 0.9);
    if (borne) drive.stand(0, 2.15, 0, 0.13);
    drive.frames(15);
    EXPECT_EQ(drive.rebels(0) > 0.5, !borne);
  }
}

TEST(Footing, OneLowCornerIsAFootUnlessItLiesOnTheGround) {
  // What a body stands on may be smooth but for one corner. A corner on the ground is there
  // whatever hangs above it.
  for (const double up_m : {0.1, 0.0}) {
    Drive drive;
    drive.stand(0, 2.5, 0.3, 0.9);
    drive.corner(0.1, 2.5, up_m);
    drive.frames(15);
    EXPECT_EQ(drive.rebels(0) > 0.5, up_m == 0) << up_m << " m: " << drive.rebels(0);
  }
}

TEST(Footing, AnIncomerThatStopsIsNormalAgain) {
  Drive drive;
  drive.stand(0, 7, 0, 1.6, {0, 0, -0.7});
  drive.frames(20);
  ASSERT_GT(drive.rebels(0), 0.9);
  drive.stop(0);
  drive.frames(25);
  EXPECT_LT(drive.rebels(0), 0.1);
}

/// Normal edges of a group that seems to be 1 m away, and so aloft.
std::vector<Edge> aloft() {
  std::vector<Edge> edges(10);
  for (int i = 0; i < 10; ++i) {
    Edge& edge = edges[i];
    edge.corner = i;
    edge.location = {300.0 + 4 * i, 300.0 + 3 * (i % 3)};
    edge.path.ratio = 3;
    edge.path.weight = 1e4;
  }
  return edges;
}

TEST(Footing, WhatHasJustComeIntoViewNeedNotHaveShownItsFoot) {
  // 0.24 s are 2 frames of 0.1 s, and twice that is what half of the group must have been seen for.
  EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
  motion.ground = Ground{.height_m = kHeight_m};
  for (const int old : {4, 5}) {
    std::vector<Edge> normals = aloft(), none;
    for (int i = 0; i < 10; ++i) normals[i].age = i < old ? 5 : 4;
    Footing(vga(), {}).judge(normals, none, MotionField(vga(), motion, {}));
    for (const Edge& edge : normals) EXPECT_EQ(edge.unfounded, old == 5) << old;
  }
}

TEST(Footing, WhatTheSideOfThePictureCutsOffNeedNotShowItsFoot) {
  EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
  motion.ground = Ground{.height_m = kHeight_m};
  const auto counted = [&](double leftmost_px, double rightmost_px) {
    std::vector<Edge> normals = aloft(), none;
    const auto [left, right] = std::minmax_element(
        normals.begin(), normals.end(),
        [](const Edge& a, const Edge& b) { return a.location.x() < b.location.x(); });
    const double from = left->location.x(), width = right->location.x() - from;
    for (Edge& edge : normals) {
      edge.age = 10;
      edge.location.x() =
          leftmost_px + (edge.location.x() - from) * (rightmost_px - leftmost_px) / width;
    }
    Footing(vga(), {}).judge(normals, none, MotionField(vga(), motion, {}));
    return normals.front().unfounded;
  };
  EXPECT_EQ(counted(30, 110), 1);
  EXPECT_EQ(counted(10, 90), 0);
  EXPECT_EQ(counted(530, 610), 1);
  EXPECT_EQ(counted(550, 630), 0);
}

TEST(Footing, CornersOfOneLineAreNotSunk) {
  // A line is drawn as stairs of pixels: corners that are no points of it, and slide along.
  EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
  motion.ground = Ground{.height_m = kHeight_m};
  for (const double bent_px : {0.0, 3.0}) {
    std::vector<Edge> normals = aloft(), none;
    for (int i = 0; i < 10; ++i) {
      normals[i].age = 10;
      normals[i].location = {300.0 + 7 * i, std::round(300 + 0.3 * 7 * i) + bent_px * (i % 2)};
      normals[i].path.ratio = 0.4;  // where the ground's is .9 and more
    }
    Footing(vga(), {}).judge(normals, none, MotionField(vga(), motion, {}));
    for (const Edge& edge : normals) EXPECT_EQ(edge.unfounded, bent_px > 0) << bent_px;
  }
}

TEST(Footing, SaysNothingWhileTheCameraStandsOrCrawlsOrTheGroundIsNotKnown) {
  std::vector<Edge> edges = aloft(), none;
  for (Edge& edge : edges) edge.unfounded = 1;
  EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
  const auto counted = [&] {
    std::vector<Edge> normals = edges;
    Footing(vga(), {}).judge(normals, none, MotionField(vga(), motion, {}));
    return normals.front().unfounded;
  };
  EXPECT_EQ(counted(), 1) << "no ground";
  motion.ground = Ground{.height_m = kHeight_m};
  EXPECT_EQ(counted(), 2);
  motion.v_C_mps.setZero();
  EXPECT_EQ(counted(), 1) << "standing";
  motion.v_C_mps = {0, 0, 0.05};
  EXPECT_EQ(counted(), 1) << "crawling, at a speed that is hardly known";
  motion.v_C_mps = {0, 0, 0.3};
  motion.ground->up_C = {0, -0.3, -0.95};
  EXPECT_EQ(counted(), 1) << "looking down";
}

}  // namespace
}  // namespace lcs
