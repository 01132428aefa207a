#include "runtime/app/commands_of_program.h"
#include "runtime/base/log.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/geoid.h"
#include "runtime/paging/dataset.h"

#include <cmath>
#include <cstdio>
#include <iostream>
#include <list>
#include <memory>
#include <sstream>
#include <string>
#include <unordered_map>

namespace belvedere {
namespace {

constexpr size_t kPagesKept = 512;  // 36 MB

struct Answer {
  double height_m = 0, slope_deg = 0;
  int level = 0;
};

// Heights of one layer, with the pages used last kept.
class HeightReader {
 public:
  HeightReader(const Dataset& dataset, int layer) : dataset_(dataset), layer_(layer) {}

  // From the finest page that can be read; a damaged one is warned of once and its ancestor taken.
  Result<Answer> At(double latitude_deg, double longitude_deg) {
    Quadcode node = dataset_.FinestContaining(layer_, latitude_deg, longitude_deg);
    while (true) {
      const ElevationPage* page = PageOf(node);
      if (page != nullptr) return AnswerFrom(*page, node, latitude_deg, longitude_deg);
      if (node.is_root()) return Status::Error("no page can be read at {} {}", latitude_deg, longitude_deg);
      node = node.Parent();
    }
  }

 private:
  using Kept = std::list<std::pair<Quadcode, std::shared_ptr<ElevationPage>>>;

  const ElevationPage* PageOf(Quadcode node) {
    const auto found = index_.find(node);
    if (found != index_.end()) {
      kept_.splice(kept_.begin(), kept_, found->second);
      return kept_.front().second.get();
    }
    Result<std::shared_ptr<ElevationPage>> page = dataset_.ReadElevation(layer_, node);
    if (!page.ok()) LogWarning("{}; taking the coarser page above it", page.message());
    kept_.emplace_front(node, page.ok() ? *page : nullptr);
    index_[node] = kept_.begin();
    if (kept_.size() > kPagesKept) {
      index_.erase(kept_.back().first);
      kept_.pop_back();
    }
    return kept_.front().second.get();
  }

  static Answer AnswerFrom(const ElevationPage& page, Quadcode node, double latitude_deg, double longitude_deg) {
    const GeoBox box = node.Box();
    const double spacing_deg = node.HeightDegrees() / kCells;
    const double east_spacing_deg = node.WidthDegrees() / kCells;
    // Slope over one post spacing, inside the page.
    const double south = std::max(latitude_deg - 0.5 * spacing_deg, box.south_deg);
    const double north = std::min(latitude_deg + 0.5 * spacing_deg, box.north_deg);
    const double centre_deg = 0.5 * (box.west_deg + box.east_deg);
    const double longitude_in_box_deg = centre_deg + std::remainder(longitude_deg - centre_deg, 360.0);
    const double west = std::max(longitude_in_box_deg - 0.5 * east_spacing_deg, box.west_deg);
    const double east = std::min(longitude_in_box_deg + 0.5 * east_spacing_deg, box.east_deg);
    const auto height = [&](double lat, double lon) { return BilinearHeight(page, node, lat, lon); };
    const double metres_per_degree = kEquatorialRadius_m * kRadiansPerDegree;
    const double east_m = (east - west) * metres_per_degree * std::cos(latitude_deg * kRadiansPerDegree);
    const double north_m = (north - south) * metres_per_degree;
    const double rise_east = east_m > 1e-6 ? (height(latitude_deg, east) - height(latitude_deg, west)) / east_m : 0.0;
    const double rise_north = (height(north, longitude_in_box_deg) - height(south, longitude_in_box_deg)) / north_m;
    return {height(latitude_deg, longitude_in_box_deg),
            std::atan(std::hypot(rise_east, rise_north)) * kDegreesPerRadian, node.level()};
  }

  const Dataset& dataset_;
  const int layer_;
  Kept kept_;
  std::unordered_map<Quadcode, Kept::iterator> index_;
};

Result<int> ElevationLayer(const Dataset& dataset, const std::string& name) {
  const auto layer =
      name.empty() ? dataset.FindLayer(LayerKind::kElevation) : dataset.FindLayer(std::string_view(name));
  if (layer && dataset.layers()[static_cast<size_t>(*layer)].kind == LayerKind::kElevation) return *layer;
  if (name.empty()) return Status::Error("{}: has no elevation layer", dataset.path());
  return Status::Error("{}: has no elevation layer called \"{}\"", dataset.path(), name);
}

// Answers one line; the reason when it cannot.
Status AnswerLine(const std::string& line, HeightReader& heights, const Geoid* geoid) {
  std::istringstream words(line);
  double latitude_deg = 0, longitude_deg = 0;
  std::string rest;
  if (!(words >> latitude_deg >> longitude_deg) || (words >> rest)) return Status::Error("expected: lat lon");
  if (!(std::abs(latitude_deg) <= 90) || !(std::abs(longitude_deg) <= 360)) {
    return Status::Error("latitude must be -90 to 90 and longitude -360 to 360");
  }
  const Result<Answer> answer = heights.At(latitude_deg, longitude_deg);
  if (!answer.ok()) return answer.status();
  const double msl_m = geoid != nullptr ? answer->height_m - geoid->Height(latitude_deg, longitude_deg)
                                        : std::numeric_limits<double>::quiet_NaN();
  std::printf("%.9g %.9g %.3f %.3f %d %.3f\n", latitude_deg, longitude_deg, answer->height_m, msl_m, answer->level,
              answer->slope_deg);
  return {};
}

}  // namespace

int AnswerHeights(const HeightOptions& options) {
  const Result<std::unique_ptr<Dataset>> dataset = Dataset::Open(options.dataset);
  if (!dataset.ok()) return CouldNot(dataset.status());
  const Result<int> layer = ElevationLayer(**dataset, options.layer);
  if (!layer.ok()) return CouldNot(layer.status());
  const Result<std::shared_ptr<const Geoid>> geoid = Geoid::LoadEgm96();
  if (!geoid.ok()) LogWarning("{}; heights above mean sea level are nan", geoid.message());

  HeightReader heights(**dataset, *layer);
  int exit_code = kExitDone;
  int number = 0;
  for (std::string line; !StopAsked() && std::getline(std::cin, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const Status status = AnswerLine(line, heights, geoid.ok() ? geoid->get() : nullptr);
    if (status.ok()) continue;
    LogError("standard input, line {}: {}", number, status.message());
    exit_code = kExitCouldNot;
  }
  return exit_code;
}

}  // namespace belvedere
