#include "tools/recording/recording_io.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <tuple>

#include "tests/tools/recordings.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/recording_fields.h"
#include "tools/scoring/scoring.h"

namespace lcs::recording {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Fills every field with a different value, including numbers with many digits.
class Filler {
 public:
  void operator()(const char*, double& number) { number = awkward(); }
  void operator()(const char*, OrInfinite value) { value.number = awkward(); }
  void operator()(const char*, OrNan value) { value.number = awkward(); }
  void operator()(const char*, int& number) { number = static_cast<int>(random_()); }
  void operator()(const char*, Id& number) { number = random_(); }
  void operator()(const char*, bool& flag) { flag = random_() % 2 == 0; }
  void operator()(const char*, IgnoreRegion::Shape& shape) {
    shape = random_() % 2 == 0 ? IgnoreRegion::Shape::circle : IgnoreRegion::Shape::rectangle;
  }
  void operator()(const char*, Form<Outline> outline) {
    outline.value.count = static_cast<int>(random_() % 4);
    for (Vec2& vertex : outline.value.vertices()) vertex = {awkward(), awkward()};
  }
  void operator()(const char*, Form<sim::PixelRuns>) {}  // empty, because the box is arbitrary
  void operator()(const char*, sim::Label& label) {
    label = static_cast<sim::Label>(random_() % 4);
  }

  template <class Item>
  std::vector<Item> items(int count) {
    std::vector<Item> items(static_cast<std::size_t>(count));
    for (Item& item : items) fields(item, *this);
    return items;
  }
  double awkward() {
    switch (random_() % 8) {
      case 0:
        return 0.1;
      case 1:
        return -0.0;
      case 2:
        return std::numeric_limits<double>::denorm_min();
      case 3:
        return -std::numeric_limits<double>::max();
      case 4:
        return 1e5;
      case 5:
        return 123456789012345680000.0;  // written as an integer of more than 64 bits
      default: {
        const double number = std::bit_cast<double>(random_());
        return std::isfinite(number) ? number : 1.0 / 3;
      }
    }
  }
  Signature signature() { return {random_(), random_(), random_(), random_()}; }
  Eigen::Vector3d vector() { return {awkward(), awkward(), awkward()}; }
  EgoMotion motion() {
    EgoMotion motion;
    motion.dt_s = awkward();
    for (int row = 0; row < 3; ++row) motion.R_cur_prev.row(row) = vector();
    motion.v_C_mps = vector();
    motion.w_C_radps = vector();
    motion.unseen_turn_rad = std::abs(awkward());
    motion.velocity_sigma_mps = std::abs(awkward());
    motion.ground = Ground{.up_C = vector(), .height_m = awkward()};
    return motion;
  }

