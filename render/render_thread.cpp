#include "render/render_thread.h"

#include "runtime/base/log.h"
#include "runtime/base/mutex.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <optional>
#include <thread>
#include <utility>

namespace belvedere {
namespace {

constexpr double kLooksPerSecond = 120;  // for news, while there is none

// Carried out by the render thread between two frames; null when it stopped before.
using Order = std::function<void(Renderer*)>;

}  // namespace

class RenderThread::Loop {
 public:
  Loop(const RenderOptions& options, const LayerTable& layers, const Clock& clock, std::unique_ptr<Context> context)
      : options_(options),
        layers_(layers),
        clock_(clock),
        context_(std::move(context)),
        recorder_(options.recorded_samples) {}

  Status Start() {
    std::promise<Result<ContextFacts>> started;
    std::future<Result<ContextFacts>> outcome = started.get_future();
    thread_ = std::thread([this, &started] { Run(started); });
    Result<ContextFacts> facts = outcome.get();
    if (facts.ok()) {
      facts_ = std::move(*facts);
      return {};
    }
    thread_.join();
    return facts.status();
  }

  void Stop() {
    {
      const MutexLock lock(mutex_);
      stopping_ = true;
    }
    wake_.NotifyAll();
    if (thread_.joinable()) thread_.join();
  }

  void Give(Order order) {
    {
      const MutexLock lock(mutex_);
      if (!stopped_) {
        orders_.push_back(std::move(order));
        return;
      }
    }
    order(nullptr);
  }

  FrameRecorder& recorder() { return recorder_; }
  const ContextFacts& facts() const { return facts_; }

 private:
  void Run(std::promise<Result<ContextFacts>>& started) {
    if (Status status = context_->MakeCurrent(); !status.ok()) {
      started.set_value(status);
      return;
    }
    {
      Result<std::unique_ptr<Renderer>> renderer = Renderer::Make(options_, layers_, clock_);
      if (renderer.ok()) {
        started.set_value((*renderer)->facts());
        DrawUntilStopped(**renderer);
      } else {
        started.set_value(renderer.status());
      }
    }
    context_->Release();
  }

  void DrawUntilStopped(Renderer& renderer) {
    double next_s = clock_.NowSeconds();
    while (true) {
      std::deque<Order> orders;
      bool stopping = false;
      {
        const MutexLock lock(mutex_);
        orders.swap(orders_);
        stopping = stopping_;
        stopped_ = stopping;
      }
      for (const Order& order : orders) order(stopping ? nullptr : &renderer);
      if (stopping) return;
      const bool drawn = renderer.DrawFrame(recorder_, *context_);
      next_s = Pace(next_s, drawn ? options_.max_fps : kLooksPerSecond);
    }
  }

  // Waits until the next frame is due; returns when the one after it will be.
  double Pace(double due_s, double most_per_second) {
    if (most_per_second <= 0) return due_s;
    const double interval_s = 1.0 / most_per_second;
    const double now_s = clock_.NowSeconds();
    // A frame that came too late is not made up for.
    const double next_s = std::max(due_s + interval_s, now_s);
    const double wait_s = std::min(next_s - now_s, interval_s);
    if (wait_s > 0) {
      const MutexLock lock(mutex_);
      const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(wait_s);
      while (!stopping_) {
        const auto left = until - std::chrono::steady_clock::now();
        if (left <= std::chrono::steady_clock::duration::zero()) break;
        wake_.WaitFor(mutex_, std::chrono::duration_cast<std::chrono::nanoseconds>(left));
      }
    }
    return next_s;
  }

  const RenderOptions options_;
  const LayerTable& layers_;
  const Clock& clock_;
  const std::unique_ptr<Context> context_;
  FrameRecorder recorder_;
  ContextFacts facts_;  // written before Start returns
  std::thread thread_;

  Mutex mutex_;
  CondVar wake_;
  std::deque<Order> orders_ GUARDED_BY(mutex_);
  bool stopping_ GUARDED_BY(mutex_) = false;
  bool stopped_ GUARDED_BY(mutex_) = false;  // nobody takes orders any more
};

Result<std::unique_ptr<RenderThread>> RenderThread::Start(const RenderOptions& options, const LayerTable& layers,
                                                          const Clock& clock, std::unique_ptr<Context> context) {
  auto loop = std::make_unique<Loop>(options, layers, clock, std::move(context));
  if (Status status = loop->Start(); !status.ok()) return status;
  return std::unique_ptr<RenderThread>(new RenderThread(std::move(loop)));
}

RenderThread::RenderThread(std::unique_ptr<Loop> loop) : loop_(std::move(loop)) {}
RenderThread::~RenderThread() {
  Stop();
}
void RenderThread::Stop() {
  loop_->Stop();
}

void RenderThread::AddView(ViewId id, std::shared_ptr<ViewChannel> channel, Presenter* presenter) {
  loop_->Give([id, channel = std::move(channel), presenter](Renderer* renderer) {
    if (renderer != nullptr) renderer->AddView(id, channel, presenter);
  });
}

void RenderThread::RemoveView(ViewId id) {
  auto done = std::make_shared<std::promise<void>>();
  std::future<void> removed = done->get_future();
  loop_->Give([id, done](Renderer* renderer) {
    if (renderer != nullptr) renderer->RemoveView(id);
    done->set_value();
  });
  removed.wait();
}

std::future<Result<Picture>> RenderThread::Capture(ViewId id, Renderer::Moment moment) {
  auto promise = std::make_shared<std::promise<Result<Picture>>>();
  std::future<Result<Picture>> picture = promise->get_future();
  loop_->Give([id, moment, promise](Renderer* renderer) {
    promise->set_value(renderer != nullptr ? renderer->Capture(id, moment)
                                           : Result<Picture>(Status::Error("capture: the render thread has stopped")));
  });
  return picture;
}

std::future<std::vector<double>> RenderThread::Redraw(ViewId id, int times, bool still) {
  auto promise = std::make_shared<std::promise<std::vector<double>>>();
  std::future<std::vector<double>> draw_ms = promise->get_future();
  loop_->Give([id, times, still, promise](Renderer* renderer) {
    promise->set_value(renderer != nullptr ? renderer->Redraw(id, times, still) : std::vector<double>{});
  });
  return draw_ms;
}

void RenderThread::SetNotices(std::vector<std::string> notices) {
  loop_->Give([notices = std::move(notices)](Renderer* renderer) {
    if (renderer != nullptr) renderer->SetNotices(notices);
  });
}

std::vector<FrameSample> RenderThread::TakeSamples() {
  return loop_->recorder().Take();
}
const ContextFacts& RenderThread::facts() const {
  return loop_->facts();
}

}  // namespace belvedere
