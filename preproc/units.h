// Units of work: the subtrees that a build is divided into, so that others may make them elsewhere.
//
// A unit is a quadnode of a layer and all that is under it. Units are the largest subtrees of at most kMostPagesOfUnit
// planned pages; they depend on the plan alone, not on who makes them, and each is made of the sources alone: making
// one twice gives the same bytes. What lies above the units is made once all are there.
//
// Threads: pure functions.
#pragma once

#include "preproc/plan.h"
#include "runtime/earth/quadcode.h"

#include <cstdint>
#include <span>
#include <vector>

namespace belvedere {

inline constexpr int64_t kMostPagesOfUnit = 512;

struct Unit {
  int layer = 0;
  Quadcode node;
  int64_t pages = 0;  // planned
};

// Of a layer, in the order of its quadcodes within each quadtree.
std::vector<Unit> UnitsOf(int layer, std::span<const PlannedSource> plan);

// Which of so many shards, from 0 on, makes each unit: the largest first, each to the shard that has the least to do.
std::vector<int> ShardsOf(std::span<const Unit> units, int shards);

}  // namespace belvedere
