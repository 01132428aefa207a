#include "runtime/scene/object_table.h"

#include "runtime/base/status.h"
#include "runtime/earth/ellipsoid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace belvedere {
namespace {

constexpr double kDeepest_m = 100e3;               // under the ellipsoid
constexpr double kNotGiven_m = 1.0;                // this close to the Earth's centre no position was given
constexpr double kOutOfOrder_s = 2.0;              // a state older by more is a sender that set its clock
constexpr double kBuildShare_sPerObject = 2.5e-6;  // ten times what copying one record takes

bool StandsStill(const KinematicState& state) {
  if (state.model == DeadReckoning::kStatic) return true;
  const auto slow = [](const glm::dvec3& v) { return std::hypot(v.x, v.y, v.z) <= kStationary_mps; };
  return slow(state.velocity_mps) && (!ModelRotates(state.model) || slow(state.angular_velocity_radps)) &&
         (!ModelAccelerates(state.model) || slow(state.acceleration_mps2));
}

}  // namespace

uint8_t PositionFlags(const glm::dvec3& ecef) {
  const double radius_m = std::hypot(ecef.x, ecef.y, ecef.z);
  if (radius_m < kNotGiven_m) return kObjectAtEarthCentre;
  if (radius_m > kFarthestObject_m) return kObjectTooFar;
  // The ellipsoid's radius in that direction; against it, depths are right to a fraction of a percent.
  const double sine = ecef.z / radius_m;
  const double surface_m =
      kEquatorialRadius_m / std::sqrt(1.0 + sine * sine * kEccentricitySquared / (1.0 - kEccentricitySquared));
  return radius_m < surface_m - kDeepest_m ? uint8_t{kObjectUnderground} : uint8_t{0};
}

std::vector<TimeoutRule> DefaultTimeouts() {
  return {{.types = {}, .version = uint8_t{7}, .stationary = true, .timeout_s = kStationaryTimeout_s}};
}

const ObjectRecord* ObjectSnapshot::Find(EntityId id) const {
  const auto at = std::lower_bound(objects.begin(), objects.end(), id,
                                   [](const ObjectRecord& record, EntityId wanted) { return record.id < wanted; });
  return at != objects.end() && at->id == id ? &*at : nullptr;
}

// Snapshots that nobody reads any more: their memory serves the next ones, which is as large.
class ObjectTable::SnapshotPool : public std::enable_shared_from_this<SnapshotPool> {
 public:
  std::shared_ptr<ObjectSnapshot> Get() {
    std::unique_ptr<ObjectSnapshot> snapshot;
    {
      MutexLock lock(mutex_);
      if (!spare_.empty()) {
        snapshot = std::move(spare_.back());
        spare_.pop_back();
      }
    }
    if (snapshot == nullptr) snapshot = std::make_unique<ObjectSnapshot>();
    snapshot->objects.clear();
    snapshot->events.clear();
    return {snapshot.release(), [pool = shared_from_this()](ObjectSnapshot* done) { pool->Put(done); }};
  }

 private:
  void Put(ObjectSnapshot* done) {
    std::unique_ptr<ObjectSnapshot> snapshot(done);
    MutexLock lock(mutex_);
    if (spare_.size() < kMostSpare) spare_.push_back(std::move(snapshot));
  }

  static constexpr size_t kMostSpare = 2;
  Mutex mutex_;
  std::vector<std::unique_ptr<ObjectSnapshot>> spare_ GUARDED_BY(mutex_);
};

ObjectTable::ObjectTable(const Options& options)
    : options_(options),
      pool_(std::make_shared<SnapshotPool>()),
      next_publish_s_(-HUGE_VAL),
      published_(std::make_shared<ObjectSnapshot>()) {
  BELVEDERE_CHECK(options_.capacity > 0 && options_.capacity < kNoSlot);
  BELVEDERE_CHECK(options_.timeouts.size() <= kMostTimeoutRules);
  for (const TimeoutRule& rule : options_.timeouts) lines_.push_back({.timeout_s = rule.timeout_s});
  lines_.push_back({.timeout_s = options_.timeout_s});
}

void ObjectTable::Put(const ObjectRecord& record) {
  MutexLock lock(mutex_);
  const auto known = slots_.find(record.id);
  if ((record.appearance & kAppearanceDeactivated) != 0) {
    if (known == slots_.end()) return;
    ++counters_.removed;
    Drop(known->second);
    return;
  }
  Accept(known == slots_.end() ? AddSlot(record.id) : known->second, record);
}

