#include "preproc/export.h"

#include "preproc/gdal_errors.h"
#include "preproc/layer_raster.h"
#include "preproc/partial_file.h"
#include "preproc/progress.h"
#include "preproc/raster_reader.h"

#include <gdal_priv.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

constexpr int64_t kGdalCacheBytes = int64_t{64} << 20;
constexpr int kSteps = 1000;                              // of the progress
constexpr double kMercatorNorth_deg = 85.05112877980659;  // where the square of the Web Mercator ends

enum class Format { kCog, kMbtiles };

Result<Format> FormatOf(const std::string& out) {
  std::string ending = std::filesystem::path(out).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".tif" || ending == ".tiff") return Format::kCog;
  if (ending == ".mbtiles") return Format::kMbtiles;
  return Status::Error("{}: its ending says no format; give FILE.tif or FILE.mbtiles", out);
}

Result<int> LayerOf(const Dataset& dataset, const std::string& name) {
  if (const auto layer = dataset.FindLayer(name)) return *layer;
  std::string names;
  for (const LayerRecord& record : dataset.layers()) {
    if (!names.empty()) names += ", ";
    names += record.name;
  }
  return Status::Error("{}: has no layer {}; it has {}", dataset.path(), name, names);
}

// What the Web Mercator can show of an extent: the world without its poles, and not over 180 E.
Result<ExportGrid> PlanTiles(const Dataset& dataset, int layer, const ExportOptions& options) {
  auto whole = PlanExport(dataset, layer, options.extent, options.level);
  if (!whole.ok()) return whole;
  const GeoBox box = whole->Box();
  const double slack_deg = whole->SpacingDegrees() / 2;
  if (box.east_deg > 180 + slack_deg)
    return Status::Error("tiles do not go over 180 E; export the extents west and east of it each to a file");
  const GeoBox shown{box.west_deg, std::max(box.south_deg, -kMercatorNorth_deg), box.east_deg,
                     std::min(box.north_deg, kMercatorNorth_deg)};
  if (shown.south_deg >= shown.north_deg)
    return Status::Error("tiles end at {:.4f} N and S, and the extent lies beyond", kMercatorNorth_deg);
  return PlanExport(dataset, layer, shown, whole->level);
}

Result<ExportGrid> PlanFor(const Dataset& dataset, int layer, Format format, const ExportOptions& options) {
  if (format == Format::kCog) return PlanExport(dataset, layer, options.extent, options.level);
  if (dataset.layers()[static_cast<size_t>(layer)].kind == LayerKind::kElevation)
    return Status::Error("tiles are pictures of 8 bits, which heights are not; export layer {} to FILE.tif",
                         options.layer);
  return PlanTiles(dataset, layer, options);
}

// One file, from a raster to its place.
class FileExport {
 public:
  FileExport(LayerRaster& raster, const ExportOptions& options, const Clock& clock)
      : raster_(raster), options_(options) {
    if (!options.show_progress) return;
    progress_.emplace(kSteps, clock, [this] {
      return Progress::Written{pages_.load(std::memory_order_relaxed), bytes_.load(std::memory_order_relaxed)};
    });
  }

  Status Write(Format format) {
    auto file = PartialFile::Create(options_.out);
    if (!file.ok()) return file.status();
    const GdalErrors errors;
    const bool written = format == Format::kCog ? WriteCog((*file)->path()) : WriteTiles((*file)->path());
    if (!raster_.failure().ok()) return Status::Error("{}: not written: {}", options_.out, raster_.failure().message());
    if (!written || errors.any()) {
      return Status::Error("{}: cannot be written ({}); what was there is unchanged, check the space on the disk",
                           options_.out, errors.first());
    }
    return (*file)->Commit();
  }

 private:
  bool WriteCog(const std::string& path) {
    CPLStringList creation;
    creation.SetNameValue("COMPRESS", "DEFLATE");
    creation.SetNameValue("PREDICTOR", "YES");
    creation.SetNameValue("RESAMPLING", "AVERAGE");
    creation.SetNameValue("NUM_THREADS", "ALL_CPUS");
    creation.SetNameValue("BIGTIFF", "IF_SAFER");
    creation.SetNameValue("SPARSE_OK", "YES");
    return Copy("COG", path, creation, 0, 1);
  }

