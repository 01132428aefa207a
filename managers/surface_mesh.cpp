#include "managers/surface_mesh.h"

#include "managers/border_joiner.h"
#include "managers/reach.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace belvedere {
namespace {

// The nodes, narrowest first, then finest, then by quadcode (border_lines.h).
std::vector<uint32_t> RankNodes(std::span<const CutNode> nodes) {
  struct Key {
    uint32_t width;
    int coarseness;
    Quadcode node;
    uint32_t number;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<Key> keys;
  keys.reserve(nodes.size());
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    const Quadcode node = nodes[i].node;
    keys.push_back({node.GridWidth(), -node.level(), node, i});
  }
  std::sort(keys.begin(), keys.end());
  std::vector<uint32_t> order;
  order.reserve(keys.size());
  for (const Key& key : keys) order.push_back(key.number);
  return order;
}

uint32_t FrameIndex(Quadcode node, std::vector<Frame>& frames) {
  const Quadcode frame_node = FrameNode(node);
  const auto found = std::find_if(frames.begin(), frames.end(), [&](const Frame& f) { return f.node == frame_node; });
  if (found != frames.end()) return static_cast<uint32_t>(found - frames.begin());
  frames.push_back(FrameOf(node));
  return static_cast<uint32_t>(frames.size() - 1);
}

// One list in the making.
class Surface {
 public:
  Surface(std::span<const CutNode> nodes, SurfaceState& state, DisplayList& list)
      : nodes_(nodes), state_(state), list_(list), ranked_(RankNodes(nodes)), rank_(nodes.size()), lines_(state.lines) {
    for (uint32_t place = 0; place < ranked_.size(); ++place) rank_[ranked_[place]] = place;
  }

  MeshStatistics Build(const Sight& sight, double error_px) {
    Choose(sight, error_px);
    Place(sight);
    if (is_changed_) {
      Share();
      Join();
    }
    AppendVertices();
    AppendTriangles();
    state_.morph.Remember(list_, ranked_, first_vertex_);
    state_.kept.ForgetUnused();
    return statistics_;
  }

 private:
  void Choose(const Sight& sight, double error_px) {
    uint32_t vertices = 0;
    for (const CutNode& node : nodes_) {
      const uint32_t frame = FrameIndex(node.node, list_.frames);
      const KeptTriangles::Choice choice = state_.kept.For(node, sight, list_.frames[frame], error_px);
      if (node.visible)
        statistics_.achieved_error_px = std::max(statistics_.achieved_error_px, choice.worst * error_px);
      chosen_.push_back({choice.mesh, frame, choice.is_new, static_cast<float>(choice.worst * error_px)});
      first_vertex_.push_back(vertices);
      vertices += static_cast<uint32_t>(choice.mesh->vertices.size());
    }
  }

  void Place(const Sight& sight) {
    FindReach();
    if (is_changed_) {
      std::unordered_map<Quadcode, const KeptMesh*> unchanged;
      for (size_t i = 0; i < nodes_.size(); ++i) {
        if (!chosen_[i].is_new) unchanged.emplace(nodes_[i].node, reach_.asked[i] ? chosen_[i].mesh : nullptr);
      }
      state_.morph.Prepare(unchanged);
    }
    for (size_t i = 0; i < nodes_.size(); ++i) {
      state_.morph.Place(nodes_[i], sight, list_.frames[chosen_[i].frame], chosen_[i].is_new, *chosen_[i].mesh);
    }
  }

  void FindReach() {
    std::vector<Quadcode> quadcodes;
    std::vector<bool> is_new;
    for (size_t i = 0; i < nodes_.size(); ++i) {
      quadcodes.push_back(nodes_[i].node);
      is_new.push_back(chosen_[i].is_new);
    }
    const std::vector<Quadcode> gone = state_.kept.Unused();
    is_changed_ = !gone.empty() || std::find(is_new.begin(), is_new.end(), true) != is_new.end();
    if (is_changed_) reach_ = ReachOf(quadcodes, is_new, gone);
  }

  // Settles which vertex is drawn where quadnodes meet, as far as the change reaches.
  void Share() {
    lines_.Clear();
    std::vector<const KeptMesh*> meshes;
    for (uint32_t i = 0; i < nodes_.size(); ++i) {
      meshes.push_back(chosen_[i].mesh);
      if (reach_.asked[i]) AddBorderPosts(nodes_[i], *chosen_[i].mesh, i, rank_[i], lines_);
    }
    lines_.Seal();
    poles_ = PoleCornersOf(nodes_, meshes, ranked_);
    for (const BorderVertex& shared : lines_.vertices()) {
      const uint32_t owner = NodeOf(shared.corner);
      const Chosen& chosen = chosen_[owner];
      // What is new is placed already; at the far side of what is asked not all posts of a border are there.
      if (chosen.is_new || !reach_.joined[owner]) continue;
      state_.morph.PlaceShared(nodes_[owner], list_.frames[chosen.frame],
                               static_cast<uint16_t>(OwnVertexOf(shared.corner)), *chosen.mesh);
    }
  }

