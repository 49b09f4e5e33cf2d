#include "tools/scoring/events.h"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "tests/scoring/whole_recordings.h"
#include "tests/tools/recordings.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/output/event_pictures.h"

namespace lcs::scoring {
namespace {

constexpr int kFrames = 20, kCorners = 6;
const test::PixelBox kMover{100, 100, 140, 150};

/// A mover with six corners, of which `missed` are missed, and a static wall far from it.
test::FrameMaker frame_of(int index, int missed, Reason reason = Reason::normal_edge) {
  test::FrameMaker frame(index);
  frame.object(1, kMover, true);
  for (int i = 0; i < kCorners; ++i) {
    const bool is_missed = i < missed;
    frame.corner(is_missed ? Verdict::normal : Verdict::rebel, sim::Label::rebel, 1, false,
                 {105.0f + static_cast<float>(5 * i), 120});
    frame.record().reasons.push_back(is_missed ? reason : Reason::rebel_edge);
  }
  for (int i = 0; i < 4; ++i) {
    frame.corner(Verdict::normal, sim::Label::fixed, 0, false,
                 {400.0f + static_cast<float>(10 * i), 300});
    frame.record().reasons.push_back(Reason::normal_edge);
  }
  return frame;
}

/// Calls `corners` of the wall's corners rebels.
void accuse(test::FrameMaker& frame, int corners, Eigen::Vector2f shift = {0, 0}) {
  for (int i = 0; i < corners; ++i) {
    frame.record().corners_px[kCorners + i] += shift;
    frame.record().verdicts[kCorners + i] = Verdict::rebel;
    frame.record().reasons[kCorners + i] = Reason::inherited;
  }
}

/// A recording with `missed(k)` missed corners in frame k.
template <class Missed>
recording::Recording recording_with(Missed&& missed) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < kFrames; ++k) frames.push_back(frame_of(k, missed(k)));
  return test::recording_of(frames);
}

int all_until(int last, int k) {
  return k <= last ? kCorners : 0;
}

RebelCounts total(const recording::Recording& recording) {
  RebelCounts sum;
  for (const RebelCounts& frame : score_frames(recording)) sum += frame;
  return sum;
}

TEST(Events, ARunWithoutFaultsHasNone) {
  EXPECT_TRUE(find_events(recording_with([](int) { return 0; })).empty());
  EXPECT_TRUE(find_events(test::recording_of({})).empty());
}

TEST(Events, AnObjectThatIsNeverFoundIsOneOverAllFramesThatCount) {
  const recording::Recording recording = recording_with([](int) { return kCorners; });
  const auto events = find_events(recording);
  ASSERT_EQ(events.size(), 1u);
  const ScoredEvent& event = events[0];
  EXPECT_EQ(event.kind, EventKind::never_found);
  EXPECT_EQ(event.object, 1);
  EXPECT_EQ(event.object_name, "mover");
  EXPECT_EQ(event.first_frame, recording::kSightings);
  EXPECT_EQ(event.last_frame, kFrames - 1);
  EXPECT_EQ(event.corners, total(recording).missed_rebels);
  EXPECT_EQ(event.counted_corners, event.corners);
  EXPECT_EQ(event.reasons, (decltype(event.reasons){{Reason::normal_edge, event.corners}}));
}

TEST(Events, CountTheRadialCornersAmongTheMissedOnes) {
  recording::Recording recording = recording_with([](int) { return kCorners; });
  EXPECT_EQ(find_events(recording).at(0).radial_corners, 0);
  for (recording::FrameRecord& frame : recording.frames) {
    for (sim::CornerTruth& truth : frame.corner_truth) {
      truth.radial = truth.label == sim::Label::rebel;
    }
  }
  const ScoredEvent event = find_events(recording).at(0);
  EXPECT_EQ(event.radial_corners, event.corners);
}

TEST(Events, AnObjectThatIsFoundAtLastIsLate) {
  const auto events = find_events(recording_with([](int k) { return all_until(9, k); }));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::found_late);
  EXPECT_EQ(events[0].first_frame, recording::kSightings);
  EXPECT_EQ(events[0].last_frame, 9);
}

TEST(Events, AnObjectThatIsMissedLaterIsLost) {
  const auto events = find_events(recording_with([](int k) { return k >= 8 && k < 12 ? 4 : 0; }));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::lost);
  EXPECT_EQ(events[0].first_frame, 8);
  EXPECT_EQ(events[0].last_frame, 11);
  EXPECT_EQ(events[0].corners, 4 * 4);
  EXPECT_EQ(events[0].counted_corners, 4 * kCorners);
}

