// Poses: places where terrain goes wrong, drawn by chance with a fixed seed: anywhere, over the finest source, on its
// border, at the poles, at 180 E. For the programs that look at many pictures.
//
// Threads: one.
#pragma once

#include "runtime/earth/ellipsoid.h"
#include "runtime/paging/dataset.h"
#include "runtime/scene/view_parameters.h"

#include <cmath>
#include <random>

namespace belvedere::figures {

class Poses {
 public:
  Poses(const Dataset& dataset, uint32_t seed) : random_(seed), inset_(FinestSource(dataset)) {}

  double Uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  Geodetic PlaceOf(int pose) {
    switch (pose % 5) {
      case 0: return {Uniform(-88, 88), Uniform(-180, 180)};
      case 1: return {Uniform(inset_.south_deg, inset_.north_deg), Uniform(inset_.west_deg, inset_.east_deg)};
      case 2: return OnBorder();
      case 3: return {std::copysign(Uniform(89, 90), Uniform(-1, 1)), Uniform(-180, 180)};
      default: return {Uniform(-80, 80), std::copysign(180 - Uniform(0, 0.05), Uniform(-1, 1))};
    }
  }

  // Any heading, a pitch from lowest_deg to highest_deg, some roll.
  glm::dmat3 AxesAt(const Geodetic& place, double lowest_deg, double highest_deg) {
    const double heading_deg = Uniform(0, 360);
    const double pitch_deg = Uniform(lowest_deg, highest_deg);
    return CameraAxes(place.latitude_deg, place.longitude_deg, Radians::FromDegrees(heading_deg),
                      Radians::FromDegrees(pitch_deg), Radians::FromDegrees(Uniform(-20, 20)));
  }

 private:
  Geodetic OnBorder() {
    const bool meridian = Uniform(0, 1) < 0.5;
    const bool low = Uniform(0, 1) < 0.5;
    if (meridian) return {Uniform(inset_.south_deg, inset_.north_deg), low ? inset_.west_deg : inset_.east_deg};
    return {low ? inset_.south_deg : inset_.north_deg, Uniform(inset_.west_deg, inset_.east_deg)};
  }

  static GeoBox FinestSource(const Dataset& dataset) {
    GeoBox box;
    int finest = -1;
    for (const LayerRecord& layer : dataset.layers()) {
      for (const SourceRecord& source : layer.sources) {
        if (layer.kind != LayerKind::kElevation || source.finest_level <= finest) continue;
        finest = source.finest_level;
        box = source.extent;
      }
    }
    return box;
  }

  std::mt19937 random_;
  const GeoBox inset_;
};

}  // namespace belvedere::figures
