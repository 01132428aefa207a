#include "managers/surface_mesh.h"

#include "managers/border_lines.h"
#include "managers/post_selection.h"
#include "runtime/base/status.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <unordered_map>

namespace belvedere {
namespace {

constexpr std::array<Border, 4> kBorders{Border::kWest, Border::kEast, Border::kSouth, Border::kNorth};

constexpr int PostOnBorder(Border border, int along) {
  switch (border) {
    case Border::kWest: return along * kPosts;
    case Border::kEast: return along * kPosts + kCells;
    case Border::kSouth: return along;
    case Border::kNorth: return kCells * kPosts + along;
  }
  return 0;
}

constexpr bool OnBorder(int post, Border border) {
  switch (border) {
    case Border::kWest: return post % kPosts == 0;
    case Border::kEast: return post % kPosts == kCells;
    case Border::kSouth: return post < kPosts;
    case Border::kNorth: return post >= kCells * kPosts;
  }
  return false;
}

// For every post, the borders it lies on, as bits 1 << Border; 0 for almost all of them.
const std::array<uint8_t, kVerticesPerPage>& BorderBits() {
  static const auto kBits = [] {
    std::array<uint8_t, kVerticesPerPage> bits{};
    for (int post = 0; post < kVerticesPerPage; ++post) {
      for (const Border border : kBorders) {
        if (OnBorder(post, border))
          bits[static_cast<size_t>(post)] |= static_cast<uint8_t>(1U << static_cast<unsigned>(border));
      }
    }
    return bits;
  }();
  return kBits;
}

constexpr int AlongBorder(int post, Border border) {
  return border == Border::kWest || border == Border::kEast ? post / kPosts : post % kPosts;
}

// The border on which both posts lie, if there is one.
std::optional<Border> SharedBorder(int a, int b) {
  for (const Border border : kBorders) {
    if (OnBorder(a, border) && OnBorder(b, border)) return border;
  }
  return std::nullopt;
}

// The vertex of each pole.
struct Poles {
  uint32_t north = 0, south = 0;
};

// Joins the triangles of one quadnode to its neighbours' along its borders, and appends them as absolute vertices.
class Joiner {
 public:
  // first_vertex: of the quadnode's own in the list.
  Joiner(const CutNode& node, const KeptMesh& mesh, uint32_t first_vertex, const BorderLines& lines, const Poles& poles,
         std::vector<uint32_t>& out)
      : mesh_(mesh), first_(first_vertex), out_(out) {
    for (const Border border : kBorders) {
      Side& side = sides_[static_cast<size_t>(border)];
      const bool polar =
          (border == Border::kNorth && node.node.SouthWest().y + node.node.GridSize() == kGridNorthPole) ||
          (border == Border::kSouth && node.node.SouthWest().y == 0);
      if (polar) {
        side.pole = border == Border::kNorth ? poles.north : poles.south;
        continue;
      }
      const uint64_t start = BorderLines::PositionOf(node.node, border, 0);
      const uint64_t spacing = node.node.PostSpacing();
      for (const BorderVertex& vertex : lines.Along(node.node, border)) {
        const uint64_t offset = vertex.position - start;
        if (offset % spacing == 0) side.at_post[offset / spacing] = &vertex;
      }
    }
  }

  void Append() {
    const size_t begin = out_.size();
    out_.resize(begin + 3 * mesh_.inner.size());
    uint32_t* next = out_.data() + begin;
    for (const KeptMesh::Triangle& triangle : mesh_.inner) {
      *next++ = first_ + triangle.a;
      *next++ = first_ + triangle.b;
      *next++ = first_ + triangle.c;
    }
    for (const KeptMesh::Triangle& triangle : mesh_.at_border) {
      const std::array<uint16_t, 3> corners{triangle.a, triangle.b, triangle.c};
      std::array<int, 3> posts;
      std::array<uint32_t, 3> vertices;
      for (size_t i = 0; i < 3; ++i) {
        posts[i] = static_cast<int>(mesh_.vertices[corners[i]].post());
        vertices[i] = Canonical(posts[i], corners[i]);
      }
      AppendAtBorder(posts, vertices);
    }
  }

 private:
  struct Side {
    // Of each post along the border; null where neither side draws it. What lies between two of them stands between.
    std::array<const BorderVertex*, kPosts> at_post{};
    std::optional<uint32_t> pole;  // the whole border is that one vertex
  };

  static const BorderVertex* At(const Side& side, int along) { return side.at_post[static_cast<size_t>(along)]; }

