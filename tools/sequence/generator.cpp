#include "tools/sequence/generator.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "scenarios/input/document.h"
#include "scenarios/input/sha256.h"
#include "sim/simulation.h"
#include "tools/files/csv.h"
#include "tools/files/output_file.h"
#include "tools/sequence/replay_settings.h"
#include "tools/sequence/self_check.h"
#include "tools/sequence/true_flow.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

constexpr const char* kScenarioFile = "scenario.yaml";

std::vector<Writer> writers_of(const SequenceInfo& info, const GenerateOptions& options) {
  std::vector<Writer> writers{picture_writer(info)};
  for (const std::string& name : options.formats) writers.push_back(format(name).make(info));
  return writers;
}

/// The cameras of a sequence. Each has a simulation of its own: their worlds are the same to the
/// bit, and a camera of a rig sees all that a single camera sees.
class Rig {
 public:
  /// \throws as `sim::Simulation`.
  explicit Rig(const scenario::Scenario& scenario) : filter_place_(scenario.rig_place) {
    const std::size_t count = std::max<std::size_t>(1, scenario.cameras.size());
    for (std::size_t place = 0; place < count; ++place) {
      scenarios_.push_back(scenario::seen_by(scenario, place));
      simulations_.push_back(std::make_unique<sim::Simulation>(scenarios_.back()));
      calibrations_.push_back(&simulations_.back()->calibration());
    }
  }

  std::vector<SequenceInfo> infos() const {
    std::vector<SequenceInfo> all;
    for (std::size_t place = 0; place < simulations_.size(); ++place) {
      const sim::Simulation& simulation = *simulations_[place];
      all.push_back({scenarios_[place], simulation.calibration(), simulation.objects(),
                     simulation.origin(), calibrations_, place});
    }
    return all;
  }
  /// Of the camera that detectors get.
  const sim::Warnings& warnings() const { return simulations_[filter_place_]->warnings(); }
  std::size_t filter_place() const { return filter_place_; }

  void skip() {
    for (const auto& simulation : simulations_) simulation->skip();
  }
  std::vector<sim::Observation> next() {
    std::vector<sim::Observation> all;
    for (const auto& simulation : simulations_) all.push_back(simulation->next().value());
    return all;
  }
  /// After the last frame: of the camera at a place.
  sim::FrameReadings late_readings(std::size_t place) const {
    return simulations_[place]->late_readings();
  }

 private:
  std::size_t filter_place_;
  std::deque<scenario::Scenario> scenarios_;  // does not move them
  std::vector<std::unique_ptr<sim::Simulation>> simulations_;
  std::vector<const sim::Calibration*> calibrations_;
};

/// The place of a camera's file, or the name of its stream, by the one of cam0: the same in folders
/// whose own layout has a place for each camera, else in the camera's own folder.
std::string placed(const SequenceInfo& info, const std::string& path) {
  const bool is_shared = path.starts_with("mav0/") || path.starts_with("kitti/");
  const bool stays = info.is_first() || is_shared || path.empty();
  return stays ? path : camera_name(info.place) + "/" + path;
}

/// Checks and writes a frame of one camera.
class FrameMaker {
 public:
  FrameMaker(const SequenceInfo& info, const GenerateOptions& options)
      : info_(info), writers_(writers_of(info, options)) {}

  /// \param next null for the scenario's last frame, whose flow and goals are not checked.
  /// \param late readings after the last frame, which are added to `now` and written with it.
  void make(sim::Observation& now, const sim::Observation* next, const sim::FrameReadings& late,
            FrameOutput& all, Agreements& checks) const {
    check_times(info_.scenario, now);
    checks["imu_share_of_tolerance"].add(
        check_imu(info_.scenario.imu, info_.calibration.gravity_mps2, now));
    std::optional<TrueFlow> motion;
    if (next != nullptr) {
      motion = true_flow(info_.calibration.optics, now.truth, now.geom,
                         {next->truth.depth_m, next->geom});
      checks["flow_px"].add(
          check_flow(info_.calibration.optics, now, *next, motion->full_px, motion->seen));
      checks["picture_share_of_block"].add(check_picture(now, *next, *motion));
    }
    const cv::Mat1w mask = object_mask(now.truth);
    check_masks(now.index, mask, now.objects, static_cast<int>(info_.objects.size()));
    checks["outline_contrast_ratio"].add(check_outlines(now, mask));
    std::ranges::copy(late.imu, std::back_inserter(now.imu));
    std::ranges::copy(late.odometry, std::back_inserter(now.odometry));
    std::ranges::copy(late.imu_truth, std::back_inserter(now.imu_truth));
    FrameOutput output;
    for (const Writer& writer : writers_) {
      writer.write({now, info_.stamp_ns(now.t_ns), mask, motion ? &*motion : nullptr}, output);
    }
    for (FrameFile& file : output.files) {
      all.files.push_back(
          {placed(info_, file.path), std::move(file.bytes), placed(info_, file.same_as)});
    }
    for (auto& [stream, text] : output.rows) all.rows[placed(info_, stream)] = std::move(text);
  }

