// Visibility: what a frustum and the Earth's own curve hide. Conservative: "hidden" is certain, "visible" may be wrong.
//
// Frames: ECEF, metres, double.
// Source: the horizon test is the cone of Zeitler, "Planets in WebGL" (Linkoeping 2015): a point is hidden when it lies
// behind the plane of the horizon circle and inside the cone from the eye to it; here in a space scaled so that the
// ellipsoid is a unit sphere, and shrunk below the deepest ground.
// Threads: pure functions.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>

namespace belvedere {

struct BoundingSphere {
  glm::dvec3 center_ecef{};
  double radius_m = 0;
};

// The five planes of a view with its far plane left open: nothing is beyond the horizon that the horizon test keeps.
class Frustum {
 public:
  Frustum() = default;
  // clip_from_ecef: reverse-Z, depth 1 at the near plane.
  explicit Frustum(const glm::dmat4& clip_from_ecef);
  bool Hides(const BoundingSphere& sphere) const;
  // Wholly inside: nothing within needs a test of its own.
  bool Encloses(const BoundingSphere& sphere) const;

 private:
  std::array<glm::dvec4, 5> planes_{};  // left, right, bottom, top, near; normals point inwards, unit length
};

// Lowest ground that the horizon test reckons with, metres above the ellipsoid (the Challenger Deep is at -10.9 km).
inline constexpr double kDeepestGround_m = -11'500.0;

class Horizon {
 public:
  Horizon() = default;  // hides nothing
  // exaggeration: of heights; it deepens the sea as it raises the mountains.
  explicit Horizon(const glm::dvec3& eye_ecef, double exaggeration = 1.0);
  bool Hides(const BoundingSphere& sphere) const;

 private:
  glm::dvec3 scale_{1.0};        // the shrunken ellipsoid from ECEF
  glm::dvec3 eye_scaled_{};      // in units of the shrunken ellipsoid
  double horizon_squared_ = -1;  // |eye|^2 - 1; negative when the eye is inside: nothing is hidden
};

}  // namespace belvedere