 private:
  std::mt19937_64 random_{1};
};

FrameRecord full_frame(Filler& filler, int index) {
  FrameRecord frame;
  frame.index = index;
  frame.t_ns = 9'007'199'254'740'993 + index;  // not representable in a double
  for (int i = 0; i < 6; ++i) {
    frame.corners_px.emplace_back(static_cast<float>(i) + 0.1f, 1.0f / static_cast<float>(i + 3));
    frame.verdicts.push_back(static_cast<Verdict>(i % 4));
    frame.reasons.push_back(static_cast<Reason>((7 * index + i) % kReasons.size()));
    frame.log_odds.push_back(static_cast<float>(311 * i - 500) / 100);
    frame.signatures.push_back(filler.signature());
  }
  frame.motion = filler.motion();
  frame.true_motion = filler.motion();
  frame.layers.normal_edges = filler.items<Edge>(3);
  frame.layers.rebel_edges = filler.items<Edge>(2);
  for (Edge& edge : frame.layers.rebel_edges) edge.rebel = true;
  frame.layers.normal_circles = filler.items<Circle>(2);
  frame.layers.rebel_circles = filler.items<Circle>(1);
  for (Circle& circle : frame.layers.rebel_circles) circle.rebel = true;
  frame.layers.squares = filler.items<Square>(2);
  frame.paper.ignored = filler.items<IgnoreRegion>(3);
  frame.paper.collectors = filler.items<Collector>(2);
  Chain chain;
  chain.count = 1;
  chain.sightings = {Vec2(filler.awkward(), filler.awkward()), Vec2::Zero()};
  chain.off_field_px = filler.awkward();
  frame.paper.chains = {chain};
  frame.corner_truth = filler.items<sim::CornerTruth>(6);
  frame.corner_truth[0].depth_m = kInfinity;
  frame.corner_truth[1].motion_px.setConstant(kNan);
  frame.object_truth = filler.items<sim::ObjectTruth>(2);
  return frame;
}

Recording full_recording() {
  Filler filler;
  Recording recording = test::recording_of({});
  recording.objects = {{1, "box \"quoted\""}, {2, "caf\u00e9\n"}};
  recording.seed = std::numeric_limits<std::uint64_t>::max();
  recording.world = {{"ego.speed", "0.5 m/s"}, {"actors.caf\u00e9.\"x\"", ""}};
  scenario::Origin& origin = recording.origin.emplace();
  origin.family = "caf\u00e9";
  origin.seed = recording.seed;
  for (int k = 0; k < 5; ++k) recording.frames.push_back(full_frame(filler, k));
  return recording;
}

void write(const Recording& recording, const std::filesystem::path& folder) {
  RecordingWriter writer(folder, recording);
  for (const FrameRecord& frame : recording.frames) writer.write(frame);
  writer.close();
}

/// A recording with consistent truth, so that all figures are defined.
Recording scorable() {
  std::vector<FrameRecord> frames;
  for (int k = 0; k < 9; ++k) {
    test::FrameMaker frame(k);
    frame.corners(3 + k % 2, Verdict::rebel, sim::Label::rebel, 1)
        .corners(2, Verdict::pending, sim::Label::rebel, 1, true)
        .corners(k % 3, Verdict::rebel, sim::Label::fixed)
        .object(1, {100, 100, 140, 150}, true, 1.0 / 3 + 0.4)
        .square(1, {103, 100, 141 + k, 150});
    frame.record().motion.dt_s = frame.record().true_motion.dt_s = 0.1;
    frame.record().motion.v_C_mps = {0.1 * k, 0.01, 1.0 / (k + 1)};
    frames.push_back(frame);
  }
  return test::recording_of(frames);
}

TEST(RecordingIo, EveryFieldComesBackToTheSameBits) {
  const Recording recording = full_recording();
  const test::TemporaryFolder folder;
  write(recording, folder.path());
  const Recording back = read_recording(folder.path());

  EXPECT_EQ(back.scenario, recording.scenario);
  EXPECT_EQ(back.seed, recording.seed);
  EXPECT_EQ(back.world, recording.world);
  ASSERT_TRUE(back.origin);
  EXPECT_TRUE(back.origin->is_same_world(*recording.origin));
  EXPECT_TRUE(read_run_info(folder.path()).origin.value().is_same_world(*recording.origin));
  ASSERT_EQ(back.objects.size(), recording.objects.size());
  for (std::size_t i = 0; i < back.objects.size(); ++i) {
    EXPECT_EQ(back.objects[i].id, recording.objects[i].id);
    EXPECT_EQ(back.objects[i].name, recording.objects[i].name);
  }
  // The written form of every number denotes one double only, so equal lines mean equal
  // bits.
  ASSERT_EQ(back.frames.size(), recording.frames.size());
  for (std::size_t k = 0; k < back.frames.size(); ++k) {
    EXPECT_EQ(layers_line(back.frames[k]), layers_line(recording.frames[k]));
    EXPECT_EQ(truth_line(back.frames[k]), truth_line(recording.frames[k]));
    EXPECT_EQ(back.frames[k].corners_px, recording.frames[k].corners_px);
    EXPECT_EQ(back.frames[k].signatures, recording.frames[k].signatures);
    EXPECT_EQ(back.frames[k].verdicts, recording.frames[k].verdicts);
    EXPECT_EQ(back.frames[k].reasons, recording.frames[k].reasons);
    EXPECT_EQ(back.frames[k].log_odds, recording.frames[k].log_odds);
    EXPECT_EQ(back.frames[k].t_ns, recording.frames[k].t_ns);
    EXPECT_EQ(back.frames[k].motion.R_cur_prev, recording.frames[k].motion.R_cur_prev);
    EXPECT_EQ(back.frames[k].motion.unseen_turn_rad, recording.frames[k].motion.unseen_turn_rad);
    EXPECT_EQ(back.frames[k].motion.velocity_sigma_mps,
              recording.frames[k].motion.velocity_sigma_mps);
    EXPECT_EQ(back.frames[k].motion.ground->up_C, recording.frames[k].motion.ground->up_C);
    EXPECT_TRUE(back.frames[k].layers.rebel_edges.front().rebel);
    EXPECT_TRUE(back.frames[k].layers.rebel_circles.front().rebel);
    EXPECT_EQ(back.frames[k].corner_truth[0].depth_m, kInfinity);
    EXPECT_TRUE(std::isnan(back.frames[k].corner_truth[1].motion_px.x()));
    EXPECT_FALSE(back.frames[k].times);
  }
}

TEST(RecordingIo, TheSignOfZeroComesBack) {
  test::FrameMaker maker(0);
  maker.rebel_circle({-0.0, 0.0}, 3);
  Recording recording = test::recording_of({maker});
  const test::TemporaryFolder folder;
  write(recording, folder.path());
  const Vec2 back = read_recording(folder.path()).frames[0].layers.rebel_circles[0].location;
  EXPECT_TRUE(std::signbit(back.x()));
  EXPECT_FALSE(std::signbit(back.y()));
}

TEST(RecordingIo, AStoredRunScoresTheSameToTheBit) {
  const Recording recording = scorable();
  const test::TemporaryFolder folder;
  write(recording, folder.path());
  const scoring::Metrics before = scoring::score(recording);
  EXPECT_EQ(before, scoring::score(read_recording(folder.path())));
  EXPECT_TRUE(scoring::value(before, "rebel.f1"));
  EXPECT_TRUE(scoring::value(before, "square.mean_iou"));
}

TEST(RecordingIo, LinesAreJsonWithAKeyForEveryLayer) {
  Filler filler;
  const auto layers = nlohmann::json::parse(layers_line(full_frame(filler, 4)));
  EXPECT_EQ(layers.at("index"), 4);
  EXPECT_EQ(layers.at("corners").at("verdict"),
            (nlohmann::json{"ignored", "pending", "normal", "rebel", "ignored", "pending"}));
  EXPECT_EQ(layers.at("normal_edges").at("id").size(), 3u);
  for (const char* key : {"t_ns", "told_motion", "rebel_edges", "normal_circles", "rebel_circles",
                          "squares", "ignored", "collectors", "chains"}) {
    EXPECT_TRUE(layers.contains(key)) << key;
  }
}

TEST(RecordingIo, SignaturesAreTheBytesOfTheirMakerInHexadecimalDigits) {
  test::FrameMaker maker(0);
  maker.corners(2, Verdict::normal, sim::Label::fixed);
  SignatureBytes bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i + 1);
  maker.record().signatures = {std::bit_cast<Signature>(bytes), Signature{}};
  EXPECT_EQ(
      nlohmann::json::parse(layers_line(maker)).at("signatures"),
      "0102030405060708090a0b0c0d0e0f101112131415161718191a1b1c1d1e1f20" + std::string(64, '0'));
}

