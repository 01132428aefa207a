#include "preproc/types/process_modules.h"

#include "preproc/types/surface_properties.h"

#include <algorithm>

namespace belvedere {
namespace {

double SettingOr(const ModuleSettings& settings, const std::string& key, double value) {
  const auto found = settings.find(key);
  return found == settings.end() || found->second.empty() ? value : found->second[0];
}

Status Classify(const ModuleSettings& settings, const ModuleContext&, PageFlow& flow) {
  const std::vector<double>& limits = settings.at("limits");
  const double offset = SettingOr(settings, "offset", 0), gain = SettingOr(settings, "gain", 0.5);
  std::array<uint8_t, 256> classes{};
  for (size_t byte = 0; byte < classes.size(); ++byte) {
    const double value = offset + gain * static_cast<double>(byte);
    classes[byte] =
        static_cast<uint8_t>(std::count_if(limits.begin(), limits.end(), [=](double limit) { return value >= limit; }));
  }
  auto& page = *flow.property;
  page.values.resize(page.values.size() / static_cast<size_t>(page.channels));
  page.channels = 1;
  for (uint8_t& value : page.values) value = classes[value];
  return {};
}

template <typename Make>
ProcessModule OfHeights(const char* name, Make make) {
  return {name,
          MetaType::kHeightField,
          MetaType::kSurfaceProperty,
          {},
          [make](const ModuleSettings&, const ModuleContext& context, PageFlow& flow) {
            flow.property = make(*flow.heights, flow.node, context.sea);
            return Status();
          }};
}

}  // namespace

ProcessModules& ProcessModules::Stock() {
  static ProcessModules modules = [] {
    ProcessModules stock;
    const auto plain = [](auto make) {
      return [make](const ElevationPage& page, Quadcode node, const Geoid&) { return make(page, node); };
    };
    for (ProcessModule& module : std::vector<ProcessModule>{
             OfHeights("slope", plain(SlopeAngles)),
             OfHeights("normals", plain(NormalMap)),
             OfHeights("roughness", plain(Roughness)),
             OfHeights("water", WaterMask),
             {"classes", MetaType::kSurfaceProperty, MetaType::kSurfaceProperty, {"limits"}, Classify}}) {
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
  return std::nullopt;
}

Status CheckModules(const DeclaredType& type, const DeclaredType* parent) {
  const auto written = PagesOf(type.write);
  if (!written) return Status::Error("it has no writer \"{}\"", type.write);
  if (*written != type.meta) return Status::Error("\"{}\" are no {}", type.write, MetaTypeName(type.meta));
  if (parent == nullptr) {
    if (type.read != "raster sources" || !type.process.empty() || type.meta == MetaType::kSurfaceProperty)
      return Status::Error("a type without a parent reads \"raster sources\" and is a height field or an image");
    return {};
  }
  const auto read = PagesOf(type.read);
  if (!read || *read != parent->meta)
    return Status::Error("\"{}\" does not read its parent \"{}\", which is a {}", type.read, parent->name,
                         MetaTypeName(parent->meta));
  if (type.meta == MetaType::kHeightField) return Status::Error("heights are made of sources alone");
  MetaType flows = *read;
  for (const ModuleUse& use : type.process) {
    const ProcessModule* module = ProcessModules::Stock().Find(use.module);
    if (module == nullptr)
      return Status::Error("no module \"{}\"; there are {}", use.module, ProcessModules::Stock().names());
    if (module->takes != flows)
      return Status::Error("module \"{}\" takes a {}, and gets a {}", use.module, MetaTypeName(module->takes),
                           MetaTypeName(flows));
    for (const std::string& key : module->settings) {
      if (!use.settings.contains(key)) return Status::Error("module \"{}\" needs \"{}\"", use.module, key);
    }
    flows = module->gives;
  }
  if (flows == type.meta) return {};
  return Status::Error("\"{}\" gets a {}", type.write, MetaTypeName(flows));
}

}  // namespace belvedere
