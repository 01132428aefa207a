// ADS-B: recorded flights, as the Python library "traffic" keeps them: JSON, gzipped or not, an array of objects with
// timestamp (ms since 1970 UTC), icao24, callsign, latitude, longitude (degrees) and altitude (feet, of pressure; taken
// as a height above the ellipsoid). What else they have is passed over.
//
// Rows of one aircraft and callsign are one flight, until there is none for ten minutes. Rows without a place, and
// places that nobody could have flown to, are left out; heights are smoothed over the 25 feet in which they come.
//
// Threads: pure function, but for reading the file.
#pragma once

#include "dis/traffic_vehicle.h"
#include "runtime/base/status.h"

#include <string>
#include <vector>

namespace belvedere::dis {

// The flights of the files as vehicles, `speed` times as fast as they were. Time 0 is from_s after the first row of
// all.
Result<std::vector<Vehicle>> ReadFlights(const std::vector<std::string>& files, double speed, double from_s = 0);

}  // namespace belvedere::dis
