// Terrain builder: from the heights of a quadnode to the page that managers select from and the render thread draws.
//
// Vertices. Each post goes from geodetic coordinates to ECEF and into the quadnode's frame in double, and is rounded to
// float once; at level 8 and finer it is within a millimetre of where it belongs. All posts on a pole are one point.
//
// Normals come from the slopes between the neighbouring posts on either side, the apron included, so that they are the
// same on both sides of a border. Below the end of the data the slopes of the finest posts are interpolated: shading
// stays smooth where geometry is a bilinear surface.
//
// Delta values (delta_values.h) are those of the dataset, which the builder made of the finest posts there are, where
// the page is the quadnode's own, its heights are as they were and no border is laid elsewhere. Otherwise they are made
// here, of the page's own posts and of what its blocks leave out around each.
//
// Vertical exaggeration multiplies heights before anything is made of them.
//
// Units: metres. Frames: frame.h. Threads: pure.
#pragma once

#include "runtime/earth/visibility.h"
#include "runtime/paging/page.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace belvedere {

struct TerrainInput {
  Quadcode node;
  // Heights of `heights_node`, which is the quadnode or an ancestor of it; nullptr: the bare ellipsoid.
  const ElevationPage* heights = nullptr;
  Quadcode heights_node;
  // Finer heights than these lie under the quadnode. Without heights: finer quadnodes exist at all.
  bool finer_exists = false;
  double exaggeration = 1;  // > 0
  // ECEF positions for the posts of a border, from its south or west end, in the order of Side; none: those of the
  // heights. Where data end, what lies beyond is coarser: there the finer surface is laid on the edge of the coarser
  // one, so that the two are one surface at full resolution, without a step.
  std::array<std::vector<glm::dvec3>, 4> laid_ecef{};
};

// The borders of a quadnode.
enum class Side : uint8_t { kWest, kEast, kSouth, kNorth };

// The posts of one border of the input's quadnode as it would be built, laid_ecef left out.
std::vector<glm::dvec3> BorderPosts(const TerrainInput& input, Side side);

// The edge of `coarser`, whose border posts those are, at the posts of the quadnode's border on that side: between two
// posts a straight line. REQUIRES: coarser lies beside the quadnode, and its posts there are as far apart or further.
std::vector<glm::dvec3> LaidOn(Quadcode node, Side side, Quadcode coarser, const std::vector<glm::dvec3>& posts);

std::unique_ptr<TerrainPage> BuildTerrain(const TerrainInput& input);

}  // namespace belvedere
