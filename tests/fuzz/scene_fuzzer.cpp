// A scene's MJCF, combined with a rover, an actor and rough ground: it is loaded and driven in
// briefly, or refused by an error of one line that begins with a file's name.
#include <tinyxml2.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>
#include <vector>

#include "scenarios/scenes.h"
#include "sim/camera/lens_renderer.h"
#include "sim/world/world.h"
#include "tests/fuzz/input.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size)
    __attribute__((weak));

namespace {

using namespace lcs;
namespace fs = std::filesystem;

/// Well-formed files of each kind, which the scenes of the corpus name.
const fs::path& scene_folder() {
  static const fs::path folder = [] {
    fs::path made = fuzz::work_folder() / "scene";
    fs::create_directories(made);
    fuzz::write_file(made / "m.obj",
                     "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    fuzz::write_file(made / "i.xml", "<mujoco><geom name='in' size='.1'/></mujoco>");
    cv::imwrite((made / "t.png").string(), cv::Mat3b(8, 8, cv::Vec3b(9, 99, 199)));
    return made;
  }();
  return folder;
}

scenario::Scenario scenario_in(const fs::path& scene, std::size_t choice) {
  scenario::Scenario s;
  s.name = "fuzz";
  s.file = fuzz::work_folder() / "fuzz.yaml";
  s.scene = scene;
  s.scene_source = {s.file.string(), 1};
  s.frames = 1;
  s.ego.phases = {{.speed_mps = 0.5}};
  if (choice % 2 == 1) s.ego.drive = scenario::Drive::wheeled;
  if (choice % 4 == 3) s.ground = scenario::RoughGround{};
  scenario::Actor actor;
  actor.name = "actor";
  actor.source = {s.file.string(), 2};
  actor.trajectory =
      scenario::Line{.from_m = Eigen::Vector2d(3, 1), .heading_rad = 0, .speed_mps = 1};
  s.actors = {actor};
  return s;
}

void drive(const scenario::Scenario& s, bool looks) {
  sim::World world(s);
  std::vector<sim::ImuSample> imu;
  std::vector<sim::OdometrySample> odometry;
  if (looks) {
    sim::LensRenderer renderer(world.model(), world.camera_id(),
                               sim::Pinhole::from_fovy(64, 48, 1));
    cv::Mat3f light;
    cv::Mat1f depth;
    cv::Mat1i geoms;
    renderer.update();
    renderer.render_light(light);
    renderer.render_depth_and_geoms(depth, geoms);
  }
  world.advance_to(50'000'000, imu, odometry);
}

/// A change that keeps the document well-formed.
class Mutation {
 public:
  Mutation(tinyxml2::XMLDocument& document, unsigned seed) : document_(document), random_(seed) {
    if (tinyxml2::XMLElement* root = document.RootElement()) collect(*root);
  }

  void apply() {
    using tinyxml2::XMLElement;
    if (elements_.empty()) return;
    XMLElement& e = *one_of(elements_);
    switch (below(10)) {
      case 0:
        return e.SetAttribute(some_key().c_str(), some_value().c_str());
      case 1:
        return e.SetAttribute(some_key().c_str(), one_of(values_).c_str());
      case 2:
      case 3:
      case 4:
        return change_word(e);
      case 5:
        if (e.FirstAttribute()) e.DeleteAttribute(std::string(e.FirstAttribute()->Name()).c_str());
        return;
      case 6:
        if (&e != document_.RootElement()) e.Parent()->DeleteChild(&e);
        return;
      case 7:
        e.Parent()->InsertAfterChild(&e, e.DeepClone(&document_));
        return;
      case 8:
        one_of(elements_)->InsertEndChild(e.DeepClone(&document_));
        return;
      default:
        e.SetName(std::string(one_of(elements_)->Name()).c_str());
    }
  }

 private:
  void collect(tinyxml2::XMLElement& e) {
    elements_.push_back(&e);
    for (const auto* a = e.FirstAttribute(); a; a = a->Next()) {
      keys_.emplace_back(a->Name());
      values_.emplace_back(a->Value());
    }
    for (auto* c = e.FirstChildElement(); c; c = c->NextSiblingElement()) collect(*c);
  }
  std::size_t below(std::size_t n) { return random_() % n; }
  template <typename T>
  T one_of(const std::vector<T>& all) {
    return all.empty() ? T{} : all[below(all.size())];
  }
  std::string some_key() {
    static const std::vector<std::string> kKeys = {
        "size", "pos",  "mass",  "type",   "class", "name",  "file",   "builtin", "width", "mesh",
        "dim",  "nrow", "count", "vertex", "face",  "scale", "extent", "nstack",  "user",  "range"};
    return below(2) == 0 && !keys_.empty() ? one_of(keys_) : one_of(kKeys);
  }
  std::string some_value() {
    static const std::vector<std::string> kValues = {
        "0",     "-1",         "1",           "1e-300",      "1e300", "nan",
        "inf",   "2147483647", "65536",       "-2147483648", "1e6",   "4294967296",
        "",      "abc",        "1e-9",        "0 0 0",       "1 1",   "true",
        "m.obj", "t.png",      "0 0 0 0 0 0", "../..",       "%s%n",  "1 2 3 4 5 6 7",
        "3",     "100",        "1000",        "20000",       "0.5",   "free",
        "plane", "mesh"};
    return one_of(kValues);
  }
  void change_word(tinyxml2::XMLElement& e) {
    std::vector<std::string> keys;
    for (const auto* a = e.FirstAttribute(); a; a = a->Next()) keys.emplace_back(a->Name());
    if (keys.empty()) return;
    const std::string key = one_of(keys);
    std::string text = e.Attribute(key.c_str());
    const std::size_t at = below(text.size() + 1);
    const std::size_t begin = std::min(text.rfind(' ', at) + 1, text.size());  // npos + 1 is 0
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    text.replace(begin, end - begin, some_value());
    e.SetAttribute(key.c_str(), text.c_str());
  }

  tinyxml2::XMLDocument& document_;
  std::minstd_rand random_;
  std::vector<tinyxml2::XMLElement*> elements_;
  std::vector<std::string> keys_, values_;
};

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  tinyxml2::XMLDocument document;
  const std::string_view text = fuzz::text_of(data, size);
  if (seed % 32 == 0 || document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    return LLVMFuzzerMutate ? LLVMFuzzerMutate(data, size, max_size) : size;
  }
  for (unsigned i = 0; i <= seed % 3; ++i) Mutation(document, seed + i).apply();
  tinyxml2::XMLPrinter printer(nullptr, true);
  document.Print(&printer);
  const std::size_t printed = static_cast<std::size_t>(printer.CStrSize()) - 1;
  if (printed > max_size) return size;
  std::copy_n(printer.CStr(), printed, data);
  return printed;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fs::path scene = scene_folder() / "scene.xml";
  fuzz::write_file(scene, fuzz::text_of(data, size));
  std::size_t sum = 0;
  for (std::size_t i = 0; i < size; ++i) sum += data[i];
  std::string said;
  try {
    drive(scenario_in(scene, sum), sum % 16 < 4);
  } catch (const input::Error& error) {
    said = error.what();
    const bool is_own = said.starts_with(fuzz::work_folder().string());
    if (!is_own && !said.starts_with(scenario::scenes_folder().string())) {
      fuzz::fail("an error begins with a file: " + said);
    }
  } catch (const sim::PhysicsError& error) {
    said = error.what();
  }
  if (said.find('\n') != std::string::npos) fuzz::fail("an error is one line: " + said);
  return 0;
}
