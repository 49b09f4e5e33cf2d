#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "filter/detect/fast.h"
#include "filter/kinematics/geometry.h"
#include "scenarios/load.h"
#include "tests/bench/recorded_run.h"
#include "tests/tools/refusal.h"
#include "tools/bench/bench.h"
#include "tools/bench/ego_motion_feed.h"
#include "tools/comparators/detectors.h"
#include "tools/comparators/flow_detectors.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/scoring.h"

namespace lcs::comparators {
namespace {

using recording::Recording;

Recording run(std::string_view name, const char* file, std::vector<std::string> sets = {}) {
  const scenario::Scenario scenario = scenario::load(std::string(LCS_SCENARIOS_DIR "/") + file,
                                                     {.sets = std::move(sets), .seed = {}});
  sim::Simulation simulation(scenario);
  const auto made =
      detector(name).make(bench::intrinsics(simulation.calibration().camera), scenario);
  Recording recording{bench::run_info(scenario, simulation), {}};
  bench::run_into(recording, scenario, simulation, *made);
  return recording;
}

TEST(Detectors, AreKnownByNameAndOthersAreRefusedWithTheListOfThem) {
  for (const DetectorKind& each : detectors()) EXPECT_EQ(&detector(each.name), &each);
  EXPECT_EQ(test::refusal_of<std::invalid_argument>([] { detector("yolo"); }),
            "no detector is called 'yolo'; there are lcs, klt, dis");
}

TEST(DetectorSpec, IsADetectorOrTheFilterWithAPresetOfItsOwn) {
  EXPECT_EQ(&spec_of("klt").detector, &detector("klt"));
  EXPECT_EQ(spec_of("klt").preset, "");
  const DetectorSpec lab = spec_of("lcs:lab");
  EXPECT_EQ(lab.name, "lcs:lab");
  EXPECT_EQ(&lab.detector, &detector("lcs"));
  EXPECT_EQ(lab.preset, "lab");
  for (const auto& [name, said] :
       {std::pair{"lcs:street", "the filter has no preset 'street'; there are default"},
        {"lcs:", "the filter has no preset ''"},
        {"klt:lab", "klt has no presets, which are the filter's; give klt alone, or lcs:lab"},
        {"yolo:lab", "no detector is called 'yolo'"}}) {
    const std::string what = test::refusal_of<std::invalid_argument>([&] { spec_of(name); });
    EXPECT_NE(what.find(said), std::string::npos) << name << ": " << what;
  }
}

TEST(DetectorSpec, APresetStandsAloneWhateverTheScenarioAndSettingsSay) {
  const std::string file = std::string(LCS_SCENARIOS_DIR) + "/suite/night.yaml";
  const scenario::Scenario plain =
      scenario::load(file, {.sets = {"filter.preset=cars"}, .seed = {}});
  ASSERT_EQ(plain.filter_preset, "cars");
  scenario::Scenario unchanged = plain;
  EXPECT_TRUE(apply_preset(spec_of("lcs"), unchanged).empty());
  EXPECT_EQ(unchanged.filter_preset, "cars");

  scenario::Scenario with_lab = plain;
  apply_preset(spec_of("lcs:lab"), with_lab);
  scenario::Scenario set =
      scenario::load(file, {.sets = {"filter.circle.mu_0=20", "filter.preset=cars"}, .seed = {}});
  EXPECT_EQ(apply_preset(spec_of("lcs:lab"), set),
            (std::vector<std::string>{
                "filter.preset has no effect with lcs:lab, which is the preset alone",
                "filter.circle.mu_0 has no effect with lcs:lab, which is the preset "
                "alone"}));
  for (const scenario::Scenario& each : {with_lab, set}) {
    const auto infos = describe(bench::filter_parameters(each)), lab = describe(preset("lab"));
    ASSERT_EQ(infos.size(), lab.size());
    for (std::size_t i = 0; i < lab.size(); ++i) EXPECT_EQ(infos[i].value, lab[i].value);
  }
}

class EachDetector : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Names, EachDetector, testing::Values("lcs", "klt", "dis"),
                         [](const auto& test) { return test.param; });

TEST_P(EachDetector, SaysTheSameToTheLastBitInTwoRuns) {
  const Recording a = run(GetParam(), "crossing.yaml", {"frames=6"});
  const Recording b = run(GetParam(), "crossing.yaml", {"frames=6"});
  ASSERT_EQ(a.frames.size(), 6u);
  for (std::size_t k = 0; k < a.frames.size(); ++k) {
    EXPECT_EQ(a.frames[k].verdicts.size(), a.frames[k].corners_px.size());
    EXPECT_EQ(layers_line(a.frames[k]), layers_line(b.frames[k]));
  }
}

// ---- Geometry

constexpr int kWidth = 320, kHeight = 240;
const sim::Pinhole kCamera = sim::Pinhole::from_fovy(kWidth, kHeight, kPi / 3);
const Intrinsics kIntrinsics = bench::intrinsics(kCamera);

EgoMotion motion(const Eigen::Vector3d& v_C_mps, const Eigen::Vector3d& w_C_radps) {
  EgoMotion motion;
  motion.dt_s = 0.1;
  motion.v_C_mps = v_C_mps;
  motion.w_C_radps = w_C_radps;
  const Eigen::Vector3d turn = -w_C_radps * motion.dt_s;
  if (turn.norm() > 0) {
    motion.R_cur_prev = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  }
  return motion;
}

MotionField field_of(const EgoMotion& motion) {
  return exact_field(kIntrinsics, motion);
}

class EgoMotions : public testing::TestWithParam<EgoMotion> {};
INSTANTIATE_TEST_SUITE_P(
    Directions, EgoMotions,
    testing::Values(motion({0, 0, 0}, {0, 0, 0}), motion({0, 0, 0}, {0.1, -0.6, 0.2}),
                    motion({0, 0, 1}, {0, 0, 0}), motion({0, 0, -1}, {0, 0.3, 0}),
                    motion({1, 0, 0}, {0, 0, 0}), motion({0.4, -0.1, 0.9}, {0.1, 0.3, -0.2})));

/// Previous place of the point at `now_px` and a depth, rotation removed, px: computed from the
/// definition of the motion, not by the field.
Vec2 earlier(const EgoMotion& motion, const Vec2& now_px, double depth_m,
             const Eigen::Vector3d& own_motion_C_m = Eigen::Vector3d::Zero()) {
  const Eigen::Vector3d now = kCamera.back_project(now_px, depth_m);
  return kCamera.project(now + motion.v_C_mps * motion.dt_s - own_motion_C_m);
}

TEST_P(EgoMotions, StaticPointsLieOnTheSegmentAtEveryDepthFromTheNearest) {
  const MotionField field = field_of(GetParam());
  for (const Vec2& x : {Vec2(160, 120), Vec2(20, 30), Vec2(300, 110), Vec2(159.5, 239)}) {
    // In reverse the point was nearer in the previous frame, where the minimum depth holds as well.
    const double nearest_m = 0.8 + std::max(0.0, -GetParam().v_C_mps.z() * GetParam().dt_s);
    for (const double depth_m : {nearest_m, 1.0, 3.0, 10.0, 1e3, 1e9}) {
      EXPECT_LT(epipolar_distance(field, x, earlier(GetParam(), x, depth_m)), 1e-6)
          << "depth " << depth_m;
    }
  }
}

TEST_P(EgoMotions, APointThatMovesAcrossTheFieldIsAsFarFromTheSegmentAsItMoved) {
  // 5 cm at 3 m, perpendicular to the field's direction there.
  const MotionField field = field_of(GetParam());
  const Vec2 x(250, 60);
  const Vec2 along = field.moving() ? field.direction(x) : Vec2(1, 0);
  const Eigen::Vector3d own(-along.y() * 0.05, along.x() * 0.05, 0);
  const double expected_px = kCamera.focal_px * 0.05 / (3 + GetParam().v_C_mps.z() * 0.1);
  EXPECT_NEAR(epipolar_distance(field, x, earlier(GetParam(), x, 3, own)), expected_px, 0.05);
}

TEST(EpipolarDistance, APointNearerThanTheNearestDepthIsOffTheSegmentsEnd) {
  const EgoMotion ahead = motion({0, 0, 1}, {0, 0, 0});
  const MotionField field = field_of(ahead);
  const Vec2 x(250, 60);
  const double beyond = (earlier(ahead, x, 0.4) - earlier(ahead, x, 0.8)).norm();
  ASSERT_GT(beyond, 3);
  EXPECT_NEAR(epipolar_distance(field, x, earlier(ahead, x, 0.4)), beyond, 1e-6);
}

TEST(EpipolarDistance, AgainstTheFieldIsAsFarAsItWent) {
  // The far end of the segment is the corner itself.
  const MotionField field = field_of(motion({0, 0, 1}, {0, 0, 0}));
  const Vec2 x(250, 60);
  EXPECT_NEAR(epipolar_distance(field, x, x + 4 * field.direction(x)), 4, 1e-9);
}

TEST(EpipolarDistance, NothingStaticIsFartherThanTheGroundWhereThatIsKnown) {
  EgoMotion ahead = motion({0, 0, 1}, {0, 0, 0});
  const Vec2 below(250, 200), above(250, 60);
  const auto distance = [&](const Vec2& x, double depth_m) {
    return epipolar_distance(field_of(ahead), x, earlier(ahead, x, depth_m));
  };
  EXPECT_LT(distance(below, 20), 1e-9);
  constexpr double kHeight_m = 1;
  ahead.ground = Ground{.up_C = {0, -1, 0}, .height_m = kHeight_m};
  // Straight ahead: depth at which the ray of a row meets the ground.
  const double ground_m = kCamera.focal_px * kHeight_m / (below.y() - kCamera.centre_px.y());
  for (const double share : {0.5, 0.9, 1.0}) EXPECT_LT(distance(below, share * ground_m), 1e-9);
  const double beyond_px = (earlier(ahead, below, 20) - earlier(ahead, below, ground_m)).norm();
  ASSERT_GT(beyond_px, 2);
  // Up to the tolerance for sloping ground.
  EXPECT_GT(distance(below, 20), 0.9 * beyond_px);
  EXPECT_LE(distance(below, 20), beyond_px);
  for (const double depth_m : {1.0, 20.0, 1e9}) EXPECT_LT(distance(above, depth_m), 1e-9);
}

TEST(EpipolarDistance, OfGroundThatIsNearerThanTheNearestDepthIsThatFromItsEnd) {
  EgoMotion back = motion({0, 0, -1}, {0, 0, 0});
  back.ground = Ground{.up_C = {0, -1, 0}, .height_m = 0.1};
  const Vec2 x(250, 220);
  const Vec2 nearest = earlier(back, x, 0.8 + 0.1);
  EXPECT_LT(epipolar_distance(field_of(back), x, nearest), 1e-9);
  EXPECT_NEAR(epipolar_distance(field_of(back), x, nearest + Vec2(0, 3)), 3, 1e-9);
}

// ---- Detectors on synthetic pictures: a plane at 3 m before a moving camera.

constexpr double kPlane_m = 3;

/// Boxes of random grey: many corners, all different.
cv::Mat1b texture() {
  cv::Mat1b picture(2 * kHeight, 2 * kWidth, uchar{120});
  cv::RNG random(3);
  for (int i = 0; i < 900; ++i) {
    const cv::Point at(random.uniform(0, picture.cols), random.uniform(0, picture.rows));
    const cv::Size size(random.uniform(5, 16), random.uniform(5, 16));
    cv::rectangle(picture, {at, size}, random.uniform(0, 255), cv::FILLED);
  }
  cv::GaussianBlur(picture, picture, {3, 3}, 0.7);
  return picture;
}

cv::Matx33d matx(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

/// Picture of the plane after a motion: points of the first view map to
/// K (R - R t n' / d) K^-1 x, with the camera's way t in the first frame.
cv::Mat1b view(const EgoMotion& motion) {
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity(), to_picture = Eigen::Matrix3d::Identity();
  K(0, 0) = K(1, 1) = kCamera.focal_px;
  K.topRightCorner<2, 1>() = kCamera.centre_px;
  to_picture(0, 2) = kWidth / 2.0;
  to_picture(1, 2) = kHeight / 2.0;
  const Eigen::Vector3d displacement_C_m = motion.v_C_mps * motion.dt_s;
  const Eigen::Matrix3d H =
      K * (motion.R_cur_prev - displacement_C_m * Eigen::RowVector3d(0, 0, 1) / kPlane_m) *
      K.inverse() * to_picture.inverse();
  cv::Mat1b seen;
  cv::warpPerspective(texture(), seen, matx(H), {kWidth, kHeight}, cv::INTER_LINEAR);
  return seen;
}

cv::Point pixel(const Eigen::Vector2f& px) {
  return {static_cast<int>(px.x()), static_cast<int>(px.y())};
}

const cv::Rect kMover(200, 60, 60, 60);

/// Pastes another piece of texture at the mover's place plus `shift`; `slid` moves its content by
/// parts of a pixel.
void paste_mover(cv::Mat1b& seen, cv::Point shift, cv::Point2d slid = {}) {
  cv::Mat1b piece;
  const cv::Matx23d from(1, 0, 30 - slid.x, 0, 1, 30 - slid.y);
  cv::warpAffine(texture(), piece, from, kMover.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  piece.copyTo(seen(kMover + shift));
}

class DetectorTest : public testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<bench::Detector> make() const {
    if (GetParam() == std::string("klt")) return std::make_unique<KltDetector>(kIntrinsics);
    return std::make_unique<DisDetector>(kIntrinsics);
  }
  static std::vector<Eigen::Vector2f> corners_of(const cv::Mat1b& grey) {
    return FastDetector(20).detect(grey);
  }
  static FrameResult step(bench::Detector& detector, const cv::Mat1b& grey,
                          const std::vector<Eigen::Vector2f>& corners, const EgoMotion& motion) {
    cv::Mat3b colour;
    cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
    return detector.step({colour, grey, corners, motion});
  }
  static double share(const std::vector<Verdict>& verdicts, Verdict verdict) {
    const auto count = std::count(verdicts.begin(), verdicts.end(), verdict);
    return static_cast<double>(count) / static_cast<double>(verdicts.size());
  }
};
INSTANTIATE_TEST_SUITE_P(Names, DetectorTest, testing::Values("klt", "dis"),
                         [](const auto& test) { return test.param; });

TEST_P(DetectorTest, InAStillWorldNothingIsARebelHoweverTheCameraMoves) {
  for (const EgoMotion& ego : {motion({0, 0, 0}, {0, 0, 0}), motion({0, 0, 0}, {0.1, 0.4, 0.2}),
                               motion({0, 0, 1.5}, {0, 0, 0}), motion({0, 0, -1.5}, {0, 0, 0}),
                               motion({1, 0, 0}, {0, 0, 0}), motion({0.3, 0, 1}, {0, 0.3, 0})}) {
    const auto detector = make();
    const cv::Mat1b before = view({}), now = view(ego);
    step(*detector, before, corners_of(before), {});
    const auto corners = corners_of(now);
    const FrameResult said = step(*detector, now, corners, ego);
    ASSERT_GT(corners.size(), 100u);
    // Corners that just entered at the border have no place in the last image: any verdict
    // is valid.
    constexpr int kBorder = 20;
    const cv::Rect inner(kBorder, kBorder, kWidth - 2 * kBorder, kHeight - 2 * kBorder);
    int rebels = 0, normal = 0, all = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (!inner.contains(pixel(corners[i]))) continue;
      ++all;
      rebels += said.verdicts[i] == Verdict::rebel;
      normal += said.verdicts[i] == Verdict::normal;
    }
    EXPECT_EQ(rebels, 0);
    EXPECT_GT(normal, 0.95 * all);
    EXPECT_LT(share(said.verdicts, Verdict::rebel), 0.02);
  }
}

TEST_P(DetectorTest, AMoverAcrossTheFieldIsFoundAndBoxed) {
  const EgoMotion ego = motion({0, 0, 1}, {0, 0.1, 0});
  const auto detector = make();
  cv::Mat1b before = view({}), now = view(ego);
  paste_mover(before, {0, 0});
  paste_mover(now, {-7, 5});
  step(*detector, before, corners_of(before), {});
  const auto corners = corners_of(now);
  const FrameResult said = step(*detector, now, corners, ego);
  const cv::Rect mover = kMover + cv::Point(-7, 5), round_it(170, 40, 100, 110);
  int inside = 0, found = 0, far = 0, false_alarms = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const cv::Point px = pixel(corners[i]);
    const bool rebel = said.verdicts[i] == Verdict::rebel;
    if (mover.contains(px)) ++inside, found += rebel;
    if (!round_it.contains(px)) ++far, false_alarms += rebel;
  }
  ASSERT_GT(inside, 10);
  ASSERT_GT(far, 100);
  // A few windows on the outline cover more of the ground than of the mover.
  EXPECT_GT(found, 0.7 * inside);
  EXPECT_EQ(false_alarms, 0);
  double best = 0;
  for (const Square& box : said.layers.squares) {
    const cv::Rect2d square(box.location.x() - box.half_size.x(),
                            box.location.y() - box.half_size.y(), 2 * box.half_size.x(),
                            2 * box.half_size.y());
    const double common = (square & cv::Rect2d(mover)).area();
    best = std::max(best, common / (square.area() + mover.area() - common));
  }
  EXPECT_GT(best, 0.5);
  EXPECT_FALSE(said.layers.rebel_circles.empty());
}

