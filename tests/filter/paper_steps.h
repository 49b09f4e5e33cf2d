/// \file
/// The steps of the paper's filter, applied to the layers of a frame in place.
#pragma once

#include <span>
#include <vector>

#include "filter/paper/paper_circles.h"
#include "filter/paper/paper_edges.h"
#include "filter/paper/paper_filter.h"
#include "filter/paper/paper_squares.h"
#include "tests/filter/world.h"

namespace lcs::testing {

/// All layers of the paper's filter.
struct AllLayers : Layers, PaperLayers {};

class EdgeSteps {
 public:
  explicit EdgeSteps(const paper::PaperParameters& p = {})
      : expert(vga(), p.edge, p.circle.trust) {}

  void predict(AllLayers& layers, const MotionField& field) {
    paper::EdgeLayer layer = layer_of(layers);
    expert.predict(layer, field);
    put(layer, layers);
  }
  /// \return the verdict of each corner of chi.
  std::vector<Verdict> update(AllLayers& layers, const Chi& chi, const std::vector<int>& groups,
                              const MotionField& field) {
    paper::EdgeLayer layer = layer_of(layers);
    const auto& [verdicts, reasons] = expert.update(layer, chi, groups, layers.ignored, field);
    put(layer, layers);
    return verdicts;
  }

  paper::PaperEdges expert;

 private:
  static paper::EdgeLayer layer_of(const AllLayers& layers) {
    return {{layers.normal_edges, layers.rebel_edges}, layers.chains};
  }
  static void put(const paper::EdgeLayer& layer, AllLayers& layers) {
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
    BothKinds<Circle> circles{layers.normal_circles, layers.rebel_circles};
    expert_.predict(circles, field);
    put(circles, layers);
  }
  void update(Layers& layers, const MotionField& field, std::span<const IgnoreRegion> psi = {}) {
    CircleExpert::Result result{{layers.normal_circles, layers.rebel_circles}, {}};
    expert_.update({layers.normal_edges, layers.rebel_edges}, psi, field, result);
    const auto& [circles, of_edges] = result;
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

  void predict(Layers& layers, const MotionField& field) { expert_.predict(layers.squares, field); }
  void update(Layers& layers, const MotionField& field, std::span<const IgnoreRegion> psi = {}) {
    expert_.update({layers.normal_circles, layers.rebel_circles}, psi, field, layers.squares);
  }

 private:
  paper::PaperSquares expert_;
};

}  // namespace lcs::testing
