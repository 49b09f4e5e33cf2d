/// Bad data during a run: nothing throws, all faults are counted and named, results stay finite,
/// and the filter recovers fully within a stated number of frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "filter/filter.h"
#include "tests/filter/invariants.h"
#include "tests/filter/presets.h"
#include "tests/filter/same_result.h"
#include "tests/filter/small_drive.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using testing::expect_same;
using testing::Random;
using testing::record;
using testing::Scene;
using testing::violation;
using Corners = std::vector<Vector2f>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfF = std::numeric_limits<float>::infinity();

struct BadData : testing::OfEachPreset {};
INSTANTIATE_TEST_SUITE_P(Presets, BadData, testing::each_preset(), testing::name_of_preset);

struct BadMotion {
  const char* name;
  Fault fault;
  std::function<void(EgoMotion&)> spoil;
};

std::vector<BadMotion> bad_motions() {
  return {
      {"no time", Fault::motion_not_finite, [](EgoMotion& m) { m.dt_s = kNan; }},
      {"for ever", Fault::motion_not_finite, [](EgoMotion& m) { m.dt_s = kInf; }},
      {"back", Fault::time_back, [](EgoMotion& m) { m.dt_s = -0.1; }},
      {"far back", Fault::time_back, [](EgoMotion& m) { m.dt_s = -1e300; }},
      {"jump", Fault::time_jump, [](EgoMotion& m) { m.dt_s = 61; }},
      {"far jump", Fault::time_jump, [](EgoMotion& m) { m.dt_s = 1e300; }},
      {"no velocity", Fault::motion_not_finite, [](EgoMotion& m) { m.v_C_mps.y() = kNan; }},
      {"infinite velocity", Fault::motion_not_finite, [](EgoMotion& m) { m.v_C_mps.z() = -kInf; }},
      {"huge velocity", Fault::motion_too_fast, [](EgoMotion& m) { m.v_C_mps.x() = 1e300; }},
      {"too fast", Fault::motion_too_fast, [](EgoMotion& m) { m.v_C_mps.z() = 1001; }},
      {"no rate", Fault::motion_not_finite, [](EgoMotion& m) { m.w_C_radps.x() = kNan; }},
      {"no unseen turn", Fault::motion_not_finite, [](EgoMotion& m) { m.unseen_turn_rad = kNan; }},
      {"no sigma", Fault::motion_not_finite, [](EgoMotion& m) { m.velocity_sigma_mps = kInf; }},
      {"negative sigma", Fault::motion_not_finite,
       [](EgoMotion& m) { m.velocity_sigma_mps = -0.01; }},
      {"negative unseen turn", Fault::motion_not_finite,
       [](EgoMotion& m) { m.unseen_turn_rad = -1e300; }},
      {"huge sigma", Fault::motion_too_fast, [](EgoMotion& m) { m.velocity_sigma_mps = 1e200; }},
      {"huge unseen turn", Fault::motion_too_fast, [](EgoMotion& m) { m.unseen_turn_rad = 1e300; }},
      {"huge rate", Fault::motion_too_fast, [](EgoMotion& m) { m.w_C_radps.x() = -1e200; }},
      {"rotation not finite", Fault::motion_not_finite,
       [](EgoMotion& m) { m.R_cur_prev(1, 2) = kNan; }},
      {"rotation of zeros", Fault::motion_no_rotation,
       [](EgoMotion& m) { m.R_cur_prev.setZero(); }},
      {"scaled rotation", Fault::motion_no_rotation, [](EgoMotion& m) { m.R_cur_prev *= 1.01; }},
      {"huge rotation", Fault::motion_no_rotation, [](EgoMotion& m) { m.R_cur_prev *= 1e300; }},
      {"mirrored rotation", Fault::motion_no_rotation,
       [](EgoMotion& m) { m.R_cur_prev.col(0) *= -1; }},
  };
}

TEST_P(BadData, AfterAMotionThatIsNoneItGivesWhatANewFilterGives) {
  for (const BadMotion& bad : bad_motions()) {
    SCOPED_TRACE(bad.name);
    Scene scene(21);
    const auto frames = record(scene, 12);
    AnyFilter filter(scene.world.camera, parameters()), fresh(scene.world.camera, parameters());
    constexpr std::size_t kBad = 6;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      EgoMotion motion = k == 0 ? EgoMotion{} : scene.motion;
      if (k == kBad) bad.spoil(motion);
      const FrameResult& result = filter.step(frames[k], motion);
      ASSERT_EQ(violation(result, frames[k].size(), scene.world.camera, parameters()),
                std::nullopt);
      if (k >= kBad) {
        expect_same(result, fresh.step(frames[k], k == kBad ? EgoMotion{} : motion), k);
      }
    }
    EXPECT_EQ(filter.diagnostics().count(bad.fault), 1);
    EXPECT_EQ(filter.diagnostics().total(), 1);
    EXPECT_EQ(fresh.diagnostics().total(), 0);
  }
}

