#include "render/frame_recorder.h"

namespace belvedere {

void FrameRecorder::Add(const FrameSample& sample) {
  const MutexLock lock(mutex_);
  if (samples_.size() == capacity_) {
    samples_.pop_front();
    ++lost_;
  }
  samples_.push_back(sample);
}

std::vector<FrameSample> FrameRecorder::Take() {
  std::deque<FrameSample> taken;
  {
    const MutexLock lock(mutex_);
    taken.swap(samples_);
  }
  return {taken.begin(), taken.end()};
}

uint64_t FrameRecorder::lost() const {
  const MutexLock lock(mutex_);
  return lost_;
}

}  // namespace belvedere
