#include "managers/surface_mesh.h"

#include "managers/border_lines.h"
#include "managers/post_selection.h"
#include "runtime/base/status.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

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

// Joins the triangles of one quadnode to its neighbours' along its borders, and appends them as absolute vertices.
class Joiner {
 public:
  Joiner(const CutNode& node, const BorderLines& lines, uint32_t north_pole, uint32_t south_pole,
         std::vector<uint32_t>& out)
      : first_(static_cast<uint32_t>(node.slot) * kVerticesPerPage), out_(out) {
    for (const Border border : kBorders) {
      Side& side = sides_[static_cast<size_t>(border)];
      const bool polar =
          (border == Border::kNorth && node.node.SouthWest().y + node.node.GridSize() == kGridNorthPole) ||
          (border == Border::kSouth && node.node.SouthWest().y == 0);
      if (polar) {
        side.pole = border == Border::kNorth ? north_pole : south_pole;
        continue;
      }
      side.vertices = lines.Along(node.node, border);
      side.start = BorderLines::PositionOf(node.node, border, 0);
      side.spacing = node.node.PostSpacing();
    }
  }

  void Append(const PostTriangle& triangle) {
    const std::array<int, 3> posts{triangle.a, triangle.b, triangle.c};
    std::array<uint32_t, 3> vertices;
    bool on_border = false;
    for (size_t i = 0; i < 3; ++i) {
      vertices[i] = Canonical(posts[i], on_border);
    }
    if (!on_border) {
      out_.insert(out_.end(), vertices.begin(), vertices.end());
      return;
    }
    AppendAtBorder(posts, vertices);
  }

 private:
  struct Side {
    std::span<const BorderVertex> vertices;
    uint64_t start = 0;
    uint64_t spacing = 1;
    std::optional<uint32_t> pole;  // the whole border is that one vertex
  };

  const BorderVertex* At(const Side& side, int along) const {
    const uint64_t position = side.start + static_cast<uint64_t>(along) * side.spacing;
    return &*std::lower_bound(side.vertices.begin(), side.vertices.end(), position,
                              [](const BorderVertex& v, uint64_t p) { return v.position < p; });
  }

  uint32_t Canonical(int post, bool& on_border) const {
    const unsigned bits = border_bits_[static_cast<size_t>(post)];
    if (bits == 0) return first_ + static_cast<uint32_t>(post);
    on_border = true;
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
  const uint32_t first_;
  std::vector<uint32_t>& out_;
  std::array<Side, 4> sides_;
  std::array<std::vector<uint32_t>, 3> edges_;
};

// Place of each node, finest first and then by quadcode.
std::vector<uint32_t> RankNodes(std::span<const CutNode> nodes) {
  std::vector<uint32_t> order(nodes.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const int level_a = nodes[a].node.level();
    const int level_b = nodes[b].node.level();
    return level_a != level_b ? level_a > level_b : nodes[a].node < nodes[b].node;
  });
  std::vector<uint32_t> rank(nodes.size());
  for (uint32_t place = 0; place < order.size(); ++place) rank[order[place]] = place;
  return rank;
}

// Adds the posts of one quadnode's triangles that lie on its borders.
void AddBorderPosts(const CutNode& node, std::span<const PostTriangle> triangles, uint32_t rank, BorderLines& lines) {
  std::array<std::array<bool, kPosts>, 4> seen{};
  const auto& border_bits = BorderBits();
  const auto add = [&](int post) {
    if (border_bits[static_cast<size_t>(post)] == 0) return;
    for (const Border border : kBorders) {
      if (!OnBorder(post, border)) continue;
      const int along = AlongBorder(post, border);
      bool& here = seen[static_cast<size_t>(border)][static_cast<size_t>(along)];
      if (here) continue;
      here = true;
      const uint32_t vertex = static_cast<uint32_t>(node.slot) * kVerticesPerPage + static_cast<uint32_t>(post);
      lines.Add(node.node, border, along, vertex, rank);
    }
  };
  for (const PostTriangle& triangle : triangles) {
    add(triangle.a);
    add(triangle.b);
    add(triangle.c);
  }
}

// The one vertex of a pole: that of the best-ranked quadnode that touches it.
uint32_t PoleVertex(std::span<const CutNode> nodes, std::span<const uint32_t> rank, bool north) {
  uint32_t best_rank = std::numeric_limits<uint32_t>::max();
  uint32_t vertex = 0;
  for (size_t i = 0; i < nodes.size(); ++i) {
    const uint32_t south = nodes[i].node.SouthWest().y;
    const bool touches = north ? south + nodes[i].node.GridSize() == kGridNorthPole : south == 0;
    if (!touches || rank[i] >= best_rank) continue;
    best_rank = rank[i];
    const int post = north ? PostOnBorder(Border::kNorth, 0) : PostOnBorder(Border::kSouth, 0);
    vertex = static_cast<uint32_t>(nodes[i].slot) * kVerticesPerPage + static_cast<uint32_t>(post);
  }
  return vertex;
}

uint32_t FrameIndex(Quadcode node, std::vector<Frame>& frames) {
  const Quadcode frame_node = FrameNode(node);
  const auto found = std::find_if(frames.begin(), frames.end(), [&](const Frame& f) { return f.node == frame_node; });
  if (found != frames.end()) return static_cast<uint32_t>(found - frames.begin());
  frames.push_back(FrameOf(node));
  return static_cast<uint32_t>(frames.size() - 1);
}

}  // namespace

MeshStatistics BuildSurface(std::span<const CutNode> nodes, const Sight& sight, double error_px, KeptTriangles& kept,
                            DisplayList& list) {
  MeshStatistics statistics;
  std::vector<std::span<const PostTriangle>> triangles;
  triangles.reserve(nodes.size());
  const std::vector<uint32_t> rank = RankNodes(nodes);
  BorderLines lines;
  for (size_t i = 0; i < nodes.size(); ++i) {
    const CutNode& node = nodes[i];
    const uint32_t frame = FrameIndex(node.node, list.frames);
    list.slots.push_back({node.page, node.slot, frame, node.node.SouthWest(), node.node.PostSpacing()});
    const KeptTriangles::Choice choice = kept.For(node, sight, list.frames[frame], error_px);
    if (node.visible) statistics.achieved_error_px = std::max(statistics.achieved_error_px, choice.worst * error_px);
    AddBorderPosts(node, choice.triangles, rank[i], lines);
    triangles.push_back(choice.triangles);
  }
  lines.Seal();

  const uint32_t north_pole = PoleVertex(nodes, rank, true);
  const uint32_t south_pole = PoleVertex(nodes, rank, false);
  for (size_t i = 0; i < nodes.size(); ++i) {
    const auto first_index = static_cast<uint32_t>(list.indices.size());
    Joiner joiner(nodes[i], lines, north_pole, south_pole, list.indices);
    for (const PostTriangle& triangle : triangles[i]) joiner.Append(triangle);
    const auto count = static_cast<uint32_t>(list.indices.size()) - first_index;
    list.terrain_draws.push_back({nodes[i].node, first_index, count, nodes[i].images});
    statistics.triangles += count / 3;
  }
  kept.ForgetUnused();
  return statistics;
}

}  // namespace belvedere
