#include "sim/observer.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/base/random.h"
#include "sim/drive.h"

namespace lcs::sim {
namespace {

/// Convex parts of each object and limb; index 0, the world, has none.
std::vector<ConvexParts> outlines(const World& world) {
  std::vector<ConvexParts> parts(world.objects().size() + 1 + world.limb_objects().size());
  const mjModel& m = world.model().m();
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const int object = world.carrier_of_geom(geom);
    if (object <= 0 || !world.is_drawn(geom)) continue;
    // at t = 0; the parts are constant, as bodies are rigid
    const Pose T_OW = world.model().body_pose(world.body_of(object)).inverse();
    const Pose T_OG = T_OW * world.model().geom_pose(geom);
    parts[static_cast<std::size_t>(object)].push_back((T_OG.R * geom_hull(m, geom)).colwise() +
                                                      T_OG.p);
  }
  return parts;
}

/// Each camera of a rig has its own noise; the first has the noise of a single camera.
std::uint64_t noise_seed(const scenario::Scenario& s) {
  if (s.rig_place == 0) return s.seed;
  return RandomStream(s.seed, fmt::format("camera.{}", s.rig_place)).bits();
}

/// \throws input::Error if shadows are asked for and no light of the scene casts any.
bool casts_shadows(const scenario::Scenario& s, const World& world) {
  const mjModel& m = world.model().m();
  if (!s.image.shadows) return false;
  for (int light = 0; light < m.nlight; ++light) {
    if (m.light_active[light] && m.light_castshadow[light]) return true;
  }
  throw input::Error({s.file.string(), 0},
                     "image.shadows is true, and no light of {} casts any; give one of its lights "
                     "castshadow=\"true\", or remove the key",
                     s.scene.string());
}

Photographer photographer_of(const scenario::Scenario& s, const Optics& camera) {
  try {
    return {s.image, camera, s.camera.rate_hz, noise_seed(s)};
  } catch (const std::invalid_argument& error) {
    throw input::Error({s.file.string(), 0}, error.what());
  }
}

}  // namespace

Observer::Observer(const scenario::Scenario& scenario, WrongStart wrong_start)
    : scenario_(scenario),
      world_(scenario, wrong_start),
      calibration_(calibrate(world_, scenario.camera)),
      renderer_(world_.model(), world_.camera_id(), calibration_.optics, scenario.image.samples,
                world_.groups(), casts_shadows(scenario, world_)),
      parts_(outlines(world_)),
      photographer_(photographer_of(scenario, calibration_.optics)),
      passage_(world_, scenario) {
  if (scenario.events) {
    event_sensor_.emplace(*scenario.events, calibration_.optics.size_px(), noise_seed(scenario));
  }
}

Observation Observer::observe() {
  Observation o;
  Drawing drawing;
  const Shutter& shutter = passage_.shutter();
  if (shutter.is_instant()) drawing = draw(true);
  FrameState frame = std::move(passage_.frame());
  passage_.advance(o);
  if (!shutter.is_instant()) drawing = draw_through_shutter(frame, o.index);
  o.rendered = drawing.even;
  o.geom = drawing.geom;
  o.truth.depth_m = drawing.depth_m;
  o.truth.shadow_edge = drawing.shadow_edge;
  if (event_sensor_) sense_events(frame, o);
  develop(drawing.light, o);
  o.truth.now = std::move(frame.now);
  o.truth.v_WC_mps = frame.v_WC_mps;
  o.truth.w_C_radps = frame.w_C_radps;
  o.truth.next = passage_.frame().now;
  if (shutter.rolls()) {
    const auto readout = [&](const std::vector<Snapshot>& at) -> Readout {
      return {at, shutter.row_at(0), shutter.row_at(1) - shutter.row_at(0)};
    };
    o.truth.now_rows = readout(frame.snapshots);
    o.truth.next_rows = readout(passage_.frame().snapshots);
  }
  o.objects = visible_objects(o.truth);
  for (const ObjectTruth& object : o.objects) seen_.insert(object.object);
  if (++observed_ == scenario_.frames) note_unseen();
  return o;
}

