/// A search learns the filter's numbers: it finds better values, resumes where it stopped, and
/// never reads the data that published figures use.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "filter/types/learnt.h"
#include "scenarios/input/input_file.h"
#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/files/output_file.h"
#include "tools/suite/suite_result.h"
#include "tools/tune/search.h"

namespace lcs::tune {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

const std::vector<std::string> kKeys{"hypotheses.prior", "hypotheses.coupling",
                                     "circle.min_members"};

double number(const Parameters& parameters, const std::string& key) {
  for (const ParameterInfo& info : describe(parameters)) {
    if (info.key == key) return std::stod(info.value);
  }
  throw std::out_of_range(key);
}

/// Best at half of the first number, twice the second and the present third.
struct Hill {
  Worth operator()(const Parameters& parameters) {
    if (++calls == fails_at) throw std::runtime_error("the power failed");
    const Parameters start;
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

struct Search {
  std::vector<std::string> keys = kKeys;
  int evaluations = 120;
  std::uint64_t seed = 1;
  std::string subject = "a hill";
  Parameters start = {};

  SearchOptions options() const {
    return {.axes = axes_of(start, keys), .evaluations = evaluations, .seed = seed};
  }
  Evaluations journal(const fs::path& file) const {
    files::Provenance provenance{.facts = {{"subject", subject}}};
    add_facts(provenance.facts, options());
    return {file, provenance, keys};
  }
};

Found climb(const fs::path& file, Hill& hill, const Search& what = {}) {
  Evaluations journal = what.journal(file);
  return search(what.start, what.options(), std::ref(hill), journal, [](int) {});
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
  const Parameters start;
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
    torn << "0.015,1";  // like a line at the end of a full disk
  }
  Hill rest;
  EXPECT_EQ(values(climb(journal, rest)), expected);
  EXPECT_EQ(rest.calls, whole.calls - 10) << "those before the failure are not asked again";
  EXPECT_EQ(test::read(journal), test::read(folder.path() / "whole.csv"));
  Hill none;
  EXPECT_EQ(values(climb(journal, none)), expected);
  EXPECT_EQ(none.calls, 0);
}

TEST(SearchJournal, OfAnotherSearchIsRefusedWithWhatDiffersAndLeftAsItWas) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "journal.csv";
  Hill hill;
  climb(file, hill, {.evaluations = 3});
  const std::string before = test::read(file);
  Search moved;
  set(moved.start, kKeys[0], "0.05");
  const std::pair<Search, std::vector<std::string>> cases[] = {
      {{.subject = "a dune"}, {"subject differs ('a hill' and 'a dune')"}},
      {{.seed = 2}, {"seed differs ('1' and '2')"}},
      {moved,
       {"hypotheses.prior differs ('0.0397, tried from ", "and '0.05, tried from 0.0125 to 0.2')"}},
      {{.keys = {kKeys[0], kKeys[1]}}, {"keys differs ('[", "circle.min_members"}},
      {{.keys = {kKeys[0], kKeys[1], kKeys[2], "hypotheses.turnover"}}, {"hypotheses.turnover"}},
      {{.keys = {kKeys[1], kKeys[0], kKeys[2]}}, {"keys differs ("}},
  };
  for (const auto& [search, parts] : cases) {
    const std::string message = test::refusal_of([&] { search.journal(file); });
    for (const std::string& part : parts) {
      EXPECT_NE(message.find(part), std::string::npos) << part << "\n" << message;
    }
    EXPECT_NE(message.find("choose another folder with --out, or remove the file"),
              std::string::npos)
        << message;
    EXPECT_EQ(test::read(file), before);
  }
}

TEST(SearchJournal, WithAnyOtherByteIsRefusedAtItsLine) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "journal.csv";
  Hill hill;
  const Search search{.evaluations = 3};
  climb(file, hill, search);
  const std::string before = test::read(file);
  for (std::size_t i = 0; i + 1 < before.size(); ++i) {
    std::string changed = before;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    test::write(file, changed);
    const std::string message = test::refusal_of([&] { search.journal(file); });
    EXPECT_TRUE(message.starts_with(file.string() + ":")) << i << ": " << message;
    EXPECT_EQ(test::read(file), changed);
  }
}

