#include "preproc/markup.h"

#include "runtime/earth/ellipsoid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace belvedere::markup {
namespace {

constexpr size_t kMostLabels = 60;  // of sources on a map: more would hide it

// Degrees east of 180 W and south of 90 N, as the map counts.
std::string OutlineOf(const SourceRecord& source, size_t number, double turn_deg, bool labelled) {
  constexpr double kSeen = 4;  // degrees: what is smaller gets a ring
  const GeoBox& box = source.extent;
  const double x = box.west_deg + turn_deg + 180, y = 90 - box.north_deg;
  const double width = box.east_deg - box.west_deg, height = box.north_deg - box.south_deg;
  const std::string colour = Css(SourceColour(number));
  std::string out = fmt::format("<g stroke=\"{}\" fill=\"none\"><title>{}</title>", colour, Escape(source.path));
  out += fmt::format("<rect x=\"{:.4f}\" y=\"{:.4f}\" width=\"{:.4f}\" height=\"{:.4f}\"/>", x, y, width, height);
  if (width < kSeen && height < kSeen)
    out += fmt::format("<circle cx=\"{:.4f}\" cy=\"{:.4f}\" r=\"{}\"/>", x + width / 2, y + height / 2, kSeen);
  if (labelled) {
    out += fmt::format("<text x=\"{:.4f}\" y=\"{:.4f}\" fill=\"{}\" stroke=\"none\">{}</text>",
                       std::clamp(x + 1, 1.0, 350.0), std::clamp(y + 7, 7.0, 178.0), colour, number + 1);
  }
  return out + "</g>";
}

std::string Degrees(double degrees, char positive, char negative) {
  return fmt::format("{:.6g} {}", std::abs(degrees), degrees < 0 ? negative : positive);
}

}  // namespace

std::string Escape(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\'': out += "&#39;"; break;
      default: out += c;
    }
  }
  return out;
}

std::string Bytes(int64_t count) {
  const auto bytes = static_cast<double>(count);
  if (bytes < 1e3) return fmt::format("{} B", count);
  if (bytes < 1e6) return fmt::format("{:.1f} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.1f} MB", bytes / 1e6);
  return fmt::format("{:.2f} GB", bytes / 1e9);
}

std::string Count(int64_t count) {
  std::string digits = std::to_string(count);
  for (auto at = static_cast<int64_t>(digits.size()) - 3; at > (count < 0 ? 1 : 0); at -= 3)
    digits.insert(static_cast<size_t>(at), 1, ',');
  return digits;
}

std::string Seconds(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<int64_t>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string Distance(double degrees) {
  const double metres = degrees * kRadiansPerDegree * kEquatorialRadius_m;
  if (metres >= 9950) return fmt::format("{:.0f} km", metres / 1e3);
  if (metres >= 995) return fmt::format("{:.1f} km", metres / 1e3);
  return metres >= 9.95 ? fmt::format("{:.0f} m", metres) : fmt::format("{:.2g} m", metres);
}

std::string Latitude(double degrees) {
  return Degrees(degrees, 'N', 'S');
}

std::string Longitude(double degrees) {
  return Degrees(std::abs(degrees) > 180 ? std::remainder(degrees, 360.0) : degrees, 'E', 'W');
}

std::string Css(const Rgb& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

std::string More(size_t rows, std::string_view what) {
  if (rows <= kMostRows) return {};
  return fmt::format("<p>And {} more {}.</p>", Count(static_cast<int64_t>(rows - kMostRows)), what);
}

std::string Head(std::span<const std::string_view> columns) {
  std::string out = "<thead><tr>";
  for (const std::string_view column : columns) out += fmt::format("<th>{}</th>", Escape(column));
  return out + "</tr></thead>";
}

std::string Extent(const GeoBox& box) {
  return fmt::format("{} to {}, {} to {}", Longitude(box.west_deg), Longitude(box.east_deg), Latitude(box.south_deg),
                     Latitude(box.north_deg));
}

Rgb SourceColour(size_t i) {
  static constexpr std::array<Rgb, 6> kColours{
      {{255, 255, 255}, {255, 90, 80}, {255, 170, 0}, {120, 220, 255}, {255, 120, 220}, {170, 255, 120}}};
  return kColours[i % kColours.size()];
}

std::string Map(const std::string& picture_uri, std::span<const SourceRecord> sources) {
  std::string out = fmt::format(
      "<svg class=\"map\" viewBox=\"0 0 360 180\" role=\"img\" aria-label=\"map of levels and sources\">"
      "<image href=\"{}\" width=\"360\" height=\"180\" preserveAspectRatio=\"none\"/>"
      "<path class=\"graticule\" d=\"M0 45H360M0 90H360M0 135H360M45 0V180M90 0V180M135 0V180M180 0V180M225 0V180M270 "
      "0V180M315 0V180\"/>",
      picture_uri);
  for (size_t i = 0; i < sources.size(); ++i) {
    for (const double turn_deg : {-360.0, 0.0, 360.0}) {
      const GeoBox& box = sources[i].extent;
      if (box.east_deg + turn_deg <= -180 || box.west_deg + turn_deg >= 180) continue;
      out += OutlineOf(sources[i], i, turn_deg, sources.size() <= kMostLabels);
    }
  }
  return out + "</svg>";
}

std::string Bars(const HeightHistogram& histogram) {
  constexpr double kWidth = 600, kHeight = 140, kFoot = 18;
  const auto bars = static_cast<double>(histogram.posts.size());
  const int64_t most = std::max<int64_t>(1, *std::max_element(histogram.posts.begin(), histogram.posts.end()));
  const int64_t posts =
      std::max<int64_t>(1, std::accumulate(histogram.posts.begin(), histogram.posts.end(), int64_t{0}));
  std::string out = fmt::format("<svg class=\"bars\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"heights\">",
                                kWidth, kHeight + kFoot);
  for (size_t i = 0; i < histogram.posts.size(); ++i) {
    const double height = kHeight * static_cast<double>(histogram.posts[i]) / static_cast<double>(most);
    const double from_m = histogram.first_m + static_cast<double>(i) * histogram.step_m;
    out += fmt::format(
        "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"><title>{:.6g} to {:.6g} m: {:.2f} %</title>"
        "</rect>",
        kWidth * static_cast<double>(i) / bars, kHeight - height, kWidth / bars * 0.9, height, from_m,
        from_m + histogram.step_m, 100.0 * static_cast<double>(histogram.posts[i]) / static_cast<double>(posts));
  }
  for (int tick = 0; tick <= 4; ++tick) {
    const double bar = std::round(bars * tick / 4);  // where one begins
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{:.6g} m</text>", kWidth * bar / bars,
                       kHeight + kFoot - 4,
                       tick == 0   ? "start"
                       : tick == 4 ? "end"
                                   : "middle",
                       histogram.first_m + bar * histogram.step_m);
  }
  return out + "</svg>";
}

}  // namespace belvedere::markup