  uint32_t Canonical(int post, uint16_t own) const {
    const unsigned bits = border_bits_[static_cast<size_t>(post)];
    if (bits == 0) return first_ + own;
    std::optional<uint32_t> found;
    for (const Border border : kBorders) {
      if ((bits & (1U << static_cast<unsigned>(border))) == 0) continue;
      const Side& side = sides_[static_cast<size_t>(border)];
      if (side.pole) return *side.pole;
      found = At(side, AlongBorder(post, border))->vertex;
    }
    return *found;
  }

  // Canonical vertices strictly between two posts of one border, in the order from `from` to `to`.
  void Between(int from, int to, std::vector<uint32_t>& between) const {
    between.clear();
    const std::optional<Border> border = SharedBorder(from, to);
    if (!border) return;
    const Side& side = sides_[static_cast<size_t>(*border)];
    if (side.pole) return;
    const int a = AlongBorder(from, *border);
    const int b = AlongBorder(to, *border);
    const BorderVertex* low = At(side, std::min(a, b));
    const BorderVertex* high = At(side, std::max(a, b));
    for (const BorderVertex* v = low + 1; v < high; ++v) between.push_back(v->vertex);
    if (a > b) std::reverse(between.begin(), between.end());
  }

  void AppendAtBorder(const std::array<int, 3>& posts, const std::array<uint32_t, 3>& vertices) {
    for (size_t i = 0; i < 3; ++i) Between(posts[i], posts[(i + 1) % 3], edges_[i]);
    for (size_t i = 0; i < 3; ++i) {
      if (vertices[(i + 1) % 3] == vertices[(i + 2) % 3]) {
        AppendAtPole(vertices[(i + 1) % 3], vertices[i], edges_[(i + 2) % 3], edges_[i]);
        return;
      }
    }
    // At most two edges of a triangle lie on borders. Number the corners so that the free edge ends at corner `p`:
    // edge 0 (p -> v) and edge 1 (v -> q) may be cut, edge 2 (q -> p) is whole.
    size_t whole = 0;
    while (whole < 3 && !edges_[whole].empty()) ++whole;
    BELVEDERE_CHECK(whole < 3);
    const size_t p = (whole + 1) % 3;
    const size_t v = (whole + 2) % 3;
    const size_t q = whole;
    const std::vector<uint32_t>& first = edges_[p];
    const std::vector<uint32_t>& second = edges_[v];
    // The fan from p covers the second edge; its first triangle (p, v, next) has the first edge, cut as a fan from
    // next.
    const uint32_t next = second.empty() ? vertices[q] : second.front();
    Fan(next, vertices[p], first, vertices[v]);
    if (second.empty()) return;
    uint32_t previous = next;
    for (size_t i = 1; i < second.size(); ++i) {
      Emit(vertices[p], previous, second[i]);
      previous = second[i];
    }
    Emit(vertices[p], previous, vertices[q]);
  }

  // Two corners are the pole: the triangle is a line from the pole to `foot` and back. Where one way is cut and the
  // other is whole, slivers join them.
  void AppendAtPole(uint32_t pole, uint32_t foot, const std::vector<uint32_t>& there,
                    const std::vector<uint32_t>& back) {
    std::vector<uint32_t> loop(there);
    loop.push_back(foot);
    loop.insert(loop.end(), back.begin(), back.end());
    for (size_t i = 0; i + 1 < loop.size(); ++i) Emit(pole, loop[i], loop[i + 1]);
  }

  // Triangles (apex, from, ..., to) over the cut edge from -> to.
  void Fan(uint32_t apex, uint32_t from, const std::vector<uint32_t>& between, uint32_t to) {
    uint32_t previous = from;
    for (const uint32_t vertex : between) {
      Emit(apex, previous, vertex);
      previous = vertex;
    }
    Emit(apex, previous, to);
  }

  void Emit(uint32_t a, uint32_t b, uint32_t c) {
    out_.push_back(a);
    out_.push_back(b);
    out_.push_back(c);
  }

