// VectorPage: what of a vector layer lies in a quadnode - roads, rivers, borders, places - with its attributes.
//
// Lines and polygons are cut at the quadnode's borders; where a feature crosses a border, both sides have the same
// point there. Buildings are never cut: each is whole in the quadnode that holds the middle of its extent. A page of a
// coarse level has the features that are large, or important, enough to be seen at it, with fewer points; what it lacks
// is in the pages under it, whose features take the place of its own, not join them. A page that lacks nothing is
// complete, and has no children.
//
// Points are in grid units (quadcode.h: 45 degrees / 2^29, at most 9.3 mm) east and north of the quadnode's south-west
// corner.
// Threads: values.
#pragma once

#include "runtime/paging/page.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace belvedere {

// What a feature is; numbers are those that datasets keep.
enum class FeatureClass : uint8_t {
  kOther,
  kRoad,
  kRailway,
  kRiver,
  kWater,
  kBorder,
  kCoast,
  kAirport,
  kPlace,
  kBuilding
};
inline constexpr int kFeatureClasses = 10;
std::string_view FeatureClassName(FeatureClass of);  // "other", "road", ..
std::optional<FeatureClass> FeatureClassOf(std::string_view name);

enum class FeatureShape : uint8_t { kPoints, kLines, kPolygons };

using AttributeValue = std::variant<int64_t, double, std::string>;
using Attribute = std::pair<std::string, AttributeValue>;
std::string TextOf(const AttributeValue& value);

struct VectorPoint {
  int32_t x = 0, y = 0;
  auto operator<=>(const VectorPoint&) const = default;
};

struct VectorFeature {
  uint32_t id = 0;  // the same in all pages of the layer, and in the index of features
  FeatureClass of = FeatureClass::kOther;
  FeatureShape shape = FeatureShape::kPoints;
  uint32_t first_part = 0, parts = 0;  // of points: one part
  uint32_t first_attribute = 0, attributes = 0;
};

struct VectorPage final : Page {
  struct Part {
    uint32_t first_point = 0, points = 0;
  };
  // A key and a value, by their places below.
  struct AttributeUse {
    uint32_t key = 0, value = 0;
  };

  bool is_complete = false;
  std::vector<VectorFeature> features;
  // Of polygons, rings, whose last point is not the first again; what lies within an odd number of them is inside.
  // Between two points on the quadnode's border a ring follows the border: there the polygon was cut.
  std::vector<Part> parts;
  std::vector<VectorPoint> points;
  std::vector<AttributeUse> attributes;
  std::vector<std::string> keys;
  std::vector<AttributeValue> values;

  // nullptr where the feature has none of that key.
  const AttributeValue* Find(const VectorFeature& feature, std::string_view key) const;

  size_t bytes() const override;
};

}  // namespace belvedere
