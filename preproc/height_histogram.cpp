#include "preproc/height_histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace belvedere {
namespace {

// The bars between two heights, as few as need be.
double StepFor(double lowest_m, double highest_m, int most_bars) {
  for (double power = 0.001;; power *= 10) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double step_m = factor * power;
      if (std::floor(highest_m / step_m) - std::floor(lowest_m / step_m) < most_bars) return step_m;
    }
  }
}

// Page::min_m and max_m hold for all that is finer: the roots' hold for the layer.
Status FindRange(const Dataset& dataset, int layer, HeightHistogram& out) {
  out.lowest_m = std::numeric_limits<double>::infinity();
  out.highest_m = -out.lowest_m;
  for (int tree = 0; tree < kTrees; ++tree) {
    const auto page = dataset.ReadElevation(layer, Quadcode::Root(tree));
    if (!page.ok()) return page.status();
    out.lowest_m = std::min(out.lowest_m, static_cast<double>((*page)->min_m));
    out.highest_m = std::max(out.highest_m, static_cast<double>((*page)->max_m));
  }
  return {};
}

// Posts on the east and north border are the neighbours'.
void Count(const ElevationPage& page, HeightHistogram& out) {
  const auto last = static_cast<int64_t>(out.posts.size()) - 1;
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      const double height_m = page.at(column, row) * kMetresPerMillimetre;
      const auto bar = static_cast<int64_t>(std::floor((height_m - out.first_m) / out.step_m));
      ++out.posts[static_cast<size_t>(std::clamp<int64_t>(bar, 0, last))];
    }
  }
}

}  // namespace

Result<HeightHistogram> CountHeights(const Dataset& dataset, int layer, int most_pages, int most_bars) {
  HeightHistogram out;
  if (Status status = FindRange(dataset, layer, out); !status.ok()) return status;
  out.step_m = StepFor(out.lowest_m, out.highest_m, most_bars);
  const double first = std::floor(out.lowest_m / out.step_m);
  out.first_m = first * out.step_m;
  out.posts.resize(static_cast<size_t>(std::floor(out.highest_m / out.step_m) - first) + 1);
  std::vector<Quadcode> finest;
  for (const uint64_t word : dataset.Nodes(layer)) {
    const Quadcode node = *Quadcode::FromWord(word);
    if (!dataset.HasChildren(layer, node)) finest.push_back(node);
  }
  out.pages = static_cast<int64_t>(finest.size());
  out.pages_read = std::min<int64_t>(out.pages, most_pages);
  for (int64_t i = 0; i < out.pages_read; ++i) {
    const auto page = dataset.ReadElevation(layer, finest[static_cast<size_t>(i * out.pages / out.pages_read)]);
    if (!page.ok()) return page.status();
    Count(**page, out);
  }
  return out;
}

}  // namespace belvedere
