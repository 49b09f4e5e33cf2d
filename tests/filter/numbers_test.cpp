/// The default filter's numbers are counted, and MODEL.md states the origin of each.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "filter/parameters.h"
#include "tests/tools/files.h"

namespace lcs {
namespace {

namespace fs = std::filesystem;
const fs::path kFilter = LCS_FILTER_SOURCE_DIR;

/// Keys of the default filter's numeric parameters.
std::set<std::string> keys() {
  std::set<std::string> keys;
  const Parameters parameters;
  for (const ParameterInfo& info : describe(parameters)) {
    const bool is_number = info.range.find(" to ") != std::string::npos;
    if (is_number) keys.insert(info.key);
  }
  return keys;
}

/// "edges/coupling.cpp kFar": constants of the folders that `default` runs, without the ego-motion
/// estimator, which models a sensor and is no part of the filter's model.
std::set<std::string> constants() {
  const std::regex constant(
      R"(constexpr (?:double|int|float|std::size_t) ((?:k\w+ = [-\d.e]+(?:, )?)+))");
  const std::regex name(R"((k\w+) = )");
  std::set<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(kFilter)) {
    const fs::path file = entry.path().lexically_relative(kFilter);
    const std::string room = file.begin()->string();
    if (!entry.is_regular_file() || file.extension() == ".md" || room == "paper" ||
        room == "detect" || room == "ego_motion" || room == "vectors") {
      continue;
    }
    const std::string text = test::read(entry.path());
    for (std::sregex_iterator c(text.begin(), text.end(), constant), end; c != end; ++c) {
      const std::string names = (*c)[1];
      for (std::sregex_iterator n(names.begin(), names.end(), name); n != end; ++n) {
        found.insert(file.string() + " " + std::string((*n)[1]));
      }
    }
  }
  return found;
}

/// Fewer is better: lower the bound after removing a number.
TEST(Numbers, AreNoMoreThanTheyWere) {
  EXPECT_LE(keys().size(), 32u);
  EXPECT_LE(constants().size(), 14u);
  EXPECT_GE(constants().size(), 8u) << "are they still found?";
}

TEST(Numbers, HaveASourceEach) {
  const std::string model = test::read(kFilter / "MODEL.md");
  const std::string table = model.substr(model.find("## Symbols"));
  for (const std::string& key : keys()) {
    EXPECT_NE(table.find('`' + key + '`'), std::string::npos) << key;
  }
  for (const std::string& constant : constants()) {
    const std::string name = constant.substr(constant.find(' ') + 1);
    EXPECT_NE(table.find('`' + name + '`'), std::string::npos) << constant;
  }
}

}  // namespace
}  // namespace lcs
