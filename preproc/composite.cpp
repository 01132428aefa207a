#include "preproc/composite.h"

#include "runtime/earth/ellipsoid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace belvedere {
namespace {

// Heights of a datum are not to be trusted beyond what 32-bit millimetres hold.
constexpr double kLargestHeight_m = 2.0e6;

// Most of what a page would otherwise store is rounding noise (decision 0011): heights are rounded to a power of two of
// millimetres. Either one that tilts no triangle by more than 20 microradians, which is 64 at level 3 and 1 from level
// 10 on;
int32_t QuantumOfLevel_mm(Quadcode node) {
  constexpr double kSteepest = 2e-5;
  constexpr int kCoarsest = 6;
  const double spacing_mm = node.HeightDegrees() / kCells * kRadiansPerDegree * kEquatorialRadius_m * 1000.0;
  return int32_t{1} << std::clamp(static_cast<int>(std::floor(std::log2(spacing_mm * kSteepest))), 0, kCoarsest);
}

// or a quarter of the step between the heights that a source can tell apart, where that is more.
int32_t QuantumOfSource_mm(double precision_m) {
  constexpr double kSteps = 4;
  constexpr int kCoarsest = 10;
  const double quantum_mm = precision_m * 1000.0 / kSteps;
  if (quantum_mm < 1) return 1;
  return int32_t{1} << std::min(static_cast<int>(std::floor(std::log2(quantum_mm))), kCoarsest);
}

int32_t Millimetres(double height_m, int32_t quantum_mm) {
  const double height_mm = std::clamp(height_m, -kLargestHeight_m, kLargestHeight_m) * 1000.0;
  return quantum_mm * static_cast<int32_t>(std::lrint(height_mm / quantum_mm));
}

uint8_t Byte(float value) {
  return static_cast<uint8_t>(std::clamp(value, 0.0f, 255.0f) + 0.5f);
}

// What is still to be covered, position by position.
struct Remaining {
  explicit Remaining(size_t count) : shares(count, 1.0f) {}
  // Takes its part for a source of that weight.
  float Take(size_t i, float weight) {
    const float part = shares[i] * weight;
    shares[i] -= part;
    return part;
  }
  bool Any() const {
    return std::any_of(shares.begin(), shares.end(), [](float share) { return share > 0; });
  }
  std::vector<float> shares;
};

void ApplyFit(const std::optional<ColourFit>& fit, std::vector<float>& colours) {
  if (!fit) return;
  for (size_t i = 0; i < colours.size(); ++i) {
    const float colour = std::clamp(colours[i], 0.0f, 255.0f);
    colours[i] = static_cast<float>(fit->gain[i % 3]) * colour + static_cast<float>(fit->offset[i % 3]);
  }
}

// Colours, multiplied by the share that is covered, as straight RGBA into the rows of a page.
void WriteTexels(const LatticeRows& lattice, const std::vector<float>& colours, const std::vector<float>& shares,
                 std::vector<uint8_t>& texels) {
  size_t i = 0;
  for (const int row : lattice.rows) {
    uint8_t* out = &texels[4 * static_cast<size_t>(row) * static_cast<size_t>(kImageSide)];
    for (size_t column = 0; column < static_cast<size_t>(kImageSide); ++column, ++i, out += 4) {
      const float alpha = 1.0f - shares[i];
      out[3] = Byte(255.0f * alpha);
      if (out[3] == 0) continue;
      const float scale = alpha == 1.0f ? 1.0f : 1.0f / alpha;
      for (size_t c = 0; c < 3; ++c) out[c] = Byte(colours[3 * i + c] * scale);
    }
  }
}

}  // namespace

Composite::Composite(LayerKind kind, const std::vector<RasterSource*>& sources, const Geoid& geoid)
    : kind_(kind), geoid_(geoid), void_fill_([this](size_t which, const LatticeRows& lattice, Quadcode node) {
        return GroundOf(which, lattice, node);
      }) {
  for (auto source = sources.rbegin(); source != sources.rend(); ++source) samplers_.emplace_back(**source, kind);
}