/// At a high rate, so that several frames make a baseline.
constexpr double kFastFrame_s = 1.0 / 60;

TEST_P(DetectorTest, AtAHighRateAStillWorldHasNoRebelsWhileTheCameraTurnsAndGoes) {
  const auto detector = make();
  const auto pose = [](int k) {
    const double t_s = k * kFastFrame_s;
    return sim::Pose{
        Eigen::AngleAxisd(0.5 * t_s, Eigen::Vector3d(0.2, 1, 0.3).normalized()).toRotationMatrix(),
        Eigen::Vector3d(0.4, 0.1, 1) * t_s};
  };
  for (int k = 0; k < 8; ++k) {
    const cv::Mat1b seen = view(k == 0 ? EgoMotion() : bench::motion_between(pose(0), pose(k), 1));
    const auto corners = corners_of(seen);
    const FrameResult said =
        step(*detector, seen, corners,
             k == 0 ? EgoMotion() : bench::motion_between(pose(k - 1), pose(k), kFastFrame_s));
    ASSERT_GT(corners.size(), 100u);
    EXPECT_LT(share(said.verdicts, Verdict::rebel), 0.02) << "frame " << k;
    if (k > 0) {
      EXPECT_GT(share(said.verdicts, Verdict::normal), 0.9) << "frame " << k;
    }
  }
}

