// LineCorrection: ground along roads and rivers as it has to be there: level across, and along a road without the steps
// of its source's pixels, along a river never rising downstream.
//
// Heights of the ground are taken along the line at distances of its width. Those of a road are the mean over a few of
// them, less towards its ends, which stay as they are, so that roads meet; those of a river fall from its higher end
// on, each the least so far. Within half a width of the line the ground has the line's height; within another half it
// goes over to what it was. A post that several lines reach is the nearest one's.
//
// Pages whose posts are further apart than a line is wide stay as they are there: they could not show it.
//
// Units: metres above the ellipsoid. Threads: const methods, any.
#pragma once

#include "preproc/vectors/feature.h"
#include "runtime/earth/quadcode.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

namespace belvedere {

class LineCorrection {
 public:
  // Height of the ground, not corrected, in the order of the lines.
  using Ground = std::function<double(double latitude_deg, double longitude_deg)>;

  // Lines among the features; of class river they fall.
  void Add(std::span<const Feature> features, double width_m, const Ground& ground);

  bool empty() const { return segments_.empty(); }
  // heights_mm: kElevationSide^2, of the node's posts and its apron. The same post has the same height in every page of
  // a level.
  void Apply(Quadcode node, std::vector<int32_t>& heights_mm) const;

 private:
  struct Segment {
    GridPlace a, b;
    double a_m = 0, b_m = 0;  // heights
    double width_m = 0;
  };
  // Posts of a page with its apron, grid units.
  struct PostRaster {
    int64_t west = 0, south = 0;
    int64_t east_spacing = 0, north_spacing = 0;
  };
  // Of a post: the line that is nearest.
  struct Nearest {
    double distance_m = std::numeric_limits<double>::infinity();
    double height_m = 0, share = 0;
  };
  static GridExtent ReachOf(const Segment& segment);
  std::vector<uint32_t> SegmentsNear(const PostRaster& posts) const;
  static void Reach(const Segment& segment, const PostRaster& posts, std::vector<Nearest>& nearest);
  void AddLine(const FeaturePart& line, bool falls, double width_m, const Ground& ground);
  void Index(size_t segment);

  std::vector<Segment> segments_;
  // Of cells of kCellLog2: column and row of a cell, and which segments may reach it.
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
  double widest_m_ = 0;
};

}  // namespace belvedere
