
#include <gtest/gtest.h>

#include <limits>

#include "tests/tools/refusal.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

scenario::Actor actor(const std::string& name, scenario::Shape shape, const std::string& kind) {
  scenario::Actor actor;
  actor.name = name;
  actor.shape = shape;
  actor.kind = kind;
  scenario::Line line;
  line.speed_mps = 1;
  actor.trajectory = line;
  return actor;
}

TEST(Objects, HaveTheClassOfTheirActorElseThatOfTheirShape) {
  scenario::Scenario s;
  s.actors = {actor("ann", scenario::Shape::own, "pedestrian"),
              actor("truck", scenario::Shape::car, "forklift"),
              actor("bike", scenario::Shape::own, "bicycle"),
              actor("taxi", scenario::Shape::car, ""), actor("thing", scenario::Shape::own, "")};
  s.actors.push_back(actor("mover", scenario::Shape::box, "agv"));
  s.actors.back().body = "cart";
  s.actors.back().trajectory = scenario::Still{};

  EXPECT_EQ(categories_of(s), (std::vector<std::string>{"pedestrian", "car", "box", "cylinder",
                                                        "object", "forklift", "bicycle", "agv"}));
  struct Expected {
    const char* object;
    const char* category;
    int coco, mot;
    bool moves;
  };
  for (const Expected& e :
       {Expected{"ann", "pedestrian", 1, 1, true}, Expected{"truck", "forklift", 6, 8, true},
        Expected{"bike", "bicycle", 7, 4, true}, Expected{"taxi", "car", 2, 3, true},
        Expected{"thing", "object", 5, 8, true}, Expected{"cart", "agv", 8, 8, false},
        Expected{"of_the_scene", "object", 5, 8, false}}) {
    const ObjectKind kind = kind_of(s, {1, e.object});
    EXPECT_EQ(kind.category, e.category) << e.object;
    EXPECT_EQ(kind.coco, e.coco) << e.object;
    EXPECT_EQ(kind.mot, e.mot) << e.object;
    EXPECT_EQ(kind.moves, e.moves) << e.object;
  }
}

TEST(Objects, TheMaskOfAFrameHoldsIdsBeyondEightBits) {
  sim::FrameTruth truth;
  truth.object = (cv::Mat1i(1, 4) << 0, 300, -1, -1);
  truth.depth_m = (cv::Mat1f(1, 4) << 5, 5, 0.3, std::numeric_limits<float>::infinity());
  const cv::Mat1w mask = object_mask(truth);
  EXPECT_EQ(mask(0, 0), 0);
  EXPECT_EQ(mask(0, 1), 300);
  EXPECT_EQ(mask(0, 2), kVoid) << "the rover";
  EXPECT_EQ(mask(0, 3), 0) << "the sky";
}

TEST(Objects, OnlyMasksOfEightBitsLimitTheirNumber) {
  scenario::Scenario scenario;
  scenario.scene = "store.xml";
  scenario.events.emplace();
  const sim::Calibration calibration;
  const std::optional<scenario::Origin> origin;
  std::vector<sim::Object> objects(253);
  const std::vector<const sim::Calibration*> rig{&calibration};
  const SequenceInfo info{scenario, calibration, objects, origin, rig};
  for (const Format& format : formats()) EXPECT_NO_THROW(format.make(info)) << format.name;
  objects.resize(254);
  for (const Format& format : formats()) {
    if (format.name == "davis") continue;
    EXPECT_NO_THROW(format.make(info)) << format.name;
  }
  const std::string refusal = test::refusal_of<input::Error>([&] { format("davis").make(info); });
  EXPECT_TRUE(refusal.starts_with("store.xml: the scene has 254 objects")) << refusal;
  EXPECT_NE(refusal.find("leave davis out of --formats"), std::string::npos) << refusal;
}

}  // namespace
}  // namespace lcs::sequence
