// Drawn and written worlds, compared with the simulator's truth.
#include "scenes/worlds/worlds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <opencv2/imgproc.hpp>
#include <set>
#include <tuple>

#include "filter/detect/fast.h"
#include "scenarios/load.h"
#include "scenes/worlds/families.h"
#include "scenes/worlds/kit.h"
#include "scenes/worlds/textures.h"
#include "scenes/worlds/world.h"
#include "sim/drive.h"
#include "sim/scene/mujoco.h"
#include "sim/simulation.h"
#include "tests/tools/files.h"
#include "tests/tools/pictures.h"
#include "tests/tools/temporary_folder.h"
#include "tools/app/world.h"
#include "tools/preview/sheet.h"

namespace lcs::worlds {
namespace {

namespace fs = std::filesystem;
constexpr int kOfEach = 12;

/// The first worlds of each family of `train`, drawn once for all tests.
const std::vector<DrawnWorld>& drawn_worlds() {
  static const std::vector<DrawnWorld> worlds = [] {
    std::vector<DrawnWorld> all;
    const int count = kOfEach * static_cast<int>(families().size());
    for (const Choice& choice : choose("train", count)) all.push_back(draw_world(choice));
    return all;
  }();
  return worlds;
}

fs::path written(const DrawnWorld& world, const test::TemporaryFolder& folder) {
  app::write_world(world, folder.path());
  return folder.path() / (name_of(world) + ".yaml");
}

/// One world of each family with movers and a small picture.
std::vector<DrawnWorld> small_ones() {
  std::map<std::string, DrawnWorld> found;
  for (const DrawnWorld& world : drawn_worlds()) {
    if (world.scenario.actors.empty()) continue;
    const auto [place, is_new] = found.emplace(world.family, world);
    if (world.scenario.camera.width_px < place->second.scenario.camera.width_px) {
      place->second = world;
    }
  }
  std::vector<DrawnWorld> all;
  for (auto& [family, world] : found) all.push_back(std::move(world));
  return all;
}

TEST(Worlds, TheSameSeedGivesTheSameBytesAndAnotherSeedOthers) {
  for (const std::string& family : families()) {
    const test::TemporaryFolder one, again, other;
    app::write_world(draw_world({family, 5}), one.path());
    app::write_world(draw_world({family, 5}), again.path());
    app::write_world(draw_world({family, 6}), other.path());
    const auto bytes = test::bytes_in(one.path());
    EXPECT_GT(bytes.size(), 10u);
    EXPECT_TRUE(bytes == test::bytes_in(again.path())) << family;
    EXPECT_NE(bytes.at("scene.xml"), test::read(other.path() / "scene.xml"));
  }
}

TEST(Worlds, TheSceneOpensInMujocoAlone) {
  for (const DrawnWorld& world : small_ones()) {
    const test::TemporaryFolder folder;
    written(world, folder);
    std::array<char, 1000> message{};
    mjModel* model = mj_loadXML((folder.path() / "scene.xml").c_str(), nullptr, message.data(),
                                static_cast<int>(message.size()));
    ASSERT_TRUE(model) << world.family << ": " << message.data();
    EXPECT_STREQ(message.data(), "");
    EXPECT_EQ(model->nbody, static_cast<int>(world.bodies.size()) + 1);
    EXPECT_GT(model->ntex, 3);
    mj_deleteModel(model);
  }
}

TEST(Worlds, TheScenarioSaysWhatWasDrawn) {
  for (const DrawnWorld& world : small_ones()) {
    const test::TemporaryFolder folder;
    const scenario::Scenario read = scenario::load(written(world, folder));
    const scenario::Scenario& drawn = world.scenario;
    EXPECT_EQ(read.name, drawn.name);
    EXPECT_EQ(read.groups, drawn.groups);
    EXPECT_EQ(read.seed, drawn.seed);
    EXPECT_EQ(read.frames, drawn.frames);
    EXPECT_EQ(read.ego.drive, drawn.ego.drive);
    ASSERT_EQ(read.ego.phases.size(), drawn.ego.phases.size());
    for (std::size_t i = 0; i < drawn.ego.phases.size(); ++i) {
      const scenario::EgoPhase &a = read.ego.phases[i], &b = drawn.ego.phases[i];
      EXPECT_NEAR(a.at_s, b.at_s, 1e-9);
      EXPECT_NEAR(a.speed_mps, b.speed_mps, 1e-4);
      EXPECT_NEAR(a.acceleration_mps2, b.acceleration_mps2, 1e-4);
      EXPECT_NEAR(a.direction_rad, b.direction_rad, 1e-6);
      EXPECT_NEAR(a.yaw_rate_radps, b.yaw_rate_radps, 1e-6);
    }
    EXPECT_NEAR(read.camera.fovy_rad, drawn.camera.fovy_rad, 1e-9);
    EXPECT_EQ(read.camera.rate_hz, drawn.camera.rate_hz);
    EXPECT_NEAR(read.camera.told.height_error_m, drawn.camera.told.height_error_m, 1e-9);
    EXPECT_NEAR(read.camera.told.pitch_error_rad, drawn.camera.told.pitch_error_rad, 1e-9);
    EXPECT_EQ(read.image.jpeg_quality, drawn.image.jpeg_quality);
    EXPECT_NEAR(read.image.noise->full_well_e, drawn.image.noise->full_well_e, 1e-3);
    EXPECT_EQ(read.imu.preset, drawn.imu.preset);
    EXPECT_EQ(read.odometry.enabled, drawn.odometry.enabled);
    EXPECT_EQ(read.ground.has_value(), drawn.ground.has_value());
    ASSERT_EQ(read.actors.size(), drawn.actors.size());
    for (std::size_t i = 0; i < drawn.actors.size(); ++i) {
      EXPECT_EQ(read.actors[i].body, drawn.actors[i].body);
      EXPECT_EQ(read.actors[i].trajectory.index(), drawn.actors[i].trajectory.index());
    }
  }
}

TEST(Worlds, TheScenarioSaysHowItWasDrawn) {
  bool is_any_again = false;
  for (const DrawnWorld& world : drawn_worlds()) {
    if (world.attempt == 0 && is_any_again) continue;
    const test::TemporaryFolder folder;
    const scenario::Origin origin = scenario::load(written(world, folder)).origin.value();
    EXPECT_EQ(origin.family, world.family);
    EXPECT_EQ(origin.seed, world.seed);
    EXPECT_EQ(origin.again, static_cast<std::uint64_t>(world.attempt));
    EXPECT_EQ(std::set<std::string>(origin.features.begin(), origin.features.end()),
              world.features);
    is_any_again |= world.attempt > 0;
  }
  EXPECT_TRUE(is_any_again);
}

TEST(Worlds, ANameOfOldMeansAWorld) {
  const auto origin = origin_named("room_2000000 ego.speed=1");
  ASSERT_TRUE(origin);
  EXPECT_EQ(origin->family, "room");
  EXPECT_EQ(origin->seed, 2'000'000u);
  for (const char* name : {"room", "room_", "room_x", "hall_7", "_7", "", "my_room_7"}) {
    EXPECT_FALSE(origin_named(name)) << name;
  }
}

TEST(Worlds, EveryFeatureOccursAtLeastTwice) {
  std::map<std::string, int> count;
  for (const DrawnWorld& world : drawn_worlds()) {
    for (const std::string& feature : world.features) ++count[feature];
  }
  for (const char* feature : {"bare_thing",
                              "text",
                              "pattern",
                              "bare_wall",
                              "speckle",
                              "foliage",
                              "thin_pole",
                              "shelf",
                              "hanging",
                              "near",
                              "mover_larger_than_picture",
                              "mover_cut",
                              "mover_before_mover",
                              "several_alike",
                              "painted_shadow",
                              "slope",
                              "uneven_ground",
                              "told_with_error",
                              "jpeg",
                              "wheeled",
                              "no_odometry",
                              "plain_mover",
                              "mover_of_meshes",
                              "mover_of_primitives",
                              "mover_stops",
                              "mover_starts"}) {
    EXPECT_GE(count[feature], 2) << feature;
    count.erase(feature);
  }
  EXPECT_TRUE(count.empty()) << count.begin()->first << " is in no list";
}

TEST(Worlds, OneInFourShowsNothingThatMovesAndOfPlainOnesOneInThree) {
  std::map<std::string, int> still;
  for (const DrawnWorld& world : drawn_worlds()) {
    const bool is_static = world.scenario.actors.empty();
    still[world.family] += is_static;
    const auto& groups = world.scenario.groups;
    EXPECT_EQ(std::count(groups.begin(), groups.end(), "static"), is_static);
    EXPECT_EQ(std::count(groups.begin(), groups.end(), world.family), 1);
  }
  for (const auto& [family, count] : still) {
    EXPECT_EQ(count, kOfEach / (family == "plain" ? 3 : 4)) << family;
  }
}

TEST(Worlds, MostPlainOnesBeginWithFewCornersButSome) {
  constexpr std::size_t kFewest = 30, kMost = 300;
  int few = 0;
  for (const DrawnWorld& world : drawn_worlds()) {
    if (world.family != "plain") continue;
    const test::TemporaryFolder folder;
    const scenario::Scenario scenario = scenario::load(written(world, folder));
    sim::Simulation simulation(scenario);
    const auto frame = simulation.next();
    ASSERT_TRUE(frame);
    cv::Mat1b grey;
    cv::cvtColor(frame->image, grey, cv::COLOR_BGR2GRAY);
    const auto corners = FastDetector(scenario.fast_threshold).detect(grey).size();
    few += corners >= kFewest && corners <= kMost;
  }
  EXPECT_GE(few, 3 * kOfEach / 4);
}

TEST(Worlds, CamerasAndSensorsAreInTheirRangesAndNeverWithoutNoise) {
  std::set<std::string> imus;
  std::set<int> widths;
  std::set<double> rates;
  for (const DrawnWorld& world : drawn_worlds()) {
    const scenario::Scenario& s = world.scenario;
    ASSERT_TRUE(s.image.noise);
    EXPECT_GE(s.image.noise->read_e, 2);
    EXPECT_LE(s.image.noise->full_well_e, 20000);
    EXPECT_GE(s.camera.width_px, 320);
    EXPECT_LE(s.camera.width_px, 1280);
    const double fovx =
        2 * std::atan(std::tan(s.camera.fovy_rad / 2) * s.camera.width_px / s.camera.height_px);
    EXPECT_GT(fovx, 44.5 * kDegree);
    EXPECT_LT(fovx, 100.5 * kDegree);
    EXPECT_GE(s.camera.rate_hz, 3);
    EXPECT_LE(s.camera.rate_hz, 30);
    EXPECT_GE(s.camera.mount_position_m.z(), 0.2);
    EXPECT_LE(s.camera.mount_position_m.z(), 1.6);
    EXPECT_GE(s.frames, 40);
    EXPECT_LE(s.frames, 80);
    EXPECT_EQ(s.ego.drive == scenario::Drive::wheeled, world.features.contains("wheeled"));
    EXPECT_TRUE(!s.ground || s.ego.drive == scenario::Drive::wheeled);
    imus.insert(s.imu.preset);
    widths.insert(s.camera.width_px);
    rates.insert(s.camera.rate_hz);
  }
  EXPECT_GE(imus.size(), 3u);
  EXPECT_GE(widths.size(), 6u);
  EXPECT_GE(rates.size(), 6u);
}

TEST(Worlds, MoversAreSeenTenFramesOrMoreByTheTruthAndRunIntoNothing) {
  for (const DrawnWorld& world : small_ones()) {
    const test::TemporaryFolder folder;
    const scenario::Scenario scenario = scenario::load(written(world, folder));
    sim::Simulation simulation(scenario);
    std::map<std::string, int> seen;
    while (const auto o = simulation.next()) {
      for (const sim::ObjectTruth& object : o->objects) {
        constexpr int kSpeck_px = 20;
        if (!object.moving || object.visible_px < kSpeck_px) continue;
        ++seen[simulation.objects()[static_cast<std::size_t>(object.object - 1)].name];
      }
    }
    for (std::size_t i = 0; i < sim::kWarnings.size(); ++i) {
      const sim::Warnings& met = simulation.warnings();
      EXPECT_EQ(met.of(static_cast<sim::Warning>(i)).first, "") << name_of(world);
    }
    for (const scenario::Actor& actor : scenario.actors) {
      EXPECT_GE(seen[*actor.body], 10) << name_of(world) << " " << actor.name;
    }
  }
}

/// According to the simulator's poses of the rover and the movers.
TEST(Worlds, MoversAreFreeOfTheRoverOfWhatStandsAndOfEachOther) {
  int movers = 0;
  for (const DrawnWorld& world : drawn_worlds()) {
    if (world.scenario.actors.empty() || ++movers > 12) continue;
    const test::TemporaryFolder folder;
    const sim::Drive drive = sim::drive(scenario::load(written(world, folder)));
    std::set<std::string> moving;
    for (const scenario::Actor& actor : world.scenario.actors) moving.insert(*actor.body);
    for (const sim::Observation& o : drive.frames) {
      std::vector<TurnedBox> boxes;
      for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        const sim::Pose& T_WO = o.truth.now.T_WO[i + 1];
        TurnedBox box = bounds(world, world.bodies[i].parts);
        box.centre_m = T_WO.p.head<2>();
        box.heading_rad = std::atan2(T_WO.R(1, 0), T_WO.R(0, 0));
        box.foot_m += T_WO.p.z();
        box.head_m += T_WO.p.z();
        boxes.push_back(box);
      }
      const Eigen::Vector3d camera = o.truth.now.T_WC.p;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (!moving.contains(world.bodies[i].name)) continue;
        for (std::size_t k = 0; k < boxes.size(); ++k) {
          if (k == i) continue;
          EXPECT_GT(gap_m(boxes[i], boxes[k]), -0.01)
              << name_of(world) << " frame " << o.index << ": " << world.bodies[i].name << ", "
              << world.bodies[k].name;
        }
        const TurnedBox rover{camera.head<2>(), {0.05, 0.05}, 0, 0, camera.z()};
        EXPECT_GT(gap_m(boxes[i], rover), 0.02) << name_of(world) << " frame " << o.index;
      }
    }
  }
}

