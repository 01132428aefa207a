#include "managers/object_selection.h"

#include "runtime/earth/ellipsoid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

constexpr double kLeast_px = 0.3;  // smaller ones are not shown at all
constexpr double kModel_px = 4.0;  // from here on the model says more than a symbol
constexpr double kBesidePicture =
    0.15;  // objects this share of their distance beside the picture are kept: they may move in

}  // namespace

ObjectShow HowToShow(const ViewParameters& view, const ViewMatrices& matrices, const glm::dvec3& position_ecef,
                     double radius_m, bool has_model) {
  ObjectShow show;
  const double distance = std::max(glm::distance(position_ecef, matrices.eye_ecef) - radius_m, 1.0);
  const BoundingSphere sphere{position_ecef, radius_m};
  if (matrices.horizon.Hides(sphere)) return show;
  if (matrices.frustum.Hides({position_ecef, radius_m + kBesidePicture * distance})) return show;
  show.metre_px =
      view.projection == Projection::kPerspective ? matrices.pixels_per_radian / distance : matrices.pixels_per_metre;
  show.size_px = 2.0 * radius_m * show.metre_px;
  if (view.symbols) {
    show.how = ObjectShow::How::kSymbol;
  } else if (show.size_px >= kModel_px && has_model) {
    show.how = ObjectShow::How::kModel;
  } else if (show.size_px >= kLeast_px) {
    show.how = ObjectShow::How::kSymbol;
  }
  return show;
}

uint8_t ChooseDetail(const ModelPage& model, double metre_px, double error_px) {
  size_t chosen = 0;
  while (chosen + 1 < model.details.size() && model.details[chosen + 1].error_m * metre_px < error_px) ++chosen;
  return static_cast<uint8_t>(chosen);
}

Pose StandOn(const Pose& pose, double ground_height_m, const glm::dvec3& ground_normal_ecef) {
  Geodetic position = ToGeodetic(pose.position_ecef);
  position.height_m = ground_height_m;
  Pose standing = pose;
  standing.position_ecef = ToEcef(position);
  const glm::dvec3 down = -ground_normal_ecef;
  const glm::dvec3 sideways = glm::cross(down, pose.ecef_from_body[0]);
  if (glm::dot(sideways, sideways) < 1e-12) return standing;  // nose straight up or down: no heading to keep
  const glm::dvec3 right = glm::normalize(sideways);
  standing.ecef_from_body = glm::dmat3(glm::cross(right, down), right, down);
  // It drives along the ground: no part of its velocity leads out of it.
  standing.velocity_ecef_mps -= glm::dot(standing.velocity_ecef_mps, ground_normal_ecef) * ground_normal_ecef;
  return standing;
}

std::array<uint8_t, 4> ForceColour(uint8_t force) {
  switch (force) {
    case 1: return {110, 180, 255, 255};
    case 2: return {255, 105, 95, 255};
    case 3: return {120, 230, 130, 255};
    default: return {250, 225, 110, 255};
  }
}

SymbolShape ForceFrame(uint8_t force) {
  switch (force) {
    case 1: return SymbolShape::kFrameFriend;
    case 2: return SymbolShape::kFrameHostile;
    case 3: return SymbolShape::kFrameNeutral;
    default: return SymbolShape::kFrameUnknown;
  }
}

bool MayBeSeen(const ViewMatrices& matrices, const KinematicState& state, double radius_m, double now_s) {
  const double dt_s = std::abs(now_s - state.time_s);
  double moved_m = 0;
  if (state.model != DeadReckoning::kStatic) {
    moved_m = dt_s * glm::length(state.velocity_mps);
    if (ModelAccelerates(state.model)) moved_m += 0.5 * dt_s * dt_s * glm::length(state.acceleration_mps2);
  }
  const double reach_m = radius_m + moved_m + SmoothingOptions{}.jump_m;  // a correction may keep it that far off
  if (matrices.horizon.Hides({state.position_ecef, reach_m})) return false;
  const double distance_m = glm::distance(state.position_ecef, matrices.eye_ecef);
  return !matrices.frustum.Hides({state.position_ecef, reach_m + kBesidePicture * distance_m});
}

}  // namespace belvedere
