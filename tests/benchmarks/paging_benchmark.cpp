// What the heart of paging costs: finding, pinning and evicting pages, stating wishes; and what the servers do for a
// page.

#include "runtime/base/trace.h"
#include "runtime/paging/request_queue.h"
#include "runtime/paging/shared_cache.h"
#include "servers/mip_levels.h"
#include "servers/shaded_relief.h"
#include "servers/terrain_builder.h"
#include "tests/servers/terrain_test_pages.h"

#include <benchmark/benchmark.h>

#include <random>

namespace belvedere {
namespace {

struct PlainPage final : Page {
  size_t bytes() const override { return 1000; }
};

PageKey Key(int64_t number) {
  return {0, Quadcode::FromColumnRow(10, number % 8192, number / 8192)};
}

void Fill(SharedCache& cache, int64_t pages) {
  for (int64_t i = 0; i < pages; ++i) cache.Insert(Key(i), std::make_unique<PlainPage>());
}

// One page found, pinned and released; with threads, all in one table.
void CacheFind(benchmark::State& state) {
  constexpr int64_t kPages = 4096;
  static SharedCache* cache = nullptr;
  if (state.thread_index() == 0) {
    cache = new SharedCache(size_t{1} << 30, 1);
    Fill(*cache, kPages);
  }
  std::mt19937 random(static_cast<unsigned>(state.thread_index()));
  for (auto unused : state) {
    PagePin pin = cache->Find(Key(static_cast<int64_t>(random() % kPages)));
    benchmark::DoNotOptimize(pin.page());
  }
  state.SetItemsProcessed(state.iterations());
  if (state.thread_index() == 0) delete cache;
}
BENCHMARK(CacheFind)->Threads(1)->Threads(2)->Threads(4)->UseRealTime();

void CacheSharePin(benchmark::State& state) {
  SharedCache cache(size_t{1} << 20, 1);
  const PagePin pin = cache.Insert(Key(1), std::make_unique<PlainPage>());
  for (auto unused : state) {
    PagePin shared = pin.Share();
    benchmark::DoNotOptimize(shared);
  }
}
BENCHMARK(CacheSharePin);

// A page inserted and another evicted for it; `types` tables to choose the oldest from.
void CacheInsertAndEvict(benchmark::State& state) {
  const auto types = static_cast<int>(state.range(0));
  SharedCache cache(size_t{4} << 20, types);
  int64_t number = 0;
  for (auto unused : state) {
    PageKey key = Key(number % (int64_t{1} << 24));
    key.type = static_cast<DataType>(number++ % types);
    cache.Insert(key, std::make_unique<PlainPage>());
  }
  state.counters["evictions"] = static_cast<double>(cache.Stats().evictions);
}
BENCHMARK(CacheInsertAndEvict)->Arg(1)->Arg(8);

// A view states all its wishes again, with other priorities; a tenth of them are new.
void QueueSetWishes(benchmark::State& state) {
  RequestQueue queue(8192, Clock::System());
  std::mt19937 random(1);
  std::vector<Wish> wishes(static_cast<size_t>(state.range(0)));
  int64_t next = 0;
  for (Wish& wish : wishes) wish = {Key(next++), static_cast<float>(random() % 1000)};
  for (auto unused : state) {
    for (size_t i = 0; i < wishes.size(); ++i) {
      wishes[i].priority = static_cast<float>(random() % 1000);
      if (i % 10 == 0) wishes[i].key = Key(next++ % (int64_t{1} << 24));
    }
    queue.SetWishes(1, wishes);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(QueueSetWishes)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

void QueueTakeAndDone(benchmark::State& state) {
  RequestQueue queue(100'000, Clock::System());
  std::vector<Wish> wishes;
  for (auto unused : state) {
    std::optional<PageKey> key = queue.TryTake();
    if (!key) {
      state.PauseTiming();
      wishes.clear();
      for (int64_t i = 0; i < 10'000; ++i) wishes.push_back({Key(i), static_cast<float>((i * 7919) % 10'007)});
      queue.SetWishes(1, wishes);
      state.ResumeTiming();
      key = queue.TryTake();
    }
    queue.Done(*key);
  }
}
BENCHMARK(QueueTakeAndDone);

void TraceSpanOff(benchmark::State& state) {
  Trace::Stop();
  for (auto unused : state) const TraceSpan span("benchmark.off");
}
BENCHMARK(TraceSpanOff);

void TraceSpanOn(benchmark::State& state) {
  Trace::Start(1 << 16);
  for (auto unused : state) const TraceSpan span("benchmark.on");
  Trace::Stop();
}
BENCHMARK(TraceSpanOn);

void TerrainPageBuild(benchmark::State& state) {
  const Quadcode node = Quadcode::Containing(37, -118, 9);
  const auto heights = MakeElevation(node, WavyHeight);
  for (auto unused : state) benchmark::DoNotOptimize(BuildTerrain({node, heights.get(), node, true, 1}));
}
BENCHMARK(TerrainPageBuild)->Unit(benchmark::kMillisecond);

void TerrainPageBuildBelowData(benchmark::State& state) {
  const Quadcode node = Quadcode::Containing(37, -118, 9);
  const auto heights = MakeElevation(node, WavyHeight);
  const Quadcode finer = node.Child(2).Child(1);
  for (auto unused : state) benchmark::DoNotOptimize(BuildTerrain({finer, heights.get(), node, false, 1}));
}
BENCHMARK(TerrainPageBuildBelowData)->Unit(benchmark::kMillisecond);

void ReliefPageBuild(benchmark::State& state) {
  const Quadcode node = Quadcode::Containing(37, -118, 9);
  const auto heights = MakeElevation(node, WavyHeight);
  for (auto unused : state) benchmark::DoNotOptimize(ShadeRelief(*heights, node, nullptr));
}
BENCHMARK(ReliefPageBuild)->Unit(benchmark::kMillisecond);

void ImageMipLevels(benchmark::State& state) {
  ImagePage page;
  page.texels.assign(ImagePage::MipOffset(kImageMipLevels, page.format), 200);
  for (auto unused : state) FillMipLevels(page);
}
BENCHMARK(ImageMipLevels)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace belvedere

BENCHMARK_MAIN();
