// TrafficStream: the Entity State PDUs that synthetic traffic sends, as a pure function of time.
//
// An entity is reported when its true state has gone further from what its last report, dead-reckoned, says than a
// threshold, and after a heartbeat at the latest: what the standard asks of a simulator. With a rate, entities are
// reported in turn instead, that many PDUs a second. Which bytes come, and in what order, depends on the options only,
// not on how often Advance is called. An entity whose flight is over is reported once more, deactivated.
//
// Units:   seconds from the start of the traffic, metres, radians.
// Threads: belongs to its user.
#pragma once

#include "dis/codec.h"
#include "dis/traffic_vehicle.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace belvedere::dis {

struct TrafficOptions {
  std::string scenario = "sierra";
  std::vector<std::string> flights{};  // files of recorded flights (adsb.h) instead of a scenario; all their aircraft
  double speed = 1;                    // times as fast as they were
  double flights_from_s = 0;           // into the recording, by its own time
  size_t entities = 250;
  uint64_t seed = 1;
  double rate_pdus_per_s = 0;  // 0: as thresholds and heartbeat ask
  uint8_t exercise = 1;
  uint8_t version = 7;
  uint16_t site = 1, application = 1;  // entities count from 1; after 60,000 the application counts on
  // Absolute timestamps, of a start at this time since 1970; negative: relative ones, so that a run can be repeated to
  // the byte.
  double utc_at_start_s = -1;

  double heartbeat_s = 5.0;
  double position_threshold_m = 1.0;
  double orientation_threshold_rad = 3.0 * 0.017453292519943295;
};

class TrafficStream {
 public:
  static Result<TrafficStream> Make(const TrafficOptions& options);

  // The PDUs due up to time_s that have not been given yet, kEntityStateBytes each; valid until the next call. Times do
  // not go back.
  std::span<const uint8_t> Advance(double time_s);
  // The shots and hits of the same time, a datagram each: of the scenario "dogfight". Valid until the next Advance.
  std::span<const std::vector<uint8_t>> Engagements() const { return engagements_; }
  // When the next step is due.
  double NextStep() const;

  const std::vector<Vehicle>& vehicles() const { return vehicles_; }
  EntityId IdOf(size_t index) const;
  uint64_t pdus() const { return pdus_; }

 private:
  TrafficStream(const TrafficOptions& options, std::vector<Vehicle> vehicles);
  void Step(double time_s);
  bool IsDue(size_t index, double time_s) const;
  void Emit(size_t index, double time_s, bool last = false);
  void Engage(double time_s);
  PduHeader HeaderAt(double time_s) const;

  TrafficOptions options_;
  std::vector<Vehicle> vehicles_;
  std::vector<KinematicState> sent_;  // as receivers have it; time_s < 0: not yet sent
  std::vector<uint8_t> bytes_;
  std::vector<std::vector<uint8_t>> engagements_;
  uint16_t events_ = 0;
  uint64_t steps_ = 0;
  uint64_t pdus_ = 0;
};

}  // namespace belvedere::dis
