#include "tools/sequence/frame_output.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace lcs::sequence {
namespace {

/// Folders whose own layout has a place for each camera.
constexpr std::array<std::string_view, 2> kShared{"mav0/", "kitti/"};

void move(const std::string& camera, std::string& path) {
  const bool is_shared = std::ranges::any_of(
      kShared, [&](std::string_view folder) { return path.starts_with(folder); });
  if (!path.empty() && !is_shared) path.insert(0, camera + "/");
}

}  // namespace

FrameOutput of_camera(const std::string& camera, FrameOutput output) {
  if (camera.empty()) return output;
  for (FrameFile& file : output.files) {
    move(camera, file.path);
    move(camera, file.same_as);
  }
  Rows rows;
  for (auto& [stream, text] : output.rows) rows[camera + "/" + stream] = std::move(text);
  output.rows = std::move(rows);
  return output;
}

Document of_camera(const std::string& camera, Document document) {
  if (camera.empty()) return document;
  move(camera, document.path);
  for (Part& part : document.parts) {
    if (!part.stream.empty()) part.stream.insert(0, camera + "/");
  }
  return document;
}

}  // namespace lcs::sequence
