#include "tools/recording/detections.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string_view>
#include <tuple>

#include "scenarios/scenario.h"
#include "tests/scoring/whole_recordings.h"
#include "tests/tools/files.h"
#include "tests/tools/recordings.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/box.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/scoring.h"

namespace lcs::recording {
namespace {

using sim::Label;

/// Six frames with corners at (10, 20), (30, 20), (50, 20), (70.25, 20.75).
Recording sequence() {
  std::vector<FrameRecord> frames;
  for (int k = 0; k < 6; ++k) {
    test::FrameMaker frame(k);
    frame.corner(Verdict::rebel, Label::fixed, 0, false, {10, 20});
    frame.corner(Verdict::rebel, Label::rebel, 1, false, {30, 20});
    frame.corner(Verdict::ignored, Label::rebel, 1, false, {50, 20});
    frame.corner(Verdict::pending, Label::fixed, 0, false, {70.25, 20.75});
    frame.object(1, {20, 10, 60, 40}, true).square(4, {0, 0, 9, 9}).rebel_circle({9, 9}, 3);
    frame.record().layers.normal_edges.resize(3);
    frame.record().times = FrameTimes{.detect_ms = 1, .filter_ms = 2};
    frames.push_back(frame);
  }
  return test::recording_of(frames);
}

/// The same sequence from a camera of 96 x 48 pixels.
Recording seen_by_a_camera() {
  Recording recording = sequence();
  recording.camera =
      Intrinsics{.focal_px = 50, .centre_px = {47.5, 23.5}, .width_px = 96, .height_px = 48};
  return recording;
}

class DetectionsTest : public testing::Test {
 protected:
  Detections detections(const std::string& text, const Recording& of = sequence()) {
    std::ofstream(path_) << text;
    return read_detections(path_, of);
  }
  std::string error(const std::string& text, const Recording& of = sequence()) {
    const std::string message = test::refusal_of<input::Error>([&] { detections(text, of); });
    const std::string where = path_.string() + ":";
    EXPECT_TRUE(message.starts_with(where)) << message;
    return message.substr(std::min(where.size(), message.size()));
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "mine.csv";
};

TEST_F(DetectionsTest, ReplaceAllThatTheSequencesOwnDetectorSaid) {
  const Detections nothing = detections("");
  EXPECT_EQ(nothing.recording.detector.name, "mine");
  EXPECT_FALSE(nothing.recording.detector.layered);
  ASSERT_EQ(nothing.recording.frames.size(), 6u);
  for (const FrameRecord& frame : nothing.recording.frames) {
    EXPECT_EQ(frame.verdicts, std::vector<Verdict>(4, Verdict::normal));
    EXPECT_TRUE(frame.layers.squares.empty());
    EXPECT_TRUE(frame.layers.rebel_circles.empty());
    EXPECT_EQ(frame.layers.dimension(), 0u);
    EXPECT_FALSE(frame.times);
  }
  const scoring::Metrics metrics = scoring::score(nothing.recording);
  EXPECT_EQ(scoring::value(metrics, "rebel.recall"), 0);
  for (const char* unknown : {"dimension.mean", "dimension.max", "edges.rematched",
                              "time.filter_ms_median", "sim.frames_per_second"}) {
    EXPECT_FALSE(scoring::value(metrics, unknown)) << unknown;
  }
  EXPECT_EQ(scoring::value(metrics, "dimension.corners_mean"), 4)
      << "of the frames, not of the detector";
}

TEST_F(DetectionsTest, NameCornersByPlaceOrByIndex) {
  const Detections said =
      detections("3,rebel,30,20\n3,pending,10.3,19.7\n3,rebel,3\n5,ignored,0\n");
  EXPECT_EQ(said.recording.frames[3].verdicts,
            (std::vector{Verdict::pending, Verdict::rebel, Verdict::normal, Verdict::rebel}));
  EXPECT_EQ(said.recording.frames[5].verdicts[0], Verdict::ignored);
  EXPECT_EQ(said.counts.verdicts, 4);
  EXPECT_EQ(said.counts.corners(), 4);
}

TEST_F(DetectionsTest, CountVerdictsThatAreOnNoCornerOrOnOneThatHasOne) {
  // 2 px is within reach, 2.01 px is not; of two rows for one corner the nearer one is used.
  const Detections said = detections(
      "3,rebel,32,20\n3,rebel,52.01,20\n3,rebel,400,300\n"
      "3,pending,30,20.1\n4,rebel,1\n4,normal,30,20\n");
  EXPECT_EQ(said.counts.verdicts, 6);
  EXPECT_EQ(said.counts.without_corner, 2);
  EXPECT_EQ(said.counts.repeated, 2);
  EXPECT_EQ(said.counts.corners(), 2);
  EXPECT_EQ(said.recording.frames[3].verdicts[1], Verdict::pending);
  EXPECT_EQ(said.recording.frames[4].verdicts[1], Verdict::rebel);
  EXPECT_EQ(lines_of(said.counts),
            (std::vector<std::string>{
                "2 of 6 verdicts are on no corner: there is none within 2 px",
                "2 of 6 verdicts are on a corner that has one already: the nearest holds"}));
}

TEST_F(DetectionsTest, OfTwoCornersInReachTakeTheNearerThatIsFree) {
  Recording close =
      test::recording_of({test::FrameMaker(0)
                              .corner(Verdict::normal, Label::fixed, 0, false, {10, 10})
                              .corner(Verdict::normal, Label::fixed, 0, false, {10.5, 10})});
  const auto verdicts = [&](const char* text) {
    std::ofstream(path_) << text;
    return read_detections(path_, close).recording.frames[0].verdicts;
  };
  EXPECT_EQ(verdicts("0,rebel,10.3,10\n"), (std::vector{Verdict::normal, Verdict::rebel}));
  EXPECT_EQ(verdicts("0,rebel,10.3,10\n0,pending,10.3,10\n"),
            (std::vector{Verdict::pending, Verdict::rebel}));
  // The nearest pair is matched first, in any order of rows.
  for (const char* text :
       {"0,rebel,10.2,10\n0,pending,10.6,10\n", "0,pending,10.6,10\n0,rebel,10.2,10\n"}) {
    EXPECT_EQ(verdicts(text), (std::vector{Verdict::rebel, Verdict::pending})) << text;
  }
  EXPECT_EQ(verdicts("0,rebel,12,10\n0,pending,10.6,10\n"),
            (std::vector{Verdict::rebel, Verdict::pending}))
      << "a corner for each, if not its nearest";
}

TEST_F(DetectionsTest, BoxesArePixelEdgesAsThoseOfTheTruth) {
  // The truth's box is columns 20 to 59, rows 10 to 39.
  std::string rows;
  for (int k = 3; k < 6; ++k) rows += fmt::format("{},box,7,20,10,40,30\n", k);
  const scoring::Metrics metrics = scoring::score(detections(rows).recording);
  EXPECT_EQ(scoring::value(metrics, "truth.boxes"), 0)
      << "with two corners on it, it is not eligible";
  const Square box = detections(rows).recording.frames[3].layers.squares.at(0);
  EXPECT_EQ(box.id, 7u);
  EXPECT_EQ(box.location, Vec2(39.5, 24.5));
  EXPECT_EQ(box.half_size, Vec2(20, 15));
  const Square same =
      detections("3,square,7,39.5,24.5,20,15").recording.frames[3].layers.squares[0];
  EXPECT_EQ(same.location, box.location);
  EXPECT_EQ(same.half_size, box.half_size);
  EXPECT_EQ(same.outline.count, 0);
  const Square outlined = detections("3,square,7,39.5,24.5,20,15,20,10,59,10.5,30,39")
                              .recording.frames[3]
                              .layers.squares[0];
  ASSERT_EQ(outlined.outline.count, 3);
  EXPECT_EQ(outlined.outline.places[1], Vec2(59, 10.5));
}

TEST_F(DetectionsTest, MasksAreTheBoxesThatHoldThem) {
  // Masks of 48 x 96 pixels: strings and boxes (left, top, width, height) from pycocotools.
  const std::pair<const char*, Eigen::Vector4d> masks[] = {
      {"Zn0n0b00000000000000000000000000000000000000000000000000000000000000000000000000"
       "0000fe1",
       {20, 10, 40, 30}},
      {"dn0>Q17JO001O001O0016I01O001O001O07JO001O001O1O25JO2N1O2N1O2N16KN1O2N1O2N1O25JO2N1O^e1",
       {20, 10, 40, 30}},
      {"o52oY4", {3, 0, 2, 48}},
      {"0P`4", {0, 0, 96, 48}},
      {"03m_4", {0, 0, 1, 3}},
      {R"(e]1110;0S40\N0nM0R10\O0\O0P30K0_N0b20jL070h10aM0^O0j00g00gN0l00\O0e20]N)"
       "0e30QK0:0]40P10iK0b40WK0N0af0",
       {30, 6, 50, 35}},
      {"147,2,4459", {3, 3, 1, 2}},  // as numbers: 3 columns of 48, 3 pixels, 2 of the mask
  };
  for (const auto& [word, box] : masks) {
    const Square square =
        detections(fmt::format("3,mask,7,48,96,{}", word)).recording.frames[3].layers.squares.at(0);
    EXPECT_EQ(square.id, 7u);
    EXPECT_EQ(square.location - square.half_size, Vec2(box[0] - 0.5, box[1] - 0.5)) << word;
    EXPECT_EQ(2 * square.half_size, Vec2(box[2], box[3])) << word;
    const SquareMasks said =
        detections(fmt::format("3,mask,7,48,96,{}", word)).recording.frames[3].masks;
    ASSERT_EQ(said.size(), 1u);
    // The string again: the mask's runs within its box cover the whole mask.
    if (std::string_view(word).find(',') == std::string_view::npos) {
      EXPECT_EQ(packed_runs(sim::runs_in(cv::Rect(0, 0, 96, 48), said.at(7))), word);
    }
  }
}

TEST_F(DetectionsTest, CirclesCountForFalseObjects) {
  // One circle on the mover, one on empty ground, in three frames after the warm-up.
  std::string rows;
  for (int k = 3; k < 6; ++k) rows += fmt::format("{0},circle,40,25,5\n{0},circle,200,200,5\n", k);
  EXPECT_EQ(scoring::value(scoring::score(detections(rows).recording),
                           "rebel.false_objects_per_100_frames"),
            100);
}

TEST_F(DetectionsTest, WithoutCirclesFalseObjectsAreUnknownAndNotNone) {
  constexpr const char* kFigures[] = {"rebel.false_objects_per_100_frames", "rebel.circle_recall"};
  const std::string rebels = "3,rebel,0\n3,rebel,1\n3,rebel,2\n4,box,1,0,0,4,4\n";
  const Detections silent = detections(rebels);
  EXPECT_FALSE(silent.recording.detector.circles);
  for (const char* figure : kFigures)
    EXPECT_FALSE(scoring::value(scoring::score(silent.recording), figure)) << figure;
  // A row without values means that there are no circles.
  const Detections none = detections(rebels + "0,circle\n");
  EXPECT_TRUE(none.recording.detector.circles);
  EXPECT_EQ(scoring::value(scoring::score(none.recording), "rebel.false_objects_per_100_frames"),
            0);
}

TEST_F(DetectionsTest, TakeSpacesCommentsEmptyLinesAndAHeader) {
  const Detections said =
      detections("# by me\r\nframe,type,x,y\r\n\r\n 3 , rebel , 30 , 20 \r\n\t\n3,rebel,50,20");
  EXPECT_EQ(said.counts.corners(), 2);
  EXPECT_EQ(said.recording.frames[3].verdicts[2], Verdict::rebel);
}

TEST_F(DetectionsTest, EveryBadRowIsToldWithItsLineAndWhatToWriteInstead) {
  const std::map<std::string, std::string> bad{
      {"3", "a row begins with FRAME,TYPE; there is one field"},
      {"three,rebel,1", "the frame is 'three'; give its number"},
      {",rebel,1", "the frame is ''; give its number"},
      {"3.0,rebel,1", "the frame is '3.0'; give its number"},
      {"6,rebel,1", "there is no frame 6: the sequence has 0 to 5; give one of these"},
      {"-1,rebel,1", "there is no frame -1: the sequence has 0 to 5; give one of these"},
      {"3,",
       "there is no type ''; give ignored, pending, normal, rebel, box, mask, square or circle"},
      {"3,Rebel,1",
       "there is no type 'Rebel'; give ignored, pending, normal, rebel, box, mask, square or "
       "circle"},
      {"3,rebel", "rebel names no corner; give it an INDEX, or X,Y"},
      {"3,normal,1,2,3", "normal names no corner; give it an INDEX, or X,Y"},
      {"3,rebel,x,20", "x is 'x'; give a number"},
      {"3,rebel,10,nan", "y is 'nan'; give a number"},
      {"3,rebel,inf,20", "x is 'inf'; give a number"},
      {"3,rebel,1e999,20", "x is '1e999'; give a number"},
      {"3,rebel,10 px,20", "x is '10 px'; give a number"},
      {"3,rebel,-1", "the corner is '-1'; give its index from 0 on, or x and y"},
      {"3,rebel,1.5", "the corner is '1.5'; give its index from 0 on, or x and y"},
      {"3,rebel,4", "there is no corner 4: frame 3 has 4; count them from 0"},
      {"3,rebel,0\n3,normal,0", "corner 0 of frame 3 has a verdict already; give one for each"},
      {"3,box,1,2,3,4", "not all of a box is there; give ID,LEFT,TOP,WIDTH,HEIGHT"},
      {"3,box,-1,0,0,4,4", "the id is '-1'; give a whole number from 0 on"},
      {"3,box,a,0,0,4,4", "the id is 'a'; give a whole number from 0 on"},
      {"3,box,1,0,0,0,4", "width is 0; it must be above 0"},
      {"3,box,1,0,0,4,-4", "height is -4; it must be above 0"},
      {"3,box,1,,0,4,4", "left is ''; give a number"},
      {"3,box,1,0,0,4,4\n3,square,1,9,9,4,4",
       "the frame has a box 1 already; an id is one object's"},
      {"3,mask,1,48,96", "not all of a mask is there; give ID,HEIGHT,WIDTH,COUNTS"},
      {"3,mask,1,48,x,0P`4", "the mask's width is 'x'; give the picture's size"},
      {"3,mask,1,24,48,0Pb0",
       "the mask is of 48 x 24 pixels, and a corner lies at 50, 20; give one of the picture's "
       "size"},
      {"3,mask,1,48,96,0P`", "the mask's counts end within a number; give all of them"},
      {"3,mask,1,48,96,0P!4",
       "the mask's counts have '!' where none can be; give COCO's word or its numbers"},
      {"3,mask,1,48,96,oooooooo4",
       "the mask's counts have 'o' where none can be; give COCO's word or its numbers"},
      {"3,mask,1,48,96,0,4608.5", "a count of the mask is '4608.5'; give whole numbers"},
      {"3,mask,1,48,96,0,9,4598",
       "the mask's counts do not add up to 48 x 96 pixels; give all of them, of pixels outside "
       "first"},
      {"3,mask,1,48,96,9,-9,4608",
       "the mask's counts do not add up to 48 x 96 pixels; give all of them, of pixels outside "
       "first"},
      {"3,mask,1,48,96,P`4", "the mask has no pixel; leave out what is not seen"},
      {"3,mask,1,48,96,0P`4\n3,box,1,0,0,4,4",
       "the frame has a box 1 already; an id is one object's"},
      {"3,square,1,2,3,4,5,6",
       "not all of a square is there; give ID,X,Y,HALF_WIDTH,HALF_HEIGHT[,X,Y,...], the latter of "
       "its outline"},
      {"3,square,1,2,3,4,5,6,seven", "y of the outline is 'seven'; give a number"},
      {"3,square,1,2,3,4",
       "not all of a square is there; give ID,X,Y,HALF_WIDTH,HALF_HEIGHT[,X,Y,...], the latter of "
       "its outline"},
      {"3,square,1,2,3,4,-0.5", "half height is -0.5; it must be 0 or more"},
      {"3,circle,1,2", "not all of a circle is there; give X,Y,RADIUS, or nothing"},
      {"3,circle,1,2,-1", "the radius is -1; it must be 0 or more"},
      {"3,rebel,1\nframe,type", "the frame is 'frame'; give its number"},
  };
  for (const auto& [rows, message] : bad) {
    const auto line = 2 + std::count(rows.begin(), rows.end(), '\n');
    EXPECT_EQ(error("2,rebel,0\n" + rows + "\n2,rebel,1\n"), fmt::format("{}: {}", line, message));
  }
}

TEST_F(DetectionsTest, DetectionsThatDoNotFitThePictureAreRefused) {
  const std::string outside =
      " lies outside of the picture, which has 96 x 48 pixels; leave out what is not in it";
  const std::string too_far =
      " reaches more than 10 times as far as the picture, which has 96 x 48 pixels; clip it to the "
      "picture";
  const std::string other_size = ", and the picture of 96 x 48; give one of the picture's size";
  const std::map<std::string, std::string> bad{
      {"3,mask,1,24,48,0Pb0", "the mask is of 48 x 24 pixels" + other_size},
      {"3,mask,1,96,192,0,18432", "the mask is of 192 x 96 pixels" + other_size},
      {"3,mask,1,96,48,0,4608", "the mask is of 48 x 96 pixels" + other_size},
      {"3,mask,1,120,2147483647,0,257698037640",
       "the mask is of 2147483647 x 120 pixels" + other_size},
      {"3,box,1,96,0,4,4", "the box from 95.5, -0.5 to 99.5, 3.5" + outside},
      {"3,box,1,0,48,4,4", "the box from -0.5, 47.5 to 3.5, 51.5" + outside},
      {"3,box,1,-4,0,4,4", "the box from -4.5, -0.5 to -0.5, 3.5" + outside},
      {"3,box,1,0,-4,4,4", "the box from -0.5, -4.5 to 3.5, -0.5" + outside},
      {"3,box,1,0,0,1060,4", "the box from -0.5, -0.5 to 1059.5, 3.5" + too_far},
      {"3,box,1,-1e300,0,2e300,4", "the box from -1e+300, -0.5 to 1e+300, 3.5" + too_far},
      {"3,square,1,200,20,4,4", "the box from 196, 16 to 204, 24" + outside},
      {"3,square,1,97,20,0,2", "the box from 97, 18 to 97, 22" + outside},
      {"3,square,1,20,20,1e308,1e308", "the box from -1e+308, -1e+308 to 1e+308, 1e+308" + too_far},
      {"3,square,1,20,20,4,4,200,9,210,9,210,20", "the outline from 200, 9 to 210, 20" + outside},
      {"3,square,1,20,20,4,4,9,9,2000,9,9,20", "the outline from 9, 9 to 2000, 20" + too_far},
      {"3,circle,120,20,5", "the circle from 115, 15 to 125, 25" + outside},
      {"3,circle,20,20,1e6", "the circle from -999980, -999980 to 1000020, 1000020" + too_far},
      {"3,rebel,98,20", "the corner at 98, 20" + outside},
      {"3,normal,20,1e30", "the corner at 20, 1e+30" + outside},
  };
  for (const auto& [row, message] : bad) {
    EXPECT_EQ(error("2,rebel,0\n" + row, seen_by_a_camera()), "2: " + message) << row;
  }
}

TEST_F(DetectionsTest, DetectionOverThePicturesEdgeIsKeptAsItIs) {
  const FrameRecord frame =
      detections(
          "3,box,1,-10,-10,20,20\n3,box,2,95.9,47.9,30,30\n3,square,3,96,20,0,3\n"
          "3,circle,100,20,5\n3,rebel,97,20\n3,mask,4,48,96,0,4608",
          seen_by_a_camera())
          .recording.frames[3];
  ASSERT_EQ(frame.layers.squares.size(), 4u);
  EXPECT_EQ(frame.layers.squares[0].location, Vec2(-0.5, -0.5));
  EXPECT_EQ(frame.layers.squares[0].half_size, Vec2(10, 10));
  EXPECT_EQ(frame.layers.squares[2].half_size, Vec2(0, 3));
  EXPECT_EQ(frame.layers.rebel_circles.size(), 1u);
}

TEST_F(DetectionsTest, WhereTheCameraIsNotKnownNothingIsFartherOutThanAnyPicture) {
  EXPECT_EQ(error("3,box,1,1e5,0,4,4"),
            "1: the box from 99999.5, -0.5 to 100003.5, 3.5 lies farther out than any picture "
            "reaches; give pixels");
  EXPECT_EQ(error("3,mask,1,120,2147483647,0,257698037640"),
            "1: the mask is of 2147483647 x 120 pixels; a picture has no side of more than 16384");
  EXPECT_EQ(detections("3,box,1,9999,0,4,4").recording.frames[3].layers.squares.size(), 1u);
}

TEST_F(DetectionsTest, AFrameHasNoMoreThanAsManyOfEachKind) {
  const auto rows = [](std::size_t count, const char* row) {
    std::string all;
    for (std::size_t i = 0; i < count; ++i) all += fmt::format(fmt::runtime(row), i);
    return all;
  };
  for (const auto& [most, row, what] :
       {std::tuple{kMostBoxes, "3,box,{},0,0,4,4\n", "boxes in the frame; give objects' boxes"},
        {kMostCircles, "3,circle,9,9,4\n", "circles in the frame; give objects' circles"},
        {kMostPlaces, "3,rebel,9,9\n",
         "verdicts by place in the frame; give the corners' indices"}}) {
    EXPECT_NO_THROW(detections(rows(most, row), seen_by_a_camera())) << row;
    EXPECT_EQ(error(rows(most + 1, row), seen_by_a_camera()),
              fmt::format("{}: there are more than {} {}", most + 1, most, what));
  }
  EXPECT_EQ(error("3,box,9007199254740992,0,0,4,4"),
            "1: the id is 9007199254740992; give a whole number up to 9007199254740991");
  EXPECT_EQ(detections("3,box,9007199254740991,0,0,4,4").recording.frames[3].layers.squares[0].id,
            kMostId);
}

TEST_F(DetectionsTest, AByteOrderMarkIsNotRead) {
  EXPECT_EQ(detections("\xef\xbb\xbf"
                       "3,rebel,3\n")
                .counts.verdicts,
            1);
  EXPECT_EQ(detections("\xef\xbb\xbf"
                       "frame,type,x,y\n3,rebel,3\n")
                .counts.verdicts,
            1);
}

TEST_F(DetectionsTest, AFileThatCannotBeReadIsNamed) {
  for (const std::filesystem::path& path : {folder_.path() / "none.csv", folder_.path()}) {
    const bool is_folder = path == folder_.path();
    EXPECT_EQ(test::refusal_of<input::Error>([&] { read_detections(path, sequence()); }),
              fmt::format("{}: {}; name a CSV file of detections", path.string(),
                          is_folder ? "this is a folder" : "there is no such file"));
  }
}

/// Random places and sizes with many digits, so that a lost bit is detected.
Recording awkward() {
  std::mt19937_64 random(5);
  const auto number = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  std::vector<FrameRecord> frames;
  for (int k = 0; k < 12; ++k) {
    test::FrameMaker frame(k);
    for (int i = 0; i < 30; ++i) {
      const bool moves = i % 3 == 0;
      frame.corner(static_cast<Verdict>(random() % 4), moves ? Label::rebel : Label::fixed, moves,
                   random() % 5 == 0, {10.f * static_cast<float>(i), 7.f * static_cast<float>(k)});
    }
    frame.object(1, {40, 30, 90, 80}, true).full();
    for (Id id = 1; id < 4; ++id) {
      Square square;
      square.id = id;
      square.location = {number(60, 70), number(50, 60)};
      square.half_size = {number(20, 30), number(20, 30)};
      for (int i = 0; i < 3 && k % 2 == 1; ++i) {
        square.outline.places[static_cast<std::size_t>(square.outline.count++)] = {number(40, 90),
                                                                                   number(30, 80)};
      }
      if (k % 3 == 2 && id == 1) {
        frame.record().masks[id] = {cv::Rect(45, 35, 50, 40), {7, 1500, 3, 490}};
        square = square_of(frame.record().masks[id], id);
      }
      frame.record().layers.squares.push_back(square);
      frame.rebel_circle({number(0, 300), number(0, 100)}, number(0, 40));
    }
    Square& thin = frame.record().layers.squares.emplace_back();  // of corners in one column
    thin.id = 9;
    thin.location = {number(60, 70), number(50, 60)};
    thin.half_size = {0, number(20, 30)};
    frames.push_back(frame);
  }
  return test::recording_of(frames);
}

class StoredDetectionsTest : public DetectionsTest, public testing::WithParamInterface<bool> {};
INSTANTIATE_TEST_SUITE_P(CameraIsKnown, StoredDetectionsTest, testing::Bool());

TEST_P(StoredDetectionsTest, ReadAgainHaveTheSameFiguresToTheLastBit) {
  Recording recording = awkward();
  if (GetParam()) {
    recording.camera =
        Intrinsics{.focal_px = 300, .centre_px = {159.5, 119.5}, .width_px = 320, .height_px = 240};
  }
  scoring::write_detections(path_, recording);
  const Detections again = read_detections(path_, recording);
  EXPECT_EQ(again.counts.without_corner + again.counts.repeated, 0);
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    EXPECT_EQ(again.recording.frames[k].verdicts, recording.frames[k].verdicts);
  }
  const scoring::Metrics before = scoring::score(recording),
                         after = scoring::score(again.recording);
  EXPECT_GT(scoring::value(before, "square.mean_iou").value(), 0.5);
  EXPECT_EQ(scoring::value(before, "mover.region_j").has_value(), GetParam());
  EXPECT_GT(scoring::value(before, "rebel.false_objects_per_100_frames").value(), 0);
  for (const auto& [name, figure] : before) {
    if (name.starts_with("rebel.") || name.starts_with("square.") || name.starts_with("mover.") ||
        name.starts_with("truth.")) {
      EXPECT_EQ(scoring::value(after, name), figure) << name;
    }
  }
}

/// A field of a row, often an invalid or unusual one.
std::string tempting(std::mt19937& random) {
  static constexpr const char* kTempting[] = {"0",
                                              "-0",
                                              "1",
                                              "-1",
                                              "0.5",
                                              "47.5",
                                              "47.75",
                                              "96",
                                              "95.5",
                                              "1e3",
                                              "-1e3",
                                              "1056",
                                              "1e9",
                                              "1e30",
                                              "-1e300",
                                              "1e308",
                                              "5e-324",
                                              "-5e-324",
                                              "2e-308",
                                              "1e-30",
                                              "nan",
                                              "inf",
                                              "2147483648",
                                              "4294967296",
                                              "9007199254740991",
                                              "9007199254740992",
                                              "18446744073709551615",
                                              "18446744073709551616",
                                              "",
                                              "x",
                                              "48"};
  const auto chance = [&](unsigned parts) { return random() % parts; };
  if (chance(8) == 0) return kTempting[chance(std::size(kTempting))];
  if (chance(2) == 0) return std::to_string(chance(48));
  return fmt::format("{}", (static_cast<double>(chance(1u << 20)) / 8000) - 8);
}

std::string any_row(std::mt19937& random) {
  static constexpr std::pair<const char*, int> kKinds[] = {
      {"rebel", 1},  {"rebel", 2},   {"pending", 2}, {"box", 5},    {"mask", 5},
      {"square", 5}, {"square", 11}, {"square", 69}, {"circle", 3}, {"circle", 0}};
  const auto& [type, fields] = kKinds[random() % std::size(kKinds)];
  std::string row = fmt::format("{},{}", random() % 6, type);
  const int more = random() % 16 == 0 ? static_cast<int>(random() % 3) - 1 : 0;
  for (int i = 0; i < fields + more; ++i) {
    const bool is_id = i == 0 && fields >= 5;
    row += ',' + (is_id && random() % 8 != 0 ? std::to_string(random() % 1000) : tempting(random));
  }
  if (type != std::string_view("mask")) return row;
  const auto before = static_cast<std::int64_t>(random() % 4700);
  const auto inside = static_cast<std::int64_t>(random() % 4700);
  const std::int64_t after = 96 * 48 - before - inside;
  return fmt::format("{},mask,{},{},{},{},{},{}", random() % 6, random() % 1000,
                     random() % 16 == 0 ? tempting(random) : "48",
                     random() % 16 == 0 ? tempting(random) : "96", before, inside, after);
}

/// Requires bitwise equal and finite figures.
void expect_same(const scoring::Metrics& before, const scoring::Metrics& after,
                 const std::string& rows) {
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto& [name, figure] = before[i];
    EXPECT_EQ(after[i], before[i]) << name << " of\n" << rows;
    EXPECT_TRUE(!figure || std::isfinite(*figure)) << name << " of\n" << rows;
  }
}

TEST_F(DetectionsTest, AnyRowIsRefusedOrKeptStoredReadAndScoredAlike) {
  std::mt19937 random(57);
  Recording frames = seen_by_a_camera();
  for (FrameRecord& frame : frames.frames) {  // with known masks and enough corners
    frame.object_truth[0].mask = {0, 1200};
    for (sim::CornerTruth& corner : frame.corner_truth) corner.object = 1;
  }
  int kept = 0, refused = 0;
  for (int trial = 0; trial < 40; ++trial) {
    std::string rows;
    for (int i = 0; i < 30; ++i) {
      const std::string row = any_row(random) + '\n';
      if (test::refusal_of<input::Error>([&] { detections(rows + row, frames); }) ==
          "nothing was refused") {
        rows += row;
        ++kept;
      } else {
        ++refused;
      }
    }
    const Recording said = detections(rows, frames).recording;
    const scoring::Metrics figures = scoring::score(said);

    const std::filesystem::path run = folder_.path() / "run";
    std::filesystem::create_directories(run);
    RecordingWriter writer(run, said);
    for (const FrameRecord& frame : said.frames) writer.write(frame);
    writer.close();
    const Recording stored = read_recording(run);
    expect_same(figures, scoring::score(stored), rows);

    scoring::write_detections(path_, stored);
    expect_same(figures, scoring::score(read_detections(path_, stored).recording), rows);
    if (HasFailure()) break;
  }
  EXPECT_GT(kept, 200);
  EXPECT_GT(refused, 200);
}

TEST_F(DetectionsTest, TheDocumentsRowsAreRead) {
  const std::string document = test::read(LCS_DETECTIONS_MD);
  const std::string begin = "```csv\n";
  const std::size_t from = document.find(begin) + begin.size();
  const std::string rows = document.substr(from, document.find("```", from) - from);
  const Detections said = detections(rows);
  EXPECT_EQ(said.counts.verdicts, 2);
  ASSERT_EQ(said.recording.frames[0].layers.squares.size(), 1u);
  const Square& box = said.recording.frames[0].layers.squares[0];
  EXPECT_EQ(box.location - box.half_size, Vec2(199.5, 179.5));
  // The rows follow from the document's program: its column names and field order.
  for (const char* part : {R"("rebel", x, y, sep=",")", R"("box", 1, 200, 180, 100, 120, sep=",")",
                           R"(frame["corners"]["x"])", R"(frame["index"])"}) {
    EXPECT_NE(document.find(part), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace lcs::recording
