#include "servers/server_thread.h"

#include "runtime/base/trace.h"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

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

void NameThread(const std::string& name) {
  constexpr size_t kLongestName = 15;
  pthread_setname_np(pthread_self(), ("srv " + name).substr(0, kLongestName).c_str());
  Trace::NameThread("page server");
}

}  // namespace

void BecomeServerThread(const std::string& name) {
  YieldToTheDisplay();
  NameThread(name);
}

}  // namespace belvedere
