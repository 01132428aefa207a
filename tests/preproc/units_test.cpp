#include "preproc/units.h"

#include "preproc/shards.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <string>

namespace belvedere {
namespace {

// The whole Earth to level 3, and a place to level 11.
const std::vector<PlannedSource> kPlan = {{{-180, -90, 180, 90}, 3, 0.05, false},
                                          {{10, 45, 11, 46}, 11, 0.0002, false}};

TEST(Units, AreSubtreesThatDoNotOverlapAndAreNotTooLarge) {
  const std::vector<Unit> units = UnitsOf(2, kPlan);
  int64_t pages = 0;
  for (const Unit& unit : units) {
    EXPECT_EQ(unit.layer, 2);
    EXPECT_LE(unit.pages, kMostPagesOfUnit);
    EXPECT_EQ(unit.pages, CountNodesUnder(kPlan, unit.node));
    pages += unit.pages;
    for (const Unit& other : units) EXPECT_TRUE(&other == &unit || !unit.node.Contains(other.node));
    if (unit.node.is_root()) continue;
    EXPECT_GT(CountNodesUnder(kPlan, unit.node.Parent()), kMostPagesOfUnit) << "a larger one would do";
  }
  EXPECT_LT(pages, CountNodes(kPlan));
  EXPECT_GT(pages, CountNodes(kPlan) * 9 / 10) << "little lies above them";
}

TEST(Units, EveryOneFallsToOneShardAndNoneHasMuchMoreToDo) {
  const std::vector<Unit> units = UnitsOf(0, kPlan);
  for (const int shards : {1, 2, 3, 7}) {
    const std::vector<int> shard_of = ShardsOf(units, shards);
    ASSERT_EQ(shard_of.size(), units.size());
    std::map<int, int64_t> load;
    for (size_t i = 0; i < units.size(); ++i) load[shard_of[i]] += units[i].pages;
    EXPECT_EQ(load.size(), static_cast<size_t>(shards));
    for (const auto& [shard, pages] : load) EXPECT_LE(pages - load.begin()->second, kMostPagesOfUnit) << shard;
    EXPECT_EQ(ShardsOf(units, shards), shard_of);
  }
}

TEST(Units, ShardsAreWrittenAsTheirNumberAndHowMany) {
  EXPECT_EQ(ParseShard("2/8")->number, 2);
  EXPECT_EQ(ParseShard("2/8")->of, 8);
  for (const char* wrong : {"", "2", "0/2", "3/2", "1/", "/2", "1/2/3", "a/b", "-1/2", "1 /2"})
    EXPECT_FALSE(ParseShard(wrong)) << wrong;
}

std::map<std::string, std::string> environment;
const char* Value(const char* name) {
  const auto found = environment.find(name);
  return found == environment.end() ? nullptr : found->second.c_str();
}

TEST(Units, RanksAreToldByWhoStartsThem) {
  environment.clear();
  EXPECT_FALSE(ShardOfRank(Value));
  for (const auto& [rank, size] : {std::pair{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                   {"PMI_RANK", "PMI_SIZE"},
                                   {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS"}}) {
    environment = {{rank, "1"}, {size, "4"}};
    ASSERT_TRUE(ShardOfRank(Value)) << rank;
    EXPECT_EQ(ShardOfRank(Value)->number, 2);
    EXPECT_EQ(ShardOfRank(Value)->of, 4);
    environment[size] = "1";
    EXPECT_FALSE(ShardOfRank(Value)) << "alone";
    environment = {{rank, "x"}, {size, "4"}};
    EXPECT_FALSE(ShardOfRank(Value));
  }
}

TEST(Units, NotesComeBack) {
  const BuildNotes notes{{{"a\n{\"path\":1}", "it is cut"}}, {"b", "c"}};
  const BuildNotes back = NotesFromJson(NotesToJson(notes));
  EXPECT_EQ(back.skipped, notes.skipped);
  EXPECT_EQ(back.seen, notes.seen);
  EXPECT_TRUE(NotesFromJson("").skipped.empty());
}

}  // namespace
}  // namespace belvedere
