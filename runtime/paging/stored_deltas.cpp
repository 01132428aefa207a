#include "runtime/paging/stored_deltas.h"

#include "runtime/base/status.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace belvedere {
namespace {

// 2^(-step / kDeltaStepsPerOctave), rounded up: what a stored step stands for, of the greatest.
using StepShares = std::array<float, 256>;
StepShares MakeStepShares() {
  constexpr double kRoundedUp = 1.0000002;
  StepShares shares{};
  for (size_t step = 0; step < shares.size(); ++step) {
    shares[step] = static_cast<float>(std::exp2(-static_cast<double>(step) / kDeltaStepsPerOctave) * kRoundedUp);
  }
  return shares;
}
const StepShares& ShareOfSteps() {
  static const StepShares kShares = MakeStepShares();
  return kShares;
}

}  // namespace

StoredDeltas StoreDeltas(std::span<const float> deltas_m) {
  BELVEDERE_CHECK(deltas_m.size() == kVerticesPerPage);
  const StepShares& shares = ShareOfSteps();
  constexpr int kLast = static_cast<int>(StepShares{}.size()) - 1;
  StoredDeltas stored{*std::max_element(deltas_m.begin(), deltas_m.end()), {}};
  stored.steps.reserve(deltas_m.size());
  for (const float delta_m : deltas_m) {
    const auto promises = [&](int step) { return stored.greatest_m * shares[static_cast<size_t>(step)] >= delta_m; };
    const float octaves = delta_m > 0 ? std::log2(stored.greatest_m / delta_m) : kLast;
    int step = static_cast<int>(std::clamp(octaves * kDeltaStepsPerOctave, 0.0F, static_cast<float>(kLast)));
    while (step > 0 && !promises(step)) --step;
    while (step < kLast && promises(step + 1)) ++step;
    stored.steps.push_back(static_cast<uint8_t>(step));
  }
  return stored;
}

std::vector<float> RestoreDeltas(const StoredDeltas& stored) {
  BELVEDERE_CHECK(stored.steps.size() == kVerticesPerPage);
  StepShares values_m = ShareOfSteps();
  for (float& value : values_m) value *= stored.greatest_m;
  std::vector<float> deltas_m;
  deltas_m.reserve(stored.steps.size());
  for (const uint8_t step : stored.steps) deltas_m.push_back(values_m[step]);
  return deltas_m;
}

}  // namespace belvedere
