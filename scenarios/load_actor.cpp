#include "scenarios/load_actor.h"

#include <algorithm>

#include "scenarios/quantities.h"
#include "scenarios/scenes.h"

namespace lcs::scenario {
namespace {

Still read_still(Reader reader) {
  Still still;
  reader.read("position", kPosition, still.position_m);
  reader.read("heading", kAngle, still.heading_rad);
  reader.finish();
  return still;
}

Line read_line(Reader reader) {
  Line line;
  reader.read("from", kPosition, line.from_m);
  reader.read("heading", kAngle, line.heading_rad);
  reader.require("speed");
  reader.read("speed", kSpeed, line.speed_mps);
  reader.read("acceleration", kAcceleration, line.acceleration_mps2);
  reader.finish();
  return line;
}

Circular read_circle(Reader reader) {
  Circular circle;
  for (const char* key : {"centre", "radius", "speed"}) reader.require(key);
  reader.read("centre", kPosition, circle.centre_m);
  reader.read("radius", kDistance, circle.radius_m);
  reader.read("start_angle", kAngle, circle.start_angle_rad);
  reader.read("speed", kSignedSpeed, circle.speed_mps);
  reader.finish();
  return circle;
}

Trajectory read_trajectory(const Value& value, const std::string& path) {
  Reader reader(value, path);
  const auto kind = reader.exactly_one_of({"still", "line", "waypoints", "circle"});
  reader.finish();
  const Value& inner = *reader.find(*kind);
  const std::string inner_path = reader.path_of(*kind);
  if (kind == "still") return read_still({inner, inner_path});
  if (kind == "line") return read_line({inner, inner_path});
  if (kind == "circle") return read_circle({inner, inner_path});
  return read_waypoints(inner, inner_path);
}

/// A body of the scene has a place to begin at, an added shape has none.
void require_place(const Actor& actor, const std::string& path) {
  const auto* still = std::get_if<Still>(&actor.trajectory);
  const auto* line = std::get_if<Line>(&actor.trajectory);
  std::string missing;
  if (still && !still->position_m) missing = "still.position";
  if (line && !line->heading_rad) missing = "line.heading";
  if (line && !line->from_m) missing = "line.from";
  if (missing.empty()) return;
  throw Error(actor.source, path + " has a shape of its own and so needs trajectory." + missing +
                                "; add it (only a body of the scene has a place there)");
}

StartTrigger read_start(Reader reader) {
  StartTrigger start;
  reader.read("time", kTime, start.at_s);
  reader.read("ego_within", kDistance, start.ego_within_m);
  reader.finish();
  return start;
}

/// The name of a procedural texture stays as it is; a picture becomes the path of a file that
/// exists.
std::string read_texture(const Value& value, const std::string& path,
                         const std::filesystem::path& folder) {
  const std::string& text = as_text(value, path);
  if (!text.ends_with(".png")) return text;
  return file_beside(value, folder, path + ": there is no picture ").string();
}

void read_shape(Reader& reader, const std::filesystem::path& folder, Actor& actor) {
  if (const auto file = own_file(reader, "shape", folder)) {
    actor.shape = Shape::own;
    actor.shape_file = *file;
  } else {
    actor.shape = static_cast<Shape>(
        *reader.choice("shape", {"box", "cylinder", "pedestrian", "car"}, kOwnFile));
  }
  reader.read("size", kSize, actor.size_m);
  if (const Value* texture = reader.find("texture")) {
    actor.texture = read_texture(*texture, reader.path_of("texture"), folder);
  }
}

void read_body(Reader& reader, Actor& actor) {
  reader.read("body", actor.body.emplace());
  for (const char* key : {"size", "texture"}) {
    const Value* value = reader.find(key);
    if (!value) continue;
    throw Error(value->where, reader.path_of(key) +
                                  " is given for a body of the scene, which has its own; "
                                  "remove it, or give 'shape' in place of 'body'");
  }
}

/// Names become names of bodies in the world and parts of `--set` paths.
void check_name(const Entry& entry) {
  const auto is_name_char = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  if (entry.key == "ego") {
    throw Error(entry.where, "an actor is called 'ego', which is the rover's name; rename it");
  }
  if (std::all_of(entry.key.begin(), entry.key.end(), is_name_char)) return;
  throw Error(entry.where,
              "the actor's name '" + entry.key +
                  "' has other characters than letters, digits, '_' and '-'; rename it");
}

}  // namespace

Waypoints read_waypoints(const Value& value, const std::string& path) {
  Waypoints waypoints;
  for (const Value& item : as_list(value, path)) {
    const std::string item_path = path + "." + std::to_string(waypoints.points.size());
    const std::vector<Value>& triple = as_list(item, item_path, 3);
    const Waypoint point{as_quantity(triple[0], item_path + ".0", kTime),
                         {as_quantity(triple[1], item_path + ".1", kPosition),
                          as_quantity(triple[2], item_path + ".2", kPosition)}};
    if (!waypoints.points.empty() && point.at_s <= waypoints.points.back().at_s) {
      throw Error(item.where, item_path + " is at '" + triple[0].text +
                                  "', not after the one before; make the times increase");
    }
    waypoints.points.push_back(point);
  }
  if (waypoints.points.size() < 2) {
    throw Error(value.where, path + " has fewer than two waypoints; give two or more [time, x, y]");
  }
  return waypoints;
}

Actor read_actor(const Entry& entry, const std::filesystem::path& folder) {
  check_name(entry);
  Actor actor;
  actor.name = entry.key;
  actor.source = entry.where;
  Reader reader(entry.value, "actors." + entry.key);

  const auto kind = reader.exactly_one_of({"shape", "body"});
  if (kind == "shape") read_shape(reader, folder, actor);
  if (kind == "body") read_body(reader, actor);
  const Value* trajectory = reader.require("trajectory");
  if (const Value* start = reader.find("start")) {
    actor.start = read_start({*start, reader.path_of("start")});
  }
  for (const char* key : {"size", "texture"}) reader.find(key);  // known, if for shapes alone
  reader.finish();

  actor.trajectory = read_trajectory(*trajectory, reader.path_of("trajectory"));
  if (!actor.body) require_place(actor, reader.path());
  return actor;
}

}  // namespace lcs::scenario
