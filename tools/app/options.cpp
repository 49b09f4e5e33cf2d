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
  all.add_with_text(
      "--detector", "NAME", &detector.name,
      about +
          "\nlcs:lab    the filter with the paper's preset, or another, without the scenario's "
          "filter settings\nFor a detector of yours: its name in the results");
  all.add("--detector-command", "COMMAND", &detector.command);
  all.add_with_text(
      "--detector-timeout", "TIME", &detector.timeout_s,
      fmt::format("Limit of the time to start, to answer a frame, and to end; {} s if not given",
                  detector.timeout_s),
      {.needs = "--detector-command", .quantity = scenario::kDuration});
}

/// --beside of a single run, in which each further detector has a folder of its own.
void add_beside(Options& all, Texts& beside) {
  all.add("--beside", "NAME=DIR", &beside, {.is_output = true});
}

/// \param type of --detections.
void add_recorded(Options& all, std::string& recorded, DetectorChoice& detector,
                  const std::string& type) {
  all.add("--recorded", "DIR", &recorded);
  all.add("--detections", type, &detector.detections,
          {.needs = "--recorded", .excludes = "--detector-command"});
}

/// The options that choose a run's files besides its figures.
void add_results(Options& all, bool& video, bool& events) {
  all.add("--no-video", "", &video);
  all.add("--events", "", &events);
}

void add_keep(Options& all, output::Keep& keep) {
  const auto read = [&keep](const std::string& word) { keep = output::keep_of(word); };
  const auto words = [&keep] { return Texts{std::string(word_of(keep))}; };
  all.push_back({"--keep", "WHAT", all.about("--keep"), Kind::text, false, read, words});
}

/// \param excludes name of an option that 2 threads do not go with.
void add_threads(Options& all, int& threads, const std::string& excludes = "") {
  all.add("--threads", "N", &threads, {.excludes = excludes, .high = 2});
}

