#include "runtime/scene/object_table.h"

#include "runtime/base/status.h"
#include "runtime/earth/ellipsoid.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace belvedere {
namespace {

constexpr double kDeepest_m = 100e3;               // under the ellipsoid
constexpr double kNotGiven_m = 1.0;                // this close to the Earth's centre no position was given
constexpr double kOutOfOrder_s = 2.0;              // a state older by more is a sender that set its clock
constexpr double kBuildShare_sPerObject = 2.5e-6;  // ten times what copying one record takes

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

}  // namespace

std::string EntityId::ToString() const {
  return fmt::format("{}:{}:{}", site, application, entity);
}

std::optional<EntityId> EntityId::Parse(std::string_view text) {
  std::array<uint16_t, 3> numbers{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ':')) return std::nullopt;
    const auto [after, error] = std::from_chars(at, end, numbers[i]);
    if (error != std::errc() || after == at) return std::nullopt;
    at = after;
  }
  if (at != end) return std::nullopt;
  return EntityId{numbers[0], numbers[1], numbers[2]};
}

std::string EntityType::ToString() const {
  return fmt::format("{}.{}.{}.{}.{}.{}.{}", kind, domain, country, category, subcategory, specific, extra);
}

Marking Marking::Sanitise(std::span<const uint8_t> bytes) {
  Marking marking;
  for (const uint8_t byte : bytes.first(std::min(bytes.size(), kMaxLength))) {
    if (byte == 0) break;
    marking.text_[marking.length_++] = byte >= 0x20 && byte < 0x7F ? static_cast<char>(byte) : '?';
  }
  while (marking.length_ > 0 && marking.text_[marking.length_ - size_t{1}] == ' ') --marking.length_;
  return marking;
}

Marking Marking::Sanitise(std::string_view text) {
  std::array<uint8_t, kMaxLength> bytes{};
  const size_t length = std::min(text.size(), kMaxLength);
  std::copy_n(text.begin(), length, bytes.begin());
  return Sanitise(std::span<const uint8_t>(bytes.data(), length));
}

const ObjectRecord* ObjectSnapshot::Find(EntityId id) const {
  const auto at = std::lower_bound(objects.begin(), objects.end(), id,
                                   [](const ObjectRecord& record, EntityId wanted) { return record.id < wanted; });
  return at != objects.end() && at->id == id ? &*at : nullptr;
}

ObjectTable::ObjectTable(const Options& options)
    : options_(options), next_publish_s_(-HUGE_VAL), published_(std::make_shared<ObjectSnapshot>()) {
  BELVEDERE_CHECK(options_.capacity > 0 && options_.capacity < kNoSlot);
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
    while (stalest_ != kNoSlot && entries_[stalest_].record.received_s + options_.timeout_s <= now_s) {
      ++counters_.timed_out;
      Drop(stalest_);
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
  if (stalest_ != kNoSlot) next = entries_[stalest_].record.received_s + options_.timeout_s;
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
    Drop(stalest_);
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
  entries_[slot].record.kinematics.time_s = -HUGE_VAL;
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
  (entry.staler == kNoSlot ? stalest_ : entries_[entry.staler].fresher) = entry.fresher;
  (entry.fresher == kNoSlot ? freshest_ : entries_[entry.fresher].staler) = entry.staler;
}

void ObjectTable::LinkFreshest(Slot slot) {
  entries_[slot].staler = freshest_;
  entries_[slot].fresher = kNoSlot;
  (freshest_ == kNoSlot ? stalest_ : entries_[freshest_].fresher) = slot;
  freshest_ = slot;
}

void ObjectTable::Accept(Slot slot, const ObjectRecord& record) {
  Unlink(slot);
  LinkFreshest(slot);
  changed_ = true;
  ObjectRecord& mine = entries_[slot].record;
  const double age_s = mine.kinematics.time_s - record.kinematics.time_s;
  if (age_s > 0.0 && age_s < kOutOfOrder_s) {
    ++counters_.out_of_order;
    mine.received_s = record.received_s;
    return;
  }
  const uint32_t report = mine.report + 1;
  mine = record;
  mine.report = report;
  mine.part_count = std::min(mine.part_count, static_cast<uint8_t>(ObjectRecord::kMaxParts));
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
  auto snapshot = std::make_shared<ObjectSnapshot>();
  snapshot->time_s = now_s;
  snapshot->number = ++snapshots_;
  snapshot->objects.reserve(slots_.size());
  for (const auto& [id, slot] : slots_) {
    ObjectRecord& record = snapshot->objects.emplace_back(entries_[slot].record);
    if ((record.flags & kObjectFrozen) != 0) record.kinematics.model = DeadReckoning::kStatic;
  }
  changed_ = false;
  next_publish_s_ =
      now_s + std::max(options_.publish_interval_s, kBuildShare_sPerObject * static_cast<double>(slots_.size()));
  return snapshot;
}

}  // namespace belvedere
