// A scenario's YAML: it is loaded, or refused by an error that names file and line.
#include "scenarios/load.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lcs;
  const std::filesystem::path file = fuzz::work_folder() / "scenario.yaml";
  fuzz::write_file(file, fuzz::text_of(data, size));
  try {
    const scenario::Scenario scenario = scenario::load(file);
    fuzz::require(scenario.frames > 0, "a scenario has frames");
    fuzz::require(scenario.camera.width_px > 0 && scenario.camera.rate_hz > 0,
                  "a scenario has a camera");
  } catch (const input::Error& error) {
    fuzz::require(std::string_view(error.what()).size() > 8, "an error says something");
  }
  return 0;
}
