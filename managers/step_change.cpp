#include "managers/step_change.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace belvedere {

std::vector<LayerUse> StepChange::Next(std::span<const LayerUse> layers, const LayerTable& table, double utc_s,
                                       double now_s, bool jump) {
  std::vector<LayerUse> uses(layers.begin(), layers.end());
  const size_t known = whole_.size();
  for (std::vector<DataType>* types : {&whole_, &now_, &before_}) types->resize(uses.size());
  progress_.resize(uses.size());
  for (size_t i = 0; i < uses.size(); ++i) {
    const DataType due = table.TypeAt(uses[i].type, utc_s);
    if (i >= known || whole_[i] != uses[i].type || jump || !uses[i].shown()) {
      now_[i] = before_[i] = due;
    } else if (before_[i] == now_[i] && now_[i] != due) {
      now_[i] = due;
      progress_[i] = {std::numeric_limits<int>::max(), now_s};
    }
    whole_[i] = uses[i].type;
    uses[i].type = now_[i];
  }
  return uses;
}

void StepChange::Shown(const std::array<int, kMaxImageLayers>& of_step_before, double now_s) {
  images_before_ = std::accumulate(of_step_before.begin(), of_step_before.end(), 0);
  for (size_t i = 0; i < std::min(before_.size(), of_step_before.size()); ++i) {
    if (before_[i] == now_[i]) continue;
    if (of_step_before[i] < progress_[i].fewest) progress_[i] = {of_step_before[i], now_s};
    if (of_step_before[i] == 0 || now_s - progress_[i].since_s > kPatience_s) before_[i] = now_[i];
  }
}

bool StepChange::changing() const {
  return before_ != now_;
}

bool StepChange::IsDue(std::span<const LayerUse> layers, const LayerTable& table, double utc_s) const {
  if (layers.size() != now_.size()) return true;
  for (size_t i = 0; i < layers.size(); ++i) {
    if (table.TypeAt(layers[i].type, utc_s) != now_[i]) return true;
  }
  return false;
}

}  // namespace belvedere