/// The plan shows the rover's path: from the commands, and from the simulator's physics.
TEST(Sheet, TheWayOnThePlanIsTheRoversOwn) {
  for (const DrawnWorld& world : small_ones()) {
    const test::TemporaryFolder folder;
    const scenario::Scenario scenario = scenario::load(written(world, folder));
    const RoverPath way = way_of(scenario);
    const sim::Drive drive = sim::drive(scenario);
    ASSERT_GE(way.frames.size(), drive.frames.size());
    for (std::size_t k = 0; k < drive.frames.size(); ++k) {
      const Eigen::Vector3d planned = camera_at(scenario.camera, way.frames[k], 0);
      EXPECT_LT((planned - drive.frames[k].truth.now.T_WC.p).head<2>().norm(), 0.3)
          << name_of(world) << " frame " << k;
    }
  }
}

int count_of(const cv::Mat3b& picture, const cv::Vec3b& colour) {
  return static_cast<int>(std::count(picture.begin(), picture.end(), colour));
}

TEST(Sheet, ThePlanHasAPathForWhatMovesAndNoneWhereNothingDoes) {
  const cv::Vec3b moves(255, 0, 255), rover(220, 80, 0);
  for (const DrawnWorld& world : drawn_worlds()) {
    const cv::Mat3b picture = preview::plan(world);
    EXPECT_GT(count_of(picture, rover), 5) << name_of(world);
    if (world.scenario.actors.empty()) {
      EXPECT_EQ(count_of(picture, moves), 0) << name_of(world);
    } else {
      EXPECT_GT(count_of(picture, moves), 10) << name_of(world);
    }
  }
}

