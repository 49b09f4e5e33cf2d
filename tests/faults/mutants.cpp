// Usage: mutants KIND SECONDS [SEED]
//
// Mutates valid inputs of the program at random for SECONDS, and runs the program on each. Exits
// with 1 if a run crashed, hung, took too much memory, refused without one line of explanation, or
// left files behind. Each finding is kept in found/KIND-SEED-NUMBER in the start folder: the
// inputs, and the command in `command.txt`.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "tests/tools/command.h"
#include "tests/tools/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using namespace lcs::test;
using namespace std::chrono_literals;
using Arguments = std::vector<std::string>;
using Random = std::mt19937_64;
using Clock = std::chrono::steady_clock;

constexpr auto kLongest = 60s;
constexpr std::size_t kMostPeak = std::size_t{2} << 30;
/// Includes the address space of all libraries and threads; protects the machine.
constexpr std::size_t kMostMemory = std::size_t{12} << 30;

std::size_t below(Random& random, std::size_t end) {
  return end == 0 ? 0 : random() % end;
}

std::string read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// ---- Mutations

bool is_of_number(char c) {
  return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e';
}
bool is_of_word(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

/// The range of letters for which `is` holds, at or after a place; empty at the end.
template <class Is>
std::pair<std::size_t, std::size_t> stretch(const std::string& text, std::size_t at, Is is) {
  while (at < text.size() && !is(text[at])) ++at;
  std::size_t begin = at, end = at;
  while (begin > 0 && is(text[begin - 1])) --begin;
  while (end < text.size() && is(text[end])) ++end;
  return {begin, end - begin};
}

std::pair<std::size_t, std::size_t> line_at(const std::string& text, std::size_t at) {
  const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  const std::size_t end = text.find('\n', at);
  return {begin, (end == std::string::npos ? text.size() : end + 1) - begin};
}

std::string tempting(Random& random) {
  static const std::vector<std::string> kTexts{"0",
                                               "-0",
                                               "1",
                                               "-1",
                                               "0.5",
                                               "1e9",
                                               "-1e9",
                                               "1e30",
                                               "1e308",
                                               "1e-308",
                                               "5e-324",
                                               "1e999",
                                               "nan",
                                               "inf",
                                               "-inf",
                                               "null",
                                               "true",
                                               "\"\"",
                                               "[]",
                                               "{}",
                                               "2147483647",
                                               "2147483648",
                                               "-2147483649",
                                               "4294967296",
                                               "9007199254740993",
                                               "18446744073709551615",
                                               "18446744073709551616",
                                               "999999999999999999999999",
                                               "0x10",
                                               "010",
                                               "1,5",
                                               "~",
                                               "''",
                                               "'",
                                               "\"",
                                               "\\",
                                               "\\u0000",
                                               "../..",
                                               "/dev/null",
                                               "/dev/zero",
                                               ".",
                                               "",
                                               " ",
                                               "\t",
                                               "\n",
                                               "\r\n",
                                               "\xff",
                                               "\xef\xbb\xbf",
                                               "\x1b[31m",
                                               "%s%n",
                                               "&amp;",
                                               "<",
                                               "-->",
                                               "[[[[[[",
                                               "*a",
                                               "&a [*a]",
                                               std::string(1, '\0'),
                                               std::string(5000, '9'),
                                               std::string(3000, '['),
                                               std::string(3000, '{'),
                                               std::string(100000, 'x')};
  return kTexts[below(random, kTexts.size())];
}

void mutate(std::string& text, Random& random) {
  const std::size_t at = below(random, text.size());
  const auto [line, line_size] = line_at(text, at);
  const auto [number, number_size] = stretch(text, at, is_of_number);
  const auto [word, word_size] = stretch(text, at, is_of_word);
  switch (below(random, 15)) {
    case 0:  // another number
    case 1:
    case 2:
      text.replace(number, number_size, tempting(random));
      break;
    case 3:  // another word
      text.replace(word, word_size, tempting(random));
      break;
    case 4: {  // a word of the same text
      const auto [other, size] = stretch(text, below(random, text.size()), is_of_word);
      const std::string copy = text.substr(std::min(other, text.size()), size);
      text.replace(word, word_size, copy);
      break;
    }
    case 5:
      text.insert(at, tempting(random));
      break;
    case 6:
      text.erase(line, line_size);
      break;
    case 7:
      text.insert(line, text.substr(line, line_size));
      break;
    case 8: {  // a line elsewhere
      const std::string copy = text.substr(line, line_size);
      text.insert(line_at(text, below(random, text.size())).first, copy);
      break;
    }
    case 9:  // cut off
      text.resize(at);
      break;
    case 10:
      text.erase(at, 1 + below(random, 40));
      break;
    case 11:  // a number changed slightly
      if (number_size > 0) text[number] = static_cast<char>('0' + below(random, 10));
      break;
    case 12:  // a bit
      if (!text.empty()) text[at] = static_cast<char>(text[at] ^ (1 << below(random, 8)));
      break;
    case 13:  // many copies
      for (int i = 0; i < 8 && text.size() < 4'000'000; ++i) {
        text.insert(line, text.substr(line, line_size));
      }
      break;
    default:  // random bytes
      for (std::size_t i = below(random, 20) + 1; i > 0; --i) {
        text.insert(below(random, text.size() + 1), 1, static_cast<char>(random()));
      }
  }
}

/// Replaces a file by something else.
void replace(const fs::path& file, const std::vector<fs::path>& others, Random& random) {
  const fs::path other = others[below(random, others.size())];
  const std::string bytes = read_bytes(other);
  fs::remove(file);
  switch (below(random, 7)) {
    case 0:
      break;  // nothing
    case 1:
      fs::create_directory(file);
      break;
    case 2:
      fs::create_symlink(file.filename(), file);  // a loop
      break;
    case 3:
      ::mkfifo(file.c_str(), 0600);
      break;
    case 4:
      write_bytes(file, "");
      break;
    case 5:
      fs::create_symlink("/dev/zero", file);
      break;
    default:
      write_bytes(file, bytes);
  }
}

// ---- Inputs

struct Input {
  /// Files of a folder that are mutated, and whole folders of them.
  std::vector<fs::path> changed;
  /// Ways to run the program in the folder.
  std::vector<Arguments> commands;
};

const Arguments kSmall{"--set", "frames=3", "--set", "camera.size=[160,120]"};

Arguments joined(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

void make(const fs::path& folder, const Arguments& arguments) {
  const CommandResult made = run_lcs(arguments, {.folder = folder});
  if (made.exit_code <= 1) return;
  throw std::runtime_error(fmt::format("{}: {}", fmt::join(arguments, " "), made.err));
}

const fs::path kScenarios = LCS_SCENARIOS_DIR;
const Arguments kCrossing = joined({"run", (kScenarios / "crossing.yaml").string()}, kSmall);

Input scenario(const fs::path& folder) {
  Input input;
  for (const char* name : {"crossing.yaml", "lab.yaml", "suite/behind_poles.yaml",
                           "suite/crossing_street.yaml", "suite/approaching_head_on.yaml"}) {
    const fs::path file = fs::path(name).filename();
    fs::copy(kScenarios / name, folder / file);
    input.changed.push_back(file);
    input.commands.push_back(
        joined({"run", file.string(), "--no-video", "--quiet", "--out", "out"}, kSmall));
  }
  return input;
}

Input scene(const fs::path& folder) {
  fs::copy(kScenarios.parent_path() / "scenes" / "lab.xml", folder / "scene.xml");
  fs::copy(kScenarios.parent_path() / "scenes" / "street.xml", folder / "street.xml");
  Input input{{"scene.xml", "street.xml"}, {}};
  for (const char* file : {"scene.xml", "street.xml"}) {
    const fs::path yaml = fs::path(file).stem().string() + ".yaml";
    write_bytes(folder / yaml, fmt::format("scene: {}\nego: {{start: [-4 m, 0 m], speed: 0.5 "
                                           "m/s}}\n",
                                           file));
    input.commands.push_back(
        joined({"run", yaml.string(), "--no-video", "--quiet", "--out", "out"}, kSmall));
  }
  return input;
}

Input stored_run(const fs::path& folder) {
  make(folder, joined(kCrossing, {"--out", "run", "--quiet", "--events"}));
  return {{"run"},
          {{"score", "run", "--out", "out.json"},
           {"score", "run", "--write-detections", "out.csv"},
           {"explain", "run", "1", "--track", "1", "--picture", "out.png"},
           joined(kCrossing, {"--recorded", "run", "--no-video", "--events", "--out", "out"}),
           joined(kCrossing, {"--recorded", "run", "--report", "--out", "out"})}};
}

Input suite(const fs::path& folder) {
  make(folder, joined({"suite", (kScenarios / "crossing.yaml").string(), "--seeds", "2", "--quiet",
                       "--out", "suite"},
                      kSmall));
  fs::copy(folder / "suite", folder / "other", fs::copy_options::recursive);
  return {{"suite/suite.json"},
          {{"compare", "suite", "other"},
           {"compare", "other", "suite"},
           {"score", "suite"},
           {"tune", "suite", "--keys", "hypotheses.prior", "--evaluations", "1", "--out", "out"},
           joined({"suite", (kScenarios / "crossing.yaml").string(), "--seeds", "2", "--recorded",
                   "suite", "--out", "out"},
                  kSmall)}};
}

Input recording(const fs::path& folder) {
  make(folder, joined({"generate", (kScenarios / "crossing.yaml").string(), "--formats", "euroc",
                       "--out", "sequence", "--quiet"},
                      kSmall));
  fs::copy(folder / "sequence", folder / "euroc", fs::copy_options::recursive);
  fs::remove(folder / "euroc" / "lcs.json");
  return {{"sequence", "euroc"},
          {{"replay", "sequence", "--no-video", "--out", "out"},
           {"replay", "euroc", "--no-video", "--out", "out"},
           {"replay", "sequence/mav0/cam0/data", "--fps", "10", "--focal", "100", "--speed", "0.5",
            "--no-video", "--out", "out"}}};
}

constexpr const char* kDetections =
    "frame,type\n0,rebel,3\n0,rebel,80.5,60\n1,pending,7\n1,box,1,20,30,40,20\n"
    "1,mask,2,120,160,0,240,18960\n2,square,3,80,60,10,12.5,70,50,90,50,80,70\n2,circle,80,60,9\n"
    "2,circle\n2,normal,1\n2,ignored,5\n2,box,7,-5,-5,20.25,20\n";

Input detections(const fs::path& folder) {
  make(folder, joined(kCrossing, {"--out", "run", "--quiet"}));
  write_bytes(folder / "mine.csv", kDetections);
  return {{"mine.csv"},
          {{"score", "run", "--detections", "mine.csv", "--out", "out.json"},
           {"score", "run", "--detections", "mine.csv", "--write-detections", "out.csv"},
           joined(kCrossing, {"--recorded", "run", "--detections", "mine.csv", "--detector", "mine",
                              "--no-video", "--out", "out"})}};
}

/// Asks a detector process; `answer` reads its answers from a file.
Input answers(const fs::path& folder) {
  make(folder, joined(kCrossing, {"--out", "run", "--quiet", "--events"}));
  write_bytes(
      folder / "answers.jsonl",
      "{\"protocol\":1,\"circles\":true}\n"
      "{\"index\":0,\"rebel\":[0,5,[80,60]],\"box\":[[1,20,30,40,20]],\"circle\":[]}\n"
      "{\"index\":1,\"pending\":[7],\"mask\":[[1,{\"size\":[120,160],\"counts\":[0,240,18960]}],"
      "[2,{\"size\":[120,160],\"counts\":\"0`7``b0\"}]],\"circle\":[[80,60,9]]}\n"
      "{\"index\":2,\"square\":[[3,80,60,10,12.5,70,50,90,50,80,70]],\"normal\":[1],"
      "\"ignored\":[[10.5,20.25]]}\n");
  const std::string command =
      fmt::format("'{}' answer answers.jsonl", fs::read_symlink("/proc/self/exe").string());
  return {
      {"answers.jsonl"},
      {joined(kCrossing, {"--recorded", "run", "--detector", "mine", "--detector-command", command,
                          "--detector-timeout", "10 s", "--no-video", "--out", "out"})}};
}

Input journal(const fs::path& folder) {
  make(folder, {"suite", (kScenarios / "crossing.yaml").string(), "--seeds", "1", "--set",
                "frames=8", "--set", "camera.size=[160,120]", "--quiet", "--out", "suite"});
  Arguments tune{"tune",    "suite", "--keys", "hypotheses.prior,hypotheses.newcomer",
                 "--quiet", "--out", "tuned",  "--evaluations"};
  make(folder, joined(tune, {"3"}));
  return {{"tuned/evaluations.csv"}, {joined(tune, {"4"}), joined(tune, {"3"})}};
}

/// One partial sequence, from a killed process, and one complete sequence.
Input sequence(const fs::path& folder) {
  const auto generate = [](const char* out) {
    return joined({"generate", (kScenarios / "crossing.yaml").string(), "--formats",
                   "euroc,coco,landmarks", "--quiet", "--out", out},
                  kSmall);
  };
  make(folder, generate("whole"));
  for (auto delay = 400ms; !fs::exists(folder / "begun.unfinished" / "work" / "plan.json");
       delay += 100ms) {
    fs::remove_all(folder / "begun.unfinished");
    Command command(generate("begun"), {.folder = folder});
    std::this_thread::sleep_for(delay);
    command.send(SIGKILL);
    command.wait();
    if (delay > 10s) throw std::runtime_error("no sequence was caught in the middle");
  }
  return {{"begun.unfinished", "whole/manifest.json", "whole/lcs.json"},
          {generate("begun"), generate("whole")}};
}

const std::map<std::string_view, Input (*)(const fs::path&)> kInputs{
    {"scenario", scenario}, {"scene", scene},         {"run", stored_run},
    {"suite", suite},       {"recording", recording}, {"detections", detections},
    {"answers", answers},   {"journal", journal},     {"sequence", sequence}};

/// Acts as a detector: returns the lines of a file unchecked, one per picture.
int answer(const char* file) {
  const rlimit memory{std::size_t{1} << 28, std::size_t{1} << 28};
  ::setrlimit(RLIMIT_AS, &memory);  // where the file is a link to /dev/zero
  std::ifstream answers(file);
  std::string line, header;
  std::getline(std::cin, header);
  const auto bytes = nlohmann::json::parse(header)["picture"]["bytes"].get<std::size_t>();
  while (std::getline(answers, line)) {
    std::cout << line << std::endl;
    if (!std::getline(std::cin, header)) break;
    std::string picture(bytes, ' ');
    std::cin.read(picture.data(), static_cast<std::streamsize>(bytes));
  }
  return 0;
}

// ---- Invariants

/// All paths below a folder, with the bytes of files.
std::map<std::string, std::string> state(const fs::path& folder) {
  std::map<std::string, std::string> paths;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    std::string& bytes = paths[entry.path().lexically_relative(folder).string()];
    if (!entry.is_symlink() && entry.is_regular_file()) bytes = read_bytes(entry.path());
  }
  return paths;
}

/// The fault in the way that a run ended; "" if there is none.
std::string wrong(const CommandResult& result, const std::map<std::string, std::string>& before,
                  const std::map<std::string, std::string>& after) {
  if (result.exit_code < 0 || result.exit_code > 2) {
    return fmt::format("exit code {}", result.exit_code);
  }
  if (result.peak_bytes > kMostPeak) return fmt::format("{} bytes", result.peak_bytes);
  for (const auto& [path, bytes] : after) {
    if (path.find("partial") != path.npos && !before.contains(path)) return "left " + path;
  }
  std::size_t refusals = 0;
  for (std::size_t at = 0; at < result.err.size();) {
    const std::size_t end = std::min(result.err.find('\n', at), result.err.size());
    refusals += std::string_view(result.err).substr(at, end - at).starts_with("lcs: ");
    at = end + 1;
  }
  const bool shows = std::ranges::all_of(
      result.err, [](unsigned char c) { return (c >= ' ' && c != 127) || c == '\n'; });
  if (!shows) return "control characters on stderr";
  if (result.exit_code != 2) return "";
  if (refusals != 1) return fmt::format("{} lines of refusal", refusals);
  if (before != after) return "what was there is not as it was";
  return "";
}

class Folders {
 public:
  Folders(const fs::path& home, const Input& input) : input_(input), home_(home) {}

  /// Copies the valid inputs and changes one file. \return a description of the change.
  std::string change(const fs::path& work, Random& random) const {
    fs::remove_all(work);
    fs::copy(home_, work, fs::copy_options::recursive);
    std::vector<fs::path> files;
    for (const fs::path& changed : input_.changed) {
      if (!fs::is_directory(work / changed)) {
        files.push_back(work / changed);
        continue;
      }
      for (const auto& entry : fs::recursive_directory_iterator(work / changed)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
      }
    }
    std::sort(files.begin(), files.end());
    const fs::path file = files[below(random, files.size())];
    if (below(random, 40) == 0) {
      replace(file, files, random);
    } else {
      std::string text = read_bytes(file);
      for (std::size_t i = below(random, below(random, 4) + 1) + 1; i > 0; --i) {
        mutate(text, random);
      }
      write_bytes(file, text);
    }
    return file.lexically_relative(work).string();
  }

 private:
  const Input& input_;
  fs::path home_;
};

int hunt(const std::string& kind, std::chrono::seconds time, std::uint64_t seed) {
  const TemporaryFolder folder;
  const fs::path home = folder.path() / "valid", work = folder.path() / "work";
  fs::create_directory(home);
  const Input input = kInputs.at(kind)(home);
  for (const Arguments& arguments : input.commands) {  // otherwise no mutant would be tried
    fs::copy(home, work, fs::copy_options::recursive);
    make(work, arguments);
    fs::remove_all(work);
  }
  const Folders folders(home, input);
  const Clock::time_point end = Clock::now() + time;
  std::map<int, int> exit_codes;
  int findings = 0;
  for (int number = 0; Clock::now() < end; ++number) {
    Random random(seed * 1'000'003 + static_cast<std::uint64_t>(number));
    const std::string changed = folders.change(work, random);
    const Arguments& arguments = input.commands[below(random, input.commands.size())];
    const auto before = state(work);

    Command command(arguments, {.folder = work, .most_memory = kMostMemory});
    const Clock::time_point latest = Clock::now() + kLongest;
    while (command.is_running() && Clock::now() < latest) std::this_thread::sleep_for(5ms);
    const bool ended = !command.is_running();
    if (!ended) command.send(SIGKILL);
    const CommandResult result = command.wait();
    ++exit_codes[result.exit_code];
    const std::string what = ended ? wrong(result, before, state(work)) : "it does not end";
    if (what.empty()) continue;

    ++findings;
    const fs::path found = fs::path("found") / fmt::format("{}-{}-{}", kind, seed, number);
    fs::create_directories(found);
    Random again(seed * 1'000'003 + static_cast<std::uint64_t>(number));
    folders.change(found / "inputs", again);
    const std::string told = fmt::format("{}: {}\nlcs {}\n{}\n", changed, what,
                                         fmt::join(arguments, " "), result.err.substr(0, 2000));
    write_bytes(found / "command.txt", told);
    fmt::print("{}: {}", found.string(), told);
    std::fflush(stdout);
  }
  for (const auto& [code, count] : exit_codes) fmt::print("{} ended with {}\n", count, code);
  return findings == 0 && !exit_codes.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (argc == 3 && arguments[0] == "answer") return answer(argv[2]);
    if (argc < 3 || !kInputs.contains(arguments[0])) {
      fmt::print(stderr, "usage: mutants KIND SECONDS [SEED]\n");
      return 2;
    }
    return hunt(arguments[0], std::chrono::seconds(std::stoi(arguments[1])),
                argc > 3 ? std::stoull(arguments[2]) : 1);
  } catch (const std::exception& error) {
    fmt::print(stderr, "mutants: {}\n", error.what());
    return 2;
  }
}
