// Quadcode: the name of one quadnode of the 32 quadtrees that cover the Earth, in one 64-bit word.
//
//   bits 63..59  tree, 0..31: 8 * row + column; column 0 spans longitudes [-180, -135), row 0 latitudes [-90, -45]
//   bits 58..0   code within the tree: 0 is the root, the children of q are 4q+1 .. 4q+4 = SW, SE, NW, NE
//
// Poles. Towards a pole meridians draw together, so a quadnode that touches one is split along its middle parallel
// alone (decision 0023): into the child that touches the pole again and the one beside it, both as wide as itself.
// Their codes are those of the western of the two children that there would be elsewhere; the eastern ones do not
// exist. The root alone has two children on its side away from the pole. What is under a child beside the pole is split
// in four as everywhere. So 8 quadnodes meet at a pole, whatever their level; of the others from 67.5 degrees on none
// is more than 1.6 times as wide on the ground as it is tall, nor less than 0.7 times.
//
// GridPoint is the exact fixed-point position in which posts, borders and texels of all levels meet: x counts units of
// 45 degrees / 2^29 east of 180 W (it wraps at 2^32, as longitude does), y the same units north of 90 S, 0 .. 2^31.
// A quadnode of level L is 2^(29-L) units tall, and as wide or, from 67.5 degrees on, 2^Doublings() times as wide.
// Level 22, the finest, has posts 9 mm apart.
//
// A quadnode carries kPosts x kPosts = 129 x 129 posts; the outermost ones lie on its border and are shared, bit for
// bit, with its neighbours. Posts are numbered row by row from the south-west corner: index = row * kPosts + column.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

inline constexpr int kTrees = 32;
inline constexpr int kTreeColumns = 8;
inline constexpr int kTreeRows = 4;
inline constexpr double kTreeDegrees = 45.0;
inline constexpr int kMaxLevel = 22;
inline constexpr int kGridBitsPerTree = 29;
inline constexpr int kCellsLog2 = 7;
inline constexpr int kCells = 1 << kCellsLog2;  // intervals between posts along an edge
inline constexpr int kPosts = kCells + 1;
inline constexpr uint32_t kGridNorthPole = uint32_t{1} << 31;  // GridPoint::y at 90 N

struct GridPoint {
  uint32_t x = 0;
  uint32_t y = 0;
  double longitude_deg() const;  // [-180, 180)
  double latitude_deg() const;   // [-90, 90]
  auto operator<=>(const GridPoint&) const = default;
};

// Geographic extent, degrees; east > west always (a box over 180 E has east > 180).
struct GeoBox {
  double west_deg = 0, south_deg = 0, east_deg = 0, north_deg = 0;
};

class Quadcode {
 public:
  constexpr Quadcode() = default;  // root of tree 0
  static constexpr Quadcode Root(int tree) { return Quadcode(static_cast<uint64_t>(tree) << kTreeShift); }
  // row counts those of the level over the whole Earth, 0..4*2^L-1 from 90 S, column those of that row from 180 W
  // (taken modulo their count). REQUIRES: 0 <= level <= kMaxLevel and row in range.
  static Quadcode FromColumnRow(int level, int64_t column, int64_t row);
  // How many there are in a row round the Earth: 8*2^L, and a power of two fewer near the poles.
  static int64_t ColumnsAround(int level, int64_t row);
  // The node of that level that contains the position; on a border the one east or north of it.
  static Quadcode Containing(double latitude_deg, double longitude_deg, int level);
  // nullopt where no quadnode has that word (as when it was read from a damaged file).
  static std::optional<Quadcode> FromWord(uint64_t word);

  constexpr uint64_t word() const { return word_; }
  constexpr int tree() const { return static_cast<int>(word_ >> kTreeShift); }
  constexpr uint64_t code() const { return word_ & kCodeMask; }
  int level() const;
  bool is_root() const { return code() == 0; }

  // The children that there are: all of 0 SW, 1 SE, 2 NW and 3 NE, but of a quadnode at a pole. 0 is always there.
  std::span<const int> Children() const;
  // which: one of Children(). REQUIRES: level() < kMaxLevel
  Quadcode Child(int which) const {
    return Quadcode((word_ & ~kCodeMask) | (4 * code() + 1 + static_cast<uint64_t>(which)));
  }
  // REQUIRES: !is_root()
  Quadcode Parent() const { return Quadcode((word_ & ~kCodeMask) | ((code() - 1) / 4)); }
  int WhichChild() const { return static_cast<int>((code() - 1) % 4); }
  // REQUIRES: level <= this->level()
  Quadcode Ancestor(int level) const;
  bool Contains(Quadcode other) const;

  int64_t column() const;
  int64_t row() const;
  GridPoint SouthWest() const;
  // It is 2^Doublings() times as wide, in degrees, as it is tall.
  int Doublings() const;
  bool touches_north_pole() const;
  bool touches_south_pole() const;
  // Sides of the quadnode, and distances between its posts, along a parallel and along a meridian, in grid units.
  uint32_t GridWidth() const { return GridHeight() << Doublings(); }
  uint32_t GridHeight() const { return uint32_t{1} << (kGridBitsPerTree - level()); }
  uint32_t PostSpacingEast() const { return GridWidth() >> kCellsLog2; }
  uint32_t PostSpacingNorth() const { return GridHeight() >> kCellsLog2; }
  GeoBox Box() const;
  double WidthDegrees() const;
  double HeightDegrees() const;

  // Those of its level in the rows from the one south of it to the one north of it that touch it, itself among them.
  std::vector<Quadcode> Around() const;
  // The coarsest quadnode beyond its border to the north, or to the south, whose posts there are no further apart than
  // its own: of its own level but where rows change their width. nullopt at the pole.
  std::optional<Quadcode> BesideParallel(bool north) const;

  // "12:0312" = tree 12, then the child taken at each level; the root of a tree is "12:".
  std::string ToString() const;
  static std::optional<Quadcode> Parse(std::string_view text);

  constexpr auto operator<=>(const Quadcode&) const = default;

 private:
  static constexpr int kTreeShift = 59;
  static constexpr uint64_t kCodeMask = (uint64_t{1} << kTreeShift) - 1;
  explicit constexpr Quadcode(uint64_t word) : word_(word) {}
  int64_t column_in_tree() const;

  uint64_t word_ = 0;
};

}  // namespace belvedere

template <>
struct std::hash<belvedere::Quadcode> {
  size_t operator()(belvedere::Quadcode q) const noexcept {
    uint64_t h = q.word() * 0x9E3779B97F4A7C15u;  // Fibonacci hashing: neighbours differ in the low bits only
    return static_cast<size_t>(h ^ (h >> 32));
  }
};
