#include "tools/replay/recorded.h"

#include <numeric>
#include <ranges>

#include "scenarios/input/inputs_read.h"

namespace lcs::replay {

void Tally::add(const std::string& what, const std::string& example, int count) {
  const auto found = std::ranges::find(entries_, what, &Entry::what);
  if (found == entries_.end()) {
    entries_.push_back({what, example, count});
  } else {
    found->count += count;
  }
}

std::vector<std::string> Tally::lines() const {
  std::vector<std::string> lines = remarks_;
  for (const Entry& entry : entries_) {
    lines.push_back(fmt::format("{} {} (the first: {})", entry.count, entry.what, entry.example));
  }
  return lines;
}

void require_one_clock(const std::vector<std::int64_t>& t_ns, const std::string& source) {
  constexpr std::size_t kLeastRows = 10;  // in a part; fewer are late
  std::vector<std::pair<std::int64_t, std::size_t>>
      parts;  // the time, and how often the clock fell before
  std::size_t first_fall = 0, falls = 0, changes = 0, distinct = 0;
  for (std::size_t i = 0; i < t_ns.size(); ++i) {
    if (i > 0 && t_ns[i] < t_ns[i - 1] && falls++ == 0) first_fall = i;
    parts.emplace_back(t_ns[i], falls);
  }
  std::ranges::stable_sort(parts, {}, [](const auto& part) { return part.first; });
  for (std::size_t i = 1; i < parts.size(); ++i) {
    changes += parts[i].second != parts[i - 1].second;
    distinct += parts[i].first != parts[i - 1].first;
  }
  if (falls > 0 && falls <= 1 + t_ns.size() / kLeastRows && changes > 2 * (falls + 1)) {
    refuse({source},
           "its clock falls back from {} to {} ns, and its times after that are among those "
           "before; give the rows before or after that alone",
           t_ns[first_fall - 1], t_ns[first_fall]);
  }
  if (10 * (distinct + 1) >= t_ns.size()) return;
  refuse({source},
         "only {} of its {} times differ, as if a spreadsheet had rounded them; write them with "
         "all their digits",
         distinct + 1, t_ns.size());
}

std::string RecordedFrame::name() const {
  return picture.empty() ? fmt::format("picture {}", number) : picture.filename().string();
}

const std::vector<RecordingLayout>& layouts() {
  static const std::vector<RecordingLayout> kLayouts{
      {"euroc", "mav0/cam0, imu0 (EuRoC ASL; sequences of lcs generate)", is_euroc, read_euroc,
       true},
      {"kitti", "image_0X, oxts: a drive of KITTI raw; calibration in the folder above", is_kitti,
       read_kitti, true},
      {"kitti_odometry", "image_X, calib.txt, times.txt, poses.txt: a sequence of KITTI odometry",
       is_kitti_odometry, read_kitti_odometry, true},
      {"kitti_tracking", "image_02/NNNN, calib/NNNN.txt, oxts, label_02: of KITTI tracking",
       is_kitti_tracking, read_kitti_tracking, true},
      {"kitti_360", "data_2d_raw/DRIVE/image_00: a drive of KITTI-360", is_kitti_360,
       read_kitti_360, true},
      {"robotcar", "stereo or mono_*, gps/ins.csv (Oxford RobotCar); needs focal", is_robotcar,
       read_robotcar, true},
      {"tum_rgbd", "rgb.txt, groundtruth.txt (TUM RGB-D); needs focal", is_tum_rgbd, read_tum_rgbd},
      {"rpg_events", "events.txt, images.txt, calib.txt, groundtruth.txt (RPG's event camera)",
       is_rpg_events, read_rpg_events},
      {"listed", "times.txt or images.txt beside pictures (TUM-mono, 4Seasons, UZH-FPV)", is_listed,
       read_listed},
      {"mot", "seqinfo.ini, img1 (MOTChallenge); needs a motion and focal", is_mot, read_mot},
      {"bag", "a ROS 1 bag, a rosbag2 (.db3) or an .mcap; needs its topics and PyPI's rosbags",
       is_bag, read_bag},
      {"video", "a file that FFmpeg reads, as .mp4 or .avi; needs a motion and focal", is_video,
       read_video},
      {"pictures", "a folder of pictures; needs fps, a motion and focal", is_pictures,
       read_pictures},
  };
  return kLayouts;
}

const RecordingLayout& layout_of(const RecordingSource& asked) {
  input::note_input(asked.path);
  for (const RecordingLayout& layout : layouts()) {
    if (asked.format.empty() ? layout.fits(asked.path) : asked.format == layout.name) return layout;
  }
  refuse(asked.source,
         "{} holds no pictures, and is none of the other layouts that are known ({}); "
         "tools/replay/README.md says what each holds; {}",
         asked.path.string(),
         fmt::join(layouts() | std::views::transform(&RecordingLayout::name), ", "), kNeutralWay);
}

bool motion_is_asked(const RecordingSource& asked) {
  return asked.poses || asked.imu || (asked.speed_mps && asked.topics.imu.empty());
}

void take_pictures(const fs::path& folder, const std::string& time_unit, Recorded& recorded) {
  OrderedPictures pictures = in_order(pictures_in(folder), time_unit);
  if (!time_unit.empty()) recorded.took.insert("time_unit");
  recorded.timed = !pictures.t_ns.empty();
  recorded.frames.clear();
  for (std::size_t i = 0; i < pictures.files.size(); ++i) {
    recorded.frames.push_back(
        {recorded.timed ? pictures.t_ns[i] : 0, std::move(pictures.files[i]), i});
  }
  if (recorded.timed) put_in_order(recorded.frames, folder, recorded.tally);
  number_frames(recorded, recorded.timed);
}

void number_frames(Recorded& recorded, bool are_times) {
  PictureNumbers& all = recorded.numbers;
  all.pictures = recorded.frames.size();
  std::vector<fs::path> files;
  for (const RecordedFrame& frame : recorded.frames) files.push_back(frame.picture);
  const std::vector<std::size_t> numbers = numbers_in(files);
  if (are_times || numbers.empty()) return;
  const auto [least, greatest] = std::ranges::minmax(numbers);
  all.least = least;
  all.greatest = greatest;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    recorded.frames[i].named = numbers[i];
    all.step = std::gcd(all.step, numbers[i] - least);
  }
  if (greatest - least >= 2 * all.pictures * all.step) all.step = 0;
  if (greatest == least) all.step = 1;
}

