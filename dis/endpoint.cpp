#include "dis/endpoint.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <charconv>

namespace belvedere::dis {
namespace {

bool IsNumeric(const std::string& address) {
  in_addr v4;
  in6_addr v6;
  const std::string without_scope = address.substr(0, address.find('%'));
  return inet_pton(AF_INET, address.c_str(), &v4) == 1 || inet_pton(AF_INET6, without_scope.c_str(), &v6) == 1;
}

}  // namespace

std::string Endpoint::ToString() const {
  const bool v6 = address.find(':') != std::string::npos;
  return v6 ? fmt::format("[{}]:{}", address, port) : fmt::format("{}:{}", address, port);
}

Result<Endpoint> ParseEndpoint(std::string_view text) {
  constexpr std::string_view kWanted = "write ADDR:PORT, as 127.0.0.1:3000 or [::1]:3000";
  const size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return Status::Error("address '{}' has no port; {}", text, kWanted);
  std::string_view address = text.substr(0, colon);
  const std::string_view port = text.substr(colon + 1);
  Endpoint endpoint;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), endpoint.port);
  if (error != std::errc() || end != port.data() + port.size() || endpoint.port == 0) {
    return Status::Error("address '{}': '{}' is not a port from 1 to 65535; {}", text, port, kWanted);
  }
  const bool bracketed = address.size() > 2 && address.front() == '[' && address.back() == ']';
  if (bracketed) {
    address = address.substr(1, address.size() - 2);
  } else if (address.find(':') != std::string_view::npos) {
    return Status::Error("address '{}': put an IPv6 address in brackets, as [::1]:3000", text);
  }
  endpoint.address = address.empty() ? "0.0.0.0" : address == "localhost" ? "127.0.0.1" : std::string(address);
  if (!IsNumeric(endpoint.address)) {
    return Status::Error("address '{}': '{}' is not a numeric address; {}", text, address, kWanted);
  }
  return endpoint;
}

}  // namespace belvedere::dis
