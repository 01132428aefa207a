#include "dis/receiver.h"

#include "dis/udp_sender.h"
#include "tests/dis/fixtures.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>

namespace belvedere::dis {
namespace {

TEST(Endpoint, IsParsedAndWritten) {
  EXPECT_EQ(ParseEndpoint("127.0.0.1:3000")->ToString(), "127.0.0.1:3000");
  EXPECT_EQ(ParseEndpoint("[::1]:3000")->ToString(), "[::1]:3000");
  EXPECT_EQ(ParseEndpoint("[ff02::1%lo]:3000")->address, "ff02::1%lo");
  EXPECT_EQ(ParseEndpoint("localhost:80")->address, "127.0.0.1");
  EXPECT_EQ(ParseEndpoint(":3000")->address, "0.0.0.0");
  for (const char* bad : {"", "127.0.0.1", "127.0.0.1:", "127.0.0.1:0", "127.0.0.1:65536", "127.0.0.1:3000x",
                          "::1:3000", "[::1:3000", "example.org:3000", "[]:3000", "300.0.0.1:3000"}) {
    EXPECT_FALSE(ParseEndpoint(bad).ok()) << bad;
  }
}

// Starts on the first free port from a fixed one on, so that runs beside each other do not meet.
std::unique_ptr<Receiver> StartOnFreePort(const std::string& address, ObjectTable& table, Endpoint& at) {
  for (uint16_t port = 43000; port < 43100; ++port) {
    at = {address, port};
    auto receiver = Receiver::Start({.network = {.listen = at}}, table, Clock::System());
    if (receiver.ok()) return std::move(*receiver);
  }
  return nullptr;
}

void SendAndExpect(const Endpoint& to, const Receiver& receiver, ObjectTable& table) {
  auto sender = UdpSender::Open(to);
  ASSERT_TRUE(sender.ok()) << sender.message();
  constexpr uint16_t kEntities = 100;
  std::vector<uint8_t> all;
  for (uint16_t entity = 1; entity <= kEntities; ++entity) {
    const std::vector<uint8_t> one = Encoded(SomeEntity(entity));
    all.insert(all.end(), one.begin(), one.end());
  }
  ASSERT_TRUE((*sender)->SendMany(all, kEntityStateBytes).ok());
  ASSERT_TRUE((*sender)->Send(std::vector<uint8_t>(5)).ok());
  while (receiver.Counters().intake.datagrams < kEntities + 1) std::this_thread::yield();
  while (table.Snapshot()->objects.size() < kEntities) std::this_thread::yield();
  EXPECT_EQ(receiver.Counters().intake.accepted, kEntities);
  EXPECT_EQ(receiver.Counters().intake.rejected_total(), 1u);
  EXPECT_EQ(receiver.Counters().lost_by_kernel, 0u);
}

TEST(Receiver, TakesUnicastOverIpv4) {
  ObjectTable table;
  Endpoint at;
  const auto receiver = StartOnFreePort("127.0.0.1", table, at);
  ASSERT_NE(receiver, nullptr);
  SendAndExpect(at, *receiver, table);
  receiver->Stop();
  receiver->Stop();
}

TEST(Receiver, TakesUnicastOverIpv6) {
  ObjectTable table;
  Endpoint at;
  const auto receiver = StartOnFreePort("::1", table, at);
  if (!receiver) GTEST_SKIP() << "no IPv6 on this machine";
  SendAndExpect(at, *receiver, table);
}

TEST(Receiver, TakesIpv4OnTheAnyAddressOfIpv6) {
  ObjectTable table;
  Endpoint at;
  const auto receiver = StartOnFreePort("::", table, at);
  if (!receiver) GTEST_SKIP() << "no IPv6 on this machine";
  SendAndExpect({"127.0.0.1", at.port}, *receiver, table);
}

TEST(Receiver, TakesMulticast) {
  ObjectTable table;
  const ListenOptions network{.listen = {"239.255.43.21", 43210}, .interface_address = "127.0.0.1"};
  auto receiver = Receiver::Start({.network = network}, table, Clock::System());
  ASSERT_TRUE(receiver.ok()) << receiver.message();
  auto second = Receiver::Start({.network = network}, table, Clock::System());  // a group may be shared
  ASSERT_TRUE(second.ok()) << second.message();
  auto sender = UdpSender::Open(network.listen, "127.0.0.1");
  ASSERT_TRUE(sender.ok()) << sender.message();
  if (!(*sender)->Send(Encoded(SomeEntity())).ok()) GTEST_SKIP() << "no multicast on loopback here";
  while ((*receiver)->Counters().intake.accepted < 1) std::this_thread::yield();
  while ((*second)->Counters().intake.accepted < 1) std::this_thread::yield();
}

TEST(Receiver, APortInUseAndABadAddressAreOneLine) {
  ObjectTable table;
  Endpoint at;
  const auto receiver = StartOnFreePort("127.0.0.1", table, at);
  ASSERT_NE(receiver, nullptr);
  const auto again = Receiver::Start({.network = {.listen = at}}, table, Clock::System());
  ASSERT_FALSE(again.ok());
  EXPECT_NE(again.message().find("in use"), std::string::npos) << again.message();
  EXPECT_NE(again.message().find(at.ToString()), std::string::npos);
  const auto elsewhere = Receiver::Start({.network = {.listen = {"203.0.113.77", 43000}}}, table, Clock::System());
  ASSERT_FALSE(elsewhere.ok());
  EXPECT_EQ(elsewhere.message().find('\n'), std::string::npos);
}

}  // namespace
}  // namespace belvedere::dis
