#include "preproc/report.h"

#include "runtime/base/iso_time.h"
#include "runtime/paging/building_page.h"
#include "runtime/paging/dataset_store.h"
#include "runtime/paging/page_codec.h"
#include "runtime/paging/vector_page.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace belvedere {
namespace {

using nlohmann::json;

json RemarksJson(const std::vector<SourceRemark>& remarks) {
  json out = json::array();
  for (const auto& remark : remarks) out.push_back({{"source", remark.source}, {"reason", remark.reason}});
  return out;
}

json SourceJson(const SourceRecord& source) {
  json out = {{"path", source.path},
              {"crs", source.crs},
              {"finest_level", source.finest_level},
              {"extent_deg",
               {source.extent.west_deg, source.extent.south_deg, source.extent.east_deg, source.extent.north_deg}}};
  if (source.nodata) out["nodata"] = *source.nodata;
  if (!source.datum.empty()) out["datum"] = source.datum;
  if (source.utc_s) out["time"] = FormatIsoTime(*source.utc_s);
  if (source.colour_fit) out["colour_fit"] = {{"gain", source.colour_fit->gain}, {"offset", source.colour_fit->offset}};
  return out;
}

json LayerJson(const LayerRecord& layer) {
  json out = {{"name", layer.name},
              {"kind", LayerKindName(layer.kind)},
              {"levels", layer.max_level + 1},
              {"pages", layer.pages}};
  if (layer.derivation) out["made_of"] = {{"type", layer.derivation->type}, {"layer", layer.derivation->of}};
  if (layer.property && !layer.property->classes.empty()) {
    for (const PropertyClass& one : layer.property->classes) out["classes"].push_back(one.name);
  } else if (layer.property) {
    out["numbers"] = {
        {"offset", layer.property->offset}, {"gain", layer.property->gain}, {"unit", layer.property->unit}};
  }
  if (layer.step) {
    out["step_of"] = layer.step->layer;
    out["time"] = FormatIsoTime(layer.step->utc_s);
    if (layer.step->repeats == Repeats::kEveryYear) out["repeats"] = "year";
  }
  return out;
}

// "classes: 0 land, 1 water", or "numbers: 0 + 0.5 * byte, deg"
std::string MeaningOf(const PropertyRecord& property) {
  if (property.classes.empty())
    return fmt::format("numbers: {:.6g} + {:.6g} * byte{}{}{}", property.offset, property.gain,
                       property.unit.empty() ? "" : ", ", property.unit,
                       property.channels > 1 ? fmt::format(", {} channels", property.channels) : "");
  std::string text = "classes:";
  for (size_t i = 0; i < property.classes.size(); ++i)
    text += fmt::format("{} {} {}", i == 0 ? "" : ",", i, property.classes[i].name);
  return text;
}

// "from 2004-01-01T00:00:00Z on, every year"
std::string SpanOf(const StepOf& step) {
  return fmt::format("step of layer {}, from {} on{}", step.layer, FormatIsoTime(step.utc_s),
                     step.repeats == Repeats::kEveryYear ? ", every year" : "");
}

// Posts on the east and north border are those of the neighbours there, where these exist.
void CompareBorders(const Dataset& dataset, int layer, Quadcode node, const ElevationPage& page, Verification& out) {
  const int level = node.level();
  const int64_t rows = int64_t{kTreeRows} << level;
  const auto compare = [&](int64_t column, int64_t row, bool east) {
    if (row >= rows) return;
    const Quadcode neighbour = Quadcode::FromColumnRow(level, column, row);
    // Where rows change their width the filters of the two do too.
    if (!dataset.Exists(layer, neighbour) || neighbour.Doublings() != node.Doublings()) return;
    const auto other = dataset.ReadElevation(layer, neighbour);
    if (!other.ok()) return;  // reported where it is read for itself
    for (int i = 0; i < kPosts; ++i) {
      const int32_t own = east ? page.at(kCells, i) : page.at(i, kCells);
      const int32_t theirs = east ? (*other)->at(0, i) : (*other)->at(i, 0);
      if (own == theirs) continue;
      out.problems.push_back(fmt::format("layer {}: quadnodes {} and {} differ on the border they share",
                                         dataset.layers()[static_cast<size_t>(layer)].name, node.ToString(),
                                         neighbour.ToString()));
      return;
    }
  };
  compare(node.column() + 1, node.row(), true);
  compare(node.column(), node.row() + 1, false);
}

void VerifyNode(const Dataset& dataset, int layer, Quadcode node, Verification& out) {
  const LayerRecord& record = dataset.layers()[static_cast<size_t>(layer)];
  ++out.pages;
  out.digest = Crc32c(dataset.ReadRaw(layer, node).value_or(std::vector<uint8_t>()),
                      Crc32c(store::MakeKey(layer, node.word()), out.digest));
  if (!node.is_root()) {
    if (!dataset.Exists(layer, node.Parent())) {
      out.problems.push_back(fmt::format("layer {}: quadnode {} has no parent", record.name, node.ToString()));
    }
    for (const int which : node.Parent().Children()) {
      if (dataset.Exists(layer, node.Parent().Child(which))) continue;
      out.problems.push_back(fmt::format("layer {}: quadnode {} lacks a sibling", record.name, node.ToString()));
      break;
    }
  }
  if (record.kind == LayerKind::kImagery) {
    if (const auto page = dataset.ReadImage(layer, node); !page.ok()) out.problems.push_back(page.message());
    return;
  }
  if (record.kind == LayerKind::kVector) {
    const auto features = dataset.ReadVector(layer, node);
    if (!features.ok())
      out.problems.push_back(features.message());
    else if ((*features)->is_complete == dataset.HasChildren(layer, node))
      out.problems.push_back(
          fmt::format("layer {}: quadnode {} is {}", record.name, node.ToString(),
                      (*features)->is_complete ? "complete and has children" : "incomplete and has none"));
    return;
  }
  if (record.kind == LayerKind::kModel) {
    if (const auto buildings = dataset.ReadBuildings(layer, node); !buildings.ok())
      out.problems.push_back(buildings.message());
    return;
  }
  if (record.kind == LayerKind::kProperty) {
    const auto property = dataset.ReadProperty(layer, node);
    if (!property.ok())
      out.problems.push_back(property.message());
    else if ((*property)->channels != record.property->channels)
      out.problems.push_back(
          fmt::format("layer {}: quadnode {} has {} channels", record.name, node.ToString(), (*property)->channels));
    return;
  }
  const auto page = dataset.ReadElevation(layer, node);
  if (!page.ok()) {
    out.problems.push_back(page.message());
    return;
  }
  CompareBorders(dataset, layer, node, **page, out);
}

}  // namespace

