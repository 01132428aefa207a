#include "servers/page_server.h"

#include "servers/server_thread.h"

#include <optional>

namespace belvedere {
PageServer::PageServer(Paging& paging, const ModuleRegistry& registry, DataType type, int threads)
    : paging_(paging), registry_(registry), type_(type) {
  BELVEDERE_CHECK(threads > 0);
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { Run(); });
}

PageServer::~PageServer() {
  Stop();
  for (std::thread& thread : threads_) thread.join();
}

void PageServer::Stop() {
  paging_.queue(type_).Stop();
}

void PageServer::Run() {
  BecomeServerThread(registry_.at(type_).layer);
  RequestQueue& queue = paging_.queue(type_);
  while (const std::optional<PageKey> key = queue.Take()) {
    // Its pin is given back at once: whoever wished for the page finds it in the cache, and a failure is kept there
    // too.
    {
      const GatePass pass(paging_.reading);
      static_cast<void>(ReadIntoCache(paging_, registry_, *key));
    }
    queue.Done(*key);
  }
}

ServerSet::ServerSet(Paging& paging, const ModuleRegistry& registry) {
  BELVEDERE_CHECK(paging.layers.size() == static_cast<int>(registry.modules().size()));
  for (const ReadModule& module : registry.modules()) {
    servers_.push_back(std::make_unique<PageServer>(paging, registry, module.type, module.threads));
  }
}

ServerSet::~ServerSet() {
  for (const std::unique_ptr<PageServer>& server : servers_) server->Stop();  // all first, so that they end together
}

int ServerSet::threads() const {
  int sum = 0;
  for (const std::unique_ptr<PageServer>& server : servers_) sum += server->threads();
  return sum;
}

}  // namespace belvedere
