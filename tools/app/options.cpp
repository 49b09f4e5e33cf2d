// The single list of all options of the requests.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenarios/fields.h"
#include "scenes/worlds/worlds.h"
#include "tools/app/compare.h"
#include "tools/app/generate.h"
#include "tools/app/kinematics.h"
#include "tools/app/replay.h"
#include "tools/app/run.h"
#include "tools/app/score.h"
#include "tools/app/suite.h"
#include "tools/app/tune.h"
#include "tools/app/world.h"
#include "tools/replay/recorded.h"
#include "tools/sequence/writer.h"

namespace lcs::app {
namespace {

using Kind = Option::Kind;

constexpr int kMostJobs = 1024, kMostSeeds = 1000;

void add_detector(Options& all, DetectorChoice& detector) {
  std::string about = "The detector; lcs if not given:";
  for (const comparators::DetectorKind& each : comparators::detectors()) {
    about += fmt::format("\n{:<10} {}", each.name, each.purpose);
  }
  all.add("--detector", "NAME", &detector.name,
          about +
              "\nlcs:lab    the filter with the paper's preset, or another, without the scenario's "
              "filter settings\nFor a detector of yours: its name in the results");
  all.add("--detector-command", "COMMAND", &detector.command,
          "A detector of yours, as 'python3 mine.py': the program reads each frame from its "
          "standard input and answers with a line (tools/comparators/PROTOCOL.md)");
  all.add(
      "--detector-timeout", "TIME", &detector.timeout_s,
      fmt::format("Limit of the time to start, to answer a frame, and to end; {} s if not given",
                  detector.timeout_s),
      {.needs = "--detector-command", .quantity = scenario::kDuration});
}

/// --beside of a single run, in which each further detector has a folder of its own.
void add_beside(Options& all, Texts& beside) {
  all.add("--beside", "NAME=DIR", &beside,
          "Run this detector on the same frames too, and write its figures and layers to the "
          "folder; may be repeated",
          {.is_output = true});
}

/// \param type of --detections. \param answers what these are.
void add_recorded(Options& all, std::string& recorded, const std::string& about,
                  DetectorChoice& detector, const std::string& type, const std::string& answers) {
  all.add("--recorded", "DIR", &recorded, about);
  all.add("--detections", type, &detector.detections,
          "With --recorded: the answers of a detector of yours" + answers,
          {.needs = "--recorded", .excludes = "--detector-command"});
}

/// The options that choose a run's files besides its figures.
void add_results(Options& all, bool& video, bool& events) {
  all.add("--no-video", "", &video, "Write no video.mp4");
  all.add("--events", "", &events,
          "Write events.json: missed and false rebels, with reasons and pictures");
}

void add_keep(Options& all, output::Keep& keep) {
  const auto read = [&keep](const std::string& word) { keep = output::keep_of(word); };
  const auto words = [&keep] { return Texts{std::string(word_of(keep))}; };
  all.push_back({"--keep", "WHAT",
                 "The files of each run: figures; events: also a row a frame and the events; all: "
                 "also layers, truth and pictures, for --recorded",
                 Kind::text, false, read, words});
}

/// \param excludes name of an option that 2 threads do not go with.
void add_threads(Options& all, int& threads, const std::string& excludes = "") {
  all.add("--threads", "N", &threads,
          "1 or 2; with 2 the next frame is made, and its corners are found, while a second thread "
          "filters and writes this one: the same results on two cores, sooner. If not given, 1",
          {.excludes = excludes, .high = 2});
}

/// \param otherwise name of the argument in whose place the worlds are.
void add_worlds(Options& all, WorldsChoice& worlds, const std::string& otherwise) {
  all.add("--worlds", "SPLIT", &worlds.split,
          "Run worlds in place of scenario files, from the split train, validate or test",
          {.excludes = otherwise});
  all.add("--count", "N", &worlds.count, "How many worlds; 60 if not given",
          {.needs = "--worlds", .high = 100'000});
  all.add("--family", "NAME", &worlds.family, "Only worlds of this family", {.needs = "--worlds"});
}

void add_place(Options& all, SuitePlace& place) {
  all.add_out(place.out, SuitePlace::kDefault);
  all.add("--baseline", "FILE", &place.baseline,
          "An earlier suite.json or its folder, to show changes against");
  all.add("--allow-missing", "", &place.allow_missing,
          "Judge also if runs of the baseline are missing, or have another number of frames",
          {.needs = "--baseline"});
}

constexpr RecordingKey kRecordingKeys[] = {
    {"camera", "NAME", "Name of the camera, if the layout has several, as cam1 (EuRoC)"},
    {"topics.image", "TOPIC", "Of a ROS bag: its pictures; without it the topics are listed"},
    {"topics.camera_info", "TOPIC", "Of a ROS bag: the calibration, if not beside the pictures"},
    {"topics.imu", "TOPIC", "Of a ROS bag: an IMU"},
    {"topics.poses", "TOPIC", "Of a ROS bag: poses, in place of the IMU"},
    {"topics.odometry", "TOPIC", "Of a ROS bag: velocities beside the IMU"},
    {"topics.world", "FRAME", "Of a ROS bag: the frame of poses that come from tf"},
    {"fps", "HZ", "Pictures a second, if the recording has no times"},
    {"times", "FILE", "When the pictures were taken: a time a line, or a table with their names"},
    {"time_unit", "UNIT", "Of times in tables and names of pictures: s, ms, us or ns"},
    {"every", "N", "Take every N-th picture only"},
    {"poses", "FILE",
     "Poses of the camera: lines of TUM (t x y z qx qy qz qw) or KITTI (12 numbers), or a table"},
    {"imu", "FILE",
     "Readings of an IMU, a table with a header as EuRoC's, ROS's or a phone's; where pictures "
     "have no clock the first one belongs to the first picture, --speed is the speed then"},
    {"odometry", "FILE", "Velocities by the wheels, in addition to --imu, CSV as EuRoC's"},
    {"speed", "M/S", "Of the camera, ahead, in m/s; 0 where it stands"},
    {"at_rest", "S", "Seconds at the start in which the camera stands"},
    {"calibration", "FILE",
     "Of the camera: YAML of Kalibr, OpenCV, ROS (camera_info), ORB-SLAM3, VINS or OpenVINS"},
    {"imu_calibration", "FILE", "Noise of the IMU, as Kalibr's imu.yaml has it"},
    {"focal", "PX", "Focal length in pixels"},
    {"centre", "X,Y", "Principal point in pixels, as 319.5,239.5; the middle if not given"},
    {"distortion", "K1,K2,P1,P2,K3", "Of the lens, as OpenCV has it"},
    {"equidistant", "K1,K2,K3,K4", "Distortion of a fisheye, as OpenCV has it"},
    {"camera_height", "M", "Of the camera above the ground, in m"},
    {"mount", "R,P,Y",
     "Where the camera looks: roll, pitch (down), yaw (left) from straight ahead, in degrees"},
    {"bayer", "PATTERN", "Raw pictures: rggb, bggr, grbg or gbrg, from the top left pixel on"},
    {"bits", "N", "Used bits of 16-bit pictures; if not given, judged by their values"},
    {"mask", "FILE", "A picture of the camera's size, white where the vehicle itself is seen"},
    {"labels", "FILE",
     "Boxes of all that moves: MOTChallenge's gt.txt, COCO's JSON, KITTI tracking's labels"},
    {"labels_video", "NAME", "The video of these labels, where their file has several"},
    {"split", "NAME", "Split that it belongs to: train, validate or test"},
    {"nothing_moves", "", "Nothing but the camera moves: every rebel is false"},
};

/// An option that is a key of `recording`.
void add_key(Options& all, ReplayRequest& request, const RecordingKey& key,
             const std::string& about) {
  const std::string name = key.key;
  const auto read = [&request, name](const std::string& word) { request.recording[name] = word; };
  const auto words = [&request, name] {
    const auto found = request.recording.find(name);
    return found == request.recording.end() ? Texts{} : Texts{found->second};
  };
  const Kind kind = *key.type == 0 ? Kind::flag : Kind::text;
  all.push_back({flag_of(name), key.type, about, kind, false, read, words, {.keyword = ""}});
}

Texts no_words() {
  return {};
}

}  // namespace

std::span<const RecordingKey> recording_keys() {
  return kRecordingKeys;
}

Options options_of(RunRequest& request) {
  const auto read_frames = [&request](const std::string& word) {
    const input::Value frames(input::Value::Kind::scalar, {"--frames", 0}, word);
    input::as_integer(frames, "the number", 1, scenario::kMostFrames);
    request.frames = word;
  };
  const auto frames = [&request] { return Texts(request.frames.empty() ? 0 : 1, request.frames); };
  Options all("run");
  all.add_scenario(request.scenario);
  all.add_out(request.out, "out/<scenario>");
  all.add_seed(request.seed);
  all.push_back({"--frames", "N", "Frames to run, instead of the scenario's", Kind::text, false,
                 read_frames, frames});
  all.add_set(request.sets, "Set a value of the scenario, as \"ego.speed=0.7 m/s\"");
  add_detector(all, request.detector);
  add_beside(all, request.beside);
  add_recorded(all, request.recorded,
               "Take corners, motion and truth from an earlier run of the same scenario and seed, "
               "instead of simulating",
               request.detector, "FILE",
               " to these frames, a CSV file (tools/recording/DETECTIONS.md)");
  add_results(all, request.video, request.events);
  add_keep(all, request.keep);
  all.add("--gzip", "", &request.gzip, "Compress layers.jsonl and truth.jsonl (.gz)");
  all.add("--report", "", &request.report,
          "Write report.html too, a page of the run with its video, and events.json");
  add_threads(all, request.threads, "--view");
  return all;
}

Options options_of(ReplayRequest& request) {
  std::string layouts = "Layout of the recording; if not given, recognized by its files:";
  for (const replay::RecordingLayout& layout : replay::layouts()) {
    layouts += fmt::format("\n{:<14} {}", layout.name, layout.purpose);
  }
  const auto read = [&request](const std::string& assignment) {
    const auto [key, value] = key_and_value(assignment);
    request.recording[key] = value;
  };
  Options all("replay");
  all.add("PATH", "", &request.path, "The recording: a folder, a video, or a ROS bag",
          {.also = "--images", .is_required = true, .kind = Kind::path});
  all.push_back({"", "", "", Kind::settings, false, read, no_words, {.keyword = "recording"}});
  add_key(all, request, {"format", "NAME", ""}, layouts);
  for (const RecordingKey& key : kRecordingKeys) add_key(all, request, key, key.about);
  all.add("--ego-motion", "SOURCE", &request.ego_motion,
          "imu: by dead reckoning; truth: by the recording's own truth");
  all.add("--corners", "SOURCE", &request.corners,
          "pictures: FAST corners; events: corners of an event camera. If not given, pictures");
  all.add("--fast-threshold", "N|auto", &request.fast_threshold,
          "Contrast of a corner, 1 to 254 grey levels; auto: by the noise and the compression of "
          "each picture. If not given, auto or the recording's");
  add_detector(all, request.run.detector);
  all.add("--preset", "NAME", &request.preset,
          "Parameters of the filter: default, or the paper's lab or cars");
  all.add_set(request.sets, "Set a parameter of the filter, as hypotheses.prior=0.05");
  add_beside(all, request.run.beside);
  all.add_out(request.run.out, "out/<recording>");
  add_results(all, request.run.video, request.run.events);
  add_threads(all, request.run.threads);
  return all;
}

Options options_of(ScoreRequest& request) {
  Options all("score");
  all.add("DIR", "", &request.sequence, "Folder of a run, or of a suite",
          {.also = "--sequence", .is_required = true, .kind = Kind::path});
  all.add("--detections", "FILE", &request.detections,
          "Score the answers in this CSV file instead of the run's own detector");
  all.add("--out", "FILE", &request.out, "Write the figures to this file, as metrics.json has them",
          {.is_output = true});
  all.add_force(request.force);
  all.add("--write-detections", "FILE", &request.write_detections,
          "Write the verdicts and boxes that are scored to this CSV file", {.is_output = true});
  return all;
}

Options options_of(SuiteRequest& request) {
  Options all("suite");
  all.add("PATH", "", &request.paths,
          "Scenario files, and folders of them; the project's own if not given",
          {.kind = Kind::paths, .keyword = "paths"});
  all.add("--group", "NAME", &request.group,
          "Only scenarios of this group; 'all' for any. If not given: any of paths that are named, "
          "short of the project's own");
  all.add("--filter", "REGEX", &request.filter,
          "Only scenarios with this regular expression in their name");
  all.add("--jobs", "N", &request.jobs,
          "Runs at a time; if not given, as many as there are processors", {.high = kMostJobs});
  add_worlds(all, request.worlds, "PATH");
  all.add("--seeds", "N", &request.seeds, "Runs of each scenario; 3 if not given, of worlds 1",
          {.high = kMostSeeds});
  add_detector(all, request.detector);
  add_recorded(
      all, request.recorded,
      "Take corners, motion and truth from an earlier suite instead of simulating, which takes "
      "seconds",
      request.detector, "DIR",
      ", a folder of CSV files (tools/recording/DETECTIONS.md), SCENARIO/seed-N.csv for each run");
  all.add("--beside", "NAME", &request.beside,
          "Run this detector too on the same frames, as klt or lcs:lab, and print F1 beside each "
          "other; may be repeated");
  all.add_set(request.sets, "Set a value in every scenario, as \"camera.rate=5 Hz\"");
  add_keep(all, request.keep);
  all.add("--shard", "I/N", &request.shard,
          "Only a part of the runs, as 2/5, on one of several machines; lcs merge joins the parts");
  all.add("--times", "FILE", &request.times,
          "With --shard: an earlier suite, whose times balance the parts; the same for all parts",
          {.needs = "--shard"});
  add_place(all, request.place);
  all.add("--all", "", &request.all,
          "Make all runs, also if the verdict against the baseline is certain before",
          {.needs = "--baseline"});
  all.add("--anew", "", &request.anew,
          "Drop the runs of an unfinished suite in the same place, and begin again");
  return all;
}

Options options_of(MergeRequest& request) {
  Options all("merge");
  all.add("DIR", "", &request.parts, "The folders of all parts",
          {.is_required = true, .kind = Kind::paths, .keyword = "parts"});
  add_place(all, request.place);
  return all;
}

Options options_of(GenerateRequest& request) {
  std::string formats = "Formats, with commas between them; if not given, all but those with a *:";
  for (const sequence::Format& one : sequence::formats()) {
    formats += fmt::format("\n{:<10} {}{}", one.name, one.purpose, one.is_usual ? "" : " *");
  }
  std::string about_uses = "The formats of a use, in place of --formats:";
  Texts uses;
  for (const sequence::Use& use : sequence::uses()) {
    about_uses += fmt::format("\n{:<10} {}", use.name, fmt::join(use.formats, ", "));
    uses.emplace_back(use.name);
  }
  const auto read_use = [&request, uses](const std::string& word) {
    const input::Value use(input::Value::Kind::scalar, {"--for", 0}, word);
    request.formats = sequence::uses()[input::as_choice(use, "the use", uses)].formats;
  };
  Options all("generate");
  all.add("SCENARIO", "", &request.paths,
          "The scenario, a YAML file; with --suite files and folders, or the project's own",
          {.kind = Kind::paths, .keyword = "paths"});
  all.add("--suite", "", &request.suite, "A sequence for each of many scenarios");
  add_worlds(all, request.worlds, "SCENARIO");
  all.add("--out", "DIR", &request.out,
          "Folder of the sequence, data/<scenario> if not given; with --suite the folder of all, "
          "data if not given",
          {.is_output = true});
  all.add("--formats", "LIST", &request.formats, formats, {.is_joined = true});
  const Option::More of_use{.excludes = "--formats", .keyword = ""};
  all.push_back({"--for", "USE", about_uses, Kind::text, false, read_use, no_words, of_use});
  all.add("--add", "", &request.add,
          "Add the formats to the finished sequence in --out, which the same scenario, seed and "
          "program made; files that are there stay as they are");
  all.add("--frames", "N", &request.frames, "Only the first N frames", {.high = 100'000'000});
  all.add_seed(request.seed);
  all.add_set(request.sets, "Set a value of the scenario, as \"ego.speed=0.7 m/s\"");
  all.add("--jobs", "N", &request.jobs,
          "Processes at a time; they share the frames of one scenario, or the sequences",
          {.high = kMostJobs});
  all.add("--shard", "I/N", &request.shard, "Only the i-th part of n, as 3/16");
  all.add("--group", "NAME", &request.group, "With --suite: only scenarios of this group");
  all.add("--filter", "REGEX", &request.filter,
          "With --suite: only scenarios with this regular expression in their name");
  all.add("--seeds", "N", &request.seeds,
          "With --suite: sequences of each scenario; 1 if not given", {.high = kMostSeeds});
  return all;
}

Options options_of(CompareRequest& request) {
  Options all("compare");
  all.add("BEFORE", "", &request.before, "A suite.json, or the folder of a suite",
          {.is_required = true, .kind = Kind::path});
  all.add("AFTER", "", &request.after, "Another one", {.is_required = true, .kind = Kind::path});
  all.add("--metric", "REGEX", &request.metric,
          "Only figures with this regular expression in their name");
  all.add("--markdown", "DIR", &request.markdown,
          "Folder for summary.md, for the discussion of a merge request, and two pictures: of the "
          "event that grew most, or with --frames of the first frame that differs",
          {.is_output = true});
  all.add("--pictures-at", "URL", &request.pictures_at,
          "Address where the pictures will be; beside summary.md if not given",
          {.needs = "--markdown"});
  all.add("--allow-missing", "", &request.allow_missing,
          "Judge also if runs of BEFORE are missing in AFTER, or have another number of frames");
  return all;
}

Options options_of(KinematicsRequest& request) {
  Options all("kinematics");
  all.add("--config", "FILE", &request.config,
          "Scenario file with the camera, rover and IMU; scenarios/crossing.yaml if not given");
  all.add_set(request.sets, "Set a value of the scenario, as \"camera.fovy=90 deg\"");
  all.add_out(request.out, "out/kinematics");
  all.add("--tolerance", "PX", &request.tolerance_px,
          "Largest acceptable error of a prediction; 1 px if not given",
          {.quantity = {input::Dimension::pixels, {0, 1000, true}}});
  all.add("--quick", "", &request.quick, "Fewer frames and seeds: a quarter of the time");
  return all;
}

Options options_of(WorldRequest& request) {
  Options all("world");
  all.add("FAMILY", "", &request.family,
          fmt::format("One of {}", fmt::join(worlds::families(), ", ")), {.is_required = true});
  all.add_seed(request.seed, "Seed of the world; 1 if not given");
  all.add_out(request.out, "out/worlds/FAMILY_SEED");
  all.add("--pictures", "DIR", &request.pictures,
          "Folder of pictures (.png, .jpg, .jpeg, .bmp) to take some of the surfaces from");
  all.add("--sheet", "", &request.sheet,
          "Write sheet.png too: first, middle and last picture, and the plan from above");
  return all;
}

Options options_of(TuneRequest& request) {
  Options all("tune");
  all.add("SUITE", "", &request.suites,
          "Folders of suites of train: worlds, and recordings in which nothing moves",
          {.also = "--suite", .is_required = true, .kind = Kind::paths, .keyword = "suites"});
  all.add("--validate", "SUITE,...", &request.validate,
          "Folders of other suites, on which before and after are stated",
          {.is_joined = true, .kind = Kind::paths});
  all.add("--keys", "KEY,...", &request.keys, "Only these parameters; all learnt ones if not given",
          {.is_joined = true});
  all.add_set(request.sets, "Set a parameter of the filter before, as hypotheses.prior=0.05");
  all.add("--evaluations", "N", &request.evaluations, "Sets of numbers to try; 300 if not given",
          {.high = 1'000'000});
  all.add_seed(request.seed,
               "1 starts from the present numbers, any other from a random point near them");
  all.add_out(request.out, "out/tune");
  return all;
}

}  // namespace lcs::app
