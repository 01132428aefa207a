#include "render/view_block.h"

#include "runtime/earth/ellipsoid.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace belvedere {
namespace {

const glm::dvec3 kAxes{kEquatorialRadius_m, kEquatorialRadius_m, kPolarRadius_m};

constexpr double kLongest_s = 1e4;         // nothing of a list is on its way for so long
constexpr double kScaleHeight_m = 8000.0;  // as in shaders/atmosphere.glsl

double SmoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

ViewBlock MakeViewBlock(const ViewParameters& view, const ViewMatrices& matrices, const glm::dvec3& sun_ecef,
                        double since_list_s) {
  ViewBlock block{};
  const Geodetic eye = ToGeodetic(matrices.eye_ecef);
  block.sun_ecef =
      glm::vec4(glm::vec3(sun_ecef), static_cast<float>(std::exp(-std::max(eye.height_m, 0.0) / kScaleHeight_m)));
  block.eye_scaled = glm::vec4(glm::vec3(matrices.eye_ecef / kAxes), static_cast<float>(eye.height_m));
  block.eye_up_ecef = glm::vec4(glm::vec3(UpAt(eye.latitude_deg, eye.longitude_deg)),
                                static_cast<float>(glm::length(matrices.eye_ecef)));
  const double tan_y = std::tan(0.5 * view.vertical_fov.value);
  const double tan_x = tan_y * view.width_px / view.height_px;
  const bool parallel = view.projection == Projection::kOrthographic;
  const auto ray = [&](double clip_x, double clip_y) {
    const glm::dvec3 camera = parallel ? glm::dvec3(0, 0, -1) : glm::dvec3(clip_x * tan_x, clip_y * tan_y, -1.0);
    return glm::vec4(glm::vec3(view.ecef_from_camera * camera), 0.0F);
  };
  block.ray_ecef = {ray(-1, -1), ray(3, -1), ray(-1, 3)};
  const auto width = static_cast<float>(view.width_px);
  const auto height = static_cast<float>(view.height_px);
  block.viewport_px = {width, height, 1.0F / width, 1.0F / height};
  for (size_t i = 0; i < std::min(view.image_layers.size(), block.layers.size()); ++i) {
    const LayerUse& layer = view.image_layers[i];
    block.layers[i] = {layer.opacity, layer.gamma, layer.multiplier, 0.0F};
  }
  block.moment = {static_cast<float>(std::clamp(since_list_s, 0.0, kLongest_s)),
                  static_cast<float>(std::max(static_cast<int>(view.tint) - 1, 0)), 0.0F, 0.0F};
  return block;
}

FrameRow MakeFrameRow(const Frame& frame, const glm::dmat4& clip_from_ecef) {
  FrameRow row{};
  row.clip_from_frame = glm::mat4(clip_from_ecef * frame.EcefFromFrame());
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec4 scaled(frame.ecef_from_frame[0][axis], frame.ecef_from_frame[1][axis],
                            frame.ecef_from_frame[2][axis], frame.origin_ecef[axis]);
    row.scaled_from_frame[static_cast<size_t>(axis)] = glm::vec4(scaled / kAxes[axis]);
  }
  row.earth_centre = glm::vec4(glm::vec3(frame.ToFrame(glm::dvec3(0.0))), 0.0F);
  return row;
}

// The formulas of shaders/terrain.vert.glsl, without the reddening of a low sun.
Daylight DaylightAt(const glm::dvec3& position_ecef, const ViewMatrices& matrices, const glm::dvec3& sun_ecef) {
  constexpr double kDepthPerMetre = 0.12 * 0.5 / kScaleHeight_m;
  const Geodetic here = ToGeodetic(position_ecef);
  const Geodetic eye = ToGeodetic(matrices.eye_ecef);
  const glm::dvec3 up = UpAt(here.latitude_deg, here.longitude_deg);
  const double sun_sine = glm::dot(up, sun_ecef);
  const glm::dvec3 to_eye = matrices.eye_ecef - position_ecef;
  const double distance_m = std::max(glm::length(to_eye), 1.0);
  const double climb = (eye.height_m - here.height_m) / kScaleHeight_m;
  const double mean_share = std::abs(climb) < 0.05 ? 1.0 : (1.0 - std::exp(-climb)) / climb;
  const double rise = glm::dot(up, to_eye) / distance_m;
  const double path_m = std::min(distance_m * mean_share, kScaleHeight_m / (std::max(rise, 0.0) + 0.012));
  const double depth = kDepthPerMetre * std::exp(-std::max(here.height_m, 0.0) / kScaleHeight_m) * path_m;
  const glm::dvec3 scatter(0.70, 1.00, 1.60);
  const glm::dvec3 airlight(0.80, 0.88, 0.97);
  const glm::dvec3 veil = airlight * (1.0 - glm::exp(-depth * scatter));
  Daylight light;
  light.day = static_cast<float>(0.12 + 0.88 * SmoothStep(-0.12, 0.30, sun_sine));
  light.air = glm::vec3(veil * (0.02 + 0.98 * SmoothStep(-0.20, 0.18, sun_sine)));
  light.left = static_cast<float>(1.0 - veil.g);
  return light;
}

float AxisDistance(const glm::dmat4& clip_from_camera, Projection projection, float depth) {
  if (depth <= 0.0F) return std::numeric_limits<float>::infinity();
  if (projection == Projection::kPerspective) {
    return static_cast<float>(clip_from_camera[3][2] / (static_cast<double>(depth) + clip_from_camera[2][2]));
  }
  return static_cast<float>((clip_from_camera[3][2] - static_cast<double>(depth)) / clip_from_camera[2][2]);
}

float DepthAt(const glm::dmat4& clip_from_camera, Projection projection, double distance_m) {
  const double scale = clip_from_camera[2][2];
  const double offset = clip_from_camera[3][2];
  const double depth =
      projection == Projection::kPerspective ? offset / distance_m - scale : offset - scale * distance_m;
  return static_cast<float>(std::clamp(depth, 0.0, 1.0));
}

}  // namespace belvedere
