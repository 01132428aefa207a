// ObjectTable: every moving object that is known now, shared by whoever hears of objects and whoever shows them.
//
// Writers put whole records; the table clamps and flags what is nonsense, drops objects that have not been heard of for
// as long as the first fitting rule of `timeouts` says (timeout_s where none fits), and at capacity drops the one not
// heard of for longest. Readers take an ObjectSnapshot: immutable, all records at one
// time, in the order of their ids. It is rebuilt by writers, at most every publish_interval_s, and less often when
// building one takes long (never more than a twentieth of the time).
//
// Units:   metres, seconds on the user's Clock::NowSeconds, radians.
// Threads: all methods from any thread. Reading costs a shared_ptr copy and never waits while a snapshot is built.
// Owns:    about 450 bytes an object, and as much again for each snapshot that somebody holds.
#pragma once

#include "runtime/base/mutex.h"
#include "runtime/scene/entity.h"
#include "runtime/scene/motion.h"
#include "runtime/scene/scene_event.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace belvedere {

struct ArticulatedPart {
  uint16_t attached_to = 0;  // 0: the entity itself
  uint32_t type = 0;         // part class, a multiple of 32, plus the metric in the low 5 bits
  float value = 0;
  uint32_t part_class() const { return type & ~uint32_t{31}; }
  uint32_t metric() const { return type & 31; }  // 11 azimuth, 13 elevation, ...
};

// What hangs on an object: a missile under a wing. The station's numbers are those of ModelStation.
struct AttachedPart {
  uint16_t station = 0;
  EntityType type;
};

// Why a record is not as it was sent.
enum ObjectFlags : uint8_t {
  kObjectAtEarthCentre = 1,  // no position was given
  kObjectUnderground = 2,    // more than 100 km under the ellipsoid
  kObjectTooFar = 4,         // more than kFarthestObject_m from the Earth's centre
  kObjectMotionClamped = 8,  // faster than kMaxSpeed_mps and so on
  kObjectUnknownModel = 16,  // dead-reckoning model not in the standard: stands still
  kObjectFrozen = 32,        // the sender asks that it not be dead-reckoned, or Hold did
};
inline constexpr uint8_t kObjectNotVisible = kObjectAtEarthCentre | kObjectUnderground | kObjectTooFar;
inline constexpr double kFarthestObject_m = 1e9;
// Which of kObjectNotVisible a place has: 0 for one that can be shown.
uint8_t PositionFlags(const glm::dvec3& ecef);

struct ObjectRecord {
  static constexpr size_t kMaxParts = 8;  // of each sort; further ones are left out

  // What is looked at in every record, of every list, comes first: one line of the processor's cache.
  EntityId id;
  EntityType type;
  uint8_t force = 0;  // 1 friendly, 2 opposing, 3 neutral
  uint8_t flags = 0;  // ObjectFlags
  uint8_t part_count = 0;
  uint8_t attached_count = 0;
  uint8_t protocol_version = 7;  // of the report
  uint32_t slot = 0;             // the table's number for it while it is known, under the capacity;
  uint32_t incarnation = 0;      // with this, which counts all that were ever added, for itself alone
  uint32_t report = 0;           // counts the reports of this object; changes with each
  uint32_t appearance = 0;
  Marking marking;
  double received_s = 0;
  uint64_t source = 0;  // who reported it: a number of the network's making, equal for one host
  KinematicState kinematics;
  std::array<ArticulatedPart, kMaxParts> part_array{};
  std::array<AttachedPart, kMaxParts> attached_array{};

  bool visible() const { return (flags & kObjectNotVisible) == 0; }
  std::span<const ArticulatedPart> parts() const { return {part_array.data(), part_count}; }
  std::span<const AttachedPart> attached() const { return {attached_array.data(), attached_count}; }
  uint32_t damage() const { return (appearance >> 3) & 3; }  // 0 none .. 3 destroyed
};

// Bits of appearance that mean the same in every kind of entity.
inline constexpr uint32_t kAppearanceFrozen = uint32_t{1} << 21;
inline constexpr uint32_t kAppearanceDeactivated = uint32_t{1} << 23;

struct ObjectSnapshot {
  std::vector<ObjectRecord> objects;  // in the order of id
  std::vector<SceneEvent> events;     // oldest first; some may be over
  double time_s = 0;                  // when it was taken
  uint64_t number = 0;                // counts snapshots

  const ObjectRecord* Find(EntityId id) const;  // nullptr when it is not there
};

// What may have changed without the rest: an Entity State Update.
struct ObjectChange {
  glm::dvec3 position_ecef{0.0};
  glm::dvec3 velocity_mps{0.0};
  EulerAngles orientation;
  uint32_t appearance = 0;
  double time_s = 0;
};

// How long an object may be silent.
struct TimeoutRule {
  EntityPattern types;             // of these,
  std::optional<uint8_t> version;  // reported in this version of the protocol,
  std::optional<bool> stationary;  // standing still or moving
  double timeout_s = 12.0;
};
inline constexpr size_t kMostTimeoutRules = 16;
inline constexpr double kStationary_mps = 0.05;  // what moves no faster, and does not turn, stands still
// IEEE 1278.1-2012: what stands still is reported once a minute, and times out after 2.4 times as long.
inline constexpr double kStationaryTimeout_s = 144.0;
std::vector<TimeoutRule> DefaultTimeouts();

