// A whole station off-screen in this process, for the figures that need one.
//
// Units:   degrees, metres, seconds; bytes. What cannot be started ends the program with one line.
// Threads: the main thread's.
#pragma once

#include "runtime/app/station.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace belvedere {

inline constexpr uint16_t kPort = 30'711;
inline constexpr size_t kMiB = size_t{1} << 20;
inline constexpr int kOverlaySlots = 960;
inline const Geodetic kOverTheSierra{37.0, -118.6, 6500};

[[noreturn]] void Give(const std::string& line);

// with_feed: it listens for exercise 1 at kPort. slots: for overlay images on the GPU.
std::unique_ptr<Station> StartStation(const std::string& dataset, size_t cache_bytes, bool with_feed,
                                      double max_fps = 60, int slots = kOverlaySlots);
ViewParameters ViewFrom(Station& station, ViewId id, const Geodetic& place, double heading_deg, double pitch_deg);
void Sleep(double seconds);
// Waits until the view draws a settled list; false after that many seconds.
bool Settle(Station& station, ViewId id, double longest_s);
size_t ResidentBytesOfProcess();

}  // namespace belvedere
