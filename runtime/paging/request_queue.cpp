#include "runtime/paging/request_queue.h"

#include "runtime/base/status.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace belvedere {
namespace {

constexpr size_t kWaitSamples = 1024;
constexpr size_t kNotWaiting = std::numeric_limits<size_t>::max();

struct KeyHash {
  size_t operator()(const PageKey& key) const noexcept {
    return std::hash<Quadcode>()(key.node) ^ (static_cast<size_t>(key.type) * 0x9E3779B97F4A7C15u);
  }
};

// What one view says of one page. `round` tells whether the view's newest wishes repeated it.
struct ViewWish {
  ViewId view = 0;
  float priority = 0;
  uint64_t round = 0;
};

struct Request {
  PageKey key;
  std::vector<ViewWish> wishes;  // one a view
  float priority = 0;            // the greatest of them
  uint64_t order = 0;            // of entering; earlier goes first among equals
  double since_s = 0;
  size_t place = kNotWaiting;  // in the heap; kNotWaiting once taken

  bool MoreWantedThan(const Request& other) const {
    return priority != other.priority ? priority > other.priority : order < other.order;
  }
};

// Binary heap of requests that know their places in it, most wanted first.
class Heap {
 public:
  bool empty() const { return requests_.empty(); }
  size_t size() const { return requests_.size(); }
  Request* top() const { return requests_.front(); }
  const std::vector<Request*>& requests() const { return requests_; }

  void Push(Request* request) {
    request->place = requests_.size();
    requests_.push_back(request);
    Rise(request);
  }

  void Remove(Request* request) {
    Request* const last = requests_.back();
    requests_.pop_back();
    if (last != request) {
      Put(last, request->place);
      Update(last);
    }
    request->place = kNotWaiting;
  }

  // The priority of the request changed.
  void Update(Request* request) {
    Rise(request);
    Sink(request);
  }

 private:
  void Put(Request* request, size_t place) {
    requests_[place] = request;
    request->place = place;
  }

  void Rise(Request* request) {
    size_t place = request->place;
    while (place > 0 && request->MoreWantedThan(*requests_[(place - 1) / 2])) {
      Put(requests_[(place - 1) / 2], place);
      place = (place - 1) / 2;
    }
    Put(request, place);
  }

  void Sink(Request* request) {
    size_t place = request->place;
    while (true) {
      size_t child = 2 * place + 1;
      if (child >= requests_.size()) break;
      if (child + 1 < requests_.size() && requests_[child + 1]->MoreWantedThan(*requests_[child])) ++child;
      if (!requests_[child]->MoreWantedThan(*request)) break;
      Put(requests_[child], place);
      place = child;
    }
    Put(request, place);
  }

  std::vector<Request*> requests_;
};

// The wishes that a view may have at all: the `most` greatest.
std::span<const Wish> MostWanted(std::span<const Wish> wishes, size_t most, std::vector<Wish>& scratch) {
  if (wishes.size() <= most) return wishes;
  scratch.assign(wishes.begin(), wishes.end());
  const auto end = scratch.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(scratch.begin(), end, scratch.end(),
                   [](const Wish& a, const Wish& b) { return a.priority > b.priority; });
  scratch.resize(most);
  return scratch;
}

}  // namespace

struct RequestQueue::State {
  State(size_t most_waiting, const Clock& time) : capacity(most_waiting), clock(time) {}

  const size_t capacity;
  const Clock& clock;
  std::unordered_map<PageKey, Request, KeyHash> requests;  // waiting or taken
  Heap waiting;
  std::unordered_map<ViewId, std::vector<PageKey>> wished;  // by each view that has wishes
  uint64_t round = 0;
  uint64_t entered = 0;
  bool stopped = false;
  Statistics statistics;
  std::array<float, kWaitSamples> waits_ms{};
  size_t waits = 0;

  bool SetWishes(ViewId view, std::span<const Wish> wishes);
  PageKey TakeTop();

 private:
  bool Add(ViewId view, const Wish& wish, double now_s);
  void Withdraw(ViewId view, const PageKey& key);
  void Reprioritise(Request& request);
  void Cancel(Request* request);
  void DropLeastWanted();
};

// True when a page entered that was not wanted before.
bool RequestQueue::State::SetWishes(ViewId view, std::span<const Wish> wishes) {
  ++round;
  const double now_s = clock.NowSeconds();
  std::vector<PageKey> keys;
  keys.reserve(wishes.size());
  bool any_new = false;
  for (const Wish& wish : wishes) {
    any_new |= Add(view, wish, now_s);
    keys.push_back(wish.key);
  }
  if (const auto before = wished.find(view); before != wished.end()) {
    for (const PageKey& key : before->second) Withdraw(view, key);
  }
  if (keys.empty()) {
    wished.erase(view);
  } else {
    wished[view] = std::move(keys);
  }
  DropLeastWanted();
  statistics.peak_waiting = std::max(statistics.peak_waiting, waiting.size());
  return any_new;
}