std::string FitText(const ColourFit& fit) {
  return fmt::format("times {:.3f}, {:.3f}, {:.3f} plus {:.1f}, {:.1f}, {:.1f}", fit.gain[0], fit.gain[1], fit.gain[2],
                     fit.offset[0], fit.offset[1], fit.offset[2]);
}

std::string BuildReportJson(const BuildReport& report) {
  json layers = json::array();
  for (const auto& layer : report.layers) layers.push_back(LayerJson(layer));
  json out = {{"seconds", report.seconds},
              {"pages", report.pages},
              {"resumed", report.resumed},
              {"bytes", report.bytes},
              {"bytes_read", report.bytes_read},
              {"layers", layers},
              {"skipped", RemarksJson(report.skipped)},
              {"warnings", RemarksJson(report.warnings)}};
  if (report.is_change) {
    out["written"] = report.written;
    out["removed"] = report.removed;
  }
  return out.dump(2);
}

std::string BuildReportLine(const BuildReport& report) {
  const double seconds = std::max(report.seconds, 1e-3);
  if (report.is_change) {
    if (report.written + report.removed == 0) return fmt::format("{} pages, of which none has changed", report.pages);
    return fmt::format("{} pages, of which {} are new or changed, and {} are gone, in {:.1f} s", report.pages,
                       report.written, report.removed, report.seconds);
  }
  if (report.shard) {
    if (report.pages == report.resumed)
      return fmt::format("shard {} of {} is whole already: {} pages", report.shard->number, report.shard->of,
                         report.pages);
    return fmt::format("shard {} of {} is whole: {} pages in {:.1f} s", report.shard->number, report.shard->of,
                       report.pages, report.seconds);
  }
  const std::string resumed =
      report.resumed == 0 ? ""
                          : fmt::format(" ({} of them taken over from the build that was interrupted)", report.resumed);
  return fmt::format(
      "{} pages{}, {:.1f} MB in {:.1f} s: {:.0f} pages/s, {:.1f} MB/s written, {:.1f} MB/s of source pixels",
      report.pages, resumed, static_cast<double>(report.bytes) / 1e6, report.seconds,
      static_cast<double>(report.pages) / seconds, static_cast<double>(report.bytes) / 1e6 / seconds,
      static_cast<double>(report.bytes_read) / 1e6 / seconds);
}