TEST(RecordingIo, FramesFromBeforeThereWereSignaturesHaveNone) {
  const test::TemporaryFolder folder;
  write(scorable(), folder.path());
  const Recording back = read_recording(folder.path());
  ASSERT_FALSE(back.frames[0].corners_px.empty());
  for (const FrameRecord& frame : back.frames) {
    EXPECT_TRUE(frame.signatures.empty());
    EXPECT_FALSE(nlohmann::json::parse(layers_line(frame)).contains("signatures"));
  }
}

TEST(RecordingIo, ReasonsThatADetectorDoesNotGiveAreUnknown) {
  test::FrameMaker maker(0);
  maker.corners(2, Verdict::rebel, sim::Label::fixed);
  const test::TemporaryFolder folder;
  write(test::recording_of({maker}), folder.path());
  EXPECT_EQ(read_recording(folder.path()).frames[0].reasons,
            std::vector<Reason>(2, Reason::unknown));
}

/// An object that is wider below, and a square.
FrameRecord masked() {
  test::FrameMaker frame(0);
  frame.object(1, {5, 3, 8, 5}, true).square(4, {5, 3, 7, 5}).square(9, {0, 0, 4, 4});
  frame.record().object_truth[0].mask = {1, 4, 1};
  frame.record().masks[4] = {cv::Rect(5, 3, 2, 2), {0, 1, 2, 1}};
  return frame;
}

