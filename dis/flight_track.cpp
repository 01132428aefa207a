#include "dis/flight_track.h"

#include "runtime/base/status.h"

#include <algorithm>
#include <cmath>

namespace belvedere::dis {

FlightTrack::FlightTrack(std::vector<TrackPlace> places, bool loops) : places_(std::move(places)), loops_(loops) {
  BELVEDERE_CHECK(places_.size() >= 2);
}

glm::dvec3 FlightTrack::TangentAt(size_t place) const {
  const TrackPlace& before = places_[place == 0 ? 0 : place - 1];
  const TrackPlace& after = places_[std::min(place + 1, places_.size() - 1)];
  return (after.position_ecef - before.position_ecef) / (after.time_s - before.time_s);
}

glm::dvec3 FlightTrack::PositionAt(double time_s) const {
  const double length_s = end_s() - start_s();
  double at_s = time_s;
  if (loops_) at_s = start_s() + (time_s - start_s()) - length_s * std::floor((time_s - start_s()) / length_s);
  at_s = std::clamp(at_s, start_s(), end_s());
  const auto next = std::upper_bound(places_.begin() + 1, places_.end() - 1, at_s,
                                     [](double time, const TrackPlace& place) { return time < place.time_s; });
  const auto to = static_cast<size_t>(next - places_.begin()), from = to - 1;
  const double span_s = places_[to].time_s - places_[from].time_s;
  const double u = (at_s - places_[from].time_s) / span_s;
  const double u2 = u * u, u3 = u2 * u;
  return (2 * u3 - 3 * u2 + 1) * places_[from].position_ecef + (u3 - 2 * u2 + u) * span_s * TangentAt(from) +
         (3 * u2 - 2 * u3) * places_[to].position_ecef + (u3 - u2) * span_s * TangentAt(to);
}

}  // namespace belvedere::dis
