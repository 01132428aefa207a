// A little Earth made by hand: pages in a real cache, display lists of a few quadnodes, and a view of them. For the
// tests and the benchmark of drawing.
#pragma once

#include "render/render_thread.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/frame.h"
#include "runtime/paging/model_catalogue.h"
#include "runtime/paging/shared_cache.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace belvedere::testing {

using Height = std::function<double(double latitude_deg, double longitude_deg)>;
using Rgba = std::array<uint8_t, 4>;

inline uint32_t Octahedral(glm::dvec3 n) {
  n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  glm::dvec2 oct{n.x, n.y};
  if (n.z < 0) {
    oct = {(1.0 - std::abs(n.y)) * (n.x < 0 ? -1.0 : 1.0), (1.0 - std::abs(n.x)) * (n.y < 0 ? -1.0 : 1.0)};
  }
  const auto pack = [](double x) { return static_cast<uint16_t>(static_cast<int16_t>(std::lround(x * 32767.0))); };
  return static_cast<uint32_t>(pack(oct.x)) | (static_cast<uint32_t>(pack(oct.y)) << 16U);
}

// The post as the frame of `node` has it, height from the function, normal of the ellipsoid.
inline TerrainVertex VertexAt(const Frame& frame, GridPoint point, const Height& height) {
  const double latitude = point.latitude_deg();
  const double longitude = point.longitude_deg();
  const glm::dvec3 local = frame.ToFrame(ToEcef({latitude, longitude, height(latitude, longitude)}));
  const glm::dvec3 normal = UpAt(latitude, longitude) * frame.ecef_from_frame;
  return {static_cast<float>(local.x), static_cast<float>(local.y), static_cast<float>(local.z), Octahedral(normal)};
}

inline std::unique_ptr<TerrainPage> MakeTerrain(Quadcode node, const Height& height) {
  auto page = std::make_unique<TerrainPage>();
  page->node = node;
  const Frame frame = FrameOf(node);
  const GridPoint corner = node.SouthWest();
  glm::dvec3 low(1e30);
  glm::dvec3 high(-1e30);
  for (uint32_t row = 0; row < kPosts; ++row) {
    for (uint32_t column = 0; column < kPosts; ++column) {
      const GridPoint point{corner.x + column * node.PostSpacingEast(), corner.y + row * node.PostSpacingNorth()};
      const TerrainVertex vertex = VertexAt(frame, point, height);
      page->vertices.push_back(vertex);
      const glm::dvec3 ecef = frame.ToEcef({vertex.x, vertex.y, vertex.z});
      low = glm::min(low, ecef);
      high = glm::max(high, ecef);
    }
  }
  page->deltas.resize(kVerticesPerPage);
  page->center_ecef = 0.5 * (low + high);
  page->radius_m = 0.5 * glm::length(high - low);
  return page;
}

// texel: of the inner square, u and v from 0 to 1 from its south-west corner; the gutter is filled likewise.
template <typename Texel>
std::unique_ptr<ImagePage> MakeImage(ImageFormat format, Texel texel) {
  auto page = std::make_unique<ImagePage>();
  page->format = format;
  for (int level = 0; level < kImageMipLevels; ++level) {
    const int side = kImageSide >> level;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const auto coordinate = [&](int i) {
          return ((i + 0.5) * (1 << level) - kImageGutter) / static_cast<double>(kImageInner);
        };
        const Rgba colour = texel(coordinate(x), coordinate(y));
        page->texels.insert(page->texels.end(), colour.begin(), colour.begin() + static_cast<int>(format));
      }
    }
  }
  return page;
}

class Scene {
 public:
  Scene() : cache_(size_t{1} << 30, 5) {
    const auto all = [](Quadcode) { return true; };
    layers_.Add({"elevation", PageKind::kElevation, 0, kMaxLevel, all});
    terrain_ = layers_.Add({"terrain", PageKind::kTerrain, 0, kMaxLevel, all});
    colour_ = layers_.Add({"colour", PageKind::kColour, 0, kMaxLevel, all});
    overlay_ = layers_.Add({"relief", PageKind::kOverlay, 0, kMaxLevel, all});
    model_ = layers_.Add({"models", PageKind::kModel, 0, kMaxLevel, all});
  }
  const LayerTable& layers() const { return layers_; }
  SharedCache& cache() { return cache_; }

