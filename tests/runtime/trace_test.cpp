#include "runtime/base/trace.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace belvedere {
namespace {

constexpr size_t kCapacity = 64;  // the first Start decides it for the whole program

nlohmann::json Written() {
  const std::string path = testing::TempDir() + "belvedere_trace.json";
  EXPECT_TRUE(Trace::Write(path).ok());
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
  std::ifstream file(path);
  return nlohmann::json::parse(file).at("traceEvents");
}

std::vector<nlohmann::json> OfPhase(const nlohmann::json& events, const std::string& phase) {
  std::vector<nlohmann::json> found;
  for (const nlohmann::json& event : events) {
    if (event.at("ph") == phase) found.push_back(event);
  }
  return found;
}

TEST(Trace, RecordsNothingWhenOff) {
  Trace::Start(kCapacity);
  Trace::Stop();
  { const TraceSpan span("test.off"); }
  TraceCounter("test.off", 1);
  EXPECT_TRUE(OfPhase(Written(), "X").empty());
  EXPECT_TRUE(OfPhase(Written(), "C").empty());
}

TEST(Trace, WritesSpansCountersAndThreadNames) {
  Trace::Start(kCapacity);
  Trace::NameThread("tester");
  {
    const TraceSpan outer("test.outer");
    const TraceSpan inner("test.\"inner\"");
  }
  TraceCounter("test.waiting", 2.5);
  Trace::Stop();
  const nlohmann::json events = Written();
  const std::vector<nlohmann::json> spans = OfPhase(events, "X");
  ASSERT_EQ(spans.size(), 2u);
  EXPECT_EQ(spans[0].at("name"), "test.\"inner\"");  // the inner one ends first
  EXPECT_EQ(spans[1].at("name"), "test.outer");
  EXPECT_LE(spans[1].at("ts"), spans[0].at("ts"));
  EXPECT_GE(spans[1].at("dur"), spans[0].at("dur"));
  const std::vector<nlohmann::json> counters = OfPhase(events, "C");
  ASSERT_EQ(counters.size(), 1u);
  EXPECT_EQ(counters[0].at("args").at("value"), 2.5);
  const std::vector<nlohmann::json> names = OfPhase(events, "M");
  ASSERT_EQ(names.size(), 1u);
  EXPECT_EQ(names[0].at("args").at("name"), "tester");
  EXPECT_EQ(names[0].at("tid"), spans[0].at("tid"));
}

TEST(Trace, KeepsTheNewestOnceFull) {
  Trace::Start(kCapacity);
  for (int i = 0; i < 1000; ++i) TraceCounter("test.count", i);
  Trace::Stop();
  const std::vector<nlohmann::json> counters = OfPhase(Written(), "C");
  ASSERT_EQ(counters.size(), kCapacity);
  EXPECT_EQ(counters.front().at("args").at("value"), 1000 - static_cast<int>(kCapacity));
  EXPECT_EQ(counters.back().at("args").at("value"), 999);
}

TEST(Trace, ManyThreadsRecordWhileItIsWritten) {
  Trace::Start(kCapacity);
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 3; ++thread) {
    threads.emplace_back([] {
      for (int i = 0; i < 3000; ++i) const TraceSpan span("test.busy");
    });
  }
  for (int i = 0; i < 5; ++i) {
    for (const nlohmann::json& event : OfPhase(Written(), "X")) EXPECT_EQ(event.at("name"), "test.busy");
  }
  for (std::thread& thread : threads) thread.join();
  Trace::Stop();
  EXPECT_EQ(OfPhase(Written(), "X").size(), kCapacity);
}

TEST(Trace, SaysWhereItCannotWrite) {
  const Status status = Trace::Write("/no/such/folder/trace.json");
  EXPECT_NE(status.message().find("/no/such/folder/trace.json"), std::string::npos);
}

}  // namespace
}  // namespace belvedere
