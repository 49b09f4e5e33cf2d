#include "sim/world/world.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <system_error>

#include "scenarios/input/reader.h"
#include "scenarios/input/spelling.h"
#include "sim/base/rotation.h"
#include "sim/base/trial.h"
#include "sim/pictures/picture_file.h"
#include "sim/scene/ground.h"
#include "sim/scene/limits.h"
#include "sim/scene/texture.h"

namespace lcs::sim {
namespace {

constexpr double kLongestStep_s = 0.002;
constexpr double kMoves_m = 1e-7;  // least step of an actor that moves
constexpr double kActorInside_m =
    0.22;  // less is a graze; the leg of a pedestrian inside a crate is deeper
constexpr double kImmovable = 1e6;  // kg or kg m^2: nothing in a scene deflects such a joint

/// \throws input::Error if the extent of the scene is too large or too small for the camera; the
/// error cites the farthest geom or its body.
void check_extent(const ComposedScene& composed, Model& model) {
  const mjModel& m = model.m();
  if (m.stat.extent >= kLeastExtent_m && m.stat.extent <= kMostExtent_m) return;
  call_mujoco([&] { mj_forward(&m, &model.d()); });
  int farthest = 0;
  double distance_m = -1;
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const double reach_m = model.geom_pose(geom).p.norm() + m.geom_rbound[geom];
    if (reach_m <= distance_m) continue;
    distance_m = reach_m;
    farthest = geom;
    if (!std::isfinite(reach_m)) break;
  }
  const std::string geom(model.name(mjOBJ_GEOM, farthest));
  const std::string body(model.name(mjOBJ_BODY, m.geom_bodyid[farthest]));
  throw input::Error(
      geom.empty() ? composed.source(mjOBJ_BODY, body) : composed.source(mjOBJ_GEOM, geom),
      "the scene is {:g} m large, and a camera sees scenes of {:g} to {:g} m: geom '{}' of body "
      "'{}' reaches {:g} m from the middle of the world; correct its place and size",
      m.stat.extent, kLeastExtent_m, kMostExtent_m, geom, body, distance_m);
}

/// Why a scene is not loaded that was tried in a child process.
std::string reason_of(const std::string& crash) {
  if (crash.starts_with("signal")) {
    return "MuJoCo crashes on this scene (" + crash +
           "); take out what was changed last; meshes, skins and textures are the first to look at";
  }
  return "MuJoCo needs " + (crash == "memory" ? "too much memory" : "more than " + crash) +
         " to load this scene; make it smaller (sizes in <size>, composites, textures, meshes), or "
         "raise ulimit -v where that is set";
}

Model compile(ComposedScene& composed) {
  try {
    Model model(*composed.spec);
    composed.reader.note_warnings(composed.spec.get());
    check_extent(composed, model);
    return model;
  } catch (const MujocoError& e) {
    throw composed.reader.refusal(e.what(), composed.spec.get());
  }
}

void fill_textures(Model& model, const scenario::Scenario& scenario,
                   const ComposedScene& composed) {
  for (int texture = 0; texture < model.m().ntex; ++texture) {
    try {
      fill_procedural_texture(model, texture, scenario.seed);
    } catch (const std::invalid_argument& error) {
      throw input::Error(composed.source(mjOBJ_TEXTURE, model.name(mjOBJ_TEXTURE, texture)),
                         error.what());
    }
  }
  for (const PictureTexture& picture : composed.pictures) {
    cv::Mat image = read_picture(picture.file, picture.source, cv::IMREAD_COLOR);
    cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
    fill_texture(model, model.id(mjOBJ_TEXTURE, picture.texture), image);
  }
}

/// The origin that the scene states; absent if it states none.
std::optional<scenario::Origin> origin_of(const Model& model, const input::Source& where) {
  if (!model.has(mjOBJ_TEXT, scenario::kOriginText)) return std::nullopt;
  const mjModel& m = model.m();
  const std::string_view text =
      m.text_data + m.text_adr[model.id(mjOBJ_TEXT, scenario::kOriginText)];
  const std::size_t space = std::min(text.rfind(' '), text.size());
  scenario::Origin origin;
  origin.source = where;
  origin.family = text.substr(0, space);
  const char* const end = text.data() + text.size();
  const auto [stop, error] =
      std::from_chars(text.data() + std::min(space + 1, text.size()), end, origin.seed);
  if (origin.family.empty() || error != std::errc() || stop != end) {
    throw input::Error(where,
                       "the text '{}' is '{}', and names no world; write family and seed, as in "
                       "'room 7', or remove it",
                       scenario::kOriginText, text);
  }
  return origin;
}

/// \throws input::Error if scenario and scene state different origins.
std::optional<scenario::Origin> origin_of(const scenario::Scenario& scenario,
                                          const ComposedScene& composed, const Model& model) {
  const auto of_scene = origin_of(model, composed.source(mjOBJ_TEXT, scenario::kOriginText));
  if (!scenario.origin || !of_scene) return scenario.origin ? scenario.origin : of_scene;
  if (scenario.origin->is_same_world(*of_scene)) return scenario.origin;
  throw input::Error(scenario.origin->source,
                     "origin is {} {}, but the scene {} was drawn as {} {}; remove origin, or give "
                     "the scene that it is of",
                     scenario.origin->family, scenario.origin->seed, scenario.scene.string(),
                     of_scene->family, of_scene->seed);
}

Eigen::Quaterniond about_z(double angle_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()));
}