TEST(SearchJournal, WithARowThatItHasNotWrittenIsRefusedAtItsLine) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "journal.csv";
  Hill hill;
  const Search search{.evaluations = 3};
  climb(file, hill, search);
  const std::string before = test::read(file);
  const std::string last = before.substr(before.rfind('\n', before.size() - 2) + 1);
  const auto lines = std::count(before.begin(), before.end(), '\n');
  for (const std::string& row :
       {std::string("0.0397,13.2,3,nan,0,0,0,0,000000000000\n"),
        std::string("0.0397,13.2,3,9e999,0,0,0,0,000000000000\n"),
        std::string("0.0397,13.2,3,,0,0,0,0,000000000000\n"),
        std::string("0.0397,13.2,3,abc,0,0,0,0,000000000000\n"),
        std::string("0.0397,13.2,3,1,0,0,0,0,000000000000\n"),
        std::string("0.0397,nan,xx,,9e999,abc\n"), std::string("\n"), std::string(9000, ',') + "\n",
        "0" + last, last.substr(0, last.size() - 2) + "\n", " " + last,
        last.substr(0, last.size() - 1) + "\r\n", "1," + last, std::string("\0\n", 2)}) {
    test::write(file, before + row);
    const std::string message = test::refusal_of([&] { search.journal(file); });
    EXPECT_TRUE(message.starts_with(file.string() + ":" + std::to_string(lines + 1) + ": "))
        << row << message;
    EXPECT_EQ(test::read(file), before + row);
  }
}

TEST(SearchJournal, CutOffAnywhereKeepsItsWholeRows) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "journal.csv";
  const Search search{.evaluations = 4};
  Hill hill;
  climb(file, hill, search);
  const std::string all = test::read(file);
  const std::size_t head = all.find("check\n") + 6;
  const auto rows_in = [&](const std::string& text) {
    return std::count(text.begin() + static_cast<std::ptrdiff_t>(head), text.end(), '\n');
  };
  for (std::size_t size = 0; size < all.size(); ++size) {
    const std::string kept = all.substr(0, size);
    test::write(file, kept);
    Hill rest;
    climb(file, rest, search);
    EXPECT_EQ(rest.calls, rows_in(all) - (size < head ? 0 : rows_in(kept))) << size;
    EXPECT_EQ(test::read(file), all);
  }
}

TEST(SearchJournal, IsNeverWrittenThroughWhatIsNoPlainFileOfItsOwn) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "evaluations.csv", other = folder.path() / "other";
  const auto refused = [&](const char* what) {
    const std::string message = test::refusal_of([&] { Search{}.journal(file); });
    EXPECT_TRUE(message.starts_with(file.string())) << what << ": " << message;
    EXPECT_NE(message.find(what), std::string::npos) << message;
  };
  Hill hill;
  climb(other, hill, {.evaluations = 1});
  const std::string journal = test::read(other);
  for (const fs::path& target : {other, fs::path("/dev/zero"), folder.path() / "none"}) {
    fs::create_symlink(target, file);
    refused("this is a link");
    EXPECT_TRUE(fs::is_symlink(file));
    fs::remove(file);
  }
  EXPECT_EQ(test::read(other), journal);
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  refused("this is a pipe");
  EXPECT_TRUE(fs::is_fifo(file));
  fs::remove(file);
  fs::create_directory(file);
  refused("this is a folder");
  fs::remove(file);
  for (const char* text : {"my notes\n", "my notes", "# lcs tune: an older one\nf1\n"}) {
    test::write(file, text);
    refused("does not begin with");
    EXPECT_EQ(test::read(file), text);
  }
}

