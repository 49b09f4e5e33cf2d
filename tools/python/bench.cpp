// The commands of the program as Python functions.
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

#include "scenarios/input/inputs_read.h"
#include "scenarios/shipped.h"
#include "tools/app/compare.h"
#include "tools/app/generate.h"
#include "tools/app/how_made.h"
#include "tools/app/kinematics.h"
#include "tools/app/replay.h"
#include "tools/app/score.h"
#include "tools/app/suite.h"
#include "tools/app/tune.h"
#include "tools/app/world.h"
#include "tools/python/guard.h"
#include "tools/python/keywords.h"
#include "tools/python/scenario.h"
#include "tools/python/type.h"
#include "tools/suite/summary.h"
#include "tools/suite/tables.h"

namespace lcs::python {

/// The texts of help/: arguments and results of the functions.
extern const std::string_view kSuiteHelp, kCompareHelp, kWorldHelp, kRunHelp, kReplayHelp,
    kGenerateHelp, kTuneHelp, kKinematicsHelp;

namespace {

using namespace py::literals;

using app::Texts;

/// Collects messages for Python, and ends the work after Ctrl-C.
class PythonCaller : public app::Caller {
 public:
  explicit PythonCaller(py::object progress = py::none()) : progress_(std::move(progress)) {}

  void check() override {
    constexpr std::chrono::milliseconds kPeriod(50);
    {
      const std::lock_guard lock(mutex_);
      const auto now = std::chrono::steady_clock::now();
      if (now - checked_ < kPeriod) return;
      checked_ = now;
    }
    check_signals();
  }
  void tell(const std::string& line) override {
    const std::lock_guard lock(mutex_);
    messages_.push_back(line);
  }
  void warn(const Texts& lines) override {
    const std::lock_guard lock(mutex_);
    warnings_.insert(warnings_.end(), lines.begin(), lines.end());
  }
  std::unique_ptr<app::Progress> progress(const std::string&, int total,
                                          const std::string&) override {
    return std::make_unique<Counter>(*this, total);
  }
  void finished(const suite::SuiteProgress& progress, const std::string&, const Texts&,
                std::span<const suite::RunResult* const>) override {
    count(progress.done, progress.total);
  }

  /// Issues the warnings. \return the other messages.
  Texts messages() {
    python::warn(std::exchange(warnings_, {}));
    return messages_;
  }

 private:
  /// Calls the Python function, if there is one, with the numbers of finished and of all units.
  void count(auto done, auto total) {
    const py::gil_scoped_acquire interpreter;
    if (!progress_.is_none()) progress_(done, total);
  }
  struct Counter : app::Progress {
    Counter(PythonCaller& caller_, int total_) : caller(caller_), total(total_) {}
    void show(int done) override {
      check_signals();
      caller.count(done, total);
    }
    PythonCaller& caller;
    int total;
  };

