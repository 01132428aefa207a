#include "preproc/layer_section.h"

#include "preproc/height_histogram.h"
#include "preproc/markup.h"
#include "preproc/preview.h"
#include "preproc/report.h"
#include "runtime/base/iso_time.h"
#include "runtime/earth/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

namespace belvedere {
namespace {

using namespace markup;

constexpr int kMapWidth = 720;
constexpr int kMostHistogramPages = 512;
constexpr int kMostBars = 60;
constexpr size_t kMostPictures = 36;  // of steps
constexpr int kLargestPicture = 560;  // pixels along its longer side
constexpr int kStepPicture = 200;

// The sources of all steps, those of several once.
std::vector<SourceRecord> SourcesOf(const Dataset& dataset, const WholeLayer& whole) {
  std::vector<SourceRecord> sources;
  for (const int number : whole.numbers) {
    for (const SourceRecord& source : dataset.layers()[static_cast<size_t>(number)].sources) {
      const bool known = std::any_of(sources.begin(), sources.end(), [&](const SourceRecord& other) {
        return other.path == source.path && other.utc_s == source.utc_s;
      });
      if (!known) sources.push_back(source);
    }
  }
  return sources;
}

double SpacingAt(int level, LayerKind kind) {
  return std::ldexp(kTreeDegrees / (kind == LayerKind::kImagery ? kImageInner : kCells), -level);
}

std::string SourceTable(const std::vector<SourceRecord>& sources, LayerKind kind) {
  std::string out = "<h3>Sources, the best last</h3><table>" +
                    Head(std::array<std::string_view, 9>{"", "source", "coordinate system", "datum", "nodata", "time",
                                                         "colours", "outer extent", "finest level"}) +
                    "<tbody>";
  for (size_t i = 0; i < std::min(sources.size(), kMostRows); ++i) {
    const SourceRecord& source = sources[i];
    out += fmt::format(
        "<tr><td><span class=\"swatch\" style=\"background:{}\"></span>{}</td><td>{}</td><td>{}</td><td>{}</td>"
        "<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{} ({})</td></tr>",
        Css(SourceColour(i)), i + 1, Escape(source.path), Escape(source.crs), Escape(source.datum),
        source.nodata ? fmt::format("{:.6g}", *source.nodata) : "", source.utc_s ? FormatIsoTime(*source.utc_s) : "",
        source.colour_fit ? FitText(*source.colour_fit) : "", Extent(source.extent), source.finest_level,
        Distance(SpacingAt(source.finest_level, kind)));
  }
  return out + "</tbody></table>" + More(sources.size(), "sources");
}

// Of features: they have no pixels.
std::string VectorSourceTable(const std::vector<SourceRecord>& sources) {
  if (sources.empty()) return {};
  std::string out = "<h3>Sources</h3><table>" +
                    Head(std::array<std::string_view, 3>{"source", "coordinate system", "extent"}) + "<tbody>";
  for (size_t i = 0; i < std::min(sources.size(), kMostRows); ++i)
    out += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>", Escape(sources[i].path), Escape(sources[i].crs),
                       Extent(sources[i].extent));
  return out + "</tbody></table>" + More(sources.size(), "sources");
}

struct LevelCount {
  int64_t pages = 0, bytes = 0;
  double share = 0;  // of the Earth's surface, were it a sphere
};

std::vector<LevelCount> CountLevels(const Dataset& dataset, const WholeLayer& whole) {
  std::vector<LevelCount> levels;
  for (const int number : whole.numbers) {
    for (const uint64_t word : dataset.Nodes(number)) {
      const Quadcode node = *Quadcode::FromWord(word);
      const auto level = static_cast<size_t>(node.level());
      if (levels.size() <= level) levels.resize(level + 1);
      ++levels[level].pages;
      levels[level].bytes += dataset.StoredBytes(number, node);
      const GeoBox box = node.Box();
      const double zone = std::sin(box.north_deg * kRadiansPerDegree) - std::sin(box.south_deg * kRadiansPerDegree);
      levels[level].share += zone / 2 * (box.east_deg - box.west_deg) / 360 / static_cast<double>(whole.numbers.size());
    }
  }
  return levels;
}

std::string LevelTable(const std::vector<LevelCount>& levels, const WholeLayer& whole) {
  const bool posts = whole.kind != LayerKind::kImagery;
  std::string out = "<h3>Levels</h3><table>" +
                    Head(std::array<std::string_view, 6>{"level", posts ? "between posts" : "between texels", "covers",
                                                         "pages", "bytes", ""}) +
                    "<tbody>";
  int64_t most = 1;
  for (const LevelCount& level : levels) most = std::max(most, level.bytes);
  for (size_t i = 0; i < levels.size(); ++i) {
    const auto number = static_cast<int>(i);
    const double percent = 100 * levels[i].share;
    out += fmt::format(
        "<tr><td><span class=\"swatch\" style=\"background:{}\"></span>{}</td><td class=\"n\">{}</td><td class=\"n\">"
        "{} %</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td style=\"width:14rem\"><span class=\"bar\" "
        "style=\"width:{:.1f}%\"></span></td></tr>",
        Css(LevelColour(number, static_cast<int>(levels.size()) - 1)), number, Distance(SpacingAt(number, whole.kind)),
        percent > 99.95 ? "100" : fmt::format("{:.2g}", percent), Count(levels[i].pages), Bytes(levels[i].bytes),
        100.0 * static_cast<double>(levels[i].bytes) / static_cast<double>(most));
  }
  return out + "</tbody></table>";
}

// As wide on the page as it is on the Earth in its middle latitude.
std::string Figure(const Preview& preview, const std::string& caption, bool true_to_middle) {
  const double middle_deg = (preview.box.south_deg + preview.box.north_deg) / 2;
  const double narrow = true_to_middle ? std::max(std::cos(middle_deg * kRadiansPerDegree), 0.2) : 1;
  return fmt::format("<figure><img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"\"><figcaption>{}</figcaption></figure>",
                     DataUri(preview.picture, PictureFormat::kJpeg), std::lrint(preview.picture.width * narrow),
                     preview.picture.height, caption);
}

Result<std::string> Pictures(const Dataset& dataset, const WholeLayer& whole, const Geoid& geoid) {
  const GeoBox earth{-180, -90, 180, 90};
  std::string out = "<div class=\"pictures\">";
  const bool steps = whole.numbers.size() > 1;
  for (size_t i = 0; i < std::min(whole.numbers.size(), kMostPictures); ++i) {
    const int number = whole.numbers[i];
    const LayerRecord& layer = dataset.layers()[static_cast<size_t>(number)];
    const auto preview = PreviewOf(dataset, number, earth, steps ? kStepPicture : kLargestPicture, geoid);
    if (!preview.ok()) return preview.status();
    out += Figure(*preview, layer.step ? "from " + FormatIsoTime(layer.step->utc_s) : "the whole Earth", false);
  }
  const auto finest = FinestBox(dataset, whole.numbers.front());
  if (!finest.ok()) return finest.status();
  if (finest->east_deg - finest->west_deg < 180) {
    const auto preview = PreviewOf(dataset, whole.numbers.front(), *finest, kLargestPicture, geoid);
    if (!preview.ok()) return preview.status();
    out += Figure(*preview,
                  fmt::format("where the pages of level {} lie, made of level {}: {}",
                              dataset.MaxLevel(whole.numbers.front()), preview->level, Extent(*finest)),
                  true);
  }
  out += "</div>";
  if (whole.numbers.size() > kMostPictures)
    out += fmt::format("<p>{} of {} steps are shown.</p>", kMostPictures, whole.numbers.size());
  return out;
}

Result<std::string> Heights(const Dataset& dataset, const WholeLayer& whole) {
  const int number = whole.numbers.front();
  const auto histogram = CountHeights(dataset, number, kMostHistogramPages, kMostBars);
  if (!histogram.ok()) return histogram.status();
  const std::string& reference = dataset.layers()[static_cast<size_t>(number)].vertical_reference;
  std::string out = fmt::format("<h3>Heights</h3><p>From {:.1f} to {:.1f} m; {}.</p>", histogram->lowest_m,
                                histogram->highest_m, Escape(reference));
  out += Bars(*histogram);
  return out + fmt::format(
                   "<p class=\"quiet\">Share of the posts of {} of the {} pages that have nothing finer under "
                   "them, in metres above the ellipsoid.</p>",
                   Count(histogram->pages_read), Count(histogram->pages));
}

std::string Legend(const PropertyRecord& property) {
  if (property.classes.empty()) {
    return fmt::format("<p>Each byte is {:.6g} + {:.6g} times it, {}.</p>", property.offset, property.gain,
                       property.unit.empty() ? "without a unit" : Escape(property.unit));
  }
  std::string out = "<h3>Classes</h3><table>" + Head(std::array<std::string_view, 2>{"byte", "class"}) + "<tbody>";
  for (size_t i = 0; i < property.classes.size(); ++i) {
    const auto& [name, colour] = property.classes[i];
    out += fmt::format("<tr><td><span class=\"swatch\" style=\"background:{}\"></span>{}</td><td>{}</td></tr>",
                       Css({colour[0], colour[1], colour[2]}), i, Escape(name));
  }
  return out + "</tbody></table>";
}

}  // namespace