/// Velocity of an element's frame, in W: angular, then linear.
Eigen::Matrix<double, 6, 1> velocity(const Model& model, mjtObj type, int id) {
  Eigen::Matrix<double, 6, 1> v;
  mj_objectVelocity(&model.m(), &model.d(), type, id, v.data(), 0);
  return v;
}

/// " (body 'ball')" if a warning cites a degree of freedom; else empty.
std::string body_of_dof(const Model& model, const std::string& warning) {
  for (const std::string words : {"in QVEL at DOF ", "in QACC at DOF "}) {
    const std::size_t at = warning.find(words);
    if (at == std::string::npos) continue;
    const int dof = std::atoi(warning.c_str() + at + words.size());
    if (dof < 0 || dof >= model.m().nv) continue;
    return fmt::format(" (body '{}')", model.name(mjOBJ_BODY, model.m().dof_bodyid[dof]));
  }
  return "";
}

/// Whether a body that moves by the physics can have contacts.
bool has_contacts(const mjModel& m) {
  if (m.npair > 0) return true;
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const bool touches = m.geom_contype[geom] != 0 || m.geom_conaffinity[geom] != 0;
    if (touches && m.body_weldid[m.geom_bodyid[geom]] != 0) return true;
  }
  return false;
}

bool in_gap(const std::vector<scenario::TimeSpan>& gaps, std::int64_t t_ns) {
  return std::ranges::any_of(gaps, [&](const scenario::TimeSpan& gap) {
    return t_ns >= std::llround(gap.from_s * 1e9) && t_ns < std::llround(gap.to_s * 1e9);
  });
}

/// \param visit is called with the beginning and the size of each array.
void visit_poses(const mjModel& m, mjData& d, const auto& visit) {
  visit(d.xpos, 3 * m.nbody);
  visit(d.xmat, 9 * m.nbody);
  visit(d.geom_xpos, 3 * m.ngeom);
  visit(d.geom_xmat, 9 * m.ngeom);
  visit(d.cam_xpos, 3 * m.ncam);
  visit(d.cam_xmat, 9 * m.ncam);
  visit(d.light_xpos, 3 * m.nlight);
  visit(d.light_xdir, 3 * m.nlight);
}

}  // namespace

std::int64_t event_time_ns(std::int64_t k, double rate_hz) {
  return std::llround(static_cast<double>(k) * 1e9 / rate_hz);
}

/// Loads a scene in a child process first (sim/base/trial.h), and here only if the child survives.
/// The child takes as much processor time as the load itself.
World::Loaded World::load(const scenario::Scenario& scenario) {
  // MuJoCo holds its own lock during a load: no other thread may fork then
  static std::mutex loading;
  const std::lock_guard lock(loading);
  const Trial trial = try_in_child([&] {
    ComposedScene composed = compose(scenario);
    compile(composed);
  });
  if (!trial.crash.empty()) {
    throw input::Error({scenario.scene.string(), 0}, reason_of(trial.crash));
  }
  ComposedScene composed = compose(scenario);  // throws the error that the child threw
  Model model = compile(composed);
  if (!trial.fine) {
    throw input::Error({scenario.scene.string(), 0},
                       "a first load failed and a second did not, as where memory is short (" +
                           trial.refused + "); end other programs, or raise ulimit -v");
  }
  return {std::move(composed), std::move(model)};
}

World::World(const scenario::Scenario& scenario, WrongStart wrong_start)
    : World(scenario, load(scenario), wrong_start) {}

World::World(const scenario::Scenario& scenario, Loaded loaded, WrongStart wrong_start)
    : scenario_(scenario),
      composed_(std::move(loaded.composed)),
      model_(std::move(loaded.model)),
      imu_noise_(scenario.imu, scenario.seed),
      odometry_noise_(scenario.odometry, scenario.seed),
      camera_(model_.id(mjOBJ_CAMERA, kCamera)),
      base_(model_.id(mjOBJ_BODY, kEgoBody)),
      imu_site_(model_.id(mjOBJ_SITE, "ego/imu")) {
  origin_ = origin_of(scenario_, composed_, model_);
  fill_textures(model_, scenario_, composed_);
  if (scenario_.ground) raise_ground(model_, *scenario_.ground, scenario_.seed);
  set_options();
  find_objects();
  guarded([&] {
    call_mujoco([&] { mj_kinematics(&model_.m(), &model_.d()); });
    rover_ = make_rover(scenario_, model_);
    place_imu();
    find_actors();
    rover_->start(model_);
    call_mujoco([&] { mj_kinematics(&model_.m(), &model_.d()); });
    forward();
    begin_watch(wrong_start);
  });
}