TEST(Events, HalfOfTheCornersMissedIsNone) {
  EXPECT_TRUE(find_events(recording_with([](int) { return kCorners / 2; })).empty());
}

TEST(Events, FramesOfOneMissMergeOverTwoGoodOnesNotOverThree) {
  const auto gap = [](int good) {
    return find_events(recording_with([good](int k) {
      return (k >= 5 && k < 8) || (k >= 8 + good && k < 11 + good) ? kCorners : 0;
    }));
  };
  ASSERT_EQ(gap(2).size(), 1u);
  EXPECT_EQ(gap(2)[0].last_frame, 12);
  EXPECT_EQ(gap(2)[0].counted_corners, 8 * kCorners) << "those of the good frames between too";
  EXPECT_EQ(gap(3).size(), 2u);
}

TEST(Events, ReasonsAreCountedMostFrequentFirst) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < kFrames; ++k) {
    frames.push_back(frame_of(k, kCorners, k < 8 ? Reason::first_sighting : Reason::normal_edge));
  }
  const auto events = find_events(test::recording_of(frames));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].reasons,
            (decltype(events[0].reasons){{Reason::normal_edge, 12 * kCorners},
                                         {Reason::first_sighting, 5 * kCorners}}));
}

TEST(Events, ADetectorWithoutReasonsHasUnknownOnes) {
  recording::Recording recording = recording_with([](int) { return kCorners; });
  for (recording::FrameRecord& frame : recording.frames) frame.reasons.clear();
  EXPECT_EQ(find_events(recording).at(0).reasons.at(0).first, Reason::unknown);
}

TEST(Events, FalseRebelsFarFromAnyMoverAreAnAlarmFollowedThroughTheFrames) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < kFrames; ++k) {
    test::FrameMaker frame = frame_of(k, 0);
    if (k >= 6 && k < 10) accuse(frame, 4, {0, static_cast<float>(3 * k)});
    frames.push_back(frame);
  }
  const auto events = find_events(test::recording_of(frames));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::false_alarm);
  EXPECT_EQ(events[0].object, 0);
  EXPECT_EQ(events[0].first_frame, 6);
  EXPECT_EQ(events[0].last_frame, 9);
  EXPECT_EQ(events[0].corners, total(test::recording_of(frames)).false_rebels);
  EXPECT_EQ(events[0].reasons.at(0).first, Reason::inherited);
}

TEST(Events, TwoFalseRebelsAreNoAlarm) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < kFrames; ++k) {
    test::FrameMaker frame = frame_of(k, 0);
    accuse(frame, 2);
    frames.push_back(frame);
  }
  EXPECT_TRUE(find_events(test::recording_of(frames)).empty());
}

TEST(Events, FalseRebelsRoundAMoverAreItsHalo) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < kFrames; ++k) {
    test::FrameMaker frame = frame_of(k, 0);
    accuse(frame, 4, {-290, -180});  // to x from 110 to 140, y = 120: in the mover's box
    frames.push_back(frame);
  }
  const auto events = find_events(test::recording_of(frames));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::halo);
  EXPECT_EQ(events[0].object, 1);
  EXPECT_EQ(events[0].corners, 4 * (kFrames - recording::kSightings));
}

TEST(Events, ARebelCircleWithNothingUnderItIsAFalseObjectAndOneOverAMoverIsNone) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < kFrames; ++k) {
    test::FrameMaker frame = frame_of(k, 0);
    frame.rebel_circle({120, 120}, 30);
    if (k == 7 || k == 8) frame.rebel_circle({500, 100}, 15);
    frames.push_back(frame);
  }
  const auto events = find_events(test::recording_of(frames));
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::circle_false);
  EXPECT_EQ(events[0].circles, 2);
  EXPECT_EQ(events[0].corners, 0);
  EXPECT_EQ(events[0].first_frame, 7);
}

