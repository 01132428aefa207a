// Kept triangles: what post selection chose for a quadnode, kept from list to list for as long as it holds.
//
// Triangles are chosen a little finer than asked, by kKeepMargin, and are kept while errors surely have not grown by
// more. What the eye's moving by d does to g (cut.h) is in the choice already, as long as d is within kKeepMargin of
// the quadnode's nearest depth. What is left, for a point of depth z when they were chosen and z' now:
//
// The eye moves: depth is at least z - d then, and z at least the nearest depth.
//
// The line of view then turns by an angle a from f to f'; t = |f' - f|. What is seen at a tangent T from f' lies at an
// angle from f whose cosine is, over that of its angle from f', at most
//     cos a + T sin a <= 1 + T t,        so  z' >= (z - d) / (1 + T t);
// T is at most the greatest of what is seen of the quadnode. g = |f x m| / cosine, m normal to the line of sight, and
// |f x m| is, over |f' x m|, at least
//     cos a - T sin a >= 1 - t^2 / 2 - T t,  so  g' <= g (1 + T t) / (1 - t^2 / 2 - T t).
// Where the quadnode's greatest g was taken, what that has become bounds it too.
//
// The order is no matter: t and d say where the eye has come from, not how. W of post_selection.h is kKeepMargin wider
// than the picture for what is seen at T now and was before the turn.
//
// What is left out because it lies beside the picture stays left out as long as it surely lies there
// (post_selection.h).
//
// A post that was drawn is left out again only when its error is half the bound, or a pixel where the bound is less
// than two: so what is left out moves the surface by less than a pixel.
//
// Units: metres, pixels, ECEF. Threads: one an object.
#pragma once

#include "managers/post_selection.h"
#include "runtime/scene/display_list.h"

#include <array>
#include <unordered_map>
#include <vector>

namespace belvedere {

// The triangles of one quadnode, between the vertices of the posts that they use.
struct KeptMesh {
  struct Triangle {
    uint16_t a, b, c;  // indices of vertices
  };
  std::vector<ListVertex> vertices;  // place: the post alone
  std::vector<Triangle> inner;       // with no post on the quadnode's border
  std::vector<Triangle> at_border;
  std::vector<uint16_t> border_vertices;
  // The triangles at the border as they are joined to the neighbours': three corners (border_lines.h) each, which
  // number quadnodes as owners does.
  std::vector<uint32_t> joined;
  std::vector<Quadcode> owners;
  // Rises of the vertices are of rises_from_s and gone at rises_until_s, clock seconds; no later: none rises.
  double rises_from_s = 0, rises_until_s = 0;
};

class KeptTriangles {
 public:
  KeptTriangles();

  struct Choice {
    KeptMesh* mesh = nullptr;  // valid until the next ForgetUnused; its rises are the caller's to keep
    double worst = 0;          // largest error left, in units of the bound
    bool is_new = false;       // chosen for this list
  };
  // Chosen anew, or as they were chosen for an earlier list. frame: of the quadnode.
  // REQUIRES: the pages of the list before this one are still in memory.
  Choice For(const CutNode& node, const Sight& sight, const Frame& frame, double error_px);

  // Quadnodes that the list before had and this one has not asked for.
  std::vector<Quadcode> Unused() const;
  // Ends a list: what it did not ask for is forgotten.
  void ForgetUnused();

  uint64_t chosen() const { return chosen_; }  // quadnodes chosen anew, ever

 private:
  struct Kept {
    const TerrainPage* page = nullptr;
    Sight sight;
    double error_scale = 0;
    double greatest_stretch = 0;
    double nearest_depth_m = 0;
    double error_px = 0;
    bool finest = true;
    bool beside = false;  // something is left out because it lies beside the picture
    KeptMesh mesh;
    double worst = 0;  // in units of error_px, with the error_scale and from where it was chosen
    uint64_t list = 0;
  };
  static bool StaysBeside(const Kept& kept, const Sight& sight);
  static double GrowthOfError(const Kept& kept, const CutNode& node, const Sight& sight);
  void Choose(Kept& kept, const CutNode& node, const Sight& sight, const Frame& frame, double error_px);
  void FillMesh(const TerrainPage& page, KeptMesh& mesh);

  PostSelection posts_;
  std::vector<PostTriangle> triangles_;  // as the posts were last chosen
  std::vector<uint16_t> drawn_before_;
  std::array<uint16_t, kVerticesPerPage> vertex_of_post_{};  // scratch, kNoVertex between uses
  std::unordered_map<Quadcode, Kept> kept_;
  uint64_t list_ = 0;
  uint64_t chosen_ = 0;
};

}  // namespace belvedere
