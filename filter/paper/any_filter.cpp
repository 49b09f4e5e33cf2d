#include "filter/paper/any_filter.h"

#include <stdexcept>

namespace lcs {

std::vector<std::string> preset_names() {
  return {"default", "lab", "cars"};
}

AnyParameters preset(std::string_view name) {
  if (name == "default") return Parameters{};
  if (name == "lab") return paper::PaperParameters{};
  if (name == "cars") return paper::cars();
  throw std::invalid_argument("the filter has no preset '" + std::string(name) +
                              "'; there are default, lab, cars");
}

void set(AnyParameters& parameters, std::string_view key, std::string_view value) {
  std::visit([&](auto& p) { set(p, key, value); }, parameters);
}

void validate(const AnyParameters& parameters) {
  std::visit([](const auto& p) { validate(p); }, parameters);
}

std::vector<ParameterInfo> describe(const AnyParameters& parameters) {
  return std::visit([](const auto& p) { return describe(p); }, parameters);
}

const FieldParameters& field_of(const AnyParameters& parameters) {
  return std::visit([](const auto& p) -> const FieldParameters& { return p.field; }, parameters);
}

AnyFilter::AnyFilter(const Intrinsics& camera, const AnyParameters& parameters)
    : filter_(std::visit(
          [&](const auto& p) -> std::variant<Filter, paper::PaperFilter> {
            if constexpr (std::is_same_v<std::decay_t<decltype(p)>, Parameters>) {
              return Filter(camera, p);
            } else {
              return paper::PaperFilter(camera, p);
            }
          },
          parameters)) {}

const FrameResult& AnyFilter::step(std::span<const Eigen::Vector2f> corners_px,
                                   std::span<const Signature> signatures, const EgoMotion& motion,
                                   GapView* view) {
  if (auto* paper = std::get_if<paper::PaperFilter>(&filter_)) {
    return paper->step(corners_px, signatures, motion);
  }
  return std::get<Filter>(filter_).step(corners_px, signatures, motion, view);
}

const FrameResult& AnyFilter::step(std::span<const Eigen::Vector2f> corners_px,
                                   const EgoMotion& motion, GapView* view) {
  if (auto* paper = std::get_if<paper::PaperFilter>(&filter_)) {
    return paper->step(corners_px, motion);
  }
  return std::get<Filter>(filter_).step(corners_px, motion, view);
}

const Diagnostics& AnyFilter::diagnostics() const {
  return std::visit([](const auto& f) -> const Diagnostics& { return f.diagnostics(); }, filter_);
}

}  // namespace lcs
