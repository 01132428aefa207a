#include "preproc/types/derived_layers.h"

#include "preproc/layer_builder.h"
#include "preproc/types/page_network.h"

#include <ranges>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

// The parent's pages, depth first.
class ParentPages {
 public:
  explicit ParentPages(const DerivedWork& work) : work_(work) {
    for (int tree = kTrees - 1; tree >= 0; --tree) to_come_.push_back(Quadcode::Root(tree));
  }

  std::optional<StoredPage> Next() {
    while (!to_come_.empty()) {
      const Quadcode node = to_come_.back();
      to_come_.pop_back();
      auto bytes = work_.parent_page(node);
      if (!bytes) continue;
      if (node.level() < kMaxLevel) {
        for (const int which : std::views::reverse(node.Children())) to_come_.push_back(node.Child(which));
      }
      if (!work_.is_known(node)) return StoredPage{node, std::move(*bytes)};
    }
    return std::nullopt;
  }

 private:
  const DerivedWork& work_;
  std::vector<Quadcode> to_come_;
};

}  // namespace

Status MakeDerivedLayer(const LayerSpec& layer, const LayerSpec& parent, const DerivedWork& work, const Geoid& sea,
                        DatasetWriter& writer) {
  ParentPages pages(work);
  int64_t uncommitted_bytes = 0;
  const NetworkEnds ends{[&pages] { return pages.Next(); },
                         [&](const StoredPage& page) {
                           Status status = writer.Put(work.layer, page.node, page.bytes);
                           uncommitted_bytes += static_cast<int64_t>(page.bytes.size());
                           if (!status.ok() || uncommitted_bytes < work.batch_bytes) return status;
                           uncommitted_bytes = 0;
                           return writer.Commit();
                         }};
  const ModuleContext context{sea, parent.derived ? parent.derived->type.property : PropertyRecord()};
  Status status;
  OnWorkers(work.jobs, [&] { status = RunNetwork(layer.derived->type, context, ends); });
  return status.ok() ? writer.Commit() : status;
}

}  // namespace belvedere
