#include "managers/shown_objects.h"

#include <utility>

namespace belvedere {

ShownObject& ShownObjects::Show(const ObjectRecord& record, uint64_t list) {
  if (record.slot >= by_slot_.size()) by_slot_.resize(size_t{record.slot} + 1, kNone);
  uint32_t& index = by_slot_[record.slot];
  if (index == kNone) {
    index = static_cast<uint32_t>(shown_.size());
    shown_.push_back({.slot = record.slot, .incarnation = record.incarnation});
  } else if (shown_[index].incarnation != record.incarnation) {
    shown_[index] = {.slot = record.slot, .incarnation = record.incarnation};
  }
  ShownObject& shown = shown_[index];
  shown.list = list;
  return shown;
}

ShownObject* ShownObjects::Find(uint32_t slot) {
  const uint32_t index = slot < by_slot_.size() ? by_slot_[slot] : kNone;
  return index == kNone ? nullptr : &shown_[index];
}

void ShownObjects::ForgetOthers(uint64_t list) {
  for (size_t i = 0; i < shown_.size();) {
    if (shown_[i].list == list) {
      ++i;
      continue;
    }
    by_slot_[shown_[i].slot] = kNone;
    if (i + 1 < shown_.size()) {
      shown_[i] = std::move(shown_.back());
      by_slot_[shown_[i].slot] = static_cast<uint32_t>(i);
    }
    shown_.pop_back();
  }
}

}  // namespace belvedere