 private:
  SequenceInfo info_;
  std::vector<Writer> writers_;
};

/// Rows of poses. Of q and -q, which are the same rotation, each gets the one nearer to the row
/// before.
std::string with_steady_signs(const std::string& rows, DocumentPart& part) {
  std::string text;
  for (const std::string_view line : files::split(rows, '\n')) {
    if (line.empty()) continue;  // after the last row
    const std::vector<std::string_view> fields = files::split(line, part.poses_between);
    std::vector<std::string> written(fields.begin(), fields.end());
    Eigen::Vector4d q;
    for (std::size_t i = 0; i < 4; ++i) q[i] = files::number_in<double>(fields[4 + i]).value();
    if (q.dot(part.last_quaternion) < 0) {
      q = Eigen::Vector4d::Zero() - q;  // no -0
      for (std::size_t i = 0; i < 4; ++i) written[4 + i] = fmt::format("{}", q[i]);
    }
    part.last_quaternion = q;
    text += fmt::format("{}\n", fmt::join(written, std::string_view(&part.poses_between, 1)));
  }
  return text;
}

/// Adds the rows of the next frame.
void add(const Rows& rows, SequenceDocument& document) {
  for (DocumentPart& part : document.parts) {
    const auto found = rows.find(part.stream);
    if (found == rows.end() || found->second.empty()) continue;
    if (!part.text.empty()) part.text += part.separator;
    part.text += part.poses_between ? with_steady_signs(found->second, part) : found->second;
  }
}

std::string text_of(const SequenceDocument& document) {
  std::string text;
  for (const DocumentPart& part : document.parts) text += part.text;
  return text;
}

/// Whether the document has streams, but no rows.
bool is_empty(const SequenceDocument& document) {
  const auto is_stream = [](const DocumentPart& part) { return !part.stream.empty(); };
  const auto has_rows = [&](const DocumentPart& part) {
    return is_stream(part) && !part.text.empty();
  };
  return std::ranges::any_of(document.parts, is_stream) &&
         std::ranges::none_of(document.parts, has_rows);
}

/// The scenario's file, with the values that replaced its own.
std::string scenario_text(const scenario::Scenario& scenario, const GenerateOptions& options) {
  const std::string text = read_file(scenario.file);
  input::Value root = input::parse_document(text, scenario.file);
  const std::string as_read = input::yaml_text(root);
  for (const std::string& assignment : options.sets) input::apply_set(root, assignment);
  const std::map<std::string, std::string> values = input::flattened(root);
  const scenario::Scenario defaults;
  const auto replace = [&](const char* key, auto value, auto if_absent) {
    const auto found = values.find(key);
    const bool is_same =
        found == values.end() ? value == if_absent : found->second == std::to_string(value);
    if (!is_same) input::apply_set(root, fmt::format("{}={}", key, value));
  };
  replace("seed", scenario.seed, defaults.seed);
  if (values.contains("duration")) input::apply_set(root, "duration=");
  replace("frames", scenario.frames, 0);
  const std::string whole = input::yaml_text(root);
  return whole == as_read ? text : whole;
}

std::vector<SequenceDocument> documents_of(const Rig& rig, const GenerateOptions& options) {
  const std::vector<SequenceInfo> infos = rig.infos();
  std::vector<SequenceDocument> all{
      {kSettingsFile, {{.text = settings_text(infos[rig.filter_place()])}}},
      {kScenarioFile, {{.text = scenario_text(infos.front().scenario, options)}}},
      {kReadmeFile, {{.text = readme_text(infos.front(), options.formats)}}}};
  for (const SequenceInfo& info : infos) {
    for (Writer& writer : writers_of(info, options)) {
      for (SequenceDocument& document : writer.documents) {
        document.path = placed(info, document.path);
        for (DocumentPart& part : document.parts) part.stream = placed(info, part.stream);
        all.push_back(std::move(document));
      }
    }
  }
  return all;
}

}  // namespace

FrameRange part_of(int count, int i, int n) {
  if (n < 1 || i < 1 || i > n) {
    throw std::invalid_argument(fmt::format("{}/{} is no part; give one from 1/N to N/N", i, n));
  }
  const auto share = [&](std::int64_t k) { return static_cast<int>(count * k / n); };
  return {share(i - 1), share(i)};
}

files::Json facts_of(const scenario::Scenario& scenario, const GenerateOptions& options) {
  const sim::Versions versions = sim::versions();
  files::Json facts = {
      {"scenario", scenario.name},        {"set", options.sets},        {"seed", scenario.seed},
      {"frames", scenario.frames},        {"formats", options.formats}, {"mujoco", versions.mujoco},
      {"renderer", versions.gl_renderer},
  };
  facts.update(options.program);
  for (const Scripted& one : kScripted) {
    if (std::ranges::count(options.formats, one.format) == 0) continue;
    facts[std::string(one.library)] = run_script(one.script, {"--version"});
  }
  return facts;
}