bool ObjectTable::Change(EntityId id, const ObjectChange& change, double received_s) {
  MutexLock lock(mutex_);
  const auto known = slots_.find(id);
  if (known == slots_.end()) return false;
  if ((change.appearance & kAppearanceDeactivated) != 0) {
    ++counters_.removed;
    Drop(known->second);
    return true;
  }
  ObjectRecord record = entries_[known->second].record;
  record.kinematics.position_ecef = change.position_ecef;
  record.kinematics.velocity_mps = change.velocity_mps;
  record.kinematics.orientation = change.orientation;
  record.kinematics.time_s = change.time_s;
  record.appearance = change.appearance;
  record.received_s = received_s;
  Accept(known->second, record);
  return true;
}

bool ObjectTable::Remove(EntityId id) {
  MutexLock lock(mutex_);
  const auto known = slots_.find(id);
  if (known == slots_.end()) return false;
  ++counters_.removed;
  Drop(known->second);
  return true;
}

bool ObjectTable::Hold(EntityId id, double now_s) {
  MutexLock lock(mutex_);
  const auto known = slots_.find(id);
  if (known == slots_.end()) return false;
  Entry& entry = entries_[known->second];
  if (entry.held) return true;
  KinematicState& motion = entry.record.kinematics;
  if ((entry.record.flags & kObjectFrozen) == 0) motion = Extrapolate(motion, now_s - motion.time_s);
  motion.time_s = now_s;
  entry.held = true;
  entry.record.flags |= kObjectFrozen;
  ++entry.record.report;
  ++counters_.held;
  changed_ = true;
  return true;
}

bool ObjectTable::Release(EntityId id, double now_s) {
  MutexLock lock(mutex_);
  const auto known = slots_.find(id);
  if (known == slots_.end()) return false;
  Entry& entry = entries_[known->second];
  if (!entry.held) return true;
  entry.held = false;
  if ((entry.record.appearance & kAppearanceFrozen) == 0) {
    entry.record.flags = static_cast<uint8_t>(entry.record.flags & ~kObjectFrozen);
  }
  entry.record.kinematics.time_s = now_s;
  ++entry.record.report;
  changed_ = true;
  return true;
}

std::optional<ObjectRecord> ObjectTable::Find(EntityId id) const {
  MutexLock lock(mutex_);
  const auto known = slots_.find(id);
  if (known == slots_.end()) return std::nullopt;
  return entries_[known->second].record;
}

void ObjectTable::AddEvent(const SceneEvent& event) {
  MutexLock lock(mutex_);
  if (events_.size() == kMostSceneEvents) events_.pop_front();
  events_.push_back(event);
  events_.back().number = ++events_added_;
  changed_ = true;
}

std::vector<EntityId> ObjectTable::Ids() const {
  MutexLock lock(mutex_);
  std::vector<EntityId> ids;
  ids.reserve(slots_.size());
  for (const auto& [id, slot] : slots_) ids.push_back(id);
  return ids;
}

void ObjectTable::Tick(double now_s) {
  std::shared_ptr<const ObjectSnapshot> next;
  {
    MutexLock lock(mutex_);
    for (const Line& line : lines_) {
      while (line.stalest != kNoSlot && entries_[line.stalest].record.received_s + line.timeout_s <= now_s) {
        ++counters_.timed_out;
        Drop(line.stalest);
      }
    }
    if (!changed_ || now_s < next_publish_s_) return;
    next = Build(now_s);
  }
  MutexLock lock(published_mutex_);
  // Two writers may come here out of order; readers never go back.
  if (next->number > published_->number) published_.swap(next);
}

std::optional<double> ObjectTable::NextTick() const {
  MutexLock lock(mutex_);
  std::optional<double> next;
  for (const Line& line : lines_) {
    if (line.stalest == kNoSlot) continue;
    const double due_s = entries_[line.stalest].record.received_s + line.timeout_s;
    next = std::min(next.value_or(due_s), due_s);
  }
  if (changed_) next = std::min(next.value_or(next_publish_s_), next_publish_s_);
  return next;
}

std::shared_ptr<const ObjectSnapshot> ObjectTable::Snapshot() const {
  MutexLock lock(published_mutex_);
  return published_;
}

ObjectTableCounters ObjectTable::Counters() const {
  MutexLock lock(mutex_);
  ObjectTableCounters counters = counters_;
  counters.alive = slots_.size();
  return counters;
}