  PagePin AddTerrain(Quadcode node, const Height& height) {
    return cache_.Insert({terrain_, node}, MakeTerrain(node, height));
  }
  PagePin AddColour(Quadcode node, Rgba colour) {
    return cache_.Insert({colour_, node}, MakeImage(ImageFormat::kRGBA8, [&](double, double) { return colour; }));
  }
  template <typename Texel>
  PagePin AddColourOf(Quadcode node, Texel texel) {
    return cache_.Insert({colour_, node}, MakeImage(ImageFormat::kRGBA8, texel));
  }
  PagePin AddOverlay(Quadcode node, uint8_t value) {
    return cache_.Insert({overlay_, node}, MakeImage(ImageFormat::kR8, [&](double, double) {
                           return Rgba{value, 0, 0, 0};
                         }));
  }
  PagePin AddModel(int number, std::unique_ptr<ModelPage> page) {
    return cache_.Insert({model_, ModelCatalogue::ModelNode(number)}, std::move(page));
  }
  // What is on the GPU of the cache's pages; empty where the page is not.
  PagePin Find(DataType type, Quadcode node) { return cache_.Find({type, node}); }
  DataType terrain_type() const { return terrain_; }
  DataType colour_type() const { return colour_; }
  DataType overlay_type() const { return overlay_; }

 private:
  LayerTable layers_;
  SharedCache cache_;
  DataType terrain_ = 0, colour_ = 0, overlay_ = 0, model_ = 0;
};

inline uint32_t FrameIndex(DisplayList& list, Quadcode node) {
  const Quadcode frame_node = FrameNode(node);
  for (uint32_t i = 0; i < list.frames.size(); ++i) {
    if (list.frames[i].node == frame_node) return i;
  }
  list.frames.push_back(FrameOf(node));
  return static_cast<uint32_t>(list.frames.size() - 1);
}

// Slot of the page, pinned by the list; -1 when it is not on the GPU.
inline int PinInto(DisplayList& list, PagePin pin) {
  Residency& residency = *pin.page().residency();
  const auto slot = residency.TryPin();
  if (slot) list.gpu_pins.push_back(&residency);
  list.page_pins.push_back(std::move(pin));
  return slot.value_or(-1);
}

// Draws quadnodes of one level as grids of every `step`th post. A post on the east or north border is the neighbour's
// where that is drawn too: shared posts are shared numbers, as in the lists of a terrain manager.
inline void AddSurface(DisplayList& list, Scene& scene, const std::vector<Quadcode>& nodes, int step) {
  std::map<std::pair<int64_t, int64_t>, uint32_t> first_vertices;  // by column and row
  std::vector<BoundingSphere> volumes;
  const auto first_draw = static_cast<uint32_t>(list.terrain_draws.size());
  const int across = kCells / step + 1;
  for (const Quadcode node : nodes) {
    PagePin pin = scene.Find(scene.terrain_type(), node);
    const TerrainPage& page = pin.as<TerrainPage>();
    volumes.push_back({page.center_ecef, page.radius_m});
    first_vertices[{node.column(), node.row()}] = static_cast<uint32_t>(list.vertices->size());
    const uint32_t draw = first_draw + static_cast<uint32_t>(first_vertices.size()) - 1;
    for (int row = 0; row < kPosts; row += step) {
      for (int column = 0; column < kPosts; column += step) {
        const auto post = static_cast<uint32_t>(row * kPosts + column);
        const TerrainVertex& v = page.vertices[post];
        list.vertices->push_back({v.x, v.y, v.z, v.normal, ListVertex::PlaceOf(draw, post), 0.0F});
      }
    }
    list.page_pins.push_back(std::move(pin));
  }
  for (size_t i = 0; i < nodes.size(); ++i) {
    const Quadcode node = nodes[i];
    const auto number = [&](int column, int row) {
      int64_t east = column == kCells ? 1 : 0;
      int64_t north = row == kCells ? 1 : 0;
      if (!first_vertices.contains({node.column() + east, node.row() + north})) {
        if (east != 0 && first_vertices.contains({node.column() + 1, node.row()})) {
          north = 0;
        } else if (north != 0 && first_vertices.contains({node.column(), node.row() + 1})) {
          east = 0;
        } else {
          east = north = 0;
        }
      }
      const int own_column = east != 0 ? 0 : column;
      const int own_row = north != 0 ? 0 : row;
      return first_vertices.at({node.column() + east, node.row() + north}) +
             static_cast<uint32_t>(own_row / step * across + own_column / step);
    };
    TerrainDraw draw;
    draw.node = node;
    draw.frame = FrameIndex(list, node);
    draw.first_index = static_cast<uint32_t>(list.indices.size());
    for (int row = 0; row < kCells; row += step) {
      for (int column = 0; column < kCells; column += step) {
        const std::array<uint32_t, 4> corner = {number(column, row), number(column + step, row),
                                                number(column + step, row + step), number(column, row + step)};
        for (const size_t c : {0U, 1U, 2U, 0U, 2U, 3U}) list.indices.push_back(corner[c]);
      }
    }
    draw.index_count = static_cast<uint32_t>(list.indices.size()) - draw.first_index;
    size_t layer = 0;
    for (const DataType type : {scene.colour_type(), scene.overlay_type()}) {
      if (PagePin image = scene.Find(type, node)) draw.images[layer].slot = PinInto(list, std::move(image));
      ++layer;
    }
    const auto first = static_cast<uint32_t>(list.records.size());
    list.volumes.push_back(volumes[i]);
    list.records.push_back(
        {ListRecord::Kind::kCullBegin, static_cast<uint32_t>(list.volumes.size() - 1), 0, first + 3});
    list.records.push_back({ListRecord::Kind::kDrawTerrain, static_cast<uint32_t>(list.terrain_draws.size()), 1, 0});
    list.records.push_back({ListRecord::Kind::kCullEnd, 0, 0, 0});
    list.terrain_draws.push_back(draw);
    list.statistics.triangles += draw.index_count / 3;
    ++list.statistics.nodes;
  }
}