TEST(BadDataOfAnyKind, RebelsAreFoundAgainInTheFrameAfterTheLastBadMotion) {
  Scene scene(13);
  const auto frames = record(scene, 10);
  const auto bad = bad_motions();
  Filter filter(scene.world.camera);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EgoMotion motion = k == 0 ? EgoMotion{} : scene.motion;
    if (k >= 4 && k < 8) bad[k].spoil(motion);  // the last one is frame 7
    const FrameResult& result = filter.step(frames[k], motion);
    const auto rebels = std::count(result.verdicts.begin(), result.verdicts.end(), Verdict::rebel);
    if (k >= 4 && k < 8) {
      EXPECT_EQ(rebels, 0) << "frame " << k;
    } else if (k > 0) {
      EXPECT_GE(rebels, 15) << "of 20, frame " << k;
    }
  }
  EXPECT_EQ(filter.diagnostics().total(), 4);
}

/// Invalid corners, each with its fault.
const std::vector<std::pair<Vector2f, Fault>>& no_corners() {
  static const std::vector<std::pair<Vector2f, Fault>> corners = {
      {{kNanF, 100}, Fault::corner_not_finite},   {{100, -kInfF}, Fault::corner_not_finite},
      {{kInfF, kNanF}, Fault::corner_not_finite}, {{-0.6F, 100}, Fault::corner_outside},
      {{100, 479.6F}, Fault::corner_outside},     {{640, 100}, Fault::corner_outside},
      {{3e38F, -3e38F}, Fault::corner_outside},   {{-1e9F, 0}, Fault::corner_outside},
  };
  return corners;
}

TEST_P(BadData, InvalidCornersLeaveNoTrace) {
  Scene scene(22);
  const auto frames = record(scene, 12);
  AnyFilter filter(scene.world.camera, parameters()), clean(scene.world.camera, parameters());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const EgoMotion motion = k == 0 ? EgoMotion{} : scene.motion;
    Corners corners = frames[k];
    for (const auto& bad : no_corners()) corners.push_back(bad.first);
    FrameResult result = filter.step(corners, motion);
    ASSERT_EQ(violation(result, corners.size(), scene.world.camera, parameters()), std::nullopt);
    for (std::size_t i = frames[k].size(); i < corners.size(); ++i) {
      EXPECT_EQ(result.verdicts[i], Verdict::pending);
      const Fault fault = no_corners()[i - frames[k].size()].second;
      EXPECT_EQ(result.reasons[i],
                fault == Fault::corner_outside ? Reason::outside : Reason::not_finite);
    }
    result.verdicts.resize(frames[k].size());
    result.reasons.resize(frames[k].size());
    expect_same(result, clean.step(frames[k], motion), k);
  }
  EXPECT_EQ(filter.diagnostics().count(Fault::corner_not_finite), 3 * 12);
  EXPECT_EQ(filter.diagnostics().count(Fault::corner_outside), 5 * 12);
  EXPECT_EQ(filter.diagnostics().total(), 8 * 12);
}

TEST_P(BadData, ACornerThatComesTwiceCountsOnceAndBothGetItsVerdict) {
  Scene scene(23);
  const auto frames = record(scene, 10);
  AnyFilter filter(scene.world.camera, parameters()), once(scene.world.camera, parameters());
  std::int64_t repeated = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const EgoMotion motion = k == 0 ? EgoMotion{} : scene.motion;
    Corners corners = frames[k];
    corners.insert(corners.end(), frames[k].begin(), frames[k].end());
    FrameResult result = filter.step(corners, motion);
    const std::size_t count = frames[k].size();
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(result.verdicts[i], result.verdicts[count + i]);
      EXPECT_EQ(result.reasons[i], result.reasons[count + i]);
      repeated += result.verdicts[i] != Verdict::ignored;  // ignored ones were not processed
    }
    result.verdicts.resize(count);
    result.reasons.resize(count);
    expect_same(result, once.step(frames[k], motion), k);
  }
  EXPECT_EQ(filter.diagnostics().count(Fault::corner_repeated), repeated);
  EXPECT_EQ(filter.diagnostics().total(), repeated);
}

