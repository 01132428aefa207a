// Engagement events: what a Fire, a Detonation or a Collision shows.
//
// Sizes are by the kind of munition where the result does not say (SISO-REF-010): bullets make sparks and dust, shells
// and guided weapons fire and smoke. Detonations on the ground leave a mark for scorch_s.
//
// Units:   metres, seconds on the clock of now_s. Frames: ECEF.
// Threads: pure.
#pragma once

#include "dis/pdu.h"
#include "runtime/scene/scene_event.h"

#include <vector>

namespace belvedere::dis {

std::vector<SceneEvent> EventsOf(const Fire& fire, double now_s);
std::vector<SceneEvent> EventsOf(const Detonation& detonation, double now_s, double scorch_s);
// issuing: the state of the entity that reports the collision, in whose axes its place is.
SceneEvent EventOf(const Collision& collision, const KinematicState& issuing, double now_s);

}  // namespace belvedere::dis
