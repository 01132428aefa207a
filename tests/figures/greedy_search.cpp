#include "tests/figures/greedy_search.h"

#include <algorithm>
#include <utility>

namespace belvedere::figures {
namespace {

constexpr std::array<CornerPosts, 2> kRoots{CornerPosts{{kCells, 0}, {kCells, kCells}, {0, 0}},
                                            CornerPosts{{0, kCells}, {0, 0}, {kCells, kCells}}};

std::array<CornerPosts, 2> HalvesOf(const CornerPosts& triangle) {
  return {CornerPosts{triangle.middle(), triangle.apex, triangle.b},
          CornerPosts{triangle.middle(), triangle.c, triangle.apex}};
}

// The two of the cell north-east of the post; the diagonal: preproc/surface_error.h.
std::array<CornerPosts, 2> FinestTriangles(Post sw) {
  const Post se{sw.column + 1, sw.row}, nw{sw.column, sw.row + 1}, ne{sw.column + 1, sw.row + 1};
  if ((sw.column + sw.row) % 2 == 0) return {CornerPosts{se, ne, sw}, CornerPosts{nw, sw, ne}};
  return {CornerPosts{sw, se, nw}, CornerPosts{ne, nw, se}};
}

}  // namespace

// The bisection of one quadnode.
class GreedySearch::Bisection {
 public:
  Bisection(GreedySearch& search, const SeenPosts& posts) : search_(search), posts_(posts) {
    for (const Post corner : {Post{0, 0}, Post{kCells, 0}, Post{0, kCells}, Post{kCells, kCells}}) {
      drawn_[static_cast<size_t>(corner.index())] = true;
    }
  }

  DrawnPosts Run() {
    do {
      changed_ = false;
      for (const CornerPosts& root : kRoots) Visit(root, 0);
    } while (changed_);
    return std::move(drawn_);
  }

 private:
  void Visit(const CornerPosts& triangle, int level) {
    if (level == kBisectionLevels) return;
    const Post middle = triangle.middle();
    const auto index = static_cast<size_t>(middle.index());
    if (!drawn_[index]) {
      const size_t side = SplitAt(middle).apex_a == triangle.apex ? 0 : 1;
      if (within_[2 * index + side]) return;
      within_[2 * index + side] = search_.ErrorOf(posts_, triangle) <= search_.bound_px_;
      if (within_[2 * index + side]) return;
      Draw(middle);
    }
    for (const CornerPosts& half : HalvesOf(triangle)) Visit(half, level + 1);
  }

  void Draw(Post post) {
    const auto index = static_cast<size_t>(post.index());
    if (drawn_[index]) return;
    drawn_[index] = true;
    changed_ = true;
    const Split split = SplitAt(post);
    for (const Post parent : {split.apex_a, split.apex_b}) {
      if (parent.inside()) Draw(parent);
    }
  }

  GreedySearch& search_;
  const SeenPosts& posts_;
  DrawnPosts drawn_ = DrawnPosts(kVerticesPerPage);
  std::vector<bool> within_ = std::vector<bool>(2 * kVerticesPerPage);  // the triangles on either side of a post
  bool changed_ = false;
};

std::vector<GreedySearch::Chosen> GreedySearch::Run() {
  std::vector<Chosen> chosen;
  for (int tree = 0; tree < kTrees; ++tree) Walk(Quadcode::Root(tree), chosen);
  return chosen;
}

void GreedySearch::Walk(Quadcode node, std::vector<Chosen>& chosen) {
  if (KeepsBound(node)) {
    chosen.push_back({node, Choose(node)});
    return;
  }
  for (const int which : node.Children()) Walk(node.Child(which), chosen);
}

DrawnPosts GreedySearch::Choose(Quadcode node) {
  return Bisection(*this, PostsOf(node)).Run();
}

double GreedySearch::Largest_px(Quadcode node, const DrawnPosts& drawn) {
  return LargestUnder(PostsOf(node), drawn, kRoots, 0);
}

double GreedySearch::LargestUnder(const SeenPosts& posts, const DrawnPosts& drawn,
                                  const std::array<CornerPosts, 2>& pair, int level) {
  double largest = 0;
  for (const CornerPosts& triangle : pair) {
    const bool split = level < kBisectionLevels && drawn[static_cast<size_t>(triangle.middle().index())];
    largest =
        std::max(largest, split ? LargestUnder(posts, drawn, HalvesOf(triangle), level + 1) : ErrorOf(posts, triangle));
  }
  return largest;
}

bool GreedySearch::IsSeen(Quadcode node) {
  const TerrainPage& page = terrain_.PageOf(node);
  const BoundingSphere sphere{page.center_ecef, page.radius_m};
  return !matrices_.horizon.Hides(sphere) && !matrices_.frustum.Hides(sphere);
}

const SeenPosts& GreedySearch::PostsOf(Quadcode node) {
  const auto found = posts_.find(node);
  if (found != posts_.end()) return found->second;
  return posts_.emplace(node, errors_.Look(terrain_.PageOf(node))).first->second;
}

const std::vector<const SeenPosts*>& GreedySearch::FullUnder(Quadcode node) {
  const auto found = full_.find(node);
  if (found != full_.end()) return found->second;
  std::vector<const SeenPosts*> full;
  if (IsSeen(node) && !terrain_.HasFiner(node)) {
    full.push_back(&PostsOf(node));
  } else if (IsSeen(node)) {
    for (const int which : node.Children()) {
      const std::vector<const SeenPosts*>& under = FullUnder(node.Child(which));
      full.insert(full.end(), under.begin(), under.end());
    }
  }
  return full_.emplace(node, std::move(full)).first->second;
}

double GreedySearch::ErrorOf(const SeenPosts& posts, const CornerPosts& triangle) {
  double largest = 0;
  for (const SeenPosts* full : FullUnder(posts.node))
    largest = std::max(largest, errors_.LargestOver(*full, posts, triangle));
  return largest;
}

// Whether the finest triangles of the quadnode do; looked at below one full-resolution quadnode after the other.
bool GreedySearch::KeepsBound(Quadcode node) {
  if (!terrain_.HasFiner(node)) return true;
  const SeenPosts& posts = PostsOf(node);
  for (const SeenPosts* full : FullUnder(node)) {
    const GridPoint from = node.SouthWest(), to = full->node.SouthWest();
    const auto west = static_cast<int>((to.x - from.x) / node.PostSpacingEast());
    const auto south = static_cast<int>((to.y - from.y) / node.PostSpacingNorth());
    const int columns = std::max(static_cast<int>(full->node.GridWidth() / node.PostSpacingEast()), 1);
    const int rows = std::max(static_cast<int>(full->node.GridHeight() / node.PostSpacingNorth()), 1);
    for (int cell = 0; cell < columns * rows; ++cell) {
      for (const CornerPosts& triangle : FinestTriangles({west + cell % columns, south + cell / columns})) {
        if (errors_.LargestOver(*full, posts, triangle) > bound_px_) return false;
      }
    }
  }
  return true;
}

}  // namespace belvedere::figures