bool Composite::MayCover(const SourceSampler& sampler, const LatticeRows& lattice) const {
  const auto [south, north] = std::minmax_element(lattice.latitudes_deg.begin(), lattice.latitudes_deg.end());
  const GeoBox& box = sampler.extent();
  if (*north < box.south_deg || *south > box.north_deg) return false;
  return std::any_of(lattice.longitudes_deg.begin(), lattice.longitudes_deg.end(),
                     [&](double longitude_deg) { return Covers(box, longitude_deg, std::max(*south, box.south_deg)); });
}

Composite::Heights Composite::HeightsAt(const LatticeRows& lattice, const Spacing& spacing, int level, size_t first) {
  const size_t columns = lattice.longitudes_deg.size();
  const size_t count = columns * lattice.latitudes_deg.size();
  std::vector<double> undulation;  // once something needs it
  const auto find_undulation = [&] {
    if (undulation.empty()) undulation = geoid_.Heights(lattice.latitudes_deg, lattice.longitudes_deg);
  };
  Heights heights{std::vector<double>(count, 0.0), std::vector<int32_t>(count, 0)};
  Remaining remaining(count);
  for (size_t which = first; which < samplers_.size(); ++which) {
    SourceSampler& sampler = samplers_[which];
    if (!MayCover(sampler, lattice)) continue;
    const Samples<double> samples = sampler.Sample<double>(lattice, spacing);
    if (sampler.source().is_above_sea_level()) find_undulation();
    const std::vector<double> datum_m =
        sampler.source().DatumHeights(lattice.latitudes_deg, lattice.longitudes_deg, undulation);
    const int32_t quantum_mm = QuantumOfSource_mm(sampler.source().precision_m());
    bool used = false;
    for (size_t i = 0; i < count; ++i) {
      if (!samples.void_weights.empty() && samples.void_weights[i] > 0 && remaining.shares[i] > 0) {
        const double delta_m =
            void_fill_.DeltaAt(which, sampler.source().georeference(), level, lattice.longitudes_deg[i % columns],
                               lattice.latitudes_deg[i / columns]);
        heights.metres[i] += static_cast<double>(remaining.shares[i] * samples.void_weights[i]) * delta_m;
      }
      if (samples.weights[i] <= 0 || std::isnan(datum_m[i])) continue;
      const float part = remaining.Take(i, samples.weights[i]);
      used = true;
      if (part <= 0) continue;
      heights.metres[i] += static_cast<double>(part) * (samples.values[i] + datum_m[i]);
      int32_t& finest_mm = heights.quanta_mm[i];
      finest_mm = finest_mm == 0 ? quantum_mm : std::min(finest_mm, quantum_mm);
    }
    if (used) sampler.source().SetUsed();
    if (!remaining.Any()) return heights;
  }
  find_undulation();
  for (size_t i = 0; i < count; ++i) heights.metres[i] += static_cast<double>(remaining.shares[i]) * undulation[i];
  return heights;
}

VoidFill::Ground Composite::GroundOf(size_t which, const LatticeRows& lattice, Quadcode node) {
  const Spacing spacing = PostSpacingOf(node);
  const Samples<double> samples = samplers_[which].Sample<double>(lattice, spacing, false);
  const std::vector<double> undulation = geoid_.Heights(lattice.latitudes_deg, lattice.longitudes_deg);
  const std::vector<double> datum_m =
      samplers_[which].source().DatumHeights(lattice.latitudes_deg, lattice.longitudes_deg, undulation);
  VoidFill::Ground ground{{}, samples.values, HeightsAt(lattice, spacing, node.level(), which + 1).metres};
  for (size_t i = 0; i < samples.weights.size(); ++i) {
    const bool has_datum = !std::isnan(datum_m[i]);
    ground.source_m[i] += has_datum ? datum_m[i] : 0.0;
    const bool is_void = !samples.void_weights.empty() && samples.void_weights[i] > 0;
    ground.posts.push_back(samples.weights[i] > 0 && has_datum ? DeltaGrid::Post::kValid
                           : is_void                           ? DeltaGrid::Post::kVoid
                                                               : DeltaGrid::Post::kOutside);
  }
  return ground;
}

