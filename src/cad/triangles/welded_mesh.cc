#include "cad/triangles/welded_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "cad/triangles/mesh_cracks.h"

namespace hvas::cad {
namespace {

// Files keep single-precision coordinates, or six to eight digits.
constexpr double kRelativeResolution = 1e-6;          // Of the diagonal.
constexpr double kSinglePrecision = 8.0 / (1 << 24);  // Of the largest coordinate.
constexpr double kLargestCoordinate = 1e9;            // [m]
constexpr double kLargestRim = 1e-5;                  // Area inside the rims over area of shell.
constexpr double kDust = 1e-6;  // Area of a piece over that of the mesh. A choice.
constexpr std::size_t kMaxNestedShells = 500;

struct CellHash {
  std::size_t operator()(const std::array<std::int64_t, 3>& cell) const {
    std::uint64_t h = 0;
    for (const std::int64_t c : cell) {
      h = (h ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h);
  }
};

/** Gives points that are nearer than a tolerance one number: that of the first of them. */
class Welder {
 public:
  Welder(const Vec3& origin, double tolerance)
      : origin_(origin), tolerance_(tolerance), inverse_(0.25 / tolerance) {}

  std::uint32_t Add(const Vec3& p) {
    const Vec3 u = inverse_ * (p - origin_);
    // A cell is four tolerances wide: mostly only one of them comes near.
    std::array<std::int64_t, 3> low{};
    std::array<std::int64_t, 3> high{};
    for (int k = 0; k < 3; ++k) {
      low[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(u[k] - 0.25));
      high[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(u[k] + 0.25));
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const auto found = first_.find({x, y, z});
          for (std::uint32_t i = found == first_.end() ? kNoTriangle : found->second;
               i != kNoTriangle; i = next_[i]) {
            if ((points_[i] - p).squaredNorm() <= tolerance_ * tolerance_) {
              return i;
            }
          }
        }
      }
    }
    const auto index = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
    const std::array<std::int64_t, 3> cell{static_cast<std::int64_t>(std::floor(u.x())),
                                           static_cast<std::int64_t>(std::floor(u.y())),
                                           static_cast<std::int64_t>(std::floor(u.z()))};
    const auto [at, is_new] = first_.try_emplace(cell, index);
    next_.push_back(is_new ? kNoTriangle : at->second);
    at->second = index;
    return index;
  }

  std::vector<Vec3> Take() { return std::move(points_); }

 private:
  Vec3 origin_;
  double tolerance_;
  double inverse_;
  std::vector<Vec3> points_;
  std::vector<std::uint32_t> next_;  // In the same cell.
  std::unordered_map<std::array<std::int64_t, 3>, std::uint32_t, CellHash> first_;
};

bool IsUsable(const TriangleSoup& soup, const Triangle& triangle) {
  return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t v) {
    return v < soup.vertices.size() && soup.vertices[v].allFinite() &&
           soup.vertices[v].cwiseAbs().maxCoeff() < kLargestCoordinate;
  });
}

void Weld(const TriangleSoup& soup, WeldedMesh* mesh) {
  spatial::Box box;
  for (const Triangle& triangle : soup.triangles) {
    if (IsUsable(soup, triangle)) {
      for (const std::uint32_t v : triangle) {
        box.Add(soup.vertices[v]);
      }
    }
  }
  if (box.is_empty()) {
    mesh->defects.unusable = soup.triangles.size();
    return;
  }
  mesh->diagonal = box.size().norm();
  const double far = std::max(box.low.cwiseAbs().maxCoeff(), box.high.cwiseAbs().maxCoeff());
  mesh->resolution = std::max(kRelativeResolution * mesh->diagonal, kSinglePrecision * far);
  if (!(mesh->diagonal > 0)) {
    mesh->defects.degenerate = soup.triangles.size();
    return;
  }
  Welder welder(box.low, 0.5 * mesh->resolution);
  std::vector<std::uint32_t> number(soup.vertices.size(), kNoTriangle);
  std::unordered_set<std::array<std::int64_t, 3>, CellHash> seen;
  seen.reserve(soup.triangles.size());
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    if (!IsUsable(soup, soup.triangles[i])) {
      ++mesh->defects.unusable;
      continue;
    }
    Triangle t{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = soup.triangles[i][k];
      if (number[v] == kNoTriangle) {
        number[v] = welder.Add(soup.vertices[v]);
      }
      t[k] = number[v];
    }
    std::array<std::int64_t, 3> key{t[0], t[1], t[2]};
    std::sort(key.begin(), key.end());
    if (key[0] == key[1] || key[1] == key[2]) {
      ++mesh->defects.degenerate;
    } else if (!seen.insert(key).second) {
      ++mesh->defects.duplicate;
    } else {
      mesh->triangles.push_back(t);
      mesh->source.push_back(static_cast<std::uint32_t>(i));
    }
  }
  mesh->vertices = welder.Take();
}

