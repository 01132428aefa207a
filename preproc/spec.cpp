#include "preproc/spec.h"

#include "preproc/source_path.h"
#include "preproc/spec_reader.h"
#include "runtime/base/iso_time.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

namespace belvedere {
namespace {

class Parser : private SpecReader {
 public:
  explicit Parser(const std::string& path) : SpecReader(path) {}

  Result<BuildSpec> Parse(const toml::table& root) {
    if (Status status = CheckKeys(root, {"layer", "type"}); !status.ok()) return status;
    if (Status status = types_.Add(root, file()); !status.ok()) return status;
    BuildSpec spec;
    spec.path = file();
    const toml::array* layers = root["layer"].as_array();
    if (layers == nullptr || layers->empty()) {
      return Status::Error("{}: no layer: write [[layer]] with a name, a kind and its sources", file());
    }
    std::set<std::string> names;
    for (const toml::node& node : *layers) {
      auto steps = ParseLayer(node, spec.layers);
      if (!steps.ok()) return steps.status();
      const LayerSpec& first = steps->front();
      bool taken = first.step && !names.insert(first.step->layer).second;
      for (LayerSpec& step : *steps) {
        taken |= !names.insert(step.name).second;
        if (taken) return Error(node, "two layers are named \"{}\"", step.step ? step.step->layer : step.name);
        spec.layers.push_back(std::move(step));
      }
    }
    if (spec.layers.size() > static_cast<size_t>(kMaxDatasetLayers)) {
      return Status::Error("{}: {} layers, each time of a layer counted, at most {} fit a dataset", file(),
                           spec.layers.size(), kMaxDatasetLayers);
    }
    return spec;
  }

 private:
  // A layer, or all its steps.
  Result<std::vector<LayerSpec>> ParseLayer(const toml::node& node, const std::vector<LayerSpec>& before) const {
    const toml::table* table = node.as_table();
    if (table == nullptr) return Error(node, "\"layer\" must be a table: write [[layer]]");
    if (Status status = CheckKeys(*table, {"name", "kind", "source", "repeats", "priority", "of"}); !status.ok())
      return status;
    LayerSpec layer;
    auto name = String(*table, "name");
    if (!name.ok()) return name.status();
    layer.name = std::move(*name);
    if (layer.name.empty()) return Error(*table, "\"name\" is empty");
    const auto kind = String(*table, "kind");
    if (!kind.ok()) return kind.status();
    const DeclaredType* type = types_.Find(*kind);
    if (type == nullptr) {
      return Error(*table->get("kind"),
                   "\"kind\" must be \"elevation\", \"imagery\", \"vector\" or another data type; there is no \"{}\"",
                   *kind);
    }
    layer.kind = KindOf(type->meta);
    if (!type->parent.empty()) return ParseDerived(*table, std::move(layer), *type, before);
    if (const toml::node* of = table->get("of"))
      return Error(*of, "\"of\" means nothing for {}, made of sources", *kind);
    for (const std::string_view key : {"priority", "repeats"}) {
      const toml::node* unwanted = table->get(key);
      if (unwanted != nullptr && layer.kind == LayerKind::kVector)
        return Error(*unwanted, "\"{}\" means nothing for vectors", key);
    }
    if (Status status = ParsePriority(*table, layer); !status.ok()) return status;
    const toml::array* sources = (*table)["source"].as_array();
    if (sources == nullptr || sources->empty()) {
      return Error(*table, "layer \"{}\" has no source: write [[layer.source]] with a path", layer.name);
    }
    for (const toml::node& source_node : *sources) {
      auto source =
          layer.kind == LayerKind::kVector ? ParseVectorSource(source_node) : ParseSource(source_node, layer.kind);
      if (!source.ok()) return source.status();
      layer.sources.push_back(std::move(*source));
    }
    const auto repeats = ParseRepeats(*table, layer);
    if (!repeats.ok()) return repeats.status();
    return StepsOf(std::move(layer), *repeats);
  }