  py::object progress_;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point checked_{};
  Texts messages_, warnings_;
};

/// Does the work while other Python threads run.
template <class Work>
auto carry_out(const Work& work) {
  require_no_fork();
  app::note_start();
  input::forget_inputs();  // an earlier call's inputs may be this one's outputs
  const py::gil_scoped_release others_may_run;
  const OneThread one_thread;
  return work();
}

py::dict dict_of(const scoring::Metrics& metrics) {
  py::dict figures;
  for (const auto& [name, figure] : metrics) figures[name.c_str()] = figure;
  return figures;
}

py::list list_of(const std::vector<scoring::JudgedCriterion>& criteria) {
  py::list list;
  for (const scoring::JudgedCriterion& one : criteria) {
    list.append(py::dict("metric"_a = one.metric, "min"_a = one.min, "max"_a = one.max,
                         "value"_a = one.value, "required"_a = one.required, "met"_a = one.met,
                         "over"_a = one.over, "message"_a = one.message));
  }
  return list;
}

/// Adds a row for each run of a suite. \param folder of the detector's results.
void add_runs(const suite::SuiteResult& suite, const fs::path& folder, py::list& rows) {
  for (const suite::ScenarioResult& scenario : suite.scenarios) {
    for (const suite::RunResult& run : scenario.runs) {
      rows.append(
          py::dict("detector"_a = suite.detector, "scenario"_a = scenario.name, "seed"_a = run.seed,
                   "family"_a = scenario.drawn ? py::cast(scenario.drawn->family) : py::none(),
                   "outcome"_a = suite::word_of(run.outcome), "error"_a = run.error,
                   "metrics"_a = dict_of(run.metrics), "criteria"_a = list_of(run.criteria),
                   "folder"_a = run.folder.empty() ? py::none() : py::cast(folder / run.folder),
                   "command"_a = run.command));
    }
  }
}

/// Adds a row for each mean in the tables of the program.
void add_means(const suite::SuiteResult& suite, py::list& rows) {
  const bool of_worlds = suite::is_of_worlds(suite);
  for (const std::string& group : suite::groups_of(suite)) {
    for (const std::string_view metric : scoring::keys_in(scoring::Table::suite)) {
      const std::vector<double> figures = suite::figures_of_group(suite, group, metric);
      if (figures.empty()) continue;
      const suite::Interval mean = suite::interval_of(figures);
      rows.append(py::dict("detector"_a = suite.detector, "group"_a = group,
                           "metric"_a = std::string(metric), "mean"_a = mean.mean,
                           "half"_a = of_worlds ? mean.half : std::nullopt,
                           "count"_a = figures.size()));
    }
  }
}

py::list list_of(const std::vector<suite::Difference>& differences, const char* what) {
  py::list list;
  for (const suite::Difference& one : differences) {
    list.append(py::dict(py::arg(what) = one.scenario, "metric"_a = one.metric,
                         "before"_a = one.before, "after"_a = one.after,
                         "change"_a = one.change.mean, "half"_a = one.change.half,
                         "pairs"_a = one.pairs, "verdict"_a = suite::word_of(one.verdict)));
  }
  return list;
}

py::dict dict_of(const suite::Comparison& comparison, const suite::SuiteVerdict& verdict) {
  return py::dict(
      "verdict"_a = verdict.line, "finding"_a = suite::word_of(*verdict.finding),
      "regressed"_a = comparison.has_regressed(), "means"_a = list_of(comparison.groups, "group"),
      "scenarios"_a = list_of(comparison.differences, "scenario"),
      "incomparable"_a = comparison.incomparable, "text"_a = suite::text_of(comparison, false));
}

py::dict dict_of(const app::SuiteMade& made, PythonCaller& caller) {
  py::list runs, means;
  add_runs(made.result, made.folder, runs);
  add_means(made.result, means);
  suite::Outcome outcome = suite::outcome_of(made.result);
  for (const suite::SuiteResult& other : made.others) {
    add_runs(other, made.folder / app::part_of(other.detector, made.result.detector), runs);
    add_means(other, means);
    outcome = std::max(outcome, suite::outcome_of(other));
  }
  std::string table = suite::suite_table(made.result, false);
  if (!made.others.empty()) table += '\n' + suite::beside_table(made.result, made.others);
  caller.warn(suite::warnings(made.result));
  return py::dict("folder"_a = made.folder, "outcome"_a = suite::word_of(outcome), "runs"_a = runs,
                  "means"_a = means, "table"_a = table, "verdict"_a = made.verdict.line,
                  "comparison"_a = made.comparison
                                       ? py::object(dict_of(*made.comparison, made.verdict))
                                       : py::none(),
                  "messages"_a = caller.messages());
}

py::dict dict_of(const app::RunMade& made, PythonCaller& caller) {
  py::dict detectors;
  for (const app::DetectorMade& one : made.detectors) {
    detectors[one.name.c_str()] =
        py::dict("metrics"_a = dict_of(one.metrics), "criteria"_a = list_of(one.criteria),
                 "folder"_a = one.folder);
  }
  return py::dict("scenario"_a = made.scenario.name, "seed"_a = made.scenario.seed,
                  "detectors"_a = detectors, "messages"_a = caller.messages());
}

py::dict dict_of(const app::WorldMade& made, PythonCaller&) {
  return py::dict("file"_a = made.folder / (worlds::name_of(made.world) + ".yaml"),
                  "objects"_a = made.world.bodies.size(),
                  "movers"_a = made.world.scenario.actors.size(),
                  "drawn_again"_a = made.world.attempt, "features"_a = made.world.features);
}

py::dict dict_of(const tune::Worth& worth) {
  return py::dict("objective"_a = worth.objective(), "f1"_a = worth.f1,
                  "false_moving"_a = worth.false_moving, "false_static"_a = worth.false_static,
                  "false_corners"_a = worth.false_corners);
}

py::dict dict_of(const std::vector<tune::Setting>& settings) {
  py::dict dict;
  for (const tune::Setting& setting : settings) dict[setting.key.c_str()] = setting.value;
  return dict;
}

py::dict dict_of(const app::TuneMade& made, PythonCaller& caller) {
  py::list stated;
  for (const tune::Stated& one : made.stated) {
    stated.append(py::dict("suite"_a = one.suite, "before"_a = dict_of(one.before),
                           "after"_a = dict_of(one.after)));
  }
  return py::dict("folder"_a = made.folder, "before"_a = dict_of(made.found.before),
                  "after"_a = dict_of(made.found.after), "stated"_a = stated,
                  "evaluations"_a = made.found.evaluations, "record"_a = made.record,
                  "messages"_a = caller.messages());
}

py::dict dict_of(const app::KinematicsMade& made, PythonCaller& caller) {
  py::list answer;
  for (const kinematics::Statement& one : made.answer) {
    py::list figures;
    for (const kinematics::Figure& figure : one.figures) {
      figures.append(py::dict("name"_a = figure.name, "value"_a = figure.value,
                              "unit"_a = figure.unit, "expected"_a = figure.expected));
    }
    answer.append(py::dict("topic"_a = one.topic, "text"_a = one.text, "figures"_a = figures,
                           "verdict"_a = one.verdict));
  }
  return py::dict("folder"_a = made.folder, "answer"_a = answer, "text"_a = made.text,
                  "messages"_a = caller.messages());
}

/// Defines a function of a request. \param usual has the defaults.
/// \param work gets the request and its caller. \return a dict.
template <class Request, class Do>
void define(py::module_& module, const Call& call, Request usual, const Do& work,
            std::string_view about) {
  py::options texts;
  texts.disable_function_signatures();
  const app::Options options = options_of(usual);
  const std::string text = fmt::format("{}\n\n{}", signature_of(call, options), about);
  module.def(
      options.command.c_str(),
      [call, usual, work](const py::args& values, const py::kwargs& named) {
        Request request = usual;
        PythonCaller caller(read_arguments(call, options_of(request), values, named));
        return py::module_::import("lcs").attr("Answer")(work(std::as_const(request), caller));
      },
      text.c_str());
}

/// As a function's work: carries out a request, and makes a dict of the result.
template <class Request, class Made>
auto dict_by(Made (*make)(const Request&, app::Caller&)) {
  return [make](const Request& request, PythonCaller& caller) {
    return dict_of(carry_out([&] { return make(request, caller); }), caller);
  };
}

void bind_suites(py::module_& module) {
  define(module, {.takes_progress = true}, app::SuiteRequest{}, dict_by(app::suite), kSuiteHelp);
  define(module, {}, app::MergeRequest{}, dict_by(app::merge),
         "Joins the folders of the parts of a suite (shard). Returns as suite.");
  define(
      module, {.positional = 2}, app::CompareRequest{},
      [](const app::CompareRequest& request, PythonCaller& caller) {
        const auto [old, now, comparison, verdict, warnings] = app::compare(request);
        caller.warn(warnings);
        caller.messages();
        return dict_of(comparison, verdict);
      },
      kCompareHelp);
}

void bind_worlds(py::module_& module) {
  define(module, {.positional = 2}, app::WorldRequest{}, dict_by(app::world), kWorldHelp);
  module.def(
      "worlds",
      [](const std::string& split, int count, const std::string& family, int jobs) {
        PythonCaller caller;
        const std::vector<worlds::Kept> chosen = app::chosen_worlds({split, count, family}, "");
        return carry_out([&] { return app::draw_worlds(chosen, app::jobs_at_once(jobs), caller); });
      },
      "split"_a, "count"_a = 60, py::kw_only(), "family"_a = "", "jobs"_a = 0,
      R"(The scenario files of the first worlds of a split: train, validate or test, by which nothing may be
chosen. Those that are missing in out/worlds/ are drawn, jobs at a time.)");
}

void bind_runs(py::module_& module) {
  define(module, {.takes_progress = true}, app::RunRequest{.video = false}, dict_by(app::run),
         kRunHelp);
  module.def(
      "_score_files",
      [](const fs::path& folder, const fs::path& detections) {
        PythonCaller caller;
        const app::Scored scored = carry_out([&] {
          return app::score({folder.string(), detections.string()}, caller);
        });
        if (scored.suite) throw py::value_error("a suite has many runs; give the folder of one");
        return dict_of(scored.metrics);
      },
      "folder"_a, "detections"_a = "", "The figures of a stored run, as lcs score computes them.");
  define(module, {.takes_progress = true}, app::ReplayRequest{.run = {.video = false}},
         dict_by(app::replay), kReplayHelp);
  define(
      module, {.takes_progress = true}, app::GenerateRequest{},
      [](const app::GenerateRequest& request, PythonCaller& caller) {
        if (request.is_of_many()) {
          const app::SequencesMade made =
              carry_out([&] { return app::generate_suite(request, caller); });
          return py::dict("folders"_a = made.folders, "errors"_a = made.errors,
                          "messages"_a = caller.messages());
        }
        const app::Generated made = carry_out([&] { return app::generate(request, caller); });
        return py::dict("folders"_a = std::vector{made.folder}, "errors"_a = Texts{},
                        "frames"_a = std::pair(made.range.first, made.range.last),
                        "notes"_a = made.notes, "messages"_a = caller.messages());
      },
      kGenerateHelp);
}

void bind_studies(py::module_& module) {
  define(module, {.takes_progress = true}, app::TuneRequest{}, dict_by(app::tune), kTuneHelp);
  define(module, {.takes_progress = true}, app::KinematicsRequest{}, dict_by(app::kinematics),
         kKinematicsHelp);
}

}  // namespace

void bind_bench(py::module_& module) {
  bind_suites(module);
  bind_worlds(module);
  bind_runs(module);
  bind_studies(module);
  module.def("_use_program", &scenario::set_program, "file"_a,
             "The program lcs, which runs suites.");
  module.def("_shipped_folder", &scenario::shipped_folder, "name"_a);
}

}  // namespace lcs::python