ObjectTable::Slot ObjectTable::AddSlot(EntityId id) {
  if (slots_.size() >= options_.capacity) {
    ++counters_.crowded_out;
    Drop(Stalest());
  }
  Slot slot;
  if (free_.empty()) {
    slot = static_cast<Slot>(entries_.size());
    entries_.emplace_back();
  } else {
    slot = free_.back();
    free_.pop_back();
    entries_[slot] = {};
  }
  entries_[slot].record.id = id;
  entries_[slot].record.slot = slot;
  entries_[slot].record.incarnation = ++incarnations_;
  entries_[slot].record.kinematics.time_s = -HUGE_VAL;
  entries_[slot].line = lines_.size() - 1;
  LinkFreshest(slot);
  slots_.emplace(id, slot);
  ++counters_.added;
  counters_.most_alive = std::max(counters_.most_alive, slots_.size());
  return slot;
}

void ObjectTable::Drop(Slot slot) {
  Unlink(slot);
  slots_.erase(entries_[slot].record.id);
  free_.push_back(slot);
  changed_ = true;
}

void ObjectTable::Unlink(Slot slot) {
  const Entry& entry = entries_[slot];
  Line& line = lines_[entry.line];
  (entry.staler == kNoSlot ? line.stalest : entries_[entry.staler].fresher) = entry.fresher;
  (entry.fresher == kNoSlot ? line.freshest : entries_[entry.fresher].staler) = entry.staler;
}

void ObjectTable::LinkFreshest(Slot slot) {
  Line& line = lines_[entries_[slot].line];
  entries_[slot].staler = line.freshest;
  entries_[slot].fresher = kNoSlot;
  (line.freshest == kNoSlot ? line.stalest : entries_[line.freshest].fresher) = slot;
  line.freshest = slot;
}

size_t ObjectTable::LineOf(const ObjectRecord& record) const {
  const bool stationary = StandsStill(record.kinematics);
  for (size_t i = 0; i < options_.timeouts.size(); ++i) {
    const TimeoutRule& rule = options_.timeouts[i];
    if (rule.version && *rule.version != record.protocol_version) continue;
    if (rule.stationary && *rule.stationary != stationary) continue;
    if (rule.types.Fits(record.type)) return i;
  }
  return options_.timeouts.size();
}

ObjectTable::Slot ObjectTable::Stalest() const {
  Slot stalest = kNoSlot;
  for (const Line& line : lines_) {
    if (line.stalest == kNoSlot) continue;
    const bool staler =
        stalest == kNoSlot || entries_[line.stalest].record.received_s < entries_[stalest].record.received_s;
    if (staler) stalest = line.stalest;
  }
  return stalest;
}

void ObjectTable::Accept(Slot slot, const ObjectRecord& record) {
  Unlink(slot);
  entries_[slot].line = LineOf(record);
  LinkFreshest(slot);
  changed_ = true;
  ObjectRecord& mine = entries_[slot].record;
  const double age_s = mine.kinematics.time_s - record.kinematics.time_s;
  if (age_s > 0.0 && age_s < kOutOfOrder_s) {
    ++counters_.out_of_order;
    mine.received_s = record.received_s;
    return;
  }
  entries_[slot].held = false;
  const uint32_t report = mine.report + 1, incarnation = mine.incarnation;
  mine = record;
  mine.report = report;
  mine.slot = slot;
  mine.incarnation = incarnation;
  mine.part_count = std::min(mine.part_count, static_cast<uint8_t>(ObjectRecord::kMaxParts));
  mine.attached_count = std::min(mine.attached_count, static_cast<uint8_t>(ObjectRecord::kMaxParts));
  mine.flags =
      static_cast<uint8_t>((record.flags & kObjectUnknownModel) | PositionFlags(mine.kinematics.position_ecef));
  if (ClampMotion(mine.kinematics)) {
    mine.flags |= kObjectMotionClamped;
    ++counters_.clamped;
  }
  if ((mine.appearance & kAppearanceFrozen) != 0) mine.flags |= kObjectFrozen;
  if (!mine.visible()) ++counters_.not_visible;
}

std::shared_ptr<const ObjectSnapshot> ObjectTable::Build(double now_s) {
  const std::shared_ptr<ObjectSnapshot> snapshot = pool_->Get();
  snapshot->time_s = now_s;
  snapshot->number = ++snapshots_;
  snapshot->objects.reserve(slots_.size());
  for (const auto& [id, slot] : slots_) {
    ObjectRecord& record = snapshot->objects.emplace_back(entries_[slot].record);
    if ((record.flags & kObjectFrozen) != 0) record.kinematics.model = DeadReckoning::kStatic;
  }
  std::erase_if(events_, [&](const SceneEvent& event) { return event.end_s <= now_s; });
  snapshot->events.assign(events_.begin(), events_.end());
  changed_ = false;
  next_publish_s_ =
      now_s + std::max(options_.publish_interval_s, kBuildShare_sPerObject * static_cast<double>(slots_.size()));
  return snapshot;
}

}  // namespace belvedere
