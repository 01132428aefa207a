#include "servers/page_server.h"

#include "runtime/base/trace.h"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <optional>

namespace belvedere {
namespace {

// Two such threads together get what one at niceness 4 would, where the display wants all cores, and all that it leaves
// otherwise. Where the system refuses, the thread runs as any other: slower frames, no other harm.
void YieldToTheDisplay() {
  constexpr int kNiceness = 7;
  const sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_BATCH, &none);
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
}

void NameThread(const std::string& layer) {
  constexpr size_t kLongestName = 15;
  pthread_setname_np(pthread_self(), ("srv " + layer).substr(0, kLongestName).c_str());
  Trace::NameThread("page server");
}

}  // namespace

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
  YieldToTheDisplay();
  NameThread(registry_.at(type_).layer);
  RequestQueue& queue = paging_.queue(type_);
  while (const std::optional<PageKey> key = queue.Take()) {
    // Its pin is given back at once: whoever wished for the page finds it in the cache, and a failure is kept there
    // too.
    static_cast<void>(ReadIntoCache(paging_, registry_, *key));
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
