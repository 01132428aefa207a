#include "servers/model_reader.h"

#include "servers/model_detail.h"

#include <OpenImageIO/imageio.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>

namespace belvedere {
namespace {

constexpr unsigned kMostVertices = 4'000'000;
constexpr size_t kMostStations = 256;

using Colour = std::array<float, 4>;

// Mean colour of an image file, 0..1; nullopt when it cannot be read.
std::optional<Colour> MeanOf(const std::string& path) {
  const std::unique_ptr<OIIO::ImageInput> image = OIIO::ImageInput::open(path);
  if (image == nullptr) return std::nullopt;
  const int channels = image->spec().nchannels;
  const auto pixels = static_cast<size_t>(image->spec().image_pixels());
  std::vector<float> values(pixels * static_cast<size_t>(channels));
  if (pixels == 0 || !image->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, values.data())) return std::nullopt;
  Colour mean{0, 0, 0, 1};
  for (size_t channel = 0; channel < 3; ++channel) {
    const auto from = std::min(channel, static_cast<size_t>(channels) - 1);  // grey images repeat their one channel
    double sum = 0;
    for (size_t pixel = 0; pixel < pixels; ++pixel)
      sum += static_cast<double>(values[pixel * static_cast<size_t>(channels) + from]);
    mean[channel] = static_cast<float>(sum / static_cast<double>(pixels));
  }
  return mean;
}

// glTF's factors are linear light; pages hold sRGB.
float SrgbFromLinear(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

Colour ColourOf(const aiMaterial& material, const std::filesystem::path& folder, bool linear) {
  Colour colour{1, 1, 1, 1};
  aiColor4D base(1, 1, 1, 1);
  if (material.Get(AI_MATKEY_BASE_COLOR, base) != aiReturn_SUCCESS) material.Get(AI_MATKEY_COLOR_DIFFUSE, base);
  colour = {base.r, base.g, base.b, 1};
  if (linear) std::transform(colour.begin(), colour.end(), colour.begin(), SrgbFromLinear);
  aiString texture;
  const bool textured = material.GetTexture(aiTextureType_BASE_COLOR, 0, &texture) == aiReturn_SUCCESS ||
                        material.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == aiReturn_SUCCESS;
  if (textured && texture.length > 0 && texture.C_Str()[0] != '*') {  // '*': inside the model file
    if (const std::optional<Colour> mean = MeanOf((folder / texture.C_Str()).string())) {
      for (size_t channel = 0; channel < 3; ++channel) colour[channel] *= (*mean)[channel];
    }
  }
  return colour;
}

// From glTF's axes (x left, y up, z forward) to the body's (x forward, y right, z down).
aiVector3D ToBody(const aiVector3D& v) {
  return {v.z, -v.x, -v.y};
}

ModelJoint JointOf(std::string_view node_name) {
  constexpr std::array<std::string_view, kModelJoints> kNames = {"",           "turret",    "gun",  "rotor",
                                                                 "tail_rotor", "propeller", "gear", "hatch"};
  const auto* const found = std::find(kNames.begin() + 1, kNames.end(), node_name);
  return found == kNames.end() ? ModelJoint::kNone : static_cast<ModelJoint>(found - kNames.begin());
}

// The number of a node that is a station.
std::optional<uint16_t> StationOf(std::string_view node_name) {
  constexpr std::string_view kPrefix = "station_";
  if (!node_name.starts_with(kPrefix)) return std::nullopt;
  node_name.remove_prefix(kPrefix.size());
  uint16_t number = 0;
  const auto [end, error] = std::from_chars(node_name.data(), node_name.data() + node_name.size(), number);
  if (error != std::errc{} || end != node_name.data() + node_name.size()) return std::nullopt;
  return number;
}

glm::vec3 OriginOf(const aiMatrix4x4& transform) {
  const aiVector3D origin = ToBody(transform * aiVector3D(0, 0, 0));
  return {origin.x, origin.y, origin.z};
}

// Where the vertices of a node go.
struct Placement {
  aiMatrix4x4 transform;
  ModelJoint joint = ModelJoint::kNone;
};

ModelVertex MakeVertex(const aiMesh& mesh, unsigned index, const Colour& colour, const Placement& placement) {
  const aiVector3D position = ToBody(placement.transform * mesh.mVertices[index]);
  const aiVector3D turned =
      aiMatrix3x3(placement.transform) * (mesh.HasNormals() ? mesh.mNormals[index] : aiVector3D(0, 1, 0));
  const aiVector3D normal = ToBody(turned).NormalizeSafe();
  ModelVertex vertex{position.x, position.y, position.z, normal.x,
                     normal.y,   normal.z,   {},         static_cast<uint8_t>(placement.joint)};
  const aiColor4D own = mesh.HasVertexColors(0) ? mesh.mColors[0][index] : aiColor4D(1, 1, 1, 1);
  const Colour tinted{colour[0] * own.r, colour[1] * own.g, colour[2] * own.b, 1};
  for (size_t channel = 0; channel < vertex.colour.size(); ++channel) {
    vertex.colour[channel] = static_cast<uint8_t>(std::lrint(255.0F * std::clamp(tinted[channel], 0.0F, 1.0F)));
  }
  return vertex;
}

void Append(const aiMesh& mesh, const Colour& colour, const Placement& placement, ModelPage& page) {
  const auto first = static_cast<uint32_t>(page.vertices.size());
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) page.vertices.push_back(MakeVertex(mesh, i, colour, placement));
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines
    for (unsigned corner = 0; corner < 3; ++corner) page.indices.push_back(first + face.mIndices[corner]);
  }
}

