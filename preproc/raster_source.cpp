#include "preproc/raster_source.h"

#include "preproc/raster_reader.h"
#include "preproc/source_settings.h"
#include "preproc/vertical_datum.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace belvedere {
namespace {

constexpr size_t kBlockPixels = static_cast<size_t>(kBlockSide) * static_cast<size_t>(kBlockSide);
constexpr int kDeepestPyramid = 24;
constexpr int kMostVoidsSide = 4096;  // pixels, where voids are looked for
constexpr int kCoarsestVoids = 6;

Block EmptyBlock(LayerKind kind) {
  Block block;
  block.coverage.assign(kBlockPixels, 0);
  if (kind == LayerKind::kElevation) block.heights.assign(kBlockPixels, 0.0f);
  if (kind == LayerKind::kImagery) block.colours.assign(3 * kBlockPixels, 0);
  return block;
}

// Column `from` of the window onwards becomes a block of its own.
Block CutBlock(const Block& window, int window_width, int window_height, int from, LayerKind kind) {
  Block block = EmptyBlock(kind);
  const int width = std::min(kBlockSide, window_width - from);
  for (int row = 0; row < std::min(kBlockSide, window_height); ++row) {
    const auto in = static_cast<size_t>(row) * static_cast<size_t>(window_width) + static_cast<size_t>(from);
    const auto out = static_cast<size_t>(row) * static_cast<size_t>(kBlockSide);
    const auto count = static_cast<size_t>(width);
    std::copy_n(&window.coverage[in], count, &block.coverage[out]);
    if (kind == LayerKind::kElevation) std::copy_n(&window.heights[in], count, &block.heights[out]);
    if (kind == LayerKind::kImagery) std::copy_n(&window.colours[3 * in], 3 * count, &block.colours[3 * out]);
  }
  return block;
}

// The mean of 2 x 2 pixels of a finer block, weighted by their coverage, as pixel `to`. count: how many of the four lie
// on the source at all, so that the last, narrower pixel of an odd row is not taken for half empty.
void ShrinkPixel(const Block& finer, const std::array<size_t, 4>& from, size_t count, Block& out, size_t to) {
  float weight = 0, height = 0, colour[3] = {0, 0, 0};
  for (const size_t at : from) {
    const float w = finer.coverage[at];
    weight += w;
    if (!finer.heights.empty()) height += w * finer.heights[at];
    for (size_t c = 0; c < 3 && !finer.colours.empty(); ++c)
      colour[c] += w * static_cast<float>(finer.colours[3 * at + c]);
  }
  if (weight <= 0 || count == 0) return;
  // Of a domain, 255 says that nothing is missing, and is never rounded up to.
  const float rounding = out.heights.empty() && out.colours.empty() ? 0.0f : 0.5f;
  out.coverage[to] = static_cast<uint8_t>(std::clamp(weight / static_cast<float>(count) + rounding, 1.0f, 255.0f));
  if (!out.heights.empty()) out.heights[to] = height / weight;
  for (size_t c = 0; c < 3 && !out.colours.empty(); ++c) {
    out.colours[3 * to + c] = static_cast<uint8_t>(colour[c] / weight + 0.5f);
  }
}

// Of the file and those that GDAL says it reads with it, as parts of a mosaic. It does not say all, so that where they
// put the pixels counts as well.
std::string StateOf(GDALDataset& dataset, const SourceSpec& spec, const Georeference& georeference) {
  char** names = dataset.GetFileList();
  std::vector<std::string> paths;
  for (char** name = names; name != nullptr && *name != nullptr; ++name) paths.emplace_back(*name);
  CSLDestroy(names);
  if (paths.empty()) paths.push_back(spec.path);
  const GeoBox& extent = georeference.extent();
  return StateOfFiles(paths) + fmt::format("{} x {}, {}, {} {} {} {}\n", dataset.GetRasterXSize(),
                                           dataset.GetRasterYSize(), georeference.crs_name(), extent.west_deg,
                                           extent.south_deg, extent.east_deg, extent.north_deg);
}

// Blocks of the source that lie under one of that level.
double CostAt(int pyramid_level) {
  return std::ldexp(1.0, 2 * pyramid_level);
}

}  // namespace

