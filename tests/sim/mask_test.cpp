#include "sim/truth/mask.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

#include "sim/truth/truth.h"

namespace lcs::sim {
namespace {

/// Blots, thin lines and single pixels, sometimes at the rim.
cv::Mat1b any_picture(std::mt19937& random, const cv::Size& size) {
  cv::Mat1b picture(size, 0);
  const auto at = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  for (int i = at(4); i >= 0; --i) {
    const cv::Point corner(at(size.width), at(size.height));
    const cv::Rect blot(corner, cv::Size(1 + at(9), 1 + at(9)));
    picture(blot & cv::Rect({}, size)) = static_cast<uchar>(i % 3 == 2 ? 0 : 1 + at(200));
  }
  return picture;
}

cv::Mat1b drawn(const Mask& mask, const cv::Size& size) {
  cv::Mat1b picture(size, 0);
  visit_stretches(mask, [&](int x, int top, int bottom) {
    for (int y = top; y < bottom; ++y) picture(y, x) = 255;
  });
  return picture;
}

bool are_same(const cv::Mat& a, const cv::Mat& b) {
  return cv::countNonZero(a != b) == 0;
}

TEST(Mask, HasThePixelsOfItsPictureInTheLeastBox) {
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) {
    const cv::Size size(12 + i % 5, 9 + i % 7);
    const cv::Mat1b picture = any_picture(random, size);
    const Mask mask = mask_of(picture);
    EXPECT_TRUE(are_same(drawn(mask, size), picture != 0));
    if (mask.box.empty()) continue;
    EXPECT_EQ(mask.runs.size() > 0 ? cv::Rect({}, size) & mask.box : cv::Rect(), mask.box);
    for (const cv::Rect& side :
         {cv::Rect(mask.box.x, mask.box.y, 1, mask.box.height),
          cv::Rect(mask.box.x, mask.box.y, mask.box.width, 1),
          cv::Rect(mask.box.br() - cv::Point(1, mask.box.height), cv::Size(1, mask.box.height)),
          cv::Rect(mask.box.br() - cv::Point(mask.box.width, 1), cv::Size(mask.box.width, 1))}) {
      EXPECT_GT(cv::countNonZero(picture(side)), 0);
    }
  }
}

TEST(Mask, OfAWholePictureAndOfItsBoxAreTheSame) {
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    const cv::Size size(13, 10);
    const Mask mask = mask_of(any_picture(random, size));
    if (mask.box.empty()) continue;
    const PixelRuns whole = runs_in({{}, size}, mask);
    const std::vector<std::int64_t> counts(whole.begin(), whole.end());
    const Mask back = mask_of(counts, size);
    EXPECT_EQ(back.box, mask.box);
    EXPECT_EQ(back.runs, mask.runs);
  }
}

TEST(Mask, ByRunsThatAreNoneIsRefused) {
  const cv::Size size(4, 3);
  const auto by = [&](const std::vector<std::int64_t>& runs) { return mask_of(runs, size); };
  EXPECT_EQ(by({4, 1, 7}).box, cv::Rect(1, 1, 1, 1));
  EXPECT_THROW(by({4, 1, 6}), std::invalid_argument);
  EXPECT_THROW(by({4, 1, 8}), std::invalid_argument);
  EXPECT_THROW(by({5, -1, 8}), std::invalid_argument);
  EXPECT_THROW(by({12}), std::invalid_argument);
}

TEST(ModalBoxes, HaveTheMasksOfTheirPixels) {
  std::mt19937 random(3);
  for (int i = 0; i < 100; ++i) {
    const cv::Size size(20, 15);
    cv::Mat1i ids(size, -1);
    for (int id : {1, 3, 0, 2, 3}) ids.setTo(id, any_picture(random, size) != 0);
    for (const ObjectTruth& truth : modal_boxes(ids, 3)) {
      EXPECT_EQ(truth.mask.empty(), truth.visible_px == 0);
      EXPECT_TRUE(are_same(drawn(mask_of(truth), size), ids == truth.object));
    }
  }
}

TEST(Mask, OfMoreThanARunHoldsIsRefused) {
  const cv::Size size(std::numeric_limits<int>::max(), 120);
  const std::int64_t all = std::int64_t{size.width} * size.height;
  for (const std::vector<std::int64_t>& runs :
       {std::vector{std::int64_t{0}, all}, {all - 5, std::int64_t{5}}}) {
    EXPECT_THROW(mask_of(runs, size), std::invalid_argument);
  }
}

}  // namespace
}  // namespace lcs::sim
