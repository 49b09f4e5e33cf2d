// ROS 1 bags, rosbag2 (.db3) and MCAP. read_bag.py writes them as a folder in EuRoC's layout, by
// PyPI's rosbags, and that folder is read.
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "scenarios/input/input_file.h"
#include "scenarios/input/message.h"
#include "scenarios/shipped.h"
#include "tools/files/json_node.h"
#include "tools/process/child.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

constexpr const char* kPosesFile = "poses.txt";
constexpr input::FileKind kMessages{input::kMebibyte, "run it again"};

/// A folder that is removed with all that is in it.
std::shared_ptr<const fs::path> temporary_folder() {
  std::string name = (fs::temp_directory_path() / "lcs-bag-XXXXXX").string();
  if (!::mkdtemp(name.data())) {
    throw std::system_error(errno, std::generic_category(), name + " cannot be made");
  }
  return {new fs::path(name), [](const fs::path* path) {
            std::error_code error;
            fs::remove_all(*path, error);
            delete path;
          }};
}

/// Runs read_bag.py. \throws input::Error with its message if it fails.
void run_reader(const std::vector<std::string>& arguments, int out, const input::Source& where) {
  const process::PythonEnd end =
      process::run_python(scenario::shipped_folder("tools/replay") / "read_bag.py", arguments, out);
  if (end.is_fine) return;
  std::string said = end.err;
  constexpr std::string_view kPrefix = "error: ";
  if (said.starts_with(kPrefix)) said.erase(0, kPrefix.size());
  const std::string& bag = arguments.front();  // its whole path
  if (said.starts_with(bag + ": ") && fs::absolute(where.file) == bag) {
    said.erase(0, bag.size() + 2);
  }
  refuse(where, "{}",
         said.empty() ? "the bag was not read to its end; run it again" : input::one_line(said));
}

}  // namespace

bool is_bag(const fs::path& path) {
  static const std::set<std::string> kEndings{".bag", ".mcap", ".db3"};
  if (fs::is_regular_file(path)) return kEndings.contains(path.extension().string());
  std::error_code error;
  return std::any_of(fs::directory_iterator(path, error), {}, [](const fs::directory_entry& entry) {
    return entry.path().extension() == ".mcap" || entry.path().extension() == ".db3";
  });
}

Recorded read_bag(const RecordingSource& asked, bool exact_motion) {
  const auto folder = temporary_folder();
  const fs::path made = *folder / "recording";
  const RecordingSource::Topics& topics = asked.topics;
  std::vector<std::string> arguments{fs::absolute(asked.path).string()};
  if (topics.image.empty()) {
    run_reader(arguments, STDOUT_FILENO, asked.source);
    refuse(asked.source,
           "{} is a bag with the topics above; name the topic of its pictures (topics.image, or "
           "--image-topic), and of an IMU or poses",
           asked.path.string());
  }
  const std::pair<const char*, const std::string&> options[] = {
      {"--image-topic", topics.image},       {"--camera-info-topic", topics.camera_info},
      {"--imu-topic", topics.imu},           {"--poses-topic", topics.poses},
      {"--odometry-topic", topics.odometry}, {"--world-frame", topics.world},
  };
  for (const auto& [option, topic] : options) {
    if (!topic.empty()) arguments.push_back(fmt::format("{}={}", option, topic));
  }
  if (motion_is_asked(asked)) arguments.emplace_back("--own-motion");
  arguments.push_back("--out=" + made.string());
  run_reader(arguments, -1, asked.source);

  RecordingSource inner = asked;
  inner.path = made;
  inner.camera.clear();
  const bool by_imu = topics.poses.empty() && fs::exists(made / "mav0" / "imu0");
  const bool by_poses = !motion_is_asked(asked) && !by_imu && fs::exists(made / kPosesFile);
  // With poses EuRoC's own motion is not read; without any motion there is none to read.
  if (!motion_is_asked(asked) && !by_imu) inner.poses = made / kPosesFile;
  Recorded recorded = [&] {
    try {
      Recorded read = read_euroc(inner, exact_motion);
      if (by_poses) {
        move_by_poses(inner, made / kPosesFile, true, read);
        read.took.insert({"topics.poses", "topics.world"});
      }
      return read;
    } catch (const input::Error& error) {
      std::string said = error.what();
      if (!said.starts_with(folder->string())) throw;
      // People do not have that file, and a bag has no header that could state a unit.
      said.erase(0, said.find(": ") + 2);
      said.erase(std::min(said.size(), said.find(", or put their unit into the header")));
      const std::string& topic = by_poses ? topics.poses : topics.imu;
      refuse(asked.source, "{}, of the bag's {}: correct the bag's messages", said,
             topic.empty() ? "only such topic" : topic);
    }
  }();
  recorded.keep = folder;
  files::read_json(made / "bag.json", kMessages, [&](const files::JsonNode& json) {
    json["told"].each([&](const files::JsonNode& line) { recorded.tally.tell("{}", line.text()); });
    if (json.has("bayer")) recorded.format.demosaic = demosaic_of(json["bayer"].text());
    return 0;
  });
  return recorded;
}

}  // namespace lcs::replay
