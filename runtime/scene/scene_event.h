// SceneEvent: something that happens at a place and is seen for a while: a shot, an explosion, a mark on the ground.
//
// Units: metres, seconds on the user's Clock::NowSeconds. Frames: ECEF.
// Threads: values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

namespace belvedere {

struct SceneEvent {
  enum class Kind : uint8_t {
    kMuzzleFlash,
    kTracer,     // flies by velocity_mps
    kExplosion,  // fire, then smoke
    kDust,       // thrown up where something hits the ground without exploding
    kScorch,     // lies on the ground under position_ecef
    kCollision,
  };
  Kind kind = Kind::kExplosion;
  glm::dvec3 position_ecef{0.0};
  glm::dvec3 velocity_mps{0.0};
  float size_m = 5;  // radius of what is seen at its largest
  double start_s = 0, end_s = 0;
  uint32_t number = 0;  // counts events: makes one look unlike the next
};

// Of those that are there at once; the oldest makes room.
inline constexpr size_t kMostSceneEvents = 1024;

}  // namespace belvedere
