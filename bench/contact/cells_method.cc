/** The scheme of Xia, Lopes and Restivo, "Design and implementation of a haptic-based virtual
 assembly system" (2011), section "Collision detection and dynamic simulation"; requirement X6. Its
 steps:

   0. beforehand: each part's box is cut into 3 x 3 x 3 space cells; each cell has the surfaces in
 it
   1. boxes of parts, all against the held one
   2. boxes of the cells of the two parts
   3. boxes of the surfaces in two cells that collide
   4. polygons of two surfaces whose boxes collide: position, normal and depth

 The paper does not say what boxes these are, nor what depth is between polygons. Here the held
 part's boxes are put into the other part's frame and boxed again along its axes, the cheapest that
 never misses; of two triangles that cut one another, the depth is how far the held one reaches
 below the other's plane. A pair of surfaces is looked at once, however many cells they share. The
 paper runs steps 1 to 3 in the graphics thread at 30 Hz and step 4 in another; here is their sum.
 */
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "method.h"

namespace hvas::bench {
namespace {

using spatial::Box;
using Triangle = std::array<Vec3, 3>;

constexpr int kCells = 3;  // Along each side.

Box BoxOf(const Triangle& t) {
  Box box;
  for (const Vec3& p : t) {
    box.Add(p);
  }
  return box;
}

struct Cell {
  Box box;
  std::vector<std::uint32_t> surfaces;
};

struct CellPart {
  Box box;
  std::vector<Cell> cells;
  std::vector<Box> surface_box;
  std::vector<std::vector<Triangle>> surface;  // [mm]

