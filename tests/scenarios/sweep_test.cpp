#include "scenarios/sweep.h"

#include <gtest/gtest.h>

#include "tests/scenarios/scenario_file.h"
#include "tests/tools/refusal.h"

namespace lcs::scenario {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

std::vector<SweepPoint> points_of(const std::string& lines) {
  const ScenarioFolder folder;
  return sweep_points(folder.write("test.yaml", smallest + lines));
}

/// The error message for a sweep, without the folder's name. The lines begin at line 4.
std::string sweep_refusal(const std::string& lines) {
  const ScenarioFolder folder;
  const auto file = folder.write("test.yaml", smallest + lines);
  return without_folder(test::refusal_of<input::Error>([&] { sweep_points(file); }), folder);
}

TEST(Groups, AreShortUnlessTheFileSays) {
  EXPECT_EQ(load_text(smallest).groups, std::vector<std::string>{"short"});
  EXPECT_EQ(load_text(smallest + "groups: [long, night-2]\n").groups,
            (std::vector<std::string>{"long", "night-2"}));
}

TEST(Groups, InvalidGroupsAreRefusedAtTheirLine) {
  EXPECT_EQ(refusal(smallest + "groups: short\n"),
            "test.yaml:4: groups is a single value; give a list, as in [...]");
  EXPECT_EQ(refusal(smallest + "groups: []\n"),
            "test.yaml:4: groups is an empty list; give one or more, or remove the key");
  EXPECT_EQ(refusal(smallest + "groups:\n  - short\n  - short\n"),
            "test.yaml:6: groups has 'short' twice; remove one");
  EXPECT_EQ(refusal(smallest + "groups: [Short run]\n"),
            "test.yaml:4: the group 'Short run' has other characters than a-z, 0-9, '_' and '-'; "
            "rename it");
}

TEST(Sweep, AScenarioThatSweepsNothingHasOnePointWithoutSettings) {
  const std::vector<SweepPoint> points = points_of("");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_TRUE(points[0].settings.empty());
}

TEST(Sweep, TheGridHasEveryPairOnceTheLastKeyFastest) {
  const std::vector<SweepPoint> points =
      points_of("sweep:\n  ego.speed: [0.2 m/s, 0.4]\n  camera.rate: [1, 5 Hz, 10]\n");
  ASSERT_EQ(points.size(), 6u);
  const auto at = [](const char* speed, const char* rate) {
    return Settings{{"ego.speed", speed}, {"camera.rate", rate}};
  };
  EXPECT_EQ(points[0].settings, at("0.2 m/s", "1"));
  EXPECT_EQ(points[1].settings, at("0.2 m/s", "5 Hz"));
  EXPECT_EQ(points[2].settings, at("0.2 m/s", "10"));
  EXPECT_EQ(points[3].settings, at("0.4", "1"));
  EXPECT_EQ(points[5].settings, at("0.4", "10"));
}

TEST(Sweep, AScenarioLoadsAtItsPointsAndAlsoWithoutThem) {
  const ScenarioFolder folder;
  const auto file = folder.write("test.yaml", smallest + "sweep: {ego.speed: [0.2 m/s, 70 cm/s]}");
  EXPECT_EQ(load(file).ego.phases[0].speed_mps, 0.5);
  std::vector<double> speeds;
  for (const SweepPoint& point : sweep_points(file)) {
    const auto& [key, value] = point.settings.at(0);
    speeds.push_back(load(file, {.sets = {key + "=" + value}, .seed = {}}).ego.phases[0].speed_mps);
  }
  EXPECT_EQ(speeds, (std::vector<double>{0.2, 0.7}));
}

TEST(Sweep, ValuesOfEveryKindReadBackAsTheyWere) {
  const ScenarioFolder folder;
  const std::string lines =
      "actors:\n  a: {shape: box, trajectory: {still: {position: [0, 0]}}}\n"
      "sweep:\n"
      "  camera.size: [[320, 240], [640, 480]]\n"
      "  actors.a.trajectory:\n"
      "    - {still: {position: [1 m, -2]}}\n"
      "    - circle: {centre: [0, 0], radius: 1 m, speed: -1 m/s}\n"
      "  filter.circle.mu_0: ['20', \"25\"]\n"
      "  actors.a.texture: ['a: b, #c', '\"']\n";
  const auto good = folder.write("good.yaml", smallest + lines);
  const std::vector<SweepPoint> points = sweep_points(good);
  ASSERT_EQ(points.size(), 16u);
  LoadOptions options;
  for (const auto& [key, value] : points.back().settings) {
    options.sets.push_back(key + "=" + value);
  }
  const Scenario last = load(good, options);
  EXPECT_EQ(last.camera.width_px, 640);
  EXPECT_EQ(std::get<Circular>(last.actors[0].trajectory).speed_mps, -1);
  EXPECT_EQ(last.filter.at(0).value, "25");
  EXPECT_EQ(last.actors[0].texture, "\"");
}

TEST(Sweep, WrongKeyOrValueIsRefusedAtItsLine) {
  EXPECT_EQ(sweep_refusal("sweep:\n  ego.speed:\n    - 0.2 m/s\n    - 9 deg\n"),
            "test.yaml:7: sweep.ego.speed: ego.speed: '9 deg' is an angle; give a speed in m/s, "
            "cm/s, mm/s or km/h");
  EXPECT_EQ(sweep_refusal("sweep:\n  camera.rate: [5, 10]\n  ego.sped: [1]\n"),
            "test.yaml:6: sweep.ego.sped: unknown key 'sped' in ego; did you mean 'speed'?");
  EXPECT_EQ(sweep_refusal("sweep:\n  frames: [1, 0]\n"),
            "test.yaml:5: sweep.frames: frames is '0'; give a whole number from 1 to 1000000");
}

TEST(Sweep, AValueThatOnlyOtherValuesForbidIsRefusedWithItsPoint) {
  EXPECT_EQ(
      sweep_refusal("criteria: [{metric: a, min: 0, max: 5}]\n"
                    "sweep: {criteria.0.min: [1, 3], criteria.0.max: [4, 2]}\n"),
      "test.yaml:5: sweep, at criteria.0.min=3, criteria.0.max=2: test.yaml:4: criteria.0 has "
      "its min above its max; exchange them");
}

TEST(Sweep, ABadFormIsRefusedByEveryLoad) {
  EXPECT_EQ(refusal(smallest + "sweep: [1]\n"),
            "test.yaml:4: sweep is a list; give a map, as in {key: value}");
  EXPECT_EQ(refusal(smallest + "sweep: {}\n"),
            "test.yaml:4: sweep is an empty map; give keys, as in {ego.speed: [0.2, 0.4]}");
  EXPECT_EQ(refusal(smallest + "sweep:\n  ego.speed: 1\n"),
            "test.yaml:5: sweep.ego.speed is a single value; give a list, as in [...]");
  EXPECT_EQ(refusal(smallest + "sweep:\n  ego.speed: []\n"),
            "test.yaml:5: sweep.ego.speed is an empty list; give one or more values");
  EXPECT_EQ(refusal(smallest + "sweep:\n  ego.speed: [1, ~]\n"),
            "test.yaml:5: sweep.ego.speed.1 is nothing; give a value");
  EXPECT_EQ(refusal(smallest + "sweep:\n  ego.speed: [1, 2, 1]\n"),
            "test.yaml:5: sweep.ego.speed has '1' twice; remove one");
  EXPECT_EQ(refusal(smallest + "sweep:\n  seed: [1, 2]\n"),
            "test.yaml:5: sweep.seed cannot be swept; the number of seeds is the suite's option");
  EXPECT_EQ(refusal(smallest + "sweep:\n  origin: [{family: room, seed: 1}]\n"),
            "test.yaml:5: sweep.origin cannot be swept; remove it");
}

TEST(Sweep, MorePointsThanAnybodyWaitsForAreRefused) {
  std::string numbers = "1";
  for (int i = 2; i <= 40; ++i) numbers += ", " + std::to_string(i);
  EXPECT_EQ(
      sweep_refusal("sweep:\n  camera.rate: [" + numbers + "]\n  frames: [" + numbers + "]\n"),
      "test.yaml:5: sweep has more than 1000 points; shorten its lists");
}

}  // namespace
}  // namespace lcs::scenario
