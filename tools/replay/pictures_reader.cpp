// Pictures that the user describes: a folder, a video, a sequence of MOTChallenge.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/videoio.hpp>
#include <stdexcept>

#include "sim/pictures/picture_file.h"
#include "tools/files/csv.h"
#include "tools/input/input_file.h"
#include "tools/output/video_reader.h"
#include "tools/replay/picture_folder.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

namespace fs = std::filesystem;

constexpr input::FileKind kVideo{
    64 * input::kGibibyte,
    "give a whole MP4, MOV, AVI, MKV, WebM, MPEG, FLV, ASF or OGG, or its pictures in a folder"};

constexpr const char* kSequenceInfo = "seqinfo.ini";

/// Reads "key=value" lines of a section [Sequence].
std::map<std::string, std::string> read_info(const fs::path& file) {
  constexpr input::FileKind kInfo{input::kMebibyte, "give the file as MOTChallenge has it"};
  input::InputFile input(file, kInfo);
  std::map<std::string, std::string> info;
  for (std::string line; input.next_line(line);) {
    const std::size_t equals = line.find('=');
    if (equals == line.npos) continue;
    const std::string_view text = line;
    info[std::string(bench::trimmed(text.substr(0, equals)))] =
        bench::trimmed(text.substr(equals + 1));
  }
  return info;
}

/// Absent for an invalid rate.
std::optional<double> rate_in(std::string_view text) {
  const auto number = bench::number_in<double>(text);
  constexpr double kFastest_hz = 10000;
  return number && *number > 0 && *number <= kFastest_hz ? number : std::nullopt;
}

}  // namespace

bool is_pictures(const fs::path& folder) {
  try {
    return PictureFolder(folder).size() > 0;
  } catch (const std::runtime_error&) {
    return false;
  }
}

Recorded read_pictures(const scenario::Recorded& asked, bool) {
  Recorded recorded;
  recorded.frames = frames_in(asked.path);
  recorded.timed = false;
  return recorded;
}

bool is_mot(const fs::path& folder) {
  return fs::exists(folder / kSequenceInfo);
}

Recorded read_mot(const scenario::Recorded& asked, bool) {
  const std::map<std::string, std::string> info = read_info(asked.path / kSequenceInfo);
  const auto text = [&](const char* key, const char* otherwise) {
    const auto found = info.find(key);
    return found == info.end() ? std::string(otherwise) : found->second;
  };
  Recorded recorded;
  recorded.frames = frames_in(asked.path / text("imDir", "img1"));
  recorded.timed = false;
  recorded.fps = rate_in(text("frameRate", ""));
  const auto listed = bench::number_in<std::size_t>(text("seqLength", ""));
  if (listed && *listed != recorded.frames.size()) {
    recorded.tally.add("lists of pictures have another length than there are pictures",
                       fmt::format("{}, {} and not {}", (asked.path / kSequenceInfo).string(),
                                   *listed, recorded.frames.size()));
  }
  return recorded;
}

bool is_video(const fs::path& file) {
  return fs::is_regular_file(file);
}

Recorded read_video(const scenario::Recorded& asked, bool) {
  const input::InputFile no_pipe(asked.path, kVideo, asked.source);
  const auto video = bench::open_video(asked.path);
  const auto refuse = [&](const std::string& what) {
    throw input::Error(asked.source,
                       fmt::format("{} {}; {}", asked.path.string(), what, kVideo.remedy));
  };
  const double count = video->isOpened() ? video->get(cv::CAP_PROP_FRAME_COUNT) : 0;
  if (!(count >= 1)) refuse("is no video that says how many pictures it has");
  // All frames are listed before the first one is read. The shortest one takes its place in the
  // file, its length and a few bits.
  constexpr double kMostPictures = 1e7, kLeastBytes = 8;
  const auto bytes = static_cast<double>(fs::file_size(asked.path));
  if (count > std::min(kMostPictures, bytes / kLeastBytes)) {
    refuse(fmt::format("says that it has {:.0f} pictures, and one of {:.0f} bytes can have {:.0f}",
                       count, bytes, std::min(kMostPictures, bytes / kLeastBytes)));
  }
  const double width = video->get(cv::CAP_PROP_FRAME_WIDTH);
  const double height = video->get(cv::CAP_PROP_FRAME_HEIGHT);
  if (width * height > static_cast<double>(sim::kMostPixels)) {
    refuse(fmt::format("has pictures of {:.0f} x {:.0f} pixels, and can have {} million in all",
                       width, height, sim::kMostPixels / 1'000'000));
  }
  Recorded recorded;
  recorded.video = asked.path;
  recorded.timed = false;
  recorded.fps = rate_in(fmt::format("{}", video->get(cv::CAP_PROP_FPS)));
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    recorded.frames.push_back({0, {}, i});
  }
  return recorded;
}

}  // namespace lcs::replay
