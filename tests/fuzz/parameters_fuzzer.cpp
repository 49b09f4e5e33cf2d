// Filter parameters as text, one "key=value" per line: refused, or the filter works with them.
#include <stdexcept>

#include "tests/filter/small_drive.h"
#include "tests/fuzz/input.h"

using namespace lcs;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text = fuzz::text_of(data, size);
  AnyParameters parameters;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    try {
      const std::size_t equals = std::min(line.find('='), line.size());
      const std::string_view key = line.substr(0, equals);
      const std::string_view value = line.substr(std::min(equals + 1, line.size()));
      if (key == "preset") {
        parameters = preset(value);
      } else {
        set(parameters, key, value);
      }
    } catch (const std::invalid_argument&) {
      // A wrong line does not change the parameters.
    }
  }
  try {
    validate(parameters);
  } catch (const std::invalid_argument&) {
    return 0;  // each is in its range, but the combination is invalid
  }
  if (const auto what = testing::violation_on_a_small_drive(parameters)) fuzz::fail(*what);
  return 0;
}
