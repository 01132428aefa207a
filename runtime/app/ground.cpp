#include "runtime/app/ground.h"

#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/visibility.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace belvedere {
namespace {

constexpr double kHighestGround_m = 9'000.0;
constexpr int kMarchSteps = 160;
constexpr int kBisections = 48;

// Where the line enters and leaves the ellipsoid raised by height_m.
struct Span {
  double enter = 0, leave = 0;
};
std::optional<Span> SpanWithin(const SightLine& line, double height_m) {
  const double equatorial = kEquatorialRadius_m + height_m, polar = kPolarRadius_m + height_m;
  const glm::dvec3 scale{1.0 / equatorial, 1.0 / equatorial, 1.0 / polar};
  const glm::dvec3 origin = line.origin_ecef * scale, direction = line.direction * scale;
  const double a = glm::dot(direction, direction);
  const double b = glm::dot(origin, direction);
  const double c = glm::dot(origin, origin) - 1.0;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return std::nullopt;
  // The root with the larger sum first: the other follows without cancellation.
  const double root = std::sqrt(discriminant);
  const double q = b >= 0 ? -b - root : -b + root;
  if (q == 0) return Span{0, 0};
  const double first = q / a, second = c / q;
  return Span{std::min(first, second), std::max(first, second)};
}

double HeightOverGround(const glm::dvec3& point, const GroundHeight& ground) {
  const Geodetic place = ToGeodetic(point);
  return place.height_m - ground(place.latitude_deg, place.longitude_deg);
}

}  // namespace

std::optional<double> DistanceToEllipsoid(const SightLine& line, double height_m) {
  const auto span = SpanWithin(line, height_m);
  if (!span || span->leave < 0) return std::nullopt;
  return span->enter >= 0 ? span->enter : span->leave;
}

std::optional<glm::dvec3> MeetGround(const SightLine& line, const GroundHeight& ground) {
  const auto shell = SpanWithin(line, kHighestGround_m);
  if (!shell || shell->leave <= 0) return std::nullopt;
  const double start = std::max(shell->enter, 0.0);
  double end = shell->leave;
  if (const auto core = SpanWithin(line, kDeepestGround_m); core && core->enter > start) end = core->enter;

  // Steps that grow: fine near the eye, where the ground is seen from close by.
  const auto distance_at = [&](double share) { return start + (end - start) * share * share; };
  const auto point_at = [&](double distance) { return line.origin_ecef + line.direction * distance; };
  double above = start;
  if (HeightOverGround(point_at(start), ground) <= 0) return point_at(start);
  for (int step = 1; step <= kMarchSteps; ++step) {
    double below = distance_at(static_cast<double>(step) / kMarchSteps);
    if (HeightOverGround(point_at(below), ground) > 0) {
      above = below;
      continue;
    }
    for (int i = 0; i < kBisections && below - above > 1e-7 * below; ++i) {
      const double middle = 0.5 * (above + below);
      (HeightOverGround(point_at(middle), ground) > 0 ? above : below) = middle;
    }
    return point_at(below);
  }
  return std::nullopt;
}

glm::dvec3 NearestOnLimb(const SightLine& line) {
  const double along = std::max(-glm::dot(line.origin_ecef, line.direction), 0.0);
  const glm::dvec3 nearest = line.origin_ecef + line.direction * along;
  Geodetic place = ToGeodetic(nearest);
  place.height_m = 0;
  return ToEcef(place);
}

}  // namespace belvedere
