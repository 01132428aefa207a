#include "managers/held_bound.h"

#include <algorithm>

namespace belvedere {
namespace {

// Within these shares of the target nothing is changed: a bound that swings is worse than a frame that is a little
// late.
constexpr double kTooLong = 1.0;
constexpr double kToSpare = 0.8;
constexpr double kLargestStep = 1.25;
constexpr double kStepBack = 1.04;

}  // namespace

double HeldBound::Next(const ViewParameters& view, const FrameReport& report, uint64_t next_list) {
  if (view.target_frame_ms <= 0) {
    loosened_ = 1;
    return view.error_px;
  }
  const double most = std::max(1.0, view.most_error_px / view.error_px);
  const bool is_new = report.frame != judged_frame_ && report.terrain_list >= changed_in_list_;
  if (is_new && report.busy_ms > 0) {
    judged_frame_ = report.frame;
    const double share = report.busy_ms / view.target_frame_ms;
    double loosened = loosened_;
    if (share > kTooLong) loosened *= std::min(share, kLargestStep);
    if (share < kToSpare) loosened /= kStepBack;
    loosened = std::clamp(loosened, 1.0, most);
    if (loosened != loosened_) changed_in_list_ = next_list;
    loosened_ = loosened;
  }
  loosened_ = std::min(loosened_, most);
  return view.error_px * loosened_;
}

}  // namespace belvedere
