#include "preproc/vectors/footprint.h"

#include "preproc/vectors/feature.h"
#include "runtime/earth/ellipsoid.h"

#include <geos_c.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace belvedere {
namespace {

using Ring = std::vector<glm::dvec2>;

// One a thread; GEOS says nothing of what it finds.
GEOSContextHandle_t Context() {
  struct Handle {
    GEOSContextHandle_t context = GEOS_init_r();
    ~Handle() { GEOS_finish_r(context); }
  };
  thread_local Handle handle;
  return handle.context;
}

struct GeometryCloser {
  void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(Context(), geometry); }
};
using Geometry = std::unique_ptr<GEOSGeometry, GeometryCloser>;

Geometry LinearRing(const Ring& ring) {
  GEOSCoordSequence* places = GEOSCoordSeq_create_r(Context(), static_cast<unsigned>(ring.size() + 1), 2);
  for (size_t i = 0; i <= ring.size(); ++i) {
    const glm::dvec2& place = ring[i % ring.size()];
    GEOSCoordSeq_setXY_r(Context(), places, static_cast<unsigned>(i), place.x, place.y);
  }
  return Geometry(GEOSGeom_createLinearRing_r(Context(), places));
}

// What lies within an odd number of the rings: the symmetric difference of all.
Geometry AreaOf(const std::vector<Ring>& rings) {
  Geometry area;
  for (const Ring& ring : rings) {
    Geometry polygon(GEOSGeom_createPolygon_r(Context(), LinearRing(ring).release(), nullptr, 0));
    if (polygon && GEOSisValid_r(Context(), polygon.get()) != 1)
      polygon.reset(GEOSMakeValid_r(Context(), polygon.get()));
    if (!polygon) return nullptr;
    if (area) polygon.reset(GEOSSymDifference_r(Context(), area.get(), polygon.get()));
    area = std::move(polygon);
  }
  return area;
}

Ring PlacesOf(const GEOSGeometry* line) {
  Ring ring;
  const GEOSCoordSequence* places = GEOSGeom_getCoordSeq_r(Context(), line);
  unsigned count = 0;
  if (places == nullptr || GEOSCoordSeq_getSize_r(Context(), places, &count) == 0) return ring;
  for (unsigned i = 0; i + 1 < count; ++i) {  // the last is the first
    glm::dvec2 place;
    GEOSCoordSeq_getXY_r(Context(), places, i, &place.x, &place.y);
    ring.push_back(place);
  }
  return ring;
}

double TwiceArea(const Ring& ring) {
  double twice = 0;
  for (size_t i = 0; i < ring.size(); ++i) {
    const glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return twice;
}

void AddRing(const GEOSGeometry* line, bool is_outer, Footprint& out) {
  Ring ring = PlacesOf(line);
  if (ring.size() < 3) return;
  if ((TwiceArea(ring) > 0) != is_outer) std::reverse(ring.begin(), ring.end());
  out.rings.push_back(std::move(ring));
}

// Calls take(polygon) for each there is, however deep.
template <typename Take>
void ForEachPolygon(const GEOSGeometry* geometry, const Take& take) {
  const int type = GEOSGeomTypeId_r(Context(), geometry);
  if (type == GEOS_POLYGON) {
    if (GEOSisEmpty_r(Context(), geometry) == 0) take(geometry);
    return;
  }
  if (type < GEOS_MULTIPOINT) return;
  for (int i = 0; i < GEOSGetNumGeometries_r(Context(), geometry); ++i)
    ForEachPolygon(GEOSGetGeometryN_r(Context(), geometry, i), take);
}

void Triangulate(const GEOSGeometry* area, Footprint& out) {
  const Geometry triangles(GEOSConstrainedDelaunayTriangulation_r(Context(), area));
  if (!triangles) return;
  ForEachPolygon(triangles.get(), [&](const GEOSGeometry* triangle) {
    Ring ring = PlacesOf(GEOSGetExteriorRing_r(Context(), triangle));
    if (ring.size() != 3) return;
    if (TwiceArea(ring) < 0) std::swap(ring[1], ring[2]);
    out.triangles.push_back({ring[0], ring[1], ring[2]});
  });
}

std::array<glm::dvec2, 4> CornersOf(const RoofFrame& frame) {
  const glm::dvec2 along = frame.along * frame.half_length_m;
  const glm::dvec2 across = glm::dvec2(-frame.along.y, frame.along.x) * frame.half_width_m;
  return {frame.middle - along - across, frame.middle + along - across, frame.middle + along + across,
          frame.middle - along + across};
}

// The smallest rectangle around the points, one of whose sides lies on their hull's.
RoofFrame FrameOf(const GEOSGeometry* area) {
  RoofFrame best;
  const Geometry hull(GEOSConvexHull_r(Context(), area));
  const Ring ring = hull && GEOSGeomTypeId_r(Context(), hull.get()) == GEOS_POLYGON
                        ? PlacesOf(GEOSGetExteriorRing_r(Context(), hull.get()))
                        : Ring();
  double smallest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < ring.size(); ++i) {
    const glm::dvec2 side = ring[(i + 1) % ring.size()] - ring[i];
    if (glm::length(side) <= 0) continue;
    glm::dvec2 along = glm::normalize(side), across{-along.y, along.x};
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const glm::dvec2& place : ring) {
      const glm::dvec2 at{glm::dot(place, along), glm::dot(place, across)};
      low = {std::min(low.x, at.x), std::min(low.y, at.y)};
      high = {std::max(high.x, at.x), std::max(high.y, at.y)};
    }
    glm::dvec2 half = (high - low) / 2.0;
    if (half.x * half.y >= smallest) continue;
    smallest = half.x * half.y;
    const glm::dvec2 middle = (low + high) / 2.0;
    best.middle = along * middle.x + across * middle.y;
    if (half.x < half.y) {
      std::swap(half.x, half.y);
      along = across;
    }
    best.along = along;
    best.half_length_m = half.x;
    best.half_width_m = half.y;
  }
  return best;
}

