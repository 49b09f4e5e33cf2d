// Boxes of moving objects, drawn by people, in the formats of MOTChallenge and COCO, and the
// scores against them.
#include "tools/recording/labels.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "tests/tools/recordings.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/scoring.h"

namespace lcs::recording {
namespace {

class LabelsFile : public testing::Test {
 protected:
  Labels labels(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return read_labels(path_);
  }
  /// Those of a recording with pictures 0.png, 1.png, ...
  static Labels joined(Labels all, int pictures, const std::string& ending = ".png") {
    std::vector<Labels::Recorded> recorded;
    for (int i = 0; i < pictures; ++i) recorded.push_back({i, std::to_string(i) + ending});
    all.remarks = all.join(recorded);
    return all;
  }
  /// The error message after the folder's name.
  std::string refusal(const std::string& text) const {
    const std::string what = test::refusal_of<input::Error>([&] { labels(text); });
    EXPECT_TRUE(what.starts_with(folder_.path().string())) << what;
    return what.substr(std::min(folder_.path().string().size() + 1, what.size()));
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "gt.txt";
};

void expect_box(const LabelledBox& box, int id, double left, double top, double right,
                double bottom) {
  EXPECT_EQ(box.id, id);
  EXPECT_EQ(box.left, left);
  EXPECT_EQ(box.top, top);
  EXPECT_EQ(box.right, right);
  EXPECT_EQ(box.bottom, bottom);
}

TEST_F(LabelsFile, MotCountsFramesAndPixelsFromOne) {
  const Labels all =
      joined(labels("\xEF\xBB\xBF"
                    "1,7,1,1,10,20,1,1,1\r\n\n3, 7 ,912.5,484,97,109,0,7,0.5\n3,-1,5,6,7,8\n"),
             4);
  ASSERT_NE(all.of(0), nullptr);
  ASSERT_EQ(all.of(0)->size(), 1u);
  expect_box(all.of(0)->front(), 7, 0, 0, 10, 20);
  EXPECT_FALSE(all.of(0)->front().ignored);
  EXPECT_EQ(all.of(1), nullptr) << "nobody looked at it";
  ASSERT_NE(all.of(2), nullptr);
  ASSERT_EQ(all.of(2)->size(), 2u);
  expect_box(all.of(2)->at(0), 7, 911.5, 483, 1008.5, 592);
  EXPECT_TRUE(all.of(2)->at(0).ignored);
  expect_box(all.of(2)->at(1), -1, 4, 5, 11, 13);
  EXPECT_FALSE(all.of(2)->at(1).ignored) << "considered, unless it says otherwise";
  EXPECT_EQ(all.remarks.back(),
            "labels: 2 of 2 labelled pictures, with 3 of 3 boxes, belong to the 4 pictures of the "
            "recording");
}

TEST_F(LabelsFile, MotWithAFrameZeroCountsFromZero) {
  const Labels all = joined(labels("0,1,1,1,5,5\n2,1,1,1,6,6\n"), 3);
  ASSERT_NE(all.of(2), nullptr);
  expect_box(all.of(2)->front(), 1, 0, 0, 6, 6);
  EXPECT_EQ(all.remarks.front(), "labels: their frames count from 0, not from 1");
}

constexpr const char* kCoco = R"(
    {"images": [{"id": 5.0, "file_name": "left/0.png"}, {"id": 9, "file_name": "1.png"}],
     "annotations": [
       {"id": 1, "image_id": 5, "bbox": [0, 0.5, 10, 20], "track_id": 4.0, "iscrowd": false},
       {"id": 2, "image_id": 5, "bbox": [-3, 0, 8, 9], "iscrowd": 1}]})";

TEST_F(LabelsFile, CocoNamesPictures) {
  const Labels all = joined(labels(kCoco), 3);
  ASSERT_NE(all.of(0), nullptr);
  ASSERT_EQ(all.of(0)->size(), 2u);
  expect_box(all.of(0)->at(0), 4, 0, 0.5, 10, 20.5);
  EXPECT_FALSE(all.of(0)->at(0).ignored);
  expect_box(all.of(0)->at(1), -1, -3, 0, 5, 9);
  EXPECT_TRUE(all.of(0)->at(1).ignored);
  ASSERT_NE(all.of(1), nullptr);
  EXPECT_TRUE(all.of(1)->empty()) << "looked at, and nothing moves in it";
  EXPECT_EQ(all.of(2), nullptr);
}

TEST_F(LabelsFile, NamesWithOtherEndingsAreFoundAndTold) {
  const Labels all = joined(labels(kCoco), 3, ".jpg");
  ASSERT_NE(all.of(0), nullptr);
  EXPECT_EQ(all.remarks.front(),
            "labels: they name pictures with other endings than the recording");
}

/// \param first frame_id of the first of three pictures.
std::string numbered(int first, const std::string& name) {
  std::string images, boxes;
  for (int i = 0; i < 3; ++i) {
    images += fmt::format(R"({}{{"id": {}, "file_name": "{}", "frame_id": {}}})", i ? "," : "", i,
                          fmt::format(fmt::runtime(name), i), first + i);
    boxes += fmt::format(R"({}{{"image_id": {}, "bbox": [{}, 0, 1, 1]}})", i ? "," : "", i, i);
  }
  return fmt::format(R"({{"images": [{}], "annotations": [{}]}})", images, boxes);
}

TEST_F(LabelsFile, ANameCountsMoreThanAFrameIdThatBeginsAtOne) {
  const Labels all = joined(labels(numbered(1, "{}.png")), 3);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(all.of(i)->front().left, i);
}

TEST_F(LabelsFile, FrameIdsOfAVideoCountFromOneIfTheyEndWithTheCountOfPictures) {
  const Labels from_one = joined(labels(numbered(1, "a.mp4")), 3, "");
  EXPECT_EQ(from_one.of(0)->front().left, 0);
  EXPECT_EQ(from_one.remarks.front(), "labels: frame_id is taken to count from 1");
  const Labels from_zero = joined(labels(numbered(0, "a.mp4")), 3, "");
  EXPECT_EQ(from_zero.of(0)->front().left, 0);
  EXPECT_EQ(from_zero.remarks.front(), "labels: frame_id is taken to count from 0");
}

/// Those of images with numbers in their names, as 000011.png.
std::vector<std::string> join(Labels& all, std::size_t from, int count, std::size_t images,
                              std::optional<std::size_t> named_first) {
  std::vector<Labels::Recorded> recorded;
  for (int i = 0; i < count; ++i) {
    const std::size_t named = from + static_cast<std::size_t>(i);
    recorded.push_back({i, fmt::format("/drive/img/{:06}.jpg", named), named});
  }
  return all.join(recorded, images, named_first);
}

std::string mot(int first, int last) {
  std::string rows;
  for (int frame = first; frame <= last; ++frame)
    rows += fmt::format("{},1,{},1,5,5\n", frame, frame);
  return rows;
}

TEST_F(LabelsFile, AreJoinedByTheNumbersInTheNamesOfPictures) {
  Labels part = labels(mot(1, 20));  // of pictures 11 to 20, and of others
  const std::vector<std::string> told = join(part, 11, 10, 10, {});
  EXPECT_EQ(part.of(0)->front().left, 11 - 1);
  EXPECT_EQ(told.at(0),
            "labels: frame 11 is 000011.jpg, by the numbers in the names of the pictures");
  EXPECT_TRUE(told.at(1).starts_with("labels: 10 of 20 labelled pictures")) << told.at(1);
  Labels from_zero = labels(mot(1, 4));  // MOT counts from 1, the names from 0
  join(from_zero, 0, 4, 4, 0);
  EXPECT_EQ(from_zero.of(0)->front().left, 1 - 1);
  Labels kitti = labels("1 3 Car 0 0 1.5 10 20 30 40 1.4 1.6 4 2 1 9 -1.5\n");  // from 0
  join(kitti, 1, 3, 3, 0);  // and picture 0 is missing
  EXPECT_NE(kitti.of(0), nullptr);
  Labels beyond = labels(mot(30, 40));
  EXPECT_NE(
      test::refusal_of<std::invalid_argument>([&] { join(beyond, 1, 20, 20, 1); }).find("0 of 11"),
      std::string::npos);
}

TEST_F(LabelsFile, BeyondTheLastOfPicturesThatAreNotCountedAreRefused) {
  Labels all = labels(mot(3, 9));
  std::vector<Labels::Recorded> video(6, {0, ""});
  for (int i = 0; i < 6; ++i) video[static_cast<std::size_t>(i)].number = i;
  EXPECT_NE(test::refusal_of<std::invalid_argument>([&] {
              all.join(video, 6);
            }).find("they go to frame 9, and the recording has 6 pictures"),
            std::string::npos);
  EXPECT_EQ(all.join(video, 9).at(0), "labels: frame 3 is picture 2, by the order of the pictures");
}

TEST_F(LabelsFile, OfTwoFoldersAreThoseOfTheFolderOfThePictures) {
  const std::string text = R"(
    {"images": [{"id": 1, "file_name": "CAM_FRONT/x.png"}, {"id": 2, "file_name": "CAM_BACK\\x.png"}],
     "annotations": [{"image_id": 1, "bbox": [1, 0, 1, 1]}, {"image_id": 2, "bbox": [2, 0, 1, 1]}]})";
  Labels all = labels(text);
  all.join({{0, "/data/CAM_BACK/x.png"}});
  EXPECT_EQ(all.of(0)->front().left, 2);
  all.join({{0, "/data/CAM_FRONT/x.jpg"}});
  EXPECT_EQ(all.of(0)->front().left, 1) << "with another ending";
  EXPECT_EQ(
      test::refusal_of<std::invalid_argument>([&] {
        all.join({{0, "/data/pictures/x.png"}});
      }),
      "CAM_FRONT/x.png and CAM_BACK/x.png may both be the picture x.png: rename its folder to "
      "that of one");
}

TEST_F(LabelsFile, OfCocoLeaveBoxesWithoutAreaOutAndTellTheirCategories) {
  const Labels all = joined(labels(R"(
    {"categories": [{"id": 1, "name": "car"}, {"id": 2, "name": "tree"}],
     "images": [{"id": 1, "file_name": "0.png"}],
     "annotations": [{"image_id": 1, "bbox": [1, 0, 3, 0], "category_id": 1},
                     {"image_id": 1, "bbox": [2, 0, 1, 1], "category_id": 2}]})"),
                            1);
  ASSERT_EQ(all.of(0)->size(), 1u);
  EXPECT_EQ(all.of(0)->front().left, 2);
  EXPECT_EQ(all.remarks.at(0), "labels: boxes of all categories count as movers: car, tree");
  EXPECT_EQ(all.remarks.at(1), "labels: 1 boxes have no area and are left out");
}

TEST_F(LabelsFile, OfSeveralVideosOneIsNamed) {
  const std::string text = R"(
    {"videos": [{"id": 1, "name": "a"}, {"id": 2, "name": "b"}],
     "images": [{"id": 1, "video_id": 1, "frame_id": 0, "file_name": "a/0.png"},
                {"id": 2, "video_id": 2, "frame_id": 0, "file_name": "b/0.png"}],
     "annotations": [{"image_id": 1, "bbox": [1, 0, 1, 1]}, {"image_id": 2, "bbox": [2, 0, 1, 1]}]})";
  EXPECT_NE(refusal(text).find("it has several videos: a, b; name one (labels_video)"),
            std::string::npos)
      << refusal(text);
  EXPECT_EQ(joined(read_labels(path_, "b"), 1).of(0)->front().left, 2);
  EXPECT_THROW(read_labels(path_, "c"), input::Error);
}

