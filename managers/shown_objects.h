// ShownObjects: what a view remembers of the objects that it shows from list to list: how their corrections are
// smoothed and where their labels stand. Found by the object's slot in the table, without a search; an object that a
// list does not show is forgotten.
//
// Threads: the object manager's.
#pragma once

#include "managers/effects.h"
#include "managers/footing.h"
#include "runtime/scene/label_box.h"
#include "runtime/scene/motion.h"
#include "runtime/scene/object_table.h"

#include <cstdint>
#include <vector>

namespace belvedere {

struct ShownObject {
  uint32_t slot = 0;
  uint32_t incarnation = 0;
  uint64_t list = 0;  // the last that showed it
  Smoother smoother{};
  GroundBlend ground{};
  bool labelled = false;
  LabelSide label_side = LabelSide::kRight;
  std::vector<TrackPoint> track{};  // where it was shown, oldest first; kept where trails are asked for
};
inline constexpr size_t kMostTrackPoints = 64;

class ShownObjects {
 public:
  // The object's memory, new where it was not shown before. Valid until the next call of this or Forget.
  ShownObject& Show(const ObjectRecord& record, uint64_t list);
  // The object's memory if it has one.
  ShownObject* Find(uint32_t slot);
  // Of all that the list has not shown.
  void ForgetOthers(uint64_t list);
  size_t size() const { return shown_.size(); }

 private:
  static constexpr uint32_t kNone = ~uint32_t{0};
  std::vector<uint32_t> by_slot_;  // index -> shown_, kNone
  std::vector<ShownObject> shown_;
};

}  // namespace belvedere