std::vector<WholeLayer> WholeLayers(const Dataset& dataset) {
  std::vector<WholeLayer> whole;
  for (size_t i = 0; i < dataset.layers().size(); ++i) {
    const LayerRecord& layer = dataset.layers()[i];
    const std::string& name = layer.step ? layer.step->layer : layer.name;
    auto found = std::find_if(whole.begin(), whole.end(), [&](const WholeLayer& other) { return other.name == name; });
    if (found == whole.end()) found = whole.insert(whole.end(), {name, layer.kind, {}});
    found->numbers.push_back(static_cast<int>(i));
  }
  return whole;
}

Result<std::string> LayerSection(const Dataset& dataset, const WholeLayer& whole, const Geoid& geoid) {
  const std::vector<LevelCount> levels = CountLevels(dataset, whole);
  const std::vector<SourceRecord> sources = SourcesOf(dataset, whole);
  int64_t pages = 0, bytes = 0;
  for (const LevelCount& level : levels) {
    pages += level.pages;
    bytes += level.bytes;
  }
  std::string out =
      fmt::format("<h2>{}</h2><p>{}{}: {} pages, {}, levels 0 to {}</p>", Escape(whole.name), LayerKindName(whole.kind),
                  whole.numbers.size() > 1 ? fmt::format(", {} times", whole.numbers.size()) : "", Count(pages),
                  Bytes(bytes), levels.size() - 1);
  const LayerRecord& record = dataset.layers()[static_cast<size_t>(whole.numbers.front())];
  if (record.derivation)
    out += fmt::format("<p>Made of layer {}; its type is \"{}\".</p>", Escape(record.derivation->of),
                       Escape(record.derivation->type));
  if (!IsOfGround(whole.kind)) return out + VectorSourceTable(sources) + LevelTable(levels, whole);
  if (whole.kind == LayerKind::kProperty) return out + Legend(*record.property) + LevelTable(levels, whole);
  const auto pictures = Pictures(dataset, whole, geoid);
  if (!pictures.ok()) return pictures;
  out += *pictures;
  const std::span shown(sources.data(), std::min(sources.size(), kMostRows));
  out += "<h3>Coverage and resolution</h3>" +
         Map(DataUri(MapOfLevels(dataset, whole.numbers, kMapWidth), PictureFormat::kPng), shown);
  out +=
      "<p class=\"quiet\">The ground is coloured by the finest level there, as in the table of levels; the outlines "
      "are those of the sources, numbered as in their table.</p>";
  out += SourceTable(sources, whole.kind) + LevelTable(levels, whole);
  if (whole.kind != LayerKind::kElevation) return out;
  const auto heights = Heights(dataset, whole);
  if (!heights.ok()) return heights;
  return out + *heights;
}

}  // namespace belvedere
