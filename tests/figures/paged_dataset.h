// PagedDataset: a dataset with read modules and a cache, and no servers: what a list wishes for is read when the caller
// says, and its images count as being on the GPU from then on. For programs that look at lists and draw nothing.
//
// Owns: the pins of all that was read, until Unpin. Threads: one.
#pragma once

#include "managers/list_pages.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/paging/terrain_height.h"
#include "servers/stock_modules.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace belvedere::figures {

class PagedDataset {
 public:
  static Result<std::unique_ptr<PagedDataset>> Open(const std::string& path) {
    Result<std::unique_ptr<Dataset>> dataset = Dataset::Open(path);
    if (!dataset.ok()) return dataset.status();
    std::unique_ptr<PagedDataset> paged(new PagedDataset(std::move(*dataset)));
    const Status registered = RegisterStockModules(paged->registry_, *paged->dataset_, paged->models_, {});
    if (!registered.ok()) return registered;
    paged->paging_ = std::make_unique<Paging>(MakeLayerTable(paged->registry_), kCache_bytes, Clock::System());
    paged->terrain_ = paged->layers().Find(kTerrainLayer)->type;
    return paged;
  }

  const Dataset& dataset() const { return *dataset_; }
  Paging& paging() { return *paging_; }
  const LayerTable& layers() const { return paging_->layers; }
  DataType terrain() const { return terrain_; }

  Result<PagePin> Read(const PageKey& key) { return ReadIntoCache(*paging_, registry_, key); }

  // Reads what a list wished for and pretends to upload it. False when there was nothing to do.
  bool Serve(const DisplayList& list) {
    bool any = false;
    for (const auto& queue : paging_->queues) {
      while (const std::optional<PageKey> key = queue->TryTake()) {
        any = true;
        if (Result<PagePin> pin = Read(*key); pin.ok()) pins_.push_back(std::move(*pin));
        queue->Done(*key);
      }
    }
    for (const PagePin& pin : list.uploads) pins_.push_back(pin.Share());
    for (; placed_ < pins_.size(); ++placed_) {
      const PagePin& pin = pins_[placed_];
      if (pin.key().type == terrain_ || pin.page().residency()->on_gpu()) continue;
      any = true;
      pin.page().residency()->Place(next_slot_++);
    }
    return any;
  }
  void Unpin() {
    pins_.clear();
    placed_ = 0;
  }

  ViewMatrices MatricesFor(const ViewParameters& view) {
    const Geodetic eye = ToGeodetic(view.eye_ecef);
    const auto ground = GroundUnder(*paging_, terrain_, eye.latitude_deg, eye.longitude_deg);
    return MatricesOf(view, 0, std::max(0.0, eye.height_m - (ground ? ground->height_m : 0)));
  }

 private:
  static constexpr size_t kCache_bytes = size_t{4} << 30;
  explicit PagedDataset(std::unique_ptr<Dataset> dataset) : dataset_(std::move(dataset)) {}

  std::unique_ptr<Dataset> dataset_;
  ModelCatalogue models_;
  ModuleRegistry registry_;
  std::unique_ptr<Paging> paging_;
  DataType terrain_ = 0;
  int next_slot_ = 0;
  size_t placed_ = 0;  // of pins_, those that have been looked at
  std::vector<PagePin> pins_;
};

}  // namespace belvedere::figures