/** An edge of a triangle under the number of its two vertices. */
struct HalfEdge {
  std::uint64_t key;
  std::uint32_t triangle;
  std::uint32_t edge;
};

void FindNeighbours(WeldedMesh* mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh->triangles.size());
  for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t a = mesh->triangles[t][k];
      const std::uint64_t b = mesh->triangles[t][(k + 1) % 3];
      edges.push_back({std::min(a, b) << 32 | std::max(a, b), t, k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
  });
  mesh->defects.open_edges = 0;
  mesh->defects.shared_edges = 0;
  mesh->neighbour.assign(mesh->triangles.size(), {kNoTriangle, kNoTriangle, kNoTriangle});
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].key == edges[i].key) {
      ++end;
    }
    if (end == i + 2) {
      mesh->neighbour[edges[i].triangle][edges[i].edge] = edges[i + 1].triangle;
      mesh->neighbour[edges[i + 1].triangle][edges[i + 1].edge] = edges[i].triangle;
    } else {
      ++(end == i + 1 ? mesh->defects.open_edges : mesh->defects.shared_edges);
    }
    i = end;
  }
}

/** Divides triangles where vertices of their neighbours lie on their open edges (T-junctions), so
 that faces which were divided each by itself hang together. */
void CloseCracks(WeldedMesh* mesh) {
  constexpr int kMostPasses = 3;  // A triangle has three edges.
  for (int pass = 0; pass < kMostPasses && mesh->defects.open_edges > 0; ++pass) {
    if (!DivideCracked(mesh)) {
      return;
    }
    FindNeighbours(mesh);
  }
}

/** Whether a triangle goes along the edge from a to b in this direction. */
bool HasDirected(const Triangle& t, std::uint32_t a, std::uint32_t b) {
  return (t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b);
}

void Flip(std::uint32_t t, WeldedMesh* mesh) {
  std::swap(mesh->triangles[t][1], mesh->triangles[t][2]);
  // Edges 0 and 2 trade places, edge 1 is its own reverse.
  std::swap(mesh->neighbour[t][0], mesh->neighbour[t][2]);
}

/** Numbers the shells and turns each triangle to agree with the one it was reached from. */
void FindShells(WeldedMesh* mesh) {
  const auto count = static_cast<std::uint32_t>(mesh->triangles.size());
  mesh->shell.assign(count, kNoTriangle);
  std::vector<std::uint32_t> members;
  for (std::uint32_t seed = 0; seed < count; ++seed) {
    if (mesh->shell[seed] != kNoTriangle) {
      continue;
    }
    const auto shell = static_cast<std::uint32_t>(mesh->shells.size());
    mesh->shells.emplace_back();
    members.assign(1, seed);
    mesh->shell[seed] = shell;
    std::vector<bool> is_flipped(1, false);
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::uint32_t t = members[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t n = mesh->neighbour[t][k];
        if (n == kNoTriangle || mesh->shell[n] != kNoTriangle) {
          continue;
        }
        mesh->shell[n] = shell;
        members.push_back(n);
        const Triangle& own = mesh->triangles[t];
        is_flipped.push_back(HasDirected(mesh->triangles[n], own[k], own[(k + 1) % 3]));
        if (is_flipped.back()) {
          Flip(n, mesh);
        }
      }
    }
    const auto flipped =
        static_cast<std::size_t>(std::count(is_flipped.begin(), is_flipped.end(), true));
    // The majority was right.
    if (2 * flipped > members.size()) {
      for (const std::uint32_t t : members) {
        Flip(t, mesh);
      }
    }
    mesh->defects.flipped += std::min(flipped, members.size() - flipped);
  }
}

