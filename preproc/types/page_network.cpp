#include "preproc/types/page_network.h"

#include "runtime/base/mutex.h"
#include "runtime/paging/page_codec.h"
#include "runtime/paging/vector_codec.h"

#include <tbb/flow_graph.h>

#include <atomic>
#include <memory>
#include <utility>

namespace belvedere {
namespace {

namespace flow = tbb::flow;

// What runs along the edges; empty once something has failed, so that the rest flows off.
struct Parcel {
  PageFlow page;
  StoredPage stored;
};
using Load = std::shared_ptr<Parcel>;

Status Decode(MetaType meta, Parcel& parcel) {
  const auto take = [](auto decoded, auto& page) {
    if (!decoded.ok()) return decoded.status();
    page = std::move(*decoded);
    return Status();
  };
  if (meta == MetaType::kHeightField) return take(DecodeElevation(parcel.stored.bytes), parcel.page.heights);
  if (meta == MetaType::kImage) return take(DecodeImage(parcel.stored.bytes), parcel.page.image);
  if (meta == MetaType::kVector) return take(DecodeVector(parcel.stored.bytes), parcel.page.features);
  if (meta == MetaType::kModel) return take(DecodeBuildings(parcel.stored.bytes), parcel.page.buildings);
  return take(DecodeProperty(parcel.stored.bytes), parcel.page.property);
}

std::vector<uint8_t> Encode(MetaType meta, const PageFlow& page) {
  if (meta == MetaType::kImage) return EncodeImage(std::span(page.image->texels).first(4 * kImageTexels));
  if (meta == MetaType::kVector) return EncodeVector(*page.features);
  if (meta == MetaType::kModel) return EncodeBuildings(*page.buildings);
  return EncodeProperty(*page.property);
}

class Network {
 public:
  Network(const DeclaredType& type, const ModuleContext& context, const NetworkEnds& ends)
      : type_(type), ends_(ends), limit_(graph_, kMostPagesUnderWay) {
    source_ =
        std::make_unique<flow::input_node<Load>>(graph_, [this](tbb::flow_control& control) { return Next(control); });
    flow::make_edge(*source_, limit_);
    flow::sender<Load>* last = &limit_;
    last =
        &Join(*last, false, type.read, [meta = *PagesOf(type.read)](Parcel& parcel) { return Decode(meta, parcel); });
    const std::vector<PropertyRecord> meanings = MeaningsAlong(type, context.takes);
    for (size_t i = 0; i < type.process.size(); ++i) {
      const ModuleUse& use = type.process[i];
      const ProcessModule& module = *ProcessModules::Stock().Find(use.module);
      const ModuleContext takes{context.sea, i == 0 ? context.takes : meanings[i - 1]};
      last = &Join(*last, use.in_series, use.module,
                   [&use, &module, takes](Parcel& parcel) { return module.process(use.settings, takes, parcel.page); });
    }
    last = &Join(*last, false, type.write, [this](Parcel& parcel) {
      if (type_.meta == MetaType::kSurfaceProperty && parcel.page.property->channels != type_.property.channels)
        return Status::Error("{} channels where the type has {}", parcel.page.property->channels,
                             type_.property.channels);
      parcel.stored.bytes = Encode(type_.meta, parcel.page);
      return Status();
    });
    last = &Join(*last, true, type.write, [this](Parcel& parcel) { return ends_.put(parcel.stored); });
    done_ = std::make_unique<flow::function_node<Load, flow::continue_msg>>(
        graph_, flow::unlimited, [](const Load&) { return flow::continue_msg(); });
    flow::make_edge(*last, *done_);
    flow::make_edge(*done_, limit_.decrementer());
  }

  Status Run() EXCLUDES_LOCK(mutex_) {
    source_->activate();
    graph_.wait_for_all();
    const MutexLock lock(mutex_);
    return status_;
  }

 private:
  using Node = flow::function_node<Load, Load>;

  Load Next(tbb::flow_control& control) {
    std::optional<StoredPage> page = failed_.load(std::memory_order_relaxed) ? std::nullopt : ends_.next();
    if (!page) {
      control.stop();
      return nullptr;
    }
    auto load = std::make_shared<Parcel>();
    load->page.node = page->node;
    load->stored = std::move(*page);
    return load;
  }

  template <typename Work>
  Node& Join(flow::sender<Load>& before, bool in_series, const std::string& name, Work work) {
    nodes_.push_back(std::make_unique<Node>(graph_, in_series ? size_t{flow::serial} : size_t{flow::unlimited},
                                            [this, name, work](const Load& load) -> Load {
                                              if (!load || failed_.load(std::memory_order_relaxed)) return nullptr;
                                              Status status = work(*load);
                                              if (!status.ok()) Fail(load->page.node, name, status);
                                              return status.ok() ? load : nullptr;
                                            }));
    flow::make_edge(before, *nodes_.back());
    return *nodes_.back();
  }

  void Fail(Quadcode node, const std::string& module, const Status& status) EXCLUDES_LOCK(mutex_) {
    failed_.store(true, std::memory_order_relaxed);
    const MutexLock lock(mutex_);
    if (!status_.ok()) return;
    status_ =
        Status::Error("data type \"{}\", {}, quadnode {}: {}", type_.name, module, node.ToString(), status.message());
  }

  const DeclaredType& type_;
  const NetworkEnds& ends_;
  std::atomic<bool> failed_{false};
  Mutex mutex_;
  Status status_ GUARDED_BY(mutex_);
  flow::graph graph_;  // goes after its nodes
  std::unique_ptr<flow::input_node<Load>> source_;
  flow::limiter_node<Load> limit_;
  std::vector<std::unique_ptr<Node>> nodes_;
  std::unique_ptr<flow::function_node<Load, flow::continue_msg>> done_;
};

}  // namespace

Status RunNetwork(const DeclaredType& type, const ModuleContext& context, const NetworkEnds& ends) {
  return Network(type, context, ends).Run();
}

}  // namespace belvedere