TEST_P(DetectorTest, AtAHighRateAMoverIsFoundThatMovesLittleFromFrameToFrame) {
  const auto detector = make();
  constexpr int kFrames = 8;
  int inside = 0, found = 0;
  for (int k = 0; k < kFrames; ++k) {
    cv::Mat1b seen = view({});
    // 0.8 px a frame, less than the minimum offset of a corner.
    paste_mover(seen, {0, 0}, {-0.8 * k, 0});
    EgoMotion still;
    still.dt_s = k == 0 ? 0 : kFastFrame_s;
    const auto corners = corners_of(seen);
    const FrameResult said = step(*detector, seen, corners, still);
    if (k + 1 < kFrames) continue;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (!kMover.contains(pixel(corners[i]))) continue;
      ++inside;
      found += said.verdicts[i] == Verdict::rebel;
    }
  }
  ASSERT_GT(inside, 10);
  EXPECT_GT(found, 0.6 * inside);
}

class DetectorOnGroundTest : public DetectorTest {};
INSTANTIATE_TEST_SUITE_P(Names, DetectorOnGroundTest, testing::Values("klt", "dis"),
                         [](const auto& test) { return test.param; });

TEST_P(DetectorOnGroundTest, CornersSeenBelowTheGroundAreRebels) {
  EgoMotion ego = motion({0, 0, 1.5}, {0, 0, 0});
  const cv::Mat1b before = view({}), now = view(ego);
  const auto corners = corners_of(now);
  for (const bool known : {false, true}) {
    // At this height the ground would hide the plane at 3 m, from the horizon down.
    if (known) ego.ground = Ground{.up_C = {0, -1, 0}, .height_m = 0.4};
    const auto detector = make();
    step(*detector, before, corners_of(before), {});
    const FrameResult said = step(*detector, now, corners, ego);
    int low = 0, low_rebels = 0, high_rebels = 0;
    const cv::Rect lower(20, 190, kWidth - 40, 30), upper(20, 20, kWidth - 40, 100);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const bool rebel = said.verdicts[i] == Verdict::rebel;
      if (lower.contains(pixel(corners[i]))) ++low, low_rebels += rebel;
      if (upper.contains(pixel(corners[i]))) high_rebels += rebel;
    }
    ASSERT_GT(low, 15);
    EXPECT_EQ(high_rebels, 0);
    if (known) {
      EXPECT_GE(low_rebels, 0.9 * low);
    } else {
      EXPECT_EQ(low_rebels, 0);
    }
  }
}