TEST(Events, FalseObjectsAreKeptHoweverManyCornersAreMissedOrFalse) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < kFrames; ++k) {
    test::FrameMaker frame = frame_of(k, k < 12 ? kCorners : 0);
    if (k >= 15) accuse(frame, 4);
    frame.rebel_circle({500, 100}, 15);
    if (k < 10) frame.rebel_circle({400, 300}, 15);  // over one corner of the wall
    frames.push_back(frame);
  }
  const auto events = find_events(test::recording_of(frames), 1);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(family_of(events[0].kind), EventFamily::rebels);
  EXPECT_EQ(events[1].kind, EventKind::circle_false);
  EXPECT_EQ(events[1].circles, kFrames - recording::kSightings) << "that which is seen longer";
  EXPECT_EQ(find_events(test::recording_of(frames)).size(), 4u);
}

TEST(Events, NothingIsFalseDuringTheWarmUp) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < kFrames; ++k) {
    test::FrameMaker frame = frame_of(k, 0);
    if (k < recording::kSightings) accuse(frame, 4);
    if (k < recording::kSightings) frame.rebel_circle({500, 100}, 15);
    frames.push_back(frame);
  }
  EXPECT_TRUE(find_events(test::recording_of(frames)).empty());
}

TEST(Events, TheCostliestComeFirstAndNoMoreThanAskedFor) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < kFrames; ++k) {
    test::FrameMaker frame = frame_of(k, k >= 5 && k < 8 ? kCorners : 0);
    if (k >= 10) accuse(frame, 4);
    frames.push_back(frame);
  }
  const auto events = find_events(test::recording_of(frames));
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].kind, EventKind::false_alarm);
  EXPECT_EQ(events[0].corners, 40);
  EXPECT_EQ(events[1].corners, 18);
  EXPECT_EQ(find_events(test::recording_of(frames), 1).size(), 1u);
}

TEST(Events, UpToFiveFramesAreShownFromTheOneBeforeToTheOneAfter) {
  const auto events = find_events(recording_with([](int k) { return all_until(15, k); }));
  const std::vector<EventView>& views = events.at(0).views;
  ASSERT_EQ(views.size(), 5u);
  EXPECT_EQ(views.front().frame, recording::kSightings - 1);
  EXPECT_EQ(views.back().frame, 16);
  for (const EventView& view : views) {
    EXPECT_EQ(view.centre_px, Vec2(119.5, 124.5));
    EXPECT_EQ(view.half_size_px, Vec2(19.5, 24.5));
    EXPECT_NEAR(view.t_s, 0.1 * view.frame, 1e-12);
  }
}

// ---- Pictures

cv::Mat3b decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<unsigned char>(bits >> count & 255));
  }
  return cv::imdecode(bytes, cv::IMREAD_COLOR);
}

/// The events with their pictures, of frames that all show the same.
std::vector<ScoredEvent> painted(const recording::Recording& recording, const cv::Mat3b& picture) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / output::kPicturesFile;
  output::PicturesWriter writer(file);
  RebelScorer scorer;
  for (const recording::FrameRecord& frame : recording.frames) {
    writer.write(picture);
    scorer.add(frame);
  }
  writer.close();
  const output::FramePictures pictures(file, picture.size());
  auto events = find_events(recording);
  for (const recording::FrameRecord& frame : recording.frames) {
    if (!output::frames_shown(events).contains(frame.index)) continue;
    output::paint_views(frame, corner_outcomes(frame, scorer.detections()), pictures, events);
  }
  return events;
}

TEST(EventPictures, ShowTheMissedCornersInTheCutAroundTheObject) {
  const recording::Recording recording = recording_with([](int) { return kCorners; });
  for (const int width : {640, 1280}) {
    // The places are the same at any stored size of pictures.
    SCOPED_TRACE(width);
    const auto events =
        painted(recording, cv::Mat3b(width * 3 / 4, width, cv::Vec3b(128, 128, 128)));
    const EventView& view = events.at(0).views.at(2);
    const cv::Mat3b picture = decoded(view.jpeg_base64);
    ASSERT_EQ(picture.size(),
              cv::Size(output::kEventPictureWidth_px, output::kEventPictureHeight_px));
    // Grey except for the box and the corners: orange occurs, magenta and green do not.
    int orange = 0, magenta = 0, green = 0;
    for (const cv::Vec3b& px : picture) {
      orange += px[2] > 150 && px[2] - px[0] > 60 && px[1] > 90;
      magenta += px[2] > 180 && px[0] > 180 && px[1] < 110;
      green += px[1] > 180 && px[2] < 110 && px[0] < 110;
    }
    EXPECT_GT(orange, 20);
    EXPECT_EQ(magenta, 0);
    EXPECT_EQ(green, 0);
    // The object is centred in the picture.
    const cv::Vec3b left_of_box = picture(96, 4);
    EXPECT_NEAR(left_of_box[0], 128, 8);
    // The part that is shown is told in pixels of the image, whatever the size of the kept picture.
    // In the wide one the left edge of the image cuts it.
    EXPECT_NEAR(view.half_size_px.x(), 80.0 * width / 640, 1);
    EXPECT_NEAR(view.half_size_px.x() / view.half_size_px.y(), 4. / 3, 0.02);
    EXPECT_NEAR(view.centre_px.x(), width == 640 ? 119.5 : view.half_size_px.x() - 0.5, 1);
  }
}

