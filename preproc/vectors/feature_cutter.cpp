#include "preproc/vectors/feature_cutter.h"

#include "preproc/vectors/clip.h"
#include "preproc/vectors/simplify.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

constexpr int kToleranceLog2 = 11;  // of the side of a quadnode
constexpr int kGridLog2 = 14;

GridExtent ExtentOf(const FeatureParts& parts) {
  GridExtent extent;
  extent.Add(parts);
  return extent;
}

// What of a feature lies in a quadnode.
struct Piece {
  const Feature* feature = nullptr;
  int64_t size = 0;  // of the whole feature, grid units
  FeatureParts parts;
};

bool StaysWhole(const Piece& piece) {
  return piece.feature->of == FeatureClass::kBuilding;
}

// Divides the pieces between what lies below and above the line.
std::array<std::vector<Piece>, 2> Divide(const std::vector<Piece>& pieces, GridAxis axis, int64_t at) {
  std::array<std::vector<Piece>, 2> out;
  for (const Piece& piece : pieces) {
    if (StaysWhole(piece)) {
      const GridPlace middle = ExtentOf(piece.parts).middle();
      out[(axis == GridAxis::kX ? middle.x : middle.y) >= at].push_back(piece);
      continue;
    }
    std::array<FeatureParts, 2> sides = CutInTwo(piece.parts, piece.feature->shape, axis, at);
    for (size_t side = 0; side < 2; ++side) {
      if (!sides[side].empty()) out[side].push_back({piece.feature, piece.size, std::move(sides[side])});
    }
  }
  return out;
}

// Puts one page together.
class PageMaker {
 public:
  PageMaker(Quadcode node, int64_t step) : origin_{node.SouthWest().x, node.SouthWest().y}, step_(step) {}

  void Add(const Feature& feature, const FeatureParts& parts) {
    VectorFeature out{feature.id,
                      feature.of,
                      feature.shape,
                      static_cast<uint32_t>(page_.parts.size()),
                      0,
                      static_cast<uint32_t>(page_.attributes.size()),
                      static_cast<uint32_t>(feature.attributes.size())};
    for (const FeaturePart& part : parts) AddPart(part, feature.shape);
    out.parts = static_cast<uint32_t>(page_.parts.size()) - out.first_part;
    for (const auto& [key, value] : feature.attributes)
      page_.attributes.push_back({PlaceOf(key, keys_, page_.keys), PlaceOf(value, values_, page_.values)});
    page_.features.push_back(out);
  }

  VectorPage& page() { return page_; }

 private:
  void AddPart(const FeaturePart& part, FeatureShape shape) {
    VectorPage::Part out{static_cast<uint32_t>(page_.points.size()), 0};
    for (const GridPlace& place : part) {
      const VectorPoint point{OnGrid(place.x - origin_.x), OnGrid(place.y - origin_.y)};
      const bool is_same = page_.points.size() > out.first_point && page_.points.back() == point;
      if (!is_same || shape == FeatureShape::kPoints) page_.points.push_back(point);
    }
    out.points = static_cast<uint32_t>(page_.points.size()) - out.first_point;
    page_.parts.push_back(out);
  }

  int32_t OnGrid(int64_t offset) const {
    const int64_t half = step_ / 2;
    const int64_t steps = offset >= 0 ? (offset + half) / step_ : -((-offset + half) / step_);
    return static_cast<int32_t>(steps * step_);
  }

  template <typename Value>
  static uint32_t PlaceOf(const Value& value, std::map<Value, uint32_t>& places, std::vector<Value>& list) {
    const auto [at, is_new] = places.emplace(value, static_cast<uint32_t>(list.size()));
    if (is_new) list.push_back(value);
    return at->second;
  }

  const GridPlace origin_;
  const int64_t step_;
  VectorPage page_;
  std::map<std::string, uint32_t> keys_;
  std::map<AttributeValue, uint32_t> values_;
};

size_t CountPoints(const FeatureParts& parts) {
  size_t points = 0;
  for (const FeaturePart& part : parts) points += part.size();
  return points;
}

class Cutter {
 public:
  explicit Cutter(const std::function<Status(Quadcode, const VectorPage&)>& put) : put_(put) {}

  Status Cut(Quadcode node, std::vector<Piece> pieces) {
    Draft draft = DraftOf(node, pieces);
    if (Status status = put_(node, PageOf(node, draft, pieces)); !status.ok()) return status;
    if (draft.is_complete) return {};
    draft.shown.clear();
    const GridPoint corner = node.SouthWest();
    auto rows = Divide(pieces, GridAxis::kY, corner.y + node.GridHeight() / 2);
    pieces.clear();
    std::array<std::vector<Piece>, 4> of_child;
    for (int row = 0; row < 2; ++row) {
      const auto west = static_cast<size_t>(2 * row);
      auto& here = rows[static_cast<size_t>(row)];
      if (node.Child(2 * row).GridWidth() == node.GridWidth()) {
        of_child[west] = std::move(here);
        continue;
      }
      auto columns = Divide(here, GridAxis::kX, corner.x + node.GridWidth() / 2);
      of_child[west] = std::move(columns[0]);
      of_child[west + 1] = std::move(columns[1]);
    }
    for (const int which : node.Children()) {
      Status status = Cut(node.Child(which), std::move(of_child[static_cast<size_t>(which)]));
      if (!status.ok()) return status;
    }
    return {};
  }