/// Number of rebels among the moving corners of a scene, which come last.
long found(const FrameResult& result) {
  return std::count(result.verdicts.end() - 20, result.verdicts.end(), Verdict::rebel);
}

TEST(BadDataOfAnyKind, AHundredThousandCornersAreBoundedAndForgottenWhenTheyHaveCoasted) {
  // A third of all pixels: most corners are rejected, and the processed ones are everywhere,
  // so that chance explains every motion.
  Random random(24);
  Corners flood;
  for (int i = 0; i < 100'000; ++i) {
    flood.emplace_back(static_cast<float>(random.uniform(0, 639)),
                       static_cast<float>(random.uniform(0, 479)));
  }
  Scene scene(13);
  const auto frames = record(scene, 12);
  Parameters parameters;
  parameters.line.max_corners = 5000;
  const std::size_t kCoast = parameters.edge.coast;
  AnyFilter filter(scene.world.camera, parameters);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const bool is_flood = k == 4 || k == 5;
    const Corners& corners = is_flood ? flood : frames[k];
    const FrameResult& result = filter.step(corners, k == 0 ? EgoMotion{} : scene.motion);
    ASSERT_EQ(violation(result, corners.size(), scene.world.camera, parameters), std::nullopt);
    if (k == 3) {
      EXPECT_GE(found(result), 15) << "of 20";
    }
    if (k > 6 + kCoast) {
      const std::size_t edges =
          result.layers.normal_edges.size() + result.layers.rebel_edges.size();
      EXPECT_LE(edges, (1 + kCoast) * frames[k - kCoast].size()) << "frame " << k;
      EXPECT_EQ(std::count(result.verdicts.begin(), result.verdicts.end() - 20, Verdict::rebel), 0)
          << "frame " << k;
    }
  }
  EXPECT_EQ(filter.diagnostics().count(Fault::corner_too_many),
            2 * (100'000 - parameters.line.max_corners));
}

TEST_P(BadData, ATimeThatStandsStillIsCountedAndForgottenThreeFramesLater) {
  Scene scene(13);
  const auto frames = record(scene, 12);
  AnyFilter filter(scene.world.camera, parameters()), without(scene.world.camera, parameters());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const EgoMotion motion = k == 0 ? EgoMotion{} : scene.motion;
    if (k == 6) {  // the same picture three times
      for (int i = 0; i < 2; ++i) {
        const FrameResult& same = filter.step(frames[5], EgoMotion{});
        ASSERT_EQ(violation(same, frames[5].size(), scene.world.camera, parameters()),
                  std::nullopt);
      }
    }
    const auto found_with = found(filter.step(frames[k], motion));
    const auto found_without = found(without.step(frames[k], motion));
    if (k >= 9) {
      EXPECT_GE(found_with, found_without - 2) << "of 20, frame " << k;
    }
  }
  EXPECT_EQ(filter.diagnostics().count(Fault::time_still), 2);
  EXPECT_EQ(filter.diagnostics().total(), 2);
}

TEST(BadDataOfAnyKind, AGroundThatIsNoneIsNotUsed) {
  const std::array<Ground, 7> none = {{{.up_C = {0, -1, 0}, .height_m = kNan},
                                       {.up_C = {0, -1, 0}, .height_m = -1},
                                       {.up_C = {0, -1, 0}, .height_m = 0},
                                       {.up_C = {0, -1, 0}, .height_m = 1e300},
                                       {.up_C = {0, kNan, 0}, .height_m = 1},
                                       {.up_C = {0, 0, 0}, .height_m = 1},
                                       {.up_C = {0, -3, 0}, .height_m = 1}}};
  Scene scene(26);
  const auto frames = record(scene, 8);
  Filter filter(scene.world.camera), clean(scene.world.camera, Parameters{});
  for (std::size_t k = 1; k < frames.size(); ++k) {
    EgoMotion motion = scene.motion;
    motion.ground = none[k - 1];
    expect_same(filter.step(frames[k], motion), clean.step(frames[k], scene.motion), k);
  }
  EXPECT_EQ(filter.diagnostics().count(Fault::ground_unusable), 7);
  EXPECT_EQ(filter.diagnostics().total(), 7);
}