TEST(RecordingIo, MasksComeBackAndAreWordsOfCoco) {
  const Recording recording = test::recording_of({masked()});
  const test::TemporaryFolder folder;
  write(recording, folder.path());
  const FrameRecord back = read_recording(folder.path()).frames[0];
  EXPECT_EQ(back.object_truth[0].mask, recording.frames[0].object_truth[0].mask);
  ASSERT_EQ(back.masks.size(), 1u);
  EXPECT_EQ(back.masks.at(4).box, cv::Rect(5, 3, 2, 2));
  EXPECT_EQ(back.masks.at(4).runs, (sim::PixelRuns{0, 1, 2, 1}));
  // From pycocotools' encode.
  EXPECT_EQ(nlohmann::json::parse(truth_line(back)).at("objects").at("mask"),
            nlohmann::json{"141"});
  EXPECT_EQ(nlohmann::json::parse(layers_line(back)).at("masks"),
            nlohmann::json::parse(R"({"square":[4],"left":[5],"top":[3],"right":[7],"bottom":[5],)"
                                  R"("mask":["0120"]})"));
  EXPECT_FALSE(nlohmann::json::parse(layers_line(full_recording().frames[0])).contains("masks"));
}

TEST(RecordingIo, LongMasksArePackedAsTheyAreUnpacked) {
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    sim::PixelRuns runs;
    for (int k = 0; k < 1 + i % 40; ++k) {
      runs.push_back(static_cast<std::uint32_t>(random() >> (random() % 31)));
    }
    const std::vector<std::int64_t> back = unpacked_runs(packed_runs(runs));
    EXPECT_EQ(sim::PixelRuns(back.begin(), back.end()), runs);
  }
}

/// Their figures by masks are unknown, all others unchanged.
TEST(RecordingIo, RecordingsFromBeforeThereWereOutlinesAndMasksAreRead) {
  std::vector<FrameRecord> frames = scorable().frames;
  for (FrameRecord& frame : frames) {
    frame.object_truth[0].mask = {0, static_cast<std::uint32_t>(frame.object_truth[0].visible_px)};
  }
  Recording recording = test::recording_of(frames);
  recording.camera =
      Intrinsics{.focal_px = 300, .centre_px = {159.5, 119.5}, .width_px = 320, .height_px = 240};
  const scoring::Metrics now = scoring::score(recording);
  EXPECT_TRUE(scoring::value(now, "mover.region_j"));
  const test::TemporaryFolder folder;
  write(recording, folder.path());
  for (const auto& [file, list, key] :
       {std::tuple(kLayersFile, "squares", "outline"), std::tuple(kTruthFile, "objects", "mask")}) {
    std::ifstream in(folder.path() / file);
    std::string older;
    for (std::string line; std::getline(in, line);) {
      nlohmann::json json = nlohmann::json::parse(line);
      if (json.contains("index")) {
        EXPECT_EQ(json[list].erase(key), 1u);
      }
      older += json.dump() + '\n';
    }
    in.close();
    std::ofstream(folder.path() / file) << older;
  }
  const scoring::Metrics then = scoring::score(read_recording(folder.path()));
  for (const auto& [name, figure] : now) {
    if (std::set<std::string>{"mover.region_j", "mover.boundary_f", "mover.j_and_f",
                              "mover.pixel_iou"}
            .contains(name)) {
      EXPECT_FALSE(scoring::value(then, name)) << name;
    } else {
      EXPECT_EQ(scoring::value(then, name), figure) << name;
    }
  }
}

TEST(RecordingIo, ANameThatIsNotUtf8IsStoredWithItsBadBytesReplaced) {
  Recording recording = test::recording_of({});
  recording.scenario = "caf\xe9";
  const test::TemporaryFolder folder;
  write(recording, folder.path());
  EXPECT_EQ(read_recording(folder.path()).scenario, "caf\xef\xbf\xbd");
}

TEST(RecordingIo, AnEmptyRunComesBackEmpty) {
  const test::TemporaryFolder folder;
  write(test::recording_of({}), folder.path());
  EXPECT_TRUE(read_recording(folder.path()).frames.empty());
}

TEST(RecordingIo, TheObjectsOfSingleFramesAreThoseOfTheWholeRecording) {
  std::vector<FrameRecord> frames;
  for (int k = 0; k < 5; ++k) {
    test::FrameMaker frame(k);
    for (int i = 0; i <= k; ++i) frame.object(i + 1, {10 * k, i, 10 * k + 20, i + 9}, i % 2 == 0);
    frames.push_back(frame);
  }
  const test::TemporaryFolder folder;
  const Recording recording = test::recording_of(frames);
  write(recording, folder.path());
  const std::vector<int> wanted{0, 2, 2, 4};
  const auto objects = read_object_truth(folder.path(), wanted);
  ASSERT_EQ(objects.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto& expected = frames[static_cast<std::size_t>(wanted[i])].object_truth;
    ASSERT_EQ(objects[i].size(), expected.size());
    for (std::size_t o = 0; o < expected.size(); ++o) {
      EXPECT_EQ(objects[i][o].left, expected[o].left);
      EXPECT_EQ(objects[i][o].bottom, expected[o].bottom);
      EXPECT_EQ(objects[i][o].moving, expected[o].moving);
    }
  }
  EXPECT_THROW(read_object_truth(folder.path(), std::vector<int>{5}), std::runtime_error);
}

