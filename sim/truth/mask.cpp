#include "sim/truth/mask.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace lcs::sim {
namespace {

/// Builds runs from consecutive pixels.
class RunWriter {
 public:
  void add(bool inside, std::int64_t pixels) {
    if (pixels <= 0) return;
    if (inside != (runs_.size() % 2 == 0)) runs_.push_back(0);
    runs_.back() += static_cast<std::uint32_t>(pixels);
    written_ += pixels;
  }
  /// Adds pixels outside the mask up to this pixel.
  void skip_to(std::int64_t pixel) { add(false, pixel - written_); }
  PixelRuns take() { return std::move(runs_); }

 private:
  PixelRuns runs_{0};
  std::int64_t written_ = 0;
};

Mask in_least_box(const Mask& mask) {
  cv::Rect box;
  visit_stretches(mask,
                  [&](int x, int top, int bottom) { box |= cv::Rect(x, top, 1, bottom - top); });
  return box.empty() ? Mask{} : Mask{box, runs_in(box, mask)};
}

}  // namespace

PixelRuns runs_of(const cv::Mat1i& columns, const cv::Rect& box, int number) {
  RunWriter runs;
  for (int x = box.x; x < box.x + box.width; ++x) {
    const int* const column = columns[x] + box.y;
    for (const int* pixel = column; pixel != column + box.height;) {
      const bool inside = *pixel == number;
      const int* const end = std::find_if(pixel, column + box.height,
                                          [&](int other) { return (other == number) != inside; });
      runs.add(inside, end - pixel);
      pixel = end;
    }
  }
  return runs.take();
}

Mask mask_of(const cv::Mat1b& picture) {
  cv::Mat1i columns;
  cv::Mat(picture != 0).convertTo(columns, CV_32S);
  cv::transpose(columns, columns);
  const cv::Rect all({}, picture.size());
  return in_least_box({all, runs_of(columns, all, 255)});
}

Mask mask_of(std::span<const std::int64_t> runs, const cv::Size& size_px) {
  const std::int64_t all = std::int64_t{size_px.height} * size_px.width;
  if (!std::in_range<PixelRuns::value_type>(all)) {
    throw std::invalid_argument(fmt::format("the mask is of {} x {} pixels, which no picture has",
                                            size_px.height, size_px.width));
  }
  std::int64_t sum = 0;
  for (const std::int64_t run : runs) {
    if (run < 0 || run > all - sum) {
      sum = -1;
      break;
    }
    sum += run;
  }
  if (sum != all) {
    throw std::invalid_argument(
        fmt::format("the mask's counts do not add up to {} x {} pixels; give all of them, of "
                    "pixels outside first",
                    size_px.height, size_px.width));
  }
  Mask mask = in_least_box({{{}, size_px}, PixelRuns(runs.begin(), runs.end())});
  if (mask.box.empty()) {
    throw std::invalid_argument("the mask has no pixel; leave out what is not seen");
  }
  return mask;
}

PixelRuns runs_in(const cv::Rect& box, const Mask& mask) {
  RunWriter runs;
  visit_stretches(mask, [&](int x, int top, int bottom) {
    runs.skip_to(std::int64_t{x - box.x} * box.height + top - box.y);
    runs.add(true, bottom - top);
  });
  runs.skip_to(std::int64_t{box.width} * box.height);
  return runs.take();
}

}  // namespace lcs::sim