TEST(Search, RefusesWhatIsNoNumberAboveNought) {
  const Parameters start;
  for (const auto& [keys, part] :
       {std::pair<std::vector<std::string>, const char*>{{"field.rotation"}, "above 0"},
        {{"field.ground"}, "above 0"},
        {{"hypotheses.prio"}, "the nearest is 'hypotheses.prior'"},
        {{""}, "the nearest is"},
        {{kKeys[0], kKeys[1], kKeys[0]}, "hypotheses.prior is given twice"}}) {
    const std::string message =
        test::refusal_of<std::invalid_argument>([&] { axes_of(start, keys); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

/// The command on a suite with one short run.
class TuneCommand : public testing::Test {
 protected:
  void SetUp() override { make_suite({}); }
  void make_suite(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"suite",   LCS_SCENARIOS_DIR "/crossing.yaml",
                                       "--seeds", "1",
                                       "--set",   "frames=16",
                                       "--out",   suite().string(),
                                       "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto made = test::run_lcs(arguments, {folder_.path()});
    ASSERT_LE(made.exit_code, 1) << made.err;  // the criteria do not apply to 16 frames
  }
  fs::path suite() const { return folder_.path() / "suite"; }
  fs::path out() const { return folder_.path() / "tune"; }
  test::CommandResult tune(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"tune", suite().string(), "--out", out().string(),
                                       "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::run_lcs(arguments, {folder_.path()});
  }

  TemporaryFolder folder_;
};

TEST_F(TuneCommand, StatesTheSuitesFiguresAndWritesAPresetThatItsRecordExplains) {
  const fs::path copy = folder_.path() / "copy";
  fs::copy(suite(), copy, fs::copy_options::recursive);
  const auto result =
      tune({"--keys", "hypotheses.prior", "--evaluations", "4", "--validate", copy.string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto f1 =
      scoring::value(suite::read_suite(suite()).scenarios.front().runs.front().metrics, "rebel.f1");
  std::ifstream journal(out() / "evaluations.csv");
  std::string line;
  while (std::getline(journal, line) && !line.ends_with(",check")) {
  }
  std::getline(journal, line);
  std::stringstream cells(line);
  std::getline(cells, line, ',');
  EXPECT_EQ(std::stod(line), number(Parameters{}, "hypotheses.prior"));
  std::getline(cells, line, ',');
  EXPECT_DOUBLE_EQ(std::stod(line), f1.value()) << "the first evaluation is of what there is";
  const std::string record = test::read(out() / "record.md");
  for (const char* part : {"lcs tune", "--evaluations 4", "--validate", "crossing", "before",
                           "after", "hypotheses.prior"}) {
    EXPECT_NE(record.find(part), std::string::npos) << part;
  }
  const std::string preset_text = test::read(out() / "learnt.h");
  for (const auto& [key, value] : kLearnt) {
    EXPECT_NE(preset_text.find(std::string("{\"") + key + "\", "), std::string::npos)
        << key << " is learnt, whether it was searched for or not";
  }
  EXPECT_NE(preset_text.find("{\"hypotheses.coupling\", " +
                             fmt::format("{}", number(Parameters{}, "hypotheses.coupling")) + "}"),
            std::string::npos)
      << "what was left alone keeps its value";

  const auto more = tune({"--keys", "hypotheses.prior", "--evaluations", "6"});
  EXPECT_EQ(more.exit_code, 0) << "the same search goes on: " << more.err;
}

TEST_F(TuneCommand, RefusesAJournalOfOtherRunsOrOfAnotherProgramAndLeavesItAsItWas) {
  const std::vector<std::string> command{"--keys", "hypotheses.prior", "--evaluations", "2"};
  const auto refused = [&](const std::vector<std::string>& more, const std::string& what) {
    const std::string before = test::read(out() / kEvaluationsFile);
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = tune(arguments);
    EXPECT_EQ(result.exit_code, 2) << what;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    for (const std::string& part :
         {what, std::string(kEvaluationsFile), std::string("remove the file")}) {
      EXPECT_NE(result.err.find(part), std::string::npos) << part << ": " << result.err;
    }
    EXPECT_EQ(test::read(out() / kEvaluationsFile), before);
  };
  ASSERT_EQ(tune(command).exit_code, 0);
  refused({"--seed", "2"}, "seed differs ('1' and '2')");
  refused({"--set", "hypotheses.coupling=10"}, "settings differs ('[]' and ");

  // A program that is one byte longer.
  const fs::path rebuilt = folder_.path() / "lcs", said = folder_.path() / "said";
  fs::copy_file(LCS_PROGRAM, rebuilt);
  std::ofstream(rebuilt, std::ios::app) << "x";
  const std::string before = test::read(out() / kEvaluationsFile);
  const std::string line =
      fmt::format("{} tune {} --out {} --quiet --keys hypotheses.prior --evaluations 2 2>{}",
                  rebuilt.string(), suite().string(), out().string(), said.string());
  EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 2);
  EXPECT_NE(test::read(said).find("other work: program_sha256 differs"), std::string::npos)
      << test::read(said);
  EXPECT_EQ(test::read(out() / kEvaluationsFile), before);

  // The suite generated again with another speed.
  const fs::path old = folder_.path() / "old";
  fs::rename(suite(), old);
  make_suite({"--set", "ego.speed=0.4 m/s"});
  refused({}, " differs");
  fs::remove_all(suite());
  fs::rename(old, suite());
  EXPECT_EQ(tune(command).exit_code, 0) << "all is as it was";
  // A difference in a single byte counts, too.
  for (const char* name : {"layers.jsonl.gz", "truth.jsonl.gz", "camera.json"}) {
    const fs::path file =
        suite() / suite::read_suite(suite()).scenarios.front().runs.front().folder / name;
    const std::string bytes = test::read(file);
    std::string changed = input::read_file(file, {input::kGibibyte, ""});
    changed.insert(changed.find(','), " ");
    const bool is_gzip = file.extension() == ".gz";
    files::TextFile text(is_gzip ? fs::path(file).replace_extension() : file, is_gzip);
    text.write(changed);
    text.close();
    refused({}, std::string(name) + " differs");
    test::write(file, bytes);
  }
}

TEST_F(TuneCommand, AFullDiskLosesNoRow) {
  const auto asked = [&](const char* evaluations, std::optional<std::size_t> largest) {
    return test::run_lcs({"tune", suite().string(), "--out", out().string(), "--quiet", "--keys",
                          "hypotheses.prior,hypotheses.coupling", "--evaluations", evaluations},
                         {.folder = folder_.path(), .largest_file = largest});
  };
  ASSERT_EQ(asked("4", {}).exit_code, 0);
  std::string before = test::read(out() / kEvaluationsFile);
  for (const std::size_t room : {1, 20, 0, 90}) {
    const auto full = asked("12", before.size() + room);
    EXPECT_EQ(full.exit_code, 2);
    EXPECT_NE(full.err.find("ulimit -f"), std::string::npos) << full.err;
    const std::string after = test::read(out() / kEvaluationsFile);
    EXPECT_TRUE(after.starts_with(before)) << "with room for " << room;
    before = after;
  }
  EXPECT_EQ(asked("12", 0).exit_code, 2);
  EXPECT_EQ(test::read(out() / kEvaluationsFile), before);
  ASSERT_EQ(asked("12", {}).exit_code, 0);
  const std::string rows = test::read(out() / kEvaluationsFile);
  fs::remove_all(out());
  ASSERT_EQ(asked("12", {}).exit_code, 0);
  EXPECT_EQ(rows, test::read(out() / kEvaluationsFile)) << "as if there had always been room";
}

TEST_F(TuneCommand, TwoAtATimeIntoOneFolderAreRefused) {
  test::Command first(
      {"tune", suite().string(), "--out", out().string(), "--quiet", "--evaluations", "1000000"},
      {folder_.path()});
  while (first.is_running() && !fs::exists(out() / kEvaluationsFile)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  first.send(SIGSTOP);
  const auto second = tune({"--evaluations", "1000000"});
  EXPECT_TRUE(first.is_running());
  first.send(SIGKILL);
  first.wait();
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_NE(second.err.find("in use by another lcs tune"), std::string::npos) << second.err;
  EXPECT_EQ(tune({"--evaluations", "1"}).exit_code, 0) << "the lock ends with its process";
}

TEST_F(TuneCommand, MistakesAreToldInOneLineAndNothingIsWritten) {
  fs::create_directory_symlink(suite(), folder_.path() / "link");
  const std::string same = (suite() / ".." / "suite" / "").string(),
                    link = (folder_.path() / "link").string(),
                    file = (suite() / "suite.json").string();
  const std::string copy = (folder_.path() / "copy").string();
  fs::copy(suite(), copy, fs::copy_options::recursive);
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"--keys", "nope"}, "--keys: the filter has no parameter 'nope'; the nearest is"},
      {{"--keys", "hypotheses.prior,hypotheses.prior"}, "is given twice"},
      {{"--keys", "field.ground"}, "only a number above 0"},
      {{"--set", "hypotheses.prio=1"}, "the nearest is 'hypotheses.prior'"},
      {{"--set", "hypotheses.prior=x"}, "takes a number"},
      {{"--set", "hypotheses.prior=nan"}, "takes a number"},
      {{suite().string()}, "one suite"},
      {{same}, "one suite"},
      {{link}, "one suite"},
      {{file}, "one suite"},
      {{"--validate", same}, "one suite"},
      {{"--validate", copy + "," + copy + "/."}, "one suite"},
  };
  for (const auto& [more, part] : cases) {
    const auto result = tune(more);
    EXPECT_EQ(result.exit_code, 2) << more.back();
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(out())) << more.back();
  }
}

TEST_F(TuneCommand, AScenarioWithoutFiguresIsNamed) {
  test::write(folder_.path() / "bad.yaml",
              "scene: none.xml\nframes: 4\nego: {start: [0 m, 0 m], speed: 0.3 m/s}\n");
  const auto made = test::run_lcs({"suite", "bad.yaml", "--seeds", "1", "--out",
                                   (folder_.path() / "failed").string(), "--quiet"},
                                  {folder_.path()});
  ASSERT_EQ(made.exit_code, 2) << made.err;
  const auto result = tune({(folder_.path() / "failed").string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("failed has no figures of bad, seed 0; correct it"), std::string::npos)
      << result.err;
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(TuneCommand, NamesOfSuitesCannotLeaveTheCommentsOfThePreset) {
  const fs::path named = folder_.path() / "a\n#error b \xe2\x80\xae|\\";
  fs::rename(suite(), named);
  const auto result = test::run_lcs(
      {"tune", named.string(), "--out", out().string(), "--quiet", "--evaluations", "1"},
      {folder_.path()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::stringstream lines(test::read(out() / "learnt.h"));
  int told = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("#error") == std::string::npos) continue;
    ++told;
    EXPECT_TRUE(line.starts_with("/// ")) << line;
    EXPECT_FALSE(line.ends_with('\\')) << line;
  }
  EXPECT_EQ(told, 1);
  const std::string record = test::read(out() / "record.md");
  EXPECT_EQ(record.find("\n#error"), std::string::npos) << record;
  EXPECT_EQ(test::run_lcs(
                {"tune", named.string(), "--out", out().string(), "--quiet", "--evaluations", "2"},
                {folder_.path()})
                .exit_code,
            0)
      << "its journal goes on";
}

TEST_F(TuneCommand, CountsTheFalseCornersOfRecordingsInWhichNothingMoves) {
  // A recording with movers is declared `nothing_moves`, so that there are false corners.
  const fs::path frames = folder_.path() / "frames", recorded = folder_.path() / "recorded";
  const auto drawn = test::run_lcs({"generate", LCS_SCENARIOS_DIR "/crossing.yaml", "--set",
                                    "frames=16", "--out", frames.string(), "--quiet"},
                                   {folder_.path()});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  fs::create_directory(recorded);
  std::ofstream(recorded / "still.yaml")
      << "recording: {path: " << frames.string() << ", nothing_moves: true}\n";
  const fs::path asked = folder_.path() / "asked";
  const auto made = test::run_lcs({"suite", recorded.string(), "--out", asked.string(), "--quiet"},
                                  {folder_.path()});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto off = scoring::value(suite::read_suite(asked).scenarios.front().runs.front().metrics,
                                  "rebel.false_corners_per_frame");
  ASSERT_GT(off.value(), 1);

  const auto alone = Trials({suite().string()}).worth(Parameters{});
  const auto both = Trials({suite().string(), asked.string()}).worth(Parameters{});
  EXPECT_DOUBLE_EQ(both.f1, alone.f1);
  EXPECT_DOUBLE_EQ(both.false_capped, alone.false_capped);
  EXPECT_DOUBLE_EQ(both.false_corners, off.value());
  EXPECT_NEAR(alone.objective() - both.objective(), 0.01 * off.value(), 1e-12);
}

TEST_F(TuneCommand, RefusesTheSplitTest) {
  const fs::path file = suite() / "suite.json";
  std::string text = test::read(file);
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
      test::run_lcs({"tune", folder_.path().string(), "--out", out().string()}, {folder_.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("suite.json"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace lcs::tune