// All quadnodes of a level that touch a box of `count` x `count` around the position.
inline std::vector<Quadcode> Block(double latitude_deg, double longitude_deg, int level, int count) {
  const Quadcode middle = Quadcode::Containing(latitude_deg, longitude_deg, level);
  std::vector<Quadcode> nodes;
  for (int64_t row = 0; row < count; ++row) {
    for (int64_t column = 0; column < count; ++column) {
      nodes.push_back(
          Quadcode::FromColumnRow(level, middle.column() + column - count / 2, middle.row() + row - count / 2));
    }
  }
  return nodes;
}

// A view of width x height pixels, with nothing over the picture and magenta behind it.
inline ViewParameters LookAt(const Geodetic& eye, double heading_deg, double pitch_deg, int width, int height) {
  ViewParameters view;
  view.view = 1;
  view.number = 1;
  view.eye_ecef = ToEcef(eye);
  view.ecef_from_camera = CameraAxes(eye.latitude_deg, eye.longitude_deg, Radians::FromDegrees(heading_deg),
                                     Radians::FromDegrees(pitch_deg), Radians::FromDegrees(0));
  view.width_px = width;
  view.height_px = height;
  view.image_layers = {{2, LayerRole::kColour}, {3, LayerRole::kMultiply}};  // of Scene
  view.hud = false;
  view.sky = false;
  view.background = {1.0F, 0.0F, 1.0F};
  view.utc_s = 1'718'971'200;  // 2024-06-21 12:00 UTC: the sun over 23 N near Greenwich
  return view;
}

// Off-screen renderer and one view, driven frame by frame by the test.
class Stage {
 public:
  static Result<std::unique_ptr<Stage>> Make(Scene& scene, const RenderOptions& options, const Clock& clock) {
    auto context = MakeOffscreenContext();
    if (!context.ok()) return context.status();
    if (Status status = (*context)->MakeCurrent(); !status.ok()) return status;
    auto renderer = Renderer::Make(options, scene.layers(), clock);
    if (!renderer.ok()) return renderer.status();
    return std::unique_ptr<Stage>(new Stage(std::move(*context), std::move(*renderer)));
  }
  ~Stage() {
    renderer.reset();
    context->Release();
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  void Frame() { renderer->DrawFrame(recorder, *context); }
  Picture Take() {
    auto picture = renderer->Capture(1, Renderer::Moment::kOfParameters);
    BELVEDERE_CHECK(picture.ok());
    return std::move(*picture);
  }
  // Publishes the terrain list that was filled and draws frames until it is shown.
  void Show(uint64_t number) {
    channel->terrain_lists.back().number = number;
    channel->terrain_lists.Publish();
    do Frame();
    while (channel->frame.Get()->terrain_list != number);
  }
  // Publishes a list that wishes for the pins and draws a frame, so that they are uploaded.
  void Upload(std::vector<PagePin> pins) {
    DisplayList& list = channel->terrain_lists.back();
    list.Clear();
    list.uploads = std::move(pins);
    channel->terrain_lists.Publish();
    Frame();
  }

  std::unique_ptr<Context> context;
  std::unique_ptr<Renderer> renderer;
  FrameRecorder recorder{1024};
  std::shared_ptr<ViewChannel> channel = std::make_shared<ViewChannel>();

 private:
  Stage(std::unique_ptr<Context> c, std::unique_ptr<Renderer> r) : context(std::move(c)), renderer(std::move(r)) {
    renderer->AddView(1, channel, nullptr);
  }
};

}  // namespace belvedere::testing
