#include "tools/suite/suite_result.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/tools/refusal.h"
#include "tests/tools/suites.h"
#include "tests/tools/temporary_folder.h"
#include "tools/files/output_file.h"

namespace lcs::suite {
namespace {

using Json = nlohmann::ordered_json;

/// Every field has a distinct value that differs from its default.
SuiteResult full_suite() {
  SuiteResult suite = suite_with({scenario_with("near<&\"", "rebel.f1", {0.1, 1.0 / 3}),
                                  scenario_with("far", "rebel.f1", {std::nullopt})});
  suite.detector = "klt";
  suite.sets = {"ego.speed=0.7 m/s", "filter.circle.mu_0=20"};
  suite.version = "0.1.0";
  ScenarioResult& near = suite.scenarios[0];
  near.purpose = "a box crosses";
  near.file = "scenarios/near.yaml";
  near.groups = {"short", "night"};
  near.drawn = Drawn{"yard", 3, {"slope", "text"}};
  near.point = {{"ego.speed", "0.7 m/s"}, {"camera.rate", "10 Hz"}};
  RunResult& run = near.runs[0];
  run.seed = std::numeric_limits<std::uint64_t>::max();
  run.outcome = Outcome::failed;
  run.folder = "runs/near/seed-1";
  run.wall_s = 2.25;
  run.criteria = {
      {"rebel.f1", 0.5, std::nullopt, 0.1, false, false, "mean", "near.yaml:3", "rebel.f1 is 0.1"},
      {"frames", std::nullopt, 60, std::nullopt, true, true, "seed", "", ""}};
  near.runs[1].outcome = Outcome::error;
  near.runs[1].error = "scenario.yaml:3: no such key";
  near.runs[1].metrics.clear();
  return suite;
}

class SuiteFile : public testing::Test {
 protected:
  void write(const std::string& text) { std::ofstream(file_) << text; }
  Json json_of(const SuiteResult& suite) {
    write_suite(file_, suite);
    std::ifstream input(file_);
    return Json::parse(input);
  }
  std::string refusal() {
    return test::refusal_of<std::runtime_error>([&] { read_suite(file_); });
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / kSuiteFile;
};

TEST_F(SuiteFile, ComesBackToTheLastBit) {
  const SuiteResult suite = full_suite();
  write_suite(file_, suite);
  const SuiteResult back = read_suite(file_);
  EXPECT_EQ(back.detector, suite.detector);
  EXPECT_EQ(back.sets, suite.sets);
  EXPECT_EQ(back.version, suite.version);
  ASSERT_EQ(back.scenarios.size(), suite.scenarios.size());
  for (std::size_t i = 0; i < back.scenarios.size(); ++i) {
    const ScenarioResult &one = back.scenarios[i], &other = suite.scenarios[i];
    EXPECT_EQ(one.name, other.name);
    EXPECT_EQ(one.purpose, other.purpose);
    EXPECT_EQ(one.file, other.file);
    EXPECT_EQ(one.groups, other.groups);
    EXPECT_EQ(one.point, other.point);
    ASSERT_EQ(one.runs.size(), other.runs.size());
    for (std::size_t k = 0; k < one.runs.size(); ++k) {
      const RunResult &run = one.runs[k], &before = other.runs[k];
      EXPECT_EQ(run.seed, before.seed);
      EXPECT_EQ(run.outcome, before.outcome);
      EXPECT_EQ(run.error, before.error);
      EXPECT_EQ(run.metrics, before.metrics);
      EXPECT_EQ(run.folder, before.folder);
      EXPECT_EQ(run.wall_s, before.wall_s);
      ASSERT_EQ(run.criteria.size(), before.criteria.size());
      for (std::size_t c = 0; c < run.criteria.size(); ++c) {
        EXPECT_EQ(run.criteria[c].metric, before.criteria[c].metric);
        EXPECT_EQ(run.criteria[c].min, before.criteria[c].min);
        EXPECT_EQ(run.criteria[c].max, before.criteria[c].max);
        EXPECT_EQ(run.criteria[c].value, before.criteria[c].value);
        EXPECT_EQ(run.criteria[c].required, before.criteria[c].required);
        EXPECT_EQ(run.criteria[c].met, before.criteria[c].met);
        EXPECT_EQ(run.criteria[c].message, before.criteria[c].message);
      }
    }
  }
}

TEST_F(SuiteFile, IsFoundByItsFolderToo) {
  write_suite(file_, full_suite());
  EXPECT_EQ(read_suite(folder_.path()).scenarios.size(), 2u);
}

TEST_F(SuiteFile, HasNullForWhatIsUndefinedOrNotFinite) {
  SuiteResult suite = suite_with({scenario_with("a", "rebel.f1", {std::nullopt})});
  suite.scenarios[0].runs[0].metrics.emplace_back("infinite",
                                                  std::numeric_limits<double>::infinity());
  suite.scenarios[0].runs[0].metrics.emplace_back("nan", std::nan(""));
  const Json metrics = json_of(suite)["scenarios"][0]["runs"][0]["metrics"];
  for (const char* name : {"rebel.f1", "infinite", "nan"}) {
    EXPECT_TRUE(metrics.at(name).is_null()) << name;
  }
  EXPECT_EQ(read_suite(file_).scenarios[0].runs[0].metrics[1].second, std::nullopt);
}

TEST_F(SuiteFile, IsJsonWhateverBytesAChildWroteToStderr) {
  SuiteResult suite = suite_with({scenario_with("a", "rebel.f1", {0.5})});
  suite.scenarios[0].runs[0].error = "bad \xff byte";
  EXPECT_NE(json_of(suite)["scenarios"][0]["runs"][0]["error"].get<std::string>().find("bad "),
            std::string::npos);
}

TEST_F(SuiteFile, MissingFileIsNamed) {
  EXPECT_TRUE(refusal().starts_with(file_.string() + ": there is no such file; ")) << refusal();
}

TEST(SuiteFolder, HasANameForAFileWithoutAFolderAndForWhatIsNotThere) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "suite.json";
  std::ofstream(file) << "{}";
  EXPECT_EQ(folder_of(folder.path()), folder.path());
  EXPECT_EQ(folder_of(file), folder.path());
  EXPECT_EQ(folder_of("nowhere"), "nowhere");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  EXPECT_EQ(folder_of("suite.json"), ".");
  std::filesystem::current_path(before);
}

TEST_F(SuiteFile, InvalidJsonIsNamedWithThePlace) {
  write("{\"format\": 1, ");
  EXPECT_TRUE(refusal().starts_with(file_.string() + ":1: not JSON at byte")) << refusal();
}

struct Damage {
  const char* name;
  const char* pointer;  ///< to the replaced value
  Json value;           ///< discarded: removed
  const char* said;
};

class DamagedSuiteFile : public SuiteFile, public testing::WithParamInterface<Damage> {};

TEST_P(DamagedSuiteFile, IsRefusedNamingFileAndPlace) {
  Json json = json_of(full_suite());
  const Json::json_pointer pointer(GetParam().pointer);
  if (GetParam().value.is_discarded()) {
    json.at(pointer.parent_pointer()).erase(pointer.back());
  } else {
    json[pointer] = GetParam().value;
  }
  write(json.dump());
  EXPECT_TRUE(refusal().starts_with(file_.string() + ": " + GetParam().said + "; name the folder"))
      << refusal();
}

INSTANTIATE_TEST_SUITE_P(
    All, DamagedSuiteFile,
    testing::Values(
        Damage{"list", "", Json::array(), "the file is not an object"},
        Damage{"other_json", "/format", Json(Json::value_t::discarded), "format is missing"},
        Damage{"later_format", "/format", 2, "its format is 2, this program reads 1"},
        Damage{"detector", "/detector", 1, "detector is not a text"},
        Damage{"sets", "/sets", "ego.speed=1", "sets is not a list"},
        Damage{"no_seed", "/scenarios/0/runs/1/seed", Json(Json::value_t::discarded),
               "scenarios[0].runs[1].seed is missing"},
        Damage{"negative_seed", "/scenarios/0/runs/1/seed", -1,
               "scenarios[0].runs[1].seed is not a whole number from 0"},
        Damage{"outcome", "/scenarios/0/runs/0/outcome", "fine",
               "scenarios[0].runs[0].outcome is not passed, failed or error"},
        Damage{"metric", "/scenarios/0/runs/0/metrics/rebel.f1", "0.5",
               "scenarios[0].runs[0].metrics.rebel.f1 is not a number or null"},
        Damage{"met", "/scenarios/0/runs/0/criteria/1/met", 1,
               "scenarios[0].runs[0].criteria[1].met is not true or false"},
        Damage{"point", "/scenarios/0/point/1", Json::array({"ego.speed"}),
               "scenarios[0].point[1] is not a key and a value"},
        Damage{"same_seeds", "/scenarios/0/runs/1/seed", std::numeric_limits<std::uint64_t>::max(),
               "near<&\" has two runs of seed 18446744073709551615"},
        Damage{"same_names", "/scenarios/1/name", "near<&\"", "two scenarios are called near<&\""}),
    [](const auto& test) { return test.param.name; });

TEST_F(SuiteFile, UnwritableFileIsAnOutputError) {
  EXPECT_THROW(write_suite("/no/such/folder/suite.json", full_suite()), files::OutputError);
  EXPECT_THROW(write_suite("/dev/full", full_suite()), files::OutputError);
}

}  // namespace
}  // namespace lcs::suite
