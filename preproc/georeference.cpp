#include "preproc/georeference.h"

#include "runtime/earth/ellipsoid.h"

#include "runtime/base/mutex.h"

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

using Affine = std::array<double, 6>;

constexpr int kEdgeSteps = 32;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Pixel coordinates by a geotransform on WGS 84 itself, neither rotated nor sheared.
class PlainGeoreference final : public Georeference {
 public:
  PlainGeoreference(const Affine& affine, int width, int height, std::string crs_name)
      : affine_(affine), width_(width), crs_name_(std::move(crs_name)) {
    const double far_x = affine[0] + affine[1] * width;
    const double far_y = affine[3] + affine[5] * height;
    extent_ = {std::min(affine[0], far_x), std::min(affine[3], far_y), std::max(affine[0], far_x),
               std::max(affine[3], far_y)};
    while (extent_.west_deg >= 180.0 + std::abs(affine[1])) {
      extent_.west_deg -= 360.0;
      extent_.east_deg -= 360.0;
      affine_[0] -= 360.0;
    }
    spacing_deg_ = std::min(std::abs(affine[1]), std::abs(affine[5]));
    wraps_ = std::abs(std::abs(affine[1]) * width - 360.0) < 0.01 * std::abs(affine[1]);
  }
  std::unique_ptr<Georeference> Clone() const override { return std::make_unique<PlainGeoreference>(*this); }
  bool separable() const override { return true; }
  bool wraps() const override { return wraps_; }
  const std::string& crs_name() const override { return crs_name_; }

  PixelPoint ToPixel(double longitude_deg, double latitude_deg) override {
    return {Column(longitude_deg), (latitude_deg - affine_[3]) / affine_[5]};
  }
  void ToPixels(std::span<const double> longitudes_deg, std::span<const double> latitudes_deg,
                std::span<PixelPoint> out) override {
    for (size_t i = 0; i < out.size(); ++i) out[i] = ToPixel(longitudes_deg[i], latitudes_deg[i]);
  }

 private:
  // The turn of the longitude that lies on the source, if any does.
  double Column(double longitude_deg) const {
    const double column = (longitude_deg - affine_[0]) / affine_[1];
    const double turn = 360.0 / affine_[1];
    for (const double candidate : {column, column + turn, column - turn}) {
      if (candidate >= 0 && candidate <= width_) return candidate;
    }
    return column;
  }

  Affine affine_;
  int width_;
  std::string crs_name_;
  bool wraps_ = false;
};

struct TransformDeleter {
  void operator()(OGRCoordinateTransformation* transform) const { OGRCoordinateTransformation::DestroyCT(transform); }
};

// GDAL's transformer for control points and RPC. It cannot be copied, so that all clones share it in turn.
class PointTransformer {
 public:
  explicit PointTransformer(void* transformer) : transformer_(transformer) {}
  ~PointTransformer() { GDALDestroyGenImgProjTransformer(transformer_); }
  PointTransformer(const PointTransformer&) = delete;
  PointTransformer& operator=(const PointTransformer&) = delete;

  void Transform(std::vector<double>& x, std::vector<double>& y, bool to_pixels, std::vector<int>& good)
      EXCLUDES_LOCK(mutex_) {
    std::vector<double> z(x.size(), 0.0);
    const MutexLock lock(mutex_);
    GDALGenImgProjTransform(transformer_, to_pixels ? TRUE : FALSE, static_cast<int>(x.size()), x.data(), y.data(),
                            z.data(), good.data());
  }

 private:
  Mutex mutex_;
  void* const transformer_ PT_GUARDED_BY(mutex_);
};

// Any other: a projection and a geotransform, or GDAL's transformer for control points and RPC.
class ProjectedGeoreference final : public Georeference {
 public:
  using Projection = std::unique_ptr<OGRCoordinateTransformation, TransformDeleter>;

  ProjectedGeoreference(const Affine& affine, const OGRSpatialReference& crs, std::string crs_name)
      : crs_(crs), crs_name_(std::move(crs_name)), affine_(affine) {}
  ProjectedGeoreference(std::shared_ptr<PointTransformer> transformer, std::string crs_name)
      : crs_name_(std::move(crs_name)), transformer_(std::move(transformer)) {}

