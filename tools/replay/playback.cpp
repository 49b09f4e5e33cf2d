#include "tools/replay/playback.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "scenarios/input/message.h"
#include "sim/pictures/picture_file.h"
#include "tools/files/csv.h"
#include "tools/replay/text_table.h"
#include "tools/sequence/replay_settings.h"

namespace lcs::replay {
namespace {

constexpr std::size_t kMostToldOneByOne = 5;

double frames_per_second(const std::vector<RecordedFrame>& frames) {
  if (frames.size() < 2) return 1;
  const double span_s = seconds(frames.back().t_ns - frames.front().t_ns);
  return static_cast<double>(frames.size() - 1) / span_s;
}

/// Refuses a fisheye's coefficients that are taken for a plain lens's: its tangential ones are
/// large, or the radius falls again far inside the picture.
void require_plain_lens(const Lens& lens, const cv::Size& size_px) {
  constexpr double kStep = 0.01, kFarthest = 10, kInside = 0.7, kMostTangential = 0.02;
  if (lens.distortion != Lens::Distortion::radial_tangential || lens.xi != 0) return;
  const auto k = [&](std::size_t i) {
    return i < lens.coefficients.size() ? lens.coefficients[i] : 0;
  };
  constexpr const char* kFisheye =
      "if its coefficients are a fisheye's (k1 to k4), give distortion_model: equidistant, or the "
      "option equidistant; else calibrate over the whole picture";
  if (std::max(std::abs(k(2)), std::abs(k(3))) > kMostTangential) {
    refuse(lens.source,
           "the distortion's p1 and p2 are {} and {}, and those of a lens are near 0; {}", k(2),
           k(3), kFisheye);
  }
  const auto bent = [&](double r) {
    const double r2 = r * r;
    return r * (1 + r2 * (k(0) + r2 * (k(1) + r2 * k(4)))) /
           (1 + r2 * (k(5) + r2 * (k(6) + r2 * k(7))));
  };
  const double corner = std::hypot(std::max(lens.cu_px, size_px.width - lens.cu_px) / lens.fu_px,
                                   std::max(lens.cv_px, size_px.height - lens.cv_px) / lens.fv_px);
  double farthest = 0;
  for (double r = 0; r < kFarthest && bent(r) >= farthest; r += kStep) farthest = bent(r);
  if (farthest >= kInside * corner) return;
  refuse(lens.source,
         "the radial distortion folds back at {:.0f} % of the way to the picture's corner; {}",
         100 * farthest / corner, kFisheye);
}

}  // namespace

Playback::Playback(const scenario::Scenario& asked)
    : scenario_(asked),
      recorded_(read_recorded(asked)),
      pictures_(recorded_.format, recorded_.video),
      truth_(asked.recording->nothing_moves ? recording::Truth::nothing_moves
             : recorded_.truth              ? recording::Truth::all
                                            : recording::Truth::unknown) {
  longest_s_ = kMostPeriods / usual_rate_hz(stamps_of(recorded_.frames)).value_or(1);
  take_settings();
  look_at_first_picture();
  require_events();
  read_mask();
  read_labels();
}

void Playback::require_events() const {
  const RecordingSource& asked = scenario_.recording.value();
  if (scenario_.corner_source == scenario::CornerSource::events && recorded_.events.empty()) {
    refuse(asked.source,
           "corners.from is 'events', and {} has none; remove the key, or give a recording of an "
           "event camera",
           asked.path.string());
  }
  for (const sim::Event& event : recorded_.events) {
    if (event.x < camera().width_px && event.y < camera().height_px) continue;
    refuse(asked.source,
           "an event of {} is at ({}, {}), and its pictures have {} x {} pixels; give both of one "
           "camera",
           asked.path.string(), event.x, event.y, camera().width_px, camera().height_px);
  }
}

void Playback::read_labels() {
  const RecordingSource& asked = scenario_.recording.value();
  if (!asked.labels) return;
  labels_ = recording::read_labels(*asked.labels, asked.labels_video);
  const PictureNumbers& all = recorded_.numbers;
  const auto first = all.begin();
  const std::size_t count = first ? *all.greatest - *first + 1 : all.pictures;
  std::vector<recording::Labels::Recorded> pictures;
  for (const RecordedFrame& frame : recorded_.frames) {
    const bool has_file = !frame.picture.empty();
    const fs::path file = has_file ? fs::absolute(frame.picture).lexically_normal() : fs::path();
    pictures.push_back({static_cast<int>(frame.number), file.string(), frame.named});
  }
  try {
    for (const std::string& line : labels_.join(pictures, count, first))
      recorded_.tally.tell("{}", line);
  } catch (const std::invalid_argument& error) {
    refuse({*asked.labels}, "{}; give the labels of this recording", error.what());
  }
}

/// Takes the detection settings of a generated sequence's run.
void Playback::take_settings() {
  const scenario::Scenario& own = recorded_.settings;
  if (!scenario_.world.contains("corners.threshold")) {
    scenario_.fast_threshold = own.fast_threshold;
  }
  if (scenario_.filter_preset.empty()) {
    scenario_.filter_preset = own.filter_preset;
    scenario_.filter_preset_source = own.filter_preset_source;
  }
  scenario_.filter.insert(scenario_.filter.begin(), own.filter.begin(), own.filter.end());
  scenario_.frames = static_cast<int>(recorded_.frames.size());
  scenario_.camera.rate_hz = frames_per_second(recorded_.frames);
}

void Playback::look_at_first_picture() {
  PictureReader pictures(recorded_.format, recorded_.video);
  std::optional<cv::Mat3b> first;
  for (std::size_t i = 0; i < recorded_.frames.size() && !first; ++i) {
    first = pictures.read(recorded_.frames[i]);
  }
  const RecordingSource& asked = scenario_.recording.value();
  if (!first) {
    refuse(asked.source,
           "none of the pictures in {} can be read (the first: {}); give a recording with its "
           "pictures",
           asked.path.string(), input::one_line(pictures.skipped().front()));
  }
  Lens& lens = recorded_.lens.value();
  const cv::Size size_px = first->size();
  if (lens.width_px > 0 && size_px != cv::Size(lens.width_px, lens.height_px)) {
    refuse(lens.source,
           "the calibration is of {} x {} pixels, and the pictures have {} x {}; give the "
           "calibration of these pictures, or focal",
           lens.width_px, lens.height_px, size_px.width, size_px.height);
  }
  // A calibration that states no size has its principal point near the middle of its pictures.
  const auto is_near = [](double centre, int side) {
    constexpr double kShare = 0.25;
    return std::abs(centre - 0.5 * (side - 1)) < kShare * side;
  };
  if (lens.width_px == 0 && !lens.centred && !asked.centre_px &&
      !(is_near(lens.cu_px, size_px.width) && is_near(lens.cv_px, size_px.height))) {
    refuse(lens.source,
           "the principal point is ({:.1f}, {:.1f}), near the middle of a picture of {:.0f} x "
           "{:.0f} pixels, and the pictures have {} x {}; give the calibration of these pictures, "
           "or focal, or centre if they were cut out",
           lens.cu_px, lens.cv_px, 2 * lens.cu_px + 1, 2 * lens.cv_px + 1, size_px.width,
           size_px.height);
  }
  if (lens.centred) {
    lens.cu_px = 0.5 * (size_px.width - 1);
    lens.cv_px = 0.5 * (size_px.height - 1);
  }
  require_plain_lens(lens, size_px);
  rectifier_.emplace(lens, size_px);
}

void Playback::read_mask() {
  const auto& file = scenario_.recording->mask;
  if (!file) return;
  constexpr double kWhite = 127;
  const input::Source& where = scenario_.recording->source;
  const cv::Mat grey = sim::read_picture(*file, where, cv::IMREAD_GRAYSCALE);
  const cv::Size size_px(camera().width_px, camera().height_px);
  if (grey.size() != size_px) {
    refuse(where,
           "the mask {} is of {} x {} pixels, and the pictures have {} x {}; give one of that "
           "size, white where the vehicle itself is seen",
           file->string(), grey.cols, grey.rows, size_px.width, size_px.height);
  }
  mask_ = grey > kWhite;
}

recording::RunInfo Playback::info() const {
  recording::RunInfo run;
  run.scenario = scenario_.name;
  run.seed = scenario_.seed;
  run.world = scenario_.world;
  run.origin = recorded_.settings.origin;
  run.camera = bench::intrinsics(camera());
  run.truth = truth_;
  if (truth_ == recording::Truth::all) run.objects = recorded_.truth->objects();
  return run;
}

bool Playback::next(recording::FrameRecord& frame, cv::Mat3b& image) {
  while (next_ < recorded_.frames.size()) {
    const RecordedFrame& recorded = recorded_.frames[next_++];
    std::optional<cv::Mat3b> picture = pictures_.read(recorded);
    if (!picture) continue;  // its time still passes
    image = *picture;
    events_ = std::span(recorded_.events).subspan(events_end_, recorded.events - events_end_);
    events_end_ = recorded.events;
    frame.index = index_++;
    frame.t_ns = recorded.t_ns;
    frame.motion = recorded_.motion->at(recorded.t_ns);
    if (frame.motion.dt_s > longest_s_) {
      recorded_.tally.add(
          "gaps are longer than four pictures, and the filter begins anew after them",
          fmt::format("{:.2f} s before {}", frame.motion.dt_s, recorded.name()));
      frame.motion = {};
    }
    const auto height_m = scenario_.recording->camera_height_m;
    const auto up_C = recorded_.motion->up_C();
    if (height_m && up_C) frame.motion.ground = Ground{.up_C = *up_C, .height_m = *height_m};
    grounded_ = frame.motion.ground.has_value();
    motion_check_.add(image, *rectifier_, recorded.t_ns, frame.motion);
    if (motion_check_.is_due()) require_right_motion();
    return true;
  }
  motion_check_.finish(*rectifier_);
  require_right_motion();
  return false;
}

void Playback::require_right_motion() const {
  const RecordingSource& asked = scenario_.recording.value();
  const fs::path& file = asked.poses ? *asked.poses : asked.imu ? *asked.imu : asked.path;
  motion_check_.require_right(*recorded_.motion, {file.string(), 0});
}

bool Playback::straighten(std::vector<Eigen::Vector2f>& corners_px, cv::Mat& picture) const {
  if (!mask_.empty()) {
    std::erase_if(corners_px, [&](const Eigen::Vector2f& px) {
      return mask_(cvRound(px.y()), cvRound(px.x())) != 0;
    });
  }
  if (rectifier_->is_pinhole()) return false;
  rectifier_->rectify(corners_px);
  rectifier_->rectify(picture);
  return true;
}

/// Matches corners by position: another threshold gives other corners.
void Playback::label_by_truth(const RecordedFrame& recorded, recording::FrameRecord& frame) {
  frame.corner_truth.assign(frame.corners_px.size(), {});
  corners_ += static_cast<int>(frame.corners_px.size());
  untold_ += static_cast<int>(frame.corners_px.size());
  const auto t_ns = files::number_in<std::int64_t>(recorded.picture.stem().native());
  const recording::FrameRecord* const found = t_ns ? recorded_.truth->at(*t_ns) : nullptr;
  if (found == nullptr) return;
  const recording::FrameRecord& truth = *found;
  std::map<std::pair<float, float>, std::size_t> places;
  for (std::size_t i = 0; i < truth.corners_px.size(); ++i) {
    places[{truth.corners_px[i].x(), truth.corners_px[i].y()}] = i;
  }
  for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
    const auto place = places.find({frame.corners_px[i].x(), frame.corners_px[i].y()});
    if (place == places.end()) continue;
    frame.corner_truth[i] = truth.corner_truth[place->second];
    --untold_;
  }
  frame.object_truth = truth.object_truth;
  frame.true_motion = recorded_.motion->exact().value_or(EgoMotion{});
}

