#include "tools/files/provenance.h"

#include <gtest/gtest.h>

#include "scenarios/input/error.h"
#include "scenarios/input/inputs_read.h"
#include "scenarios/input/sha256.h"
#include "tests/tools/files.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/files/output.h"

namespace lcs::files {
namespace {

namespace fs = std::filesystem;

class ProvenanceTest : public testing::Test {
 protected:
  ProvenanceTest() { input::forget_inputs(); }
  ~ProvenanceTest() override { input::forget_inputs(); }

  test::TemporaryFolder temporary_;
  fs::path top_ = fs::canonical(temporary_.path());
};

TEST_F(ProvenanceTest, FilesReadAreThoseOfTheProcessWithoutItsOutputs) {
  test::write(top_ / "scene.xml", "<mujoco/>");
  input::note_input(top_ / "scene.xml");
  Output output(top_ / "out", {"metrics.json"});
  test::write(output.staging() / "metrics.json", "{}");
  input::note_input(output.staging() / "metrics.json");  // as when it is read back
  const Provenance provenance = provenance_of({{"seed", 1}});
  ASSERT_EQ(provenance.read.size(), 1U);
  EXPECT_EQ(provenance.read.begin()->first, (top_ / "scene.xml").string());
  EXPECT_EQ(provenance.read.begin()->second, input::sha256("<mujoco/>"));
  const Provenance moved = provenance_of({}, top_ / "scenarios");
  EXPECT_EQ(moved.read.begin()->first, "../scene.xml");
}

TEST_F(ProvenanceTest, IsTheSameOnceItWasWritten) {
  Provenance provenance{.facts = {{"seed", 7}, {"settings", {"a=1"}}}, .read = {{"x.yaml", "ab"}}};
  provenance.facts["read_only"] = false;
  Json file{{"command", "lcs run"}, {"started", "now"}, {"wall_s", 1}, {"cpu_s", 2}};
  file.update(provenance.json());
  const Provenance again = Provenance::from(file);
  EXPECT_EQ(again.facts, provenance.facts);
  EXPECT_EQ(again.read, provenance.read);
}

TEST_F(ProvenanceTest, FirstDifferenceIsNamedWithBothValues) {
  const Provenance a{.facts = {{"seed", 1}, {"keep", "all"}}, .read = {{"x", "1"}, {"y", "2"}}};
  const auto with = [&](auto change) {
    Provenance b = a;
    change(b);
    return difference(a, b);
  };
  EXPECT_EQ(with([](auto&) {}), "");
  EXPECT_EQ(with([](auto& b) { b.facts["keep"] = "figures"; }),
            "keep differs ('all' and 'figures')");
  EXPECT_EQ(with([](auto& b) { b.facts.erase("seed"); }), "seed differs ('1' and not stated)");
  EXPECT_EQ(with([](auto& b) {
              b.facts["more"] = {1, 2};
            }),
            "more differs (not stated and '[1,2]')");
  EXPECT_EQ(with([](auto& b) { b.read["y"] = "3"; }), "y differs");
  EXPECT_EQ(with([](auto& b) { b.read.erase("y"), b.read["z"] = "4"; }), "")
      << "a unit of the work reads only some of the files";
  const Provenance other{.facts = {{"seed", 2}, {"keep", "all"}}, .read = {}};
  constexpr std::string_view kSeed[] = {"seed"};
  EXPECT_EQ(difference(a, other, kSeed), "");
}

TEST_F(ProvenanceTest, FileThatIsNotAsItWasReadIsNamed) {
  test::write(top_ / "scene.xml", "one");
  const Provenance provenance{.facts = {}, .read = {{"scene.xml", input::sha256("one")}}};
  EXPECT_EQ(changed_since(provenance, top_), "");
  test::write(top_ / "scene.xml", "two");
  EXPECT_EQ(changed_since(provenance, top_), "scene.xml was changed since");
  fs::remove(top_ / "scene.xml");
  EXPECT_EQ(changed_since(provenance, top_), "scene.xml is missing");
}

TEST_F(ProvenanceTest, UnitsThatHaveReadDifferentStatesDoNotJoin) {
  Provenance whole;
  whole.add_read({.facts = {}, .read = {{"x", "1"}}}, "a seed 1");
  whole.add_read({.facts = {}, .read = {{"x", "1"}, {"y", "2"}}}, "a seed 2");
  EXPECT_EQ(whole.read, (std::map<std::string, std::string>{{"x", "1"}, {"y", "2"}}));
  const std::string message = test::refusal_of<std::runtime_error>([&] {
    whole.add_read({.facts = {}, .read = {{"y", "3"}}}, "b seed 1");
  });
  EXPECT_TRUE(message.starts_with("b seed 1 has read y in another state")) << message;
}

TEST_F(ProvenanceTest, ResultWithoutOneIsRefused) {
  test::write(top_ / "run.json", R"({"command": "lcs run", "seed": 1})");
  EXPECT_EQ(test::refusal_of<input::Error>([&] { read_how_made(top_); }),
            (top_ / "run.json").string() + ": read is missing; make the result again");
}

}  // namespace
}  // namespace lcs::files