TEST(EventPictures, AreWholeAtTheImagesBorder) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < kFrames; ++k) {
    test::FrameMaker frame(k);
    frame.object(1, {0, 0, 20, 20}, true);
    for (int i = 0; i < kCorners; ++i) {
      frame.corner(Verdict::pending, sim::Label::rebel, 1, false, {static_cast<float>(i), 0});
    }
    frames.push_back(frame);
  }
  const recording::Recording recording = test::recording_of(frames);
  const auto events = painted(recording, cv::Mat3b(60, 80, cv::Vec3b(9, 9, 9)));
  for (const EventView& view : events.at(0).views) {
    EXPECT_EQ(decoded(view.jpeg_base64).cols, output::kEventPictureWidth_px);
  }
}

// ---- The file

TEST(EventsFile, ComesBackAsItWas) {
  recording::Recording recording = recording_with([](int k) { return all_until(9, k); });
  recording.objects[0].name = "a \"mover\" <b>";
  auto events = find_events(recording);
  events.at(0).views.at(0).jpeg_base64 = base64("bytes");
  const test::TemporaryFolder folder;
  const auto file = folder.path() / kEventsFile;
  write_events(file, events, sums_of(events));
  const auto back = read_events(file);
  ASSERT_EQ(back.size(), events.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_EQ(back[i].kind, events[i].kind);
    EXPECT_EQ(back[i].first_frame, events[i].first_frame);
    EXPECT_EQ(back[i].last_frame, events[i].last_frame);
    EXPECT_EQ(back[i].object, events[i].object);
    EXPECT_EQ(back[i].object_name, events[i].object_name);
    EXPECT_EQ(back[i].corners, events[i].corners);
    EXPECT_EQ(back[i].counted_corners, events[i].counted_corners);
    EXPECT_EQ(back[i].radial_corners, events[i].radial_corners);
    EXPECT_EQ(back[i].circles, events[i].circles);
    EXPECT_EQ(back[i].reasons, events[i].reasons);
    ASSERT_EQ(back[i].views.size(), events[i].views.size());
    for (std::size_t v = 0; v < back[i].views.size(); ++v) {
      EXPECT_EQ(back[i].views[v].frame, events[i].views[v].frame);
      EXPECT_EQ(back[i].views[v].t_s, events[i].views[v].t_s);
      EXPECT_EQ(back[i].views[v].centre_px, events[i].views[v].centre_px);
      EXPECT_EQ(back[i].views[v].half_size_px, events[i].views[v].half_size_px);
      EXPECT_EQ(back[i].views[v].jpeg_base64, events[i].views[v].jpeg_base64);
    }
  }
}

TEST(EventsFile, MistakesAreToldWithTheFile) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / kEventsFile;
  const auto expect_error = [&](const std::string& part) {
    const std::string what = test::refusal_of<std::runtime_error>([&] { read_events(file); });
    EXPECT_NE(what.find(file.string()), std::string::npos) << what;
    EXPECT_NE(what.find(part), std::string::npos) << what;
  };
  expect_error("there is no such file");
  std::ofstream(file) << "{";
  expect_error(":1: not JSON at byte");
  std::ofstream(file) << R"({"events": [{"kind": "party"}]})";
  expect_error("events[0].kind is not a word that is known here: 'party'");
  std::ofstream(file) << R"({"events": [{"kind": "halo"}]})";
  expect_error("events[0].first_frame is missing");
}

TEST(Base64, IsThatOfTheStandard) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

// ---- Squares

constexpr test::PixelBox kCrate{300, 100, 380, 180}, kBeside{390, 100, 470, 180};

