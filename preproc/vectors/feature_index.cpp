#include "preproc/vectors/feature_index.h"

#include "preproc/gdal_errors.h"
#include "preproc/georeference.h"
#include "runtime/paging/dataset_store.h"
#include "runtime/paging/dataset_writer.h"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

namespace belvedere {
namespace {

using nlohmann::json;

struct ResultCloser {
  GDALDataset* file;
  void operator()(OGRLayer* layer) const { file->ReleaseResultSet(layer); }
};

template <typename Line>
void SetPoints(const FeaturePart& part, Line& line) {
  for (const GridPlace& place : part) line.addPoint(place.longitude_deg(), place.latitude_deg());
}

// Rings are one polygon each with the holes in it, as OGR finds them.
std::unique_ptr<OGRGeometry> GeometryOf(const Feature& feature) {
  if (feature.shape == FeatureShape::kPolygons) {
    std::vector<OGRGeometry*> polygons;
    for (const FeaturePart& part : feature.parts) {
      auto ring = std::make_unique<OGRLinearRing>();
      SetPoints(part, *ring);
      ring->closeRings();
      auto polygon = std::make_unique<OGRPolygon>();
      polygon->addRingDirectly(ring.release());
      polygons.push_back(polygon.release());
    }
    return std::unique_ptr<OGRGeometry>(
        OGRGeometryFactory::organizePolygons(polygons.data(), static_cast<int>(polygons.size()), nullptr));
  }
  if (feature.shape == FeatureShape::kLines) {
    auto lines = std::make_unique<OGRMultiLineString>();
    for (const FeaturePart& part : feature.parts) {
      auto line = std::make_unique<OGRLineString>();
      SetPoints(part, *line);
      lines->addGeometryDirectly(line.release());
    }
    if (feature.parts.size() > 1) return lines;
    return std::unique_ptr<OGRGeometry>(lines->getGeometryRef(0)->clone());
  }
  auto points = std::make_unique<OGRMultiPoint>();
  for (const GridPlace& place : feature.parts.front()) {
    const OGRPoint point(place.longitude_deg(), place.latitude_deg());
    points->addGeometry(&point);
  }
  if (feature.parts.front().size() > 1) return points;
  return std::unique_ptr<OGRGeometry>(points->getGeometryRef(0)->clone());
}

json AttributesJson(const Feature& feature) {
  json out = json::object();
  for (const auto& [key, value] : feature.attributes)
    std::visit([&, &name = key](const auto& v) { out[name] = v; }, value);
  return out;
}

std::string Quoted(const std::string& text, char quote) {
  std::string out(1, quote);
  for (const char c : text) out += c == quote ? std::string(2, c) : std::string(1, c);
  return out + quote;
}
std::string Name(const std::string& text) {
  return Quoted(text, '"');
}
std::string Text(const std::string& text) {
  return Quoted(text, '\'');
}

std::string InBox(const std::string& table, const GeoBox& box) {
  return fmt::format(
      "ROWID IN (SELECT ROWID FROM SpatialIndex WHERE f_table_name = {} AND search_frame = "
      "BuildMbr({:.9f}, {:.9f}, {:.9f}, {:.9f}, 4326))",
      Text(table), box.west_deg, box.south_deg, box.east_deg, box.north_deg);
}

// Features are kept as their sources have them, some beyond 180.
std::string InBoxes(const std::string& table, const GeoBox& box) {
  std::string out;
  for (const double shift : {0.0, 360.0, -360.0}) {
    const GeoBox shifted{box.west_deg + shift, box.south_deg, box.east_deg + shift, box.north_deg};
    out += (out.empty() ? "(" : " OR ") + InBox(table, shifted);
  }
  return out + ")";
}

std::string DistanceTo(const FeatureQuery::Near& near) {
  std::string out;
  for (const double shift : {0.0, 360.0, -360.0}) {
    out += fmt::format("{}ST_Distance(geometry, MakePoint({:.9f}, {:.9f}, 4326), 1)", out.empty() ? "min(" : ", ",
                       near.longitude_deg + shift, near.latitude_deg);
  }
  return out + ")";
}

std::string QuestionTo(const std::string& table, const FeatureQuery& query) {
  std::vector<std::string> conditions;
  if (query.of) conditions.push_back("class = " + Text(std::string(FeatureClassName(*query.of))));
  if (query.name) conditions.push_back("instr(lower(name), lower(" + Text(*query.name) + ")) > 0");
  if (query.box) conditions.push_back(InBoxes(table, *query.box));
  if (query.near) {
    conditions.push_back(InBoxes(table, Widened({query.near->longitude_deg, query.near->latitude_deg,
                                                 query.near->longitude_deg, query.near->latitude_deg},
                                                query.near->within_m)));
    conditions.push_back(fmt::format("{} <= {:.6f}", DistanceTo(*query.near), query.near->within_m));
  }
  if (!query.where.empty()) conditions.push_back("(" + query.where + ")");
  std::string sql = "SELECT ROWID AS id, *";
  if (query.near) sql += ", " + DistanceTo(*query.near) + " AS distance_m";
  sql += " FROM " + Name(table);
  for (size_t i = 0; i < conditions.size(); ++i) sql += (i == 0 ? " WHERE " : " AND ") + conditions[i];
  return sql + fmt::format(" ORDER BY {} LIMIT {}", query.near ? "distance_m" : "importance DESC, ROWID", query.limit);
}

struct Answer {
  double order = 0;  // the least first
  std::string line;
};

Answer AnswerOf(const std::string& layer, OGRFeature& row, bool is_near) {
  json properties = json::parse(row.GetFieldAsString("attributes"), nullptr, false);
  if (!properties.is_object()) properties = json::object();
  properties["layer"] = layer;
  properties["id"] = row.GetFieldAsInteger64("id");
  properties["class"] = row.GetFieldAsString("class");
  properties["importance"] = row.GetFieldAsDouble("importance");
  if (is_near) properties["distance_m"] = row.GetFieldAsDouble("distance_m");
  CPLStringList options(std::vector<const char*>{"COORDINATE_PRECISION=8", nullptr}.data());
  char* geometry = row.GetGeometryRef() == nullptr
                       ? nullptr
                       : OGR_G_ExportToJsonEx(OGRGeometry::ToHandle(row.GetGeometryRef()), options.List());
  const std::string text = geometry == nullptr ? "null" : geometry;
  CPLFree(geometry);
  return {is_near ? row.GetFieldAsDouble("distance_m") : -row.GetFieldAsDouble("importance"),
          fmt::format("{{\"type\":\"Feature\",\"geometry\":{},\"properties\":{}}}", text, properties.dump())};
}

}  // namespace

std::string NewFeaturesFile() {
  return std::string(store::kFeaturesPrefix) + NewStoreId() + std::string(store::kFeaturesSuffix);
}

Result<std::unique_ptr<FeatureIndexWriter>> FeatureIndexWriter::Create(const std::string& path) {
  GDALAllRegister();
  std::error_code error;
  std::filesystem::remove(path, error);
  const GdalErrors errors;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("SQLite");
  CPLStringList options(std::vector<const char*>{"SPATIALITE=YES", "INIT_WITH_EPSG=NO", nullptr}.data());
  GDALDataset* file = driver == nullptr ? nullptr : driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, options.List());
  if (file == nullptr) return Status::Error("{}: the index of features cannot be made: {}", path, errors.first());
  return std::unique_ptr<FeatureIndexWriter>(new FeatureIndexWriter(path, file));
}

