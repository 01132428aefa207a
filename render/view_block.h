// ViewBlock: what every shader of a view knows of it: shaders/view.glsl, laid out as std140 wants it.
//
// Threads: pure functions.
#pragma once

#include "runtime/earth/frame.h"
#include "runtime/scene/display_list.h"
#include "runtime/scene/view_parameters.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <array>

namespace belvedere {

struct ViewBlock {
  glm::vec4 sun_ecef;
  glm::vec4 eye_scaled;
  glm::vec4 eye_up_ecef;
  std::array<glm::vec4, 3> ray_ecef;
  glm::vec4 viewport_px;
  glm::vec4 moment;
  std::array<glm::vec4, kMaxImageLayers> layers;
};
// since_list_s: since the terrain list was made.
ViewBlock MakeViewBlock(const ViewParameters& view, const ViewMatrices& matrices, const glm::dvec3& sun_ecef,
                        double since_list_s);

// A coordinate frame as the terrain shader knows it: FrameRow of shaders/terrain.vert.glsl, std430.
struct FrameRow {
  glm::mat4 clip_from_frame;                   // multiplied in double
  std::array<glm::vec4, 3> scaled_from_frame;  // rows
  glm::vec4 earth_centre;                      // in the frame
};
FrameRow MakeFrameRow(const Frame& frame, const glm::dmat4& clip_from_ecef);

// Light and air at one place, as shaders/atmosphere.glsl has them, for things that are lit as a whole.
struct Daylight {
  float day = 1;        // of full light
  glm::vec3 air{0.0F};  // added
  float left = 1;       // share of the own light that comes through the air
};
Daylight DaylightAt(const glm::dvec3& position_ecef, const ViewMatrices& matrices, const glm::dvec3& sun_ecef);

// Depth in metres along the view axis of what the depth buffer holds; infinity for the sky's 0.
float AxisDistance(const glm::dmat4& clip_from_camera, Projection projection, float depth);
// The other way round.
float DepthAt(const glm::dmat4& clip_from_camera, Projection projection, double distance_m);

}  // namespace belvedere