RasterSource::RasterSource(const SourceSpec& spec, LayerKind kind, int number, BlockCache& cache)
    : spec_(spec), kind_(kind), number_(number), cache_(cache) {}
RasterSource::~RasterSource() = default;

Result<std::unique_ptr<RasterSource>> RasterSource::Open(const SourceSpec& spec, LayerKind kind, int number,
                                                         int handles, BlockCache& cache) {
  std::unique_ptr<RasterSource> source(new RasterSource(spec, kind, number, cache));
  auto reader = RasterReader::Open(spec, kind, handles);
  if (!reader.ok()) return reader.status();
  source->reader_ = std::move(*reader);
  auto georeference = Georeference::Make(source->reader_->dataset(), spec);
  if (!georeference.ok()) return georeference.status();
  source->georeference_ = std::move(*georeference);
  source->width_ = source->reader_->width();
  source->height_ = source->reader_->height();
  source->remark_ = source->reader_->remark();
  if (Status status = kind == LayerKind::kElevation ? source->FindDatum() : Status(); !status.ok()) return status;
  source->state_ = StateOf(source->reader_->dataset(), spec, *source->georeference_);
  const GeoBox& extent = source->georeference_->extent();
  if (!(extent.south_deg < 90 && extent.north_deg > -90 && extent.east_deg - extent.west_deg < 361)) {
    return Status::Error(
        "it covers nothing of the Earth (west {}, south {}, east {}, north {}); correct its georeference or crs",
        extent.west_deg, extent.south_deg, extent.east_deg, extent.north_deg);
  }
  if (source->datum_grid_) source->state_ += StateOfFiles({source->datum_grid_->path()});
  source->pyramid_levels_ =
      source->georeference_->wraps() ? std::countr_zero(static_cast<unsigned>(source->width_)) : kDeepestPyramid;
  return source;
}

SourceRecord RasterSource::Record() const {
  SourceRecord record;
  record.path = spec_.written_path;
  record.crs = georeference_->crs_name();
  record.extent = georeference_->extent();
  record.nodata = reader_->nodata();
  record.utc_s = spec_.utc_s;
  record.colour_fit = colour_fit_;
  record.settings = SettingsToJson(spec_);
  record.state = state_;
  if (kind_ == LayerKind::kElevation) {
    record.datum = datum_name_;
  }
  return record;
}

double RasterSource::precision_m() const {
  return reader_->precision_m();
}

// What the spec says, else the file, else EGM96.
Status RasterSource::FindDatum() {
  datum_ = spec_.datum;
  std::string grid = spec_.datum_grid;
  const DeclaredHeights declared = reader_->declared_heights();
  const bool is_declared = spec_.datum == VerticalDatum::kDeclared;
  if (is_declared) {
    datum_ = declared.datum.value_or(VerticalDatum::kEgm96);
    grid = declared.grid;
  }
  std::string reason = declared.name.empty() || declared.datum ? "" : "which is not known here";
  if (datum_ == VerticalDatum::kGrid) {
    auto loaded = LoadGeoidGrid(grid, georeference_->extent());
    if (loaded.ok())
      datum_grid_ = std::move(*loaded);
    else if (!is_declared)
      return loaded.status();
    else
      reason = loaded.message();
  }
  if (is_declared && !reason.empty()) {
    datum_ = VerticalDatum::kEgm96;
    remark_ += fmt::format(
        "{}its heights are above {} ({}) and are taken as above EGM96, which may be metres off; give "
        "it a datum",
        remark_.empty() ? "" : "; ", declared.name, reason);
  }
  datum_name_ = datum_ == VerticalDatum::kEgm96       ? "egm96"
                : datum_ == VerticalDatum::kEllipsoid ? "ellipsoid"
                : datum_ == VerticalDatum::kOffset    ? fmt::format("{}", spec_.datum_m)
                                                      : grid;
  return {};
}

