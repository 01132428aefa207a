// Footing: what an entity stands on, and how it stays on it while the ground under it becomes finer or coarser.
//
// Land vehicles and life forms on land stand on the drawn ground, ships on the sea; what flies or dives is where it
// says.
//
// Units:   metres, seconds. Frames: ECEF; heights above the ellipsoid, as drawn.
// Threads: pure; a GroundBlend belongs to its user.
#pragma once

#include "runtime/paging/terrain_height.h"
#include "runtime/scene/entity.h"

namespace belvedere {

enum class Footing : uint8_t { kNone, kGround, kSea };
Footing FootingOf(const EntityType& type);

// Mean sea level there: the EGM96 geoid where the machine has its grid, else the ellipsoid.
double SeaHeight(double latitude_deg, double longitude_deg);

// The ground under one object. When a page of another level answers for it, what is shown goes from what it was to what
// it is in kGroundBlend_s.
inline constexpr double kGroundBlend_s = 0.4;
class GroundBlend {
 public:
  // now_s does not go back.
  GroundPoint Show(const GroundPoint& ground, double now_s);

 private:
  int level_ = -1;
  double shown_m_ = 0;
  glm::dvec3 shown_normal_{0.0};
  double off_m_ = 0;  // over the page's ground when the blend began
  glm::dvec3 off_normal_{0.0};
  double begun_s_ = -1e9, last_s_ = -1e9;
};

}  // namespace belvedere
