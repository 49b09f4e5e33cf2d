/// \file
/// The running processes.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace lcs::test {

/// The text of a file of /proc; empty if the process ends before or while it is read. (An iterator
/// over the file's buffer would throw then.)
inline std::string text_in(const std::filesystem::path& file) {
  const std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// State of a process as one letter, and its parent; the state is 0 after its end.
struct ProcessState {
  char state = 0;
  pid_t parent = 0;
};
inline ProcessState state_of(const std::string& process) {
  const std::string stat = text_in(std::filesystem::path("/proc") / process / "stat");
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
  return text_in(std::filesystem::path("/proc") / std::to_string(process) / "cmdline");
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
