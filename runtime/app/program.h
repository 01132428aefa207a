// What all commands of `belvedere` share: exit codes, the wish to stop, the size of a picture, default times.
//
// Threads: as each function says.
#pragma once

#include "runtime/base/status.h"

#include <optional>
#include <string>
#include <string_view>

namespace belvedere {

inline constexpr int kExitDone = 0;
inline constexpr int kExitCouldNot = 1;
inline constexpr int kExitWrongUse = 2;

// SIGINT and SIGTERM ask the program to stop; commands look at StopAsked between two steps.
void CatchSignals();
bool StopAsked();

// Prints the line to standard error and gives kExitCouldNot.
int CouldNot(const Status& status);

struct PictureSize {
  int width_px = 0, height_px = 0;
};
// "1024x768"; nullopt for anything else, and for less than 16 or more than 8192 pixels.
std::optional<PictureSize> ParseSize(std::string_view text);

// UTC seconds of the local solar noon at the March equinox of 2026: when no time is asked for, every place is lit.
double EquinoxNoonAt(double longitude_deg);

// Simulated time may run so much faster than the clock, or back: some three years a second.
inline constexpr double kFastestTime = 1e8;

// Writes text beside its place and moves it into it.
Status WriteText(const std::string& path, std::string_view text);

// Clock seconds since the process began.
double SecondsSinceStart();

}  // namespace belvedere
