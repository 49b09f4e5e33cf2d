// The order of pictures by the numbers in their names, and names that are times.
#include "tools/replay/recorded.h"

#include <gtest/gtest.h>

#include "scenarios/input/error.h"
#include "tests/tools/files.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::replay {
namespace {

using Names = std::vector<std::string>;

OrderedPictures ordered(const Names& names, const std::string& time_unit = "") {
  return in_order({names.begin(), names.end()}, time_unit);
}

Names order(const Names& names) {
  Names all;
  for (const auto& file : ordered(names).files) all.push_back(file.string());
  return all;
}

using test::refusal_of;

std::string refusal(const Names& names) {
  return refusal_of<input::Error>([&] { ordered(names); });
}

TEST(PictureNames, AreSortedByTheNumberThatVaries) {
  EXPECT_EQ(order({"a10.png", "a2.png", "a1.JPG"}), (Names{"a1.JPG", "a2.png", "a10.png"}));
  EXPECT_EQ(order({"10_v2.png", "9_v2.png"}), (Names{"9_v2.png", "10_v2.png"}));
  EXPECT_EQ(order({"img10_cam1.png", "img9_cam1.png"}), (Names{"img9_cam1.png", "img10_cam1.png"}));
  EXPECT_EQ(order({"b.png", "a.png"}), (Names{"a.png", "b.png"}));
}

TEST(PictureNames, MayHaveSeveralNumbersThatGiveOneOrder) {
  EXPECT_EQ(order({"f2_t1700000010.png", "f1_t1700000009.png"}),
            (Names{"f1_t1700000009.png", "f2_t1700000010.png"}));
  EXPECT_EQ(
      order({"IMG_20240102_000059.jpg", "IMG_20240102_000100.jpg", "IMG_20240101_235959.jpg"}),
      (Names{"IMG_20240101_235959.jpg", "IMG_20240102_000059.jpg", "IMG_20240102_000100.jpg"}));
  EXPECT_EQ(order({"2024-01-02_12-31-00.png", "2024-01-02_12-30-59.png"}),
            (Names{"2024-01-02_12-30-59.png", "2024-01-02_12-31-00.png"}));
}

TEST(PictureNames, OfTwoPossibleOrdersAreRefused) {
  EXPECT_NE(refusal({"img1_cam1.png", "img1_cam2.png", "img2_cam1.png", "img2_cam2.png"})
                .find("another one gives another order"),
            std::string::npos);
  EXPECT_NE(refusal({"left_1.png", "right_1.png"}).find("have the same number"), std::string::npos);
  EXPECT_NE(refusal({"1.png", "01.png"}).find("have the same number"), std::string::npos);
  EXPECT_NE(refusal({"1.png", "cover.png"}).find("cover.png has no number"), std::string::npos);
  EXPECT_NE(refusal({"v1.9.png", "v1.10.png"}).find("may be fractions"), std::string::npos);
}

TEST(PictureNames, TimestampsAreReadAsTimes) {
  const OrderedPictures seconds = ordered({"1001.000000.png", "1000.900000.png"});
  EXPECT_EQ(seconds.files.front(), "1000.900000.png");
  EXPECT_EQ(seconds.t_ns, (std::vector<std::int64_t>{1'000'900'000'000, 1'001'000'000'000}));
  const std::vector<std::int64_t> epoch{1'403'636'579'763'555'584, 1'403'636'579'813'555'456};
  EXPECT_EQ(ordered({"1403636579763555584.png", "1403636579813555456.png"}).t_ns, epoch);
  EXPECT_EQ(ordered({"1403636579763555.584.png", "1403636579813555.456.png"}, "us").t_ns, epoch);
  EXPECT_EQ(ordered({"1403636579_763555584.png", "1403636580_000000001.png"}).t_ns[1],
            1'403'636'580'000'000'001);
  EXPECT_EQ(ordered({"img_1700000000100.jpg", "img_1700000000200.jpg"}).t_ns[1],
            1'700'000'000'200'000'000);
  EXPECT_TRUE(ordered({"000001.png", "000002.png"}).t_ns.empty());
  EXPECT_TRUE(ordered({"1700000000000.png", "1700000000001.png"}).t_ns.empty()) << "at 1000 Hz";
}

TEST(PictureNames, OfAFolderAreThoseOfPicturesWithoutHiddenFiles) {
  const test::TemporaryFolder folder;
  for (const char* name : {"2.png", "1.WebP", "._1.png", "log.txt"}) {
    test::write(folder.path() / name, name);
  }
  const OrderedPictures pictures = in_order(pictures_in(folder.path()), "");
  ASSERT_EQ(pictures.files.size(), 2u);
  EXPECT_EQ(pictures.files[0].filename(), "1.WebP");
}

}  // namespace
}  // namespace lcs::replay