/// Sets the physics that the readings rely on, and overrides the scene's options.
void World::set_options() {
  mjOption& option = model_.m().opt;
  if (option.integrator == mjINT_RK4) option.integrator = mjINT_EULER;
  option.timestep = std::min(option.timestep, kLongestStep_s);
  option.disableflags &= ~(mjDSBL_ACTUATION | mjDSBL_CLAMPCTRL | mjDSBL_FILTERPARENT);
  option.disableflags |= mjDSBL_SENSOR;  // the IMU is calculated from the motion of its site
  if (!has_contacts(model_.m())) option.disableflags |= mjDSBL_CONTACT;  // halves the run time
  const mjtNum* g = option.gravity;
  const bool upright = g[0] == 0 && g[1] == 0 && g[2] <= 0;
  if (!upright) {
    throw input::Error(composed_.reader.source_of_tag("<option>"),
                       "gravity must point along -z of the world; correct <option gravity>");
  }
  gravity_mps2_ = option.disableflags & mjDSBL_GRAVITY ? 0 : -g[2];
}

void World::find_objects() {
  const mjModel& m = model_.m();
  const auto refuse = [&](const std::string& body, const std::string& what) {
    throw input::Error(composed_.source(mjOBJ_BODY, body), what);
  };
  object_bodies_ = {0};
  std::vector<std::string> articulated;
  std::vector<int> object_of_body(static_cast<std::size_t>(m.nbody), 0);
  for (int body = 1; body < m.nbody; ++body) {
    const auto b = static_cast<std::size_t>(body);
    const std::string name(model_.name(mjOBJ_BODY, body));
    const bool moves = m.body_dofnum[body] > 0;
    if (m.body_parentid[body] != 0) {
      object_of_body[b] = object_of_body[static_cast<std::size_t>(m.body_parentid[body])];
      const std::string_view root = model_.name(mjOBJ_BODY, m.body_rootid[body]);
      const bool is_led = std::ranges::any_of(scenario_.actors, [&](const scenario::Actor& actor) {
        return !actor.joints.empty() && actor.body == root;
      });
      if (moves && !is_led && object_of_body[b] >= 0) articulated.push_back(name);
    } else if (name == kEgoBody) {
      object_of_body[b] = -1;
    } else if (!name.empty()) {
      object_of_body[b] = static_cast<int>(object_bodies_.size());
      objects_.push_back({object_of_body[b], name});
      object_bodies_.push_back(body);
    }
  }
  if (!articulated.empty()) {
    const std::string more =
        articulated.size() > 1 ? fmt::format(" (and {} more)", articulated.size() - 1) : "";
    refuse(articulated.front(),
           fmt::format("body '{}'{} has a joint inside another body, and an object moves as one: "
                       "give the scenario a pose (a keyframe of the scene, or zero) that it keeps, "
                       "or an actor that moves the joint; or make it a body of the worldbody",
                       articulated.front(), more));
  }
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const int object = object_of_body[static_cast<std::size_t>(m.geom_bodyid[geom])];
    object_of_geom_.push_back(object);
    carrier_of_geom_.push_back(object);
    if (object > 0 && (m.geom_type[geom] == mjGEOM_PLANE || m.geom_type[geom] == mjGEOM_HFIELD)) {
      const std::string& body = objects_[static_cast<std::size_t>(object - 1)].name;
      refuse(body, fmt::format("body '{}' has a plane or height field; these are setting: put them "
                               "right into the worldbody",
                               body));
    }
  }
}

void World::place_imu() {
  const scenario::Imu& imu = scenario_.imu;
  if (!imu.position_m && !imu.rpy_rad) return;
  Pose T_BS = T_WB().inverse() * T_WS();
  if (imu.position_m) T_BS.p = *imu.position_m;
  if (imu.rpy_rad) T_BS.R = rotation_of_rpy(*imu.rpy_rad);
  mjModel& m = model_.m();
  // of the body that the site is fixed in, which is the base or fixed to it
  const Pose T_PS = model_.body_pose(m.site_bodyid[imu_site_]).inverse() * T_WB() * T_BS;
  const Eigen::Quaterniond q(T_PS.R);
  Eigen::Map<Eigen::Vector3d>(m.site_pos + 3 * imu_site_) = T_PS.p;
  Eigen::Map<Eigen::Vector4d>(m.site_quat + 4 * imu_site_) << q.w(), q.x(), q.y(), q.z();
  m.site_sameframe[imu_site_] = 0;
}

void World::find_actors() {
  for (std::size_t i = 0; i < scenario_.actors.size(); ++i) {
    const scenario::Actor& actor = scenario_.actors[i];
    const int body = model_.id(mjOBJ_BODY, composed_.actor_bodies[i]);
    const Pose T_WA = model_.body_pose(body);
    const PlanarPose home{T_WA.p.head<2>(), std::atan2(T_WA.R(1, 0), T_WA.R(0, 0))};
    actors_.push_back({body, T_WA.p.z(), about_z(-home.heading_rad) * Eigen::Quaterniond(T_WA.R),
                       home, actor.trajectory, Trigger(actor.start), actor.name});
    if (actor.walks()) actors_.back().gait.emplace(model_, actor.name + "/");
    find_joints(actors_.back(), actor);
    if (actor.walks() || !actor.joints.empty()) find_limbs(body);
    place(actors_.back(), -1);
  }
}

