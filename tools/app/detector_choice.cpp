#include "tools/app/detector_choice.h"

#include <cstring>
#include <filesystem>

#include "scenarios/input/inputs_read.h"

namespace lcs::app {

namespace {

/// Records the files that the words of a shell command name, such as a script. Files that a program
/// reads by itself, and programs on the PATH, are not known.
void note_files(const std::string& command) {
  std::string word;
  char quote = 0;
  const auto end_word = [&] {
    std::error_code error;
    if (std::filesystem::is_regular_file(word, error)) input::note_input(word);
    word.clear();
  };
  for (std::size_t i = 0; i < command.size(); ++i) {
    const char c = command[i];
    if (quote != 0 ? c == quote : c == '\'' || c == '"') {
      quote = quote != 0 ? 0 : c;
    } else if (c == '\\' && quote != '\'' && i + 1 < command.size()) {
      word += command[++i];
    } else if (quote == 0 && std::strchr(" \t\n;&|<>()", c) != nullptr) {
      end_word();
    } else {
      word += c;
    }
  }
  end_word();
}

}  // namespace

comparators::DetectorSpec spec_of(const DetectorChoice& choice) {
  if (!choice.command.empty()) {
    note_files(choice.command);
    return comparators::spec_of_program(choice.name, {choice.command, choice.timeout_s});
  }
  if (!choice.detections.empty()) return comparators::spec_of_file(choice.name, choice.detections);
  return comparators::spec_of(choice.name.empty() ? "lcs" : choice.name);
}

}  // namespace lcs::app
