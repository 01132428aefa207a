// Dataset: the pages on disk, an LMDB store in a folder and changes laid over it, read by many threads at once.
// docs/dataset-format.md has the bytes.
//
// A layer is a pyramid of pages of one kind. The children of a quadnode exist all or not at all; level 0 of every
// layer has all 32 pages. Which pages exist is loaded at Open, so Exists touches no disk.
//
// A dataset is opened for reading alone (no lock file, no write permission needed) and is never changed in place: a
// build makes a new store and moves it over the old one, and what adds or removes a source lays one more over those
// that are there. An open Dataset goes on reading what it has opened.
//
// Threads: all const methods, any thread; a read copies nothing but the decoded page.
// Owns: the memory map, until destruction.
#pragma once

#include "runtime/base/status.h"
#include "runtime/paging/layer_steps.h"
#include "runtime/paging/page.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace belvedere {

struct BuildingPage;
struct VectorPage;

inline constexpr int kDatasetVersion = 4;
inline constexpr int kOldestDatasetVersion = 4;  // that is still read
inline constexpr int kMaxDatasetLayers = 256;

enum class LayerKind : uint8_t { kElevation = 1, kImagery = 2, kProperty = 4, kVector = 5, kModel = 6 };
inline constexpr std::array<LayerKind, 5> kLayerKinds = {LayerKind::kElevation, LayerKind::kImagery,
                                                         LayerKind::kProperty, LayerKind::kVector, LayerKind::kModel};
// Whether the ground is drawn of it, rather than something that stands on the ground.
constexpr bool IsOfGround(LayerKind kind) {
  return kind != LayerKind::kVector && kind != LayerKind::kModel;
}
std::string_view LayerKindName(LayerKind kind);  // "elevation", "imagery", "property", "vector", "model"

// What a layer was made of, as recorded when it was built.
// What a source's colours, 0 to 255, were made to be: gain * colour + offset, of red, green and blue.
struct ColourFit {
  std::array<double, 3> gain{1, 1, 1}, offset{0, 0, 0};
};

struct SourceRecord {
  std::string path;  // as the spec wrote it
  std::string crs;   // short name, such as "EPSG:4326"
  GeoBox extent;
  std::optional<double> nodata;
  std::string datum;  // elevation: "egm96", "ellipsoid" or an offset in metres; imagery: empty
  int finest_level = 0;
  std::optional<double> utc_s{};          // when it was so, if the spec said
  std::optional<ColourFit> colour_fit{};  // imagery that was matched to what lies below it
  std::string settings{};                 // the builder's: all that the spec said of it, a JSON object
  std::string state{};                    // the builder's: of its files when they were read
};

// What the bytes of a property layer's pages mean: classes, by their number, or numbers, offset + gain * byte.
struct PropertyClass {
  std::string name;
  std::array<uint8_t, 4> colour{};  // sRGB and alpha, by which it is shown
};
struct PropertyRecord {
  int channels = 1;                    // 1 to kMostPropertyChannels
  std::vector<PropertyClass> classes;  // none: numbers
  double offset = 0, gain = 1;
  std::string unit;  // of numbers; may be empty
};

// A layer that was made of the pages of another.
struct Derivation {
  std::string type;        // of data, by its name
  std::string of;          // the other layer's name
  std::string definition;  // the builder's: of the type, a JSON object
};

struct LayerRecord {
  std::string name;
  LayerKind kind = LayerKind::kElevation;
  int max_level = 0;
  std::vector<int64_t> pages_per_level;  // max_level + 1 counts
  int64_t pages = 0;
  int64_t bytes = 0;               // stored bytes of all its pages
  std::string vertical_reference;  // elevation: "WGS 84 ellipsoid", and the geoid that the sources were lifted by
  std::vector<SourceRecord> sources;
  std::optional<StepOf> step{};              // imagery: it is one step of a layer that changes with the time
  int rules = 0;                             // the builder's: by which it makes pages of sources
  bool finest_last = false;                  // the builder's: sources are in the order of their resolution
  std::optional<PropertyRecord> property{};  // of kProperty
  std::optional<Derivation> derivation{};
};

class Dataset {
 public:
  // path: the dataset's folder. Fails with one line when it is missing, damaged, or of another version.
  static Result<std::unique_ptr<Dataset>> Open(const std::string& path);
  virtual ~Dataset() = default;

  // Layer numbers, as below, are indices into layers().
  virtual const std::string& path() const = 0;
  virtual const std::vector<LayerRecord>& layers() const = 0;
  virtual const std::string& build_time() const = 0;  // ISO 8601, UTC
  virtual int version() const = 0;                    // of its format, as it was written
  virtual int64_t bytes() const = 0;                  // size of the stores
  std::optional<int> FindLayer(std::string_view name) const;
  std::optional<int> FindLayer(LayerKind kind) const;  // the first of that kind

  virtual bool Exists(int layer, Quadcode node) const = 0;
  // Quadcode words of the layer's pages, ascending.
  virtual std::span<const uint64_t> Nodes(int layer) const = 0;
  // Whether the page is there and its children too (which exist together).
  bool HasChildren(int layer, Quadcode node) const { return node.level() < kMaxLevel && Exists(layer, node.Child(0)); }
  int MaxLevel(int layer) const { return layers()[static_cast<size_t>(layer)].max_level; }
  // Finest existing page that contains the position; its level is at most max_level.
  Quadcode FinestContaining(int layer, double latitude_deg, double longitude_deg, int max_level = kMaxLevel) const;

  // REQUIRES: the layer's kind is the one asked for. A page that is missing or damaged is a Status that names the
  // dataset, layer, quadcode and reason.
  virtual Result<std::shared_ptr<ElevationPage>> ReadElevation(int layer, Quadcode node) const = 0;
  // Level 0 of the texels is filled; there is room for the other kImageMipLevels - 1, zeroed. Always kRGBA8.
  virtual Result<std::shared_ptr<ImagePage>> ReadImage(int layer, Quadcode node) const = 0;

  virtual Result<std::shared_ptr<PropertyPage>> ReadProperty(int layer, Quadcode node) const = 0;

  virtual Result<std::shared_ptr<VectorPage>> ReadVector(int layer, Quadcode node) const = 0;
  virtual Result<std::shared_ptr<BuildingPage>> ReadBuildings(int layer, Quadcode node) const = 0;
  // The ids of its stores, the lowest first, and the pages that one of them names.
  virtual std::vector<std::string> store_ids() const = 0;
  virtual void ForEachKey(size_t store, const std::function<void(int layer, Quadcode)>& visit) const = 0;
  // The SQLite file with the features of all vector layers; empty where there is none.
  virtual std::string features_path() const = 0;

  // Stored bytes of a page, as ReadElevation decodes them; nullopt when it is not there.
  virtual std::optional<std::vector<uint8_t>> ReadRaw(int layer, Quadcode node) const = 0;
  // What the builder keeps of a page for itself (DatasetWriter::PutDeviations); nullopt where it keeps nothing.
  virtual std::optional<std::vector<uint8_t>> ReadDeviations(int layer, Quadcode node) const = 0;
  // How many bytes a page has, without reading it; 0 when it is not there.
  virtual int64_t StoredBytes(int layer, Quadcode node) const = 0;
};

// Height in metres of a page at a position inside its quadnode, bilinear between posts.
double BilinearHeight(const ElevationPage& page, Quadcode node, double latitude_deg, double longitude_deg);

}  // namespace belvedere
