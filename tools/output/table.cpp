#include "tools/output/table.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace lcs::bench {
namespace {

using Figure = std::optional<double>;

/// Right-aligned in `width`, "-" when undefined.
std::string number(Figure figure, int decimals, int width) {
  if (!figure) return fmt::format("{:>{}}", "-", width);
  return fmt::format("{:>{}.{}f}", *figure, width, decimals);
}

std::string share(Figure figure) {
  return number(figure, 2, 4);
}

/// At least three digits, whatever the size.
std::string milliseconds(Figure figure) {
  const int decimals = !figure || *figure < 10 ? 2 : *figure < 100 ? 1 : 0;
  return number(figure, decimals, 4);
}

std::string count(Figure figure) {
  return number(figure, 0, 0);
}

}  // namespace

std::string table(const Metrics& metrics) {
  const auto get = [&](const char* name) { return value(metrics, name); };
  std::string text;
  const auto line = [&](std::string_view head, const std::string& figures) {
    text += fmt::format("  {:<8} {}\n", head, figures);
  };

  line("rebels",
       fmt::format("precision {}   recall {}   F1 {} (clear {}, distinct {})   radial recall {}",
                   share(get("rebel.precision")), share(get("rebel.recall")),
                   share(get("rebel.f1")), share(get("rebel.f1_clear")),
                   share(get("rebel.f1_distinct")), share(get("rebel.recall_radial"))));
  const Figure objects = get("truth.rebel_objects");
  const Figure recall = get("rebel.object_recall");
  const Figure found = recall ? Figure(std::round(*recall * *objects)) : Figure(0);
  line("objects",
       fmt::format("found {} of {}   latency {} frames   false {} per 100 frames", count(found),
                   count(objects), number(get("rebel.latency_frames_median"), 1, 0),
                   number(get("rebel.false_objects_per_100_frames"), 1, 0)));
  line("squares",
       fmt::format("precision {}   recall {} (movers {}, static {})   mean IoU {} (masks {})",
                   share(get("square.precision_50")), share(get("square.recall_50")),
                   share(get("square.recall_50_movers")), share(get("square.recall_50_static")),
                   share(get("square.mean_iou")), share(get("square.mask_mean_iou"))));
  if (const Figure labelled = get("labels.frames")) {
    line("labels",
         fmt::format("found {} and boxed {} of {} in {} frames   off them {} rebels a frame, {} "
                     "circles per 100 frames",
                     share(get("labels.found")), share(get("labels.boxed_50")),
                     count(get("labels.boxes")), count(labelled),
                     number(get("labels.rebels_off_per_frame"), 1, 0),
                     number(get("labels.circles_off_per_100_frames"), 1, 0)));
  }
  line("size", fmt::format("{} items, beside {} corners of 5 frames, {} of 8, {} of all",
                           count(get("dimension.mean")), count(get("dimension.five_frame_mean")),
                           count(get("dimension.eight_frame_mean")),
                           count(get("dimension.accumulative_final"))));
  if (const Figure process = get("time.process_ms_median")) {
    line("time",
         fmt::format("a process: {} ms to be handed a frame and answer, 99 % in {}; FAST {}",
                     milliseconds(process), milliseconds(get("time.process_ms_p99")),
                     milliseconds(get("time.detect_ms_median"))));
    return text;
  }
  line("time",
       fmt::format(
           "{} ms (line {}, circle {}, square {}), 99 % in {}; FAST {}, signatures {}",
           milliseconds(get("time.filter_ms_median")), milliseconds(get("time.line_ms_median")),
           milliseconds(get("time.circle_ms_median")), milliseconds(get("time.square_ms_median")),
           milliseconds(get("time.filter_ms_p99")), milliseconds(get("time.detect_ms_median")),
           milliseconds(get("time.describe_ms_median"))));
  return text;
}

}  // namespace lcs::bench
