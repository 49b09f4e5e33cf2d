#include "tools/tune/record.h"

#include <fmt/format.h>

namespace lcs::tune {

std::string preset_text(const Found& found, const Circumstances& circumstances) {
  std::string text = fmt::format(
      "{}, and not by hand: what the preset `default` has learnt from worlds and\n"
      "/// recordings of `train`.\n"
      "///\n"
      "/// {}, lcs {}, {} evaluations; objective {:.4f} -> {:.4f}:\n"
      "///   {}\n"
      "#pragma once\n\n"
      "#include <array>\n"
      "#include <utility>\n\n"
      "namespace lcs {{\n\n"
      "/// Keys and values as `set` takes them.\n"
      "inline constexpr std::array<std::pair<const char*, const char*>, {}> kLearnt{{{{\n",
      kPresetSign, circumstances.date, circumstances.program, found.evaluations,
      found.worth_before.objective(), found.worth_after.objective(), circumstances.command,
      found.after.size());
  for (const Setting& setting : found.after) {
    text += fmt::format("    {{\"{}\", \"{}\"}},\n", setting.key, setting.value);
  }
  return text + "}};\n\n}  // namespace lcs\n";
}

std::string record_text(const Found& found, const std::vector<Stated>& stated,
                        const Circumstances& circumstances) {
  std::string text = fmt::format(
      "{}\n\n"
      "{}, lcs {}, {} evaluations by NLopt's BOBYQA:\n\n"
      "    {}\n\n"
      "It makes the most of the mean F1 of rebels over the worlds in which something moves, less a "
      "tenth of the mean number\nof false objects in a frame over all of them, of which none "
      "counts for more than one, and less a hundredth of the\nfalse corners in a frame of "
      "recordings in which nothing moves.\n\n"
      "| | objective | F1 | false objects in 100 frames, something moves | nothing moves | false "
      "corners, recordings |\n"
      "|---|---|---|---|---|---|\n",
      kRecordSign, circumstances.date, circumstances.program, found.evaluations,
      circumstances.command);
  for (const Stated& one : stated) {
    for (const auto& [when, worth] : {std::pair("before", one.before), {"after", one.after}}) {
      text += fmt::format("| {}, {} | {:.4f} | {:.4f} | {:.1f} | {:.1f} | {:.1f} |\n", one.suite,
                          when, worth.objective(), worth.f1, 100 * worth.false_moving,
                          100 * worth.false_static, worth.false_corners);
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
