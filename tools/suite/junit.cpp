#include "tools/suite/junit.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <cstdint>
#include <map>
#include <string>

#include "tools/files/output_file.h"
#include "tools/input/message.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

using tinyxml2::XMLElement;

void set(XMLElement& element, const char* name, const std::string& value) {
  element.SetAttribute(name, input::printable(value).c_str());
}

struct Counts {
  int tests = 0, failures = 0, errors = 0;
  double time_s = 0;

  void write(XMLElement& element) const {
    element.SetAttribute("tests", tests);
    element.SetAttribute("failures", failures);
    element.SetAttribute("errors", errors);
    element.SetAttribute("skipped", 0);
    set(element, "time", fmt::format("{:.3f}", time_s));
  }
  Counts& operator+=(const Counts& other) {
    tests += other.tests;
    failures += other.failures;
    errors += other.errors;
    time_s += other.time_s;
    return *this;
  }
};

/// The case's name without the bounds, so that it keeps its history when a bound changes. Repeated
/// names are numbered.
std::string name_of(const bench::JudgedCriterion& criterion, std::uint64_t seed,
                    std::map<std::string, int>& times) {
  std::string name = criterion.metric;
  if (criterion.min) name += " min";
  if (criterion.max) name += " max";
  if (!criterion.required) name += " (not required)";
  if (criterion.over != "seed") name += fmt::format(" of the {} over seeds", criterion.over);
  if (const int number = ++times[name]; number > 1) name += fmt::format(" #{}", number);
  return name + fmt::format(", seed {}", seed);
}

/// Adds a test case. Only the first case of a run has the run's time, so that sums are correct.
XMLElement& add_case(XMLElement& parent, const ScenarioResult& scenario, const std::string& name,
                     double time_s) {
  XMLElement& element = *parent.InsertNewChildElement("testcase");
  set(element, "classname", "lcs." + scenario.name);
  set(element, "name", name);
  set(element, "file", scenario.file.generic_string());
  set(element, "time", fmt::format("{:.3f}", time_s));
  return element;
}

void add_problem(XMLElement& element, const char* kind, const std::string& message) {
  XMLElement& problem = *element.InsertNewChildElement(kind);
  set(problem, "message", input::one_line(message.substr(0, message.find('\n'))));
  problem.SetText(input::printable(message).c_str());
}

/// \param by "" for the suite's own detector, else such as "klt: ".
Counts add_run(XMLElement& parent, const ScenarioResult& scenario, const RunResult& run,
               const std::string& by) {
  Counts counts;
  counts.time_s = run.wall_s;
  if (run.outcome == Outcome::error || run.criteria.empty()) {
    XMLElement& element =
        add_case(parent, scenario, fmt::format("{}runs, seed {}", by, run.seed), run.wall_s);
    ++counts.tests;
    if (run.outcome == Outcome::error) {
      ++counts.errors;
      add_problem(element, "error", run.error);
    }
    return counts;
  }
  std::map<std::string, int> times;
  for (const bench::JudgedCriterion& criterion : run.criteria) {
    XMLElement& element = add_case(parent, scenario, by + name_of(criterion, run.seed, times),
                                   counts.tests == 0 ? run.wall_s : 0);
    ++counts.tests;
    if (criterion.met) continue;
    if (criterion.required) {
      ++counts.failures;
      add_problem(element, "failure", criterion.message);
    } else {
      element.InsertNewChildElement("system-out")
          ->SetText(input::printable("missed (not required): " + criterion.message).c_str());
    }
  }
  return counts;
}

/// Adds the other detectors' criteria, and their errors if the suite's own run has none.
Counts add_others(XMLElement& parent, const ScenarioResult& scenario, const RunResult& run,
                  std::span<const SuiteResult> others) {
  Counts counts;
  for (const SuiteResult& other : others) {
    const ScenarioResult* by_other = find(other, scenario.name);
    const RunResult* found = by_other ? find(*by_other, run.seed) : nullptr;
    if (!found) continue;
    const bool is_error = found->outcome == Outcome::error && run.outcome != Outcome::error;
    if (is_error || !found->criteria.empty()) {
      RunResult untimed = *found;
      untimed.wall_s = 0;  // the own run already counts the process's time
      counts += add_run(parent, scenario, untimed, other.detector + ": ");
    }
  }
  return counts;
}

}  // namespace

void write_junit(const std::filesystem::path& file, const SuiteResult& suite,
                 std::span<const SuiteResult> others) {
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  XMLElement& root = *document.NewElement("testsuites");
  document.InsertEndChild(&root);
  set(root, "name", "lcs suite, detector " + suite.detector);
  Counts total;
  for (const ScenarioResult& scenario : suite.scenarios) {
    XMLElement& element = *root.InsertNewChildElement("testsuite");
    set(element, "name", scenario.name);
    Counts counts;
    for (const RunResult& run : scenario.runs) {
      counts += add_run(element, scenario, run, "");
      counts += add_others(element, scenario, run, others);
    }
    counts.write(element);
    total += counts;
  }
  total.write(root);

  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  bench::write_file(file, printer.CStr());
}

}  // namespace lcs::suite
