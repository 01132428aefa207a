// Layer steps: a layer whose pages change with the simulation time has one layer of pages for each of several times,
// its steps. A step holds from its time until that of the next.
//
// Where a layer repeats every year only month, day and time of day count: the twelve pictures of 2004 serve every year,
// and before the first of a year the last of the year before holds. Days are those of UTC.
//
// Units: seconds since 1970-01-01 UTC. Threads: values and pure functions.
#pragma once

#include "runtime/paging/page.h"

#include <cstdint>
#include <span>
#include <string>

namespace belvedere {

enum class Repeats : uint8_t { kNever, kEveryYear };

// Of which layer a layer is a step, and from when on.
struct StepOf {
  std::string layer;
  double utc_s = 0;
  Repeats repeats = Repeats::kNever;
};

// One step of a layer, as the layer table has it.
struct LayerStep {
  double utc_s = 0;
  DataType type = 0;
};

// Seconds since the year began, in a year that has a 29th of February: the same for the same date of every year.
double SecondsIntoYear(double utc_s);
int YearOf(double utc_s);

// Whether a step's time comes before another's, in the year where the layer repeats.
bool IsEarlier(double utc_s, double other_utc_s, Repeats repeats);

// Number of the step that holds at a time: the last one at or before it. Before all of them it is the first, or, where
// they repeat, the last. REQUIRES: at least one step; ascending as IsEarlier has it.
size_t StepAt(std::span<const LayerStep> steps, Repeats repeats, double utc_s);

}  // namespace belvedere
