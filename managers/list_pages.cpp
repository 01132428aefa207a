#include "managers/list_pages.h"

#include <algorithm>
#include <span>

namespace belvedere {

ListPages::Known& ListPages::Look(const PageKey& key) {
  const auto [entry, is_new] = known_.try_emplace(key);
  Known& known = entry->second;
  if (!is_new) return known;
  PagePin pin = paging_.cache.Find(key);
  if (!pin) return known;
  known.page = &pin.page();
  // The vertices of terrain go into the list itself.
  const std::optional<int> slot = key.type == terrain_ ? std::nullopt : known.page->residency()->TryPin();
  if (slot) {
    known.slot = *slot;
    if (int* count = CountOf(key)) ++*count;
    list_.gpu_pins.push_back(known.page->residency().get());
  }
  list_.page_pins.push_back(std::move(pin));
  return known;
}

const TerrainPage* ListPages::Terrain(Quadcode node) {
  return static_cast<const TerrainPage*>(Look({terrain_, node}).page);
}

std::optional<int> ListPages::Slot(const PageKey& key) {
  const Known& known = Look(key);
  return known.slot < 0 ? std::nullopt : std::optional<int>(known.slot);
}

bool ListPages::Want(const PageKey& key, float priority) {
  Known& known = Look(key);
  if (known.wanted) return true;
  if (!key.node.is_root() && !HasRoomFor(key)) {
    at_limit_ = true;
    return false;
  }
  if (known.page != nullptr) {
    known.wanted = true;
    if (int* count = CountOf(key)) ++*count;
    uploads_.push_back({priority, paging_.cache.Find(key)});
    return true;
  }
  known.failed = !paging_.cache.FailureOf(key).ok();
  if (known.failed) return false;
  known.wanted = true;
  if (int* count = CountOf(key)) ++*count;
  wishes_.push_back({key, priority});
  return true;
}

bool ListPages::WantSoon(const PageKey& key, float priority) {
  Known& known = Look(key);
  if (known.wanted) return true;
  if (known.page != nullptr || !paging_.cache.FailureOf(key).ok()) return false;
  known.wanted = true;
  wishes_.push_back({key, priority});
  ++foreseen_;
  return true;
}

int* ListPages::CountOf(const PageKey& key) {
  switch (paging_.layers.at(key.type).kind) {
    case PageKind::kColour: return &colour_;
    case PageKind::kOverlay: return &overlay_;
    case PageKind::kElevation:
    case PageKind::kTerrain:
    case PageKind::kModel: break;
  }
  return nullptr;
}

bool ListPages::HasRoomFor(const PageKey& key) {
  const int* count = CountOf(key);
  return count == nullptr || *count < (count == &colour_ ? limits_.colour : limits_.overlay);
}

void ListPages::CountByLayer() {
  std::vector<LayerPages> counts(static_cast<size_t>(paging_.layers.size()));
  for (const auto& [key, known] : known_) {
    LayerPages& of_layer = counts[key.type];
    if (of_layer.layer.empty()) of_layer.layer = paging_.layers.at(key.type).name;
    of_layer.on_gpu += known.slot >= 0 ? 1 : 0;
    of_layer.in_memory += known.slot < 0 && known.page != nullptr ? 1 : 0;
    of_layer.asked += known.page == nullptr && known.wanted ? 1 : 0;
    of_layer.failed += known.failed ? 1 : 0;
  }
  for (LayerPages& of_layer : counts) {
    if (!of_layer.layer.empty()) list_.layer_pages.push_back(std::move(of_layer));
  }
}

void ListPages::Finish(ViewId view, Queues queues) {
  std::sort(wishes_.begin(), wishes_.end(), [](const Wish& a, const Wish& b) { return a.key.type < b.key.type; });
  auto begin = wishes_.begin();
  for (int type = 0; type < paging_.layers.size(); ++type) {
    const auto end = std::find_if(begin, wishes_.end(), [&](const Wish& wish) { return wish.key.type != type; });
    const bool is_model = paging_.layers.at(static_cast<DataType>(type)).kind == PageKind::kModel;
    if (is_model == (queues == Queues::kObjects)) {
      paging_.queue(static_cast<DataType>(type)).SetWishes(view, std::span<const Wish>(begin, end));
    }
    begin = end;
  }
  std::sort(uploads_.begin(), uploads_.end(), [](const Upload& a, const Upload& b) { return a.priority > b.priority; });
  for (Upload& upload : uploads_) list_.uploads.push_back(std::move(upload.pin));
}

}  // namespace belvedere
