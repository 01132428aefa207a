// BorderLines: the grid lines along which quadnodes of a cut meet, and the one vertex that each position on them has.
//
// Every quadnode adds the posts that it draws on its four borders. Seal then settles, for each position, the canonical
// vertex: that of the narrowest quadnode, among equals that of the finest, then of the least quadcode. All quadnodes
// that touch a position in their corner agree on it along the meridian and along the parallel, since the narrowest of
// them always has it in a corner, also where rows change their width (quadcode.h).
//
// A corner names a vertex by its quadnode: (number of the quadnode in the cut) << 15 | number among the quadnode's own,
// packed as ListVertex::place is.
//
// Units: positions in grid units (quadcode.h).
// Threads: one.
#pragma once

#include "runtime/earth/quadcode.h"
#include "runtime/scene/display_list.h"

#include <cstdint>
#include <span>
#include <vector>

namespace belvedere {

enum class Border : uint8_t { kWest, kEast, kSouth, kNorth };

// A quadnode has no more vertices than posts: they fit in as many bits.
constexpr uint32_t CornerOf(uint32_t node, uint32_t own_vertex) {
  return ListVertex::PlaceOf(node, own_vertex);
}
constexpr uint32_t NodeOf(uint32_t corner) {
  return corner >> ListVertex::kPostBits;
}
constexpr uint32_t OwnVertexOf(uint32_t corner) {
  return corner & ListVertex::kPostMask;
}

struct BorderVertex {
  uint64_t line = 0;      // meridian: grid x; parallel: grid y with kParallel set
  uint64_t position = 0;  // along the line; 2^32 on a parallel is 180 E seen from the west
  uint32_t corner = 0;
  uint32_t rank = 0;  // lower wins
};

class BorderLines {
 public:
  void Clear();
  // rank: the place of the quadnode among all of the cut, narrowest first (RankNodes).
  void Add(Quadcode node, Border border, int post, uint32_t corner, uint32_t rank);
  // No Add after this.
  void Seal();

  // Canonical vertices along that border of the quadnode, corners included, from its south or west end.
  std::span<const BorderVertex> Along(Quadcode node, Border border) const;

  // All canonical vertices; those on 180 E may be there twice.
  std::span<const BorderVertex> vertices() const { return vertices_; }

  static uint64_t PositionOf(Quadcode node, Border border, int post);
  static uint32_t SpacingAlong(Quadcode node, Border border);

 private:
  static constexpr uint64_t kParallel = uint64_t{1} << 32;
  static uint64_t LineOf(Quadcode node, Border border);

  std::vector<BorderVertex> vertices_;
};

}  // namespace belvedere