/// Warns of actors that no frame of the whole scenario shows.
void Observer::note_unseen() {
  for (const scenario::Actor& actor : scenario_.actors) {
    const Object& object =
        *std::ranges::find(world_.objects(), actor.body.value_or(actor.name), &Object::name);
    if (seen_.contains(object.id)) continue;
    bool is_drawn = false;
    for (int geom = 0; geom < world_.model().m().ngeom; ++geom) {
      is_drawn |= world_.object_of_geom(geom) == object.id && world_.is_drawn(geom);
    }
    world_.warnings().add(
        Warning::actors_never_seen,
        fmt::format("actor '{}' is in none of the {} pictures{}", actor.name, scenario_.frames,
                    is_drawn ? "" : " (none of its geoms is in camera.groups and has an alpha)"));
  }
}

void Observer::advance() {
  if (event_sensor_ || scenario_.image.auto_exposure) {
    observe();
    return;
  }
  Observation skipped;
  passage_.advance(skipped);
}

/// Draws the world as it is shown now. Without `has_truth` depth and geoms may be missing.
Observer::Drawing Observer::draw(bool has_truth) {
  Drawing d;
  renderer_.update();
  renderer_.render_light(d.even);
  d.light = d.even;
  if (!has_truth && !scenario_.image.shadows) return d;
  renderer_.render_depth_and_geoms(d.depth_m, d.geom);
  if (scenario_.image.shadows) {
    d.light.release();
    renderer_.render_shaded(d.even, d.geom, d.light, d.shadow_edge);
  }
  return d;
}

/// Calls `on_point(parts_px)` for every eighth pixel of a drawing, with the lengths of the ways
/// that its point takes through the picture from each of the snapshots to the next. \param
/// reference the snapshot of the drawing.
void Observer::visit_ways(const std::vector<const Snapshot*>& at, const Snapshot& reference,
                          const cv::Mat1f& depth_m, const cv::Mat1i& geom,
                          const auto& on_point) const {
  constexpr int kStride_px = 8;
  const Optics& optics = calibration_.optics;
  // from the camera of the drawing to that at each time, for each object
  std::vector<std::vector<Pose>> ways(reference.T_WO.size());
  for (std::size_t id = 0; id < ways.size(); ++id) {
    const Pose T_OC = reference.T_WO[id].inverse() * reference.T_WC;
    for (const Snapshot* then : at) {
      ways[id].push_back(then->T_WC.inverse() * (then->T_WO[id] * T_OC));
    }
  }
  std::vector<double> parts_px(at.size() - 1);
  for (int y = 0; y < geom.rows; y += kStride_px) {
    for (int x = 0; x < geom.cols; x += kStride_px) {
      const int object = geom(y, x) < 0 ? -1 : world_.carrier_of_geom(geom(y, x));
      if (object < 0) continue;
      const Eigen::Vector3d p_C = optics.back_project(Eigen::Vector2d(x, y), depth_m(y, x));
      std::ranges::fill(parts_px, 0.0);
      std::optional<Eigen::Vector2d> last_px;
      const std::vector<Pose>& way = ways[static_cast<std::size_t>(object)];
      for (std::size_t i = 0; i < way.size(); ++i) {
        const Eigen::Vector3d there = way[i] * p_C;
        if (there.z() < renderer_.near_m()) break;
        const Eigen::Vector2d px = optics.project(there);
        if (last_px && px.allFinite()) parts_px[i - 1] = (px - *last_px).norm();
        last_px = px;
      }
      on_point(parts_px);
    }
  }
}

/// The longest way that a visible point takes through the picture during the shutter's window.
double Observer::shift_px(const FrameState& frame, const cv::Mat1f& depth_m,
                          const cv::Mat1i& geom) const {
  constexpr std::size_t kParts = 8;
  const std::vector<Snapshot>& all = frame.snapshots;
  std::vector<const Snapshot*> at;
  for (std::size_t part = 0; part <= kParts; ++part) {
    at.push_back(&all[part * (all.size() - 1) / kParts]);
  }
  double longest_px = 0;
  visit_ways(at, all[Shutter::kMiddle], depth_m, geom, [&](const std::vector<double>& parts_px) {
    double way_px = 0;
    for (const double part_px : parts_px) way_px += part_px;
    longest_px = std::max(longest_px, way_px);
  });
  return longest_px;
}

