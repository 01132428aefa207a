// Page server: takes the most wanted page of one data type from its queue, has the read module make it, and puts it
// into the shared cache; again and again, on threads of its own.
//
// Servers use the cores that the display leaves over: their threads run at a low priority of the system. A page that
// cannot be made is marked failed with its reason, and the server goes on.
//
// Threads: constructed and destroyed by one thread. Destroying stops the queues, for good, and waits for the pages that
// are being made.
#pragma once

#include "servers/read_module.h"

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace belvedere {

class PageServer {
 public:
  // threads: 1 or more. Paging and registry outlive the server.
  PageServer(Paging& paging, const ModuleRegistry& registry, DataType type, int threads);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  // Lets the threads end after the pages that they are making; does not wait.
  void Stop();
  int threads() const { return static_cast<int>(threads_.size()); }

 private:
  void Run();

  Paging& paging_;
  const ModuleRegistry& registry_;
  const DataType type_;
  std::vector<std::thread> threads_;
};

// One server a layer, with the threads that its module asks for.
class ServerSet {
 public:
  ServerSet(Paging& paging, const ModuleRegistry& registry);
  ~ServerSet();
  ServerSet(const ServerSet&) = delete;
  ServerSet& operator=(const ServerSet&) = delete;

  int threads() const;

 private:
  std::vector<std::unique_ptr<PageServer>> servers_;
};

}  // namespace belvedere
