// Each error of a scene is one line with the user's own file and line. MuJoCo's crashes, and
// excessive memory or time, are errors like any other.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "sim/world/world.h"
#include "tests/sim/support.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::sim {
namespace {

namespace fs = std::filesystem;
using test::scenario_error;

/// A scene whose parts have separate lines, in a folder with the files that it names.
class SceneFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  struct Parts {
    // on lines 2, 4, 7 and 9
    std::string top = {}, asset = {}, world = {}, end = {};
  };
  scenario::Scenario scenario(const Parts& parts) const {
    std::ofstream(scene_) << "<mujoco>\n"
                          << parts.top << "\n<asset>\n"
                          << parts.asset
                          << "\n</asset><worldbody>\n"
                             "<geom name='floor' type='plane' size='50 50 .1'/>\n"
                          << parts.world << "\n</worldbody>\n"
                          << parts.end << "\n</mujoco>\n";
    scenario::Scenario s = test::scenario_in("lab", 0, 1);
    s.scene = scene_;
    return s;
  }
  void write(const std::string& name, const std::string& content) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }
  /// The error message of loading; the libraries must write nothing to stderr.
  static std::string refusal(const scenario::Scenario& s) {
    testing::internal::CaptureStderr();
    const std::string message = scenario_error([&] { World world(s); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  void expect(const Parts& parts, int line, const std::vector<std::string>& words) const {
    expect_at(scene_.string() + ":" + std::to_string(line) + ": ", refusal(scenario(parts)), words);
  }
  static void expect_at(const std::string& place, const std::string& message,
                        const std::vector<std::string>& words) {
    EXPECT_EQ(message.find(place), 0u) << message << "\n  is not at " << place;
    for (const std::string& word : words) {
      EXPECT_NE(message.find(word), std::string::npos) << message << "\n  lacks: " << word;
    }
  }

  const fs::path folder_ = lcs::test::folder_of_the_process() /
                           testing::UnitTest::GetInstance()->current_test_info()->name();
  const fs::path scene_ = folder_ / "scene.xml";
};

constexpr const char* kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
constexpr const char* kCorners = "vertex='0 0 0 1 0 0 0 1 0 0 0 1'";

/// Content of a file in one of MuJoCo's binary formats.
std::string bytes(const std::vector<std::int32_t>& integers, const std::vector<float>& numbers,
                  const std::vector<std::int32_t>& more) {
  std::string content(4 * (integers.size() + numbers.size() + more.size()), '\0');
  std::memcpy(content.data(), integers.data(), 4 * integers.size());
  std::memcpy(content.data() + 4 * integers.size(), numbers.data(), 4 * numbers.size());
  std::memcpy(content.data() + 4 * (integers.size() + numbers.size()), more.data(),
              4 * more.size());
  return content;
}

class SceneRefused : public SceneFile {};

TEST_F(SceneRefused, ByTheCompilerNamesLineAndElement) {
  expect({.world = "<body name='b'><freejoint/><geom size='.1' mass='0'/></body>"}, 7,
         {"<body name=\"b\">", "mass and inertia", "give the body a geom"});
  expect({.world = "<geom name='g' type='box'/>"}, 7,
         {"<geom name=\"g\">", "must be positive", "above 0"});
  expect({.world = "<geom type='box' size='1 -1 1'/>"}, 7, {"<geom>", "must be positive"});
  expect({.world = "<geom name='floor' size='1'/>"}, 7, {"repeated name", "another name"});
  expect({.world = "<geom size='1' colour='red'/>"}, 7, {"<geom>", "'colour'", "spelling"});
  expect({.world = "<ball size='1'/>"}, 7, {"<ball>", "unrecognized element"});
  expect({.world = "<geom size='1' material='gold'/>"}, 7, {"'gold' not found", "define it"});
  expect({.world = "<geom size='1 1 1 1'/>"}, 7, {"too much data"});
  expect({.asset = "<material name='m' texture='gone'/>"}, 4, {"<material name=\"m\">", "'gone'"});
  expect({.top = "<option integrator='magic'/>"}, 2, {"<option>", "'magic'"});
  expect({.end = "<equality><weld body1='gone'/></equality>"}, 9, {"<weld>", "'gone'"});
  expect({.end = "<sensor><clock/><gyro name='a' site='gone'/></sensor>"}, 9,
         {"<gyro name=\"a\">"});
  expect({.end = "<sensor><clock/><gyro site='gone'/></sensor>"}, 9, {"<gyro>"});
}

TEST_F(SceneRefused, InAnIncludedFileNamesThatFile) {
  write("part.xml", "<mujoco>\n\n<geom type='box'/></mujoco>");
  expect_at((folder_ / "part.xml").string() + ":3: ",
            refusal(scenario({.world = "<include file='part.xml'/>"})),
            {"<geom>", "must be positive"});
  // MuJoCo would find the file by itself, and its content would be unchecked
  expect_at((folder_ / "part.xml").string() + ":3: ",
            refusal(scenario({.world = "<Include file='part.xml'/>"})),
            {"<geom>", "must be positive"});
  write("picture.xml", "<mujoco>\n<asset>\n<texture name='t' file='no.png'/></asset></mujoco>");
  expect_at((folder_ / "picture.xml").string() + ":3: ",
            refusal(scenario({.end = "<include file='picture.xml'/>"})), {"no.png", "missing"});
}

TEST_F(SceneRefused, InAnActorsFileNamesThatFile) {
  write("actors/box.xml",
        "<mujoco><custom><numeric name='size' data='1 1 1'/></custom><worldbody>\n<body "
        "name='base'>\n<geom type='box' size='0 1 1'/></body></worldbody></mujoco>");
  ASSERT_EQ(setenv("LCS_SCENES", folder_.c_str(), 1), 0);
  auto s = scenario({});
  s.actors = {test::line_actor("visitor", scenario::Shape::box, {2, 0}, 0, 0)};
  const std::string message = refusal(s);
  unsetenv("LCS_SCENES");
  expect_at((folder_ / "actors/box.xml").string() + ":3: ", message,
            {"<geom>", "must be positive"});
}

TEST_F(SceneRefused, LinesHoldBehindAttributesOfManyLines) {
  expect({.top = "<custom><text name='t' data='x\n\n'/></custom>", .world = "<geom type='box'/>"},
         9, {"must be positive"});
}

TEST_F(SceneRefused, ForAnOriginThatIsNoneOrNotTheScenarios) {
  const auto stated = [](const std::string& text) {
    return "<custom><text name='lcs.world' data='" + text + "'/></custom>";
  };
  for (const char* text : {"room", "room x", " 7", "room 7 8x", "room -1"}) {
    expect({.top = stated(text)}, 2, {"lcs.world", "family and seed"});
  }
  scenario::Scenario s = scenario({.top = stated("room 2000000")});
  const auto of_scene = World(s).origin();
  ASSERT_TRUE(of_scene);
  EXPECT_EQ(of_scene->family, "room");
  EXPECT_EQ(of_scene->seed, 2'000'000u);
  scenario::Origin& of_scenario = s.origin.emplace();
  of_scenario.source = {"mine.yaml", 3};
  of_scenario.family = "room";
  of_scenario.seed = 2'000'000;
  EXPECT_NO_THROW(World{s});
  s.origin->seed = 1;
  expect_at("mine.yaml:3: ", refusal(s), {"origin is room 1", "drawn as room 2000000"});
}

TEST_F(SceneRefused, ForAFlatMeshInOneLineAndNoneOfQhulls) {
  expect({.asset = "<mesh name='m' vertex='0 0 0 1 0 0 0 1 0 1 1 0'/>",
          .world = "<geom type='mesh' mesh='m'/>"},
         4, {"<mesh name=\"m\">", "coplanar", "thickness"});
}

TEST_F(SceneRefused, ForFilesThatAreNoneOfTheirKind) {
  write("a.stl", "solid cube\nendsolid\n" + std::string(100, ' '));
  expect({.asset = "<mesh name='m' file='a.stl'/>"}, 4, {"a.stl", "binary STL"});
  write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 99\n");
  expect({.asset = "<mesh name='m' file='a.obj'/>"}, 4,
         {"<mesh name=\"m\">", "vertex index 98", "faces"});
  write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1 2 4\n");
  expect_at(scene_.string() + ": ", refusal(scenario({.asset = "<mesh name='m' file='a.obj'/>"})),
            {"normal index out of bounds", "faces"});
  write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf -1 -2 -3\nf 1 2 -9\n");
  expect({.asset = "<mesh name='m' file='b.obj'/>"}, 4, {"b.obj", "save it anew as OBJ"});
  write("a.png", "this is no picture, but it is long enough");
  expect({.asset = "<texture name='t' type='2d' file='a.png'/>"}, 4, {"PNG"});
  write("a.jpg", "this is no picture, but it is long enough");
  expect({.asset = "<texture name='t' type='2d' file='a.jpg'/>"}, 4,
         {"<texture name=\"t\">", "unsupported", ".png"});
  write("a.skn", "no skin");
  expect({.asset = "<skin name='s' file='a.skn'/>"}, 4, {"a.skn", "save it anew"});
  // MuJoCo multiplies these sizes in an int
  for (const int vertices : {1 << 29, (1 << 30) + 3}) {
    write("a.skn", bytes({vertices, 0, 0, 1}, std::vector<float>(30), {}));
    expect({.asset = "<skin name='s' file='a.skn'/>"}, 4, {"a.skn", "save it anew"});
  }
}

TEST_F(SceneRefused, ForIndicesBeyondTheVertices) {
  const std::vector<float> tetrahedron = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const auto expect_refused = [&](const std::string& asset) {
    const std::string message = refusal(scenario({.asset = asset}));
    expect_at(scene_.string() + ":", message, {});
    // MuJoCo may write to a wrong index before it detects the index
    const bool is_told = message.find("vertex index") != std::string::npos;
    EXPECT_TRUE(is_told || message.find("MuJoCo crashes") != std::string::npos) << message;
  };
  for (const char* face : {"0 1 4'/>", "0 1 99999'/>", "0 1 2000000000'/>", "0 1 -1'/>"}) {
    expect_refused(std::string("<mesh name='m' ") + kCorners + " face='" + face);
  }
  write("a.msh", bytes({4, 0, 0, 1}, tetrahedron, {0, 1, 77}));
  expect_refused("<mesh name='m' file='a.msh'/>");
  write("a.msh", bytes({1 << 30, 0, 0, 1}, tetrahedron, {0, 1, 2}));
  expect({.asset = "<mesh name='m' file='a.msh'/>"}, 4, {"a.msh", "too large sizes"});
  const std::string bone =
      "<bone body='b' bindpos='0 0 0' bindquat='1 0 0 0' vertid='0 1 2' vertweight='1 1 1'/>";
  const std::string body = "<body name='b'><geom size='.1'/></body>";
  expect({.asset = "<skin name='s' vertex='0 0 0 1 0 0 0 1 0' face='0 1 3'>" + bone + "</skin>",
          .world = body},
         4, {"<skin name=\"s\">", "face of vertex 3", "there are 3", "correct its faces"});
}

TEST_F(SceneRefused, ForNumbersThatAreNoneOrEndless) {
  expect({.world = "<geom size='nan'/>"}, 7, {"<geom>", "size has 'nan'"});
  expect({.world = "<geom size='1' pos='0 inf 0'/>"}, 7, {"pos has 'inf'"});
  expect({.world = "<geom size='1' pos='0 1e999 0'/>"}, 7, {"'pos'", "too large"});
  expect({.world = "<geom size='1' pos='0 1e30 0'/>"}, 7, {"pos has '1e30'", "1e+06 m"});
  expect({.asset = "<mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 one'/>"}, 4,
         {"'vertex'", "bad format"});
  for (const char* face : {"0 2 1.5", "0 2 1e0", "0 2 x"}) {
    expect({.asset = std::string("<mesh name='m' ") + kCorners + " face='" + face + "'/>"}, 4,
           {"'face'", "bad format", "integers"});
  }
  std::vector<float> numbers = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0};
  numbers.back() = std::numeric_limits<float>::quiet_NaN();
  write("a.msh", bytes({4, 0, 4, 4}, numbers, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}));
  expect_at(scene_.string() + ": ", refusal(scenario({.asset = "<mesh name='m' file='a.msh'/>"})),
            {"not finite", "mesh_texcoord"});
  for (const char* joint :
       {"damping='nan'", "stiffness='inf'", "user='1 nan'", "name='nan' armature='inf'"}) {
    expect({.world = "\n<body name='b'><joint " + std::string(joint) + "/><geom size='1'/></body>"},
           8, {"<joint", "not finite"});
  }
  EXPECT_NO_THROW(World(scenario(
      {.world =
           "<body name='b' pos='0 0 5'><joint name='j' range='-inf inf'/><geom size='1'/></body>",
       .end = "<actuator><motor joint='j' forcerange='-inf inf'/></actuator>"})));
  EXPECT_NO_THROW(World(scenario({.world = "<site name='nan' pos='0 0 1'/>"})));
}