std::string DescribeDataset(const Dataset& dataset) {
  std::string text = fmt::format("{}: dataset of version {}, built {}, {:.1f} MB\n", dataset.path(), dataset.version(),
                                 dataset.build_time(), static_cast<double>(dataset.bytes()) / 1e6);
  for (const LayerRecord& layer : dataset.layers()) {
    text += fmt::format("layer {} ({}): {} pages, {:.1f} MB, levels 0 to {}\n", layer.name, LayerKindName(layer.kind),
                        layer.pages, static_cast<double>(layer.bytes) / 1e6, layer.max_level);
    if (layer.step) text += fmt::format("  {}\n", SpanOf(*layer.step));
    if (layer.derivation)
      text += fmt::format("  made of layer {}, type \"{}\"\n", layer.derivation->of, layer.derivation->type);
    if (layer.property) text += "  " + MeaningOf(*layer.property) + "\n";
    if (!layer.vertical_reference.empty()) text += fmt::format("  heights: {}\n", layer.vertical_reference);
    text += "  pages by level:";
    for (const int64_t pages : layer.pages_per_level) text += fmt::format(" {}", pages);
    text += "\n";
    for (const SourceRecord& source : layer.sources) {
      const std::string level = layer.kind == LayerKind::kVector ? "" : fmt::format("level {}, ", source.finest_level);
      text += fmt::format("  source {}: {}, {}west {:.6g} south {:.6g} east {:.6g} north {:.6g}{}{}\n", source.path,
                          source.crs, level, source.extent.west_deg, source.extent.south_deg, source.extent.east_deg,
                          source.extent.north_deg, source.utc_s ? ", time " + FormatIsoTime(*source.utc_s) : "",
                          source.colour_fit ? ", colours " + FitText(*source.colour_fit) : "");
    }
  }
  return text;
}

std::string DescribeDatasetJson(const Dataset& dataset) {
  json layers = json::array();
  int64_t pages = 0;
  for (const LayerRecord& layer : dataset.layers()) {
    json entry = LayerJson(layer);
    entry["max_level"] = layer.max_level;
    entry["pages_per_level"] = layer.pages_per_level;
    entry["bytes"] = layer.bytes;
    if (!layer.vertical_reference.empty()) entry["vertical_reference"] = layer.vertical_reference;
    entry["sources"] = json::array();
    for (const auto& source : layer.sources) entry["sources"].push_back(SourceJson(source));
    pages += layer.pages;
    layers.push_back(std::move(entry));
  }
  json out = {{"version", dataset.version()},
              {"build_time", dataset.build_time()},
              {"bytes", dataset.bytes()},
              {"pages", pages},
              {"layers", layers}};
  if (!dataset.features_path().empty()) out["features"] = dataset.features_path();
  return out.dump(2);
}

Verification VerifyDataset(const Dataset& dataset) {
  Verification out;
  for (size_t layer = 0; layer < dataset.layers().size(); ++layer) {
    const int number = static_cast<int>(layer);
    for (int tree = 0; tree < kTrees; ++tree) {
      if (dataset.Exists(number, Quadcode::Root(tree))) continue;
      out.problems.push_back(fmt::format("layer {}: quadtree {} has no root", dataset.layers()[layer].name, tree));
    }
    for (const uint64_t word : dataset.Nodes(number)) VerifyNode(dataset, number, *Quadcode::FromWord(word), out);
  }
  return out;
}

}  // namespace belvedere