 private:
  struct Shown {
    const Piece* piece = nullptr;
    FeatureParts parts;
  };
  struct Draft {
    bool is_complete = true;
    std::vector<Shown> shown;
  };

  static Draft DraftOf(Quadcode node, const std::vector<Piece>& pieces) {
    const GridPoint corner = node.SouthWest();
    const int64_t side = node.GridHeight();
    const auto on_border = [&](const GridPlace& place) {
      return place.x == corner.x || place.x == corner.x + node.GridWidth() || place.y == corner.y ||
             place.y == corner.y + side;
    };
    const int64_t most_off = side >> kToleranceLog2;
    Draft draft;
    size_t points = 0;
    for (const Piece& piece : pieces) {
      const Feature& feature = *piece.feature;
      const bool is_exact = static_cast<double>(most_off) <= feature.resolution;
      if (!is_exact && feature.shape != FeatureShape::kPoints && piece.size < most_off) {
        draft.is_complete = false;
        continue;
      }
      Shown shown{&piece, {}};
      for (const FeaturePart& part : piece.parts) {
        Simplified simple = Simplify(part, feature.shape, is_exact ? 0 : static_cast<double>(most_off), on_border);
        draft.is_complete &= simple.deviation <= feature.resolution && !simple.part.empty();
        if (!simple.part.empty()) shown.parts.push_back(std::move(simple.part));
      }
      points += CountPoints(shown.parts);
      if (points > kMostPointsOfPage && !draft.shown.empty() && node.level() < kMaxLevel) {
        draft.is_complete = false;
        break;
      }
      draft.shown.push_back(std::move(shown));
    }
    size_t whole = 0;
    for (const Piece& piece : pieces) whole += CountPoints(piece.parts);
    draft.is_complete &= whole <= kMostPointsOfPage || pieces.size() == 1;
    draft.is_complete |= node.level() == kMaxLevel;
    return draft;
  }

  static VectorPage PageOf(Quadcode node, const Draft& draft, const std::vector<Piece>& pieces) {
    PageMaker maker(node, draft.is_complete ? 1 : std::max<int64_t>(1, node.GridHeight() >> kGridLog2));
    maker.page().is_complete = draft.is_complete;
    if (draft.is_complete) {
      for (const Piece& piece : pieces) maker.Add(*piece.feature, piece.parts);
    } else {
      for (const Shown& shown : draft.shown) maker.Add(*shown.piece->feature, shown.parts);
    }
    return std::move(maker.page());
  }

  const std::function<Status(Quadcode, const VectorPage&)>& put_;
};

// The most important first, the parts of those over 180 E on both sides of it.
std::vector<Piece> PiecesOf(std::span<const Feature> features) {
  std::vector<Piece> pieces;
  for (const Feature& feature : features) {
    const GridExtent extent = ExtentOf(feature.parts);
    // What is on the wrong side of the Earth falls away when it is divided among the quadtrees.
    for (const int64_t shift : {int64_t{0}, kUnitsAround, -kUnitsAround}) {
      if (extent.west + shift >= kUnitsAround || extent.east + shift < 0) continue;
      Piece piece{&feature, extent.size(), feature.parts};
      for (FeaturePart& part : piece.parts) {
        for (GridPlace& place : part) place.x += shift;
      }
      pieces.push_back(std::move(piece));
    }
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.feature->importance > b.feature->importance; });
  return pieces;
}

}  // namespace

Status CutFeatures(std::span<const Feature> features, const std::function<Status(Quadcode, const VectorPage&)>& put) {
  Cutter cutter(put);
  constexpr int64_t kTreeSide = int64_t{1} << kGridBitsPerTree;
  std::vector<Piece> rest = PiecesOf(features);
  for (int row = 0; row < kTreeRows; ++row) {
    // The north pole belongs to the last row.
    std::array<std::vector<Piece>, 2> rows;
    if (row + 1 < kTreeRows)
      rows = Divide(rest, GridAxis::kY, (row + 1) * kTreeSide);
    else
      rows[0] = std::move(rest);
    rest = std::move(rows[1]);
    std::vector<Piece> columns = std::move(Divide(rows[0], GridAxis::kX, 0)[1]);
    for (int column = 0; column < kTreeColumns; ++column) {
      auto sides = Divide(columns, GridAxis::kX, (column + 1) * kTreeSide);
      columns = std::move(sides[1]);
      Status status = cutter.Cut(Quadcode::Root(row * kTreeColumns + column), std::move(sides[0]));
      if (!status.ok()) return status;
    }
  }
  return {};
}

}  // namespace belvedere
