// Surface morph: when a list replaces another, nothing jumps. Vertices of the new surface start where the old one was,
// and go to their places within kLeast_s or, where the way is far, at kSpeed_px_s on the screen.
//
// Where the old surface was at a post:
//   a post that the old list drew too    at its vertex, which may itself have been on its way;
//   any other                            halfway between the ends of the edge that the post splits, both found in the
//                                        same way: bisecting the old triangles adds nothing but points of their own
//                                        edges. This goes through all levels, as the posts of a quadnode are among
//                                        those of its children and the diagonals agree (bisection.h).
//
// What moves beside the picture moves nothing in it: there vertices are in their places at once, and the bound is kept
// when the view turns that way. Not at borders, where a neighbour's larger triangles may hang on them.
//
// A vertex that several quadnodes share is one vertex of the list, so that the surface stays closed on its way. A post
// that is left out jumps, by less than a pixel (kept_triangles.h).
//
// Units: clock seconds, metres, pixels. Threads: one an object.
#pragma once

#include "managers/cut.h"
#include "managers/kept_triangles.h"
#include "runtime/scene/display_list.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace belvedere {

class SurfaceMorph {
 public:
  static constexpr double kLeast_s = 0.25;
  static constexpr double kMost_s = 1.0;
  static constexpr double kSpeed_px_s = 50.0;
  static constexpr double kUnseen_px = 0.02;  // shorter ways are not gone

  // A list for that time begins. jump: the surface may jump, for the eye has.
  void Begin(double now_s, bool jump);

  // All meshes of the list are chosen. unchanged: those that are as the old list had them; of these only the border is
  // looked for again, and nothing where there is no mesh with it.
  void Prepare(const std::unordered_map<Quadcode, const KeptMesh*>& unchanged);

  // Gives the rises of a quadnode's vertices for now. is_new: its mesh was chosen for this list.
  void Place(const CutNode& node, const Sight& sight, const Frame& frame, bool is_new, KeptMesh& mesh);
  // The same for one vertex that neighbours share, of a mesh that is not new: whose vertex is drawn there may have
  // changed.
  void PlaceShared(const CutNode& node, const Frame& frame, uint16_t vertex, KeptMesh& mesh);

  // Ends the list. ranked: its draws in the order in which shared vertices are taken from them; first_vertex: of each.
  void Remember(const DisplayList& list, std::span<const uint32_t> ranked, std::span<const uint32_t> first_vertex);

 private:
  friend class OldSurface;

  void Index(uint32_t vertex, GridPoint position);
  std::optional<uint32_t> OldVertexAt(GridPoint position) const;
  glm::vec3 OldPointIn(const Frame& frame, uint32_t vertex) const;
  glm::dvec3 OldPointEcef(uint32_t vertex) const;
  void PlaceNew(const CutNode& node, const Sight& sight, const Frame& frame, KeptMesh& mesh);
  void Schedule(const CutNode& node, double most_m, KeptMesh& mesh) const;

  double now_s_ = 0;
  bool jump_ = true;
  double old_s_ = 0;
  std::shared_ptr<const std::vector<ListVertex>> old_vertices_;
  struct OldDraw {
    Quadcode node;
    uint32_t frame;
    float rise_s;
  };
  std::vector<OldDraw> old_draws_;
  std::vector<Frame> old_frames_;
  std::vector<uint32_t> old_ranked_, old_first_vertex_;
  std::vector<GridPoint> positions_;  // of the old vertices that are in the table
  std::vector<uint32_t> table_;       // old vertices by their place on the grid, open addressing

  struct Found {
    uint32_t round = 0;
    std::optional<glm::vec3> point;
  };
  std::vector<Found> found_;  // scratch of Place, by post
  uint32_t round_ = 0;
};

}  // namespace belvedere