/// Events of frames with two crates and the squares added by `squares`.
template <class Squares>
std::vector<ScoredEvent> square_events(Squares&& squares) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < kFrames; ++k) {
    test::FrameMaker frame(k);
    for (const auto& [id, box] : {std::pair(1, kCrate), std::pair(2, kBeside)}) {
      frame.object(id, box, false);
      for (int i = 0; i < 4; ++i) {
        frame.corner(Verdict::normal, sim::Label::fixed, id, false,
                     {static_cast<float>(box.left + 10 * i), 120});
      }
    }
    squares(frame, k);
    frames.push_back(frame);
  }
  return find_square_events(test::recording_of(frames));
}

TEST(SquareEvents, ObjectsWithTheirSquaresHaveNone) {
  EXPECT_TRUE(square_events([](test::FrameMaker& frame, int) {
                frame.square(1, kCrate).square(2, kBeside);
              }).empty());
}

TEST(SquareEvents, SayWhatIsWrongInHowManyFrames) {
  const struct {
    EventKind kind;
    std::vector<test::PixelBox>
        squares;  // on the first crate, and on the second if they reach that far
    std::size_t events;
  } cases[] = {
      {EventKind::square_missed, {kBeside}, 1},
      {EventKind::square_split, {kBeside, {300, 100, 338, 180}, {342, 100, 380, 180}}, 1},
      {EventKind::square_split, {kBeside, kCrate, {310, 110, 330, 170}}, 1},
      {EventKind::square_merged, {{270, 70, 500, 210}}, 2},
      {EventKind::square_size, {kBeside, {330, 130, 420, 220}}, 1},
  };
  for (const auto& each : cases) {
    const auto events = square_events([&](test::FrameMaker& frame, int k) {
      if (k < 5 || k >= 15) {
        frame.square(90, kCrate).square(91, kBeside);
        return;
      }
      for (std::size_t i = 0; i < each.squares.size(); ++i) frame.square(i + 1, each.squares[i]);
    });
    SCOPED_TRACE(text_of(each.kind).word);
    ASSERT_EQ(events.size(), each.events);
    EXPECT_EQ(events[0].kind, each.kind);
    EXPECT_EQ(events[0].object_name, "mover");  // the name of the first object of these recordings
    EXPECT_EQ(events[0].frames, 10);
    EXPECT_EQ(events[0].of_frames, 10);
    EXPECT_EQ(events[0].first_frame, 5);
    EXPECT_EQ(events[0].last_frame, 14);
  }
}

TEST(SquareEvents, OneOnNoObjectIsFollowedByItsId) {
  const auto events = square_events([](test::FrameMaker& frame, int k) {
    frame.square(1, kCrate).square(2, kBeside);
    if (k >= 8 && k < 12) frame.square(7, {20, 300, 80, 360});
  });
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::square_false);
  EXPECT_EQ(events[0].frames, 4);
  EXPECT_EQ(events[0].of_frames, 0);
}

TEST(SquareEvents, TellHowFarTheObjectsCornersCame) {
  const auto events = square_events([](test::FrameMaker& frame, int) {
    frame.square(2, kBeside);
    Layers& layers = frame.record().layers;
    Circle circle;
    circle.location = {340, 140};  // in no square
    layers.normal_circles = {circle};
    for (const int corner : {0, 1, 2}) {  // three of the four on the first crate
      Edge edge;
      edge.corner = corner;
      edge.circle = corner == 0 ? -1 : 0;
      layers.normal_edges.push_back(edge);
    }
  });
  ASSERT_EQ(events.size(), 1u);
  constexpr int kFramesScored = kFrames - 3;
  const std::vector<std::pair<SquareStep, int>> steps{{SquareStep::no_square, 2 * kFramesScored},
                                                      {SquareStep::no_edge, kFramesScored},
                                                      {SquareStep::no_circle, kFramesScored}};
  EXPECT_EQ(events[0].steps, steps);

  const test::TemporaryFolder folder;
  write_events(folder.path() / kEventsFile, events, sums_of(events));
  const auto read = read_events(folder.path() / kEventsFile);
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].kind, EventKind::square_missed);
  EXPECT_EQ(read[0].steps, steps);
  EXPECT_EQ(read[0].frames, events[0].frames);
  EXPECT_EQ(read[0].of_frames, events[0].of_frames);
  EXPECT_EQ(read_event_sums(folder.path() / kEventsFile).squares,
            (std::map<EventKind, int>{{EventKind::square_missed, kFramesScored}}));
}

}  // namespace
}  // namespace lcs::scoring
