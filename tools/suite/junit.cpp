#include "tools/suite/tables.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <array>
#include <string>
#include <vector>

#include "scenarios/input/message.h"
#include "tools/files/output_file.h"
#include "tools/suite/judgement.h"

namespace lcs::suite {
namespace {

using tinyxml2::XMLElement;

constexpr const char* kBaseline = "baseline";

void set(XMLElement& element, const char* name, const std::string& value) {
  element.SetAttribute(name, input::printable(value).c_str());
}

void set_counts(XMLElement& element, const std::vector<Judgement>& judgements) {
  const CriteriaCounts counts = count_criteria(judgements);
  double time_s = 0;
  for (const Judgement& one : judgements) time_s += one.time_s;
  element.SetAttribute("tests", counts.all());
  element.SetAttribute("failures", counts.failed);
  element.SetAttribute("errors", counts.errors);
  element.SetAttribute("skipped", counts.missed);
  set(element, "time", fmt::format("{:.3f}", time_s));
}

void add_case(XMLElement& parent, const Judgement& one) {
  XMLElement& element = *parent.InsertNewChildElement("testcase");
  set(element, "classname", "lcs." + one.scenario);
  set(element, "name", one.name);
  set(element, "file", one.file.generic_string());
  set(element, "time", fmt::format("{:.3f}", one.time_s));
  if (one.judged == Judged::met) return;
  const char* const kind = one.judged == Judged::failed   ? "failure"
                           : one.judged == Judged::missed ? "skipped"
                                                          : "error";
  const std::string message =
      (one.judged == Judged::missed ? "missed, but not required: " : "") + one.message;
  XMLElement& problem = *element.InsertNewChildElement(kind);
  set(problem, "message", input::one_line(message.substr(0, message.find('\n'))));
  problem.SetText(input::printable(fmt::format("{}\nreport.html#{}", message, one.anchor)).c_str());
}

Judgement judgement_of(Finding finding, const std::string& line) {
  constexpr std::array<Judged, 4> kByFinding{Judged::failed, Judged::error, Judged::met,
                                             Judged::met};
  return {.scenario = kBaseline,
          .file = {},
          .name = "main figures",
          .judged = kByFinding.at(static_cast<std::size_t>(finding)),
          .message = line,
          .anchor = {}};
}

}  // namespace

void write_junit(const std::filesystem::path& file, const SuiteResult& suite,
                 std::span<const SuiteResult> others, const SuiteVerdict& verdict) {
  std::vector<Judgement> all = judgements_of(suite, others);
  std::vector<std::string> names;
  for (const ScenarioResult& scenario : suite.scenarios) names.push_back(scenario.name);
  if (verdict.finding) {
    names.emplace_back(kBaseline);
    all.push_back(judgement_of(*verdict.finding, verdict.line));
  }
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  XMLElement& root = *document.NewElement("testsuites");
  document.InsertEndChild(&root);
  set(root, "name", "lcs suite, detector " + suite.detector);
  set_counts(root, all);
  for (const std::string& name : names) {
    XMLElement& element = *root.InsertNewChildElement("testsuite");
    set(element, "name", name);
    std::vector<Judgement> of_scenario;
    for (const Judgement& one : all) {
      if (one.scenario == name) of_scenario.push_back(one);
    }
    set_counts(element, of_scenario);
    for (const Judgement& one : of_scenario) add_case(element, one);
  }

  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  files::write_file(file, printer.CStr());
}

}  // namespace lcs::suite
