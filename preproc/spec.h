// Build spec: which layers a dataset has and what each is made of, as read from a TOML file.
//
// Sources of a layer are in the order of the file: a later one wins where it has data, unless the layer's priority is
// resolution, when a finer one does. Every mistake in the file is one
// line that names the file, the line, the key and, for a key nobody knows, the nearest that is known.
//
// An imagery layer some of whose sources have a time changes with the time: it becomes one layer for each of the times,
// its step, named NAME@TIME. A step is made of the sources without a time, and over them those of its own time.
//
// Units: degrees; feather in metres; datum_m in metres above the ellipsoid.
// Threads: values.
#pragma once

#include "preproc/types/data_type.h"
#include "preproc/vectors/feature_selection.h"
#include "runtime/base/status.h"
#include "runtime/paging/dataset.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

// kDeclared: what the file's CRS says, else EGM96 (vertical_datum.h). Numbers are those that datasets keep.
enum class VerticalDatum { kEgm96, kEllipsoid, kOffset, kGrid, kDeclared };

struct SourceSpec {
  std::string path;          // to open: relative paths are taken from the spec's folder
  std::string written_path;  // as it stands in the spec
  // Where the path names many files (mosaic.h): which this source is of, and what they have in common if it is not all.
  std::vector<std::string> files;
  std::string tiles;
  std::optional<GeoBox> extent;  // of tiles on a server: what of them is read
  std::optional<double> nodata;
  std::optional<std::string> crs;  // anything that GDAL takes: "EPSG:27700", WKT, a PROJ string
  // At most one of these: the outer edges west, south, east, north; or a GDAL geotransform.
  std::optional<GeoBox> box;
  std::optional<std::array<double, 6>> geotransform;
  std::optional<double> metres_per_unit;  // elevation; without it the file's own unit, or metres
  VerticalDatum datum = VerticalDatum::kDeclared;
  double datum_m = 0;      // for kOffset: height of the source's zero above the ellipsoid
  std::string datum_grid;  // for kGrid: "EPSG:n", or the file
  double feather_m = 0;
  std::optional<double> utc_s;                 // imagery: when it was so; to the second
  bool match_colour = false;                   // imagery: its colours are fitted to those of what lies below it
  std::optional<FeatureSelection> features{};  // of a vector layer: which, and what they are
};

// For people: the path as written, and which of its files.
std::string NameOf(const SourceSpec& source);

// Which of a layer's sources wins.
enum class Priority { kOrder, kResolution };

// Of a layer that is made of another's pages: its type, and the other's name.
struct DerivedSpec {
  DeclaredType type;
  std::string of;
};

struct LayerSpec {
  std::string name;
  LayerKind kind = LayerKind::kElevation;
  std::vector<SourceSpec> sources;
  std::optional<StepOf> step;
  Priority priority = Priority::kOrder;
  std::optional<DerivedSpec> derived{};  // it has no sources then
};
// Whether its pages are made of the pixels of its sources.
inline bool IsOfRasters(const LayerSpec& layer) {
  return layer.kind == LayerKind::kElevation || (layer.kind == LayerKind::kImagery && !layer.derived);
}
// The name of its data type.
std::string_view TypeOf(const LayerSpec& layer);
// Whether the pages of `layer` are made of those of `other`: it is the layer that it names, and of the parent's type.
bool IsMadeOf(const LayerSpec& layer, const LayerSpec& other);

// One layer as the spec has it: itself, or its steps, the earliest first.
std::vector<LayerSpec> StepsOf(LayerSpec layer, Repeats repeats);

struct BuildSpec {
  std::string path;
  std::vector<LayerSpec> layers;
};

// path names the spec in messages and says where relative sources lie.
Result<BuildSpec> ParseSpec(std::string_view text, const std::string& path);
Result<BuildSpec> LoadSpec(const std::string& path);

}  // namespace belvedere