sim::Warnings generate_frames(const scenario::Scenario& scenario, const GenerateOptions& options,
                              SequenceFolder& folder, FrameRange range,
                              const std::function<void(int)>& on_frame) {
  std::set<int> missing;
  for (int k = range.first; k < range.last; ++k) {
    if (!folder.is_whole(k)) missing.insert(k);
  }
  int whole = range.last - range.first - static_cast<int>(missing.size());
  on_frame(whole);
  if (missing.empty()) return {};

  Rig rig(scenario);
  std::vector<FrameMaker> makers;
  for (const SequenceInfo& info : rig.infos()) makers.emplace_back(info, options);
  std::vector<sim::Observation> last;  // until its next frame is simulated
  const auto make = [&](std::vector<sim::Observation>& now,
                        const std::vector<sim::Observation>& next) {
    FrameOutput output;
    Agreements checks;
    for (std::size_t i = 0; i < makers.size(); ++i) {
      try {
        makers[i].make(now[i], next.empty() ? nullptr : &next[i],
                       next.empty() ? rig.late_readings(i) : sim::FrameReadings(), output, checks);
      } catch (const TruthError& error) {
        const auto& coplanar = rig.warnings().of(sim::Warning::coplanar_faces);
        const std::string fault =
            ", which is a fault of this program: please report it with the scenario";
        throw TruthError(error.what() +
                         (coplanar.count > 0 ? ", perhaps as " + coplanar.first : fault));
      }
    }
    folder.add(now.front().index, output, checks);
    on_frame(++whole);
  };
  for (int k = *missing.begin(); k > 0; --k) rig.skip();
  for (int k = *missing.begin(); k < scenario.frames && (!last.empty() || k <= *missing.rbegin());
       ++k) {
    const bool is_missing = missing.contains(k);
    if (!is_missing && last.empty()) {
      rig.skip();
      continue;
    }
    std::vector<sim::Observation> now = rig.next();
    if (!last.empty()) make(last, now);
    last.clear();
    if (!is_missing) continue;
    if (k + 1 < scenario.frames) {
      last = std::move(now);
    } else {
      make(now, {});
    }
  }
  return rig.warnings();
}

std::vector<std::string> finish_sequence(const scenario::Scenario& scenario,
                                         const GenerateOptions& options, SequenceFolder& folder) {
  const Rig rig(scenario);  // for mounting and objects
  std::vector<SequenceDocument> documents = documents_of(rig, options);
  Agreements checks;
  std::vector<FileRecord> files;
  for (int k = 0; k < scenario.frames; ++k) {
    const FrameEntry& entry = folder.read(k);
    std::ranges::copy(entry.files, std::back_inserter(files));
    for (const auto& [name, agreement] : entry.checks) checks[name].add(agreement);
    for (SequenceDocument& document : documents) add(entry.rows, document);
  }
  std::vector<std::string> notes;
  const scenario::Imu& imu = scenario.imu;
  const bool has_errors =
      imu.gyroscopes != scenario::Gyroscopes{} || imu.accelerometers != scenario::Accelerometers{};
  if ((has_errors || scenario.camera.time_offset_s != 0) &&
      std::ranges::find(options.formats, "kalibr") == options.formats.end()) {
    notes.emplace_back(
        "no calibration of these formats states the errors of the IMU or the time offset of the "
        "camera; --formats with kalibr writes one that does");
  }
  for (const SequenceDocument& document : documents) {
    const std::string text = text_of(document);
    const auto scripted = std::ranges::find_if(
        kScripted, [&](const Scripted& one) { return document.path.ends_with(one.file); });
    if (scripted != kScripted.end()) {
      const auto make = [&](const std::filesystem::path& out) {
        const std::filesystem::path rows = out.parent_path() / "rows";
        files::write_file(rows, text);
        std::vector<std::string> arguments{rows, out};
        if (scripted->takes_pictures) arguments.insert(arguments.begin() + 1, folder.staging());
        run_script(scripted->script, arguments);
      };
      const std::filesystem::path within = std::filesystem::path(document.path).parent_path();
      std::ranges::move(folder.add_folder(within, make), std::back_inserter(files));
      continue;
    }
    folder.write(document.path, text);
    files.push_back({document.path, text.size(), input::sha256(text)});
    if (is_empty(document)) {
      notes.push_back(
          fmt::format("{} is empty: there is nothing to tell in any frame", document.path));
    }
  }
  folder.finish(checks, std::move(files));
  for (const auto& [name, agreement] : checks) {
    notes.push_back(fmt::format("checked {}: at most {:.2g} over {} comparisons", name,
                                agreement.worst, agreement.compared));
  }
  return notes;
}

}  // namespace lcs::sequence