TEST_P(DetectorTest, TheFirstFrameIsPending) {
  const cv::Mat1b seen = view({});
  const FrameResult said = step(*make(), seen, corners_of(seen), {});
  EXPECT_GT(said.verdicts.size(), 100u);
  EXPECT_EQ(share(said.verdicts, Verdict::pending), 1);
  EXPECT_EQ(said.layers.dimension(), 0u);
}

TEST_P(DetectorTest, NoCornersAndOneCornerGetNoneAndOneVerdict) {
  const auto detector = make();
  const cv::Mat1b seen = view({});
  const std::vector<Eigen::Vector2f> none, one{corners_of(seen).at(50)};
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(step(*detector, seen, none, {}).verdicts.empty());
    EXPECT_EQ(step(*detector, seen, one, motion({0, 0, 1}, {0, 0, 0})).verdicts.size(), 1u);
  }
  EXPECT_EQ(step(*detector, seen, one, {}).verdicts, std::vector{Verdict::normal});
}

TEST_P(DetectorTest, CornersOnTexturelessGreyAreLostOrStandNoRebels) {
  const auto detector = make();
  const cv::Mat1b grey(kHeight, kWidth, uchar{128});
  std::vector<Eigen::Vector2f> corners;
  for (int i = 0; i < 40; ++i) {
    corners.emplace_back(static_cast<float>(8 * i), static_cast<float>(6 * i));
  }
  step(*detector, grey, corners, {});
  const FrameResult said = step(*detector, grey, corners, motion({0, 0, 1}, {0, 0, 0}));
  // Dense flow has a value everywhere: here, zero motion.
  const bool dense = GetParam() == std::string("dis");
  EXPECT_EQ(share(said.verdicts, dense ? Verdict::normal : Verdict::pending), 1);
}

