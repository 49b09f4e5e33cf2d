#include "tools/tune/record.h"

#include <fmt/format.h>

#include "scenarios/input/message.h"
#include "tools/suite/suite_run.h"

namespace lcs::tune {

namespace {

/// The command, quoted for a shell, as one line, because it becomes a comment in C++.
std::string line_of(std::vector<std::string> command) {
  for (std::string& word : command) word = input::one_line(word);
  return suite::shell_line(command);
}

/// Escapes a text for a cell of a Markdown table.
std::string cell_of(const std::string& text) {
  std::string cell;
  for (const char c : input::one_line(text)) cell += c == '|' ? "\\|" : std::string(1, c);
  return cell;
}

}  // namespace

std::string preset_text(const Found& found, const Circumstances& circumstances) {
  std::string text = fmt::format(
      "/// Written by `lcs tune`, and not by hand: what the preset `default` has learnt from "
      "worlds and\n"
      "/// recordings of `train`.\n"
      "///\n"
      "///   {}\n"
      "/// {}, lcs {}, {} evaluations; objective {:.4f} -> {:.4f}\n"
      "#pragma once\n\n"
      "#include <array>\n"
      "#include <utility>\n\n"
      "namespace lcs {{\n\n"
      "/// Keys as `set` takes them, and values.\n"
      "inline constexpr std::array<std::pair<const char*, double>, {}> kLearnt{{{{\n",
      line_of(circumstances.command), circumstances.date, circumstances.program, found.evaluations,
      found.worth_before.objective(), found.worth_after.objective(), found.after.size());
  for (const Setting& setting : found.after) {
    text += fmt::format("    {{\"{}\", {}}},\n", setting.key, setting.value);
  }
  return text + "}};\n\n}  // namespace lcs\n";
}

std::string record_text(const Found& found, const std::vector<Stated>& stated,
                        const Circumstances& circumstances) {
  std::string text = fmt::format(
      "# What `lcs tune` found\n\n"
      "{}, lcs {}, {} evaluations by NLopt's BOBYQA:\n\n"
      "    {}\n\n"
      "It makes the most of the mean F1 of rebels over the worlds in which something moves, less a "
      "tenth of the mean number\nof false objects in a frame over all of them, of which none "
      "counts for more than one, and less a hundredth of the\nfalse corners in a frame of "
      "recordings in which nothing moves.\n\n"
      "| | objective | F1 | false objects in 100 frames, something moves | nothing moves | false "
      "corners, recordings |\n"
      "|---|---|---|---|---|---|\n",
      circumstances.date, circumstances.program, found.evaluations, line_of(circumstances.command));
  for (const Stated& one : stated) {
    for (const auto& [when, worth] : {std::pair("before", one.before), {"after", one.after}}) {
      text += fmt::format("| {}, {} | {:.4f} | {:.4f} | {:.1f} | {:.1f} | {:.1f} |\n",
                          cell_of(one.suite), when, worth.objective(), worth.f1,
                          100 * worth.false_moving, 100 * worth.false_static, worth.false_corners);
    }
  }
  text += "\n| parameter | before | after |\n|---|---|---|\n";
  for (std::size_t i = 0; i < found.after.size(); ++i) {
    text += fmt::format("| `{}` | {} | {} |\n", found.after[i].key, found.before[i].value,
                        found.after[i].value);
  }
  return text;
}

}  // namespace lcs::tune