  Result<std::vector<LayerSpec>> ParseDerived(const toml::table& table, LayerSpec layer, const DeclaredType& type,
                                              const std::vector<LayerSpec>& before) const {
    for (const std::string_view key : {"source", "repeats", "priority"}) {
      if (const toml::node* node = table.get(key))
        return Error(*node, "\"{}\" means nothing for {}, which is made of the pages of {}", key, type.name,
                     type.parent);
    }
    const auto named = String(table, "of", "");
    if (!named.ok()) return named.status();
    const std::string& of = *named;
    for (const LayerSpec& other : before) {
      if (TypeOf(other) != type.parent || other.step || (!of.empty() && other.name != of)) continue;
      layer.derived = {type, other.name};
      return std::vector<LayerSpec>{std::move(layer)};
    }
    const bool is_here =
        std::any_of(before.begin(), before.end(), [&](const LayerSpec& other) { return other.name == of; });
    if (of.empty() || is_here) {
      return Error(table, "layer \"{}\" is made of a layer of type \"{}\"{}, and none stands before it", layer.name,
                   type.parent, of.empty() ? "" : " named \"" + of + "\"");
    }
    layer.derived = {type, of};  // of the dataset that this is added to
    return std::vector<LayerSpec>{std::move(layer)};
  }

  Status ParsePriority(const toml::table& table, LayerSpec& layer) const {
    const toml::node* node = table.get("priority");
    if (node == nullptr) return {};
    const auto priority = String(table, "priority");
    if (!priority.ok()) return priority.status();
    if (*priority != "order" && *priority != "resolution") {
      return Error(*node, "\"priority\" must be \"order\" or \"resolution\", here it is \"{}\"", *priority);
    }
    layer.priority = *priority == "order" ? Priority::kOrder : Priority::kResolution;
    return {};
  }

  Result<Repeats> ParseRepeats(const toml::table& table, const LayerSpec& layer) const {
    const toml::node* node = table.get("repeats");
    if (node == nullptr) return Repeats::kNever;
    const auto repeats = String(table, "repeats");
    if (!repeats.ok()) return repeats.status();
    if (*repeats != "year") return Error(*node, "\"repeats\" must be \"year\", here it is \"{}\"", *repeats);
    std::optional<double> first_s;
    for (const SourceSpec& source : layer.sources) {
      if (!source.utc_s) continue;
      if (!first_s) first_s = source.utc_s;
      if (YearOf(*first_s) == YearOf(*source.utc_s)) continue;
      return Error(*node, "what repeats every year has all its times in one year, here {} and {}",
                   FormatIsoTime(*first_s), FormatIsoTime(*source.utc_s));
    }
    if (!first_s) return Error(*node, "\"repeats\" needs sources with a \"time\", layer \"{}\" has none", layer.name);
    return Repeats::kEveryYear;
  }

  Result<SourceSpec> ParseSource(const toml::node& node, LayerKind kind) const {
    const toml::table* table = node.as_table();
    if (table == nullptr) return Error(node, "\"source\" must be a table: write [[layer.source]]");
    if (Status status = CheckKeys(*table, {"path", "zoom", "extent", "nodata", "crs", "georeference", "unit", "datum",
                                           "feather_m", "time", "match_colour"});
        !status.ok()) {
      return status;
    }
    SourceSpec source;
    auto written = String(*table, "path");
    if (!written.ok()) return written.status();
    source.written_path = std::move(*written);
    const auto zoom = ParseZoom(*table, source.written_path);
    if (!zoom.ok()) return zoom.status();
    source.path = ResolveSourcePath(source.written_path, std::filesystem::path(file()).parent_path().string(), *zoom);
    if (Status status = ParseExtent(*table, source); !status.ok()) return status;
    if (const toml::node* nodata = table->get("nodata")) {
      const auto value = Number(*nodata, "nodata");
      if (!value.ok()) return value.status();
      source.nodata = *value;
    }
    if (const toml::node* feather = table->get("feather_m")) {
      const auto value = Number(*feather, "feather_m");
      if (!value.ok()) return value.status();
      if (!(*value >= 0)) return Error(*feather, "\"feather_m\" must not be negative");
      source.feather_m = *value;
    }
    if (table->contains("crs")) {
      auto crs = String(*table, "crs");
      if (!crs.ok()) return crs.status();
      source.crs = std::move(*crs);
    }
    if (Status status = ParseGeoreference(*table, source); !status.ok()) return status;
    if (Status status = ParseHeightKeys(*table, kind, source); !status.ok()) return status;
    if (Status status = ParseTime(*table, kind, source); !status.ok()) return status;
    if (Status status = ParseMatchColour(*table, kind, source); !status.ok()) return status;
    return source;
  }