void take_rows(const fs::path& table, std::size_t rows, const char* what, Recorded& recorded,
               const std::function<bool(RecordedFrame&, std::size_t)>& use) {
  const PictureNumbers& all = recorded.numbers;
  if (all.pictures == 0) number_frames(recorded, false);
  std::optional<std::size_t> first;
  if (rows != all.pictures && all.least) {
    const bool ends_with_last = *all.least > 1 && *all.greatest + 1 == rows;
    first = *all.least == 0 || all.first ? all.begin()
            : *all.greatest == rows      ? std::optional(1UL)
            : ends_with_last             ? std::optional(0UL)
                                         : std::nullopt;
  }
  std::size_t found = 0;
  std::string used;
  if (rows == all.pictures || first) {
    std::erase_if(recorded.frames, [&](RecordedFrame& frame) {
      const std::size_t row = first ? *frame.named - *first : frame.number;  // may wrap: no row
      if (row >= rows) {
        recorded.tally.add(fmt::format("pictures have no {} and are left out", what), frame.name());
        return true;
      }
      if (found++ == 0) used = fmt::format("row {} to {}", row + 1, frame.name());
      return !use(frame, row);
    });
  }
  if (found == 0) {
    refuse({table}, "has {} rows for {} pictures, {}; give one row for each of these pictures",
           rows, all.pictures,
           !all.least ? "whose names have no number that counts them"
                      : fmt::format("{} the numbers {} to {}",
                                    first ? "and none for" : "which may count from 0 or from 1 by",
                                    *all.least, *all.greatest));
  }
  recorded.tally.tell("{} of the {} rows of {} belong to pictures, by {}: {}", found, rows,
                      table.string(), first ? "the numbers in their names" : "their order", used);
}

