// Feather: how much of a source counts near the border of its domain, the pixels that are its own.
//
// The weight of a position is 3 t^2 - 2 t^3, where t is the distance to the border in shares of the feather, 1 at most:
// 0 on the border, 1 from one feather inwards, with no corner at either end. The distance is the Euclidean one, on the
// ground, to the nearest pixel that is not inside, each pixel a rectangle: exact, and continuous in the position. It is
// found in two passes, along rows once for all positions, then over the rows near each (Meijster, Roerdink and
// Hesselink 2000, "A general algorithm for computing distance transforms in linear time").
//
// Units: positions in pixels of the window's pyramid level, (0, 0) the outer corner of the first; distances in metres.
// Threads: values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace belvedere {

struct DomainWindow {
  int x = 0, y = 0, width = 0, height = 0;
  std::vector<uint8_t> inside;  // row by row, 1 or 0
};

// Of a pixel, along a row and along a column.
struct PixelSize {
  double x_m = 0, y_m = 0;
};

class Feather {
 public:
  // What lies off the window is taken for inside: it has to reach a feather beyond the positions asked for.
  explicit Feather(DomainWindow window);

  // Whether all of it is inside, so that every weight is 1.
  bool whole() const { return whole_; }
  // REQUIRES: the position lies in the window; feather_m > 0.
  float WeightAt(double x, double y, const PixelSize& size, double feather_m) const;
  // The distance, or most_m where it is no less.
  double DistanceAt(double x, double y, const PixelSize& size, double most_m) const;

 private:
  double DistanceInRow(int row, int column, double x) const;

  DomainWindow window_;
  bool whole_ = true;
  // Pixels to the nearest one that is not inside, in its row; 0 for such a pixel itself.
  std::vector<int32_t> left_, right_;
};

}  // namespace belvedere