std::vector<int32_t> Composite::Heights_mm(Quadcode node) {
  const Spacing spacing = PostSpacingOf(node);
  const int32_t quantum_mm = QuantumOfLevel_mm(node);
  std::vector<int32_t> heights_mm(static_cast<size_t>(kElevationSide) * static_cast<size_t>(kElevationSide));
  for (const LatticeRows& lattice : PostLattice(node)) {
    const Heights heights = HeightsAt(lattice, spacing, node.level());
    const size_t columns = lattice.longitudes_deg.size();
    for (size_t j = 0; j < lattice.rows.size(); ++j) {
      int32_t* out = &heights_mm[static_cast<size_t>(lattice.rows[j] * kElevationSide)];
      for (size_t i = 0; i < static_cast<size_t>(kElevationSide); ++i) {
        const size_t from = j * columns + std::min(i, columns - 1);
        out[i] = Millimetres(heights.metres[from], std::max(heights.quanta_mm[from], quantum_mm));
      }
    }
  }
  return heights_mm;
}

double Composite::HeightAt(double latitude_deg, double longitude_deg, std::span<const PlannedSource> plan) {
  const int level = SourceLevel(plan, Quadcode::Containing(latitude_deg, longitude_deg, kMaxLevel));
  const Quadcode node = Quadcode::Containing(latitude_deg, longitude_deg, level);
  return HeightsAt({{longitude_deg}, {latitude_deg}, {0}}, PostSpacingOf(node), level).metres[0];
}

Composite::Colours Composite::ColoursAt(const LatticeRows& lattice, const Spacing& spacing, size_t first) {
  const size_t count = lattice.longitudes_deg.size() * lattice.latitudes_deg.size();
  Colours colours{std::vector<float>(3 * count, 0.0f), {}, std::vector<bool>(samplers_.size(), false)};
  Remaining remaining(count);
  for (size_t which = first; which < samplers_.size() && remaining.Any(); ++which) {
    SourceSampler& sampler = samplers_[which];
    if (!MayCover(sampler, lattice)) continue;
    Samples<float> samples = sampler.Sample<float>(lattice, spacing);
    ApplyFit(sampler.source().colour_fit(), samples.values);
    for (size_t i = 0; i < count; ++i) {
      if (samples.weights[i] <= 0) continue;
      const float part = remaining.Take(i, samples.weights[i]);
      for (size_t c = 0; c < 3; ++c)
        colours.rgb[3 * i + c] += part * std::clamp(samples.values[3 * i + c], 0.0f, 255.0f);
      colours.used[which] = true;
    }
  }
  colours.shares = std::move(remaining.shares);
  return colours;
}

std::vector<uint8_t> Composite::Texels(Quadcode node) {
  const Spacing spacing = TexelSpacingOf(node);
  std::vector<uint8_t> texels(4 * static_cast<size_t>(kImageSide) * static_cast<size_t>(kImageSide), 0);
  for (const LatticeRows& lattice : TexelLattice(node)) {
    const Colours colours = ColoursAt(lattice, spacing);
    for (size_t which = 0; which < samplers_.size(); ++which) {
      if (colours.used[which]) samplers_[which].source().SetUsed();
    }
    WriteTexels(lattice, colours.rgb, colours.shares, texels);
  }
  return texels;
}

std::vector<ColourPair> Composite::ColourPairs(size_t place, const LatticeRows& lattice, const Spacing& spacing) {
  constexpr float kOpaque = 0.99f;
  const size_t which = samplers_.size() - 1 - place;
  const Samples<float> own = samplers_[which].Sample<float>(lattice, spacing, false);
  const Colours below = ColoursAt(lattice, spacing, which + 1);
  std::vector<ColourPair> pairs;
  for (size_t i = 0; i < own.weights.size(); ++i) {
    const float covered = 1.0f - below.shares[i];
    if (own.weights[i] < kOpaque || covered < kOpaque) continue;
    ColourPair& pair = pairs.emplace_back();
    for (size_t c = 0; c < 3; ++c) {
      pair.source[c] = std::clamp(own.values[3 * i + c], 0.0f, 255.0f);
      pair.below[c] = below.rgb[3 * i + c] / covered;
    }
  }
  return pairs;
}

}  // namespace belvedere
