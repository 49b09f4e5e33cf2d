/// The filter's numbers are learnt by a search that finds what is better, goes on where it was, and
/// never looks at what figures are stated on.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "filter/learnt.h"
#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/suite/suite_result.h"
#include "tools/tune/search.h"
#include "tools/tune/trials.h"

namespace lcs::tune {
namespace {

namespace fs = std::filesystem;
using bench::TemporaryFolder;

const std::vector<std::string> kKeys{"hypotheses.prior", "hypotheses.coupling",
                                     "circle.min_members"};

double number(const Parameters& parameters, const std::string& key) {
  for (const ParameterInfo& info : describe(parameters)) {
    if (info.key == key) return std::stod(info.value);
  }
  throw std::out_of_range(key);
}

/// As if the best were half of the first, twice the second and the present third.
struct Hill {
  Worth operator()(const Parameters& parameters) {
    if (++calls == fails_at) throw std::runtime_error("the power failed");
    const Parameters start = preset("default");
    double off = 0;
    const double best[] = {0.5, 2, 1};
    for (std::size_t i = 0; i < kKeys.size(); ++i) {
      const double ratio = number(parameters, kKeys[i]) / number(start, kKeys[i]);
      off += std::pow(std::log(ratio / best[i]), 2);
    }
    return {.f1 = 1 - off};
  }
  int fails_at = -1;
  int calls = 0;
};

Found climb(const fs::path& journal, Hill& hill, int evaluations = 120,
            const std::string& subject = "a hill") {
  return search(preset("default"), {.keys = kKeys, .evaluations = evaluations}, std::ref(hill),
                journal, subject, [](int) {});
}

std::string values(const Found& found) {
  std::string text;
  for (const Setting& setting : found.after) text += setting.key + '=' + setting.value + '\n';
  return text;
}

TEST(Search, FindsTheTopWithinAFewPercentAndTriesNoMoreThanAsked) {
  const TemporaryFolder folder;
  Hill hill;
  const Found found = climb(folder.path() / "journal.csv", hill);
  EXPECT_LT(found.worth_before.f1, 0.1) << "two factors of two are ln(2)^2 each";
  EXPECT_GT(found.worth_after.f1, 0.995);
  EXPECT_LE(found.evaluations, 120);
  const Parameters start = preset("default");
  EXPECT_NEAR(std::stod(found.after[0].value) / number(start, kKeys[0]), 0.5, 0.05);
  EXPECT_NEAR(std::stod(found.after[1].value) / number(start, kKeys[1]), 2, 0.15);
  EXPECT_EQ(std::stod(found.after[2].value), number(start, kKeys[2])) << "a whole number";
}

TEST(Search, GoesOnWhereItWasWithTheSameEnd) {
  const TemporaryFolder folder;
  Hill whole;
  const std::string expected = values(climb(folder.path() / "whole.csv", whole));

  const fs::path journal = folder.path() / "broken.csv";
  Hill broken{.fails_at = 11};
  EXPECT_THROW(climb(journal, broken), std::runtime_error);
  {
    std::ofstream torn(journal, std::ios::app);
    torn << "0.015,1";  // as a line is where a disk was full
  }
  Hill rest;
  EXPECT_EQ(values(climb(journal, rest)), expected);
  EXPECT_EQ(rest.calls, whole.calls - 10) << "those before the failure are not asked again";
  EXPECT_EQ(bench::read(journal), bench::read(folder.path() / "whole.csv"));
}

TEST(Search, RefusesAJournalOfAnotherSearchAndLeavesItAsItWas) {
  const TemporaryFolder folder;
  const fs::path journal = folder.path() / "journal.csv";
  Hill hill;
  climb(journal, hill, 3);
  const std::string before = bench::read(journal);
  EXPECT_THROW(climb(journal, hill, 3, "another hill"), std::runtime_error);
  EXPECT_EQ(bench::read(journal), before);
}

TEST(Search, RefusesWhatIsNoNumberAboveNought) {
  const TemporaryFolder folder;
  for (const char* key : {"circle.edge_rule", "line.ignore", "circle.no_such_thing"}) {
    Hill hill;
    EXPECT_THROW(search(preset("default"), {.keys = {key}, .evaluations = 2}, std::ref(hill),
                        folder.path() / "journal.csv", "a hill", [](int) {}),
                 std::invalid_argument)
        << key;
  }
}

/// The command on a suite of one short run.
class TuneCommand : public testing::Test {
 protected:
  void SetUp() override {
    const auto made = bench::run_lcs({"suite", LCS_SCENARIOS_DIR "/crossing.yaml", "--seeds", "1",
                                      "--set", "frames=16", "--out", suite().string(), "--quiet"},
                                     {folder_.path()});
    ASSERT_LE(made.exit_code, 1) << made.err;  // of 16 frames no criterion is asked
  }
  fs::path suite() const { return folder_.path() / "suite"; }
  fs::path out() const { return folder_.path() / "tune"; }
  bench::CommandResult tune(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"tune", suite().string(), "--out", out().string(),
                                       "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return bench::run_lcs(arguments, {folder_.path()});
  }