/// Takes hold of all joints in the body of an actor that moves some of them. \throws input::Error
/// for joints that it lacks, that are no hinges or slides, or that do not reach a value.
void World::find_joints(MovingActor& actor, const scenario::Actor& asked) {
  mjModel& m = model_.m();
  std::vector<std::string> names;  // of its joints, which follow each other
  int first = 0;
  for (int joint = 0; joint < m.njnt; ++joint) {
    if (m.body_rootid[m.jnt_bodyid[joint]] != actor.body) continue;
    if (names.empty()) first = joint;
    names.emplace_back(model_.name(mjOBJ_JOINT, joint));
  }
  for (const scenario::JointMotion& motion : asked.joints) {
    const auto refuse = [&](const std::string& what) {
      throw input::Error(motion.source, "joint '{}' {}", motion.name, what);
    };
    const auto found = std::ranges::find(names, motion.name);
    if (found == names.end()) {
      refuse(fmt::format("is not in body '{}'; its joints are called '{}'", *asked.body,
                         fmt::join(input::nearest_first(motion.name, names), "', '")));
    }
    const int joint = first + static_cast<int>(found - names.begin());
    const bool turns = m.jnt_type[joint] == mjJNT_HINGE;
    if (!turns && m.jnt_type[joint] != mjJNT_SLIDE) {
      refuse("is a ball or free joint, and actors move hinges and slides; make it one of these");
    }
    const Eigen::Map<const Eigen::Vector2d> range(m.jnt_range + 2 * joint);
    for (const scenario::JointPoint& point : motion.points) {
      if (point.is_angle != turns) {
        refuse(turns ? "is a hinge; give angles, in deg or rad"
                     : "is a slide; give lengths, as in m");
      }
      constexpr double kRounding = 1e-9;
      const double beyond = std::max(range[0] - point.value, point.value - range[1]);
      if (!m.jnt_limited[joint] || beyond < kRounding) continue;
      const auto unit = turns ? input::Dimension::angle : input::Dimension::length;
      refuse(fmt::format("moves to {}, and reaches {} to {} ({}); stay within this",
                         input::quantity_text(point.value, unit),
                         input::quantity_text(range[0], unit), input::quantity_text(range[1], unit),
                         input::text_of(composed_.source(mjOBJ_JOINT, motion.name))));
    }
    actor.joints.push_back({m.jnt_qposadr[joint], m.jnt_dofadr[joint], motion.points});
  }
  if (actor.joints.empty()) return;
  const int end = first + static_cast<int>(names.size());
  const bool is_last = end == m.njnt;
  actor.positions = {m.jnt_qposadr[first], is_last ? static_cast<int>(m.nq) : m.jnt_qposadr[end]};
  actor.velocities = {m.jnt_dofadr[first], is_last ? static_cast<int>(m.nv) : m.jnt_dofadr[end]};
  for (int dof = actor.velocities[0]; dof < actor.velocities[1]; ++dof) {
    m.dof_armature[dof] = kImmovable;
    m.tree_sleep_policy[m.dof_treeid[dof]] = mjSLEEP_NEVER;
  }
  if (names.size() > actor.joints.size()) {
    composed_.frozen.push_back(
        fmt::format("actor '{}' moves {} of {} joints; the others stay at zero", actor.name,
                    actor.joints.size(), names.size()));
  }
}

/// Each body below the root body of a walker, or of a body with joints that an actor moves, carries
/// its geoms with a motion of its own.
void World::find_limbs(int body) {
  const mjModel& m = model_.m();
  const auto object =
      static_cast<int>(std::ranges::find(object_bodies_, body) - object_bodies_.begin());
  for (int limb = body + 1; limb < m.nbody && m.body_rootid[limb] == body; ++limb) {
    for (int i = 0; i < m.body_geomnum[limb]; ++i) {
      carrier_of_geom_[static_cast<std::size_t>(m.body_geomadr[limb] + i)] =
          static_cast<int>(object_bodies_.size());
    }
    object_bodies_.push_back(limb);
    limb_objects_.push_back(object);
  }
}