  explicit CellPart(const PeerMesh& mesh) : surface_box(mesh.face_count), surface(mesh.face_count) {
    for (const Vec3& v : mesh.vertices_mm) {
      box.Add(v);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& v = mesh.triangles[t];
      const Triangle triangle{mesh.vertices_mm[v[0]], mesh.vertices_mm[v[1]],
                              mesh.vertices_mm[v[2]]};
      surface[mesh.face[t]].push_back(triangle);
      surface_box[mesh.face[t]].Add(BoxOf(triangle));
    }
    const Vec3 step = box.size() / kCells;
    for (int i = 0; i < kCells * kCells * kCells; ++i) {
      const int row = i / kCells % kCells;
      const int layer = i / (kCells * kCells);
      const Vec3 at(i % kCells, row, layer);
      Cell cell;
      cell.box.low = box.low + at.cwiseProduct(step);
      cell.box.high = cell.box.low + step;
      for (std::uint32_t s = 0; s < surface.size(); ++s) {
        if (std::any_of(surface[s].begin(), surface[s].end(),
                        [&](const Triangle& t) { return BoxOf(t).Overlaps(cell.box); })) {
          cell.surfaces.push_back(s);
        }
      }
      cells.push_back(std::move(cell));
    }
  }
};

// Separating axes of two triangles: both normals, the nine products of edges, and for triangles in
// one plane the edges' normals in it.
bool Intersect(const Triangle& a, const Triangle& b) {
  const auto separates = [&](const Vec3& axis) {
    double low[2] = {std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity()};
    double high[2] = {-low[0], -low[1]};
    for (std::size_t k = 0; k < 3; ++k) {
      const double at[2] = {axis.dot(a[k]), axis.dot(b[k])};
      for (int i = 0; i < 2; ++i) {
        low[i] = std::min(low[i], at[i]);
        high[i] = std::max(high[i], at[i]);
      }
    }
    return high[0] < low[1] || high[1] < low[0];
  };
  const std::array<Vec3, 3> ea{a[1] - a[0], a[2] - a[1], a[0] - a[2]};
  const std::array<Vec3, 3> eb{b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  const Vec3 na = ea[0].cross(ea[1]);
  const Vec3 nb = eb[0].cross(eb[1]);
  if (separates(na) || separates(nb)) {
    return false;
  }
  for (const Vec3& e : ea) {
    for (const Vec3& f : eb) {
      const Vec3 axis = e.cross(f);
      if (axis.squaredNorm() > 1e-18 && separates(axis)) {
        return false;
      }
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (separates(na.cross(ea[k])) || separates(nb.cross(eb[k]))) {
      return false;
    }
  }
  return true;
}

class CellScheme : public Method {
 public:
  explicit CellScheme(MeshOf mesh_of) : mesh_of_(std::move(mesh_of)) {}

  void Load(std::size_t held, const std::vector<PlacedPart>& scene) override {
    scene_.clear();
    for (const PlacedPart& part : scene) {
      const spatial::Pose X(part.X_WB.q(), 1e3 * part.X_WB.p());
      const CellPart* cells = PartOf(part.part);
      scene_.push_back({cells, X, spatial::Transform(X, cells->box)});
    }
    held_ = PartOf(held);
  }

  std::size_t Query(const spatial::Pose& X_WH) override {
    found_.clear();
    const spatial::Pose X_WH_mm(X_WH.q(), 1e3 * X_WH.p());
    const Box box_W = spatial::Transform(X_WH_mm, held_->box);
    for (const Body& body : scene_) {
      if (body.box_W.Overlaps(box_W)) {
        Cells(body, body.X_WB.Inverse() * X_WH_mm);
      }
    }
    return found_.size();
  }

  std::span<const FoundContact> contacts() override { return found_; }

 private:
  struct Body {
    const CellPart* part;
    spatial::Pose X_WB;
    Box box_W;
  };

  const CellPart* PartOf(std::size_t part) {
    std::unique_ptr<CellPart>& cells = parts_[part];
    if (cells == nullptr) {
      cells = std::make_unique<CellPart>(mesh_of_(part));
    }
    return cells.get();
  }

  void Cells(const Body& body, const spatial::Pose& X_BH) {
    const CellPart& other = *body.part;
    held_box_.clear();
    for (const Box& box : held_->surface_box) {
      held_box_.push_back(spatial::Transform(X_BH, box));
    }
    seen_.assign(held_box_.size() * other.surface_box.size(), false);
    for (const Cell& a : held_->cells) {
      const Box box_a = spatial::Transform(X_BH, a.box);
      for (const Cell& b : other.cells) {
        if (!a.surfaces.empty() && !b.surfaces.empty() && box_a.Overlaps(b.box)) {
          Surfaces(body, X_BH, a, b);
        }
      }
    }
  }

  void Surfaces(const Body& body, const spatial::Pose& X_BH, const Cell& a, const Cell& b) {
    const CellPart& other = *body.part;
    for (const std::uint32_t s : a.surfaces) {
      for (const std::uint32_t t : b.surfaces) {
        const std::size_t pair = s * other.surface_box.size() + t;
        if (!seen_[pair] && held_box_[s].Overlaps(other.surface_box[t])) {
          Polygons(body, X_BH, s, t);
        }
        seen_[pair] = true;
      }
    }
  }

  void Polygons(const Body& body, const spatial::Pose& X_BH, std::uint32_t s, std::uint32_t t) {
    // Only polygons that reach into the other surface's box can meet one of its polygons.
    near_a_.clear();
    const Mat3 R = X_BH.R();
    for (const Triangle& triangle : held_->surface[s]) {
      const Triangle moved{R * triangle[0] + X_BH.p(), R * triangle[1] + X_BH.p(),
                           R * triangle[2] + X_BH.p()};
      const Box box = BoxOf(moved);
      if (box.Overlaps(body.part->surface_box[t])) {
        near_a_.emplace_back(moved, box);
      }
    }
    for (const Triangle& b : body.part->surface[t]) {
      const Box box = BoxOf(b);
      if (!box.Overlaps(held_box_[s])) {
        continue;
      }
      for (const auto& [a, box_a] : near_a_) {
        if (box_a.Overlaps(box) && Intersect(a, b)) {
          Report(body, a, b);
        }
      }
    }
  }

  void Report(const Body& body, const Triangle& a, const Triangle& b) {
    const Vec3 n = (b[1] - b[0]).cross(b[2] - b[0]).normalized();
    double depth = 0;
    Vec3 deepest = a[0];
    for (const Vec3& p : a) {
      const double below = n.dot(b[0] - p);
      if (below > depth) {
        depth = below;
        deepest = p;
      }
    }
    found_.push_back({1e-3 * (body.X_WB * deepest), body.X_WB.q() * n, 1e-3 * depth});
  }

  MeshOf mesh_of_;
  std::map<std::size_t, std::unique_ptr<CellPart>> parts_;
  std::vector<Body> scene_;
  const CellPart* held_{nullptr};
  std::vector<Box> held_box_;
  std::vector<bool> seen_;
  std::vector<std::pair<Triangle, Box>> near_a_;
  std::vector<FoundContact> found_;
};

}  // namespace

std::unique_ptr<Method> MakeCellScheme(MeshOf mesh_of) {
  return std::make_unique<CellScheme>(std::move(mesh_of));
}

}  // namespace hvas::bench
