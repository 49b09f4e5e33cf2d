#include "tools/likeness/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/files/output_file.h"
#include "tools/likeness/likeness_script.h"
#include "tools/report/page_writer.h"
#include "tools/scoring/statistics.h"

namespace lcs::likeness {
namespace {

using Json = nlohmann::json;
constexpr const char* kTable = "likeness.csv";
constexpr const char* kPage = "page.html";
constexpr const char* kHead = "origin,group,run,frame";
constexpr std::array<double, 5> kShares{0.1, 0.25, 0.5, 0.75, 0.9};
constexpr std::size_t kLow = 0, kMiddle = 2, kHigh = 4;

std::string_view name_of(Origin origin) {
  return origin == Origin::world ? "world" : origin == Origin::suite ? "suite" : "recording";
}

template <class Takes>
Group group(Origin origin, const std::string& name, const std::vector<Row>& rows, Takes takes) {
  Group group{origin, name, 0, 0, {}};
  std::array<std::vector<double>, kMeasures> values;
  std::set<std::string> runs;
  for (const Row& row : rows) {
    if (row.origin != origin || !takes(row)) continue;
    ++group.pairs;
    runs.insert(row.run);
    for (std::size_t m = 0; m < kMeasures; ++m) {
      const auto& value = row.values[static_cast<Measure>(m)];
      if (value) values[m].push_back(*value);
    }
  }
  group.runs = runs.size();
  for (std::size_t m = 0; m < kMeasures && group.pairs > 0; ++m) {
    if (values[m].empty()) continue;
    for (const double share : kShares) {
      group.quantiles[m].push_back(*bench::quantile(values[m], share));
    }
  }
  return group;
}

/// Whether a recording's median is not what most worlds have.
bool is_outside(const Group& group, const Group& worlds, std::size_t measure) {
  const auto &own = group.quantiles[measure], &theirs = worlds.quantiles[measure];
  return group.origin == Origin::recording && !own.empty() && !theirs.empty() &&
         (own[kMiddle] < theirs[kLow] || own[kMiddle] > theirs[kHigh]);
}

std::string digits(double value) {
  const double size = std::abs(value);
  return fmt::format("{:.{}f}", value, size < 10 ? 2 : size < 100 ? 1 : 0);
}

std::string data_of(const std::vector<Group>& groups) {
  Json data = {{"measures", Json::array()}, {"groups", Json::array()}};
  for (const MeasureText& measure : measures()) {
    data["measures"].push_back(
        {{"name", measure.name}, {"about", measure.about}, {"by_factors", measure.by_factors}});
  }
  for (const Group& group : groups) {
    Json outside = Json::array();
    for (std::size_t m = 0; m < kMeasures; ++m) {
      outside.push_back(is_outside(group, groups.front(), m));
    }
    data["groups"].push_back({{"origin", name_of(group.origin)},
                              {"name", group.name},
                              {"runs", group.runs},
                              {"pairs", group.pairs},
                              {"quantiles", group.quantiles},
                              {"outside", outside}});
  }
  return data.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::vector<Group> groups_of(const std::vector<Row>& rows) {
  std::vector<Group> groups{group(Origin::world, "worlds", rows, [](const Row&) { return true; })};
  for (const Origin origin : {Origin::world, Origin::suite, Origin::recording}) {
    std::set<std::string> known;
    for (const Row& row : rows) {
      if (row.origin != origin || !known.insert(row.group).second) continue;
      groups.push_back(group(origin, row.group, rows,
                             [&](const Row& other) { return other.group == row.group; }));
    }
  }
  return groups;
}

std::string text_of(const std::vector<Group>& groups) {
  std::size_t longest = 5;
  for (const Group& group : groups) longest = std::max(longest, group.name.size());
  std::string text = fmt::format("{:<{}}  runs", "", longest);
  for (const MeasureText& measure : measures()) text += fmt::format("  {}", measure.name);
  text += "\n";
  bool is_marked = false;
  for (const Group& group : groups) {
    if (group.pairs == 0) continue;
    text += fmt::format("{:<{}}  {:>4}", group.name, longest, group.runs);
    for (std::size_t m = 0; m < kMeasures; ++m) {
      const auto& own = group.quantiles[m];
      const bool outside = is_outside(group, groups.front(), m);
      is_marked |= outside;
      const std::string median = own.empty() ? "-" : digits(own[kMiddle]);
      text += fmt::format("  {:>{}}", outside ? "*" + median : median, measures()[m].name.size());
    }
    text += "\n";
  }
  if (is_marked) text += "* outside of what 80 in 100 pictures of worlds have\n";
  return text;
}

bench::ResultNames likeness_files() {
  return {kTable, kPage};
}

void write_likeness(const std::filesystem::path& folder, const std::vector<Row>& rows) {
  std::string text = kHead;
  for (const MeasureText& measure : measures()) text += fmt::format(",{}", measure.name);
  for (const Row& row : rows) {
    text += fmt::format("\n{},{},{},{}", name_of(row.origin), row.group, row.run, row.frame);
    for (std::size_t m = 0; m < kMeasures; ++m) {
      const auto& value = row.values[static_cast<Measure>(m)];
      text += value ? fmt::format(",{:.6g}", *value) : ",";
    }
  }
  bench::write_file(folder / kTable, text + "\n");
  report::write_page(folder / kPage, {.title = "lcs likeness",
                                      .data = data_of(groups_of(rows)),
                                      .script = kLikenessJs,
                                      .where_else = kTable});
}

}  // namespace lcs::likeness