// A node, and what hangs under it, which moves with it unless it is a joint of its own. False where it is too much.
bool AppendNode(const aiScene& scene, const aiNode& node, Placement placement, const std::vector<Colour>& colours,
                ModelPage& page) {
  placement.transform = placement.transform * node.mTransformation;
  const ModelJoint joint = JointOf(node.mName.C_Str());
  if (joint != ModelJoint::kNone) {
    page.pivots[static_cast<size_t>(joint)] = OriginOf(placement.transform);
    placement.joint = joint;
  }
  if (const auto number = StationOf(node.mName.C_Str()); number && page.stations.size() < kMostStations) {
    page.stations.push_back({*number, OriginOf(placement.transform)});
  }
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    if (page.vertices.size() + mesh.mNumVertices > kMostVertices) return false;
    const Colour colour = mesh.mMaterialIndex < colours.size() ? colours[mesh.mMaterialIndex] : Colour{1, 1, 1, 1};
    Append(mesh, colour, placement, page);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    if (!AppendNode(scene, *node.mChildren[i], placement, colours, page)) return false;
  }
  return true;
}

bool Finite(const ModelPage& page) {
  return std::all_of(page.vertices.begin(), page.vertices.end(), [](const ModelVertex& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.normal_x) &&
           std::isfinite(v.normal_y) && std::isfinite(v.normal_z);
  });
}

// False when the model has no length to scale.
bool ScaleToLength(ModelPage& page, float length_m) {
  float least = std::numeric_limits<float>::max();
  float greatest = std::numeric_limits<float>::lowest();
  for (const ModelVertex& vertex : page.vertices) {
    least = std::min(least, vertex.x);
    greatest = std::max(greatest, vertex.x);
  }
  if (!(greatest - least > 0)) return false;
  const float scale = length_m / (greatest - least);
  for (ModelVertex& vertex : page.vertices) {
    vertex.x *= scale;
    vertex.y *= scale;
    vertex.z *= scale;
    page.radius_m = std::max(page.radius_m, std::hypot(vertex.x, vertex.y, vertex.z));
  }
  for (glm::vec3& pivot : page.pivots) pivot *= scale;
  for (ModelStation& station : page.stations) station.place *= scale;
  return true;
}

Result<std::unique_ptr<ModelPage>> MakePage(const aiScene& scene, const std::string& path, float length_m) {
  const std::filesystem::path file(path);
  const bool linear = file.extension() != ".obj";
  std::vector<Colour> colours;
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    colours.push_back(ColourOf(*scene.mMaterials[i], file.parent_path(), linear));
  }
  auto page = std::make_unique<ModelPage>();
  if (!AppendNode(scene, *scene.mRootNode, {}, colours, *page)) {
    return Status::Error("{}: the model has more than {} vertices; simplify it", path, kMostVertices);
  }
  if (page->indices.empty()) return Status::Error("{}: the model has no triangles; export it again", path);
  if (!Finite(*page)) return Status::Error("{}: the model has vertices that are no numbers; export it again", path);
  if (!ScaleToLength(*page, length_m)) {
    return Status::Error("{}: the model has no length along its forward axis (z); turn it and export it again", path);
  }
  AddDetails(*page);
  return page;
}

}  // namespace

Result<std::unique_ptr<ModelPage>> ReadModelFile(const std::string& path, float length_m) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(
      path, aiProcess_Triangulate | aiProcess_GenNormals | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType);
  if (scene == nullptr) return Status::Error("{}: cannot read the model: {}", path, importer.GetErrorString());
  return MakePage(*scene, path, length_m);
}

Result<std::unique_ptr<ModelPage>> ReadModel(const ModelCatalogue& models, int number) {
  if (number < 0 || number >= static_cast<int>(models.entries().size())) {
    return Status::Error("{}: there is no model number {}", models.folder(), number);
  }
  const ModelEntry& entry = models.entries()[static_cast<size_t>(number)];
  const std::string path = (std::filesystem::path(models.folder()) / entry.name).string();
  for (const char* ending : {".gltf", ".glb", ".obj"}) {
    std::error_code ignored;
    if (std::filesystem::exists(path + ending, ignored)) return ReadModelFile(path + ending, entry.length_m);
  }
  return Status::Error("{}: there is no such model (.gltf, .glb or .obj); put it there or take it out of the catalogue",
                       path);
}

}  // namespace belvedere
