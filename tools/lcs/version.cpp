#include "tools/lcs/version.h"

#include <fmt/format.h>

#include <opencv2/core/utility.hpp>

#include "sim/simulation.h"
#include "tools/lcs/commit.h"

namespace lcs::tools {

std::string version_text() {
  const sim::Versions versions = sim::versions();
  return fmt::format("lcs {}\nMuJoCo {}\n{}\nOpenCV {}", LCS_VERSION, versions.mujoco,
                     versions.gl_renderer, cv::getVersionString());
}

std::string program_text() {
  return fmt::format("{} ({})", LCS_VERSION, LCS_COMMIT);
}

}  // namespace lcs::tools
