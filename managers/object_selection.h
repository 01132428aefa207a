// Object selection: which moving objects one view shows, and how. Pure; the object manager feeds it.
//
// An object is left out when the horizon hides it, when it is beside the picture, or when it would be smaller than
// kLeast_px. From kModel_px on it is drawn as its model, at the coarsest level of detail whose error stays under a
// pixel; below that, or where the view asks for symbols, as a symbol of constant size.
//
// Frames: ECEF, metres. Units: pixels on the view's picture.
// Threads: pure.
#pragma once

#include "runtime/scene/display_list.h"
#include "runtime/scene/entity_looks.h"
#include "runtime/scene/motion.h"
#include "runtime/scene/object_table.h"
#include "runtime/scene/view_parameters.h"

#include <string>

namespace belvedere {

struct ObjectShow {
  enum class How : uint8_t { kNot, kModel, kSymbol };
  How how = How::kNot;
  double size_px = 0;   // diameter of its bounding sphere on the picture
  double metre_px = 0;  // pixels that one metre spans at its distance
};

// radius_m: of the object's bounding sphere. has_model: a model page could be drawn.
ObjectShow HowToShow(const ViewParameters& view, const ViewMatrices& matrices, const glm::dvec3& position_ecef,
                     double radius_m, bool has_model);

// The coarsest level whose error is under that many pixels.
uint8_t ChooseDetail(const ModelPage& model, double metre_px, double error_px = 1.0);

// Triangles that the models of one view may have together. Where those within a pixel have more, all become coarser.
inline constexpr uint64_t kMostObjectTriangles = 400'000;

// The pose of a vehicle that stands on the ground: lowered or raised onto it, upright to its normal, heading kept.
Pose StandOn(const Pose& pose, double ground_height_m, const glm::dvec3& ground_normal_ecef);

// Colour by force: friendly blue, opposing red, neutral green, others yellow.
std::array<uint8_t, 4> ForceColour(uint8_t force);

// The frame in the manner of APP-6: friendly rectangle, opposing diamond, neutral square, others quatrefoil.
SymbolShape ForceFrame(uint8_t force);

// False when the object cannot be in the picture, wherever its report lets it be dead-reckoned to by now. Cheap:
// nothing is dead-reckoned.
bool MayBeSeen(const ViewMatrices& matrices, const KinematicState& state, double radius_m, double now_s);

}  // namespace belvedere
