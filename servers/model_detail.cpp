#include "servers/model_detail.h"

#include "runtime/base/status.h"

#include <meshoptimizer.h>

#include <algorithm>

namespace belvedere {
namespace {

constexpr size_t kFewestIndices = 3 * 12;  // a level is not made coarser than a box
constexpr float kAnyError = 1.0F;          // relative to the model's size: triangles decide

void ShareVertices(ModelPage& page) {
  std::vector<unsigned> remap(page.vertices.size());
  const size_t count = meshopt_generateVertexRemap(remap.data(), page.indices.data(), page.indices.size(),
                                                   page.vertices.data(), page.vertices.size(), sizeof(ModelVertex));
  std::vector<ModelVertex> shared(count);
  meshopt_remapVertexBuffer(shared.data(), page.vertices.data(), page.vertices.size(), sizeof(ModelVertex),
                            remap.data());
  meshopt_remapIndexBuffer(page.indices.data(), page.indices.data(), page.indices.size(), remap.data());
  page.vertices = std::move(shared);
}

struct Coarser {
  std::vector<uint32_t> indices;
  float error_m = 0;
};

// A mesh of about target_count indices. Hard edges, at which vertices are not shared, hold the careful way back; then
// vertices are merged by where they lie.
Coarser Simplify(const ModelPage& page, const std::vector<uint32_t>& finest, size_t target_count) {
  const float* positions = &page.vertices.front().x;
  const float scale_m = meshopt_simplifyScale(positions, page.vertices.size(), sizeof(ModelVertex));
  Coarser coarser;
  coarser.indices.resize(finest.size());
  float error = 0;
  size_t count = meshopt_simplify(coarser.indices.data(), finest.data(), finest.size(), positions, page.vertices.size(),
                                  sizeof(ModelVertex), target_count, kAnyError, 0, &error);
  if (2 * count > 3 * target_count) {
    count = meshopt_simplifySloppy(coarser.indices.data(), finest.data(), finest.size(), positions,
                                   page.vertices.size(), sizeof(ModelVertex), target_count, kAnyError, &error);
  }
  coarser.indices.resize(count);
  coarser.error_m = error * scale_m;
  return coarser;
}

}  // namespace

void AddDetails(ModelPage& page) {
  BELVEDERE_CHECK(!page.vertices.empty() && !page.indices.empty() && page.details.empty());
  ShareVertices(page);
  meshopt_optimizeVertexCache(page.indices.data(), page.indices.data(), page.indices.size(), page.vertices.size());
  const std::vector<uint32_t> finest = page.indices;
  page.details.push_back({0, static_cast<uint32_t>(finest.size()), 0});
  for (const size_t divisor : {size_t{4}, size_t{16}}) {
    const size_t target_count = std::max(finest.size() / divisor / 3 * 3, kFewestIndices);
    const ModelPage::Detail before = page.details.back();
    if (target_count >= before.index_count) break;
    const Coarser coarser = Simplify(page, finest, target_count);
    if (coarser.indices.empty() || 4 * coarser.indices.size() > 3 * size_t{before.index_count}) continue;
    const auto first = static_cast<uint32_t>(page.indices.size());
    page.indices.insert(page.indices.end(), coarser.indices.begin(), coarser.indices.end());
    page.details.push_back(
        {first, static_cast<uint32_t>(coarser.indices.size()), std::max(coarser.error_m, before.error_m)});
  }
}

}  // namespace belvedere
