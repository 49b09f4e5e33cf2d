#include "tools/replay/picture_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <stdexcept>
#include <tuple>

#include "sim/pictures/picture_file.h"

namespace lcs::replay {
namespace {

namespace fs = std::filesystem;

bool is_picture(const fs::path& file) {
  static const std::set<std::string> kKinds = {".png", ".jpg",  ".jpeg", ".bmp",
                                               ".tif", ".tiff", ".pgm",  ".ppm"};
  std::string kind = file.extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return kKinds.contains(kind);
}

/// The last number in the name, without leading zeros. Comparing length first, then text, compares
/// such numbers of any size.
std::string last_number(const fs::path& file) {
  const std::string stem = file.stem().string();
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t end = stem.size();
  while (end > 0 && !digit(stem[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && digit(stem[begin - 1])) --begin;
  while (begin + 1 < end && stem[begin] == '0') ++begin;
  return stem.substr(begin, end - begin);
}

}  // namespace

PictureFolder::PictureFolder(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->is_regular_file() && is_picture(entry->path())) files_.push_back(entry->path());
  }
  if (error) {
    throw std::runtime_error(
        fmt::format("{}: {}; give a folder of pictures", folder.string(), error.message()));
  }
  if (files_.empty()) {
    throw std::runtime_error(
        fmt::format("{} holds no pictures; give a folder of PNG, JPEG, BMP, TIFF, PGM or PPM",
                    folder.string()));
  }
  std::sort(files_.begin(), files_.end(), [](const fs::path& a, const fs::path& b) {
    const std::string na = last_number(a), nb = last_number(b);
    return std::tuple(na.size(), na, a.string()) < std::tuple(nb.size(), nb, b.string());
  });
}

std::optional<cv::Mat3b> PictureReader::read(const fs::path& file) {
  const auto skip = [&](std::string why) {
    skipped_.push_back(std::move(why));
    return std::nullopt;
  };
  std::error_code error;
  if (!fs::exists(file, error)) return skip(fmt::format("{} is missing", file.string()));
  cv::Mat picture;
  try {
    picture = sim::read_picture(file, {file.string(), 0},
                                demosaic_ ? cv::IMREAD_GRAYSCALE : cv::IMREAD_COLOR);
  } catch (const input::Error& refused) {
    return skip(refused.what());
  }
  if (size_.empty()) size_ = picture.size();
  if (picture.size() != size_) {
    return skip(fmt::format("{} is {}x{}, not {}x{} as those before it", file.string(),
                            picture.cols, picture.rows, size_.width, size_.height));
  }
  if (!demosaic_) return cv::Mat3b(picture);
  cv::Mat3b image;
  cv::cvtColor(picture, image, *demosaic_);
  return image;
}

}  // namespace lcs::replay