  TemporaryFolder folder_;
};

TEST_F(TuneCommand, StatesTheSuitesFiguresAndWritesAPresetThatItsRecordExplains) {
  const auto result =
      tune({"--keys", "hypotheses.prior", "--evaluations", "4", "--validate", suite().string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto f1 =
      bench::value(suite::read_suite(suite()).scenarios.front().runs.front().metrics, "rebel.f1");
  std::ifstream journal(out() / "evaluations.csv");
  std::string line;
  for (int i = 0; i < 3; ++i) std::getline(journal, line);
  std::stringstream cells(line);
  std::getline(cells, line, ',');
  EXPECT_EQ(std::stod(line), number(preset("default"), "hypotheses.prior"));
  std::getline(cells, line, ',');
  EXPECT_DOUBLE_EQ(std::stod(line), f1.value()) << "the first evaluation is of what there is";
  const std::string record = bench::read(out() / "record.md");
  for (const char* part : {"lcs tune", "--evaluations 4", "--validate", "crossing", "before",
                           "after", "hypotheses.prior"}) {
    EXPECT_NE(record.find(part), std::string::npos) << part;
  }
  const std::string preset_text = bench::read(out() / "learnt.h");
  for (const auto& [key, value] : kLearnt) {
    EXPECT_NE(preset_text.find(std::string("{\"") + key + "\", \""), std::string::npos)
        << key << " is learnt, whether it was searched for or not";
  }
  EXPECT_NE(
      preset_text.find("{\"hypotheses.coupling\", \"" +
                       fmt::format("{}", number(preset("default"), "hypotheses.coupling")) + "\"}"),
      std::string::npos)
      << "what was left alone keeps its value";

  const auto more = tune({"--keys", "hypotheses.prior", "--evaluations", "6"});
  EXPECT_EQ(more.exit_code, 0) << "the same search goes on: " << more.err;
  const auto other = tune({"--keys", "hypotheses.turnover", "--evaluations", "6"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("evaluations.csv is of another search"), std::string::npos) << other.err;
}

TEST_F(TuneCommand, CountsTheFalseCornersOfRecordingsInWhichNothingMoves) {
  // What moves in the scenario is said to stand, so that there are some.
  const fs::path frames = folder_.path() / "frames", recorded = folder_.path() / "recorded";
  const auto drawn = bench::run_lcs({"generate", LCS_SCENARIOS_DIR "/crossing.yaml", "--set",
                                     "frames=16", "--out", frames.string(), "--quiet"},
                                    {folder_.path()});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  fs::create_directory(recorded);
  std::ofstream(recorded / "still.yaml")
      << "recording: {path: " << frames.string() << ", nothing_moves: true}\n";
  const fs::path asked = folder_.path() / "asked";
  const auto made = bench::run_lcs({"suite", recorded.string(), "--out", asked.string(), "--quiet"},
                                   {folder_.path()});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto off = bench::value(suite::read_suite(asked).scenarios.front().runs.front().metrics,
                                "rebel.false_corners_per_frame");
  ASSERT_GT(off.value(), 1);

  const auto alone = Trials({suite().string()}).worth(preset("default"));
  const auto both = Trials({suite().string(), asked.string()}).worth(preset("default"));
  EXPECT_DOUBLE_EQ(both.f1, alone.f1);
  EXPECT_DOUBLE_EQ(both.false_capped, alone.false_capped);
  EXPECT_DOUBLE_EQ(both.false_corners, off.value());
  EXPECT_NEAR(alone.objective() - both.objective(), 0.01 * off.value(), 1e-12);
}

TEST_F(TuneCommand, RefusesTheSplitTest) {
  const fs::path file = suite() / "suite.json";
  std::string text = bench::read(file);
  const std::string group = "\"short\"";
  const std::size_t at = text.find(group);
  ASSERT_NE(at, std::string::npos);
  std::ofstream(file) << text.replace(at, group.size(), "\"test\"");
  const auto result = tune({"--evaluations", "1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("of the split test"), std::string::npos) << result.err;
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(TuneCommand, NamesWhatIsNoSuite) {
  const auto result =
      bench::run_lcs({"tune", folder_.path().string(), "--out", out().string()}, {folder_.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("suite.json"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace lcs::tune
