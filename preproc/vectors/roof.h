// Roof: how high the top of a building is at each point of its footprint.
//
// Roofs lie over the smallest rectangle around the footprint: l runs along its longer side, d across, both metres from
// its middle. Names are those of OpenStreetMap's roof:shape; shapes that are not known are flat.
//
// Threads: values.
#pragma once

#include <glm/vec2.hpp>

#include <cmath>
#include <string_view>
#include <vector>

namespace belvedere {

enum class RoofShape { kFlat, kSkillion, kGabled, kHipped, kPyramidal };
RoofShape RoofShapeOf(std::string_view name);

// Of the rectangle.
struct RoofFrame {
  glm::dvec2 middle{0, 0};
  glm::dvec2 along{1, 0};  // of length 1
  double half_length_m = 1, half_width_m = 1;
};

class Roof {
 public:
  Roof(RoofShape shape, const RoofFrame& frame, double eaves_m, double rise_m);

  // Above the ground.
  double HeightAt(glm::dvec2 place) const;

  // Lines along which it folds; between them it is flat.
  struct Crease {
    glm::dvec2 normal{0, 0};  // of length 1
    double c = 0;
    // Metres; 0 where it is nearer than a thousandth of a millimetre.
    double SideOf(glm::dvec2 place) const {
      const double distance_m = normal.x * place.x + normal.y * place.y - c;
      return std::abs(distance_m) < 1e-6 ? 0 : distance_m;
    }
  };
  const std::vector<Crease>& creases() const { return creases_; }

 private:
  // Where normal_l * l + normal_d * d = c.
  void AddCrease(double normal_l, double normal_d, double c);

  RoofShape shape_;
  RoofFrame frame_;
  double eaves_m_, rise_m_;
  std::vector<Crease> creases_;
};

// How much a roof of that shape rises where nothing says so: at the usual slope.
double UsualRise(RoofShape shape, const RoofFrame& frame);

}  // namespace belvedere