/// Shows event pixels the world at instants since the last frame between which nothing that the
/// pictures at both ends show shifts by more than `kMostEventShift_px`.
void Observer::sense_events(const FrameState& frame, Observation& o) {
  const std::vector<EventInstant>& instants = frame.event_instants;
  std::vector<std::size_t> chosen{0};
  if (sensed_) {
    std::vector<const Snapshot*> at{&sensed_->now};
    for (std::size_t part = 1; part <= kEventParts; ++part) {
      at.push_back(&instants[part * kEventCells / kEventParts - 1].snapshot);
    }
    std::vector<double> parts_px(kEventParts, 0.0);
    const auto take_longest = [&](const std::vector<double>& of_point) {
      for (std::size_t i = 0; i < kEventParts; ++i) {
        parts_px[i] = std::max(parts_px[i], of_point[i]);
      }
    };
    visit_ways(at, sensed_->now, sensed_->depth_m, sensed_->geom, take_longest);
    visit_ways(at, frame.now, o.truth.depth_m, o.geom, take_longest);
    const EventSampling sampling = sample_events(parts_px);
    chosen = sampling.cells;
    if (sampling.most_shift_px > kMostEventShift_px) {
      world_.warnings().add(Warning::coarse_events,
                            fmt::format("up to frame {} the picture shifts by {:.1f} px between "
                                        "two of the {} instants at which events are sampled",
                                        o.index, sampling.most_shift_px, chosen.size()));
    }
  }
  const ScenePoses present = world_.stage();
  for (const std::size_t cell : chosen) {
    world_.show(instants[cell].stage);
    const Drawing d = draw(photographer_.depends_on_depth());
    event_sensor_->sample(photographer_.light(d.light, d.depth_m), instants[cell].t_ns, o.events);
  }
  world_.show(present);
  sensed_ = {frame.now, o.truth.depth_m.clone(), o.geom.clone()};
}

/// The drawing of a frame whose pixels see the world at several instants. Its light is the mean
/// over the exposure; all else is that of the middle of the exposure, of each row.
Observer::Drawing Observer::draw_through_shutter(const FrameState& frame, int index) {
  const Shutter& shutter = passage_.shutter();
  const ScenePoses present = world_.stage();
  world_.show(frame.stages[Shutter::kMiddle]);
  Drawing seen;
  if (shutter.rolls()) {  // each row comes from its own drawing
    renderer_.update();
    renderer_.render_depth_and_geoms(seen.depth_m, seen.geom);
    seen.even.create(seen.geom.size());
    seen.light = seen.even;
    if (scenario_.image.shadows) {
      seen.light = cv::Mat3f(seen.geom.size());
      seen.shadow_edge.create(seen.geom.size());
    }
  } else {
    seen = draw(true);
  }
  // a picture of its own: `zeros` would be written over `even`
  if (shutter.smears()) seen.light = cv::Mat3f(seen.geom.size(), cv::Vec3f::all(0));
  const double shift = shift_px(frame, seen.depth_m, seen.geom);
  const int n = Shutter::drawings_for(shift);
  if (shift > n * Shutter::kMostShift_px) {
    world_.warnings().add(Warning::coarse_shutter,
                          fmt::format("frame {} shifts by {:.0f} px during readout and exposure, "
                                      "and is drawn at {} instants, {:.2f} px apart",
                                      index, shift, n, shift / n));
  }
  for (int i = 0; i < n; ++i) {
    std::vector<int> own;  // rows whose time is in this cell: they are next to each other
    for (int y = 0; y < seen.even.rows && shutter.rolls(); ++y) {
      if (shutter.drawing_of(y, n) == i) own.push_back(y);
    }
    if (own.empty() && !shutter.smears()) continue;
    world_.show(frame.stages[Shutter::instant_of(i, n)]);
    const Drawing now = draw(!own.empty());
    for (int y = 0; y < seen.light.rows && shutter.smears(); ++y) {
      if (const double share = shutter.share(y, i, n); share > 0) {
        cv::scaleAdd(now.light.row(y), share, seen.light.row(y), seen.light.row(y));
      }
    }
    if (own.empty()) continue;
    const cv::Range rows(own.front(), own.back() + 1);
    const auto take = [&](const cv::Mat& from, cv::Mat& to) {
      if (!from.empty()) from.rowRange(rows).copyTo(to.rowRange(rows));
    };
    take(now.even, seen.even);
    if (!shutter.smears()) take(now.light, seen.light);
    take(now.depth_m, seen.depth_m);
    take(now.geom, seen.geom);
    take(now.shadow_edge, seen.shadow_edge);
  }
  world_.show(present);
  return seen;
}

