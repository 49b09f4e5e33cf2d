#include "tools/sequence/generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>

#include "sim/simulation.h"
#include "tools/files/sha256.h"
#include "tools/sequence/manifest.h"
#include "tools/sequence/objects.h"
#include "tools/sequence/readme.h"
#include "tools/sequence/replay_settings.h"
#include "tools/sequence/self_check.h"
#include "tools/sequence/text_file.h"
#include "tools/sequence/true_flow.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

constexpr const char* kScenarioFile = "scenario.yaml";

std::vector<std::unique_ptr<Writer>> writers_of(const SequenceInfo& info,
                                                const GenerateOptions& options) {
  std::vector<std::unique_ptr<Writer>> writers;
  writers.push_back(std::make_unique<PictureWriter>());
  for (const std::string& name : options.formats) writers.push_back(format(name).make(info));
  return writers;
}

/// Checks and writes a frame.
class FrameMaker {
 public:
  FrameMaker(const SequenceInfo& info, const GenerateOptions& options, const Journal& journal)
      : info_(info), journal_(journal), writers_(writers_of(info, options)) {}

  /// \param next null for the scenario's last frame, whose flow and goals are not checked.
  void make(const sim::Observation& now, const sim::Observation* next) const {
    Agreements checks;
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
    const std::int64_t stamp_ns =
        kEpoch_ns + now.t_ns - std::llround(1e9 * info_.scenario.camera.time_offset_s);
    FrameOutput output;
    for (const auto& writer : writers_) {
      writer->write({now, stamp_ns, mask, motion ? &*motion : nullptr}, output);
    }
    journal_.add(now.index, output, checks);
  }

 private:
  const SequenceInfo& info_;
  const Journal& journal_;
  std::vector<std::unique_ptr<Writer>> writers_;
};

/// A document that collects the rows of one frame after the other.
class GrowingDocument {
 public:
  explicit GrowingDocument(Document document)
      : document_(std::move(document)), rows_(document_.parts.size()) {}

  void add(const Rows& rows) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto found = rows.find(document_.parts[i].stream);
      if (found == rows.end() || found->second.empty()) continue;
      if (!rows_[i].empty()) rows_[i] += document_.parts[i].separator;
      rows_[i] += found->second;
    }
  }

  const std::string& path() const { return document_.path; }
  std::string text() const {
    std::string text;
    for (std::size_t i = 0; i < rows_.size(); ++i) text += document_.parts[i].text + rows_[i];
    return text;
  }
  /// Whether the document has streams, but no rows.
  bool is_empty() const {
    bool takes_rows = false;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!rows_[i].empty()) return false;
      takes_rows |= !document_.parts[i].stream.empty();
    }
    return takes_rows;
  }

 private:
  Document document_;
  std::vector<std::string> rows_;
};

