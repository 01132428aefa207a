#include "preproc/types/page_network.h"

#include "preproc/layer_builder.h"
#include "runtime/paging/page_codec.h"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <set>

namespace belvedere {
namespace {

constexpr int kPages = 300;

// Pages whose bytes are all of one number each.
NetworkEnds Ends(std::map<uint64_t, uint8_t>& out, int& fetched) {
  return {[&fetched]() -> std::optional<StoredPage> {
            if (fetched == kPages) return std::nullopt;
            PropertyPage page;
            page.values.assign(static_cast<size_t>(kElevationSide) * kElevationSide,
                               static_cast<uint8_t>(fetched % 200));
            return StoredPage{Quadcode::FromColumnRow(6, fetched++, 100), EncodeProperty(page)};
          },
          [&out](const StoredPage& page) {
            const auto decoded = DecodeProperty(page.bytes);
            EXPECT_TRUE(decoded.ok());
            EXPECT_TRUE(out.insert({page.node.word(), (*decoded)->values[0]}).second);
            return Status();
          }};
}

DeclaredType TypeWith(const std::vector<ModuleUse>& process) {
  DeclaredType type;
  type.name = "tried";
  type.parent = "slope angle";
  type.read = type.write = "property pages";
  type.process = process;
  return type;
}

// A module that counts how many are in it at once.
struct Crowd {
  std::atomic<int> inside{0}, most{0};
  Status Enter(PageFlow& flow) {
    const int now = ++inside;
    for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
    }
    for (uint8_t& value : flow.property->values) ++value;
    --inside;
    return {};
  }
};

void AddOnce(const char* name, std::function<Status(PageFlow&)> work) {
  static_cast<void>(
      ProcessModules::Stock()
          .Add({name,
                MetaType::kSurfaceProperty,
                MetaType::kSurfaceProperty,
                {},
                {},
                [work](const ModuleSettings&, const ModuleContext&, PageFlow& flow) { return work(flow); }})
          .ok());
}

class PageNetwork : public testing::Test {
 protected:
  void SetUp() override {
    auto geoid = Geoid::LoadEgm96();
    ASSERT_TRUE(geoid.ok());
    sea_ = *geoid;
  }
  Status Run(const DeclaredType& type, const NetworkEnds& ends, int jobs = 4) {
    Status status;
    OnWorkers(jobs, [&] { status = RunNetwork(type, {*sea_}, ends); });
    return status;
  }
  std::shared_ptr<const Geoid> sea_;
};

TEST_F(PageNetwork, EveryPageGoesThroughEveryModuleOnce) {
  static Crowd crowd;
  AddOnce("add one", [](PageFlow& flow) { return crowd.Enter(flow); });
  for (const int jobs : {1, 4}) {
    std::map<uint64_t, uint8_t> out;
    int fetched = 0;
    ASSERT_TRUE(Run(TypeWith({{"add one", false, {}}, {"add one", true, {}}}), Ends(out, fetched), jobs).ok());
    ASSERT_EQ(out.size(), static_cast<size_t>(kPages));
    for (int i = 0; i < kPages; ++i) EXPECT_EQ(out.at(Quadcode::FromColumnRow(6, i, 100).word()), i % 200 + 2);
  }
}

TEST_F(PageNetwork, InSeriesThereIsOnePageAtATime) {
  static Crowd crowd;
  AddOnce("one at a time", [](PageFlow& flow) { return crowd.Enter(flow); });
  std::map<uint64_t, uint8_t> out;
  int fetched = 0;
  ASSERT_TRUE(Run(TypeWith({{"one at a time", true, {}}}), Ends(out, fetched)).ok());
  EXPECT_EQ(crowd.most.load(), 1);
}

TEST_F(PageNetwork, NoMorePagesAreUnderWayThanTheLimit) {
  static std::atomic<int> under_way{0};
  static std::atomic<int> most{0};
  std::map<uint64_t, uint8_t> out;
  int fetched = 0;
  NetworkEnds ends = Ends(out, fetched);
  const NetworkEnds counted{[&] {
                              auto page = ends.next();
                              if (page) most = std::max(most.load(), ++under_way);
                              return page;
                            },
                            [&](const StoredPage& page) {
                              --under_way;
                              return ends.put(page);
                            }};
  ASSERT_TRUE(Run(TypeWith({}), counted).ok());
  EXPECT_LE(most.load(), kMostPagesUnderWay + 2);  // one in the source's hand, one just put
}

TEST_F(PageNetwork, AFailureStopsTheFlowAndIsNamed) {
  AddOnce("fails at 40",
          [](PageFlow& flow) { return flow.property->values[0] == 40 ? Status::Error("it is forty") : Status(); });
  std::map<uint64_t, uint8_t> out;
  int fetched = 0;
  const Status status = Run(TypeWith({{"fails at 40", false, {}}}), Ends(out, fetched));
  ASSERT_FALSE(status.ok());
  for (const char* part : {"\"tried\"", "fails at 40", "it is forty", "quadnode"})
    EXPECT_NE(status.message().find(part), std::string::npos) << status.message();
  EXPECT_LT(fetched, kPages);
}

TEST_F(PageNetwork, PagesOfOtherChannelsThanTheTypesAreAFailure) {
  DeclaredType type = TypeWith({});
  type.property.channels = 3;
  std::map<uint64_t, uint8_t> out;
  int fetched = 0;
  EXPECT_NE(Run(type, Ends(out, fetched)).message().find("1 channels where the type has 3"), std::string::npos);
  EXPECT_TRUE(out.empty());
}

TEST_F(PageNetwork, ADamagedPageIsAFailure) {
  std::map<uint64_t, uint8_t> out;
  int fetched = 0;
  NetworkEnds ends = Ends(out, fetched);
  const NetworkEnds damaged{[&] {
                              auto page = ends.next();
                              if (page && fetched == 50) page->bytes.back() ^= 1;
                              return page;
                            },
                            ends.put};
  EXPECT_NE(Run(TypeWith({}), damaged).message().find("checksum"), std::string::npos);
}

}  // namespace
}  // namespace belvedere
