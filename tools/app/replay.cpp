#include "tools/app/replay.h"

#include <algorithm>

#include "scenarios/input/document.h"
#include "scenarios/load.h"
#include "tools/files/csv.h"

namespace lcs::app {
namespace {

using input::Value;

constexpr std::string_view kTopics = "topics.";

Value scalar(const std::string& flag, const std::string& text) {
  return {Value::Kind::scalar, {flag, 0}, text};
}

Value list_of(const std::string& flag, const std::string& text) {
  Value list(Value::Kind::list, {flag, 0});
  for (const std::string_view item : files::fields_of(text)) {
    list.items.push_back(scalar(flag, std::string(item)));
  }
  return list;
}

/// The type of a key's value; "" for one without an option.
std::string_view type_of(std::string_view key) {
  const auto found = std::ranges::find(recording_keys(), key, &RecordingKey::key);
  return found == recording_keys().end() ? "" : found->type;
}

/// The options as a scenario document.
Value document_of(const ReplayRequest& request) {
  const input::Source command{"lcs replay", 0};
  Value root(Value::Kind::map, command);
  input::set(root, "recording", {Value::Kind::map, {request.path, 0}}, command);
  input::set(root, "recording.path", {Value::Kind::scalar, command, request.path}, command);
  for (const auto& [key, text] : request.recording) {
    const std::string flag = flag_of(key);
    const bool is_list = type_of(key).find(',') != std::string_view::npos;
    const Value value = is_list ? list_of(flag, text) : scalar(flag, text);
    if (key == "equidistant") {
      input::set(root, "recording.distortion", {Value::Kind::map, {flag, 0}}, {flag, 0});
      input::set(root, "recording.distortion.equidistant", value, {flag, 0});
    } else {
      input::set(root, "recording." + key, value, {flag, 0});
    }
  }
  const auto set_given = [&](const char* key, const std::string& flag, const std::string& text) {
    if (!text.empty()) input::set(root, key, scalar(flag, text), {flag, 0});
  };
  set_given("ego_motion", "--ego-motion", request.ego_motion);
  set_given("corners.from", "--corners", request.corners);
  set_given("corners.threshold", "--fast-threshold", request.fast_threshold);
  set_given("filter.preset", "--preset " + request.preset, request.preset);
  for (const std::string& setting : request.sets) {
    const auto [key, value] = key_and_value(setting);
    input::set(root, "filter." + key, scalar("--set " + setting, value), {"--set " + setting, 0});
  }
  return root;
}

/// The name of the recording's folder, or of its video without the extension.
std::string name_of(const fs::path& path) {
  // A path with a trailing slash has an empty filename.
  const fs::path whole = fs::absolute(path).lexically_normal();
  const fs::path last = whole.has_filename() ? whole : whole.parent_path();
  return (fs::is_directory(last) ? last.filename() : last.stem()).string();
}

/// Makes all paths absolute, because a scenario's paths are relative to its file.
void make_absolute(Value& recording) {
  for (input::Entry& entry : recording.entries) {
    const bool is_path = entry.key == "path" || type_of(entry.key) == "FILE";
    if (is_path) entry.value.text = fs::absolute(entry.value.text).lexically_normal();
  }
}

}  // namespace

std::string flag_of(const std::string& key) {
  std::string flag = "--" + key;
  if (key.starts_with(kTopics)) {
    flag = "--" + key.substr(kTopics.size()) + (key.ends_with("world") ? "-frame" : "-topic");
  }
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

void write_scenario(const ReplayRequest& request, const fs::path& path,
                    files::Overwrite overwrite) {
  Value document = document_of(request);
  scenario::load(document, "");  // throws for wrong values
  files::Output file(path, overwrite);
  for (input::Entry& entry : document.entries) {
    if (entry.key == "recording") make_absolute(entry.value);
  }
  files::write_file(file.staging(), input::yaml_text(document) + "\n");
  file.commit();
}

RunMade replay(const ReplayRequest& request, Caller& caller) {
  scenario::Scenario scenario = scenario::load(document_of(request), "");
  RunRequest run = request.run;
  scenario.name = name_of(run.out.empty() ? request.path : run.out);
  run.command = arguments_of(request);
  return run_scenario(run, std::move(scenario), caller);
}

}  // namespace lcs::app