bool RequestQueue::State::Add(ViewId view, const Wish& wish, double now_s) {
  const float priority = std::isnan(wish.priority) ? -std::numeric_limits<float>::infinity() : wish.priority;
  const auto [found, is_new] = requests.try_emplace(wish.key);
  Request& request = found->second;
  if (is_new) {
    request.key = wish.key;
    request.since_s = now_s;
    request.order = entered++;
    ++statistics.issued;
  }
  const auto own = std::find_if(request.wishes.begin(), request.wishes.end(),
                                [view](const ViewWish& other) { return other.view == view; });
  if (own == request.wishes.end()) {
    request.wishes.push_back({view, priority, round});
  } else {
    // Of a page that is wished twice at once the greater priority counts.
    own->priority = own->round == round ? std::max(own->priority, priority) : priority;
    own->round = round;
  }
  if (is_new) {
    request.priority = priority;
    waiting.Push(&request);
  } else {
    Reprioritise(request);
  }
  return is_new;
}

// Takes back what the view said of the page in an earlier round, if it did not repeat it in this one.
void RequestQueue::State::Withdraw(ViewId view, const PageKey& key) {
  const auto found = requests.find(key);
  if (found == requests.end()) return;
  Request& request = found->second;
  const size_t erased =
      std::erase_if(request.wishes, [&](const ViewWish& wish) { return wish.view == view && wish.round != round; });
  if (erased == 0) return;
  if (request.wishes.empty() && request.place != kNotWaiting) {
    Cancel(&request);
  } else {
    Reprioritise(request);
  }
}

void RequestQueue::State::Reprioritise(Request& request) {
  if (request.place == kNotWaiting || request.wishes.empty()) return;
  float greatest = request.wishes.front().priority;
  for (const ViewWish& wish : request.wishes) greatest = std::max(greatest, wish.priority);
  if (greatest == request.priority) return;
  request.priority = greatest;
  waiting.Update(&request);
}

void RequestQueue::State::Cancel(Request* request) {
  waiting.Remove(request);
  ++statistics.cancelled;
  requests.erase(PageKey(request->key));  // a copy: the key lies in what is erased
}

void RequestQueue::State::DropLeastWanted() {
  if (waiting.size() <= capacity) return;
  std::vector<Request*> dropped = waiting.requests();
  const auto first = dropped.begin() + static_cast<std::ptrdiff_t>(capacity);
  std::nth_element(dropped.begin(), first, dropped.end(),
                   [](const Request* a, const Request* b) { return a->MoreWantedThan(*b); });
  for (auto request = first; request != dropped.end(); ++request) Cancel(*request);
}

PageKey RequestQueue::State::TakeTop() {
  Request* const request = waiting.top();
  waiting.Remove(request);
  waits_ms[waits++ % kWaitSamples] = static_cast<float>((clock.NowSeconds() - request->since_s) * 1e3);
  return request->key;
}

RequestQueue::RequestQueue(size_t capacity, const Clock& clock) : state_(std::make_unique<State>(capacity, clock)) {
  BELVEDERE_CHECK(capacity > 0);
}

RequestQueue::~RequestQueue() = default;

void RequestQueue::SetWishes(ViewId view, std::span<const Wish> wishes) {
  bool any_new = false;
  {
    std::vector<Wish> scratch;
    MutexLock lock(mutex_);
    any_new = state_->SetWishes(view, MostWanted(wishes, state_->capacity, scratch));
  }
  if (any_new) wanted_.NotifyAll();
}

std::optional<PageKey> RequestQueue::Take() {
  MutexLock lock(mutex_);
  while (!state_->stopped && state_->waiting.empty()) wanted_.Wait(mutex_);
  if (state_->stopped) return std::nullopt;
  return state_->TakeTop();
}

std::optional<PageKey> RequestQueue::TryTake() {
  MutexLock lock(mutex_);
  if (state_->stopped || state_->waiting.empty()) return std::nullopt;
  return state_->TakeTop();
}

void RequestQueue::Done(const PageKey& key) {
  MutexLock lock(mutex_);
  const auto found = state_->requests.find(key);
  BELVEDERE_CHECK(found != state_->requests.end() && found->second.place == kNotWaiting);
  state_->requests.erase(found);
  ++state_->statistics.served;
}

void RequestQueue::Stop() {
  {
    MutexLock lock(mutex_);
    state_->stopped = true;
  }
  wanted_.NotifyAll();
}

RequestQueue::Statistics RequestQueue::Stats() const {
  Statistics statistics;
  std::vector<float> waits_ms;
  {
    MutexLock lock(mutex_);
    statistics = state_->statistics;
    statistics.waiting = state_->waiting.size();
    const size_t samples = std::min(state_->waits, kWaitSamples);
    waits_ms.assign(state_->waits_ms.begin(), state_->waits_ms.begin() + static_cast<std::ptrdiff_t>(samples));
  }
  if (!waits_ms.empty()) {
    const auto p95 = waits_ms.begin() + static_cast<std::ptrdiff_t>((waits_ms.size() - 1) * 95 / 100);
    std::nth_element(waits_ms.begin(), p95, waits_ms.end());
    statistics.p95_wait_ms = static_cast<double>(*p95);
  }
  return statistics;
}

}  // namespace belvedere