/// Rejects impossible overlaps at the start. Actors may start inside walls; an actor that only
/// grazes an object gets a warning later.
void World::begin_watch(WrongStart wrong_start) {
  for (const int group : scenario_.camera.groups) groups_[static_cast<std::size_t>(group)] = true;
  const Drawables drawables(model_, groups_, camera_);
  for (int geom = 0; geom < model_.m().ngeom; ++geom) {
    is_drawn_.push_back(drawables.alpha(geom) > 0);
  }
  const std::vector<std::string>& bodies = composed_.actor_bodies;
  const auto actor_of = [&](int object) {
    const std::string& name = objects_[static_cast<std::size_t>(object - 1)].name;
    return std::ranges::find(bodies, name) - bodies.begin();
  };
  std::vector<Watch::Solid> named;
  for (const Object& object : objects_) {
    const auto actor = actor_of(object.id);
    const bool is_actor = actor < std::ssize(bodies);
    Watch::Solid& solid = named.emplace_back();
    solid.kind = is_actor ? Watch::Kind::actor : Watch::Kind::object;
    solid.name = fmt::format("{} '{}'", is_actor ? "actor" : "object", object.name);
    solid.body = body_of(object.id);
    solid.moves = is_actor || model_.m().body_dofnum[solid.body] > 0;
    if (is_actor) solid.size_m = composed_.actor_sizes_m[static_cast<std::size_t>(actor)];
  }
  watch_ = std::make_unique<Watch>(model_, base_, std::move(named), object_of_geom_, is_drawn_);
  note_load();
  note_looks(drawables);
  note_coplanar();
  for (const Watch::Meeting& meeting : watch_->meetings(model_)) {
    const bool is_rover = meeting.traveller == 0;
    const bool is_inside =
        meeting.kind_b != Watch::Kind::setting && meeting.depth_m > kActorInside_m;
    if (!is_rover && !is_inside) continue;
    const input::Error error(
        is_rover ? input::Source{scenario_.file.string(), 0}
                 : scenario_.actors[static_cast<std::size_t>(actor_of(meeting.traveller))].source,
        fmt::format("{}{} starts inside {}, at {}; move one of them", is_rover ? "ego.start: " : "",
                    meeting.a, meeting.b, meeting.where));
    if (wrong_start == WrongStart::refused) throw error;
    wrong_at_start_.emplace_back(error.what());
    watch_->pass_over(meeting);
  }
}

/// Warns of what MuJoCo warned of, and of the scene's options that are replaced.
void World::note_load() {
  for (const std::string& what : composed_.reader.warnings()) {
    warnings().add(Warning::mujoco_warnings, what);
  }
  for (const std::string& what : composed_.frozen) warnings().add(Warning::joints_frozen, what);
  for (const std::string& what : composed_.named) warnings().add(Warning::bodies_named, what);
  for (const std::string& what : composed_.loose_joints) {
    warnings().add(Warning::joints_loose,
                   fmt::format("the rover's joint '{}' is loose: its motor gets no command", what));
  }
  const mjOption& asked = composed_.spec->option;
  const auto replaced = [&](const std::string& what) {
    warnings().add(Warning::options_replaced,
                   input::Error(composed_.reader.source_of_tag("<option>"), what).what());
  };
  if (asked.timestep > kLongestStep_s) {
    replaced(fmt::format("the scene's timestep of {:g} ms is replaced by {:g} ms",
                         1e3 * asked.timestep, 1e3 * kLongestStep_s));
  }
  if (asked.integrator == mjINT_RK4) replaced("the integrator RK4 is replaced by Euler's");
  for (int flag = 0; flag < mjNDISABLE; ++flag) {
    if (!(asked.disableflags & ~model_.m().opt.disableflags & 1 << flag)) continue;
    replaced(fmt::format("the scene disables '{}', which a drive needs; it is enabled",
                         mjDISABLESTRING[flag]));
  }
}

/// Warns of surfaces in one place: of two bodies, or of floors that look different. Other parts of
/// the setting, as notices over each other on a wall, differ in few pixels and in no label.
void World::note_coplanar() {
  const mjModel& m = model_.m();
  const auto cited = [&](int geom) -> std::string {
    const mjsElement* element = nullptr;
    for_each(*composed_.spec, mjOBJ_GEOM, [&](mjsElement* e) {
      if (mjs_getId(e) == geom) element = e;
    });
    return input::Error(composed_.reader.source(element), "geom '{}' of body '{}'",
                        model_.name(mjOBJ_GEOM, geom), model_.name(mjOBJ_BODY, m.geom_bodyid[geom]))
        .what();
  };
  for (const auto& [a, b] : coplanar_geoms(model_, is_drawn_, model_.camera_pose(camera_).p)) {
    const int material = m.geom_matid[a], carrier = carrier_of_geom(a);
    const bool is_plain = material < 0 || m.mat_texid[mjNTEXROLE * material + mjTEXROLE_RGB] < 0;
    const bool looks_alike =
        is_plain && material == m.geom_matid[b] &&
        std::equal(m.geom_rgba + 4 * a, m.geom_rgba + 4 * a + 4, m.geom_rgba + 4 * b);
    const bool is_floor_of_two = carrier == 0 && (is_floor(model_, a) || is_floor(model_, b));
    if (carrier == carrier_of_geom(b) && (!is_floor_of_two || looks_alike)) continue;
    warnings().add(Warning::coplanar_faces,
                   fmt::format("{} and {} have a surface in one place", cited(a), cited(b)));
  }
}

