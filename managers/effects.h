// Effects: what events and the appearance of objects look like, as soft shapes for the display list.
//
// Pure functions of the time: a puff of smoke is where it is because of when it came out, so that every list, and every
// view, shows the same smoke without remembering it. Appearance bits as IEEE 1278.1 and SISO-REF-010 have them for each
// kind of entity.
//
// Frames: ECEF, metres; clock seconds.
// Threads: pure.
#pragma once

#include "runtime/scene/display_list.h"
#include "runtime/scene/object_table.h"
#include "runtime/scene/scene_event.h"

#include <optional>
#include <span>
#include <vector>

namespace belvedere {

// What an object's appearance asks to be seen, whatever kind of entity it is.
struct SeenAppearance {
  bool smoke = false, engine_smoke = false, flames = false, afterburner = false;
  int trail = 0;  // 0 none to 3 large: dust on land, contrails in the air, a wake at sea, vapour of munitions
  bool head_lights = false, tail_lights = false, brake_lights = false;                    // land
  bool landing_lights = false, navigation_lights = false, anti_collision_lights = false;  // air
  bool running_lights = false;                                                            // sea
  bool any() const {
    return smoke || engine_smoke || flames || afterburner || trail > 0 || head_lights || tail_lights || brake_lights ||
           landing_lights || navigation_lights || anti_collision_lights || running_lights;
  }
};
SeenAppearance AppearanceOf(const EntityType& type, uint32_t appearance);

// How dark an object is painted: 1 undamaged, less with damage.
float ShadeOfDamage(uint32_t damage);

struct EffectMoment {
  double now_s = 0;
  double day = 1;  // 0 in the night: how strong lights seem
};

void AddAppearance(const SeenAppearance& seen, const EntityType& type, const ObjectInstance& object, uint64_t seed,
                   const EffectMoment& moment, std::vector<EffectInstance>& effects);

// ground: height above the ellipsoid and normal under the event, where known; scorch is left out without.
struct EffectGround {
  double height_m = 0;
  glm::dvec3 normal_ecef{};
};
void AddEvent(const SceneEvent& event, double now_s, const std::optional<EffectGround>& ground,
              std::vector<EffectInstance>& effects);

// A line of so many pixels' width, whatever the distance.
EffectInstance ThinLine(const glm::dvec3& from_ecef, const glm::dvec3& to_ecef, float width_px,
                        const std::array<uint8_t, 4>& from_colour, const std::array<uint8_t, 4>& to_colour);

// Where an object was, oldest first, as a line that fades backwards.
struct TrackPoint {
  glm::dvec3 position_ecef{};
  double time_s = 0;
};
void AddTrail(std::span<const TrackPoint> track, const ObjectInstance& object, double now_s, double longest_s,
              std::vector<EffectInstance>& effects);
// Where its report lets it go in the next ahead_s.
void AddVector(const KinematicState& state, const ObjectInstance& object, double now_s, double ahead_s,
               std::vector<EffectInstance>& effects);

}  // namespace belvedere