TEST(Sheet, HasBoxesWhereTheTruthHasThemAtAnyScaleOfThePicture) {
  const cv::Vec3b moves(255, 0, 255), stands(0, 200, 0);
  sim::ObjectTruth mover, thing;
  std::tie(mover.left, mover.top, mover.right, mover.bottom) = std::tuple{200, 100, 300, 200};
  std::tie(thing.left, thing.top, thing.right, thing.bottom) = std::tuple{400, 300, 600, 400};
  mover.moving = true;
  for (const double scale : {1.0, 0.5, 0.25}) {  // scales of an image of 960 x 720
    preview::Shots shots;
    for (preview::Shot& shot : shots) {
      shot.picture = cv::Mat3b(cvRound(720 * scale), cvRound(960 * scale), cv::Vec3b(9, 9, 9));
      shot.scale = scale;
      shot.objects = {mover, thing};
    }
    for (const int columns : {2, 4}) {
      const cv::Mat3b sheet = preview::contact_sheet(shots, {}, columns);
      ASSERT_EQ(sheet.size(), columns == 2 ? cv::Size(960, 720) : cv::Size(1920, 360));
      for (int tile = 0; tile < 3; ++tile) {
        const cv::Point corner(tile % columns * 480, tile / columns * 360);
        EXPECT_EQ(sheet(corner + cv::Point(100, 50)), moves);
        EXPECT_EQ(sheet(corner + cv::Point(149, 99)), moves);
        EXPECT_EQ(sheet(corner + cv::Point(200, 150)), stands);
        EXPECT_EQ(sheet(corner + cv::Point(299, 199)), stands);
        EXPECT_EQ(sheet(corner + cv::Point(120, 70)), cv::Vec3b(9, 9, 9));
      }
    }
  }
  EXPECT_EQ(preview::frames_shown(60), (std::array{0, 30, 59}));
}