void Playback::label(recording::FrameRecord& frame) {
  const RecordedFrame& recorded = recorded_.frames[next_ - 1];
  if (truth_ == recording::Truth::all) {
    label_by_truth(recorded, frame);
  } else {
    recording::set_corner_truth(truth_, frame);
  }
  const recording::Labels::Boxes* boxes = labels_.of(static_cast<int>(recorded.number));
  if (!boxes) return;
  frame.labels = *boxes;
  for (recording::LabelledBox& box : *frame.labels) {
    rectifier_->rectify(box.left, box.top, box.right, box.bottom);
  }
}

Diagnostics Playback::diagnostics() const {
  Diagnostics diagnostics = recorded_.motion->diagnostics();
  diagnostics.forget(Fault::imu_gap);  // reported by its reader, with the place
  return diagnostics;
}

std::vector<std::string> Playback::remarks() const {
  std::vector<std::string> lines;
  const std::vector<std::string>& skipped = pictures_.skipped();
  for (std::size_t i = 0; i < skipped.size() && i < kMostToldOneByOne; ++i) {
    lines.push_back("skipped: " + skipped[i]);
  }
  if (skipped.size() > kMostToldOneByOne) {
    lines.push_back(fmt::format("skipped: {} more", skipped.size() - kMostToldOneByOne));
  }
  for (const std::string& line : recorded_.tally.lines()) lines.push_back(line);
  for (const std::string& line : motion_check_.remarks()) lines.push_back(line);
  if (untold_ > 0) {
    lines.push_back(
        fmt::format("{} of {} corners are none of those whose truth {} has, and count for nothing; "
                    "leave pictures, lens and corners.threshold as they were generated",
                    untold_, corners_, sequence::kTruthFile));
  }
  if (!grounded_) {
    const bool has_height = scenario_.recording->camera_height_m.has_value();
    lines.push_back(fmt::format(
        "the filter was not told where the ground is: {}",
        has_height
            ? "where up is is not known; give mount, or poses of KITTI, or an IMU"
            : "give camera_height, and mount where neither poses nor an IMU say where up is"));
  }
  return lines;
}

}  // namespace lcs::replay