std::vector<double> RasterSource::DatumHeights(std::span<const double> latitudes_deg,
                                               std::span<const double> longitudes_deg,
                                               const std::vector<double>& undulation_m) const {
  if (datum_ == VerticalDatum::kEgm96) return undulation_m;
  if (datum_grid_) return datum_grid_->Heights(latitudes_deg, longitudes_deg);
  const size_t count = latitudes_deg.size() * longitudes_deg.size();
  return std::vector<double>(count, datum_ == VerticalDatum::kOffset ? spec_.datum_m : 0.0);
}

uint64_t RasterSource::KeyOf(Plane plane, int pyramid_level, int column, int row) const {
  static_assert(kDeepestPyramid < 32);
  const auto level = static_cast<uint64_t>(pyramid_level) | (plane == Plane::kDomain ? 32U : 0U);
  return static_cast<uint64_t>(number_) << 48 | level << 42 | static_cast<uint64_t>(column) << 21 |
         static_cast<uint64_t>(row);
}

std::shared_ptr<const Block> RasterSource::GetBlock(int pyramid_level, int column, int row) {
  const uint64_t key = KeyOf(Plane::kPixels, pyramid_level, column, row);
  if (auto found = cache_.Find(key)) return found;
  if (pyramid_level == 0) return ReadFromFile(column, row);
  auto block = Shrink(Plane::kPixels, pyramid_level, column, row);
  cache_.Insert(key, block, CostAt(pyramid_level));
  return block;
}

std::shared_ptr<const Block> RasterSource::GetDomain(int pyramid_level, int column, int row) {
  const uint64_t key = KeyOf(Plane::kDomain, pyramid_level, column, row);
  if (auto found = cache_.Find(key)) return found;
  auto block = pyramid_level == 0 ? DomainOf(column, row) : Shrink(Plane::kDomain, pyramid_level, column, row);
  cache_.Insert(key, block, CostAt(pyramid_level));
  return block;
}

std::shared_ptr<const Block> RasterSource::DomainOf(int column, int row) {
  auto domain = std::make_shared<Block>();
  domain->coverage = GetBlock(0, column, row)->coverage;
  bool whole = true;
  for (uint8_t& coverage : domain->coverage) {
    coverage = coverage > 0 ? 255 : 0;
    whole &= coverage != 0;
  }
  if (whole || kind_ != LayerKind::kElevation || !HasVoids()) return domain;
  for (int y = 0; y < kBlockSide; ++y) {
    for (int x = 0; x < kBlockSide; ++x) {
      uint8_t& coverage = domain->coverage[static_cast<size_t>(y * kBlockSide + x)];
      const int at_x = column * kBlockSide + x, at_y = row * kBlockSide + y;
      if (coverage == 0 && at_x < width_ && at_y < height_ && Voids().Holds(at_x >> voids_level_, at_y >> voids_level_))
        coverage = 255;
    }
  }
  return domain;
}

const VoidMap& RasterSource::Voids() {
  std::call_once(voids_found_, [this] { voids_ = FindVoids(); });
  return voids_;
}

// On a level of the pyramid that is not too large, where a pixel with anything missing under it is missing, so that no
// void is too small.
VoidMap RasterSource::FindVoids() {
  while (voids_level_ < std::min(pyramid_levels_, kCoarsestVoids) &&
         std::max(width(voids_level_), height(voids_level_)) > kMostVoidsSide)
    ++voids_level_;
  const auto across = static_cast<size_t>(width(voids_level_));
  VoidFinder finder(width(voids_level_), georeference_->wraps());
  for (int top = 0; top < height_; top += kBlockSide) {
    std::vector<uint8_t> missing(across * static_cast<size_t>(kBlockSide >> voids_level_), 0);
    const int rows = std::min(kBlockSide, height_ - top);
    for (int left = 0; left < width_; left += kBlockSide) {
      const auto block = GetBlock(0, left / kBlockSide, top / kBlockSide);
      const int columns = std::min(kBlockSide, width_ - left);
      for (int y = 0; y < rows; ++y) {
        uint8_t* const out = &missing[across * static_cast<size_t>(y >> voids_level_)];
        for (int x = 0; x < columns; ++x)
          out[(left + x) >> voids_level_] |= block->coverage[static_cast<size_t>(y * kBlockSide + x)] == 0;
      }
    }
    const int last = (rows - 1) >> voids_level_;
    for (int row = 0; row <= last; ++row) finder.AddRow({&missing[across * static_cast<size_t>(row)], across});
  }
  return finder.Finish();
}