TEST_P(DetectorTest, TheGlobalGeneratorOfRandomNumbersHasNoSay) {
  const auto said = [&](unsigned seed) {
    cv::theRNG().state = seed;
    const auto detector = make();
    cv::Mat1b before = view({}), now = view(motion({0, 0, 1}, {0, 0.1, 0}));
    paste_mover(before, {0, 0});
    paste_mover(now, {-7, 5});
    step(*detector, before, corners_of(before), {});
    recording::FrameRecord frame;
    frame.corners_px = corners_of(now);
    FrameResult result = step(*detector, now, frame.corners_px, motion({0, 0, 1}, {0, 0.1, 0}));
    frame.verdicts = result.verdicts;
    frame.layers = result.layers;
    return layers_line(frame);
  };
  EXPECT_EQ(said(1), said(77));
}

TEST(Dis, SaysTheSameHoweverManyThreadsThereAre) {
  const EgoMotion ego = motion({0.3, 0, 1}, {0, 0.3, 0});
  cv::Mat1b before = view({}), now = view(ego);
  paste_mover(now, {-7, 5});
  const auto corners = FastDetector(20).detect(now);
  const int threads = cv::getNumThreads();
  std::vector<std::string> lines;
  for (const int count : {1, 2, 5}) {
    cv::setNumThreads(count);
    DisDetector detector(kIntrinsics);
    detector.step({cv::Mat3b(), before, {}, {}});
    recording::FrameRecord frame;
    frame.corners_px = corners;
    const FrameResult& said = detector.step({cv::Mat3b(), now, corners, ego});
    frame.verdicts = said.verdicts;
    frame.layers = said.layers;
    lines.push_back(layers_line(frame));
  }
  cv::setNumThreads(threads);
  EXPECT_EQ(lines[0], lines[1]);
  EXPECT_EQ(lines[0], lines[2]);
}

