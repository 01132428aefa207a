#include "preproc/vectors/buildings.h"

#include "preproc/hex_colour.h"
#include "preproc/vectors/footprint.h"
#include "preproc/vectors/roof.h"
#include "runtime/base/status.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

using Colour = std::array<uint8_t, 3>;

constexpr double kMetresPerLevel = 3;
constexpr double kUsualHeight_m = 6;
constexpr double kMetresPerFoot = 0.3048;
constexpr double kMostHeight_m = 2000;  // what is more is a mistake
constexpr Colour kWalls{214, 206, 196}, kFlatRoof{168, 166, 164}, kTiles{158, 106, 84};

struct Shape {
  double height_m = kUsualHeight_m, base_m = 0, rise_m = 0;
  RoofShape roof = RoofShape::kFlat;
  Colour walls = kWalls, top = kFlatRoof;
};

Shape ShapeOf(const VectorPage& page, const VectorFeature& feature, const RoofFrame& frame) {
  const auto text = [&](const char* key) {
    const AttributeValue* value = page.Find(feature, key);
    return value == nullptr ? std::string() : TextOf(*value);
  };
  const auto length = [&](const char* key) { return ParseLength(text(key)); };
  const auto levels = [&](const char* key) {
    const auto number = length(key);
    return number ? std::optional(*number * kMetresPerLevel) : std::nullopt;
  };
  Shape shape;
  shape.roof = RoofShapeOf(text("roof:shape"));
  shape.rise_m = length("roof:height").value_or(levels("roof:levels").value_or(UsualRise(shape.roof, frame)));
  if (shape.roof == RoofShape::kFlat) shape.rise_m = 0;
  if (const auto height = length("height"))
    shape.height_m = *height;
  else if (const auto stories = levels("building:levels"))
    shape.height_m = *stories + shape.rise_m;
  if (!(shape.height_m > 0 && shape.height_m < kMostHeight_m)) shape.height_m = kUsualHeight_m;
  shape.base_m = length("min_height").value_or(levels("building:min_level").value_or(0));
  if (!(shape.base_m >= 0 && shape.base_m < shape.height_m)) shape.base_m = 0;
  shape.rise_m = std::clamp(shape.rise_m, 0.0, shape.height_m - shape.base_m);
  shape.walls = ParseColourName(text("building:colour")).value_or(kWalls);
  shape.top = ParseColourName(text("roof:colour")).value_or(shape.roof == RoofShape::kFlat ? kFlatRoof : kTiles);
  return shape;
}

// Parts of a convex polygon on the two sides of a line.
std::vector<std::vector<glm::dvec2>> Fold(const std::vector<glm::dvec2>& polygon, const Roof::Crease& crease) {
  std::vector<std::vector<glm::dvec2>> sides(2);
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double from = crease.SideOf(a), to = crease.SideOf(b);
    if (from <= 0) sides[0].push_back(a);
    if (from >= 0) sides[1].push_back(a);
    if ((from < 0 && to > 0) || (from > 0 && to < 0)) {
      const glm::dvec2 crossing = a + (b - a) * (from / (from - to));
      for (auto& side : sides) side.push_back(crossing);
    }
  }
  // A side that only touches the line is none.
  std::erase_if(sides, [&](const auto& side) {
    return std::all_of(side.begin(), side.end(), [&](glm::dvec2 place) { return crease.SideOf(place) == 0; });
  });
  return sides;
}

class PageBuilder {
 public:
  explicit PageBuilder(BuildingPage& page) : page_(page) {}

  void StartDetail() { page_.details.push_back({static_cast<uint32_t>(page_.indices.size()), 0, 0}); }
  void AllowError(double error_m) {
    page_.details.back().error_m = std::max(page_.details.back().error_m, static_cast<float>(error_m));
  }

  // Walls around the footprint and a roof over it.
  void Raise(size_t building, const Footprint& footprint, const Roof& roof, const Shape& shape) {
    for (const auto& ring : footprint.rings) {
      for (size_t i = 0; i < ring.size(); ++i) AddWall(building, ring[i], ring[(i + 1) % ring.size()], roof, shape);
    }
    for (const auto& triangle : footprint.triangles) {
      std::vector<std::vector<glm::dvec2>> faces{{triangle.begin(), triangle.end()}};
      for (const Roof::Crease& crease : roof.creases()) {
        std::vector<std::vector<glm::dvec2>> folded;
        for (const auto& face : faces) {
          for (auto& part : Fold(face, crease)) folded.push_back(std::move(part));
        }
        faces = std::move(folded);
      }
      for (const auto& face : faces) AddTop(building, face, roof, shape.top);
    }
  }

  void EndDetail() {
    BuildingPage::Detail& detail = page_.details.back();
    detail.indices = static_cast<uint32_t>(page_.indices.size()) - detail.first_index;
  }

 private:
  void AddWall(size_t building, glm::dvec2 a, glm::dvec2 b, const Roof& roof, const Shape& shape) {
    std::vector<double> cuts{0, 1};
    for (const Roof::Crease& crease : roof.creases()) {
      const double from = crease.SideOf(a), to = crease.SideOf(b);
      if (from * to < 0) cuts.push_back(from / (from - to));
    }
    std::sort(cuts.begin(), cuts.end());
    for (size_t i = 1; i < cuts.size(); ++i) {
      const glm::dvec2 p = a + (b - a) * cuts[i - 1], q = a + (b - a) * cuts[i];
      AddFace(building, {{p, shape.base_m}, {q, shape.base_m}, {q, roof.HeightAt(q)}, {p, roof.HeightAt(p)}},
              shape.walls);
    }
  }

