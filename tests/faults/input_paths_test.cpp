// Every file is opened by scenarios/input/input_file.h, every picture decoded by
// sim/pictures/picture_file.h, every video opened by tools/output/video.h and all JSON
// parsed by tools/files/json_node.h or the reader of recordings, so that their limits apply to all
// input. No other code opens a file.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tests/tools/files.h"

namespace {

namespace fs = std::filesystem;

const fs::path kSources = fs::path(LCS_TESTS_DIR).parent_path();

/// Calls that read a file or decode bytes, and the files that may use them.
const std::map<std::string, std::set<std::string>> kWays{
    {R"(ifstream|std::fstream|basic_filebuf|std::filebuf|freopen|fopen\([^;]*"r|FileStorage)",
     {"sim/base/trial.cpp"}},  // /proc/self/statm
    {R"(::open(at)?\()",
     {"scenarios/input/input_file.cpp",
      "sim/base/trial.cpp",          // /dev/null
      "tools/lcs/terminal.cpp",       // /dev/null
      "tools/process/child.cpp",      // /dev/null
      "tools/files/output_file.cpp",  // the file to be replaced or copied
      "scenarios/input/sha256.cpp",   // of regular files alone
      "tools/files/output.cpp",       // a folder, a pipe to write to
      "tools/files/journal.cpp"}},    // to append
    {R"(imread|imdecode)",
     {"sim/pictures/media.h", "sim/pictures/media_module.cpp",  // what the others call
      "sim/pictures/picture_file.cpp", "sim/pictures/picture_file.h"}},
    {R"(tjDecompress)", {"sim/pictures/picture_file.cpp"}},
    {R"(VideoCapture[\s(>&]*[a-z]*\()", {"sim/pictures/media.h", "sim/pictures/media_module.cpp"}},
    {R"(media\(\)\.read_video)", {"tools/output/video.cpp"}},
    {R"(avformat_open|media\(\)\.video_times)",
     {"sim/pictures/media_module.cpp", "tools/replay/pictures_reader.cpp"}},
    {R"(\.open\()", {}},
    {R"(LoadFile|mj_loadModel|mj_loadXML|mj_parse\b|mj_parseXML\b)", {}},
    {R"(mj_parseXMLString)", {"sim/scene/spec.cpp"}},  // text in memory
    {R"([Jj]son::(parse|accept|sax_parse))", {"tools/files/json_node.h"}},
    {R"(simdjson::(dom|ondemand)::parser)", {"tools/recording/recording_reader.cpp"}},
};

/// Code without comments, because comments may name forbidden calls.
std::string code_of(const fs::path& file) {
  std::istringstream lines(lcs::test::read(file));
  std::string code;
  for (std::string line; std::getline(lines, line);) {
    code += line.substr(0, line.find("//")) + '\n';
  }
  return code;
}

TEST(InputPaths, AreOneForEachKindOfFile) {
  int files = 0;
  for (const char* folder : {"filter", "scenarios", "sim", "tools"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kSources / folder)) {
      const std::string kind = entry.path().extension();
      if (kind != ".cpp" && kind != ".h") continue;
      ++files;
      const std::string name = entry.path().lexically_relative(kSources);
      const std::string code = code_of(entry.path());
      for (const auto& [way, allowed] : kWays) {
        if (allowed.contains(name)) continue;
        std::smatch found;
        EXPECT_FALSE(std::regex_search(code, found, std::regex(way)))
            << name << " has '" << found.str() << "', which the files above are for";
      }
    }
  }
  EXPECT_GT(files, 300);
}

}  // namespace