TEST(Dis, TakesTheSmallestPictures) {
  for (const cv::Size size : {cv::Size(16, 16), cv::Size(16, 320), cv::Size(40, 24)}) {
    DisDetector detector(
        bench::intrinsics(sim::Pinhole::from_fovy(size.width, size.height, kPi / 3)));
    const cv::Mat1b seen = texture()(cv::Rect({0, 0}, size)).clone();
    const std::vector<Eigen::Vector2f> corners{{8, 8}, {4, 10}};
    detector.step({cv::Mat3b(), seen, corners, {}});
    const FrameResult& said =
        detector.step({cv::Mat3b(), seen, corners, motion({0, 0, 0}, {0, 0, 0})});
    EXPECT_EQ(said.verdicts, std::vector(2, Verdict::normal));
  }
}

TEST(Detectors, RefuseParametersOutOfTheirRange) {
  EXPECT_THROW(KltDetector(kIntrinsics, {.window_px = 12}), std::invalid_argument);
  EXPECT_THROW(KltDetector(kIntrinsics, {.levels = -1}), std::invalid_argument);
  EXPECT_THROW(KltDetector(kIntrinsics, {.baseline_s = -1}), std::invalid_argument);
  EXPECT_THROW(RebelGroups({.reach_px = 0}), std::invalid_argument);
  EXPECT_THROW(RebelGroups({.least_corners = 0}), std::invalid_argument);
  DisParameters dis;
  dis.baseline_s = std::nan("");
  EXPECT_THROW(DisDetector(kIntrinsics, dis), std::invalid_argument);
}