std::vector<GrowingDocument> documents_of(const SequenceInfo& info,
                                          const GenerateOptions& options) {
  std::vector<GrowingDocument> all;
  const auto add_text = [&](const char* path, std::string text) {
    all.emplace_back(Document{path, {{.text = std::move(text)}}});
  };
  add_text(kSettingsFile, settings_text(info.scenario, info.calibration, info.origin));
  add_text(kScenarioFile, read_file(info.scenario.file));
  add_text(kReadmeFile, readme_text(info, options.formats));
  for (const auto& writer : writers_of(info, options)) {
    for (Document& document : writer->documents()) all.emplace_back(std::move(document));
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

/// Hash of an input file of the sequence.
std::string sha256_of(const std::filesystem::path& file) {
  return bench::sha256(read_file(file));
}

std::string plan_of(const scenario::Scenario& scenario, const GenerateOptions& options) {
  const sim::Versions versions = sim::versions();
  nlohmann::ordered_json plan = {
      {"scenario", scenario.name},
      {"scenario_sha256", sha256_of(scenario.file)},
      {"scene_sha256", sha256_of(scenario.scene)},
      {"set", options.sets},
      {"seed", scenario.seed},
      {"frames", scenario.frames},
      {"formats", options.formats},
      {"program", options.program},
      {"mujoco", versions.mujoco},
      {"renderer", versions.gl_renderer},
  };
  if (scenario.ego.drive == scenario::Drive::own) {
    plan["rover_sha256"] = sha256_of(scenario.ego.drive_file);
  }
  for (const scenario::Actor& actor : scenario.actors) {
    if (actor.body || actor.shape != scenario::Shape::own) continue;
    plan["shape_sha256"][actor.name] = sha256_of(actor.shape_file);
  }
  return plan.dump();
}

sim::Warnings generate_frames(const scenario::Scenario& scenario, const GenerateOptions& options,
                              const Journal& journal, FrameRange range,
                              const std::function<void(int)>& on_frame) {
  std::set<int> missing;
  for (int k = range.first; k < range.last; ++k) {
    if (!journal.is_whole(k)) missing.insert(k);
  }
  int whole = range.last - range.first - static_cast<int>(missing.size());
  on_frame(whole);
  if (missing.empty()) return {};

  sim::Simulation simulation(scenario);
  const SequenceInfo info{scenario, simulation.calibration(), simulation.objects(),
                          simulation.origin()};
  std::vector<std::filesystem::path> later{kManifestFile};
  for (const GrowingDocument& document : documents_of(info, options)) {
    later.emplace_back(document.path());
  }
  journal.require_unwritten(later, *missing.begin());
  const FrameMaker maker(info, options, journal);
  std::optional<sim::Observation> last;  // until its next frame is simulated
  const auto make = [&](const sim::Observation& now, const sim::Observation* next) {
    maker.make(now, next);
    on_frame(++whole);
  };
  for (int k = *missing.begin(); k > 0; --k) simulation.skip();
  for (int k = *missing.begin(); k < scenario.frames && (last || k <= *missing.rbegin()); ++k) {
    const bool is_missing = missing.contains(k);
    if (!is_missing && !last) {
      simulation.skip();
      continue;
    }
    std::optional<sim::Observation> now = simulation.next();
    if (last) make(*last, &*now);
    last.reset();
    if (!is_missing) continue;
    if (k + 1 < scenario.frames) {
      last = std::move(now);
    } else {
      make(*now, nullptr);
    }
  }
  return simulation.warnings();
}

std::vector<std::string> finish_sequence(const scenario::Scenario& scenario,
                                         const GenerateOptions& options, const std::string& plan,
                                         Journal& journal) {
  const sim::Simulation simulation(scenario);  // for mounting and objects
  const SequenceInfo info{scenario, simulation.calibration(), simulation.objects(),
                          simulation.origin()};
  std::vector<GrowingDocument> documents = documents_of(info, options);
  Agreements checks;
  std::vector<FileRecord> files;
  for (int k = 0; k < scenario.frames; ++k) {
    FrameRecordEntry record = journal.read(k);
    std::move(record.files.begin(), record.files.end(), std::back_inserter(files));
    for (const auto& [name, agreement] : record.checks) checks[name].add(agreement);
    for (GrowingDocument& document : documents) document.add(record.rows);
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
  for (const GrowingDocument& document : documents) {
    const std::string text = document.text();
    journal.write(document.path(), text);
    files.push_back({document.path(), text.size(), bench::sha256(text)});
    if (document.is_empty()) {
      notes.push_back(
          fmt::format("{} is empty: there is nothing to tell in any frame", document.path()));
    }
  }
  journal.write(kManifestFile, manifest_text(plan, checks, std::move(files)));
  journal.close();
  for (const auto& [name, agreement] : checks) {
    notes.push_back(fmt::format("checked {}: at most {:.2g} over {} comparisons", name,
                                agreement.worst, agreement.compared));
  }
  return notes;
}

}  // namespace lcs::sequence
