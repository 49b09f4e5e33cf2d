#include "tools/app/version.h"

#include <fmt/format.h>

#include <filesystem>
#include <opencv2/core/utility.hpp>
#include <regex>
#include <stdexcept>
#include <string_view>

#include "scenarios/input/sha256.h"
#include "scenarios/shipped.h"
#include "sim/simulation.h"
#include "tools/app/commit.h"

namespace lcs::app {

std::string version_text() {
  const sim::Versions versions = sim::versions();
  return fmt::format("lcs {}\nMuJoCo {}\n{}\nOpenCV {}", program_text(), versions.mujoco,
                     versions.gl_renderer, cv::getVersionString());
}

std::string version_line() {
  return std::regex_replace(version_text(), std::regex("\n"), ", ");
}

std::string program_sha256() {
  const auto digest = input::sha256_of_file(std::filesystem::canonical(scenario::program()));
  if (!digest) throw std::runtime_error("the program cannot be read; install it again");
  return *digest;
}

bool is_of_a_commit() {
  const std::string_view commit = LCS_COMMIT;
  return commit != "unknown" && commit.find(',') == commit.npos;
}

std::string program_text() {
  return fmt::format("{} ({})", LCS_VERSION, LCS_COMMIT);
}

}  // namespace lcs::app