// ---- Flow

TEST(KltDetector, FindsWhereCornersWere) {
  cv::Mat1b before = view({}), now = before.clone();
  paste_mover(now, {0, 0});  // covers the old place
  const auto corners = FastDetector(20).detect(now);
  // By this turn, which the pictures do not have, the guesses are off by about (2, -1) px.
  const EgoMotion turned =
      motion({0, 0, 0}, {10 / kIntrinsics.focal_px, 20 / kIntrinsics.focal_px, 0});

  KltDetector flow(kIntrinsics, {.residual_px = 10});
  const FrameResult& first = flow.step({cv::Mat3b(), before, corners, {}});
  EXPECT_EQ(first.verdicts, std::vector(corners.size(), Verdict::pending));
  const FrameResult& seen = flow.step({cv::Mat3b(), now, corners, turned});
  const MotionField field = exact_field(kIntrinsics, turned);
  int followed = 0;
  for (const Edge& edge : seen.layers.normal_edges) {
    const Eigen::Vector2f& corner = corners[static_cast<std::size_t>(edge.corner)];
    const cv::Point px = pixel(corner);
    if (kMover.contains(px) || (px.x >= 180 && px.y <= 140)) continue;
    ++followed;
    EXPECT_LT((edge.origin - field.rotated(corner.cast<double>())).norm(), 0.1) << px;
  }
  EXPECT_GT(followed, 10);
}

// ---- Groups

