#include "tools/app/how_made.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <opencv2/core/utility.hpp>

#include "tools/app/version.h"
#include "tools/files/json_node.h"
#include "tools/files/output_file.h"

namespace lcs::app {
namespace {

/// The start of the request: of the process, unless `note_start` was called.
struct Start {
  std::time_t date = std::time(nullptr);
  std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();
  std::clock_t cpu = std::clock();
};
Start request_start;

}  // namespace

void note_start() {
  request_start = {};
}

void note_longer(const std::filesystem::path& folder, bool is_named, const char* what,
                 std::size_t count, Caller& caller) {
  std::size_t before = 0;
  try {
    // Not as an input of this command, which may replace it.
    const auto json =
        files::parse_json<files::Json>(files::beginning(folder / files::kHowMadeFile, 1 << 24));
    before = files::JsonNode(json, "")[what].natural();
  } catch (const std::exception&) {  // of another kind, or made before there was this file
    return;
  }
  if (before <= count) return;
  const std::string text = fmt::format("{} holds a result of {} {}, and this one has {}",
                                       folder.string(), before, what, count);
  if (is_named) return caller.warn({text + ", which will replace it"});
  throw files::OutputError(text + "; name a place by --out, or remove that folder");
}

void add_program(files::Json& facts, const sim::Versions& versions) {
  facts["program"] = program_text();
  if (!versions.mujoco.empty()) facts["mujoco"] = versions.mujoco;
  if (!versions.gl_renderer.empty()) facts["renderer"] = versions.gl_renderer;
  facts["opencv"] = cv::getVersionString();
}

void add_changed_program(files::Json& facts) {
  if (!is_of_a_commit()) facts["program_sha256"] = program_sha256();
}

void write_how_made(const std::filesystem::path& folder, const std::string& command,
                    const files::Provenance& provenance) {
  files::Json json{{"command", command}};
  json["started"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(request_start.date));
  json["wall_s"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - request_start.wall).count();
  json["cpu_s"] = static_cast<double>(std::clock() - request_start.cpu) / CLOCKS_PER_SEC;
  json.update(provenance.json());
  files::write_file(folder / files::kHowMadeFile, files::json_text(json, 1) + '\n');
}

}  // namespace lcs::app
