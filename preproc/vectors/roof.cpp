#include "preproc/vectors/roof.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace belvedere {
namespace {

constexpr double kUsualSlope = 0.7;     // rise over run, 35 degrees
constexpr double kSkillionSlope = 0.2;  // of a roof that rises all across

glm::dvec2 Across(const RoofFrame& frame) {
  return {-frame.along.y, frame.along.x};
}

}  // namespace

RoofShape RoofShapeOf(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, RoofShape>, 11> kNames = {
      {{"skillion", RoofShape::kSkillion},
       {"lean_to", RoofShape::kSkillion},
       {"gabled", RoofShape::kGabled},
       {"saltbox", RoofShape::kGabled},
       {"gambrel", RoofShape::kGabled},
       {"hipped", RoofShape::kHipped},
       {"half-hipped", RoofShape::kHipped},
       {"mansard", RoofShape::kHipped},
       {"pyramidal", RoofShape::kPyramidal},
       {"cone", RoofShape::kPyramidal},
       {"dome", RoofShape::kPyramidal}}};
  const auto found = std::find_if(kNames.begin(), kNames.end(), [&](const auto& one) { return one.first == name; });
  return found == kNames.end() ? RoofShape::kFlat : found->second;
}

Roof::Roof(RoofShape shape, const RoofFrame& frame, double eaves_m, double rise_m)
    : shape_(shape), frame_(frame), eaves_m_(eaves_m), rise_m_(rise_m) {
  const double length = frame.half_length_m, width = frame.half_width_m;
  if (shape == RoofShape::kGabled || shape == RoofShape::kHipped) AddCrease(0, 1, 0);
  if (shape == RoofShape::kHipped) {
    for (const double l : {-1.0, 1.0}) {
      for (const double d : {-1.0, 1.0}) AddCrease(l, d, length - width);
    }
  }
  if (shape == RoofShape::kPyramidal) {
    AddCrease(1 / length, 1 / width, 0);
    AddCrease(1 / length, -1 / width, 0);
  }
}

void Roof::AddCrease(double normal_l, double normal_d, double c) {
  const double length = std::hypot(normal_l, normal_d);
  const glm::dvec2 normal = (normal_l * frame_.along + normal_d * Across(frame_)) / length;
  creases_.push_back({normal, c / length + normal.x * frame_.middle.x + normal.y * frame_.middle.y});
}

double Roof::HeightAt(glm::dvec2 place) const {
  const glm::dvec2 offset = place - frame_.middle, across = Across(frame_);
  const double l = offset.x * frame_.along.x + offset.y * frame_.along.y;
  const double d = offset.x * across.x + offset.y * across.y;
  const double length = frame_.half_length_m, width = frame_.half_width_m;
  double share = 0;
  switch (shape_) {
    case RoofShape::kFlat: break;
    case RoofShape::kSkillion: share = (d + width) / (2 * width); break;
    case RoofShape::kGabled: share = 1 - std::abs(d) / width; break;
    case RoofShape::kHipped: share = std::min(width - std::abs(d), length - std::abs(l)) / width; break;
    case RoofShape::kPyramidal: share = 1 - std::max(std::abs(d) / width, std::abs(l) / length); break;
  }
  return eaves_m_ + rise_m_ * std::clamp(share, 0.0, 1.0);
}

double UsualRise(RoofShape shape, const RoofFrame& frame) {
  if (shape == RoofShape::kFlat) return 0;
  if (shape == RoofShape::kSkillion) return 2 * frame.half_width_m * kSkillionSlope;
  return frame.half_width_m * kUsualSlope;
}

}  // namespace belvedere
