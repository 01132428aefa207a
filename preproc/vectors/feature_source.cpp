#include "preproc/vectors/feature_source.h"

#include "preproc/gdal_errors.h"
#include "preproc/source_settings.h"
#include "runtime/earth/ellipsoid.h"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace belvedere {
namespace {

constexpr int kMostDegreesOfArc = 4;  // a step of a curve that becomes a line

struct DatasetCloser {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using DatasetHandle = std::unique_ptr<GDALDataset, DatasetCloser>;

std::optional<double> NumberIn(std::string_view text) {
  double number = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
  return problem == std::errc() && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

// Places of a geometry in WGS 84, as parts of one shape: of a collection those of its highest dimension.
class Shaper {
 public:
  bool Take(const OGRGeometry& geometry, Feature& feature) {
    const int dimension = geometry.getDimension();
    feature.shape = dimension == 2   ? FeatureShape::kPolygons
                    : dimension == 1 ? FeatureShape::kLines
                                     : FeatureShape::kPoints;
    Add(geometry, dimension, feature);
    std::erase_if(feature.parts, [&](const FeaturePart& part) {
      return part.size() < (dimension == 2 ? 3u : dimension == 1 ? 2u : 1u);
    });
    return is_good_ && !feature.parts.empty();
  }

 private:
  void Add(const OGRGeometry& geometry, int dimension, Feature& feature) {
    if (geometry.IsEmpty()) return;
    if (const auto* collection = dynamic_cast<const OGRGeometryCollection*>(&geometry)) {
      for (int i = 0; i < collection->getNumGeometries(); ++i) Add(*collection->getGeometryRef(i), dimension, feature);
    } else if (geometry.getDimension() != dimension) {
      return;
    } else if (const auto* polygon = dynamic_cast<const OGRPolygon*>(&geometry)) {
      AddRing(*polygon->getExteriorRing(), feature);
      for (int i = 0; i < polygon->getNumInteriorRings(); ++i) AddRing(*polygon->getInteriorRing(i), feature);
    } else if (const auto* line = dynamic_cast<const OGRSimpleCurve*>(&geometry)) {
      feature.parts.push_back(PlacesOf(*line));
    } else if (const auto* point = dynamic_cast<const OGRPoint*>(&geometry)) {
      if (feature.parts.empty()) feature.parts.emplace_back();
      feature.parts.front().push_back(PlaceOf(point->getX(), point->getY()));
    }
  }

  void AddRing(const OGRLinearRing& ring, Feature& feature) {
    FeaturePart places = PlacesOf(ring);
    if (places.size() > 1 && places.front() == places.back()) places.pop_back();
    feature.parts.push_back(std::move(places));
  }

  FeaturePart PlacesOf(const OGRSimpleCurve& line) {
    FeaturePart places;
    for (int i = 0; i < line.getNumPoints(); ++i) {
      GridPlace place = PlaceOf(line.getX(i), line.getY(i));
      if (!places.empty()) {
        // The short way round.
        while (place.x - places.back().x > kUnitsAround / 2) place.x -= kUnitsAround;
        while (places.back().x - place.x > kUnitsAround / 2) place.x += kUnitsAround;
      }
      if (places.empty() || places.back() != place) places.push_back(place);
    }
    return places;
  }

  GridPlace PlaceOf(double longitude_deg, double latitude_deg) {
    constexpr double kBeyond_deg = 1e-6;
    if (!(std::abs(latitude_deg) <= 90 + kBeyond_deg && std::abs(longitude_deg) <= 540)) {
      is_good_ = false;
      return {};
    }
    GridPlace place = GridPlace::At(latitude_deg, longitude_deg);
    place.y = std::clamp(place.y, int64_t{0}, int64_t{kGridNorthPole});
    return place;
  }

  bool is_good_ = true;
};

double LengthAround(const Feature& feature) {
  double around = 0;
  for (const FeaturePart& part : feature.parts) {
    for (size_t i = 1; i < part.size(); ++i)
      around +=
          std::hypot(static_cast<double>(part[i].x - part[i - 1].x), static_cast<double>(part[i].y - part[i - 1].y));
  }
  return around / kUnitsPerDegree;
}

// The table of a source with what is taken of it.
class Table {
 public:
  Table(OGRLayer& layer, const FeatureSelection& selection, bool is_osm)
      : layer_(layer), selection_(selection), osm_(is_osm ? OsmClassOf(selection.of) : kNoOsm) {}

  // Layers without a CRS are taken as degrees.
  Status Prepare(const std::string& crs, SourceRecord& record) {
    OGRSpatialReference geographic;
    geographic.SetWellKnownGeogCS("WGS84");
    geographic.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    OGRSpatialReference own = geographic;
    if (!crs.empty()) {
      if (own.SetFromUserInput(crs.c_str()) != OGRERR_NONE) return Status::Error("its crs \"{}\" is not known", crs);
    } else if (layer_.GetSpatialRef() != nullptr) {
      own = *layer_.GetSpatialRef();
    }
    own.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const char* authority = own.GetAuthorityName(nullptr);
    const char* code = own.GetAuthorityCode(nullptr);
    record.crs = authority != nullptr && code != nullptr ? std::string(authority) + ":" + code : own.GetName();
    if (own.IsSame(&geographic)) return {};
    transformation_.reset(OGRCreateCoordinateTransformation(&own, &geographic));
    return transformation_ ? Status()
                           : Status::Error("{} cannot be brought to WGS 84: {}", record.crs, LastGdalError());
  }

  Status Select() {
    std::string condition = osm_.where;
    if (!selection_.where.empty())
      condition = condition.empty() ? selection_.where : "(" + condition + ") AND (" + selection_.where + ")";
    if (condition.empty() || layer_.SetAttributeFilter(condition.c_str()) == OGRERR_NONE) return CheckFields();
    return Status::Error("its table {} cannot be asked for \"{}\": {}", layer_.GetName(), condition, LastGdalError());
  }

  std::vector<Feature> Read(int64_t& unusable) {
    std::vector<Feature> features;
    layer_.ResetReading();
    for (OGRFeatureUniquePtr row(layer_.GetNextFeature()); row; row.reset(layer_.GetNextFeature())) {
      Feature feature;
      if (!ReadGeometry(*row, feature)) {
        ++unusable;
        continue;
      }
      ReadAttributes(*row, feature);
      feature.id = static_cast<uint32_t>(features.size());
      feature.of = selection_.of;
      feature.resolution = selection_.resolution_m / MetresPerDegree(0).x * kUnitsPerDegree;
      feature.importance = ImportanceOf(feature);
      features.push_back(std::move(feature));
    }
    return features;
  }

 private:
  Status CheckFields() const {
    std::vector<std::string> wanted;
    wanted.reserve(selection_.fields.size() + 1);
    for (const auto& [attribute, field] : selection_.fields) wanted.push_back(field);
    if (!selection_.importance.empty()) wanted.push_back(selection_.importance);
    const OGRFeatureDefn& columns = *layer_.GetLayerDefn();
    std::string all;
    for (int i = 0; i < columns.GetFieldCount(); ++i)
      all += (i == 0 ? "" : ", ") + std::string(columns.GetFieldDefn(i)->GetNameRef());
    if (columns.GetFieldIndex("other_tags") >= 0) return {};  // any tag may be there
    for (const std::string& field : wanted) {
      if (columns.GetFieldIndex(field.c_str()) < 0)
        return Status::Error("its table {} has no field \"{}\"; there are {}", layer_.GetName(), field, all);
    }
    return {};
  }

  bool ReadGeometry(OGRFeature& row, Feature& feature) {
    std::unique_ptr<OGRGeometry> geometry(row.StealGeometry());
    if (!geometry || geometry->IsEmpty()) return false;
    if (geometry->hasCurveGeometry()) geometry.reset(geometry->getLinearGeometry(kMostDegreesOfArc));
    if (!geometry || (transformation_ && geometry->transform(transformation_.get()) != OGRERR_NONE)) return false;
    const bool outlines = selection_.of == FeatureClass::kBorder || selection_.of == FeatureClass::kCoast;
    if (outlines && geometry->getDimension() == 2) geometry.reset(geometry->Boundary());
    return geometry && Shaper().Take(*geometry, feature);
  }

  void ReadAttributes(const OGRFeature& row, Feature& feature) const {
    std::map<std::string, AttributeValue> found;
    for (int i = 0; i < row.GetFieldCount(); ++i) {
      if (!row.IsFieldSetAndNotNull(i)) continue;
      const OGRFieldDefn& field = *row.GetFieldDefnRef(i);
      const std::string key = field.GetNameRef();
      if (key == "other_tags") {
        for (auto& [tag, value] : ParseTags(row.GetFieldAsString(i))) found.emplace(tag, value);
      } else if (field.GetType() == OFTInteger || field.GetType() == OFTInteger64) {
        found[key] = static_cast<int64_t>(row.GetFieldAsInteger64(i));
      } else if (field.GetType() != OFTReal) {
        if (const std::string text = row.GetFieldAsString(i); !text.empty()) found[key] = text;
      } else if (std::isfinite(row.GetFieldAsDouble(i))) {
        found[key] = row.GetFieldAsDouble(i);
      }
    }
    if (!selection_.fields.empty()) {
      std::map<std::string, AttributeValue> kept;
      for (const auto& [attribute, field] : selection_.fields) {
        if (const auto at = found.find(field); at != found.end()) kept[attribute] = at->second;
      }
      if (const auto at = found.find(selection_.importance); at != found.end()) kept.emplace(at->first, at->second);
      found = std::move(kept);
    }
    for (const char* other : {"NAME", "Name"}) {
      if (found.contains("name") || !found.contains(other)) continue;
      auto node = found.extract(other);
      node.key() = "name";
      found.insert(std::move(node));
    }
    feature.attributes.assign(found.begin(), found.end());
  }

  double ImportanceOf(const Feature& feature) const {
    const std::string key = selection_.importance.empty() ? osm_.ordered_by : selection_.importance;
    const double extent = LengthAround(feature);
    const auto found = std::find_if(feature.attributes.begin(), feature.attributes.end(),
                                    [&](const Attribute& attribute) { return attribute.first == key; });
    if (key.empty()) return extent;
    if (!selection_.importance.empty())
      return found == feature.attributes.end() ? 0 : NumberIn(TextOf(found->second)).value_or(0);
    // Of those that are equally important, the larger one.
    constexpr double kOneClass = 1000;
    if (found == feature.attributes.end()) return std::min(extent, kOneClass);
    const std::string value = TextOf(found->second);
    const auto place =
        std::find_if(osm_.order.begin(), osm_.order.end(), [&](const char* other) { return value == other; });
    return kOneClass * static_cast<double>(osm_.order.end() - place) + std::min(extent, kOneClass);
  }

  inline static const OsmClass kNoOsm{};
  OGRLayer& layer_;
  const FeatureSelection& selection_;
  const OsmClass& osm_;
  std::unique_ptr<OGRCoordinateTransformation> transformation_;
};

DatasetHandle OpenVectors(const std::string& path) {
  // Of a table of text, which columns are places.
  constexpr std::array<const char*, 3> kOptions = {"X_POSSIBLE_NAMES=lon,lng,long,longitude,lon_deg,x,easting",
                                                   "Y_POSSIBLE_NAMES=lat,latitude,lat_deg,y,northing", nullptr};
  const bool is_csv = path.size() > 4 && (path.ends_with(".csv") || path.ends_with(".CSV"));
  std::array<const char*, 4> options = {kOptions[0], kOptions[1], "AUTODETECT_TYPE=YES", nullptr};
  return DatasetHandle(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                         nullptr, is_csv ? options.data() : nullptr));
}

Result<OGRLayer*> TableOf(GDALDataset& file, const FeatureSelection& selection, bool is_osm) {
  std::string table = selection.table;
  if (table.empty() && is_osm) table = OsmClassOf(selection.of).table;
  if (table.empty() && file.GetLayerCount() == 1) return file.GetLayer(0);
  std::string tables;
  for (int i = 0; i < file.GetLayerCount(); ++i)
    tables += (i == 0 ? "" : ", ") + std::string(file.GetLayer(i)->GetName());
  if (table.empty()) return Status::Error("it has several tables ({}): say \"table\"", tables);
  OGRLayer* layer = file.GetLayerByName(table.c_str());
  if (layer == nullptr) return Status::Error("it has no table {}; there are {}", table, tables);
  // Its driver keeps rows of all tables that anybody may ask for.
  if (is_osm) file.ReleaseResultSet(file.ExecuteSQL(("SET interest_layers = " + table).c_str(), nullptr, nullptr));
  return layer;
}

}  // namespace

Result<FeatureSource> FeatureSource::Read(const SourceSpec& spec) {
  FeatureSource source(spec);
  const FeatureSelection& selection = *spec.features;
  const GdalErrors errors;
  const DatasetHandle file = OpenVectors(spec.path);
  if (!file) return Status::Error("{}", errors.first());
  const bool is_osm = std::string(file->GetDriverName()) == "OSM";
  const auto layer = TableOf(*file, selection, is_osm);
  if (!layer.ok()) return layer.status();
  Table table(**layer, selection, is_osm);
  Status status = table.Prepare(spec.crs.value_or(""), source.record_);
  if (status.ok()) status = table.Select();
  if (!status.ok()) return status;
  int64_t unusable = 0;
  source.features_ = table.Read(unusable);
  if (errors.any()) return Status::Error("it cannot be read to its end: {}; get the file again", errors.first());
  if (source.features_.empty())
    return Status::Error("it has no such feature with a place{}",
                         unusable > 0 ? fmt::format("; of {} it is missing or not on the Earth", unusable) : "");
  if (unusable > 0) source.AddRemark(fmt::format("{} features have no place on the Earth and are left out", unusable));
  source.record_.path = spec.written_path;
  source.record_.extent = ExtentOf(source.features_);
  source.record_.settings = SettingsToJson(spec);
  std::vector<std::string> files;
  const CPLStringList listed(file->GetFileList());
  files.reserve(static_cast<size_t>(listed.size()));
  for (int i = 0; i < listed.size(); ++i) files.emplace_back(listed[i]);
  if (files.empty()) files.push_back(spec.path);
  source.record_.state = StateOfFiles(files);
  return source;
}

GeoBox ExtentOf(std::span<const Feature> features) {
  GridExtent extent;
  for (const Feature& feature : features) extent.Add(feature.parts);
  return extent.box();
}

std::map<std::string, std::string> ParseTags(std::string_view text) {
  std::map<std::string, std::string> tags;
  size_t at = 0;
  const auto quoted = [&]() -> std::optional<std::string> {
    if (at >= text.size() || text[at] != '"') return std::nullopt;
    std::string out;
    for (++at; at < text.size() && text[at] != '"'; ++at) {
      if (text[at] == '\\' && at + 1 < text.size()) ++at;
      out += text[at];
    }
    if (at >= text.size()) return std::nullopt;
    ++at;
    return out;
  };
  while (at < text.size()) {
    auto key = quoted();
    if (!key || text.substr(at, 2) != "=>") break;
    at += 2;
    auto value = quoted();
    if (!value) break;
    tags[std::move(*key)] = std::move(*value);
    if (at < text.size() && text[at] == ',') ++at;
  }
  return tags;
}

}  // namespace belvedere
