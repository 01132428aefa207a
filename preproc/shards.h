// Shards: the parts of a dataset that several processes make, on one machine or many that share a file system.
//
// Shard k of n is a store in OUT.shards that holds the units (units.h) that fall to it, as a build that was interrupted
// leaves them, so that a shard that is killed goes on where it stopped. When it is whole a mark is put beside it: a
// line of what it was made of, how many pages it has, and a checksum of them all. Whoever merges takes the pages of all
// shards over, checks them against the marks, and makes what lies above.
//
// Threads: one at a time.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/dataset_writer.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

struct Shard {
  int number = 1, of = 1;  // 1 to `of`
};
// "2/8"; nothing where it is none.
std::optional<Shard> ParseShard(std::string_view text);
std::string ShardPath(const std::string& out, const Shard& shard);

// What mpirun or srun has told this process: its rank and their number, as a shard. Nothing where it runs alone. name:
// of an environment variable; gives its value or null.
std::optional<Shard> ShardOfRank(const char* (*value_of)(const char* name));

// What a build knows of its sources that another would have to find out again: which it left out and why, and of which
// something is seen.
struct BuildNotes {
  std::map<std::string, std::string> skipped;
  std::set<std::string> seen;
};
std::string NotesToJson(const BuildNotes& notes);
BuildNotes NotesFromJson(const std::string& text);  // throws where the text is damaged

// Marks a shard as whole, once all its pages are committed.
Status MarkWhole(const std::string& out, const Shard& shard, const std::string& made_of, DatasetWriter& store);
// Before it is worked on again.
void RemoveMark(const std::string& out, const Shard& shard);
// How many pages a shard has that is whole and made of this; nothing where it is not.
std::optional<int64_t> PagesOfWhole(const std::string& out, const Shard& shard, const std::string& made_of);

struct Merged {
  BuildNotes notes;
  std::vector<int> left_out;  // shards made with sources that others found to be bad: their pages are made anew
};
// Puts the pages of all shards into the writer, one after the other, and commits them. Fails where one is missing,
// unfinished, made of something else, or damaged, and says how to make it.
Result<Merged> MergeShards(const std::string& out, int shards, const std::string& made_of, int64_t batch_bytes,
                           DatasetWriter& into);
void RemoveShards(const std::string& out);

}  // namespace belvedere
