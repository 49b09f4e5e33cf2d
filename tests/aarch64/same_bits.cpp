// Usage: same_bits make FILE | same_bits run FILE
//
// `make` writes the corners and motions of some frames to FILE, in hexadecimal. `run` steps the
// default filter through them, and prints all numbers of its layers likewise, so that two builds of
// the filter can be compared bit by bit. The inputs are made once, because they depend on the
// machine's sine and cosine.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "filter/filter.h"
#include "tests/filter/world.h"

namespace {

using lcs::testing::Scene;

void print(const lcs::Vec2& x) {
  std::printf(" %a %a", x.x(), x.y());
}

int make(const char* file) {
  std::ofstream out(file);
  out << std::hexfloat;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Scene scene(seed);
    const auto frames = lcs::testing::record(scene, 40);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      out << frames[k].size() << ' ' << (k == 0 ? 0.0 : scene.motion.dt_s);
      for (const double number : scene.motion.R_cur_prev.reshaped()) out << ' ' << number;
      for (const double number : scene.motion.v_C_mps) out << ' ' << number;
      for (const double number : scene.motion.w_C_radps) out << ' ' << number;
      for (const auto& x : frames[k]) out << ' ' << x.x() << ' ' << x.y();
      out << '\n';
    }
  }
  return out.flush() ? 0 : 1;
}

int run(const char* file) {
  std::ifstream in(file);
  // Streams do not read hexadecimal numbers.
  const auto next = [&] {
    std::string word;
    in >> word;
    return std::strtod(word.c_str(), nullptr);
  };
  lcs::Filter filter(lcs::testing::vga(), {});
  int rebels = 0;
  for (std::string count; in >> count;) {
    lcs::EgoMotion motion;
    motion.dt_s = next();
    for (double& number : motion.R_cur_prev.reshaped()) number = next();
    for (double& number : motion.v_C_mps) number = next();
    for (double& number : motion.w_C_radps) number = next();
    std::vector<Eigen::Vector2f> corners;
    for (std::size_t i = std::stoul(count); i > 0; --i) {
      const double x = next(), y = next();
      corners.emplace_back(static_cast<float>(x), static_cast<float>(y));
    }
    const lcs::FrameResult& result = filter.step(corners, motion);
    for (const lcs::Verdict verdict : result.verdicts) {
      std::printf("%d", static_cast<int>(verdict));
      rebels += verdict == lcs::Verdict::rebel;
    }
    for (const auto* edges : {&result.layers.normal_edges, &result.layers.rebel_edges}) {
      for (const lcs::Edge& edge : *edges) {
        std::printf("\nedge %lld %d", static_cast<long long>(edge.id), edge.trust);
        print(edge.location);
        print(edge.predicted);
        std::printf(" %a %a %a %a", edge.speed, edge.angle, edge.depth_ratio,
                    edge.depth_ratio_sigma);
      }
    }
    for (const lcs::Square& square : result.layers.squares) {
      std::printf("\nsquare %lld", static_cast<long long>(square.id));
      print(square.location);
      for (const lcs::Vec2& vertex : square.outline.vertices()) print(vertex);
    }
    std::printf("\n");
  }
  if (rebels > 100) return 0;
  std::cerr << "only " << rebels << " corners are rebels: the comparison says nothing\n";
  return 1;
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 3 && std::string(arguments[1]) == "make") return make(arguments[2]);
  if (count == 3 && std::string(arguments[1]) == "run") return run(arguments[2]);
  return 2;
}
