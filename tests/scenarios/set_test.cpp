#include <gtest/gtest.h>

#include "tests/scenarios/scenario_file.h"

namespace lcs::scenario {
namespace {

const std::string with_actor = R"(scene: room.xml
frames: 3
ego:
  speed: 0.5 m/s
  phases:
    - {at: 1 s, speed: 0.2 m/s}
actors:
  box1:
    shape: box
    trajectory: {line: {from: [1, 2], heading: 0 deg, speed: 0.5 m/s}}
filter: {circle.mu_0: 20}
)";

Scenario load_with(std::vector<std::string> sets) {
  return load_text(with_actor, {.sets = std::move(sets), .seed = {}});
}

std::string refusal_with(std::string set) {
  return refusal(with_actor, {.sets = {std::move(set)}, .seed = {}});
}

TEST(Set, ReplacesAValueWithOrWithoutItsUnit) {
  EXPECT_EQ(load_with({"ego.speed=0.7"}).ego.phases[0].speed_mps, 0.7);
  EXPECT_EQ(load_with({"ego.speed=70 cm/s"}).ego.phases[0].speed_mps, 0.7);
}

TEST(Set, AddsWhatTheFileDoesNotSay) {
  const Scenario s = load_with({"camera.rate=5 Hz", "odometry.noise=0.1"});
  EXPECT_EQ(s.camera.rate_hz, 5);
  EXPECT_TRUE(s.odometry.enabled);
  EXPECT_EQ(s.odometry.noise_mps, 0.1);
}

TEST(Set, ReachesIntoActorsAndLists) {
  const Scenario s = load_with({"actors.box1.trajectory.line.speed=0.9", "ego.phases.0.speed=0.1",
                                "actors.box1.trajectory.line.from.1=7", "camera.size=[320, 240]"});
  EXPECT_EQ(std::get<Line>(s.actors[0].trajectory).speed_mps, 0.9);
  EXPECT_EQ(std::get<Line>(s.actors[0].trajectory).from_m.value(), Eigen::Vector2d(1, 7));
  EXPECT_EQ(s.ego.phases[1].speed_mps, 0.1);
  EXPECT_EQ(s.camera.width_px, 320);
}

TEST(Set, TakesAllAfterFilterAsOneKey) {
  const Scenario s =
      load_with({"filter.circle.mu_0=25", "filter.circle.rho_c=0.3", "filter.preset=lab"});
  ASSERT_EQ(s.filter.size(), 2u);
  EXPECT_EQ(s.filter[0].key, "circle.mu_0");
  EXPECT_EQ(s.filter[0].value, "25");
  EXPECT_EQ(s.filter[0].source.file, "--set filter.circle.mu_0=25");
  EXPECT_EQ(s.filter[0].source.line, 0);
  EXPECT_EQ(s.filter[1].key, "circle.rho_c");
  EXPECT_EQ(s.filter_preset, "lab");
}

TEST(Set, TheLastOfTwoHolds) {
  EXPECT_EQ(load_with({"ego.speed=0.7", "ego.speed=0.8"}).ego.phases[0].speed_mps, 0.8);
}

TEST(Set, NothingAfterTheEqualsSignRemovesTheKey) {
  const Scenario s = load_with({"frames=", "duration=1 s", "actors="});
  EXPECT_EQ(s.frames, 10);
  EXPECT_TRUE(s.actors.empty());
}

TEST(Set, AddsAWholeActor) {
  const Scenario s =
      load_with({"actors.two={shape: car, trajectory: {still: {position: [1, 1]}}}"});
  ASSERT_EQ(s.actors.size(), 2u);
  EXPECT_EQ(s.actors[1].name, "two");
  EXPECT_EQ(s.actors[1].shape, Shape::car);
}

TEST(Set, MistakesAreReportedAtTheAssignment) {
  EXPECT_EQ(refusal_with("ego.speed"),
            "--set ego.speed: this is not of the form key=value; write it as in ego.speed=0.7");
  EXPECT_EQ(refusal_with("=5"),
            "--set =5: this is not of the form key=value; write it as in ego.speed=0.7");
  EXPECT_EQ(refusal_with("ego..speed=1"),
            "--set ego..speed=1: there is an empty part in the key; write it as in ego.speed=0.7");
  EXPECT_EQ(refusal_with("ego.=1"),
            "--set ego.=1: there is an empty part in the key; write it as in ego.speed=0.7");
  EXPECT_EQ(refusal_with("ego.sped=1"),
            "--set ego.sped=1: unknown key 'sped' in ego; did you mean 'speed'?");
  EXPECT_EQ(refusal_with("eog.speed=1"),
            "--set eog.speed=1: unknown key 'eog'; did you mean 'ego'?");
  EXPECT_EQ(
      refusal_with("ego.speed=3 kg"),
      "--set ego.speed=3 kg: ego.speed: '3 kg' has the unknown unit 'kg'; give a speed in m/s, "
      "cm/s, mm/s or km/h");
  EXPECT_EQ(refusal_with("ego.speed.x=1"),
            "--set ego.speed.x=1: ego.speed is '0.5 m/s', which has no 'x' in it; set ego.speed "
            "itself");
  EXPECT_EQ(refusal_with("ego.phases.1.speed=1"),
            "--set ego.phases.1.speed=1: ego.phases is a list of 1 with no item '1'; give an index "
            "from 0");
  EXPECT_EQ(
      refusal_with("ego.phases.first.speed=1"),
      "--set ego.phases.first.speed=1: ego.phases is a list of 1 with no item 'first'; give an "
      "index from 0");
  EXPECT_EQ(refusal_with("camera.rate="),
            "--set camera.rate=: there is nothing to remove; give a value after the '='");
  EXPECT_EQ(
      refusal_with("camera={rate: 5"),
      "--set camera={rate: 5: this is not YAML: end of map flow not found; check indentation, "
      "brackets and quotes");
  EXPECT_EQ(refusal_with("actors.new.shape=box"),
            "--set actors.new.shape=box: actors.new needs 'trajectory' or 'joint'; add it "
            "(scenarios/README.md shows how)");
  EXPECT_EQ(refusal_with("ego.speed=\xff"),
            "--set ego.speed=\\xff: this is not UTF-8; save the file as UTF-8");
}

}  // namespace
}  // namespace lcs::scenario