/// Warns of parts that look otherwise than in MuJoCo's own pictures.
void World::note_looks(const Drawables& drawables) {
  const auto warn = [&](Warning warning, mjtObj kind, std::string_view name,
                        const std::string& what) {
    warnings().add(warning, input::Error(composed_.source(kind, name), what).what());
  };
  for (int geom = 0; geom < model_.m().ngeom; ++geom) {
    const float alpha = drawables.alpha(geom);
    if (alpha <= 0 || alpha >= 1 || drawables.is_stain(geom)) continue;
    const std::string_view body = model_.name(mjOBJ_BODY, model_.m().geom_bodyid[geom]);
    const std::string_view name = model_.name(mjOBJ_GEOM, geom);
    warn(Warning::translucent_geoms, name.empty() ? mjOBJ_BODY : mjOBJ_GEOM,
         name.empty() ? body : name,
         fmt::format("a geom of body '{}' has alpha {:g} and is drawn opaque", body, alpha));
  }
  for (const auto& [type, id] : undrawn_parts(model_)) {
    const std::string_view name = model_.name(type, id);
    const int body = type == mjOBJ_SITE ? model_.m().site_bodyid[id] : 0;
    if (body > 0 && model_.m().body_rootid[body] == base_) continue;  // its IMU
    warn(Warning::undrawn_parts, name.empty() ? mjOBJ_BODY : type,
         name.empty() ? model_.name(mjOBJ_BODY, body) : name,
         fmt::format("{} '{}' is not drawn", mju_type2Str(type), name));
  }
}

/// Places an actor `seconds` after its trigger. \return whether it moves.
bool World::place(const MovingActor& actor, double seconds) {
  const mjModel& m = model_.m();
  mjData& d = model_.d();
  bool moves = false;
  std::copy(m.qpos0 + actor.positions[0], m.qpos0 + actor.positions[1],
            d.qpos + actor.positions[0]);
  std::fill(d.qvel + actor.velocities[0], d.qvel + actor.velocities[1], 0);
  for (const MovingJoint& joint : actor.joints) {
    const auto [value, rate] = joint_at(joint.points, seconds);
    d.qpos[joint.position] = value;
    d.qvel[joint.velocity] = rate;
    moves |= rate != 0;
  }
  const int mocap = m.body_mocapid[actor.body];
  if (mocap < 0) return moves;
  const PlanarPose pose = pose_on(actor.trajectory, actor.home, seconds);
  const Eigen::Quaterniond q = about_z(pose.heading_rad) * actor.upright;
  Eigen::Map<Eigen::Vector3d>(d.mocap_pos + 3 * mocap) << pose.position_m, actor.height_m;
  Eigen::Map<Eigen::Vector4d>(d.mocap_quat + 4 * mocap) << q.w(), q.vec();
  if (actor.gait) actor.gait->place(model_.m(), pose.walked_m);
  const Eigen::Map<const Eigen::Vector2d> here(d.xpos + 3 * actor.body);
  return (pose.position_m - here).norm() > kMoves_m;
}

void World::move_actors() {
  const mjData& d = model_.d();
  const Eigen::Map<const Eigen::Vector2d> ego(d.xpos + 3 * base_);
  for (MovingActor& actor : actors_) {
    const Eigen::Map<const Eigen::Vector2d> here(d.xpos + 3 * actor.body);
    const double distance_m = (here - ego).norm();
    actor.nearest_m = std::min(actor.nearest_m, distance_m);
    actor.has_moved |= place(actor, actor.trigger.update(t_ns_, distance_m));
  }
}

void World::guarded(const auto& action) {
  std::string problem;
  try {
    action();
    const std::string warning = take_warning();
    const auto has_met = [&](mjtWarning kind) { return model_.d().warning[kind].number > 0; };
    const bool diverged =
        has_met(mjWARN_BADQPOS) || has_met(mjWARN_BADQVEL) || has_met(mjWARN_BADQACC);
    if (diverged) problem = warning;
    if (!diverged && !warning.empty()) {
      warnings().add(Warning::mujoco_warnings,
                     fmt::format("MuJoCo warns at {:.4f} s: {}", 1e-9 * static_cast<double>(t_ns_),
                                 in_one_line(warning)));
    }
  } catch (const MujocoError& e) {
    problem = e.what();
  }
  if (!problem.empty()) {
    throw PhysicsError(fmt::format("{}: the physics failed at {:.4f} s of simulated time: {}",
                                   scenario_.scene.string(), 1e-9 * static_cast<double>(t_ns_),
                                   in_one_line(problem, body_of_dof(model_, problem))));
  }
}

/// Computes all derived quantities at the present time.
void World::forward() {
  // from the nanosecond count, so that no rounding accumulates
  model_.d().time = 1e-9 * static_cast<double>(t_ns_);
  rover_->command(model_, t_ns_);
  move_actors();
  call_mujoco([&] { mj_forward(&model_.m(), &model_.d()); });
  rover_->accelerate(model_);
}

/// Warns, once, of actors that did not move until the last frame although they should.
void World::end_watch() {
  if (std::exchange(is_watch_over_, true)) return;
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    const MovingActor& actor = actors_[i];
    if (actor.has_moved || scenario_.actors[i].stands()) continue;
    warnings().add(
        Warning::actors_never_moved,
        fmt::format("actor '{}' never moves: its start trigger does not fire within {:.1f} s (the "
                    "rover comes as near as {:.2f} m), or its speed is 0",
                    actor.name, scenario_.frames / scenario_.camera.rate_hz, actor.nearest_m));
  }
}

