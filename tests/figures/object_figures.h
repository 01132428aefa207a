// The figures of station_figures that have to do with moving objects; its usage says what each measures.
//
// Each prints what was measured and returns 1 when a promise of docs/performance.md is broken, else 0.
// Units: seconds. Threads: the main thread's.
#pragma once

#include <cstddef>
#include <string>

namespace belvedere {

int Feed(const std::string& dataset, double seconds);
int Entities(const std::string& dataset, size_t count, double seconds, const std::string& picture_path);
int Storm(const std::string& dataset, size_t count, double seconds, const std::string& picture_path);
int Malformed(const std::string& dataset, const std::string& folder);

}  // namespace belvedere
