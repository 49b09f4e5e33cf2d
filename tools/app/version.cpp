#include "tools/app/version.h"

#include <fmt/format.h>

#include <opencv2/core/utility.hpp>

#include "scenarios/shipped.h"
#include "sim/simulation.h"
#include "tools/app/commit.h"
#include "tools/files/sha256.h"
#include "tools/input/input_file.h"

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
  constexpr input::FileKind kProgram{input::kGibibyte, "install the program again"};
  return bench::sha256(input::read_file(scenario::program(), kProgram));
}

std::string program_text() {
  return fmt::format("{} ({})", LCS_VERSION, LCS_COMMIT);
}

}  // namespace lcs::app