std::int64_t World::next_event_ns(std::int64_t until_ns) const {
  std::int64_t next = std::min(until_ns, event_time_ns(imu_count_, scenario_.imu.rate_hz));
  if (scenario_.odometry.enabled) {
    next = std::min(next, event_time_ns(odometry_count_, scenario_.odometry.rate_hz));
  }
  for (const scenario::EgoPhase& phase : scenario_.ego.phases) {
    const std::int64_t at = std::llround(phase.at_s * 1e9);
    if (at > t_ns_) next = std::min(next, at);
  }
  return next;
}

void World::step_to(std::int64_t t_ns) {
  const std::int64_t start_ns = t_ns_;
  const std::int64_t span_ns = t_ns - start_ns;
  mjModel& m = model_.m();
  const auto longest_ns =
      std::llround(1e9 * std::min(composed_.spec->option.timestep, kLongestStep_s));
  const std::int64_t steps = (span_ns + longest_ns - 1) / longest_ns;
  m.opt.timestep = 1e-9 * static_cast<double>(span_ns) / static_cast<double>(steps);
  // own count of steps, as MuJoCo resets its time to 0 when it diverges
  for (std::int64_t i = 0; i < steps; ++i) {
    guarded([&] {
      const PlanarVelocity asked = rover_->command(model_, t_ns_);
      move_actors();
      call_mujoco([&] { mj_step(&m, &model_.d()); });
      if (t_ns_ <= event_time_ns(scenario_.frames - 1, scenario_.camera.rate_hz)) {
        watch_->look(model_, t_ns_, is_on_ground() ? std::optional(asked) : std::nullopt);
      } else {
        end_watch();
      }
    });
    t_ns_ = start_ns + span_ns * (i + 1) / steps;
  }
  guarded([&] { forward(); });
}

ImuSample World::ideal_reading() {
  ImuSample reading{t_ns_};
  const Pose T_WS = this->T_WS();
  const Eigen::Vector3d v_WS_mps = this->v_WS_mps();
  const bool is_mean = scenario_.imu.reading == scenario::ImuReading::mean;
  if (is_mean && imu_truth_.t_ns < t_ns_) {
    const double span_s = 1e-9 * static_cast<double>(t_ns_ - imu_truth_.t_ns);
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(imu_truth_.T_WS.R.transpose() * T_WS.R));
    const Eigen::Matrix3d R_middle =
        imu_truth_.T_WS.R * Eigen::AngleAxisd(turn.angle() / 2, turn.axis());
    reading.gyro_radps = turn.angle() / span_s * turn.axis();
    reading.accel_mps2 = R_middle.transpose() * ((v_WS_mps - imu_truth_.v_WS_mps) / span_s +
                                                 gravity_mps2_ * Eigen::Vector3d::UnitZ());
  } else {
    Eigen::Matrix<mjtNum, 6, 1> motion;  // rotation, translation; acceleration includes gravity
    call_mujoco([&] { mj_rnePostConstraint(&model_.m(), &model_.d()); });
    mj_objectAcceleration(&model_.m(), &model_.d(), mjOBJ_SITE, imu_site_, motion.data(), 1);
    reading.accel_mps2 = motion.tail<3>();
    mj_objectVelocity(&model_.m(), &model_.d(), mjOBJ_SITE, imu_site_, motion.data(), 1);
    reading.gyro_radps = motion.head<3>();
  }
  imu_truth_ = {t_ns_, T_WS, v_WS_mps};
  return reading;
}

void World::read_sensors(std::vector<ImuSample>& imu, std::vector<OdometrySample>& odometry,
                         std::vector<ImuTruth>* imu_truth) {
  if (event_time_ns(imu_count_, scenario_.imu.rate_hz) == t_ns_) {
    ++imu_count_;
    // draw noise in a gap, too, so that later readings are as in a run without gaps
    const ImuSample reading = imu_noise_.corrupt(ideal_reading());
    imu_truth_.gyro_bias_radps = imu_noise_.gyro_bias_radps();
    imu_truth_.accel_bias_mps2 = imu_noise_.accel_bias_mps2();
    if (!in_gap(scenario_.imu.gaps, t_ns_)) imu.push_back(reading);
    if (imu_truth) imu_truth->push_back(imu_truth_);
  }
  if (scenario_.odometry.enabled &&
      event_time_ns(odometry_count_, scenario_.odometry.rate_hz) == t_ns_) {
    ++odometry_count_;
    const PlanarVelocity v = rover_->odometry(model_);
    odometry.push_back(odometry_noise_.corrupt(
        {t_ns_, {v.linear_mps.x(), v.linear_mps.y(), 0}, v.yaw_rate_radps}));
  }
}