/** Vector area inside the rims of each shell, rim by rim. */
std::vector<double> CalcRimArea(const WeldedMesh& mesh) {
  std::vector<std::uint32_t> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&root](std::uint32_t v) {
    while (root[v] != v) {
      root[v] = root[root[v]];
      v = root[v];
    }
    return v;
  };
  const auto each_open = [&mesh](const auto& visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (mesh.neighbour[t][k] == kNoTriangle) {
          visit(t, mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
        }
      }
    }
  };
  each_open([&](std::uint32_t, std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    root[std::max(a, b)] = std::min(a, b);
  });
  std::unordered_map<std::uint64_t, Vec3> rims;  // By shell and vertex.
  each_open([&](std::uint32_t t, std::uint32_t a, std::uint32_t b) {
    const std::uint32_t r = find(a);
    const Vec3& c = mesh.vertices[r];
    Vec3& area =
        rims.try_emplace(std::uint64_t{mesh.shell[t]} << 32 | r, Vec3::Zero()).first->second;
    area += 0.5 * (mesh.vertices[a] - c).cross(mesh.vertices[b] - c);
  });
  std::vector<double> worst(mesh.shells.size(), 0.0);
  for (const auto& [key, area] : rims) {  // A maximum: the order does not matter.
    worst[key >> 32] = std::max(worst[key >> 32], area.norm());
  }
  return worst;
}

void MeasureTriangles(WeldedMesh* mesh) {
  mesh->normal.resize(mesh->triangles.size());
  mesh->area.resize(mesh->triangles.size());
  for (std::size_t t = 0; t < mesh->triangles.size(); ++t) {
    const Triangle& v = mesh->triangles[t];
    const Vec3& a = mesh->vertices[v[0]];
    const Vec3 product = (mesh->vertices[v[1]] - a).cross(mesh->vertices[v[2]] - a);
    const double norm = product.norm();
    mesh->area[t] = 0.5 * norm;
    mesh->normal[t] = norm > 0 ? Vec3(product / norm) : Vec3::Zero();
  }
}

void MeasureShells(WeldedMesh* mesh) {
  for (std::size_t t = 0; t < mesh->triangles.size(); ++t) {
    MeshShell& shell = mesh->shells[mesh->shell[t]];
    shell.area += mesh->area[t];
    for (const std::uint32_t v : mesh->triangles[t]) {
      shell.box.Add(mesh->vertices[v]);
    }
  }
  for (std::size_t t = 0; t < mesh->triangles.size(); ++t) {
    MeshShell& shell = mesh->shells[mesh->shell[t]];
    const Vec3 c = shell.box.centre();
    const Triangle& v = mesh->triangles[t];
    shell.volume +=
        (mesh->vertices[v[0]] - c).dot((mesh->vertices[v[1]] - c).cross(mesh->vertices[v[2]] - c)) /
        6;
  }
  const std::vector<double> rim = CalcRimArea(*mesh);
  for (std::size_t s = 0; s < mesh->shells.size(); ++s) {
    MeshShell& shell = mesh->shells[s];
    // A lamina encloses nothing to speak of, whatever its rims do.
    shell.is_closed = rim[s] <= kLargestRim * shell.area &&
                      std::abs(shell.volume) > 1e-9 * shell.area * shell.box.size().norm();
  }
}

