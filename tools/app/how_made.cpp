#include "tools/app/how_made.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <opencv2/core/utility.hpp>
#include <regex>
#include <stdexcept>
#include <string_view>

#include "scenarios/input/sha256.h"
#include "scenarios/shipped.h"
#include "tools/app/commit.h"
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

/// Whether the commit alone says what this program does: it is known, and no file was changed
/// since.
bool is_of_a_commit() {
  const std::string_view commit = LCS_COMMIT;
  return commit != "unknown" && commit.find(',') == commit.npos;
}

}  // namespace

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

std::string program_text() {
  return fmt::format("{} ({})", LCS_VERSION, LCS_COMMIT);
}

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