double ReachBeyond(const RoofFrame& frame, const GEOSGeometry* area) {
  double furthest = 0;
  for (const glm::dvec2& corner : CornersOf(frame)) {
    const Geometry point(GEOSGeom_createPointFromXY_r(Context(), corner.x, corner.y));
    double distance = 0;
    if (point && GEOSDistance_r(Context(), point.get(), area, &distance) == 1) furthest = std::max(furthest, distance);
  }
  return furthest;
}

}  // namespace

Footprint Footprint::Box() const {
  Footprint box;
  box.anchor = anchor;
  box.frame = frame;
  const auto corners = CornersOf(frame);
  box.rings = {{corners.begin(), corners.end()}};
  box.triangles = {{corners[0], corners[1], corners[2]}, {corners[0], corners[2], corners[3]}};
  return box;
}

std::optional<Footprint> FootprintOf(const VectorPage& page, const VectorFeature& feature, Quadcode node) {
  const GridPoint corner = node.SouthWest();
  int64_t west = INT64_MAX, south = INT64_MAX, east = INT64_MIN, north = INT64_MIN;
  for (uint32_t p = 0; p < feature.parts; ++p) {
    const VectorPage::Part& part = page.parts[feature.first_part + p];
    for (uint32_t i = 0; i < part.points; ++i) {
      const VectorPoint& point = page.points[part.first_point + i];
      west = std::min<int64_t>(west, point.x);
      east = std::max<int64_t>(east, point.x);
      south = std::min<int64_t>(south, point.y);
      north = std::max<int64_t>(north, point.y);
    }
  }
  if (west >= east || south >= north) return std::nullopt;
  const int64_t middle_x = (west + east) / 2, middle_y = (south + north) / 2;
  Footprint out;
  out.anchor = {static_cast<uint32_t>(int64_t{corner.x} + middle_x),
                static_cast<uint32_t>(std::clamp<int64_t>(int64_t{corner.y} + middle_y, 0, kGridNorthPole))};
  const glm::dvec2 metres = MetresPerDegree(out.anchor.latitude_deg()) / kUnitsPerDegree;
  std::vector<Ring> rings;
  for (uint32_t p = 0; p < feature.parts; ++p) {
    const VectorPage::Part& part = page.parts[feature.first_part + p];
    Ring ring;
    for (uint32_t i = 0; i < part.points; ++i) {
      const VectorPoint& point = page.points[part.first_point + i];
      ring.push_back(metres * glm::dvec2(point.x - middle_x, point.y - middle_y));
      out.radius_m = std::max(out.radius_m, glm::length(ring.back()));
    }
    if (ring.size() >= 3) rings.push_back(std::move(ring));
  }
  const Geometry area = AreaOf(rings);
  if (!area) return std::nullopt;
  ForEachPolygon(area.get(), [&](const GEOSGeometry* polygon) {
    AddRing(GEOSGetExteriorRing_r(Context(), polygon), true, out);
    for (int i = 0; i < GEOSGetNumInteriorRings_r(Context(), polygon); ++i)
      AddRing(GEOSGetInteriorRingN_r(Context(), polygon, i), false, out);
  });
  Triangulate(area.get(), out);
  if (out.rings.empty() || out.triangles.empty()) return std::nullopt;
  out.frame = FrameOf(area.get());
  if (!(out.frame.half_width_m > 0)) return std::nullopt;
  out.box_error_m = ReachBeyond(out.frame, area.get());
  for (const glm::dvec2& place : CornersOf(out.frame)) out.radius_m = std::max(out.radius_m, glm::length(place));
  return out;
}

}  // namespace belvedere