/// Texts of any kind may have words that are numbers, begin as numbers or are not finite.
TEST_F(SceneFile, MayHaveNumbersInItsTexts) {
  write("3d/2f85.xml",
        "<mujoco model='2f85'><worldbody><body name='1e9'><geom size='.1'/></body></worldbody>"
        "</mujoco>");
  write("3d/inf.obj", kTetrahedron);
  const auto s = scenario(
      {.top = "<compiler meshdir='3d'/><custom><text name='12 inf' data='nan 5x'/></custom>",
       .asset = "<model name='2f85' file='3d/2f85.xml'/><mesh name='7up' file='inf.obj'/>",
       .world = "<attach model='2f85' body='1e9' prefix='1_'/>"
                "<replicate count='2' sep='0_' offset='1 0 0'><body name='nan' pos='3 0 0'>"
                "<geom type='mesh' mesh='7up'/></body></replicate>",
       .end = "<custom><tuple name='1x'><element objtype='mesh' objname='7up' prm='2'/></tuple>"
              "</custom>"});
  const World world(s);
  EXPECT_EQ(world.objects().size(), 3u);
}

TEST_F(SceneRefused, ForMoreThanTheLimitsAllow) {
  expect({.top = "<size nuserdata='2000000000'/>"}, 2, {"nuserdata", "2000000000", "1000000"});
  expect({.top = "<visual><quality numslices='1000000'/></visual>"}, 2, {"numslices", "512"});
  expect({.top = "<option timestep='0'/>"}, 2, {"timestep"});
  expect({.top = "<option iterations='2000000000'/>"}, 2, {"iterations"});
  expect({.top = "<option iterations='99x'/>"}, 2, {"iterations", "99x"});
  expect({.top = "<custom><numeric name='n' data='1' size='501'/></custom>"}, 2,
         {"numeric", "500"});
  expect({.asset = "<hfield name='h' nrow='3000' ncol='20' size='1 1 1 1'/>",
          .world = "<geom type='hfield' hfield='h'/>"},
         4, {"<hfield name=\"h\">", "20 x 3000", "2000 x 2000"});
}