TEST_F(LabelsFile, OfKittiTrackingCountFromZero) {
  const Labels all =
      joined(labels("0 -1 DontCare -1 -1 -10 1 2 3 4 -1 -1 -1 -1000 -1000 -1000 -10\n"
                    "1 3 Car 0 0 1.5 10.5 20 30.5 40 1.4 1.6 4 2 1 9 -1.5\n"),
             2);
  EXPECT_TRUE(all.of(0)->front().ignored);
  expect_box(all.of(1)->front(), 3, 10.5, 20, 30.5, 40);
}

TEST_F(LabelsFile, LabelsOfNoPictureAreRefused) {
  const Labels all = labels("372,1,1,1,5,5\n");
  const std::string what = test::refusal_of<std::invalid_argument>([&] { joined(all, 40); });
  EXPECT_EQ(what,
            "0 of 1 labelled pictures, with 0 of 1 boxes, belong to the 40 pictures of the "
            "recording: the first labels are of picture 372, and the recording begins with 0.png");
}

TEST_F(LabelsFile, BrokenLabelsAreRefusedAtTheirLine) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "gt.txt: is empty; give boxes as gt.txt"},
      {" \n\n", "gt.txt: is empty"},
      {"1,1,0,0,5,5\n2,1,0,0,5\n",
       "gt.txt:2: 5 fields are too few for FRAME,ID,LEFT,TOP,WIDTH,HEIGHT"},
      {"-1,1,0,0,5,5\n", "gt.txt:1: the frame is '-1', which is not a whole number from 0"},
      {"0 1 Car 0 0 0 1 2 3\n", "gt.txt:1: 9 fields are too few for FRAME ID TYPE"},
      {"1.5,1,0,0,5,5\n", "the frame is '1.5', which is not a whole number"},
      {"1,a,0,0,5,5\n", "the id is 'a', which is no number"},
      {"1,1,nan,0,5,5\n", "the left side is 'nan', which is no number"},
      {"1,1,0,0,0,5\n", "gt.txt:1: the box has no area"},
      {"1,1,0,0,5,-5\n", "the box has no area"},
      {"1,1,1e7,0,5,5\n", "the box is not within a million pixels"},
      {"1,1,0,0,5,5,x\n", "the seventh field is 'x', which is no number"},
      {"1,1,0,0,5,5\n1,1,9,9,5,5\n", "gt.txt:2: object 1 has a box in that picture already"},
      {std::string("1,\0,0,0,5,5\n", 13), "gt.txt:1: the id is "},
      {"frame,id,left,top,width,height\n", "gt.txt:1: the frame is 'frame', which is no number"},
      {"{\n\"images\": [}", "gt.txt:2: not JSON at byte"},
      {"{}", "gt.txt: images is missing; give boxes as"},
      {R"({"images": [], "annotations": [{"image_id": 3, "bbox": [0, 0, 1, 1]}]})",
       "annotations[0].image_id is not the id of an image in the list"},
      {R"({"images": [{"id": 1, "file_name": "a"}, {"id": 1, "file_name": "b"}], "annotations": []})",
       "images[1].id is not one that no other image has"},
      {R"({"images": [{"id": 1, "file_name": "x/a"}, {"id": 2, "file_name": "x\\a"}], "annotations": []})",
       "images[1].file_name is not one that no other image has"},
      {R"({"images": [{"id": 1, "file_name": "a"}], "annotations": [{"image_id": 1, "bbox": [0, 0, -2, 1]}]})",
       "annotations[0].bbox is not a mover's box: the box has no area"},
      {R"({"images": [{"id": 1, "file_name": "a"}], "annotations": [{"image_id": 1, "bbox": [0, 0, 1]}]})",
       "annotations[0].bbox is not a list of 4 numbers"},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_NE(refusal(text).find(expected), std::string::npos) << refusal(text) << "\n" << text;
  }
  EXPECT_THROW(read_labels(folder_.path() / "nowhere.txt"), input::Error);
  EXPECT_THROW(read_labels(folder_.path()), input::Error) << "a folder";
}

