#include "runtime/earth/frame.h"

#include "runtime/earth/ellipsoid.h"

namespace belvedere {

Frame FrameOf(Quadcode node) {
  Frame frame;
  frame.node = FrameNode(node);
  const GeoBox box = frame.node.Box();
  const double latitude_deg = 0.5 * (box.south_deg + box.north_deg);
  const double longitude_deg = 0.5 * (box.west_deg + box.east_deg);
  const LevelAxes axes = LevelAxesAt(latitude_deg, longitude_deg);
  frame.origin_ecef = ToEcef({latitude_deg, longitude_deg, 0.0});
  frame.ecef_from_frame = glm::dmat3(axes.east, axes.north, axes.up);
  return frame;
}

glm::dmat4 Frame::EcefFromFrame() const {
  return {glm::dvec4(ecef_from_frame[0], 0), glm::dvec4(ecef_from_frame[1], 0), glm::dvec4(ecef_from_frame[2], 0),
          glm::dvec4(origin_ecef, 1)};
}

}  // namespace belvedere
