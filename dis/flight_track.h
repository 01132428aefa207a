// FlightTrack: where something went, as timed places, and where it was between them.
//
// Between places the way is a cubic through them whose tangents are those of a Catmull-Rom spline over unequal times:
// it steps neither position nor velocity.
//
// Units:   seconds, metres. Frames: ECEF.
// Threads: immutable once made.
#pragma once

#include <glm/vec3.hpp>

#include <vector>

namespace belvedere::dis {

struct TrackPlace {
  double time_s = 0;
  glm::dvec3 position_ecef{0.0};
};

class FlightTrack {
 public:
  // REQUIRES: at least two places, times rising. loops: after the last place it starts again.
  FlightTrack(std::vector<TrackPlace> places, bool loops);
  double start_s() const { return places_.front().time_s; }
  double end_s() const { return places_.back().time_s; }
  bool loops() const { return loops_; }
  // Whether it is there at that time: a track that does not loop has a beginning and an end.
  bool Covers(double time_s) const { return loops_ || (time_s >= start_s() && time_s <= end_s()); }
  glm::dvec3 PositionAt(double time_s) const;

 private:
  glm::dvec3 TangentAt(size_t place) const;  // metres a second
  std::vector<TrackPlace> places_;
  bool loops_;
};

}  // namespace belvedere::dis