LabelledBox labelled(double left, double top, double right, double bottom, bool ignored = false) {
  return {.id = -1, .left = left, .top = top, .right = right, .bottom = bottom, .ignored = ignored};
}

/// After the warm-up two labelled frames and one without labels: a box with three rebels, one of
/// them 3 px outside, one with two, an ignored one with a rebel, and rebels elsewhere.
Recording labelled_recording() {
  std::vector<FrameRecord> frames;
  for (int k = 0; k < 6; ++k) {
    test::FrameMaker frame(k);
    for (const Eigen::Vector2f& px : std::vector<Eigen::Vector2f>{
             {110, 110}, {120, 120}, {96.5F, 100}, {210, 110}, {220, 110}, {310, 310}, {400, 20}}) {
      frame.corner(Verdict::rebel, sim::Label::none, -1, false, px);
    }
    frame.corner(Verdict::normal, sim::Label::none, -1, false, {230, 120});
    frame.corner(Verdict::rebel, sim::Label::none, -1, false, {103.6F + 50, 100});  // 4.1 px off
    frame.square(1, {100, 100, 150, 140}).square(2, {200, 100, 250, 150});
    frame.rebel_circle({120, 115}, 10).rebel_circle({400, 20}, 5).rebel_circle({158, 110}, 40);
    frame.rebel_circle({310, 310}, 2)
        .rebel_circle({300, 130}, 60);  // ignored; over no corner of a box
    frames.push_back(frame);
    frames.back().layers.squares[0].circles = frames.back().layers.squares[0].rebel_circles = 1;
    frames.back().layers.squares[1].circles = 3;  // static
  }
  const std::vector<LabelledBox> boxes{labelled(100, 100, 150, 150), labelled(200, 100, 250, 150),
                                       labelled(300, 300, 320, 320, true)};
  frames[1].labels = boxes;  // in the warm-up
  frames[3].labels = boxes;
  frames[5].labels.emplace();  // nothing moves in it
  Recording recording = test::recording_of(std::move(frames));
  recording.truth = Truth::unknown;
  return recording;
}