class GroupsTest : public testing::Test {
 protected:
  /// Adds a row of corners 20 px apart from `first` that all move by `step`.
  void row(Vec2 first, int count, Vec2 step) {
    for (int i = 0; i < count; ++i) {
      // Zigzag, so that the box has an area.
      corners_.push_back((first + Vec2(20 * i, 20 * (i % 2))).cast<float>());
      motions_.push_back({.known = true, .off = true, .step_px = step});
    }
  }
  const FrameResult& group() { return groups_.group(corners_, motions_, 0.1); }
  void clear() {
    corners_.clear();
    motions_.clear();
  }

  RebelGroups groups_{GroupParameters{}};
  std::vector<Eigen::Vector2f> corners_;
  std::vector<CornerMotion> motions_;
};

TEST_F(GroupsTest, CornersNearEachOtherAndOfLikeStepAreOneBox) {
  row({100, 100}, 5, {4, 0});
  const FrameResult& said = group();
  EXPECT_EQ(said.verdicts, std::vector<Verdict>(5, Verdict::rebel));
  ASSERT_EQ(said.layers.squares.size(), 1u);
  EXPECT_EQ(said.layers.squares[0].location, Vec2(140, 110));
  EXPECT_EQ(said.layers.squares[0].half_size, Vec2(40, 10));
  ASSERT_EQ(said.layers.rebel_circles.size(), 1u);
  EXPECT_EQ(said.layers.rebel_circles[0].members, 5);
  EXPECT_NEAR(said.layers.rebel_circles[0].radius, std::hypot(40, 10), 1e-12);
  EXPECT_DOUBLE_EQ(said.layers.rebel_circles[0].speed, 40);
}

TEST_F(GroupsTest, CornersFarApartOrOfUnlikeStepAreNot) {
  row({100, 100}, 5, {4, 0});
  row({100, 260}, 5, {4, 0});  // farther than the reach of 120
  row({500, 100}, 5, {4, 0});
  row({505, 105}, 5, {-4, 0});  // among the first row
  EXPECT_EQ(group().layers.squares.size(), 4u);
}

TEST_F(GroupsTest, FewerThanAGroupAreNormal) {
  row({100, 100}, 4, {4, 0});
  const FrameResult& said = group();
  EXPECT_EQ(said.verdicts, std::vector<Verdict>(4, Verdict::normal));
  EXPECT_TRUE(said.layers.rebel_circles.empty());
}

TEST_F(GroupsTest, LostCornersArePendingAndThoseInTheFieldNormal) {
  row({100, 100}, 7, {4, 0});
  motions_[0] = {};
  motions_[1].off = false;
  EXPECT_EQ(group().verdicts,
            (std::vector{Verdict::pending, Verdict::normal, Verdict::rebel, Verdict::rebel,
                         Verdict::rebel, Verdict::rebel, Verdict::rebel}));
}

TEST_F(GroupsTest, ABoxKeepsItsIdWhileItOverlapsItself) {
  row({100, 100}, 5, {4, 0});
  row({400, 300}, 5, {0, 4});
  ASSERT_EQ(group().layers.squares.size(), 2u);
  const Id left = group().layers.squares[0].id, right = group().layers.squares[1].id;
  EXPECT_NE(left, right);
  // The left group moves on, the right one jumps, and their order is swapped.
  clear();
  row({400, 100}, 5, {0, 4});
  row({108, 102}, 5, {4, 0});
  const FrameResult& said = group();
  ASSERT_EQ(said.layers.squares.size(), 2u);
  EXPECT_EQ(said.layers.squares[1].id, left);
  EXPECT_NE(said.layers.squares[0].id, left);
  EXPECT_NE(said.layers.squares[0].id, right);
}

// ---- Performance

/// Measured on the whole scenario: 0.85, less a margin for another OpenCV.
TEST(Yardstick, OnTheCrossingKltIsWorthComparingWith) {
  const scoring::Metrics klt = scoring::score(run("klt", "crossing.yaml"));
  EXPECT_GT(scoring::value(klt, "rebel.f1").value(), 0.81);
  EXPECT_GT(scoring::value(klt, "square.recall_50_movers").value(), 0.8);
  EXPECT_LT(scoring::value(klt, "rebel.false_objects_per_100_frames").value(), 5);
}

}  // namespace
}  // namespace lcs::comparators
