#include "tools/preview/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <opencv2/imgproc.hpp>

#include "filter/detect/fast.h"
#include "sim/pictures/picture_file.h"
#include "tools/recording/warnings.h"

namespace lcs::preview {
namespace {

constexpr int kJpegQuality = 85;

PreviewMover mover_of(const scenario::Scenario& scenario, const sim::Survey& survey,
                      const std::vector<Look>& looks, std::size_t actor) {
  const std::size_t id = survey.actors[actor].front();
  PreviewMover mover{.name = scenario.actors[actor].name, .object = static_cast<int>(id)};
  for (std::size_t k = 0; k < survey.snapshots.size(); ++k) {
    const Eigen::Vector2d here = survey.snapshots[k].T_WO[id].p.head<2>();
    const double t_s = static_cast<double>(k) / scenario.camera.rate_hz;
    const double distance_m = (here - survey.rover_m[k]).norm();
    if (k == 0 || distance_m < mover.nearest_m) {
      mover.nearest_m = distance_m;
      mover.nearest_s = t_s;
    }
    const auto moves = [&](std::size_t part) {
      return sim::moved(survey.snapshots[k - 1].T_WO[part], survey.snapshots[k].T_WO[part]);
    };
    if (k > 0 && std::ranges::any_of(survey.actors[actor], moves)) {
      if (!mover.moves) mover.moves = {t_s - 1 / scenario.camera.rate_hz, t_s};
      mover.moves->to_s = t_s;
    }
    mover.way_m.push_back(here);
  }
  for (const Look& look : looks) {
    mover.looks += std::ranges::find(look.objects, mover.object, &sim::ObjectTruth::object) !=
                   look.objects.end();
  }
  return mover;
}

/// The same view with at most `kMostLookPixels` pixels.
scenario::Scenario looked_at(scenario::Scenario scenario) {
  int &width = scenario.camera.width_px, &height = scenario.camera.height_px;
  const double share = kMostLookPixels / (static_cast<double>(width) * height);
  if (share < 1) {
    width = std::max(1, static_cast<int>(width * std::sqrt(share)));
    height = std::max(1, static_cast<int>(height * std::sqrt(share)));
  }
  return scenario;
}

std::vector<std::string> what_is_wrong(const Preview& p) {
  std::vector<std::string> lines = p.survey.wrong_at_start;
  lines.insert(lines.end(), p.survey.inside.begin(), p.survey.inside.end());
  for (std::size_t i = 0; i < sim::kWarnings.size(); ++i) {
    const auto& met = p.survey.warnings.of(static_cast<sim::Warning>(i));
    if (met.count > 0) lines.push_back(met.first);
    lines.insert(lines.end(), met.next.begin(), met.next.end());
    const std::int64_t more = met.count - 1 - std::ssize(met.next);
    if (more > 0) lines.back() += fmt::format(" (and {} more times)", more);
  }
  for (const PreviewMover& mover : p.movers) {
    if (mover.looks > 0) continue;
    lines.push_back(fmt::format("actor '{}' is in none of the {} pictures that were looked at: {}",
                                mover.name, p.looks.size(),
                                sim::text_of(sim::Warning::actors_never_seen).remedy));
  }
  const auto has_few = [](const auto& corners) { return corners.size() < recording::kFewCorners; };
  const auto few = std::ranges::count_if(p.corners_px, has_few);
  if (2 * few > std::ssize(p.corners_px)) {
    lines.push_back(
        fmt::format("fewer than {} corners are in {} of {} pictures: lower corners.threshold, or "
                    "give the scene more texture or light",
                    recording::kFewCorners, few, p.corners_px.size()));
  }
  return lines;
}

}  // namespace

Preview preview(const scenario::Scenario& scenario, const std::function<void(int)>& on_frame) {
  Preview p;
  const FastDetector detector(scenario.fast_threshold);
  const auto on_look = [&](const sim::Observation& seen) {
    cv::Mat1b grey;
    cv::cvtColor(seen.image, grey, cv::COLOR_BGR2GRAY);
    p.corners_px.push_back(detector.detect(grey));
    p.looks.push_back(
        {seen.index, seen.image.size(), seen.objects, sim::encode_jpeg(seen.image, kJpegQuality)});
  };
  p.survey = sim::survey(looked_at(scenario), kLooks, on_look, on_frame);
  for (std::size_t i = 0; i < scenario.actors.size(); ++i) {
    p.movers.push_back(mover_of(scenario, p.survey, p.looks, i));
  }
  p.wrong = what_is_wrong(p);
  return p;
}

}  // namespace lcs::preview
