/// \file
/// The steps of the paper's filter, applied to the layers of a frame in place.
#pragma once

#include <vector>

#include "filter/paper/feedback.h"
#include "filter/paper/paper_circles.h"
#include "filter/paper/paper_edges.h"
#include "filter/paper/paper_squares.h"
#include "tests/filter/world.h"

namespace lcs::testing {

class EdgeSteps {
 public:
  explicit EdgeSteps(const paper::PaperParameters& p = {})
      : expert(vga(), p.edge, p.circle.trust) {}

  void predict(Layers& layers, const MotionField& field) {
    put(expert.predict(layer_of(layers), field), layers);
  }
  /// \return the verdict of each corner of chi.
  std::vector<Verdict> update(Layers& layers, const Chi& chi, const std::vector<int>& groups,
                              const MotionField& field) {
    const auto& result = expert.update(layer_of(layers), chi, groups, layers.ignored, field);
    put(result.layer, layers);
    return result.verdicts;
  }

  paper::PaperEdges expert;

 private:
  static paper::EdgeLayer layer_of(const Layers& layers) {
    return {{layers.normal_edges, layers.rebel_edges}, layers.chains};
  }
  static void put(const paper::EdgeLayer& layer, Layers& layers) {
    layers.normal_edges = layer.edges.normal;
    layers.rebel_edges = layer.edges.rebel;
    layers.chains = layer.chains;
  }
};

class CircleSteps {
 public:
  explicit CircleSteps(const paper::PaperCircleParameters& p = {}, bool ignore = false)
      : expert_(vga(), p, paper::PaperEdgeParameters{}.corner_noise, ignore) {}

  void predict(Layers& layers, const MotionField& field) {
    put(expert_.predict({layers.normal_circles, layers.rebel_circles}, field), layers);
  }
  void update(Layers& layers, const MotionField& field) {
    const auto& [circles, of_edges] =
        expert_.update({layers.normal_edges, layers.rebel_edges},
                       {layers.normal_circles, layers.rebel_circles}, layers.ignored, field);
    put(circles, layers);
    for (std::size_t i = 0; i < layers.normal_edges.size(); ++i) {
      layers.normal_edges[i].circle = of_edges.normal[i];
    }
    for (std::size_t i = 0; i < layers.rebel_edges.size(); ++i) {
      layers.rebel_edges[i].circle = of_edges.rebel[i];
    }
  }

 private:
  static void put(const BothKinds<Circle>& circles, Layers& layers) {
    layers.normal_circles = circles.normal;
    layers.rebel_circles = circles.rebel;
  }
  paper::PaperCircles expert_;
};

class SquareSteps {
 public:
  explicit SquareSteps(const paper::PaperSquareParameters& p = {}, bool ignore = false)
      : expert_(vga(), p, ignore) {}

  void predict(Layers& layers, const MotionField& field) {
    layers.squares = expert_.predict(std::vector<Square>(layers.squares), field);
  }
  void update(Layers& layers, const MotionField& field) {
    layers.squares = expert_.update({layers.normal_circles, layers.rebel_circles}, layers.squares,
                                    layers.ignored, field);
  }

 private:
  paper::PaperSquares expert_;
};

}  // namespace lcs::testing
