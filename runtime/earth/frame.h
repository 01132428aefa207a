// Frame: a local coordinate frame, in which 32-bit floats are exact enough to draw the Earth to a millimetre.
//
// Each quadtree has 256 x 256 of them, those of its level-8 quadnodes; a finer quadnode uses the frame of its level-8
// ancestor, a coarser one has a frame of its own. Origin on the ellipsoid at the geographic centre of the quadnode,
// z the outward normal, y towards north, x = y x z (east). Vertices are float in a frame; all else is double in ECEF.
//
// Source: Lindstrom et al., "An integrated global GIS and visual simulation system", section on coordinate systems.
// Threads: values.
#pragma once

#include "runtime/earth/quadcode.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace belvedere {

inline constexpr int kFrameLevel = 8;

struct Frame {
  Quadcode node;  // whose frame it is
  glm::dvec3 origin_ecef{};
  glm::dmat3 ecef_from_frame{};  // columns x (east), y (north), z (up)

  glm::dvec3 ToFrame(const glm::dvec3& ecef) const { return (ecef - origin_ecef) * ecef_from_frame; }
  glm::dvec3 ToEcef(const glm::dvec3& local) const { return origin_ecef + ecef_from_frame * local; }
  glm::dmat4 EcefFromFrame() const;
};

// The quadnode whose frame the vertices of this one are in.
inline Quadcode FrameNode(Quadcode node) {
  return node.level() > kFrameLevel ? node.Ancestor(kFrameLevel) : node;
}
// The frame of FrameNode(node).
Frame FrameOf(Quadcode node);

}  // namespace belvedere
