#include "sim/picture_file.h"

#include <opencv2/imgcodecs.hpp>

#include "scenarios/input_file.h"

namespace lcs::sim {
namespace {

/// 8192 x 8192 pixels of three bytes are 192 MiB before they are compressed.
constexpr scenario::FileKind kPictureFile{256 * scenario::kMebibyte, "give a PNG or JPEG picture"};

}  // namespace

cv::Mat read_picture(const std::filesystem::path& file, const scenario::Source& where, int flags) {
  const std::string bytes = scenario::InputFile(file, kPictureFile, where).bytes();
  if (bytes.empty()) return {};
  try {
    return cv::imdecode(cv::Mat(1, static_cast<int>(bytes.size()), CV_8U,
                                const_cast<char*>(bytes.data())),
                        flags);
  } catch (const cv::Exception&) {  // as for a size that no picture has
    return {};
  }
}

}  // namespace lcs::sim