TEST(ScoreLabels, CountsWhatIsOnAndOffThem) {
  const scoring::Metrics metrics = scoring::score(labelled_recording());
  EXPECT_EQ(scoring::value(metrics, "labels.frames"), 2);
  EXPECT_EQ(scoring::value(metrics, "labels.boxes"), 2);
  EXPECT_EQ(scoring::value(metrics, "labels.found"), 0.5) << "two corners do not find one";
  EXPECT_EQ(scoring::value(metrics, "labels.boxed_50"), 0.5)
      << "a square that stands boxes no mover";
  // in the first frame (400, 20) and (153.6, 100); in the second all eight
  EXPECT_EQ(scoring::value(metrics, "labels.rebels_off_per_frame"), (2 + 8) / 2.0);
  // in the first frame those at (400, 20) and (300, 130), in the second all five
  EXPECT_EQ(scoring::value(metrics, "labels.circles_off_per_100_frames"), 100 * (2 + 5) / 2.0);
}

TEST(ScoreLabels, AStrangersBoxMayBeOfAMover) {
  Recording recording = labelled_recording();
  for (FrameRecord& frame : recording.frames) {
    for (Square& square : frame.layers.squares) square.circles = square.rebel_circles = 0;
  }
  EXPECT_EQ(scoring::value(scoring::score(recording), "labels.boxed_50"), 1);
}