void World::advance_to(std::int64_t t_ns, std::vector<ImuSample>& imu,
                       std::vector<OdometrySample>& odometry, std::vector<ImuTruth>* imu_truth) {
  read_sensors(imu, odometry, imu_truth);  // the readings at time 0, before the first step
  while (t_ns_ < t_ns) {
    step_to(next_event_ns(t_ns));
    read_sensors(imu, odometry, imu_truth);
  }
}

std::string World::saved(bool as_mjcf) {
  mjModel& m = model_.m();
  const auto keep = [&](int body) {  // its present pose
    const Pose T_PB = model_.body_pose(m.body_parentid[body]).inverse() * model_.body_pose(body);
    const Eigen::Quaterniond q(T_PB.R);
    Eigen::Map<Eigen::Vector3d>(m.body_pos + 3 * body) = T_PB.p;
    Eigen::Map<Eigen::Vector4d>(m.body_quat + 4 * body) << q.w(), q.vec();
  };
  for (const MovingActor& actor : actors_) {
    for (int b = actor.body; b < m.nbody && m.body_rootid[b] == actor.body; ++b) keep(b);
    for (const MovingJoint& joint : actor.joints) {
      m.qpos0[joint.position] = model_.d().qpos[joint.position];
    }
  }
  keep(base_);
  const int joint = m.body_jntadr[base_];
  if (joint >= 0 && m.jnt_type[joint] == mjJNT_FREE) {
    std::copy_n(model_.d().qpos + m.jnt_qposadr[joint], 7, m.qpos0 + m.jnt_qposadr[joint]);
  }
  if (!has_contacts(m)) m.opt.disableflags &= ~mjDSBL_CONTACT;  // for bodies that a user adds
  // MuJoCo writes only to files, and ignores a full disk. This file is in memory.
  const int file = ::memfd_create("world", MFD_CLOEXEC);
  if (file < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  std::array<char, 1000> message{};
  if (as_mjcf) {
    mjSpec* spec = composed_.spec.get();
    call_mujoco([&] {
      mj_copyBack(spec, &m);
      mj_saveXML(spec, path.c_str(), message.data(), static_cast<int>(message.size()));
    });
  } else {
    call_mujoco([&] { mj_saveModel(&m, path.c_str(), nullptr, 0); });
  }
  std::string bytes(static_cast<std::size_t>(std::max<off_t>(::lseek(file, 0, SEEK_END), 0)), '\0');
  const ssize_t read = ::pread(file, bytes.data(), bytes.size(), 0);
  ::close(file);
  const std::string problem = as_mjcf ? message.data() : take_warning();
  if (!problem.empty()) throw MujocoError(problem);
  if (bytes.empty() || read != static_cast<ssize_t>(bytes.size())) {
    throw MujocoError("the world cannot be saved");
  }
  return bytes;
}

Snapshot World::snapshot() const {
  Snapshot s;
  s.T_WC = model_.camera_pose(camera_);
  s.T_WO.reserve(object_bodies_.size());
  for (const int body : object_bodies_) s.T_WO.push_back(model_.body_pose(body));
  return s;
}

ScenePoses World::stage() {
  ScenePoses stage;
  visit_poses(model_.m(), model_.d(), [&](const mjtNum* begin, std::int64_t size) {
    stage.numbers.insert(stage.numbers.end(), begin, begin + size);
  });
  return stage;
}

ScenePoses World::stage_before(std::int64_t t_ns) {
  const mjModel& m = model_.m();
  mjData& d = model_.d();
  const std::vector<mjtNum> qpos(d.qpos, d.qpos + m.nq);
  const auto pose_all = [&] {
    mj_kinematics(&m, &d);
    mj_camlight(&m, &d);
  };
  call_mujoco([&] { mj_integratePos(&m, d.qpos, d.qvel, 1e-9 * static_cast<double>(t_ns)); });
  call_mujoco(pose_all);
  ScenePoses before = stage();
  std::ranges::copy(qpos, d.qpos);
  call_mujoco(pose_all);
  return before;
}

void World::show(const ScenePoses& stage) {
  auto from = stage.numbers.begin();
  visit_poses(model_.m(), model_.d(), [&](mjtNum* begin, std::int64_t size) {
    std::copy_n(from, size, begin);
    from += size;
  });
}

Snapshot World::snapshot_of(const ScenePoses& stage) {
  const ScenePoses present = this->stage();
  show(stage);
  Snapshot snapshot = this->snapshot();
  show(present);
  return snapshot;
}

Eigen::Vector3d World::v_WB_mps() const {
  return velocity(model_, mjOBJ_XBODY, base_).tail<3>();
}
Eigen::Vector3d World::v_WS_mps() const {
  return velocity(model_, mjOBJ_SITE, imu_site_).tail<3>();
}
Eigen::Vector3d World::v_WC_mps() const {
  return velocity(model_, mjOBJ_CAMERA, camera_).tail<3>();
}

Eigen::Vector3d World::w_C_radps() const {
  return model_.camera_pose(camera_).R.transpose() *
         velocity(model_, mjOBJ_CAMERA, camera_).head<3>();
}

}  // namespace lcs::sim