  Status Start() {
    if (transformer_) return {};
    OGRSpatialReference geodetic;
    geodetic.importFromEPSG(4326);
    geodetic.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    to_source_.reset(OGRCreateCoordinateTransformation(&geodetic, &crs_));
    from_source_.reset(OGRCreateCoordinateTransformation(&crs_, &geodetic));
    if (!to_source_ || !from_source_)
      return Status::Error("its coordinate reference system {} cannot be used", crs_name_);
    if (GDALInvGeoTransform(affine_.data(), inverse_.data()) == 0) {
      return Status::Error("its geotransform cannot be inverted");
    }
    return {};
  }

  std::unique_ptr<Georeference> Clone() const override {
    std::unique_ptr<ProjectedGeoreference> copy;
    if (transformer_) {
      copy = std::make_unique<ProjectedGeoreference>(transformer_, crs_name_);
    } else {
      copy = std::make_unique<ProjectedGeoreference>(affine_, crs_, crs_name_);
      BELVEDERE_CHECK(copy->Start().ok());
    }
    copy->extent_ = extent_;
    copy->spacing_deg_ = spacing_deg_;
    return copy;
  }
  bool separable() const override { return false; }
  bool wraps() const override { return false; }
  const std::string& crs_name() const override { return crs_name_; }

  PixelPoint ToPixel(double longitude_deg, double latitude_deg) override {
    PixelPoint out;
    ToPixels({&longitude_deg, 1}, {&latitude_deg, 1}, {&out, 1});
    return out;
  }

