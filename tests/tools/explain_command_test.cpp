// `lcs explain` from its command line, on the output of `lcs run`.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/recording_io.h"

namespace lcs::test {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

constexpr int kFrame = 5;

class ExplainCommand : public testing::Test {
 protected:
  /// A run, made once.
  static void SetUpTestSuite() {
    made_ = std::make_unique<TemporaryFolder>();
    const CommandResult result =
        lcs({"run", fs::path(LCS_SCENARIOS_DIR) / "crossing.yaml", "--set", "frames=8", "--set",
             "filter.hypotheses.prior=0.05", "--no-video", "--events", "--report", "--quiet",
             "--out", "run"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  static void TearDownTestSuite() { made_.reset(); }

  static CommandResult lcs(const Arguments& arguments) {
    return run_lcs(arguments, {.folder = made_->path()});
  }
  static fs::path home() { return made_->path(); }
  static recording::FrameRecord frame() {
    return recording::read_recording(home() / "run").frames.at(kFrame);
  }
  /// One that has a corner in this frame and in the frame before.
  static std::string track() {
    for (const Edge& edge : frame().layers.normal_edges) {
      if (edge.corner >= 0 && edge.age >= 3 && edge.trust > 5) return std::to_string(edge.id);
    }
    ADD_FAILURE() << "no static corner is followed";
    return "1";
  }
  /// A copy of the run without its pictures.
  static fs::path copy(const std::string& name) {
    const fs::path folder = home() / name;
    fs::create_directory(folder);
    for (const char* file :
         {"layers.jsonl", "truth.jsonl", "camera.json", "detector.json", "run.json"}) {
      fs::copy_file(home() / "run" / file, folder / file, fs::copy_options::overwrite_existing);
    }
    return folder;
  }
  /// Refused in one line, with the remedy, and nothing is written.
  static void expect_refused(Arguments arguments, const std::string& said) {
    arguments.insert(arguments.begin(), "explain");
    arguments.insert(arguments.end(), {"--picture", "no.png"});
    const CommandResult result = lcs(arguments);
    EXPECT_EQ(result.exit_code, 2) << said;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find(said), std::string::npos) << said << "\n" << result.err;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(home() / "no.png"));
  }

 private:
  static std::unique_ptr<TemporaryFolder> made_;
};
std::unique_ptr<TemporaryFolder> ExplainCommand::made_;

TEST_F(ExplainCommand, StatesTheNumbersOfACornerWithTheirEquations) {
  const recording::FrameRecord seen = frame();
  const auto rebel = std::ranges::find(seen.reasons, Reason::rebel_edge);
  ASSERT_NE(rebel, seen.reasons.end());
  const auto i = static_cast<std::size_t>(rebel - seen.reasons.begin());
  const std::string x = fmt::format("{}", seen.corners_px[i].x() + 1),
                    y = fmt::format("{}", seen.corners_px[i].y());
  const CommandResult result = lcs({"explain", "run", std::to_string(kFrame), x, y});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  for (const char* part : {"crossing frame 5", "verdict  rebel by rebel_edge", "truth    ",
                           "(1)      x_r, px = (", "(2), (4) x', px = (", "(12)     p_S, 1/px^2 = ",
                           "(13)     p_M, 1/px^2 = ", "(15)     phi, 1/px^2 = ", "L' = ",
                           "(34)     L_C = ", "(20)     rebel_edge\n", "frame  miss static"}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " in\n" << result.out;
  }
  std::smatch m, last;
  ASSERT_TRUE(std::regex_search(result.out, m, std::regex(R"(\(18\) +m = (-?[\d.]+))")));
  EXPECT_NEAR(std::stod(m[1]), seen.log_odds[i], 0.006);
  // The last line is that of the frame.
  const std::regex row(R"((\d+) +[-\d.e+]+ +[-\d.e+]+ +-?[\d.]+ +(-?[\d.]+)  rebel[^\n]*\n$)");
  ASSERT_TRUE(std::regex_search(result.out, last, row)) << result.out;
  EXPECT_EQ(last[1], std::to_string(kFrame));
  EXPECT_NEAR(std::stod(last[2]), seen.log_odds[i], 0.011);

  std::smatch track;
  ASSERT_TRUE(std::regex_search(result.out, track, std::regex(R"(track +(\d+),)")));
  EXPECT_EQ(lcs({"explain", "run", std::to_string(kFrame), "--track", track[1]}).out, result.out);
}

TEST_F(ExplainCommand, ExplainsEveryCornerOfAFrame) {
  const recording::FrameRecord seen = frame();
  for (std::size_t i = 0; i < seen.corners_px.size(); i += seen.corners_px.size() / 6) {
    const Eigen::Vector2f& x = seen.corners_px[i];
    const CommandResult result = lcs({"explain", "run", std::to_string(kFrame),
                                      fmt::format("{}", x.x()), fmt::format("{}", x.y())});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find(fmt::format("({:.2f}, {:.2f})", x.x(), x.y())), std::string::npos);
  }
}

TEST_F(ExplainCommand, GivesTheNumbersOfAllCornersAsJson) {
  const recording::FrameRecord seen = frame();
  const CommandResult result = lcs({"explain", "run", std::to_string(kFrame), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::istringstream lines(result.out);
  std::size_t i = 0, tracked = 0;
  for (std::string line; std::getline(lines, line); ++i) {
    const auto corner = nlohmann::json::parse(line);
    ASSERT_LT(i, seen.corners_px.size());
    EXPECT_EQ(corner.at("corner"), i);
    EXPECT_EQ(corner.at("place_px").at(0), seen.corners_px[i].x());
    EXPECT_EQ(corner.at("verdict") == "rebel", seen.verdicts[i] == Verdict::rebel);
    if (!corner.contains("track")) continue;
    ++tracked;
    const auto& numbers = corner.at("numbers");
    EXPECT_NEAR(numbers.at("m"), seen.log_odds[i], 0.0051) << "stored in steps of .01";
    EXPECT_EQ(corner.at("history").back().at("frame"), kFrame);
    if (!numbers.contains("sum of k")) continue;
    double k = 0;
    for (const auto& voice : corner.at("neighbours")) k += voice.at("k").get<double>();
    EXPECT_NEAR(numbers.at("sum of k"), k, 1e-4);
  }
  EXPECT_EQ(i, seen.corners_px.size());
  EXPECT_GT(tracked, i / 2);
  const CommandResult one =
      lcs({"explain", "run", std::to_string(kFrame), "--track", track(), "--json"});
  EXPECT_NE(result.out.find(one.out), std::string::npos) << one.out << one.err;
}

TEST_F(ExplainCommand, GivesTheNumbersOfAllFramesAsJson) {
  const auto lines_of = [](const CommandResult& result, int frame) {
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::vector<nlohmann::json> found;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) {
      found.push_back(nlohmann::json::parse(line));
      found.back().erase("history");
      if (found.back().at("frame") != frame) found.pop_back();
    }
    return found;
  };
  const CommandResult all = lcs({"explain", "run", "--json"});
  EXPECT_EQ(all.out.find("history"), std::string::npos);
  for (const int frame : {0, kFrame, 7}) {
    const auto of_one = lcs({"explain", "run", std::to_string(frame), "--json"});
    EXPECT_EQ(lines_of(all, frame), lines_of(of_one, frame));
    EXPECT_FALSE(lines_of(all, frame).empty());
  }
  EXPECT_TRUE(lines_of(all, 8).empty()) << "the run has 8 frames";
}

/// The page of a run has the text of the command for the corners that its pictures mark.
TEST_F(ExplainCommand, TheReportHasTheExplanationsOfTheCornersOnItsPictures) {
  const std::string page = read(home() / "run" / "report.html");
  const std::string head = R"(<script type="application/json" id="data">)";
  const std::size_t begin = page.find(head) + head.size();
  const auto data =
      nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  ASSERT_FALSE(data.at("explained").empty());
  int told = 0, drawn = 0;
  for (const auto& [frame, corners] : data.at("explained").items()) {
    ASSERT_FALSE(corners.empty()) << "frame " << frame;
    for (std::size_t i = 0; i < corners.size(); i += 1 + corners.size() / 3) {
      const auto& corner = corners[i];
      const CommandResult result =
          lcs({"explain", "run", frame, corner.at("x").dump(), corner.at("y").dump()});
      const std::string text = corner.at("text");
      EXPECT_TRUE(result.out.starts_with(text)) << text << "\nbut\n" << result.out;
      ++told;
      if (!corner.contains("history")) continue;
      EXPECT_EQ(std::ranges::count(result.out, '\n') - std::ranges::count(text, '\n'),
                std::ssize(corner.at("history")) + 1);
      ++drawn;
      const auto& last = corner.at("history").back();
      ASSERT_EQ(last.size(), 6);
      EXPECT_EQ(last[0], std::stoi(frame));
      EXPECT_TRUE(result.out.ends_with("  " + last[5].get<std::string>() + "\n")) << last;
      for (const auto& neighbour : corner.value("neighbours", nlohmann::json::array())) {
        ASSERT_EQ(neighbour.size(), 4);
        EXPECT_LE(std::abs(neighbour[3].get<double>()), 1) << "tanh(m/2)";
      }
    }
  }
  EXPECT_GT(told, 3);
  EXPECT_GT(drawn, 3);
}

/// A corner whose point went elsewhere has a wrong match by truth, and a told motion that is wrong
/// by a pixel is named, too.
TEST_F(ExplainCommand, NamesWrongMatchesAndToldMotionsByTruth) {
  ASSERT_EQ(lcs({"run", fs::path(LCS_SCENARIOS_DIR) / "crossing.yaml", "--set", "frames=5", "--set",
                 "imu.gyroscope_turn_on_bias=0.1 rad/s", "--no-video", "--quiet", "--out", "told"})
                .exit_code,
            0);
  const auto kinds = [](const CommandResult& result) {
    std::map<std::string, int> counts;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) {
      const std::string kind = nlohmann::json::parse(line).at("kind");
      ++counts[kind.substr(0, kind.find(':'))];
    }
    return counts;
  };
  const auto right = kinds(lcs({"explain", "run", "4", "--json"}));
  const auto told = kinds(lcs({"explain", "told", "4", "--json"}));
  EXPECT_FALSE(right.contains("told motion"));
  EXPECT_TRUE(told.contains("told motion"));
  EXPECT_GT(right.at("tracked"), 100);
}

TEST_F(ExplainCommand, DrawsAPictureAndSaysIfTheRunKeptNone) {
  const Arguments asked{"explain", "run", std::to_string(kFrame), "--track", track(), "--picture"};
  Arguments one = asked;
  one.emplace_back("seen.png");
  const CommandResult seen = lcs(one);
  ASSERT_EQ(seen.exit_code, 0) << seen.err;
  EXPECT_EQ(seen.err, "");
  copy("blind");
  Arguments other = asked;
  other[1] = "blind";
  other.emplace_back("blind.png");
  const CommandResult blind = lcs(other);
  ASSERT_EQ(blind.exit_code, 0) << blind.err;
  EXPECT_NE(blind.err.find("blind has no pictures"), std::string::npos) << blind.err;
  EXPECT_EQ(blind.out, seen.out);
  const std::string a = read(home() / "seen.png"), b = read(home() / "blind.png");
  EXPECT_TRUE(a.starts_with("\x89PNG"));
  EXPECT_TRUE(b.starts_with("\x89PNG"));
  EXPECT_GT(a.size(), b.size()) << "the picture of the frame is in it";
}

TEST_F(ExplainCommand, RefusesWhatItCannotExplain) {
  expect_refused({"run", "8", "100", "100"}, "run has no frame 8; give one below 8");
  expect_refused({"run", "-1", "100", "100"}, "");
  expect_refused({"run", "5"}, "give the corner by X and Y, or by --track");
  expect_refused({"run"}, "give the corner by X and Y, or by --track");
  expect_refused({"run", "--track", "1"}, "give FRAME, in which --track names the corner");
  expect_refused({"run", "5", "--track", "1000000"}, "no corner of the frame is on track 1000000");
  const Eigen::Vector2f first = frame().corners_px.front();
  expect_refused({"run", "5", fmt::format("{}", first.x()), "5000"}, " px away");
  fs::create_directory(home() / "empty");
  expect_refused({"empty", "5", "100", "100"}, "empty has no frames; name a run");
  expect_refused({"nowhere", "5", "100", "100"}, "nowhere has no frames; name a run");
}

TEST_F(ExplainCommand, RefusesRunsOfOtherDetectorsAndOtherFilters) {
  const fs::path crossing = fs::path(LCS_SCENARIOS_DIR) / "crossing.yaml";
  for (const std::string detector : {"klt", "lcs:lab"}) {
    ASSERT_EQ(lcs({"run", crossing, "--set", "frames=4", "--no-video", "--quiet", "--detector",
                   detector, "--out", "other"})
                  .exit_code,
              0);
    expect_refused({"other", "3", "--track", "1"}, "with --detector lcs:default");
  }
  // A filter with other parameters than those that its run states.
  const fs::path changed = copy("changed");
  std::string how = read(changed / "run.json");
  const std::string was = R"("hypotheses.prior": "0.05")";
  ASSERT_NE(how.find(was), std::string::npos) << how;
  how.replace(how.find(was), was.size(), R"("hypotheses.prior": "0.2")");
  write(changed / "run.json", how);
  expect_refused({"changed", "5", "--track", "1"}, "make it again");
}

TEST_F(ExplainCommand, RefusesARunWhoseVerdictsWereEdited) {
  const fs::path edited = copy("edited");
  std::string layers = read(edited / "layers.jsonl");
  std::size_t line = 0;
  for (int k = 0; k < kFrame; ++k) line = layers.find('\n', line) + 1;
  const std::size_t verdict = layers.find("\"normal\"", line);
  ASSERT_LT(verdict, layers.find('\n', line));
  layers.replace(verdict, 8, "\"rebel\"");
  write(edited / "layers.jsonl", layers);
  expect_refused({"edited", "5", "--track", "1"}, "the verdicts in frame 5 are not this filter's");
  const CommandResult before = lcs({"explain", "edited", "4", "--track", track()});
  EXPECT_EQ(before.exit_code, 0) << before.err;
}

}  // namespace
}  // namespace lcs::test