FeatureIndexWriter::~FeatureIndexWriter() {
  if (file_ != nullptr) GDALClose(file_);
}

Status FeatureIndexWriter::Add(const std::string& layer, std::span<const Feature> features) {
  const GdalErrors errors;
  OGRSpatialReference geographic;
  geographic.importFromEPSG(4326);
  geographic.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  CPLStringList options(std::vector<const char*>{"LAUNDER=NO", "GEOMETRY_NAME=geometry", "FID=rowid_", nullptr}.data());
  OGRLayer* table = file_->CreateLayer(layer.c_str(), &geographic, wkbUnknown, options.List());
  const auto failed = [&] {
    return Status::Error(
        "{}: the index of layer {} cannot be written: {}; see that there is space, and no other layer of a like name",
        path_, layer, errors.first());
  };
  if (table == nullptr) return failed();
  OGRFieldDefn of("class", OFTString), name("name", OFTString), importance("importance", OFTReal),
      attributes("attributes", OFTString);
  for (OGRFieldDefn* field : {&of, &name, &importance, &attributes}) {
    if (table->CreateField(field) != OGRERR_NONE) return failed();
  }
  if (file_->StartTransaction() != OGRERR_NONE) return failed();
  for (const Feature& feature : features) {
    OGRFeature row(table->GetLayerDefn());
    row.SetFID(feature.id);
    row.SetField(0, std::string(FeatureClassName(feature.of)).c_str());
    for (const auto& [key, value] : feature.attributes) {
      if (const auto* text = std::get_if<std::string>(&value); key == "name" && text != nullptr)
        row.SetField(1, text->c_str());
    }
    row.SetField(2, feature.importance);
    row.SetField(3, AttributesJson(feature).dump(-1, ' ', false, json::error_handler_t::replace).c_str());
    row.SetGeometryDirectly(GeometryOf(feature).release());
    if (table->CreateFeature(&row) != OGRERR_NONE) return failed();
  }
  if (file_->CommitTransaction() != OGRERR_NONE) return failed();
  return {};
}