std::shared_ptr<const Block> RasterSource::ReadFromFile(int column, int row) {
  const int from = reader_->row_by_row() ? 0 : column * kBlockSide;
  const int window_width = reader_->row_by_row() ? width_ : std::min(kBlockSide, width_ - from);
  const int window_height = std::min(kBlockSide, height_ - row * kBlockSide);
  Block window;
  int64_t bytes = 0;
  if (Status status = reader_->Read(from, row * kBlockSide, window_width, window_height, window, bytes); !status.ok()) {
    Fail(std::move(status));
    return std::make_shared<Block>(EmptyBlock(kind_));
  }
  bytes_read_.fetch_add(bytes, std::memory_order_relaxed);
  std::shared_ptr<const Block> wanted;
  for (int at = 0; at < window_width; at += kBlockSide) {
    auto block = std::make_shared<const Block>(CutBlock(window, window_width, window_height, at, kind_));
    const int block_column = (from + at) / kBlockSide;
    cache_.Insert(KeyOf(Plane::kPixels, 0, block_column, row), block, CostAt(0));
    if (block_column == column) wanted = std::move(block);
  }
  return wanted;
}

std::shared_ptr<const Block> RasterSource::Shrink(Plane plane, int pyramid_level, int column, int row) {
  const bool is_domain = plane == Plane::kDomain;
  auto out = std::make_shared<Block>(is_domain ? Block{{}, {}, std::vector<uint8_t>(kBlockPixels)} : EmptyBlock(kind_));
  const int finer_width = width(pyramid_level - 1);
  const int finer_height = height(pyramid_level - 1);
  constexpr int kHalf = kBlockSide / 2;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const int finer_column = 2 * column + quarter % 2;
    const int finer_row = 2 * row + quarter / 2;
    if (finer_column * kBlockSide >= finer_width || finer_row * kBlockSide >= finer_height) continue;
    const auto finer = is_domain ? GetDomain(pyramid_level - 1, finer_column, finer_row)
                                 : GetBlock(pyramid_level - 1, finer_column, finer_row);
    for (int y = 0; y < kHalf; ++y) {
      for (int x = 0; x < kHalf; ++x) {
        const int columns = std::clamp(finer_width - (finer_column * kBlockSide + 2 * x), 0, 2);
        const int rows = std::clamp(finer_height - (finer_row * kBlockSide + 2 * y), 0, 2);
        const auto at = static_cast<size_t>(2 * y * kBlockSide + 2 * x);
        const auto to = static_cast<size_t>((quarter / 2 * kHalf + y) * kBlockSide + quarter % 2 * kHalf + x);
        ShrinkPixel(*finer, {at, at + 1, at + kBlockSide, at + kBlockSide + 1}, static_cast<size_t>(columns * rows),
                    *out, to);
      }
    }
  }
  return out;
}

bool RasterSource::HasData() {
  int level = 0;
  while (width(level) > kBlockSide || height(level) > kBlockSide) ++level;
  const auto block = GetBlock(level, 0, 0);
  return std::any_of(block->coverage.begin(), block->coverage.end(), [](uint8_t coverage) { return coverage > 0; });
}

Status RasterSource::failure() const {
  const MutexLock lock(failure_mutex_);
  return failure_;
}

void RasterSource::Fail(Status status) {
  const MutexLock lock(failure_mutex_);
  if (failure_.ok()) failure_ = std::move(status);
}

}  // namespace belvedere
