#include "sim/scene/spec.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>

#include "sim/scene/limits.h"
#include "sim/scene/model.h"

namespace lcs::sim {
namespace {

using xml::Element;

/// Removes settings that would change other bodies, names, or the rover's mass.
void prepare(Element& root, SpecReader::Part part) {
  for (Element* c = root.FirstChildElement("compiler"); c; c = c->NextSiblingElement("compiler")) {
    for (const char* key : {"fusestatic", "discardvisual", "inertiafromgeom", "settotalmass",
                            "boundmass", "boundinertia"}) {
      c->DeleteAttribute(key);
    }
  }
  if (part == SpecReader::Part::fragment) {
    for (const char* kind : {"size", "visual", "statistic"}) {
      while (Element* section = root.FirstChildElement(kind)) root.DeleteChild(section);
    }
    for (Element* o = root.FirstChildElement("option"); o; o = o->NextSiblingElement("option")) {
      const std::string integrator = xml::attribute(*o, "integrator");
      while (o->FirstAttribute()) o->DeleteAttribute(o->FirstAttribute()->Name());
      o->DeleteChildren();
      if (!integrator.empty()) o->SetAttribute("integrator", integrator.c_str());
    }
  }
  check_limits(root);
}

const mjString* info_of(mjsElement* e) {
  const mjString* info = nullptr;
  const auto take = [&](const auto*... kinds) {  // all but one are null
    ((info = kinds ? kinds->info : info), ...);
  };
  take(mjs_asBody(e), mjs_asJoint(e), mjs_asGeom(e), mjs_asSite(e), mjs_asActuator(e),
       mjs_asTendon(e), mjs_asFlex(e), mjs_asSkin(e), mjs_asTexture(e), mjs_asHField(e),
       mjs_asNumeric(e), mjs_asText(e));
  return info;
}

/// The first number after "line " in a text, of the innermost element; 0 without one.
int line_in(std::string_view text) {
  constexpr std::string_view kLine = "line ";
  int line = 0;
  for (std::size_t at = text.find(kLine); at != text.npos && line == 0;
       at = text.find(kLine, at + 1)) {
    std::from_chars(text.data() + at + kLine.size(), text.data() + text.size(), line);
  }
  return line;
}

struct Placed {
  double *pos, *quat;
  mjsOrientation* alt;
};

Placed placed(mjsElement* e) {
  if (mjsBody* body = mjs_asBody(e)) return {body->pos, body->quat, &body->alt};
  if (mjsGeom* geom = mjs_asGeom(e)) return {geom->pos, geom->quat, &geom->alt};
  if (mjsFrame* frame = mjs_asFrame(e)) return {frame->pos, frame->quat, &frame->alt};
  mjsSite* site = mjs_asSite(e);
  return {site->pos, site->quat, &site->alt};
}

Pose pose_in_frame(mjsElement* e) {
  const Placed of = placed(e);
  std::array<double, 4> q{};
  std::copy_n(of.quat, 4, q.begin());
  const mjsCompiler* compiler = mjs_getCompiler(e);
  mjs_resolveOrientation(q.data(), compiler->degree, compiler->eulerseq, of.alt);
  return {Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix(),
          Eigen::Map<const Eigen::Vector3d>(of.pos)};
}

}  // namespace

/// A document's text, from the next free line on.
std::string SpecReader::numbered(Element& root) {
  std::vector<std::pair<std::string, bool>> tags;
  xml::for_each(root, [&](const Element& e) { tags.emplace_back(xml::tag(e), has_endless(e)); });
  const std::vector<input::Source> sources = xml::take_sources(root);
  tinyxml2::XMLPrinter printer;
  root.Accept(&printer);
  std::string text = std::string(static_cast<std::size_t>(lines_), '\n') + printer.CStr();

  tinyxml2::XMLDocument again;  // MuJoCo counts lines with the same parser
  if (again.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw input::Error({sources.front().file, 0},
                       std::string("cannot be read once its parts are put together (") +
                           tinyxml2::XMLDocument::ErrorIDToName(again.ErrorID()) +
                           "); nest its elements less deeply");
  }
  std::size_t i = 0;
  xml::for_each(*again.RootElement(), [&](const Element& e) {
    origins_.emplace(e.GetLineNum(), Origin{sources[i], tags[i].first, tags[i].second});
    ++i;
  });
  lines_ = static_cast<int>(std::ranges::count(text, '\n')) + 1;
  return text;
}

/// Gives the files of <model> elements to MuJoCo.
void SpecReader::add_models(Element& root, Part part, const Edit& edit, mjVFS& vfs, int depth) {
  constexpr int kDeepest = 8, kMost = 100;
  if (edit) edit(root, depth > 0);
  prepare(root, part);
  for (Element* s = root.FirstChildElement("asset"); s; s = s->NextSiblingElement("asset")) {
    for (Element* e = s->FirstChildElement("model"); e; e = e->NextSiblingElement("model")) {
      const input::Source here = xml::source_of(*e);
      if (depth == kDeepest || models_ == kMost) {
        throw input::Error(here, "more models are in each other than a scene has");
      }
      if (!e->Attribute("file")) continue;  // MuJoCo reports it
      const xml::Document model = xml::load(e->Attribute("file"), here);
      add_models(*model->RootElement(), Part::fragment, edit, vfs, depth + 1);
      const std::string text = numbered(*model->RootElement());
      const std::string name = fmt::format("model{}.xml", ++models_);
      if (mj_addBufferVFS(&vfs, name.c_str(), text.data(), static_cast<int>(text.size())) != 0) {
        throw MujocoError("could not allocate a <model>");
      }
      if (!e->Attribute("name")) {
        e->SetAttribute("name", std::filesystem::path(e->Attribute("file")).stem().c_str());
      }
      e->SetAttribute("file", name.c_str());
    }
  }
}

Spec SpecReader::read(const std::filesystem::path& file, const input::Source& where, Part part,
                      const Edit& edit) {
  if (first_file_.empty()) first_file_ = file;
  install_mujoco_handlers();
  mjVFS vfs;
  mj_defaultVFS(&vfs);
  const std::unique_ptr<mjVFS, void (*)(mjVFS*)> guard(&vfs, mj_deleteVFS);
  const xml::Document document = xml::load(file, where);
  add_models(*document->RootElement(), part, edit, vfs, 0);
  const std::string text = numbered(*document->RootElement());
  std::array<char, 2000> said{};
  Spec spec;
  try {
    spec.reset(call_mujoco([&] {
      return mj_parseXMLString(text.c_str(), &vfs, said.data(), static_cast<int>(said.size()));
    }));
  } catch (const MujocoError& e) {
    throw refusal(e.what(), nullptr);
  }
  if (!spec) throw refusal(said.data(), nullptr);
  note_warnings(spec.get());
  return spec;
}

const SpecReader::Origin* SpecReader::at(int line) const {
  const auto found = origins_.find(line);
  return found == origins_.end() ? nullptr : &found->second;
}

const SpecReader::Origin* SpecReader::origin(const mjsElement* element) const {
  if (!element) return nullptr;
  auto* e = const_cast<mjsElement*>(element);
  const mjString* info = info_of(e);
  const Origin* found = info ? at(line_in(mjs_getString(info))) : nullptr;
  // MuJoCo knows no line of a <freejoint>
  return found || e->elemtype != mjOBJ_JOINT ? found : origin(mjs_getParent(e)->element);
}

input::Source SpecReader::source(const mjsElement* element) const {
  const Origin* found = origin(element);
  return found ? found->source : input::Source{first_file_.string(), 0};
}

void SpecReader::refuse(const mjsElement* element, std::string what) const {
  const Origin* found = origin(element);
  constexpr std::string_view kTag = "TAG";
  if (const std::size_t at = what.find(kTag); at != what.npos) {
    what.replace(at, kTag.size(), found ? found->tag : "the element");
  }
  throw input::Error(source(element), what);
}

input::Source SpecReader::source_of_tag(std::string_view tag) const {
  const auto found =
      std::ranges::find_if(origins_, [&](const auto& o) { return o.second.tag == tag; });
  return found == origins_.end() ? source(nullptr) : found->second.source;
}

/// The element that a message of MuJoCo cites by its line, or else by its name in quotes.
const SpecReader::Origin* SpecReader::origin_in(const std::string& said, const mjSpec* spec) const {
  const Origin* found = at(line_in(said));
  const bool is_endless = said.find("is not finite") != said.npos;  // of `check_compiled`
  for (const auto& [line, of] : origins_) {
    if (!found && is_endless && of.has_endless) found = &of;
  }
  std::size_t end = 0;
  for (std::size_t begin = said.find('\''); !found && begin != said.npos;
       begin = said.find('\'', end + 1)) {
    end = std::min(said.find('\'', begin + 1), said.size());
    const std::string name = said.substr(begin + 1, end - begin - 1);
    for (int type = mjOBJ_BODY; spec && !found && !name.empty() && type < mjNOBJECT; ++type) {
      found = origin(find(*spec, static_cast<mjtObj>(type), name));
    }
    const std::string named = fmt::format(" name=\"{}\">", name);  // as in URDF, without lines
    const auto tagged = std::ranges::find_if(
        origins_, [&](const auto& o) { return o.second.tag.ends_with(named); });
    if (!found && tagged != origins_.end()) found = &tagged->second;
  }
  return found;
}

input::Error SpecReader::refusal(const std::string& said, const mjSpec* spec,
                                 std::string_view verb) const {
  const Origin* found = origin_in(said, spec);
  return {
      found ? found->source : source(nullptr),
      fmt::format("MuJoCo {} {}: {}", verb, found ? found->tag : "the scene", in_one_line(said))};
}

void SpecReader::note_warnings(const mjSpec* spec) {
  std::vector<std::string> said{take_warning()};
  for (int i = 0; i < mjs_numWarnings(spec); ++i) said.emplace_back(mjs_getWarning(spec, i));
  for (const std::string& warning : said) {
    if (warning.empty()) continue;
    const std::string line = refusal(warning, spec, "warns of").what();
    if (std::ranges::find(warnings_, line) == warnings_.end()) warnings_.push_back(line);
  }
}

std::string_view name_of(const mjsElement* element) {
  return mjs_getString(mjs_getName(const_cast<mjsElement*>(element)));
}

mjsElement* find(const mjSpec& spec, mjtObj type, std::string_view name) {
  return mjs_findElement(&spec, type, std::string(name).c_str());
}

void remove(mjSpec& spec, mjsElement* element) {
  const std::string name(name_of(element));
  const auto is_it = [&](int type, const mjString* of) {
    return type == element->elemtype && !name.empty() && mjs_getString(of) == name;
  };
  for_each(spec, mjOBJ_ACTUATOR, [&](mjsElement* e) {
    const mjsActuator& a = *mjs_asActuator(e);
    const bool is_of_joint = a.trntype == mjTRN_JOINT || a.trntype == mjTRN_JOINTINPARENT;
    if (is_it(is_of_joint                 ? mjOBJ_JOINT
              : a.trntype == mjTRN_TENDON ? mjOBJ_TENDON
                                          : mjOBJ_UNKNOWN,
              a.target)) {
      remove(spec, e);
    }
  });
  for_each(spec, mjOBJ_SENSOR, [&](mjsElement* e) {
    const mjsSensor& s = *mjs_asSensor(e);
    if (is_it(s.objtype, s.objname) || is_it(s.reftype, s.refname)) mjs_delete(&spec, e);
  });
  for_each(spec, mjOBJ_EQUALITY, [&](mjsElement* e) {
    const mjsEquality& q = *mjs_asEquality(e);
    const int type = q.type == mjEQ_JOINT    ? mjOBJ_JOINT
                     : q.type == mjEQ_TENDON ? mjOBJ_TENDON
                                             : q.objtype;
    if (is_it(type, q.name1) || is_it(type, q.name2)) mjs_delete(&spec, e);
  });
  for_each(spec, mjOBJ_TENDON, [&](mjsElement* e) {
    const mjsTendon* tendon = mjs_asTendon(e);
    for (int i = 0; i < mjs_getWrapNum(tendon); ++i) {
      if (mjs_getWrapTarget(mjs_getWrap(tendon, i)) != element) continue;
      remove(spec, e);
      return;
    }
  });
  mjs_delete(&spec, element);
}

Pose pose_in_body(const mjsElement* element) {
  auto* e = const_cast<mjsElement*>(element);
  Pose pose = pose_in_frame(e);
  for (mjsFrame* frame = mjs_getFrame(e); frame; frame = mjs_getFrame(frame->element)) {
    pose = pose_in_frame(frame->element) * pose;
  }
  return pose;
}

void set_pose_in_body(mjsElement* element, const Pose& pose, const Eigen::Vector3d& scale,
                      const Eigen::Matrix3d& axes) {
  mjsFrame* frame = mjs_addFrame(mjs_getParent(element), nullptr);
  const Eigen::Quaterniond q(axes), q_in_frame(axes.transpose() * pose.R);
  Eigen::Map<Eigen::Vector3d>(frame->pos) = pose.p;
  Eigen::Map<Eigen::Vector4d>(frame->quat) << q.w(), q.vec();
  Eigen::Map<Eigen::Vector3d>(frame->scale) = scale;
  frame->scaling = mjSCALING_GEOMETRY;
  const Placed of = placed(element);
  mjs_defaultOrientation(of.alt);
  std::fill_n(of.pos, 3, 0.0);
  Eigen::Map<Eigen::Vector4d>(of.quat) << q_in_frame.w(), q_in_frame.vec();
  mjs_setFrame(element, frame);
}

}  // namespace lcs::sim