TEST(Worlds, SplitsAreDisjointAndSpreadOverTheFamilies) {
  std::set<std::uint64_t> seeds;
  for (const Split& split : splits()) {
    std::map<std::string, int> count;
    for (const Choice& choice : choose(split.name, 10 * static_cast<int>(families().size()))) {
      ++count[choice.family];
      EXPECT_GE(choice.seed, split.first_seed);
      EXPECT_LE(choice.seed, split.last_seed);
      if (choice.family != "room") continue;
      EXPECT_TRUE(seeds.insert(choice.seed).second);
    }
    for (const std::string& family : families()) EXPECT_EQ(count[family], 10);
    for (const Split& other : splits()) {
      if (other.name == split.name) continue;
      EXPECT_TRUE(other.last_seed < split.first_seed || split.last_seed < other.first_seed);
    }
  }
  EXPECT_EQ(choose("test", 3, "yard").back().family, "yard");
  EXPECT_THROW(choose("dev", 3), std::invalid_argument);
  EXPECT_THROW(choose("test", 3, "moon"), std::invalid_argument);
}

TEST(Worlds, PicturesOfAFolderAreSurfacesAndChangeNothingElse) {
  const test::TemporaryFolder folder;
  cv::Mat3b red(60, 90, cv::Vec3b(0, 0, 255));
  test::write_picture(folder.path() / "red.png", red);
  const DrawnWorld painted = draw_world({"room", 5});
  const DrawnWorld photographed = draw_world({"room", 5}, pictures_in(folder.path().string()));
  int photographs = 0;
  for (const Texture& texture : photographed.textures) {
    if (!texture.name.starts_with("photograph")) continue;
    ++photographs;
    EXPECT_EQ(cv::norm(texture.picture, cv::Mat3b(texture.picture.size(), cv::Vec3b(0, 0, 255)),
                       cv::NORM_INF),
              0);
  }
  EXPECT_GT(photographs, 0);
  EXPECT_LT(photographs, static_cast<int>(photographed.textures.size()));
  ASSERT_EQ(painted.bodies.size(), photographed.bodies.size());
  for (std::size_t i = 0; i < painted.bodies.size(); ++i) {
    EXPECT_EQ(painted.bodies[i].position_m, photographed.bodies[i].position_m);
  }
}