void require_start(Recorded& recorded, std::int64_t lasts_ns, const fs::path& file) {
  const PictureNumbers& all = recorded.numbers;
  if (!recorded.has_own_clock || all.before_ns == 0) return;
  if (lasts_ns < recorded.frames.back().t_ns + all.before_ns / 2) {
    recorded.tally.tell("the first row of {} is taken to be at the first picture, {}",
                        file.string(), recorded.frames.front().name());
    return;
  }
  refuse({file},
         "the numbers of the pictures begin with {}, and its first row may be at that picture or "
         "at number 0; give the times of the pictures (times), on its clock",
         *all.least);
}

void take_list(const TextTable& list, std::int64_t unit_ns,
               const std::function<fs::path(const TextTable::Row&)>& picture_of,
               Recorded& recorded) {
  require_zeros(list, 0);
  for (std::size_t i = 0; i < list.rows.size(); ++i) {
    TextTable::Row row = list.rows[i];
    const bool is_name_first = row.fields.size() > 1 && is_picture(row.fields[0]);
    if (is_name_first) std::swap(row.fields[0], row.fields[1]);
    const auto t_ns = time_in(row.fields.front(), unit_ns);
    const fs::path picture = picture_of(row);
    if (t_ns && !picture.empty()) {
      recorded.frames.push_back({*t_ns, picture, i});
    } else {
      recorded.tally.add("rows cannot be read and are left out", list.at(list.rows[i]));
    }
  }
  put_in_order(recorded.frames, list.file, recorded.tally);
  number_frames(recorded, false);
}

void put_in_order(std::vector<RecordedFrame>& frames, const fs::path& list, Tally& tally) {
  sort_by_time(frames, "pictures", list.string(), tally);
  if (frames.empty()) {
    refuse({list}, "{}", tally.before("lists no picture with a time; give a row for each picture"));
  }
}

void keep_within(const ReadingTimes& readings, Recorded& recorded) {
  constexpr double kPeriods = 4, kFrames = 2;
  const std::vector<std::int64_t>& times_ns = readings.t_ns;
  const std::int64_t first_ns = readings.first_ns, last_ns = times_ns.back() + readings.behind_ns;
  std::erase_if(recorded.frames, [&](const RecordedFrame& frame) {
    const bool is_outside = frame.t_ns < first_ns || frame.t_ns > last_ns;
    if (is_outside) recorded.tally.add(readings.outside, frame.name());
    return is_outside;
  });
  if (recorded.frames.empty()) {
    refuse({}, "{}",
           recorded.tally.before(fmt::format("no picture was taken while the sensors recorded, "
                                             "from {} to {} ns; give both the times of one clock",
                                             first_ns, last_ns)));
  }
  const auto periods_s = [](const std::vector<std::int64_t>& of, double count) {
    return count / usual_rate_hz(of).value_or(1);
  };
  const double gap_s =
      std::max(periods_s(times_ns, kPeriods), periods_s(stamps_of(recorded.frames), kFrames));
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    const std::int64_t from_ns = times_ns[i - 1], to_ns = times_ns[i];
    const double silent_s = seconds(to_ns - from_ns);
    if (silent_s <= gap_s || readings.is_known(i)) continue;
    const auto left_out = std::erase_if(recorded.frames, [&](const RecordedFrame& frame) {
      return frame.t_ns > from_ns && frame.t_ns < to_ns;
    });
    if (left_out == 0) continue;
    recorded.tally.add("pictures are in gaps of the " + readings.name + " and are left out",
                       fmt::format("after {:.3f} s of silence from {} ns on", silent_s, from_ns),
                       static_cast<int>(left_out));
  }
  if (recorded.frames.empty()) {
    refuse({}, "all pictures are in gaps of the {}; give both the times of one clock",
           readings.name);
  }
}

void move_by_navigation(std::vector<NavigationState> states, const sim::Pose& T_BC,
                        Recorded& recorded) {
  sort_by_time(states, "states of the navigation", "the navigation's", recorded.tally);
  if (states.size() < 2) {
    refuse({},
           "there are fewer than two states of navigation to tell a motion from; give a table of "
           "them that covers the pictures");
  }
  keep_within({stamps_of(states), "states of the navigation",
               "pictures are outside of the navigation's time and are left out"},
              recorded);
  recorded.motion = std::make_unique<PosesMotion>(
      poses_along(states, stamps_of(recorded.frames), T_BC), Vector3d::UnitZ(), false);
}

}  // namespace lcs::replay