/// \param otherwise name of the argument in whose place the worlds are.
void add_worlds(Options& all, WorldsChoice& worlds, const std::string& otherwise) {
  all.add("--worlds", "SPLIT", &worlds.split, {.excludes = otherwise});
  all.add("--count", "N", &worlds.count, {.needs = "--worlds", .high = 100'000});
  all.add("--family", "NAME", &worlds.family, {.needs = "--worlds"});
}

void add_place(Options& all, SuitePlace& place) {
  all.add_out(place.out, SuitePlace::kDefault);
  all.add("--baseline", "FILE", &place.baseline);
  all.add("--allow-missing", "", &place.allow_missing, {.needs = "--baseline"});
}

constexpr RecordingKey kRecordingKeys[] = {{"camera", "NAME"},
                                           {"topics.image", "TOPIC"},
                                           {"topics.camera_info", "TOPIC"},
                                           {"topics.imu", "TOPIC"},
                                           {"topics.poses", "TOPIC"},
                                           {"topics.odometry", "TOPIC"},
                                           {"topics.world", "FRAME"},
                                           {"fps", "HZ"},
                                           {"times", "FILE"},
                                           {"time_unit", "UNIT"},
                                           {"every", "N"},
                                           {"poses", "FILE"},
                                           {"imu", "FILE"},
                                           {"odometry", "FILE"},
                                           {"speed", "M/S"},
                                           {"at_rest", "S"},
                                           {"calibration", "FILE"},
                                           {"imu_calibration", "FILE"},
                                           {"focal", "PX"},
                                           {"centre", "X,Y"},
                                           {"distortion", "K1,K2,P1,P2,K3"},
                                           {"equidistant", "K1,K2,K3,K4"},
                                           {"camera_height", "M"},
                                           {"mount", "R,P,Y"},
                                           {"bayer", "PATTERN"},
                                           {"bits", "N"},
                                           {"mask", "FILE"},
                                           {"labels", "FILE"},
                                           {"labels_video", "NAME"},
                                           {"split", "NAME"},
                                           {"nothing_moves", ""}};

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
  all.push_back({"--frames", "N", all.about("--frames"), Kind::text, false, read_frames, frames});
  all.add_set(request.sets);
  add_detector(all, request.detector);
  add_beside(all, request.beside);
  add_recorded(all, request.recorded, request.detector, "FILE");
  add_results(all, request.video, request.events);
  add_keep(all, request.keep);
  all.add("--gzip", "", &request.gzip);
  all.add("--report", "", &request.report);
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
  all.add("PATH", "", &request.path, {.also = "--images", .is_required = true, .kind = Kind::path});
  all.push_back({"", "", "", Kind::settings, false, read, no_words, {.keyword = "recording"}});
  add_key(all, request, {"format", "NAME"}, layouts);
  for (const RecordingKey& key : kRecordingKeys)
    add_key(all, request, key, all.about(flag_of(key.key)));
  all.add("--ego-motion", "SOURCE", &request.ego_motion);
  all.add("--corners", "SOURCE", &request.corners);
  all.add("--fast-threshold", "N|auto", &request.fast_threshold);
  add_detector(all, request.run.detector);
  all.add("--preset", "NAME", &request.preset);
  all.add_set(request.sets);
  add_beside(all, request.run.beside);
  all.add_out(request.run.out, "out/<recording>");
  add_results(all, request.run.video, request.run.events);
  add_threads(all, request.run.threads);
  return all;
}

Options options_of(ScoreRequest& request) {
  Options all("score");
  all.add("DIR", "", &request.sequence,
          {.also = "--sequence", .is_required = true, .kind = Kind::path});
  all.add("--detections", "FILE", &request.detections);
  all.add("--out", "FILE", &request.out, {.is_output = true});
  all.add_force(request.force);
  all.add("--write-detections", "FILE", &request.write_detections, {.is_output = true});
  return all;
}

Options options_of(SuiteRequest& request) {
  Options all("suite");
  all.add("PATH", "", &request.paths, {.kind = Kind::paths, .keyword = "paths"});
  all.add("--group", "NAME", &request.group);
  all.add("--filter", "REGEX", &request.filter);
  all.add("--jobs", "N", &request.jobs, {.high = kMostJobs});
  add_worlds(all, request.worlds, "PATH");
  all.add("--seeds", "N", &request.seeds, {.high = kMostSeeds});
  add_detector(all, request.detector);
  add_recorded(all, request.recorded, request.detector, "DIR");
  all.add("--beside", "NAME", &request.beside);
  all.add_set(request.sets);
  add_keep(all, request.keep);
  all.add("--shard", "I/N", &request.shard);
  all.add("--times", "FILE", &request.times, {.needs = "--shard"});
  add_place(all, request.place);
  all.add("--all", "", &request.all, {.needs = "--baseline"});
  all.add("--anew", "", &request.anew);
  return all;
}

Options options_of(MergeRequest& request) {
  Options all("merge");
  all.add("DIR", "", &request.parts,
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
  all.add("SCENARIO", "", &request.paths, {.kind = Kind::paths, .keyword = "paths"});
  all.add("--suite", "", &request.suite);
  add_worlds(all, request.worlds, "SCENARIO");
  all.add("--out", "DIR", &request.out, {.is_output = true});
  all.add_with_text("--formats", "LIST", &request.formats, formats, {.is_joined = true});
  const Option::More of_use{.excludes = "--formats", .keyword = ""};
  all.push_back({"--for", "USE", about_uses, Kind::text, false, read_use, no_words, of_use});
  all.add("--add", "", &request.add);
  all.add("--frames", "N", &request.frames, {.high = 100'000'000});
  all.add_seed(request.seed);
  all.add_set(request.sets);
  all.add("--jobs", "N", &request.jobs, {.high = kMostJobs});
  all.add("--shard", "I/N", &request.shard);
  all.add("--group", "NAME", &request.group);
  all.add("--filter", "REGEX", &request.filter);
  all.add("--seeds", "N", &request.seeds, {.high = kMostSeeds});
  return all;
}

Options options_of(CompareRequest& request) {
  Options all("compare");
  all.add("BEFORE", "", &request.before, {.is_required = true, .kind = Kind::path});
  all.add("AFTER", "", &request.after, {.is_required = true, .kind = Kind::path});
  all.add("--metric", "REGEX", &request.metric);
  all.add("--markdown", "DIR", &request.markdown, {.is_output = true});
  all.add("--pictures-at", "URL", &request.pictures_at, {.needs = "--markdown"});
  all.add("--allow-missing", "", &request.allow_missing);
  return all;
}

Options options_of(KinematicsRequest& request) {
  Options all("kinematics");
  all.add("--config", "FILE", &request.config);
  all.add_set(request.sets);
  all.add_out(request.out, "out/kinematics");
  all.add("--tolerance", "PX", &request.tolerance_px,
          {.quantity = {input::Dimension::pixels, {0, 1000, true}}});
  all.add("--quick", "", &request.quick);
  return all;
}

Options options_of(WorldRequest& request) {
  Options all("world");
  all.add_with_text("FAMILY", "", &request.family,
                    fmt::format("One of {}", fmt::join(worlds::families(), ", ")),
                    {.is_required = true});
  all.add_seed(request.seed);
  all.add_out(request.out, "out/worlds/FAMILY_SEED");
  all.add("--pictures", "DIR", &request.pictures);
  all.add("--sheet", "", &request.sheet);
  return all;
}

Options options_of(TuneRequest& request) {
  Options all("tune");
  all.add("SUITE", "", &request.suites,
          {.also = "--suite", .is_required = true, .kind = Kind::paths, .keyword = "suites"});
  all.add("--validate", "SUITE,...", &request.validate, {.is_joined = true, .kind = Kind::paths});
  all.add("--keys", "KEY,...", &request.keys, {.is_joined = true});
  all.add_set(request.sets);
  all.add("--evaluations", "N", &request.evaluations, {.high = 1'000'000});
  all.add_seed(request.seed);
  all.add_out(request.out, "out/tune");
  return all;
}

}  // namespace lcs::app
