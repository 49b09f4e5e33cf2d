#include "tools/files/json_node.h"

#include <gtest/gtest.h>

#include "tests/tools/files.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::files {
namespace {

using Json = nlohmann::json;

std::string lists(std::size_t depth, const std::string& inside = "") {
  return std::string(depth, '[') + inside + std::string(depth, ']');
}

std::string refusal(const std::string& text) {
  return test::refusal_of<JsonError>([&] { parse_json<Json>(text); });
}

TEST(JsonText, ReplacesWhatIsNoUtf8) {
  EXPECT_EQ(json_text(Json{{"name", "a\xff"}}), "{\"name\":\"a\xef\xbf\xbd\"}");
  EXPECT_EQ(json_text(Json{1}, 1), "[\n 1\n]");
}

TEST(ParseJson, TakesWhatIsAsDeepAsTheLimit) {
  EXPECT_EQ(parse_json<Json>(lists(kDeepestJson)).dump(), lists(kDeepestJson));
}

TEST(ParseJson, RefusesWhatIsDeeperWhereverItIs) {
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += "{\"a\":";
  for (const std::string& deep :
       {lists(kDeepestJson + 1), lists(100'000), std::string(100'000, '['),
        "{\"a\":1,\n\"b\":" + lists(100'000) + "}", objects, "[{}," + lists(kDeepestJson) + "]",
        "[\"\\\\\"," + lists(kDeepestJson) + "]", "[\"]]]]\"," + lists(kDeepestJson) + "]"}) {
    EXPECT_TRUE(refusal(deep).starts_with("lists and objects are nested more than 64 deep"))
        << deep.substr(0, 100) << ": " << refusal(deep);
  }
}

TEST(ParseJson, BracketsInTextsNestNothing) {
  const std::string text = "[\"" + std::string(1000, '[') + "\\\"" + std::string(1000, '{') + "\"]";
  EXPECT_EQ(parse_json<Json>(text).dump(), text);
  std::string beside = "[";
  for (int i = 0; i < 1000; ++i) beside += "[],{},";
  EXPECT_EQ(parse_json<Json>(beside + "0]").size(), 2001u);
}

TEST(ParseJson, ToldOfAFileNamesItsLine) {
  const test::TemporaryFolder folder;
  test::write(folder.path() / "a.json", "{\"a\": 1,\n\n \"b\": " + lists(100'000) + "}");
  const std::string told = test::refusal_of<input::Error>([&] {
    read_json(folder.path() / "a.json", {input::kMebibyte, "give another"},
              [](const JsonNode&) { return 0; });
  });
  EXPECT_NE(told.find("a.json:3: lists and objects are nested"), std::string::npos) << told;
  EXPECT_TRUE(told.ends_with("; give another")) << told;
}

}  // namespace
}  // namespace lcs::files