  bool WriteTiles(const std::string& path) {
    CPLStringList creation;
    creation.SetNameValue("NAME", options_.layer.c_str());
    creation.SetNameValue("DESCRIPTION",
                          fmt::format("Belvedere layer {}, level {}", options_.layer, raster_.grid().level).c_str());
    creation.SetNameValue("TILE_FORMAT", "PNG");
    creation.SetNameValue("ZOOM_LEVEL_STRATEGY", "UPPER");
    creation.SetNameValue("RESAMPLING", "BILINEAR");
    constexpr double kShareOfFinest = 0.8;
    if (!Copy("MBTiles", path, creation, 0, kShareOfFinest)) return false;
    const DatasetHandle tiles(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    if (!tiles) return false;
    std::vector<int> factors;
    for (int side = std::max(tiles->GetRasterXSize(), tiles->GetRasterYSize()), factor = 2; side > kTileSide;
         side = (side + 1) / 2, factor *= 2) {
      factors.push_back(factor);
    }
    if (factors.empty()) return true;
    Range range{this, kShareOfFinest, 1};
    return tiles->BuildOverviews("AVERAGE", static_cast<int>(factors.size()), factors.data(), 0, nullptr, Advance,
                                 &range) == CE_None;
  }

  bool Copy(const char* driver_name, const std::string& path, const CPLStringList& creation, double from, double to) {
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(driver_name);
    if (driver == nullptr) {
      CPLError(CE_Failure, CPLE_AppDefined, "this GDAL cannot write %s", driver_name);
      return false;
    }
    Range range{this, from, to};
    const DatasetHandle copy(driver->CreateCopy(path.c_str(), &raster_, FALSE, creation.List(), Advance, &range));
    return copy != nullptr;
  }

  // GDAL says how much of a step is done, 0 to 1; the step is a part of the whole.
  struct Range {
    FileExport* self;
    double from, to;
  };
  static int CPL_STDCALL Advance(double share, const char* /*message*/, void* range_of) {
    const Range& range = *static_cast<Range*>(range_of);
    range.self->AdvanceTo(range.from + share * (range.to - range.from));
    return TRUE;
  }
  void AdvanceTo(double share) {
    pages_.store(raster_.pages_read(), std::memory_order_relaxed);
    bytes_.store(raster_.bytes_made(), std::memory_order_relaxed);
    if (!progress_) return;
    for (const int reached = static_cast<int>(share * kSteps); done_ < reached; ++done_) progress_->Done();
  }

  static constexpr int kTileSide = 256;
  LayerRaster& raster_;
  const ExportOptions& options_;
  std::atomic<int64_t> pages_{0}, bytes_{0};
  int done_ = 0;
  std::optional<Progress> progress_;  // last: its thread reads the numbers above
};

}  // namespace

Result<ExportReport> Export(const Dataset& dataset, const ExportOptions& options, const Clock& clock) {
  const double start_s = clock.NowSeconds();
  GDALAllRegister();
  GDALSetCacheMax64(kGdalCacheBytes);
  const auto format = FormatOf(options.out);
  if (!format.ok()) return format.status();
  const auto layer = LayerOf(dataset, options.layer);
  if (!layer.ok()) return layer.status();
  if (const LayerKind kind = dataset.layers()[static_cast<size_t>(*layer)].kind;
      kind != LayerKind::kElevation && kind != LayerKind::kImagery)
    return Status::Error("{}: layer {} is of kind {}; elevation and imagery can be exported", dataset.path(),
                         options.layer, LayerKindName(kind));
  const auto grid = PlanFor(dataset, *layer, *format, options);
  if (!grid.ok()) return Status::Error("{}: {}", options.out, grid.message());
  LayerRaster raster(dataset, *layer, *grid, options.enlarge);
  if (Status status = FileExport(raster, options, clock).Write(*format); !status.ok()) return status;
  std::error_code error;
  return ExportReport{*grid, raster.pages_read(), static_cast<int64_t>(std::filesystem::file_size(options.out, error)),
                      clock.NowSeconds() - start_s};
}

std::string ExportReportLine(const ExportReport& report) {
  const GeoBox box = report.grid.Box();
  return fmt::format("level {}, {} x {} {}, west {:.6g} south {:.6g} east {:.6g} north {:.6g}; {:.1f} MB in {:.1f} s",
                     report.grid.level, report.grid.width, report.grid.height,
                     report.grid.kind == LayerKind::kElevation ? "posts" : "texels", box.west_deg, box.south_deg,
                     box.east_deg, box.north_deg, static_cast<double>(report.bytes) / 1e6, report.seconds);
}

}  // namespace belvedere