Status FeatureIndexWriter::Close() {
  const GdalErrors errors;
  GDALClose(std::exchange(file_, nullptr));
  if (!errors.any()) return {};
  return Status::Error("{}: the index of features cannot be written: {}; free some space and build again", path_,
                       errors.first());
}

Result<int64_t> QueryFeatures(const Dataset& dataset, const FeatureQuery& query,
                              const std::function<void(const std::string&)>& found) {
  std::vector<std::string> layers;
  for (const LayerRecord& layer : dataset.layers()) {
    if (layer.kind == LayerKind::kVector && (query.layer.empty() || query.layer == layer.name))
      layers.push_back(layer.name);
  }
  if (layers.empty())
    return query.layer.empty() ? Status::Error("{}: it has no vector layer", dataset.path())
                               : Status::Error("{}: it has no vector layer {}; belvedere-build info lists them",
                                               dataset.path(), query.layer);
  GDALAllRegister();
  const GdalErrors errors;
  const std::unique_ptr<GDALDataset> file(
      GDALDataset::Open(dataset.features_path().c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
  if (!file)
    return Status::Error("{}: the index of features {} cannot be read: {}; build it again", dataset.path(),
                         dataset.features_path(), errors.first());
  std::vector<Answer> answers;
  for (const std::string& layer : layers) {
    const std::unique_ptr<OGRLayer, ResultCloser> rows(
        file->ExecuteSQL(QuestionTo(layer, query).c_str(), nullptr, nullptr), ResultCloser{file.get()});
    if (!rows || errors.any())
      return Status::Error("{}: layer {} cannot be asked: {}", dataset.path(), layer, errors.first());
    for (OGRFeatureUniquePtr row(rows->GetNextFeature()); row; row.reset(rows->GetNextFeature()))
      answers.push_back(AnswerOf(layer, *row, query.near.has_value()));
  }
  std::stable_sort(answers.begin(), answers.end(), [](const Answer& a, const Answer& b) { return a.order < b.order; });
  const auto count = std::min(static_cast<int64_t>(answers.size()), query.limit);
  for (int64_t i = 0; i < count; ++i) found(answers[static_cast<size_t>(i)].line);
  return count;
}

}  // namespace belvedere
