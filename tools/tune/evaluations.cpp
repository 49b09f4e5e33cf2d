#include "tools/tune/evaluations.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

#include "scenarios/input/error.h"
#include "scenarios/input/message.h"
#include "tools/files/csv.h"

namespace lcs::tune {
namespace {

constexpr const char* kSign = "# Written by `lcs tune`: the sets of numbers that it has tried";
constexpr const char* kRemedy = "choose another folder with --out, or remove the file";
constexpr double Worth::*kFigures[] = {&Worth::f1, &Worth::false_moving, &Worth::false_static,
                                       &Worth::false_capped, &Worth::false_corners};
constexpr const char* kColumns = "f1,false_moving,false_static,false_capped,false_corners,check";

}  // namespace

Evaluations::Evaluations(const std::filesystem::path& file, const files::Provenance& provenance,
                         const std::vector<std::string>& keys)
    : journal_(file, kSign, provenance, fmt::format("{},{}", fmt::join(keys, ","), kColumns),
               kRemedy, [&](const std::string& row, int line) {
                 const auto refuse = [&](const std::string& what) {
                   throw input::Error({file.string(), line}, "the row '{}' {}; {}",
                                      input::one_line(row), what, kRemedy);
                 };
                 const auto cells = files::fields_of(row);
                 if (cells.size() != keys.size() + std::size(kFigures)) {
                   refuse(fmt::format("has {} cells, and not {}", cells.size(),
                                      keys.size() + std::size(kFigures)));
                 }
                 std::vector<std::string> values;
                 Worth worth;
                 for (std::size_t i = 0; i < cells.size(); ++i) {
                   const auto number = files::number_in<double>(cells[i]);
                   if (!number) {
                     refuse(fmt::format("has '{}', which is no number", input::one_line(cells[i])));
                   }
                   if (i < keys.size()) {
                     values.emplace_back(cells[i]);
                   } else {
                     worth.*kFigures[i - keys.size()] = *number;
                   }
                 }
                 known_[values] = worth;
               }) {}

std::optional<Worth> Evaluations::find(const std::vector<std::string>& values) const {
  const auto found = known_.find(values);
  return found == known_.end() ? std::nullopt : std::optional(found->second);
}

void Evaluations::add(const std::vector<std::string>& values, const Worth& worth) {
  std::string row = fmt::format("{}", fmt::join(values, ","));
  for (double Worth::*figure : kFigures) row += fmt::format(",{}", worth.*figure);
  journal_.add(row);
  known_[values] = worth;
}

}  // namespace lcs::tune
