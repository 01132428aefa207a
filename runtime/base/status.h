// Status and Result: how Belvedere says that bytes, files, sockets or settings were bad.
//
// A Status is either ok or carries one line for a person: what went wrong, where, and what to do. A broken contract is
// not a Status: BELVEDERE_CHECK stops the program. No exception crosses a thread; code that calls a throwing library
// catches at its own boundary and returns a Status.
//
// Threads: values; each thread has its own.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

namespace belvedere {

class [[nodiscard]] Status {
 public:
  Status() = default;  // ok

  // Error("{}: cannot open: {}", path, reason)
  template <typename... Args>
  static Status Error(fmt::format_string<Args...> format, Args&&... args) {
    Status status;
    status.message_ = fmt::format(format, std::forward<Args>(args)...);
    return status;
  }

  bool ok() const { return !message_.has_value(); }
  // The line for a person; empty when ok.
  const std::string& message() const {
    static const std::string kEmpty;
    return message_ ? *message_ : kEmpty;
  }

 private:
  std::optional<std::string> message_;
};

// A value, or the Status that says why there is none.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}          // NOLINT(google-explicit-constructor): reads as a return
  Result(Status status) : status_(std::move(status)) {}  // NOLINT(google-explicit-constructor): REQUIRES: !status.ok()

  bool ok() const { return value_.has_value(); }
  const Status& status() const { return status_; }
  const std::string& message() const { return status_.message(); }

  // REQUIRES: ok()
  T& operator*() { return *value_; }
  const T& operator*() const { return *value_; }
  T* operator->() { return &*value_; }
  const T* operator->() const { return &*value_; }

 private:
  std::optional<T> value_;
  Status status_;
};

[[noreturn]] inline void CheckFailed(const char* file, int line, const char* condition) {
  std::fprintf(stderr, "%s:%d: contract broken: %s\n", file, line, condition);
  std::abort();
}

}  // namespace belvedere

#define BELVEDERE_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::belvedere::CheckFailed(__FILE__, __LINE__, #condition))
