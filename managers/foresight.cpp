#include "managers/foresight.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace belvedere {
namespace {

constexpr float kShare = 0.01F;         // of the priority that a page will have
constexpr double kShareOfHeight = 0.5;  // that a path which goes down is foreseen

// The pages of a list that will never be drawn.
class ForeseenPages final : public PageAccess {
 public:
  explicit ForeseenPages(ListPages& pages) : pages_(pages) {}

  const TerrainPage* Terrain(Quadcode node) override { return pages_.Terrain(node); }
  std::optional<int> Slot(const PageKey& key) override {
    return pages_.IsInMemory(key) ? std::optional<int>(0) : std::nullopt;
  }
  bool Want(const PageKey& key, float priority) override { return pages_.WantSoon(key, kShare * priority); }

 private:
  ListPages& pages_;
};

}  // namespace

double SecondsForeseen(const ViewParameters& view, double now_s, double height_m) {
  if (view.eye_velocity_mps == glm::dvec3(0)) return 0;
  const double down_mps = -glm::dot(view.eye_velocity_mps, glm::normalize(view.EyeAt(now_s)));
  if (down_mps <= 0) return kAhead_s;
  return std::min(kAhead_s, kShareOfHeight * height_m / down_mps);
}

void Foresee(const ViewParameters& view, double now_s, double height_m, const LayerTable& layers, DataType terrain,
             const CutLimits& limits, ListPages& pages) {
  const double ahead_s = SecondsForeseen(view, now_s, height_m);
  if (ahead_s <= 0) return;
  const ViewMatrices matrices = MatricesOf(view, now_s + ahead_s, height_m);
  ForeseenPages foreseen(pages);
  static_cast<void>(SelectCut(view, matrices, layers, terrain, limits, foreseen));
}

}  // namespace belvedere
