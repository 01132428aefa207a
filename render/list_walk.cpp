#include "render/list_walk.h"

#include "runtime/base/status.h"

namespace belvedere {

void VisibleDraws::Clear() {
  terrain.clear();
  instances.clear();
  triangles = 0;
}

void WalkList(const DisplayList& list, const ViewMatrices& matrices, VisibleDraws& visible) {
  visible.Clear();
  int depth = 0;
  int enclosed_depth = 0;  // cull depth of the outermost volume that the frustum encloses, 0 none
  for (size_t i = 0; i < list.records.size();) {
    const ListRecord& record = list.records[i];
    switch (record.kind) {
      case ListRecord::Kind::kCullBegin: {
        const BoundingSphere& volume = list.volumes[record.index];
        if ((enclosed_depth == 0 && matrices.frustum.Hides(volume)) || matrices.horizon.Hides(volume)) {
          BELVEDERE_CHECK(record.skip > i);
          i = record.skip;
          continue;
        }
        ++depth;
        if (enclosed_depth == 0 && matrices.frustum.Encloses(volume)) enclosed_depth = depth;
        break;
      }
      case ListRecord::Kind::kCullEnd:
        if (enclosed_depth == depth) enclosed_depth = 0;
        --depth;
        break;
      case ListRecord::Kind::kDrawTerrain:
        visible.terrain.push_back(record.index);
        visible.triangles += list.terrain_draws[record.index].index_count / 3;
        break;
      case ListRecord::Kind::kDrawInstances: visible.instances.push_back({record.index, record.count}); break;
    }
    ++i;
  }
}

}  // namespace belvedere