  void ToPixels(std::span<const double> longitudes_deg, std::span<const double> latitudes_deg,
                std::span<PixelPoint> out) override {
    std::vector<double> x(longitudes_deg.begin(), longitudes_deg.end());
    std::vector<double> y(latitudes_deg.begin(), latitudes_deg.end());
    const std::vector<int> good = Transform(x, y, true);
    for (size_t i = 0; i < out.size(); ++i) {
      out[i] = {kNaN, kNaN};
      if (good[i] == 0 || !std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
      out[i] = transformer_ ? PixelPoint{x[i], y[i]}
                            : PixelPoint{inverse_[0] + inverse_[1] * x[i] + inverse_[2] * y[i],
                                         inverse_[3] + inverse_[4] * x[i] + inverse_[5] * y[i]};
    }
  }

  // Longitude and latitude of a lattice over the source give its extent; the centre gives its spacing.
  Status Measure(int width, int height) {
    std::vector<double> x, y;
    for (int j = 0; j <= kEdgeSteps; ++j) {
      for (int i = 0; i <= kEdgeSteps; ++i) {
        x.push_back(static_cast<double>(width) * i / kEdgeSteps);
        y.push_back(static_cast<double>(height) * j / kEdgeSteps);
      }
    }
    const auto [middle_x, middle_y] = std::pair{width / 2.0, height / 2.0};
    x.push_back(middle_x);
    y.push_back(middle_y);
    if (!transformer_) Apply(affine_, x, y);
    const std::vector<int> good = Transform(x, y, false);
    if (good.back() == 0 || !std::isfinite(x.back())) return Status::Error("its centre lies nowhere on the Earth");
    const double centre_lon = x.back(), centre_lat = y.back();
    extent_ = {centre_lon, centre_lat, centre_lon, centre_lat};
    for (size_t i = 0; i < x.size(); ++i) {
      if (good[i] == 0 || !std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
      const double lon = x[i] - 360.0 * std::round((x[i] - centre_lon) / 360.0);
      extent_ = {std::min(extent_.west_deg, lon), std::min(extent_.south_deg, y[i]), std::max(extent_.east_deg, lon),
                 std::max(extent_.north_deg, y[i])};
    }
    IncludePoles(width, height);
    const double margin = 1e-3 * std::max(extent_.east_deg - extent_.west_deg, extent_.north_deg - extent_.south_deg);
    extent_ = {extent_.west_deg - margin, std::max(extent_.south_deg - margin, -90.0), extent_.east_deg + margin,
               std::min(extent_.north_deg + margin, 90.0)};
    return MeasureSpacing(centre_lon, centre_lat);
  }

 private:
  static void Apply(const Affine& t, std::vector<double>& x, std::vector<double>& y) {
    for (size_t i = 0; i < x.size(); ++i) {
      const double column = x[i], line = y[i];
      x[i] = t[0] + t[1] * column + t[2] * line;
      y[i] = t[3] + t[4] * column + t[5] * line;
    }
  }

  // Longitude, latitude to source coordinates or, with GDAL's transformer, to pixels; or back.
  std::vector<int> Transform(std::vector<double>& x, std::vector<double>& y, bool to_source) {
    std::vector<int> good(x.size(), 0);
    const int count = static_cast<int>(x.size());
    if (transformer_) {
      transformer_->Transform(x, y, to_source, good);
    } else {
      (to_source ? to_source_ : from_source_)->Transform(count, x.data(), y.data(), nullptr, good.data());
    }
    return good;
  }

  void IncludePoles(int width, int height) {
    for (const double pole : {-90.0, 90.0}) {
      const PixelPoint p = ToPixel(0, pole);
      if (!(p.x >= 0 && p.x <= width && p.y >= 0 && p.y <= height)) continue;
      extent_.west_deg = -180;
      extent_.east_deg = 180;
      (pole < 0 ? extent_.south_deg : extent_.north_deg) = pole;
    }
  }

  Status MeasureSpacing(double lon, double lat) {
    constexpr double kStep_deg = 1e-4;
    const PixelPoint west = ToPixel(lon - kStep_deg, lat), east = ToPixel(lon + kStep_deg, lat);
    const PixelPoint south = ToPixel(lon, lat - kStep_deg), north = ToPixel(lon, lat + kStep_deg);
    const double per_degree =
        std::max(std::hypot(east.x - west.x, east.y - west.y), std::hypot(north.x - south.x, north.y - south.y)) /
        (2 * kStep_deg);
    if (!std::isfinite(per_degree) || per_degree <= 0) return Status::Error("its pixels have no size on the Earth");
    spacing_deg_ = 1.0 / per_degree;
    return {};
  }

  OGRSpatialReference crs_;
  std::string crs_name_;
  Affine affine_{}, inverse_{};
  Projection to_source_, from_source_;
  std::shared_ptr<PointTransformer> transformer_;
};

std::string NameOf(const OGRSpatialReference& crs) {
  const char* authority = crs.GetAuthorityName(nullptr);
  const char* code = crs.GetAuthorityCode(nullptr);
  if (authority != nullptr && code != nullptr) return fmt::format("{}:{}", authority, code);
  const char* name = crs.GetName();
  return name != nullptr ? name : "unnamed";
}

// The spec's CRS, else the file's, else WGS 84 where the spec gives a box in degrees.
Result<OGRSpatialReference> FindCrs(GDALDataset& dataset, const SourceSpec& spec) {
  OGRSpatialReference crs;
  if (spec.crs) {
    if (crs.SetFromUserInput(spec.crs->c_str()) != OGRERR_NONE)
      return Status::Error("crs \"{}\" is not known to GDAL", *spec.crs);
  } else if (spec.box) {
    crs.importFromEPSG(4326);
  } else if (const OGRSpatialReference* own = dataset.GetSpatialRef(); own != nullptr && !own->IsEmpty()) {
    crs = *own;
  } else if (const OGRSpatialReference* of_points = dataset.GetGCPSpatialRef(); of_points != nullptr) {
    crs = *of_points;
  } else {
    return Status::Error("it has no coordinate reference system; give one with crs = \"EPSG:...\"");
  }
  if (crs.IsLocal())
    return Status::Error("its coordinate reference system is a local one; give one with crs = \"EPSG:...\"");
  crs.StripVertical();
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

std::optional<Affine> FindGeotransform(GDALDataset& dataset, const SourceSpec& spec) {
  Affine affine{};
  if (spec.geotransform) return *spec.geotransform;
  if (spec.box) {
    const GeoBox& box = *spec.box;
    return Affine{box.west_deg,
                  (box.east_deg - box.west_deg) / dataset.GetRasterXSize(),
                  0,
                  box.north_deg,
                  0,
                  -(box.north_deg - box.south_deg) / dataset.GetRasterYSize()};
  }
  // Some drivers give the identity where there is none.
  const bool by_points = dataset.GetGCPCount() > 0 || dataset.GetMetadata("RPC") != nullptr;
  const Affine identity{0, 1, 0, 0, 0, 1};
  if (dataset.GetGeoTransform(affine.data()) == CE_None && !(by_points && affine == identity)) return affine;
  return std::nullopt;
}

// Control points or RPC, through GDAL's own transformer.
Result<std::unique_ptr<Georeference>> MakeFromPoints(GDALDataset& dataset, const SourceSpec& spec) {
  const bool has_rpc = dataset.GetMetadata("RPC") != nullptr;
  if (!has_rpc && dataset.GetGCPCount() == 0) {
    return Status::Error("it has no georeference; give one with georeference = [west, south, east, north]");
  }
  OGRSpatialReference geodetic;
  geodetic.importFromEPSG(4326);
  char* wkt = nullptr;
  geodetic.exportToWkt(&wkt);
  CPLStringList options;
  options.SetNameValue("METHOD", dataset.GetGCPCount() > 0 ? "GCP_POLYNOMIAL" : "RPC");
  options.SetNameValue("DST_SRS", wkt);
  CPLFree(wkt);
  if (spec.crs) options.SetNameValue("SRC_SRS", spec.crs->c_str());
  void* const transformer = GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&dataset), nullptr, options.List());
  if (transformer == nullptr)
    return Status::Error("its control points or RPC cannot be used ({})", CPLGetLastErrorMsg());
  auto reference = std::make_unique<ProjectedGeoreference>(std::make_shared<PointTransformer>(transformer),
                                                           has_rpc ? "RPC" : "control points");
  if (Status status = reference->Measure(dataset.GetRasterXSize(), dataset.GetRasterYSize()); !status.ok())
    return status;
  return std::unique_ptr<Georeference>(std::move(reference));
}

}  // namespace