  void Join() {
    std::vector<uint32_t> corners;
    for (uint32_t i = 0; i < nodes_.size(); ++i) {
      if (!reach_.joined[i]) continue;
      corners.clear();
      JoinBorders(nodes_[i], *chosen_[i].mesh, i, lines_, poles_, corners);
      KeepJoined(corners, *chosen_[i].mesh);
    }
  }

  // Numbers of quadnodes in the cut change from list to list: a mesh names them.
  void KeepJoined(std::span<const uint32_t> corners, KeptMesh& mesh) const {
    std::vector<uint32_t> owners;  // by their number in the cut
    mesh.joined.clear();
    mesh.owners.clear();
    for (const uint32_t corner : corners) {
      size_t owner = 0;
      while (owner < owners.size() && owners[owner] != NodeOf(corner)) ++owner;
      if (owner == owners.size()) {
        owners.push_back(NodeOf(corner));
        mesh.owners.push_back(nodes_[NodeOf(corner)].node);
      }
      mesh.joined.push_back(CornerOf(static_cast<uint32_t>(owner), OwnVertexOf(corner)));
    }
  }

  void AppendVertices() {
    std::vector<ListVertex>& vertices = *list_.vertices;
    if (!nodes_.empty()) vertices.reserve(first_vertex_.back() + chosen_.back().mesh->vertices.size());
    for (uint32_t i = 0; i < nodes_.size(); ++i) {
      const KeptMesh& mesh = *chosen_[i].mesh;
      vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
      for (size_t v = first_vertex_[i]; v < vertices.size(); ++v) vertices[v].place |= ListVertex::PlaceOf(i, 0);
      statistics_.rises_until_s = std::max(statistics_.rises_until_s, mesh.rises_until_s);
    }
  }

  void AppendTriangles() {
    std::unordered_map<Quadcode, uint32_t> first_vertex_of;
    for (size_t i = 0; i < nodes_.size(); ++i) first_vertex_of.emplace(nodes_[i].node, first_vertex_[i]);
    for (size_t i = 0; i < nodes_.size(); ++i) {
      const KeptMesh& mesh = *chosen_[i].mesh;
      TerrainDraw draw;
      draw.node = nodes_[i].node;
      draw.frame = chosen_[i].frame;
      draw.rise_s = static_cast<float>(mesh.rises_until_s - mesh.rises_from_s);
      draw.error_px = chosen_[i].error_px + nodes_[i].left_over_px;
      draw.first_index = static_cast<uint32_t>(list_.indices.size());
      draw.images = nodes_[i].images;
      draw.from = nodes_[i].from;
      for (size_t layer = 0; layer < kFadingLayers; ++layer) {
        draw.fade_s[layer] = static_cast<float>(std::max(nodes_[i].fade_until_s[layer] - list_.time_s, 0.0));
      }
      AppendIndices(mesh, first_vertex_[i], first_vertex_of);
      draw.index_count = static_cast<uint32_t>(list_.indices.size()) - draw.first_index;
      list_.terrain_draws.push_back(draw);
      statistics_.triangles += draw.index_count / 3;
    }
  }

  void AppendIndices(const KeptMesh& mesh, uint32_t own_first,
                     const std::unordered_map<Quadcode, uint32_t>& first_vertex_of) {
    const size_t begin = list_.indices.size();
    list_.indices.resize(begin + 3 * mesh.inner.size() + mesh.joined.size());
    uint32_t* next = list_.indices.data() + begin;
    for (const KeptMesh::Triangle& triangle : mesh.inner) {
      *next++ = own_first + triangle.a;
      *next++ = own_first + triangle.b;
      *next++ = own_first + triangle.c;
    }
    first_of_owner_.clear();
    for (const Quadcode owner : mesh.owners) first_of_owner_.push_back(first_vertex_of.at(owner));
    for (const uint32_t corner : mesh.joined) *next++ = first_of_owner_[NodeOf(corner)] + OwnVertexOf(corner);
  }

  struct Chosen {
    KeptMesh* mesh;
    uint32_t frame;
    bool is_new;
    float error_px;
  };
  const std::span<const CutNode> nodes_;
  SurfaceState& state_;
  DisplayList& list_;
  const std::vector<uint32_t> ranked_;  // nodes_, as shared vertices are taken from them
  std::vector<uint32_t> rank_;          // of each of nodes_
  std::vector<Chosen> chosen_;
  std::vector<uint32_t> first_vertex_;  // in the list, of each of nodes_
  bool is_changed_ = false;             // since the list before
  Reach reach_;                         // of the change
  BorderLines& lines_;
  PoleCorners poles_;
  std::vector<uint32_t> first_of_owner_;  // scratch
  MeshStatistics statistics_;
};

}  // namespace

MeshStatistics BuildSurface(std::span<const CutNode> nodes, const Sight& sight, double error_px, SurfaceState& state,
                            DisplayList& list) {
  return Surface(nodes, state, list).Build(sight, error_px);
}

}  // namespace belvedere