/// Adjacent columns across the border between two copies differ no more than columns
/// inside.
TEST(Textures, RepeatWithoutASeam) {
  for (const Style style : {Style::fractal, Style::concrete, Style::foliage, Style::speckle,
                            Style::worn, Style::plain}) {
    Draw draw(3, info_of(style).name);
    const cv::Mat3b picture = paint(style, 256, draw);
    const auto step = [&](int a, int b) {
      return cv::norm(picture.col(a), picture.col(b), cv::NORM_L1);
    };
    double inside = 0;
    for (int x = 0; x + 1 < picture.cols; ++x) inside = std::max(inside, step(x, x + 1));
    EXPECT_LE(step(picture.cols - 1, 0), 1.3 * inside) << info_of(style).name;
  }
}

TEST(Textures, WeatherHasItsDeviationAndNoSeam) {
  constexpr double kLevels = 20;
  for (int seed = 1; seed <= 6; ++seed) {  // both kinds of it
    Draw draw(static_cast<std::uint64_t>(seed), "weather");
    cv::Mat3b picture(256, 256, cv::Vec3b(128, 128, 128));
    weather(picture, kLevels, draw);
    cv::Scalar mean, deviation;
    cv::meanStdDev(picture, mean, deviation);
    EXPECT_NEAR(mean[0], 128, 3) << seed;
    EXPECT_GT(deviation[0], 0.65 * kLevels) << seed;
    EXPECT_LT(deviation[0], 1.35 * kLevels) << seed;
    double inside = 0;
    for (int x = 0; x + 1 < picture.cols; ++x) {
      inside = std::max(inside, cv::norm(picture.col(x), picture.col(x + 1), cv::NORM_L1));
    }
    EXPECT_LE(cv::norm(picture.col(255), picture.col(0), cv::NORM_L1), 1.3 * inside) << seed;
  }
}

