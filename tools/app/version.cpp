#include "tools/app/version.h"

#include <fmt/format.h>

#include <filesystem>
#include <opencv2/core/utility.hpp>
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
  std::string text = version_text();
  for (std::size_t i = text.find('\n'); i != std::string::npos; i = text.find('\n')) {
    text.replace(i, 1, ", ");
  }
  return text;
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