TEST_F(SceneRefused, ForMoreThanMemoryHolds) {
  for (const char* size : {"njmax", "nconmax", "nstack", "nuser_geom"}) {
    for (const char* count : {"2000000000", "50x"}) {
      const std::string top = std::string("<size ") + size + "='" + count + "'/>";
      expect({.top = top}, 2, {"<size>", size + std::string(" is ") + count, "can be -1 to"});
    }
  }
  expect({.top = "<option gravity='0 0 -9.81m'/>"}, 2, {"'gravity'", "bad format"});
}

TEST_F(SceneRefused, ForTexturesThatAreTooLargeNamingThemAndNotTheCamera) {
  const auto builtin = [](const std::string& more) {
    return "<texture name='t' builtin='flat' " + more + "/>";
  };
  expect({.asset = builtin("type='2d' width='20000' height='20000'")}, 4,
         {"<texture name=\"t\">", "width is 20000", "8192"});
  expect({.asset = builtin("type='2d' width='65536' height='65536'")}, 4, {"65536"});
  expect({.asset = builtin("type='cube' width='2147483647'")}, 4, {"2147483647"});
  // the header suffices for the check
  write("a.png",
        std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xea\x60\0\0\xea\x60\x08\x02\0\0\0", 29));
  expect({.asset = "<texture name='t' type='2d' file='a.png'/>"}, 4, {"60000 x 60000"});
  expect({.asset = builtin("type='cube' width='8192'")}, 4,
         {"<texture name=\"t\">", "8192 x 49152", "4096 x 24576"});
  std::string all;
  for (int i = 0; i < 1001; ++i) {
    all += "<texture name='t" + std::to_string(i) +
           "' type='2d' builtin='flat' width='8' height='8'/>\n";
  }
  expect({.asset = all}, 1004, {"<texture name=\"t1000\">", "1001 textures", "1000 MB"});
}

TEST_F(SceneRefused, ForASizeThatNoCameraSees) {
  for (const char* extent : {"0", "1e-30", "-3", "1e30"}) {
    expect({.top = std::string("<statistic extent='") + extent + "'/>"}, 2, {"extent", extent});
  }
  // MuJoCo computes it if the scene does not give it
  expect({.world = "<body name='far' pos='900000 900000 900000'><geom size='900000'/></body>"}, 7,
         {"'far'", "1e+06 m"});
}

const pid_t kThisProcess = ::getpid();

TEST_F(SceneRefused, WhereMujocoCrashesAndTheProgramLivesOn) {
  // simulates a crash that no check prevents
  mju_user_malloc = [](std::size_t size) {
    if (::getpid() != kThisProcess) ::raise(SIGSEGV);
    return std::malloc(size);
  };
  const std::string message = refusal(scenario({}));
  mju_user_malloc = nullptr;
  expect_at(scene_.string() + ": ", message,
            {"MuJoCo crashes on this scene (signal SEGV)", "take out what was changed last"});
  EXPECT_NO_THROW(World(scenario({})));
}

TEST_F(SceneRefused, WhereMemoryEnds) {
  mju_user_malloc = [](std::size_t size) {
    return ::getpid() != kThisProcess && size > 1000 ? nullptr : std::malloc(size);
  };
  const std::string message = refusal(scenario({}));
  mju_user_malloc = nullptr;
  expect_at(scene_.string() + ": ", message, {"not enough memory", "ulimit -v"});
}

TEST_F(SceneFile, MayHaveFramesReplicatesAndAttachedModels) {
  write("shelf.xml",
        "<mujoco>\n<option timestep='.01'/>\n<worldbody><body name='shelf'>\n<geom size='.1'/>"
        "</body></worldbody><keyframe><key name='k'/></keyframe></mujoco>");
  const scenario::Scenario s = scenario(
      {.asset = "<model name='m' file='shelf.xml'/>",
       .world = "<frame pos='1 0 0' euler='0 0 90'><body name='framed' pos='1 0 0'><geom "
                "size='.1'/></body></frame>"
                "<replicate count='3' offset='0 1 0'><body name='post' pos='5 0 0'><geom "
                "size='.1'/></body></replicate>"
                "<frame pos='0 0 3'><attach model='m' body='shelf' prefix='a/'/></frame>"});
  const World world(s);
  std::vector<std::string> names;
  for (const Object& object : world.objects()) names.push_back(object.name);
  EXPECT_EQ(names, (std::vector<std::string>{"framed", "post0", "post1", "post2", "a/shelf"}));
  EXPECT_NEAR((world.snapshot().T_WO.at(1).p - Eigen::Vector3d(1, 1, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((world.snapshot().T_WO.at(5).p - Eigen::Vector3d(0, 0, 3)).norm(), 0, 1e-12);
  // a fault in a model is at its own file and line
  write("shelf.xml",
        "<mujoco>\n<worldbody><body name='shelf'>\n<geom type='box'/></body>"
        "</worldbody></mujoco>");
  expect_at((folder_ / "shelf.xml").string() + ":3: ", refusal(s), {"<geom>", "must be positive"});
  write("shelf.xml",
        "<mujoco>\n<worldbody><body name='shelf'>\n<geom colour='red'/></body>"
        "</worldbody></mujoco>");
  expect_at((folder_ / "shelf.xml").string() + ":3: ", refusal(s), {"<geom>", "'colour'"});
  write("shelf.xml", "<mujoco>\n<asset>\n<model file='shelf.xml'/></asset></mujoco>");
  expect_at((folder_ / "shelf.xml").string() + ":3: ", refusal(s), {"more models"});
  expect_at(scene_.string() + ":4: ", refusal(scenario({.asset = "<model file='gone.xml'/>"})),
            {"gone.xml", "missing"});
}

TEST_F(SceneFile, MayDriveABodyThatAnActorMoves) {
  auto s = scenario({.world = "<body name='cart' pos='4 0 1'><joint name='j'/><geom "
                              "size='.1'/></body>",
                     .end = "<actuator><motor joint='j'/><position joint='j' "
                            "timeconst='.1'/></actuator><sensor><jointpos joint='j'/></sensor>"});
  s.actors = {test::line_actor("cart", scenario::Shape::box, {4, 0}, 0, 0.5)};
  s.actors[0].body = "cart";
  const World world(s);
  EXPECT_EQ(world.objects().size(), 1u);
}

TEST_F(SceneRefused, NotForAKeyframeOfItsOwn) {
  // a keyframe of the scene does not cover the rover's joints
  EXPECT_NO_THROW(World(scenario({.end = "<keyframe><key qpos='1 2 3'/></keyframe>"})));
}

TEST_F(SceneRefused, NotForFilesWhoseFoldersAreStripped) {
  write("a.obj", kTetrahedron);
  EXPECT_NO_THROW(World(scenario({.top = "<compiler strippath='true'/>",
                                  .asset = "<mesh name='m' file='/elsewhere/a.obj'/>",
                                  .world = "<geom type='mesh' mesh='m'/>"})));
}

/// Asked of MuJoCo: each file has one place by which it loads, and no other.
TEST_F(SceneFile, FindsFilesWhereMujocoFindsThem) {
  constexpr const char* kBall = "<body name='ball'><geom size='.1'/></body>";
  const std::string in_world = "<mujoco><worldbody>" + std::string(kBall) + "</worldbody></mujoco>";
  const std::string of_mesh =
      "<mujoco><asset><mesh name='m' file='m.obj'/></asset><worldbody><body name='ball'>"
      "<geom type='mesh' mesh='m'/></body></worldbody></mujoco>";
  const std::string elsewhere = (lcs::test::folder_of_the_process() / "elsewhere").string();
  write(elsewhere + "/m.obj", kTetrahedron);
  write(elsewhere + "/part.xml", of_mesh);
  struct Case {
    std::map<std::string, std::string> files;
    Parts parts;
  };
  const std::string attach = "<attach model='m' body='ball' prefix='a/'/>";
  const std::vector<Case> cases = {
      // a model is named from the scene's folder, not from that of meshes
      {{{"robots/m.xml", of_mesh}, {"robots/m.obj", kTetrahedron}, {"meshes/m.obj", "v 0 0 0"}},
       {.top = "<compiler meshdir='meshes'/>",
        .asset = "<model name='m' file='robots/m.xml'/>",
        .world = attach}},
      // an included file may name its own neighbours, or those of the scene
      {{{"a/part.xml", of_mesh}, {"a/m.obj", kTetrahedron}},
       {.end = "<include file='a/part.xml'/>"}},
      {{{"a/part.xml", of_mesh}, {"m.obj", kTetrahedron}}, {.end = "<include file='a/part.xml'/>"}},
      {{{"a/part.xml", "<mujoco><include file='b/c.xml'/></mujoco>"}, {"a/b/c.xml", in_world}},
       {.end = "<include file='a/part.xml'/>"}},
      {{{"a/part.xml", "<mujoco><compiler assetdir='x'/><include file='b.xml'/></mujoco>"},
        {"b.xml", of_mesh},
        {"x/m.obj", kTetrahedron}},
       {.end = "<include file='a/part.xml'/>"}},
      // absolute names
      {{}, {.end = "<include file='" + elsewhere + "/part.xml'/>"}},
      {{},
       {.top = "<compiler meshdir='" + elsewhere + "'/>",
        .asset = "<mesh file='m.obj'/>",
        .world = "<body name='ball'><geom type='mesh' mesh='m'/></body>"}},
      // stripped names, also where an included file says so
      {{{"x/m.obj", kTetrahedron}, {"s.xml", "<mujoco><compiler strippath='true'/></mujoco>"}},
       {.top = "<compiler meshdir='x'/>",
        .asset = "<mesh file='/gone/m.obj'/>",
        .world = "<body name='ball'><geom type='mesh' mesh='m'/></body>",
        .end = "<include file='s.xml'/>"}},
      {{{"meshes/m.obj", kTetrahedron}},
       {.top = "<compiler meshdir='meshes'/>",
        .world = "<body name='ball' pos='0 0 1'><flexcomp name='f' type='mesh' file='m.obj' "
                 "rigid='true'/></body>"}}};
  for (const Case& c : cases) {
    for (const auto& [name, content] : c.files) write(name, content);
    const scenario::Scenario s = scenario(c.parts);
    EXPECT_NO_THROW(World{s}) << c.parts.end << c.parts.world;
    for (const auto& [name, content] : c.files) fs::remove(folder_ / name);
    if (!c.files.empty()) expect_at(folder_.string(), refusal(s), {"file", "; "});
  }
  fs::remove_all(elsewhere);
}

}  // namespace
}  // namespace lcs::sim