TEST(RecordingIo, ALayerThatIsNotFiniteIsRefusedByFrameAndField) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    test::FrameMaker maker(12);
    maker.rebel_circle({10, bad}, 3);
    EXPECT_EQ(test::refusal_of<std::invalid_argument>([&] { layers_line(maker); }),
              "frame 12: rebel_circles.y is not a finite number")
        << bad;
  }
}

TEST(RecordingIo, AMotionThatIsInfiniteAndADepthThatIsNanAreRefused) {
  test::FrameMaker maker(0);
  maker.corner(Verdict::normal, sim::Label::fixed);
  FrameRecord far = maker, deep = maker;
  far.corner_truth[0].motion_px.x() = kInfinity;
  deep.corner_truth[0].depth_m = kNan;
  EXPECT_THROW(truth_line(far), std::invalid_argument);
  EXPECT_THROW(truth_line(deep), std::invalid_argument);
}

// ---- Faults of a file are reported by file and line.

class BrokenRecording : public testing::Test {
 protected:
  BrokenRecording() { write(scorable(), folder_.path()); }

  /// Replaces the first `from` in the given line (1-based) of a file.
  void edit(const char* file, int line, const std::string& from, const std::string& to) {
    change(file, [&](std::vector<std::string>& lines) {
      std::string& text = lines.at(static_cast<std::size_t>(line - 1));
      const std::size_t at = text.find(from);
      ASSERT_NE(at, std::string::npos);
      text.replace(at, from.size(), to);
    });
  }
  void drop_last_line(const char* file) {
    change(file, [](std::vector<std::string>& lines) { lines.pop_back(); });
  }
  void expect_error(const std::string& part) {
    const std::string what =
        test::refusal_of<std::runtime_error>([&] { read_recording(folder_.path()); });
    EXPECT_NE(what.find(part), std::string::npos) << what;
  }
  template <class Change>
  void change(const char* file, const Change& how) {
    std::ifstream in(folder_.path() / file);
    std::vector<std::string> lines;
    for (std::string text; std::getline(in, text);) lines.push_back(text);
    how(lines);
    std::ofstream out(folder_.path() / file);
    for (const std::string& line : lines) out << line << '\n';
  }
  test::TemporaryFolder folder_;
};

