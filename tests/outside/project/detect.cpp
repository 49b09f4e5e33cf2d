// Detects four bright dots and computes their descriptors.
#include <cstdio>
#include <vector>

#include "filter/detect/describe.h"
#include "filter/detect/fast.h"

int main() {
  cv::Mat1b grey(240, 320, 40);
  for (const cv::Point dot : {cv::Point(90, 80), {200, 80}, {90, 150}, {200, 150}}) grey(dot) = 220;
  const auto corners_px = lcs::FastDetector(51).detect(grey);
  const auto signatures = lcs::describe(grey, corners_px);
  std::printf("%zu corners, %zu signatures\n", corners_px.size(), signatures.size());
  return corners_px.size() == 4 && signatures.size() == 4 ? 0 : 1;
}
