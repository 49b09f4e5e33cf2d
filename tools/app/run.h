/// \file
/// Simulates a scenario, or reads its recording, runs detectors on its frames and scores them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/app/caller.h"
#include "tools/app/option.h"
#include "tools/comparators/detectors.h"
#include "tools/output/result.h"
#include "tools/scoring/criteria.h"

namespace lcs::app {

/// The detector that a request names.
struct DetectorChoice {
  std::string name;     ///< "": lcs, or a default name for a program or file
  std::string command;  ///< of a detector program; "": no program
  double timeout_s = comparators::Program{}.timeout_s;
  std::string detections;  ///< CSV file or folder; "": none
};

/// The detector. Records the files that a detector's command names as inputs of this process.
/// \throws std::invalid_argument as the `comparators::spec_of` functions do.
comparators::DetectorSpec spec_of(const DetectorChoice& choice);

/// Gets each frame of the video, until it returns false.
using ShowFrame = std::function<bool(const cv::Mat3b& sheet)>;

struct RunRequest {
  std::string scenario = {};  ///< scenario file
  std::string out = {};       ///< folder; "" is out/<scenario's name>
  std::optional<std::uint64_t> seed = {};
  std::vector<std::string> sets = {};  ///< "key=value"
  std::string frames = {};             ///< number of frames; "": as in the scenario
  DetectorChoice detector = {};
  std::vector<std::string> beside = {};  ///< "detector=folder" of further detectors
  std::string recorded = {};  ///< folder of an earlier run that provides the frames; "": simulate
  output::Keep keep = output::Keep::all;
  bool gzip = false;  ///< compress layers and truth
  bool video = true;
  bool events = false;
  bool report = false;  ///< write report.html, and with it events.json
  int threads = 1;      ///< 1 or 2, as of `bench::run`; 2 not with `view`
  /// Makes the receiver of the video's frames; null: none.
  std::function<ShowFrame(const scenario::Scenario&)> view = {};
  std::vector<std::string> command = {};  ///< of a request that is carried out as this one
};

Options options_of(RunRequest& request);

/// What a detector has reached in a run.
struct DetectorMade {
  std::string name;
  std::vector<scoring::JudgedCriterion> criteria;
  scoring::Metrics metrics;
  std::filesystem::path folder;
};

struct RunMade {
  std::vector<DetectorMade> detectors;  ///< the run's own first, then `beside`'s detectors
  std::optional<int> pictures_skipped;  ///< of a recording
  scenario::Scenario scenario = {};     ///< as it was run
};

/// \throws input::Error, files::OutputError, sim::PhysicsError, std::exception, and an
///   exception of `caller.check`; then no output is written, and earlier output is unchanged.
RunMade run(const RunRequest& request, Caller& caller);

/// As `run`, for a loaded scenario: `request.seed` is ignored; `request.scenario`, `sets` and
/// `frames` only appear in the report. \throws as `run`.
RunMade run_scenario(const RunRequest& request, scenario::Scenario scenario, Caller& caller);

}  // namespace lcs::app