  const std::array<uint8_t, kVerticesPerPage>& border_bits_ = BorderBits();
  const KeptMesh& mesh_;
  const uint32_t first_;
  std::vector<uint32_t>& out_;
  std::array<Side, 4> sides_;
  std::array<std::vector<uint32_t>, 3> edges_;
};

// The nodes, finest first and then by quadcode.
std::vector<uint32_t> RankNodes(std::span<const CutNode> nodes) {
  std::vector<uint32_t> order(nodes.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const int level_a = nodes[a].node.level();
    const int level_b = nodes[b].node.level();
    return level_a != level_b ? level_a > level_b : nodes[a].node < nodes[b].node;
  });
  return order;
}

// Adds the drawn posts of one quadnode that lie on its borders.
void AddBorderPosts(const CutNode& node, const KeptMesh& mesh, uint32_t first_vertex, uint32_t rank,
                    BorderLines& lines) {
  for (const uint16_t own : mesh.border_vertices) {
    const auto post = static_cast<int>(mesh.vertices[own].post());
    for (const Border border : kBorders) {
      if (OnBorder(post, border)) lines.Add(node.node, border, AlongBorder(post, border), first_vertex + own, rank);
    }
  }
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
      : nodes_(nodes), state_(state), list_(list), ranked_(RankNodes(nodes)), rank_(nodes.size()) {
    for (uint32_t place = 0; place < ranked_.size(); ++place) rank_[ranked_[place]] = place;
  }

  MeshStatistics Build(const Sight& sight, double error_px) {
    Choose(sight, error_px);
    Place();
    Share();
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

  void Place() {
    std::unordered_map<Quadcode, const KeptMesh*> unchanged;
    for (size_t i = 0; i < nodes_.size(); ++i) {
      if (!chosen_[i].is_new) unchanged.emplace(nodes_[i].node, chosen_[i].mesh);
    }
    state_.morph.Prepare(unchanged);
    for (size_t i = 0; i < nodes_.size(); ++i) {
      state_.morph.Place(nodes_[i], list_.frames[chosen_[i].frame], chosen_[i].is_new, *chosen_[i].mesh);
    }
  }

  // Settles which vertex is drawn where quadnodes meet.
  void Share() {
    for (size_t i = 0; i < nodes_.size(); ++i) {
      AddBorderPosts(nodes_[i], *chosen_[i].mesh, first_vertex_[i], rank_[i], lines_);
    }
    lines_.Seal();
    poles_ = {PoleVertex(true), PoleVertex(false)};
    for (const BorderVertex& shared : lines_.vertices()) {
      const uint32_t owner = ranked_[shared.rank];
      const Chosen& chosen = chosen_[owner];
      if (chosen.is_new) continue;  // placed already
      state_.morph.PlaceShared(nodes_[owner], list_.frames[chosen.frame],
                               static_cast<uint16_t>(shared.vertex - first_vertex_[owner]), *chosen.mesh);
    }
  }

  // That of the best-ranked quadnode that touches the pole.
  uint32_t PoleVertex(bool north) const {
    for (const uint32_t i : ranked_) {
      const uint32_t south = nodes_[i].node.SouthWest().y;
      const bool touches = north ? south + nodes_[i].node.GridSize() == kGridNorthPole : south == 0;
      if (!touches) continue;
      const auto post = static_cast<uint32_t>(PostOnBorder(north ? Border::kNorth : Border::kSouth, 0));
      const std::vector<ListVertex>& vertices = chosen_[i].mesh->vertices;  // corners are always drawn
      const auto found =
          std::find_if(vertices.begin(), vertices.end(), [&](const ListVertex& v) { return v.post() == post; });
      return first_vertex_[i] + static_cast<uint32_t>(found - vertices.begin());
    }
    return 0;
  }

  void AppendVertices() {
    if (!nodes_.empty()) list_.vertices.resize(first_vertex_.back() + chosen_.back().mesh->vertices.size());
    for (uint32_t i = 0; i < nodes_.size(); ++i) {
      const KeptMesh& mesh = *chosen_[i].mesh;
      ListVertex* next = list_.vertices.data() + first_vertex_[i];
      for (const ListVertex& vertex : mesh.vertices) {
        *next = vertex;
        next++->place = ListVertex::PlaceOf(i, vertex.post());
      }
      statistics_.rises_until_s = std::max(statistics_.rises_until_s, mesh.rises_until_s);
    }
  }

  void AppendTriangles() {
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
      Joiner(nodes_[i], mesh, first_vertex_[i], lines_, poles_, list_.indices).Append();
      draw.index_count = static_cast<uint32_t>(list_.indices.size()) - draw.first_index;
      list_.terrain_draws.push_back(draw);
      statistics_.triangles += draw.index_count / 3;
    }
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
  BorderLines lines_;
  Poles poles_;
  MeshStatistics statistics_;
};

}  // namespace

MeshStatistics BuildSurface(std::span<const CutNode> nodes, const Sight& sight, double error_px, SurfaceState& state,
                            DisplayList& list) {
  return Surface(nodes, state, list).Build(sight, error_px);
}

}  // namespace belvedere
