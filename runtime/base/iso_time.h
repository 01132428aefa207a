// ISO 8601 times, as "2026-06-21T19:30:00Z".
//
// Units: seconds since 1970-01-01 UTC.
// Threads: pure functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace belvedere {

// YYYY-MM-DD, or YYYY-MM-DDThh:mm[:ss[.fraction]] with Z, +hh:mm, -hh:mm or nothing (UTC) behind; a blank may stand for
// the T. nullopt for anything else, and for days and hours that do not exist.
std::optional<double> ParseIsoTime(std::string_view text);
// YYYY-MM-DDThh:mm:ssZ, to the nearest second; what ParseIsoTime reads again. REQUIRES: a year of four digits.
std::string FormatIsoTime(double utc_s);

}  // namespace belvedere
