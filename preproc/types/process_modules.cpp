#include "preproc/types/process_modules.h"

#include "preproc/types/surface_properties.h"
#include "preproc/vectors/buildings.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace belvedere {
namespace {

PropertyRecord Numbers(double offset, double gain, int channels = 1) {
  PropertyRecord record;
  record.channels = channels;
  record.offset = offset;
  record.gain = gain;
  return record;
}

Status Classify(const ModuleSettings& settings, const ModuleContext& context, PageFlow& flow) {
  const std::vector<double>& limits = settings.at("limits");
  std::array<uint8_t, 256> classes{};
  for (size_t byte = 0; byte < classes.size(); ++byte) {
    const double value = context.takes.offset + context.takes.gain * static_cast<double>(byte);
    classes[byte] =
        static_cast<uint8_t>(std::count_if(limits.begin(), limits.end(), [=](double limit) { return value >= limit; }));
  }
  auto& page = *flow.property;
  page.values.resize(page.values.size() / static_cast<size_t>(page.channels));
  page.channels = 1;
  for (uint8_t& value : page.values) value = classes[value];
  return {};
}

Status Raise(const ModuleSettings&, const ModuleContext&, PageFlow& flow) {
  flow.buildings = RaiseBuildings(*flow.features, flow.node);
  return {};
}

template <typename Make>
ProcessModule OfHeights(const char* name, const PropertyRecord& meaning, Make make) {
  return {name,
          MetaType::kHeightField,
          MetaType::kSurfaceProperty,
          {},
          [meaning](const PropertyRecord&) { return meaning; },
          [make](const ModuleSettings&, const ModuleContext& context, PageFlow& flow) {
            flow.property = make(*flow.heights, flow.node, context.sea);
            return Status();
          }};
}

bool IsSame(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

}  // namespace

ProcessModules& ProcessModules::Stock() {
  static ProcessModules modules = [] {
    ProcessModules stock;
    const auto plain = [](auto make) {
      return [make](const ElevationPage& page, Quadcode node, const Geoid&) { return make(page, node); };
    };
    const PropertyRecord classes = Numbers(0, 1);
    for (ProcessModule& module :
         std::vector<ProcessModule>{OfHeights("slope", Numbers(0, 1 / kSlopeSteps_deg), plain(SlopeAngles)),
                                    OfHeights("normals", Numbers(-1, 2.0 / 255, 3), plain(NormalMap)),
                                    OfHeights("roughness", Numbers(0, 1 / kRoughnessSteps_m), plain(Roughness)),
                                    OfHeights("water", classes, WaterMask),
                                    {"classes",
                                     MetaType::kSurfaceProperty,
                                     MetaType::kSurfaceProperty,
                                     {"limits"},
                                     [classes](const PropertyRecord&) { return classes; },
                                     Classify},
                                    {"raise", MetaType::kVector, MetaType::kModel, {}, {}, Raise}}) {
      BELVEDERE_CHECK(stock.Add(std::move(module)).ok());
    }
    return stock;
  }();
  return modules;
}

Status ProcessModules::Add(ProcessModule module) {
  if (Find(module.name) != nullptr) return Status::Error("a module \"{}\" is there already", module.name);
  modules_.push_back(std::move(module));
  return {};
}

const ProcessModule* ProcessModules::Find(std::string_view name) const {
  const auto found =
      std::find_if(modules_.begin(), modules_.end(), [&](const ProcessModule& module) { return module.name == name; });
  return found == modules_.end() ? nullptr : &*found;
}

std::string ProcessModules::names() const {
  std::string names;
  for (const ProcessModule& module : modules_) names += (names.empty() ? "\"" : ", \"") + module.name + "\"";
  return names;
}

std::optional<MetaType> PagesOf(std::string_view reader_or_writer) {
  if (reader_or_writer == "height pages") return MetaType::kHeightField;
  if (reader_or_writer == "image pages") return MetaType::kImage;
  if (reader_or_writer == "property pages") return MetaType::kSurfaceProperty;
  if (reader_or_writer == "vector pages") return MetaType::kVector;
  if (reader_or_writer == "model pages") return MetaType::kModel;
  return std::nullopt;
}

std::vector<PropertyRecord> MeaningsAlong(const DeclaredType& type, const PropertyRecord& parent) {
  std::vector<PropertyRecord> meanings;
  for (const ModuleUse& use : type.process) {
    const PropertyRecord& before = meanings.empty() ? parent : meanings.back();
    const ProcessModule& module = *ProcessModules::Stock().Find(use.module);
    meanings.push_back(module.meaning ? module.meaning(before) : before);
  }
  return meanings;
}

Status CheckModules(const DeclaredType& type) {
  const auto written = PagesOf(type.write);
  if (!written) return Status::Error("it has no writer \"{}\"", type.write);
  if (*written != type.meta)
    return Status::Error("\"{}\" are not of meta-type {}", type.write, MetaTypeName(type.meta));
  if (type.parent.empty()) {
    const bool of_rasters = type.meta == MetaType::kHeightField || type.meta == MetaType::kImage;
    const bool of_vectors = type.meta == MetaType::kVector;
    if (type.process.empty() &&
        ((of_rasters && type.read == "raster sources") || (of_vectors && type.read == "vector sources")))
      return {};
    return Status::Error(
        "a type without a parent reads \"raster sources\" and is a height field or an image, or reads \"vector "
        "sources\" and is a vector");
  }
  const auto read = PagesOf(type.read);
  if (!read) return Status::Error("it has no reader \"{}\"", type.read);
  if (type.meta == MetaType::kHeightField) return Status::Error("heights are made of sources alone");
  MetaType flows = *read;
  for (const ModuleUse& use : type.process) {
    const ProcessModule* module = ProcessModules::Stock().Find(use.module);
    if (module == nullptr)
      return Status::Error("no module \"{}\"; there are {}", use.module, ProcessModules::Stock().names());
    if (module->takes != flows)
      return Status::Error("module \"{}\" takes {}, and gets {}", use.module, MetaTypeName(module->takes),
                           MetaTypeName(flows));
    for (const std::string& key : module->settings) {
      if (!use.settings.contains(key)) return Status::Error("module \"{}\" needs \"{}\"", use.module, key);
    }
    for (const auto& [key, numbers] : use.settings) {
      if (std::find(module->settings.begin(), module->settings.end(), key) == module->settings.end())
        return Status::Error("module \"{}\" has no setting \"{}\"", use.module, key);
    }
    flows = module->gives;
  }
  if (flows == type.meta) return {};
  return Status::Error("\"{}\" gets {}", type.write, MetaTypeName(flows));
}

Status CheckParent(const DeclaredType& type, const DeclaredType& parent) {
  if (*PagesOf(type.read) != parent.meta)
    return Status::Error("\"{}\" does not read its parent \"{}\", of meta-type {}", type.read, parent.name,
                         MetaTypeName(parent.meta));
  if (type.meta != MetaType::kSurfaceProperty) return {};
  const std::vector<PropertyRecord> meanings = MeaningsAlong(type, parent.property);
  const PropertyRecord& given = meanings.empty() ? parent.property : meanings.back();
  if (given.channels != type.property.channels)
    return Status::Error("it is said to have {} channels, and its modules give {}", type.property.channels,
                         given.channels);
  const bool is_alike = IsSame(given.offset, type.property.offset) && IsSame(given.gain, type.property.gain);
  if (!type.property.classes.empty() || is_alike) return {};
  return Status::Error("a byte is said to be {} + {} * byte, and its modules give {} + {} * byte", type.property.offset,
                       type.property.gain, given.offset, given.gain);
}

}  // namespace belvedere
