#include "tools/replay/recorded.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace lcs::replay {

void Tally::add(const std::string& what, const std::string& example, int count) {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.what == what; });
  if (found == entries_.end()) {
    entries_.push_back({what, example, count});
  } else {
    found->count += count;
  }
}

std::vector<std::string> Tally::lines() const {
  std::vector<std::string> lines;
  for (const Entry& entry : entries_) {
    lines.push_back(fmt::format("{} {} (the first: {})", entry.count, entry.what, entry.example));
  }
  return lines;
}

const std::vector<Layout>& layouts() {
  static const std::vector<Layout> kLayouts{
      {"euroc", "mav0/cam0, imu0 (EuRoC ASL; sequences of lcs generate)", is_euroc, read_euroc},
      {"kitti", "image_0X, oxts: a drive of KITTI raw; calibration in the folder above", is_kitti,
       read_kitti},
      {"robotcar", "stereo or mono_*, gps/ins.csv (Oxford RobotCar); needs --focal", is_robotcar,
       read_robotcar},
      {"pictures", "a folder of pictures, with --fps and --speed or --imu", is_pictures,
       read_pictures},
  };
  return kLayouts;
}

const Layout& layout_of(const std::string& name, const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) {
    throw std::runtime_error(
        fmt::format("{} is no folder; name that of a recording", folder.string()));
  }
  std::string names;
  for (const Layout& layout : layouts()) {
    if (name == layout.name || (name == "auto" && layout.fits(folder))) return layout;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", layout.name);
  }
  if (name != "auto") {
    throw std::runtime_error(fmt::format("no layout is called '{}'; there are {}", name, names));
  }
  throw std::runtime_error(fmt::format(
      "{} holds no pictures, and none of the other layouts that are known ({}); see lcs "
      "replay --help",
      folder.string(), names));
}

void put_in_order(std::vector<RecordedFrame>& frames, const std::filesystem::path& list,
                  Tally& tally) {
  const auto earlier = [](const RecordedFrame& a, const RecordedFrame& b) {
    return a.t_ns < b.t_ns;
  };
  if (!std::is_sorted(frames.begin(), frames.end(), earlier)) {
    tally.add("lists of pictures are not in the order of time and are sorted",
              frames.front().picture.parent_path().string());
    std::stable_sort(frames.begin(), frames.end(), earlier);
  }
  const auto twice =
      std::unique(frames.begin(), frames.end(),
                  [](const RecordedFrame& a, const RecordedFrame& b) { return a.t_ns == b.t_ns; });
  if (twice != frames.end()) {
    tally.add("pictures have the time of another one and are left out",
              twice->picture.filename().string(), static_cast<int>(frames.end() - twice));
  }
  frames.erase(twice, frames.end());
  if (frames.empty()) {
    throw scenario::Error({list.string(), 0},
                          "lists no picture with a time; give a row for each picture");
  }
}

void keep_within(std::int64_t first_ns, std::int64_t last_ns, const char* what,
                 Recorded& recorded) {
  std::vector<RecordedFrame>& frames = recorded.frames;
  const auto is_outside = [&](const RecordedFrame& frame) {
    return frame.t_ns < first_ns || frame.t_ns > last_ns;
  };
  const auto first = std::find_if(frames.begin(), frames.end(), is_outside);
  if (first == frames.end()) return;
  const std::string example = first->picture.filename().string();
  const auto count = std::erase_if(frames, is_outside);
  recorded.tally.add(what, example, static_cast<int>(count));
  if (frames.empty()) {
    throw std::runtime_error(
        "no picture was taken while the sensors recorded; give both the times of one clock");
  }
}

void move_by_navigation(std::vector<NavigationState> states, const sim::Pose& T_BC,
                        Recorded& recorded) {
  const auto earlier = [](const auto& a, const auto& b) { return a.t_ns < b.t_ns; };
  if (!std::is_sorted(states.begin(), states.end(), earlier)) {
    recorded.tally.add("tables are not in the order of time and are sorted", "the navigation's");
    std::stable_sort(states.begin(), states.end(), earlier);
  }
  const auto twice = std::unique(states.begin(), states.end(),
                                 [](const auto& a, const auto& b) { return a.t_ns == b.t_ns; });
  if (twice != states.end()) {
    recorded.tally.add("states of the navigation have the time of another one and are left out",
                       fmt::format("at {} ns", twice->t_ns),
                       static_cast<int>(states.end() - twice));
  }
  states.erase(twice, states.end());
  auto motion = std::make_unique<NavigationMotion>(std::move(states), T_BC);
  keep_within(motion->first_ns(), motion->last_ns(),
              "pictures are outside of the navigation's time and are left out", recorded);
  recorded.motion = std::move(motion);
}

}  // namespace lcs::replay
