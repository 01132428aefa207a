// ObjectManager: chooses, for one view, which moving objects are seen and how: as a model at the level of detail that
// their size on the screen deserves, or as a symbol; and publishes them as display lists.
//
// It owns a thread that takes the newest snapshot of the object table, dead-reckons every object to now, smooths
// corrections, stands ground vehicles on the terrain that is resident, culls what is too small or hidden, shows groups
// as one symbol (group_selection.h), finds room for labels, adds effects, and publishes.
//
// Threads: constructed and destroyed by the UI thread; destroying stops the thread and withdraws the view's wishes.
#pragma once

#include "managers/cluster_manager.h"
#include "runtime/base/clock.h"
#include "runtime/paging/paging.h"
#include "runtime/scene/entity_looks.h"
#include "runtime/scene/object_table.h"
#include "runtime/scene/view_channel.h"

#include <memory>

namespace belvedere {

class ObjectManager {
 public:
  // looks: what each type of entity looks like; its model numbers are those of the catalogue that the model server
  // reads.
  ObjectManager(ViewId view, Paging& paging, const EntityLooks& looks, const ObjectTable& objects,
                const ClusterManager& clusters, std::shared_ptr<ViewChannel> channel, const Clock& clock);
  ~ObjectManager();
  ObjectManager(const ObjectManager&) = delete;
  ObjectManager& operator=(const ObjectManager&) = delete;

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
  const ViewId view_;
  Paging& paging_;
};

}  // namespace belvedere
