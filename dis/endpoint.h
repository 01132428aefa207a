// Endpoint: the ADDR:PORT that a user writes.
//
//   192.0.2.7:3000   [2001:db8::7]:3000   [ff02::1%eth0]:3000   localhost:3000   :3000 (any address)
//
// No name but localhost is looked up.
#pragma once

#include "runtime/base/status.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace belvedere::dis {

struct Endpoint {
  std::string address;  // numeric, with a scope after % where one was given
  uint16_t port = 0;
  std::string ToString() const;
};

Result<Endpoint> ParseEndpoint(std::string_view text);

}  // namespace belvedere::dis
