// PostGrid: where the posts of a quadnode lie on the Earth, and points evenly between them.
//
// The same post has the same bits whichever quadnode asks. All posts on a pole are one point.
//
// Units: degrees, metres, radians. Frames: ECEF. Threads: values.
#pragma once

#include "runtime/earth/quadcode.h"

#include <glm/vec3.hpp>

#include <vector>

namespace belvedere {

// A parallel, and what the Earth's shape makes of it.
struct RowGeometry {
  double sin_latitude = 0, cos_latitude = 0;  // cosine exactly 0 at a pole
  double prime_vertical_m = 0;                // radius of curvature east-west
  double meridian_m = 0;                      // and north-south
};
RowGeometry RowAt(double latitude_deg);

// A meridian.
struct ColumnGeometry {
  double sin_longitude = 0, cos_longitude = 0;
};

glm::dvec3 EcefAt(const RowGeometry& row, const ColumnGeometry& column, double height_m);

struct PostGrid {
  // per_cell: intervals between points along each side of a cell, a power of two. REQUIRES: per_cell <=
  // node.PostSpacingNorth()
  explicit PostGrid(Quadcode node, int per_cell = 1);

  std::vector<RowGeometry> rows;  // kCells * per_cell + 1, from the south
  std::vector<ColumnGeometry> columns;

  glm::dvec3 At(size_t column, size_t row, double height_m) const {
    return EcefAt(rows[row], columns[column], height_m);
  }
  // The vertical there, a unit vector.
  glm::dvec3 UpAt(size_t column, size_t row) const {
    const auto& [sin_longitude, cos_longitude] = columns[column];
    const RowGeometry& parallel = rows[row];
    return {parallel.cos_latitude * cos_longitude, parallel.cos_latitude * sin_longitude, parallel.sin_latitude};
  }
};

// Width of the quadnode along its longer parallel, in degrees of the equator: comparable with HeightDegrees().
double WidthOnGroundDegrees(Quadcode node);

// How far the ellipsoid rises over a straight line across one cell of the quadnode, at most.
double CellSagitta(Quadcode node);

}  // namespace belvedere
