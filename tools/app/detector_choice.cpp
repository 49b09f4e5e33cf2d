#include "tools/app/detector_choice.h"

namespace lcs::app {

comparators::DetectorSpec spec_of(const DetectorChoice& choice) {
  if (!choice.command.empty()) {
    return comparators::spec_of_program(choice.name, {choice.command, choice.timeout_s});
  }
  if (!choice.detections.empty()) return comparators::spec_of_file(choice.name, choice.detections);
  return comparators::spec_of(choice.name.empty() ? "lcs" : choice.name);
}

}  // namespace lcs::app
