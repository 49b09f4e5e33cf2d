#include "tools/lcs/suite_worlds.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "tools/lcs/interrupt.h"
#include "tools/suite/child_process.h"
#include "tools/worlds/worlds.h"

namespace lcs::tools {
namespace {

constexpr const char* kFolder = "out/worlds";

}  // namespace

std::vector<std::string> make_worlds(const WorldsOptions& options, std::size_t jobs) {
  std::vector<worlds::Choice> choices =
      worlds::choose(options.split, options.count, options.family);
  std::stable_sort(choices.begin(), choices.end(),
                   [](const auto& a, const auto& b) { return a.family < b.family; });
  std::vector<std::string> files;
  std::vector<std::vector<std::string>> commands;
  for (const worlds::Choice& choice : choices) {
    const std::filesystem::path file = worlds::kept_world(kFolder, choice);
    files.push_back(file.string());
    if (std::filesystem::exists(file)) continue;
    std::filesystem::create_directories(file.parent_path().parent_path());
    commands.push_back({"world", choice.family, "--seed", std::to_string(choice.seed), "--out",
                        file.parent_path().string(), "--quiet"});
  }
  suite::run_all(
      commands, jobs,
      [](std::size_t, const suite::Exit& exit) {
        if (exit.code != 0 || exit.signal != 0) {
          throw std::runtime_error(suite::complaint_of(exit));
        }
      },
      [&](const std::vector<std::size_t>&) { check_interrupted(); });
  return files;
}

}  // namespace lcs::tools
