// TourReport: what a tour measured, as `belvedere tour` writes it.
//
// Threads: values; pure functions.
#pragma once

#include "render/frame_recorder.h"
#include "runtime/paging/paging.h"

#include <string>
#include <vector>

namespace belvedere {

struct TourReport {
  std::string renderer;
  int width_px = 0, height_px = 0, views = 1;
  double error_px = 2;
  double seconds = 0;
  bool complete = true;              // flown to the end of the path
  double first_image_s = 0;          // from the start of the process to the first frame with ground in it
  std::vector<FrameSample> samples;  // of all views, oldest first
  std::vector<double> scene_hz;      // per view
  SharedCache::Statistics cache;
  RequestQueue::Statistics requests;  // of all queues together
  int64_t peak_rss_bytes = 0;
  int threads = 0;
  // Where the same lists were drawn again with nothing else running: a frame while paging over one redrawn.
  std::vector<double> paging_ratios;
  uint64_t traffic_sent = 0, traffic_received = 0, traffic_lost = 0;
};

std::string ToJson(const TourReport& report);
// A line a view and frame, after one of names.
std::string ToCsv(const std::vector<FrameSample>& samples);

// Sums of all queues; the wait is that of the queue with the longest.
RequestQueue::Statistics SumOf(const std::vector<std::unique_ptr<RequestQueue>>& queues);

// Of this process, from /proc.
int64_t PeakResidentBytes();
int ThreadCount();

}  // namespace belvedere