/** How often a closed shell goes around a point: Van Oosterom and Strackee's solid angles. */
double CalcWinding(const WeldedMesh& mesh, const std::vector<std::uint32_t>& members,
                   const Vec3& p) {
  double angle = 0;
  for (const std::uint32_t t : members) {
    const Triangle& v = mesh.triangles[t];
    const Vec3 a = mesh.vertices[v[0]] - p;
    const Vec3 b = mesh.vertices[v[1]] - p;
    const Vec3 c = mesh.vertices[v[2]] - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * std::numbers::pi);
}

/** Turns the closed shells outward, but leaves cavities be: inside out, inside another shell. */
void OrientShells(WeldedMesh* mesh) {
  const std::size_t count = mesh->shells.size();
  std::vector<std::vector<std::uint32_t>> members(count);
  for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t) {
    members[mesh->shell[t]].push_back(t);
  }
  mesh->defects.has_unknown_cavities = count > kMaxNestedShells;
  std::vector<bool> is_turned(count, false);
  for (std::size_t s = 0; s < count; ++s) {
    MeshShell& shell = mesh->shells[s];
    if (!shell.is_closed) {
      continue;
    }
    // The shells around it, each with the sense it has in the file.
    std::optional<std::size_t> around;
    int depth = 0;
    const Triangle& first = mesh->triangles[members[s].front()];
    const Vec3 p =
        (mesh->vertices[first[0]] + mesh->vertices[first[1]] + mesh->vertices[first[2]]) / 3;
    for (std::size_t o = 0; o < count && count <= kMaxNestedShells; ++o) {
      const MeshShell& other = mesh->shells[o];
      if (o != s && other.is_closed && other.box.Contains(shell.box.low) &&
          other.box.Contains(shell.box.high) && std::abs(CalcWinding(*mesh, members[o], p)) > 0.5) {
        ++depth;
        if (!around || std::abs(other.volume) > std::abs(mesh->shells[*around].volume)) {
          around = o;
        }
      }
    }
    const bool is_cavity =
        depth % 2 == 1 && (shell.volume < 0) != (mesh->shells[*around].volume < 0);
    is_turned[s] = is_cavity ? shell.volume > 0 : shell.volume < 0;
  }
  for (std::size_t s = 0; s < count; ++s) {
    if (is_turned[s]) {
      ++mesh->defects.turned_shells;
      mesh->shells[s].volume = -mesh->shells[s].volume;
      for (const std::uint32_t t : members[s]) {
        Flip(t, mesh);
        mesh->normal[t] = -mesh->normal[t];
      }
    }
  }
}

/** Takes open pieces out that are next to nothing of the mesh, as needles are that touch nothing
 but one another. False where there are none. */
bool DropDust(WeldedMesh* mesh) {
  double area = 0;
  for (const MeshShell& shell : mesh->shells) {
    area += shell.area;
  }
  std::vector<bool> is_dust(mesh->triangles.size(), false);
  for (std::size_t t = 0; t < is_dust.size(); ++t) {
    const MeshShell& shell = mesh->shells[mesh->shell[t]];
    is_dust[t] = !shell.is_closed && shell.area < kDust * area;
  }
  if (std::find(is_dust.begin(), is_dust.end(), true) == is_dust.end()) {
    return false;
  }
  DropTriangles(is_dust, mesh);
  return true;
}

void FindPieces(WeldedMesh* mesh) {
  mesh->shells.clear();
  mesh->defects.flipped = 0;
  FindNeighbours(mesh);
  CloseCracks(mesh);
  FindShells(mesh);
  MeasureTriangles(mesh);
  MeasureShells(mesh);
}

}  // namespace

WeldedMesh WeldMesh(const TriangleSoup& soup) {
  WeldedMesh mesh;
  Weld(soup, &mesh);
  if (mesh.triangles.empty()) {
    return mesh;
  }
  FindPieces(&mesh);
  if (DropDust(&mesh)) {
    FindPieces(&mesh);
  }
  OrientShells(&mesh);
  return mesh;
}

}  // namespace hvas::cad
