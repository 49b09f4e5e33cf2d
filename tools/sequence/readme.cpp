#include "tools/sequence/readme.h"

#include <fmt/format.h>

namespace lcs::sequence {
namespace {

std::string head(const SequenceInfo& info) {
  const scenario::Scenario& s = info.scenario;
  const sim::Pinhole& camera = info.calibration.camera;
  return fmt::format(
      R"(# {name}

{purpose}.

{frames} frames at {rate} Hz, {width}x{height} pixels, seed {seed}; made by `lcs generate` from `scenario.yaml`.
`manifest.json` has the versions of all that took part, and size and SHA-256 of every file.

## Units, frames, axes

SI units and radians, unless a file's own format has others. Right-handed frames; `T_AB` takes the
coordinates of a point in B to those in A.

| frame | axes |
|---|---|
| W, world (EuRoC's R) | z up; gravity is {gravity} m/s^2 along -z |
| B, rover | x ahead, y left, z up; origin on the ground below its middle |
| S, IMU (EuRoC's body) | as `T_BS` in `lcs.json` has it; an accelerometer at rest reads +9.81 m/s^2 upwards |
| C, camera | x right, y down, z forward |

Camera: a pinhole without distortion, f = {focal} px in both directions, principal point ({cx}, {cy}).
Pixels: x right, y down, (0, 0) is the centre of the top-left one. The picture is taken in an instant.

Frames count from 0 (in MOTChallenge's and COCO's files from 1). Times are nanoseconds, {epoch} at the
first frame, which is time 0 of the simulation: frame k is at {epoch} + round(k * 10^9 / {rate}).
Sample i of a sensor is at {epoch} + round(i * 10^9 / its rate). Picture, depth, masks, boxes and poses of a frame
belong to the very same moment; there is no delay between sensors.

## Files
)",
      fmt::arg("name", s.name), fmt::arg("purpose", s.purpose.empty() ? s.name : s.purpose),
      fmt::arg("frames", s.frames), fmt::arg("rate", s.camera.rate_hz),
      fmt::arg("width", camera.width_px), fmt::arg("height", camera.height_px),
      fmt::arg("seed", s.seed), fmt::arg("gravity", info.calibration.gravity_mps2),
      fmt::arg("focal", camera.focal_px), fmt::arg("cx", camera.centre_px.x()),
      fmt::arg("cy", camera.centre_px.y()), fmt::arg("epoch", kEpoch_ns));
}

constexpr const char* kPictures = R"(
* `mav0/cam0/data/<ns>.png`, `mav0/cam0/data.csv`: the pictures, 8-bit colour, and their list.
* `lcs.json`: how `lcs replay` sets up the detectors for the same bits as `lcs run` gives; `origin` is the world of `lcs world` that the pictures are of, if they are of one.
* `scenario.yaml`: the scenario as it was read, without what was set on the command line.
)";

constexpr const char* kObjects = R"(
## Objects

Ids are the same in all files:

| id | name |
|---|---|
)";

}  // namespace

std::string readme_text(const SequenceInfo& info, const std::vector<std::string>& formats) {
  std::string text = head(info) + kPictures;
  for (const std::string& name : formats) text += format(name).readme;
  text += kObjects;
  for (const sim::Object& object : info.objects) {
    text += fmt::format("| {} | {} |\n", object.id, object.name);
  }
  return text;
}

}  // namespace lcs::sequence
