/// \file
/// The running processes.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace lcs::test {

/// State of a process as one letter, and its parent; the state is 0 after its end.
struct ProcessState {
  char state = 0;
  pid_t parent = 0;
};
inline ProcessState state_of(const std::string& process) {
  std::ifstream file(std::filesystem::path("/proc") / process / "stat");
  const std::string stat{std::istreambuf_iterator<char>(file), {}};
  const std::size_t after_name = stat.rfind(')');
  ProcessState state;
  if (after_name != std::string::npos) {
    std::sscanf(stat.c_str() + after_name + 1, " %c %d", &state.state, &state.parent);
  }
  return state;
}

/// Whether a process runs; a zombie does not.
inline bool is_running(pid_t process) {
  const char state = state_of(std::to_string(process)).state;
  return state != 0 && state != 'Z';
}

/// Its program and arguments, each ended by a NUL; empty after its end.
inline std::string command_line_of(pid_t process) {
  std::ifstream file(std::filesystem::path("/proc") / std::to_string(process) / "cmdline");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The running children of a process.
inline std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> children;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    if (state_of(name).parent == parent && is_running(std::stoi(name))) {
      children.push_back(std::stoi(name));
    }
  }
  return children;
}

}  // namespace lcs::test