TEST(ScoreLabels, OneSquareBoxesOneMover) {
  Recording recording = labelled_recording();
  FrameRecord& frame = recording.frames[3];
  frame.layers.squares.resize(1);
  frame.labels = {labelled(100, 100, 150, 138), labelled(100, 100, 150, 140)};
  EXPECT_EQ(scoring::value(scoring::score(recording), "labels.boxed_50"), 0.5);
}

TEST(ScoreLabels, WithoutLabelsAndTruthOnlySizesAndTimesAreKnown) {
  Recording recording = labelled_recording();
  for (FrameRecord& frame : recording.frames) frame.labels.reset();
  for (const auto& [name, figure] : scoring::score(recording)) {
    const bool is_told = name.starts_with("rebel.") || name.starts_with("truth.") ||
                         name.starts_with("square.") || name.starts_with("labels.");
    if (is_told) {
      EXPECT_FALSE(figure) << name;
    }
  }
  EXPECT_EQ(scoring::value(scoring::score(recording), "dimension.corners_mean"), 9);
}

TEST(ScoreLabels, WhereNothingMovesEveryRebelIsFalse) {
  Recording recording = labelled_recording();
  recording.truth = Truth::nothing_moves;
  for (FrameRecord& frame : recording.frames) set_corner_truth(recording.truth, frame);
  const scoring::Metrics metrics = scoring::score(recording);
  EXPECT_EQ(scoring::value(metrics, "rebel.false_corners_per_frame"), 8);
  EXPECT_EQ(scoring::value(metrics, "rebel.false_objects_per_100_frames"), 500);
  EXPECT_EQ(scoring::value(metrics, "truth.fixed_corners"), 3 * 9);
  EXPECT_EQ(scoring::value(metrics, "rebel.recall"), std::nullopt);
  EXPECT_EQ(scoring::value(metrics, "square.precision_50"), std::nullopt)
      << "where objects are is unknown";
  EXPECT_EQ(scoring::value(metrics, "truth.objects"), std::nullopt);
}

TEST(ScoreLabels, ARecordingKeepsThem) {
  const test::TemporaryFolder folder;
  const Recording recording = labelled_recording();
  RecordingWriter writer(folder.path(), recording);
  for (const FrameRecord& frame : recording.frames) writer.write(frame);
  writer.close();
  const Recording read = read_recording(folder.path());
  EXPECT_EQ(read.truth, Truth::unknown);
  EXPECT_FALSE(read.frames[4].labels);
  ASSERT_TRUE(read.frames[5].labels);
  EXPECT_TRUE(read.frames[5].labels->empty());
  ASSERT_EQ(read.frames[3].labels.value().size(), 3u);
  expect_box(read.frames[3].labels->at(0), -1, 100, 100, 150, 150);
  EXPECT_TRUE(read.frames[3].labels->at(2).ignored);
  EXPECT_EQ(scoring::score(read), scoring::score(recording));
  EXPECT_TRUE(without_detections(read).frames[3].labels) << "and who asks again has them";
  EXPECT_EQ(without_detections(read).truth, Truth::unknown);
}

}  // namespace
}  // namespace lcs::recording