Result<std::unique_ptr<Georeference>> Georeference::Make(GDALDataset& dataset, const SourceSpec& spec) {
  const auto affine = FindGeotransform(dataset, spec);
  if (!affine) return MakeFromPoints(dataset, spec);
  const auto crs = FindCrs(dataset, spec);
  if (!crs.ok()) return crs.status();
  const int width = dataset.GetRasterXSize();
  const int height = dataset.GetRasterYSize();
  OGRSpatialReference geodetic;
  geodetic.importFromEPSG(4326);
  geodetic.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const bool straight = (*affine)[2] == 0 && (*affine)[4] == 0 && (*affine)[1] > 0 && (*affine)[5] != 0;
  if (straight && crs->IsSame(&geodetic) != 0) {
    return std::unique_ptr<Georeference>(std::make_unique<PlainGeoreference>(*affine, width, height, NameOf(*crs)));
  }
  auto reference = std::make_unique<ProjectedGeoreference>(*affine, *crs, NameOf(*crs));
  if (Status status = reference->Start(); !status.ok()) return status;
  if (Status status = reference->Measure(width, height); !status.ok()) return status;
  return std::unique_ptr<Georeference>(std::move(reference));
}

bool Overlap(const GeoBox& a, const GeoBox& b) {
  constexpr double kSliver_deg = 1e-9;  // rounding of a file's georeference is no overlap
  if (!(a.south_deg + kSliver_deg < b.north_deg && b.south_deg + kSliver_deg < a.north_deg)) return false;
  for (const double turn : {-720.0, -360.0, 0.0, 360.0, 720.0}) {
    if (a.west_deg + turn + kSliver_deg < b.east_deg && b.west_deg + kSliver_deg < a.east_deg + turn) return true;
  }
  return false;
}

GeoBox Widened(const GeoBox& box, double by_m) {
  const double north_deg = by_m / MetresPerDegree(0).y;  // where a degree is shortest
  const double furthest_deg = std::max(std::abs(box.south_deg), std::abs(box.north_deg)) + north_deg;
  const double metres_east = MetresPerDegree(std::min(furthest_deg, 90.0)).x;
  const double east_deg = by_m < 180 * metres_east ? by_m / metres_east : 180;
  return {box.west_deg - east_deg, box.south_deg - north_deg, box.east_deg + east_deg, box.north_deg + north_deg};
}

bool Covers(const GeoBox& box, double longitude_deg, double latitude_deg) {
  if (latitude_deg < box.south_deg || latitude_deg > box.north_deg) return false;
  const double turns = std::ceil((box.west_deg - longitude_deg) / 360.0);
  return longitude_deg + 360.0 * turns <= box.east_deg;
}

}  // namespace belvedere