struct ObjectTableOptions {
  size_t capacity = 100'000;
  double timeout_s = 12.0;
  std::vector<TimeoutRule> timeouts = DefaultTimeouts();  // at most kMostTimeoutRules; the first that fits holds
  double publish_interval_s = 0.05;
};

struct ObjectTableCounters {
  size_t alive = 0, most_alive = 0;
  uint64_t added = 0, removed = 0, timed_out = 0, crowded_out = 0, out_of_order = 0, clamped = 0, not_visible = 0;
  uint64_t held = 0;
};
class ObjectTable {
 public:
  using Options = ObjectTableOptions;
  explicit ObjectTable(const Options& options = {});
  ObjectTable(const ObjectTable&) = delete;
  ObjectTable& operator=(const ObjectTable&) = delete;

  // Adds or replaces. Fills flags and report, clamps the motion; a deactivated entity is removed instead. A record
  // whose state is up to 2 s older than the one there came out of order: only received_s moves. REQUIRES: kinematics
  // are finite.
  void Put(const ObjectRecord& record) EXCLUDES_LOCK(mutex_);
  // False when the object is not known (its type and model are not, so there is nothing to show).
  bool Change(EntityId id, const ObjectChange& change, double received_s) EXCLUDES_LOCK(mutex_);
  bool Remove(EntityId id) EXCLUDES_LOCK(mutex_);
  // Stops the object where it is shown at now_s, until Release or the next report of it.
  bool Hold(EntityId id, double now_s) EXCLUDES_LOCK(mutex_);
  bool Release(EntityId id, double now_s) EXCLUDES_LOCK(mutex_);
  std::optional<ObjectRecord> Find(EntityId id) const EXCLUDES_LOCK(mutex_);
  // Shown from its start_s to its end_s. Its number is filled in.
  void AddEvent(const SceneEvent& event) EXCLUDES_LOCK(mutex_);
  // Of every object known now, in order.
  std::vector<EntityId> Ids() const EXCLUDES_LOCK(mutex_);
  // Drops what has timed out and publishes what has changed, if it is time for either. Writers call it after a batch.
  void Tick(double now_s) EXCLUDES_LOCK(mutex_, published_mutex_);
  // When Tick next has something to do, though nothing more is put; nullopt: never.
  std::optional<double> NextTick() const EXCLUDES_LOCK(mutex_);

  // Never null. As of the last Tick that published.
  std::shared_ptr<const ObjectSnapshot> Snapshot() const EXCLUDES_LOCK(published_mutex_);
  ObjectTableCounters Counters() const EXCLUDES_LOCK(mutex_);

 private:
  using Slot = uint32_t;
  static constexpr Slot kNoSlot = ~Slot{0};
  struct Entry {
    ObjectRecord record;
    Slot staler = kNoSlot, fresher = kNoSlot;  // neighbours in its line, in the order of received_s
    size_t line = 0;
    bool held = false;
  };
  // Objects that may be silent for equally long: of timeouts[i], the last is for those that no rule fits.
  struct Line {
    double timeout_s = 0;
    Slot stalest = kNoSlot, freshest = kNoSlot;
  };

  Slot AddSlot(EntityId id) REQUIRES_LOCK(mutex_);
  void Drop(Slot slot) REQUIRES_LOCK(mutex_);
  void Unlink(Slot slot) REQUIRES_LOCK(mutex_);
  void LinkFreshest(Slot slot) REQUIRES_LOCK(mutex_);
  size_t LineOf(const ObjectRecord& record) const;
  Slot Stalest() const REQUIRES_LOCK(mutex_);
  void Accept(Slot slot, const ObjectRecord& record) REQUIRES_LOCK(mutex_);
  std::shared_ptr<const ObjectSnapshot> Build(double now_s) REQUIRES_LOCK(mutex_);
  class SnapshotPool;

  const Options options_;
  mutable Mutex mutex_;
  std::vector<Entry> entries_ GUARDED_BY(mutex_);
  std::vector<Slot> free_ GUARDED_BY(mutex_);
  const std::shared_ptr<SnapshotPool> pool_;
  std::map<EntityId, Slot> slots_ GUARDED_BY(mutex_);
  std::vector<Line> lines_ GUARDED_BY(mutex_);
  bool changed_ GUARDED_BY(mutex_) = false;
  double next_publish_s_ GUARDED_BY(mutex_);
  uint64_t snapshots_ GUARDED_BY(mutex_) = 0;
  uint32_t incarnations_ GUARDED_BY(mutex_) = 0;
  std::deque<SceneEvent> events_ GUARDED_BY(mutex_);
  uint32_t events_added_ GUARDED_BY(mutex_) = 0;
  ObjectTableCounters counters_ GUARDED_BY(mutex_);

  mutable Mutex published_mutex_;
  std::shared_ptr<const ObjectSnapshot> published_ GUARDED_BY(published_mutex_);
};

}  // namespace belvedere