  void AddTop(size_t building, const std::vector<glm::dvec2>& face, const Roof& roof, const Colour& colour) {
    std::vector<glm::dvec3> corners;
    corners.reserve(face.size());
    for (const glm::dvec2& place : face) corners.emplace_back(place, roof.HeightAt(place));
    AddFace(building, corners, colour);
  }

  // A flat, convex face, counter-clockwise. Nothing where it has no area.
  void AddFace(size_t building, const std::vector<glm::dvec3>& corners, const Colour& colour) {
    glm::dvec3 normal{0, 0, 0};
    for (size_t i = 2; i < corners.size(); ++i)
      normal += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    constexpr double kLeastArea_m2 = 1e-6;
    if (glm::length(normal) < kLeastArea_m2) return;
    normal = glm::normalize(normal);
    const auto first = static_cast<uint32_t>(page_.vertices.size());
    for (const glm::dvec3& corner : corners) {
      BuildingVertex vertex{
          static_cast<float>(corner.x),   static_cast<float>(corner.y), static_cast<float>(corner.z), {}, colour,
          static_cast<uint16_t>(building)};
      for (int axis = 0; axis < 3; ++axis)
        vertex.normal[static_cast<size_t>(axis)] = static_cast<int8_t>(std::lrint(127 * normal[axis]));
      page_.vertices.push_back(vertex);
    }
    for (uint32_t i = 2; i < corners.size(); ++i) {
      for (const uint32_t corner : {0u, i - 1, i}) page_.indices.push_back(first + corner);
    }
  }

  BuildingPage& page_;
};

struct Raised {
  Footprint footprint;
  Shape shape;
};

}  // namespace

std::shared_ptr<BuildingPage> RaiseBuildings(const VectorPage& page, Quadcode node) {
  auto out = std::make_shared<BuildingPage>();
  std::vector<Raised> raised;
  for (const VectorFeature& feature : page.features) {
    if (feature.of != FeatureClass::kBuilding || feature.shape != FeatureShape::kPolygons) continue;
    std::optional<Footprint> footprint = FootprintOf(page, feature, node);
    if (!footprint || raised.size() > UINT16_MAX) continue;
    const Shape shape = ShapeOf(page, feature, footprint->frame);
    out->buildings.push_back(
        {feature.id, footprint->anchor, static_cast<float>(shape.height_m), static_cast<float>(footprint->radius_m)});
    raised.push_back({std::move(*footprint), shape});
  }
  if (raised.empty()) return out;
  PageBuilder builder(*out);
  for (int detail = 0; detail < 3; ++detail) {
    builder.StartDetail();
    for (size_t i = 0; i < raised.size(); ++i) {
      const auto& [footprint, shape] = raised[i];
      const Roof shaped(shape.roof, footprint.frame, shape.height_m - shape.rise_m, shape.rise_m);
      // What is cut off and what is added are the same.
      const Roof flat(RoofShape::kFlat, footprint.frame, shape.height_m - shape.rise_m / 2, 0);
      builder.Raise(i, detail < 2 ? footprint : footprint.Box(), detail == 0 ? shaped : flat, shape);
      if (detail > 0) builder.AllowError(shape.rise_m / 2);
      if (detail > 1) builder.AllowError(std::hypot(footprint.box_error_m, shape.rise_m / 2));
    }
    builder.EndDetail();
  }
  return out;
}

std::optional<double> ParseLength(std::string_view text) {
  double number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (problem != std::errc() || !std::isfinite(number)) return std::nullopt;
  std::string_view unit = text.substr(static_cast<size_t>(end - text.data()));
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  if (unit.empty() || unit == "m") return number;
  if (unit == "ft" || unit == "'") return number * kMetresPerFoot;
  return std::nullopt;
}

std::optional<std::array<uint8_t, 3>> ParseColourName(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, Colour>, 19> kNames = {{{"white", {255, 255, 255}},
                                                                                  {"silver", {192, 192, 192}},
                                                                                  {"lightgrey", {211, 211, 211}},
                                                                                  {"lightgray", {211, 211, 211}},
                                                                                  {"grey", {128, 128, 128}},
                                                                                  {"gray", {128, 128, 128}},
                                                                                  {"black", {0, 0, 0}},
                                                                                  {"red", {255, 0, 0}},
                                                                                  {"maroon", {128, 0, 0}},
                                                                                  {"brown", {165, 42, 42}},
                                                                                  {"orange", {255, 165, 0}},
                                                                                  {"yellow", {255, 255, 0}},
                                                                                  {"beige", {245, 245, 220}},
                                                                                  {"tan", {210, 180, 140}},
                                                                                  {"olive", {128, 128, 0}},
                                                                                  {"green", {0, 128, 0}},
                                                                                  {"teal", {0, 128, 128}},
                                                                                  {"blue", {0, 0, 255}},
                                                                                  {"navy", {0, 0, 128}}}};
  for (const auto& [name, colour] : kNames) {
    if (name == text) return colour;
  }
  const auto hex = ParseHexColour(text);
  return hex ? std::optional(Colour{(*hex)[0], (*hex)[1], (*hex)[2]}) : std::nullopt;
}

}  // namespace belvedere
