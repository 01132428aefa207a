#include "managers/instance_groups.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

constexpr double kCubeSide_m = 500e3;
constexpr double kLookAhead_s = 0.5;  // a volume holds where its objects will be until the next list

// The cube that a place lies in: 21 bits of each of its numbers.
uint64_t CubeOf(const glm::dvec3& position_ecef) {
  constexpr double kMost = 1 << 20;
  uint64_t cube = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::clamp(std::floor(position_ecef[axis] / kCubeSide_m) + kMost, 0.0, 2 * kMost - 1);
    cube = cube << 21 | static_cast<uint64_t>(cell);
  }
  return cube;
}

}  // namespace

void InstanceGroups::Add(uint32_t index, const glm::dvec3& position_ecef) {
  placed_.push_back({CubeOf(position_ecef), index});
}

void InstanceGroups::Emit(std::span<const ObjectInstance> instances, DisplayList& list) {
  std::sort(placed_.begin(), placed_.end(), [](const Placed& a, const Placed& b) {
    return a.cube != b.cube ? a.cube < b.cube : a.instance < b.instance;
  });
  list.instances.reserve(placed_.size());
  for (size_t begin = 0; begin < placed_.size();) {
    size_t end = begin;
    glm::dvec3 center(0.0);
    const auto first = static_cast<uint32_t>(list.instances.size());
    for (; end < placed_.size() && placed_[end].cube == placed_[begin].cube; ++end) {
      list.instances.push_back(instances[placed_[end].instance]);
      center += list.instances.back().position_ecef;
    }
    center /= static_cast<double>(end - begin);
    double radius = 0;
    for (size_t i = first; i < list.instances.size(); ++i) {
      const ObjectInstance& instance = list.instances[i];
      radius = std::max(radius, glm::distance(center, instance.position_ecef) + instance.radius_m +
                                    kLookAhead_s * glm::length(instance.velocity_mps));
    }
    const auto record = static_cast<uint32_t>(list.records.size());
    list.records.push_back({ListRecord::Kind::kCullBegin, static_cast<uint32_t>(list.volumes.size()), 0, record + 3});
    list.records.push_back({ListRecord::Kind::kDrawInstances, first, static_cast<uint32_t>(end - begin), 0});
    list.records.push_back({ListRecord::Kind::kCullEnd, 0, 0, 0});
    list.volumes.push_back({center, radius});
    begin = end;
  }
}

}  // namespace belvedere
