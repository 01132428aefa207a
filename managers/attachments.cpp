#include "managers/attachments.h"

#include <algorithm>

namespace belvedere {

std::optional<glm::vec3> PlaceOfStation(const ModelPage& model, uint16_t station) {
  constexpr uint16_t kLastOwn = 511;
  const auto found = std::find_if(model.stations.begin(), model.stations.end(),
                                  [&](const ModelStation& one) { return one.number == station; });
  if (found != model.stations.end()) return found->place;
  const bool counted = station >= 1 && station <= kLastOwn && station <= model.stations.size();
  if (!counted) return std::nullopt;
  return model.stations[station - size_t{1}].place;
}

}  // namespace belvedere
