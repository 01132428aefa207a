// Builds in processes of their own, which may be killed. REQUIRES: forked before this one has a thread.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <thread>

namespace belvedere::testing_rasters {

// Runs it in a child and returns the child's wait status.
inline int InChild(const std::function<int()>& body) {
  const pid_t child = fork();
  if (child == 0) _exit(body());
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return status;
}

inline bool Succeeds(const std::function<bool()>& body) {
  const int status = InChild([&] { return body() ? 0 : 1; });
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

// Runs it in a child that is killed as soon as `now` holds. Whether it was, before it was done.
inline bool IsKilledWhen(const std::function<bool()>& now, const std::function<void()>& body) {
  const int status = InChild([&] {
    std::thread work([&] {
      body();
      _exit(0);
    });
    while (!now()) std::this_thread::yield();
    std::raise(SIGKILL);
    work.join();
    return 0;
  });
  return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
}

}  // namespace belvedere::testing_rasters