TEST_P(BadData, AHundredFramesOfEveryFaultAtOnceAreSurvivedAndForgotten) {
  Random random(27);
  const auto bad = bad_motions();
  Scene scene(27);
  const auto frames = record(scene, 8);
  AnyFilter filter(scene.world.camera, parameters()), fresh(scene.world.camera, parameters());
  const auto pick = [&](std::size_t count) {
    return static_cast<std::size_t>(random.uniform(0, static_cast<double>(count)));
  };
  for (int k = 0; k < 100; ++k) {
    Corners corners;
    for (std::size_t i = pick(200); i > 0; --i) {
      const float size = static_cast<float>(std::pow(10, random.uniform(0, 5)));
      corners.push_back(size * Vector2f(static_cast<float>(random.uniform(-1, 1)),
                                        static_cast<float>(random.uniform(-1, 1))));
      if (i % 7 == 0) corners.push_back(no_corners()[pick(no_corners().size())].first);
      if (i % 5 == 0) corners.push_back(corners.front());
    }
    EgoMotion motion = testing::steady_motion(random.vector(900), random.vector(900),
                                              std::pow(10, random.uniform(-9, 1.7)));
    if (k % 3 != 0) bad[pick(bad.size())].spoil(motion);
    const FrameResult& result = filter.step(corners, motion);
    ASSERT_EQ(violation(result, corners.size(), scene.world.camera, parameters()), std::nullopt)
        << "frame " << k;
  }
  EgoMotion lost;
  lost.dt_s = -1;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    expect_same(filter.step(frames[k], k == 0 ? lost : scene.motion),
                fresh.step(frames[k], k == 0 ? EgoMotion{} : scene.motion), k);
  }
}

TEST(BadDataOfAnyKind, ACameraThatIsNoneIsRefused) {
  const Intrinsics good = testing::vga();
  const auto refuses = [&](auto spoil) {
    Intrinsics camera = good;
    spoil(camera);
    EXPECT_THROW(Filter(camera, Parameters{}), std::invalid_argument);
  };
  refuses([](Intrinsics& c) { c.focal_px = kNan; });
  refuses([](Intrinsics& c) { c.focal_px = kInf; });
  refuses([](Intrinsics& c) { c.focal_px = -400; });
  refuses([](Intrinsics& c) { c.centre_px.x() = kNan; });
  refuses([](Intrinsics& c) { c.centre_px.y() = kInf; });
  refuses([](Intrinsics& c) { c.width_px = -640; });
  refuses([](Intrinsics& c) { c.height_px = 0; });
}

/// Both ends of each range, and each word, if valid together with the other parameters.
TEST_P(BadData, TheFilterWorksAtBothEndsOfEveryRange) {
  int tried = 0;
  for (const ParameterInfo& info : describe(parameters())) {
    std::string_view words = info.range;
    const std::string_view between = words.find(" to ") < words.size() ? " to " : ", ";
    while (!words.empty()) {
      const std::size_t end = std::min(words.find(between), words.size());
      const std::string_view word = words.substr(0, end);
      words.remove_prefix(std::min(end + between.size(), words.size()));
      AnyParameters at_its_end = parameters();
      set(at_its_end, info.key, word);
      try {
        validate(at_its_end);
      } catch (const std::invalid_argument&) {
        continue;
      }
      const auto what = testing::violation_on_a_small_drive(at_its_end);
      EXPECT_FALSE(what) << info.key << "=" << word << ": " << *what;
      ++tried;
    }
  }
  EXPECT_GT(tried, std::ssize(describe(parameters())));
}

TEST(BadDataOfAnyKind, ParametersThatAreNoNumbersAreRefused) {
  for (const double value : {kNan, kInf, -kInf, 1e300}) {
    Parameters parameters;
    parameters.edge.neighbour_reach_px = value;
    EXPECT_THROW(Filter(testing::vga(), parameters), std::invalid_argument);
    parameters = Parameters{};
    parameters.field.reference_depth_m = value;
    EXPECT_THROW(Filter(testing::vga(), parameters), std::invalid_argument);
  }
  Parameters parameters;
  parameters.field.rotation = static_cast<RotationModel>(7);
  EXPECT_THROW(Filter(testing::vga(), parameters), std::invalid_argument);
}

TEST(Diagnostics, HaveAWordAndAMeaningOfTheirOwnAndTellWhatWasMet) {
  for (std::size_t i = 0; i < kFaults.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_STRNE(kFaults[i].word, kFaults[j].word);
      EXPECT_STRNE(kFaults[i].meaning, kFaults[j].meaning);
    }
  }
  Diagnostics met;
  EXPECT_TRUE(met.lines().empty());
  met.add(Fault::corner_outside, 3);
  Diagnostics more;
  more.add(Fault::imu_gap);
  met += more;
  EXPECT_EQ(met.lines(),
            (std::vector<std::string>{
                "3 corners are outside of the picture: left out (corner_outside)",
                "1 gaps are in the readings of the IMU, in which the last one is held (imu_gap)"}));
}

}  // namespace
}  // namespace lcs