TEST(Meshes, ChipsAreClosedAndFaceOutward) {
  const std::vector<Chip> chips{{{0, 0, 0}, {0.1, 0.2, 0.3}, 0.06}, {{2, 1, 0}, {2, 1, -0.4}, 0.1}};
  const Mesh mesh = chips_mesh(chips);
  double volume = 0, expected = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto at = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)].position_m; };
    volume += at(a).dot(at(b).cross(at(c))) / 6;  // the same from any origin, if it is closed
  }
  for (const Chip& chip : chips) {
    expected += chip.width_m * chip.width_m / 4 * (chip.tip_m - chip.foot_m).norm() / 3;
  }
  EXPECT_NEAR(volume, expected, 1e-9);
}

TEST(Textures, EachStyleIsAPictureOfItsOwn) {
  std::vector<cv::Mat3b> pictures;
  for (int i = 0; i <= static_cast<int>(Style::facade); ++i) {
    Draw draw(1, "the same");
    pictures.push_back(paint(static_cast<Style>(i), 64, draw));
    for (std::size_t k = 0; k + 1 < pictures.size(); ++k) {
      EXPECT_GT(cv::norm(pictures[k], pictures.back(), cv::NORM_L1), 64 * 64);
    }
  }
}

}  // namespace
}  // namespace lcs::worlds
