#include "managers/border_joiner.h"

#include "runtime/base/status.h"

#include <algorithm>
#include <array>
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

class Joiner {
 public:
  Joiner(const CutNode& node, const KeptMesh& mesh, uint32_t number, const BorderLines& lines, const PoleCorners& poles,
         std::vector<uint32_t>& out)
      : mesh_(mesh), number_(number), out_(out) {
    for (const Border border : kBorders) {
      Side& side = sides_[static_cast<size_t>(border)];
      const bool polar = (border == Border::kNorth && node.node.touches_north_pole()) ||
                         (border == Border::kSouth && node.node.touches_south_pole());
      if (polar) {
        side.pole = border == Border::kNorth ? poles.north : poles.south;
        continue;
      }
      const uint64_t start = BorderLines::PositionOf(node.node, border, 0);
      const uint64_t spacing = BorderLines::SpacingAlong(node.node, border);
      for (const BorderVertex& vertex : lines.Along(node.node, border)) {
        const uint64_t offset = vertex.position - start;
        if (offset % spacing == 0) side.at_post[offset / spacing] = &vertex;
      }
    }
  }

  void Append() {
    for (const KeptMesh::Triangle& triangle : mesh_.at_border) {
      const std::array<uint16_t, 3> own{triangle.a, triangle.b, triangle.c};
      std::array<int, 3> posts;
      std::array<uint32_t, 3> corners;
      for (size_t i = 0; i < 3; ++i) {
        posts[i] = static_cast<int>(mesh_.vertices[own[i]].post());
        corners[i] = Canonical(posts[i], own[i]);
      }
      AppendAtBorder(posts, corners);
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
    if (bits == 0) return CornerOf(number_, own);
    std::optional<uint32_t> found;
    for (const Border border : kBorders) {
      if ((bits & (1U << static_cast<unsigned>(border))) == 0) continue;
      const Side& side = sides_[static_cast<size_t>(border)];
      if (side.pole) return *side.pole;
      found = At(side, AlongBorder(post, border))->corner;
    }
    return *found;
  }

  // Canonical corners strictly between two posts of one border, in the order from `from` to `to`.
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
    for (const BorderVertex* v = low + 1; v < high; ++v) between.push_back(v->corner);
    if (a > b) std::reverse(between.begin(), between.end());
  }

  void AppendAtBorder(const std::array<int, 3>& posts, const std::array<uint32_t, 3>& corners) {
    for (size_t i = 0; i < 3; ++i) Between(posts[i], posts[(i + 1) % 3], edges_[i]);
    for (size_t i = 0; i < 3; ++i) {
      if (corners[(i + 1) % 3] == corners[(i + 2) % 3]) {
        AppendAtPole(corners[(i + 1) % 3], corners[i], edges_[(i + 2) % 3], edges_[i]);
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
    const uint32_t next = second.empty() ? corners[q] : second.front();
    Fan(next, corners[p], first, corners[v]);
    if (second.empty()) return;
    uint32_t previous = next;
    for (size_t i = 1; i < second.size(); ++i) {
      Emit(corners[p], previous, second[i]);
      previous = second[i];
    }
    Emit(corners[p], previous, corners[q]);
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
    for (const uint32_t corner : between) {
      Emit(apex, previous, corner);
      previous = corner;
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
  const uint32_t number_;
  std::vector<uint32_t>& out_;
  std::array<Side, 4> sides_;
  std::array<std::vector<uint32_t>, 3> edges_;
};

// That of the best-ranked quadnode that touches the pole; corners of a quadnode are always drawn.
uint32_t PoleCorner(std::span<const CutNode> nodes, std::span<const KeptMesh* const> meshes,
                    std::span<const uint32_t> ranked, bool north) {
  for (const uint32_t number : ranked) {
    const Quadcode node = nodes[number].node;
    if (north ? !node.touches_north_pole() : !node.touches_south_pole()) continue;
    const auto post = static_cast<uint32_t>(PostOnBorder(north ? Border::kNorth : Border::kSouth, 0));
    const std::vector<ListVertex>& vertices = meshes[number]->vertices;
    const auto found =
        std::find_if(vertices.begin(), vertices.end(), [&](const ListVertex& v) { return v.post() == post; });
    return CornerOf(number, static_cast<uint32_t>(found - vertices.begin()));
  }
  return 0;
}

}  // namespace

PoleCorners PoleCornersOf(std::span<const CutNode> nodes, std::span<const KeptMesh* const> meshes,
                          std::span<const uint32_t> ranked) {
  return {PoleCorner(nodes, meshes, ranked, true), PoleCorner(nodes, meshes, ranked, false)};
}

void AddBorderPosts(const CutNode& node, const KeptMesh& mesh, uint32_t number, uint32_t rank, BorderLines& lines) {
  for (const uint16_t own : mesh.border_vertices) {
    const auto post = static_cast<int>(mesh.vertices[own].post());
    for (const Border border : kBorders) {
      if (OnBorder(post, border)) lines.Add(node.node, border, AlongBorder(post, border), CornerOf(number, own), rank);
    }
  }
}

void JoinBorders(const CutNode& node, const KeptMesh& mesh, uint32_t number, const BorderLines& lines,
                 const PoleCorners& poles, std::vector<uint32_t>& out) {
  Joiner(node, mesh, number, lines, poles, out).Append();
}

}  // namespace belvedere