  Result<SourceSpec> ParseVectorSource(const toml::node& node) const {
    const toml::table* table = node.as_table();
    if (table == nullptr) return Error(node, "\"source\" must be a table: write [[layer.source]]");
    Status status = CheckKeys(*table, {"path", "crs", "features", "table", "where", "importance", "resolution_m",
                                       "fields", "corrects", "width_m"});
    SourceSpec source;
    FeatureSelection selection;
    std::string of, crs;
    const auto take = [&](const char* key, std::string& text, bool is_needed) {
      if (!status.ok()) return;
      auto read = is_needed ? String(*table, key) : String(*table, key, "");
      status = read.status();
      if (read.ok()) text = std::move(*read);
    };
    take("path", source.written_path, true);
    take("features", of, true);
    take("crs", crs, false);
    take("table", selection.table, false);
    take("where", selection.where, false);
    take("importance", selection.importance, false);
    take("corrects", selection.corrects, false);
    if (!status.ok()) return status;
    const auto known = FeatureClassOf(of);
    if (!known)
      return Error(*table->get("features"), "\"features\" must be one of {}, here it is \"{}\"", FeatureClasses(), of);
    selection.of = *known;
    const auto resolution = Number(*table, "resolution_m", selection.resolution_m);
    if (!resolution.ok()) return resolution.status();
    if (!(*resolution > 0)) return Error(*table->get("resolution_m"), "\"resolution_m\" must be more than 0");
    selection.resolution_m = *resolution;
    const auto width = Number(*table, "width_m", 0);
    if (!width.ok()) return width.status();
    selection.width_m = *width;
    if (selection.corrects.empty() != !table->contains("width_m"))
      return Error(*table,
                   "\"corrects\" names an elevation layer, and \"width_m\" how wide lines are: one needs the other");
    if (!selection.corrects.empty() && !(*width > 0))
      return Error(*table->get("width_m"), "\"width_m\" must be more than 0");
    if (status = ParseFields(*table, selection); !status.ok()) return status;
    if (!crs.empty()) source.crs = std::move(crs);
    source.path = ResolveSourcePath(source.written_path, std::filesystem::path(file()).parent_path().string(), {});
    source.features = std::move(selection);
    return source;
  }

  static std::string FeatureClasses() {
    std::string names;
    for (int i = 0; i < kFeatureClasses; ++i)
      names += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", FeatureClassName(static_cast<FeatureClass>(i)));
    return names;
  }

  Status ParseFields(const toml::table& table, FeatureSelection& selection) const {
    const toml::node* node = table.get("fields");
    if (node == nullptr) return {};
    const toml::table* fields = node->as_table();
    if (fields == nullptr || fields->empty())
      return Error(*node, "\"fields\" must name some: {{ height = \"BLDG_HT\", name = \"STREET\" }}");
    for (const auto& [key, value] : *fields) {
      const auto field = value.value_exact<std::string>();
      if (!field)
        return Error(value, "\"{}\" must be the name of a field, here it is {}", key.str(), TomlTypeName(value));
      selection.fields[std::string(key.str())] = *field;
    }
    return {};
  }

