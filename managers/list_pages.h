// ListPages: a manager's view of the cache and the GPU, for one display list. Pins what it hands out into the list, and
// gathers what the manager wants: wishes for the servers, uploads for the render thread.
//
// Threads: the manager's.
#pragma once

#include "managers/cut.h"
#include "runtime/paging/paging.h"

#include <unordered_map>
#include <vector>

namespace belvedere {

// How many images a list may use: what it asks for beyond that would find no place on the GPU and be waited for in
// vain. Roots may always come, for without them the ground is bare.
struct ImageLimits {
  int colour = 1 << 16;
  int overlay = 1 << 16;
};

class ListPages final : public PageAccess {
 public:
  // Pages are pinned into `list`. REQUIRES: the list is clear and outlives this.
  ListPages(Paging& paging, DataType terrain, DisplayList& list, ImageLimits limits = {})
      : paging_(paging), terrain_(terrain), list_(list), limits_(limits) {}

  const TerrainPage* Terrain(Quadcode node) override;
  std::optional<int> Slot(const PageKey& key) override;
  bool Want(const PageKey& key, float priority) override;

  // For a list that is still to come: whether the page is in memory, and a wish that it should come there. Of an image
  // this uses nothing of ImageLimits.
  bool IsInMemory(const PageKey& key) const { return paging_.cache.Contains(key); }
  bool WantSoon(const PageKey& key, float priority);

  // The page, pinned in the list; nullptr when it is not in memory.
  const Page* Find(const PageKey& key) { return Look(key).page; }

  // Which of a view's queues a manager speaks for.
  enum class Queues { kTerrain, kObjects };
  // Leaves in list.layer_pages where the pages of each layer are that were looked for.
  void CountByLayer();
  // Sends the wishes of that view to those queues, sorts the list's uploads, most wanted first, and tells the list
  // where the pages of each layer are.
  void Finish(ViewId view, Queues queues);
  bool at_limit() const { return at_limit_; }  // an image was refused for ImageLimits
  size_t pages_waiting() const { return wishes_.size() - foreseen_ + uploads_.size(); }

 private:
  struct KeyHash {
    size_t operator()(const PageKey& key) const noexcept {
      return std::hash<Quadcode>()(key.node) + key.type * 0x9E37u;
    }
  };
  struct Known {
    const Page* page = nullptr;  // nullptr: not in memory
    int slot = -1;               // pinned in the list
    bool wanted = false;
    bool failed = false;
  };
  Known& Look(const PageKey& key);
  // Of the images that the list uses and wants, those of the key's kind; nullptr: it is no image.
  int* CountOf(const PageKey& key);
  bool HasRoomFor(const PageKey& key);

  struct Upload {
    float priority;
    PagePin pin;
  };

  Paging& paging_;
  const DataType terrain_;
  DisplayList& list_;
  const ImageLimits limits_;
  int colour_ = 0, overlay_ = 0;
  bool at_limit_ = false;
  std::unordered_map<PageKey, Known, KeyHash> known_;
  std::vector<Wish> wishes_;
  size_t foreseen_ = 0;  // of the wishes
  std::vector<Upload> uploads_;
};

}  // namespace belvedere
