// InstanceGroups: puts the instances of a display list into an order in which those of one place come together, each
// such group under one culling volume.
//
// Frames:  ECEF, metres.
// Threads: the object manager's.
#pragma once

#include "runtime/scene/display_list.h"

#include <cstdint>
#include <span>
#include <vector>

namespace belvedere {

class InstanceGroups {
 public:
  void Clear() { placed_.clear(); }
  // index: of the instances that Emit gets.
  void Add(uint32_t index, const glm::dvec3& position_ecef);
  // Appends those that were added, with their records and volumes.
  void Emit(std::span<const ObjectInstance> instances, DisplayList& list);

 private:
  struct Placed {
    uint64_t cube = 0;
    uint32_t instance = 0;
  };
  std::vector<Placed> placed_;
};

}  // namespace belvedere