TEST_F(BrokenRecording, BadJson) {
  edit(kLayersFile, 3, "{", "[");
  expect_error("layers.jsonl:3: not JSON at byte ");
}
TEST_F(BrokenRecording, ACameraWithoutAPicture) {
  const std::string begin = "{\"focal_px\":100,\"centre_px\":[1,1],";
  for (const auto& [text, message] :
       {std::pair{begin + "\"width_px\":0,\"height_px\":1}", "1: width_px is not the side of a"},
        {begin + "\"width_px\":1,\"height_px\":-2147483648}", "1: height_px is not the side of a"},
        {std::string(), " is empty"}}) {
    std::ofstream(folder_.path() / kCameraFile) << text;
    expect_error(std::string("camera.json:") + message);
  }
}
TEST_F(BrokenRecording, AMissingKey) {
  edit(kLayersFile, 2, "\"squares\"", "\"sqares\"");
  expect_error("layers.jsonl:2: has no squares; ");
}
TEST_F(BrokenRecording, AnUnknownWord) {
  edit(kLayersFile, 2, "\"rebel\"", "\"robot\"");
  expect_error("layers.jsonl:2: corners.verdict[0] is the unknown word 'robot'; ");
}
TEST_F(BrokenRecording, ColumnsOfDifferentLength) {
  edit(kTruthFile, 4, "\"radial\":[false,", "\"radial\":[");
  expect_error("truth.jsonl:4: corners has columns that differ in length; ");
}
TEST_F(BrokenRecording, AFractionWhereAnIntegerBelongs) {
  edit(kTruthFile, 2, "\"visible_px\":[2000]", "\"visible_px\":[2000.5]");
  expect_error("truth.jsonl:2: objects.visible_px[0] is not a whole number of its range; ");
}
TEST_F(BrokenRecording, FramesThatDoNotPair) {
  edit(kTruthFile, 5, "\"index\":3", "\"index\":7");
  expect_error("truth.jsonl:5: ");
}
TEST_F(BrokenRecording, AWordWhereANumberBelongs) {
  edit(kLayersFile, 2, "\"dt_s\":", "\"dt_s\":\"soon\",\"was\":");
  expect_error("layers.jsonl:2: told_motion.dt_s is not a number; name the folder of a whole run");
}
TEST_F(BrokenRecording, ANumberThatNoIntegerHolds) {
  edit(kTruthFile, 2, "\"visible_px\":[2000]", "\"visible_px\":[4294967296]");
  expect_error("truth.jsonl:2: objects.visible_px[0] is not a whole number of its range; ");
}
TEST_F(BrokenRecording, AHundredThousandNestedLists) {
  const std::string lists = std::string(100000, '[') + std::string(100000, ']');
  edit(kLayersFile, 2, "\"index\":", "\"index\":" + lists + ",\"was\":");
  expect_error("layers.jsonl:2: lists and objects are nested more than 64 deep at byte ");
}
TEST_F(BrokenRecording, SignaturesThatAreNotOneForEachCorner) {
  Recording recording = scorable();
  for (FrameRecord& frame : recording.frames) frame.signatures.resize(frame.corners_px.size());
  write(recording, folder_.path());
  EXPECT_NO_THROW(read_recording(folder_.path()));
  const std::string wrong =
      "signatures is not 64 hexadecimal digits for each corner; name the folder of a whole run";
  edit(kLayersFile, 2, "\"signatures\":\"00", "\"signatures\":\"");  // one byte too few
  expect_error("layers.jsonl:2: " + wrong);
  edit(kLayersFile, 2, "\"signatures\":\"", "\"signatures\":\"0000");  // one too many
  expect_error("layers.jsonl:2: " + wrong);
  for (const char* digits : {"0x", "-1", "+1", " 1", "g0", "0G"}) {
    SCOPED_TRACE(digits);
    write(recording, folder_.path());
    edit(kLayersFile, 3, "\"signatures\":\"00", std::string("\"signatures\":\"") + digits);
    expect_error("layers.jsonl:3: " + wrong);
  }
}
TEST_F(BrokenRecording, SignaturesThatAreNoText) {
  edit(kLayersFile, 2, "\"squares\"", "\"signatures\":[1],\"squares\"");
  expect_error("layers.jsonl:2: signatures is not a text; name the folder of a whole run");
}
TEST_F(BrokenRecording, MasksThatAreNoneOrNotAsLargeAsTheirBox) {
  edit(kTruthFile, 2, "\"mask\":[\"\"]", "\"mask\":[\"0\"]");
  expect_error("truth.jsonl:2: objects.mask[0] is not as large as its box; ");
  edit(kTruthFile, 2, "\"mask\":[\"0\"]", "\"mask\":[\"0 1\"]");
  expect_error("truth.jsonl:2: objects.mask[0] is not the word of a mask; ");
  edit(kTruthFile, 2, "\"mask\":[\"0 1\"]", "\"mask\":[7]");
  expect_error("truth.jsonl:2: objects.mask[0] is not a text; ");
  write(scorable(), folder_.path());
  edit(kLayersFile, 3, "\"squares\"",
       R"("masks":{"square":[1],"left":[0],"top":[0],"right":[2],"bottom":[0],"mask":[""]},)"
       R"("squares")");
  expect_error("layers.jsonl:3: masks.mask[0] is not as large as its box; ");
}
TEST_F(BrokenRecording, AnOutlineOfMorePointsThanThereIsRoomFor) {
  std::string points = "[0,0]";
  for (int i = 0; i < Outline::kMost; ++i) points += ",[0,1]";
  edit(kLayersFile, 2, "\"outline\":[[]]", "\"outline\":[[" + points + "]]");
  expect_error("layers.jsonl:2: squares.outline[0] has over 32 points; ");
}
TEST_F(BrokenRecording, ATruthThatEndsEarly) {
  drop_last_line(kTruthFile);
  expect_error("truth.jsonl:9: ends before the layers do");
}
TEST_F(BrokenRecording, LayersThatEndEarly) {
  drop_last_line(kLayersFile);
  expect_error("layers.jsonl:8: ends before the truth does");
}
TEST_F(BrokenRecording, AMissingFile) {
  std::filesystem::remove(folder_.path() / kTruthFile);
  expect_error("truth.jsonl: there is no such file; ");
}

}  // namespace
}  // namespace lcs::recording
