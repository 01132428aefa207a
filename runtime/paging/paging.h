// Paging: the three things through which pages flow, together: which layers there are, what is in memory, what is
// wanted.
//
// Managers find pages in `cache` and wish for missing ones through the queue of their data type; the server of that
// data type takes wishes from the queue, reads or makes the page, and inserts it. Nobody else talks to a server.
//
// Model pages are keyed by a quadcode too, for one kind of key serves all: ModelNode(number) names the model of that
// number in the model catalogue (model_catalogue.h) and says nothing about a place.
//
// Threads: `layers` is read-only after the start; cache and queues are for any thread.
#pragma once

#include "runtime/base/gate.h"
#include "runtime/paging/layer_table.h"
#include "runtime/paging/request_queue.h"
#include "runtime/paging/shared_cache.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace belvedere {

struct Paging {
  static constexpr size_t kQueueCapacity = 8192;  // requests that may wait for one server

  Paging(LayerTable table, size_t budget_bytes, const Clock& clock)
      : layers(std::move(table)), cache(budget_bytes, layers.size()) {
    for (int type = 0; type < layers.size(); ++type) {
      queues.push_back(std::make_unique<RequestQueue>(kQueueCapacity, clock));
    }
  }
  RequestQueue& queue(DataType type) { return *queues[type]; }

  const LayerTable layers;
  SharedCache cache;
  std::vector<std::unique_ptr<RequestQueue>> queues;  // one a data type
  // Servers read a page, and terrain managers make a list, while they have a pass. Whoever changes what pages are made
  // of closes the first, and when no server is at the disk any more the second: so managers wait for no disk.
  Gate reading, listing;
  std::atomic<uint64_t> generation{0};  // one more with each such change
};

}  // namespace belvedere