void Observer::develop(const cv::Mat3f& light, Observation& o) {
  o.exposure = photographer_.develop(light.clone(), o.truth.depth_m, o.index, o.image);
  const auto label = [&](cv::Mat1i& pixels, auto&& of_geom) {
    pixels.create(o.geom.size());
    const int* const geoms = o.geom.ptr<int>();
    std::transform(geoms, geoms + o.geom.total(), pixels.ptr<int>(),
                   [&](int geom) { return geom < 0 ? -1 : of_geom(geom); });
  };
  label(o.truth.object, [&](int geom) { return world_.object_of_geom(geom); });
  o.truth.limb_objects = world_.limb_objects();
  if (o.truth.limb_objects.empty()) return;
  label(o.truth.part, [&](int geom) { return world_.carrier_of_geom(geom); });
}

/// Area that each object's pixels of a lens have in the picture of the pinhole, by id.
std::vector<double> Observer::areas_px(const cv::Mat1i& object) const {
  const Optics& optics = calibration_.optics;
  const double focal_px = calibration_.camera.focal_px;
  std::vector<double> areas_px(parts_.size(), 0);
  for (int y = 0; y < object.rows; ++y) {
    for (int x = 0; x < object.cols; ++x) {
      if (object(y, x) <= 0) continue;
      areas_px[static_cast<std::size_t>(object(y, x))] +=
          focal_px * focal_px / optics.jacobian_px(optics.ray(x, y)).determinant();
    }
  }
  return areas_px;
}

std::vector<ObjectTruth> Observer::visible_objects(const FrameTruth& truth) const {
  std::vector<ObjectTruth> all =
      modal_boxes(truth.object, static_cast<int>(world_.objects().size()));
  std::erase_if(all, [](const ObjectTruth& o) { return o.visible_px == 0; });
  const PointMotion way(truth, truth.object.rows);
  const bool is_pinhole = calibration_.optics.is_pinhole();
  const std::vector<double> of_lens_px =
      is_pinhole ? std::vector<double>() : areas_px(truth.object);
  for (ObjectTruth& o : all) {
    const auto id = static_cast<std::size_t>(o.object);
    const double row = (o.top + o.bottom) / 2.0;
    ConvexParts parts = parts_[id];
    for (std::size_t i = 0; i < truth.limb_objects.size(); ++i) {
      if (truth.limb_objects[i] != o.object) continue;
      const std::size_t limb = world_.objects().size() + 1 + i;
      const Pose T_OL = way.T_WO(id, row).inverse() * way.T_WO(limb, row);
      for (const Eigen::Matrix3Xd& part : parts_[limb]) {
        parts.push_back((T_OL.R * part).colwise() + T_OL.p);
      }
    }
    const double full =
        silhouette_px(calibration_.camera, way.T_WC(row).inverse() * way.T_WO(id, row), parts,
                      renderer_.near_m());
    const double seen_px = is_pinhole ? o.visible_px : of_lens_px[id];
    o.visible_fraction = full > 0 ? std::min(1.0, seen_px / full) : 0;
    o.moving = way.any_moves(id);
  }
  return all;
}

}  // namespace lcs::sim