  Result<std::optional<int>> ParseZoom(const toml::table& table, const std::string& path) const {
    constexpr int64_t kFinestZoom = 24;
    const toml::node* node = table.get("zoom");
    if (!IsTileTemplate(path)) {
      if (node != nullptr) return Error(*node, "\"zoom\" is of tiles alone: a path with {{z}}, {{x}} and {{y}}");
      return std::optional<int>();
    }
    const auto zoom = node == nullptr ? std::nullopt : node->value_exact<int64_t>();
    if (zoom && *zoom >= 0 && *zoom <= kFinestZoom) return std::optional<int>(static_cast<int>(*zoom));
    return Error(node == nullptr ? *table.get("path") : *node,
                 "tiles need a \"zoom\", the level that is read: a whole number from 0 to {}", kFinestZoom);
  }

  Status ParseExtent(const toml::table& table, SourceSpec& source) const {
    const toml::node* node = table.get("extent");
    if (node == nullptr) return {};
    if (!IsTileTemplate(source.written_path))
      return Error(*node, "\"extent\" is of tiles alone: a path with {{z}}, {{x}} and {{y}}");
    const auto numbers = Numbers(*node, "extent");
    if (!numbers.ok()) return numbers.status();
    if (numbers->size() != 4) return Error(*node, "\"extent\" must be [west, south, east, north] in degrees");
    source.extent = GeoBox{(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
    const GeoBox& box = *source.extent;
    if (!(box.west_deg >= -180 && box.west_deg < box.east_deg && box.east_deg <= 180 && box.south_deg >= -90 &&
          box.south_deg < box.north_deg && box.north_deg <= 90)) {
      return Error(*node, "\"extent\" needs west < east, from -180 to 180, and south < north, from -90 to 90");
    }
    return {};
  }

  Status ParseMatchColour(const toml::table& table, LayerKind kind, SourceSpec& source) const {
    const toml::node* node = table.get("match_colour");
    if (node == nullptr) return {};
    if (kind == LayerKind::kElevation) return Error(*node, "\"match_colour\" means nothing for elevation");
    const auto value = node->value_exact<bool>();
    if (!value) return Error(*node, "\"match_colour\" must be true or false, here it is {}", TomlTypeName(*node));
    source.match_colour = *value;
    return {};
  }

  Status ParseTime(const toml::table& table, LayerKind kind, SourceSpec& source) const {
    const toml::node* node = table.get("time");
    if (node == nullptr) return {};
    if (kind == LayerKind::kElevation) return Error(*node, "\"time\" means nothing for elevation");
    const auto text = String(table, "time");
    if (!text.ok()) return text.status();
    source.utc_s = ParseIsoTime(*text);
    if (!source.utc_s) {
      return Error(*node, "\"time\" must be a time like \"2004-01-01T00:00:00Z\", here it is \"{}\"", *text);
    }
    source.utc_s = std::floor(*source.utc_s);
    return {};
  }

  Status ParseGeoreference(const toml::table& table, SourceSpec& source) const {
    const toml::node* node = table.get("georeference");
    if (node == nullptr) return {};
    const auto found = Numbers(*node, "georeference");
    if (!found.ok()) return found.status();
    if (found->size() != 4 && found->size() != 6) {
      return Error(*node,
                   "\"georeference\" must be [west, south, east, north] in degrees or a geotransform of 6 numbers");
    }
    std::array<double, 6> numbers{};
    std::copy(found->begin(), found->end(), numbers.begin());
    if (found->size() == 6) {
      source.geotransform = numbers;
      return {};
    }
    source.box = GeoBox{numbers[0], numbers[1], numbers[2], numbers[3]};
    if (!(numbers[2] > numbers[0]) || !(numbers[3] > numbers[1])) {
      return Error(*node, "\"georeference\" needs west < east and south < north");
    }
    return {};
  }

  Status ParseHeightKeys(const toml::table& table, LayerKind kind, SourceSpec& source) const {
    if (kind == LayerKind::kImagery) {
      for (const std::string_view key : {"unit", "datum"}) {
        if (const toml::node* node = table.get(key)) return Error(*node, "\"{}\" means nothing for imagery", key);
      }
      return {};
    }
    if (const toml::node* node = table.get("unit")) {
      const auto unit = String(table, "unit");
      if (!unit.ok()) return unit.status();
      static constexpr std::pair<std::string_view, double> kUnits[] = {
          {"m", 1.0}, {"ft", 0.3048}, {"us-ft", 1200.0 / 3937.0}, {"cm", 0.01}};
      for (const auto& [name, metres] : kUnits) {
        if (*unit == name) source.metres_per_unit = metres;
      }
      if (!source.metres_per_unit) return Error(*node, "\"unit\" must be \"m\", \"ft\", \"us-ft\" or \"cm\"");
    }
    const toml::node* datum = table.get("datum");
    if (datum == nullptr) return {};
    if (datum->is_integer() || datum->is_floating_point()) {
      source.datum = VerticalDatum::kOffset;
      source.datum_m = datum->value<double>().value_or(0);
      return {};
    }
    const auto name = datum->value_exact<std::string>();
    if (name && (*name == "egm96" || *name == "ellipsoid")) {
      source.datum = *name == "egm96" ? VerticalDatum::kEgm96 : VerticalDatum::kEllipsoid;
      return {};
    }
    source.datum = VerticalDatum::kGrid;
    if (name && name->starts_with("EPSG:")) {
      source.datum_grid = *name;
      return {};
    }
    if (!name || name->find('.') == std::string::npos) {
      return Error(*datum,
                   "\"datum\" must be \"egm96\", \"ellipsoid\", a number of metres above the ellipsoid, a vertical CRS "
                   "like \"EPSG:3855\" or the file of a geoid grid");
    }
    source.datum_grid = (std::filesystem::path(file()).parent_path() / *name).string();
    return {};
  }

  DeclaredTypes types_ = DeclaredTypes::Stock();
};

}  // namespace

std::string NameOf(const SourceSpec& source) {
  return source.tiles.empty() ? source.written_path : source.written_path + " (" + source.tiles + ")";
}

std::string_view TypeOf(const LayerSpec& layer) {
  return layer.derived ? std::string_view(layer.derived->type.name) : LayerKindName(layer.kind);
}

bool IsMadeOf(const LayerSpec& layer, const LayerSpec& other) {
  return layer.derived && layer.derived->of == other.name && layer.derived->type.parent == TypeOf(other);
}

std::vector<LayerSpec> StepsOf(LayerSpec layer, Repeats repeats) {
  std::set<double> times;
  for (const SourceSpec& source : layer.sources) {
    if (source.utc_s) times.insert(*source.utc_s);
  }
  std::vector<LayerSpec> steps;
  if (times.empty()) {
    steps.push_back(std::move(layer));
    return steps;
  }
  for (const double utc_s : times) {
    LayerSpec step{layer.name + "@" + FormatIsoTime(utc_s), layer.kind,     {},
                   StepOf{layer.name, utc_s, repeats},      layer.priority, {}};
    for (const bool timed : {false, true}) {
      for (const SourceSpec& source : layer.sources) {
        if (timed ? source.utc_s == utc_s : !source.utc_s) step.sources.push_back(source);
      }
    }
    steps.push_back(std::move(step));
  }
  return steps;
}

Result<BuildSpec> ParseSpec(std::string_view text, const std::string& path) {
  try {
    return Parser(path).Parse(toml::parse(text, path));
  } catch (const toml::parse_error& problem) {
    return Status::Error("{}:{}: {}", path, problem.source().begin.line, problem.description());
  }
}

Result<BuildSpec> LoadSpec(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) return Status::Error("{}: cannot read the spec", path);
  return ParseSpec(text.str(), path);
}

}  // namespace belvedere
