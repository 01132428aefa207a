// MovedObjects: where the instances of a display list are at a frame's time, and where on the screen that is.
//
// A list gives instances at its own time; they are moved on by their velocity and turned by their angular velocity, for
// at most kLongestExtrapolation_s (a manager that stopped must not send them round the Earth).
//
// Units:   metres, seconds; pixels from the upper left corner, y downwards.
// Frames:  ECEF, double.
// Threads: pure functions.
#pragma once

#include "render/list_walk.h"
#include "runtime/scene/display_list.h"
#include "runtime/scene/view_parameters.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace belvedere {

inline constexpr double kLongestExtrapolation_s = 2.0;

struct MovedObject {
  uint32_t instance = 0;  // index -> DisplayList::instances
  glm::dvec3 position_ecef{};
  glm::dmat3 ecef_from_body{1.0};
  double distance_m = 0;  // along the view axis
  glm::vec2 screen_px{};  // of its origin
  float radius_px = 0;    // that its sphere has on the screen
};

// The objects of those ranges that the frustum and the horizon leave, nearest first.
std::vector<MovedObject> MoveObjects(const DisplayList& list, std::span<const InstanceRange> ranges,
                                     const ViewParameters& view, const ViewMatrices& matrices, double now_s);

// Whether it is drawn as a model (else as a symbol, if it has one).
bool DrawnAsModel(const ObjectInstance& instance, const ViewParameters& view);

}  // namespace belvedere
