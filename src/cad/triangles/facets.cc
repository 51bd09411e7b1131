#include "cad/triangles/facets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "spatial/decompose.h"

namespace hvas::cad {
namespace {

constexpr double kFlatCosine = 0.99985;  // One degree.
constexpr double kSliver = 4;  // Lowest height of a triangle with a normal, in tolerances.

/** Grows one facet at a time. */
class FacetGrower {
 public:
  FacetGrower(const WeldedMesh& mesh, std::span<const std::uint32_t> group, double tolerance,
              Facets* facets)
      : mesh_(mesh), group_(group), tolerance_(tolerance), facets_(facets) {
    stamp_.assign(mesh.triangles.size(), 0);
  }

  [[nodiscard]] bool IsSliver(std::uint32_t t) const {
    const Triangle& v = mesh_.triangles[t];
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      longest = std::max(longest, (mesh_.vertices[v[(k + 1) % 3]] - mesh_.vertices[v[k]]).norm());
    }
    return !(2 * mesh_.area[t] > kSliver * tolerance_ * longest);
  }

  void Add(std::uint32_t seed) {
    members_.assign(1, seed);
    if (!IsSliver(seed)) {
      Collect(seed, mesh_.vertices[mesh_.triangles[seed][0]], mesh_.normal[seed]);
      if (members_.size() >
          4) {  // A plane through many corners is truer than that of one triangle.
        Vec3 p = Vec3::Zero();
        Vec3 nhat = mesh_.normal[seed];
        FitPlane(&p, &nhat);
        Collect(seed, p, nhat);
      }
    }
    const auto index = static_cast<std::uint32_t>(facets_->triangles.size());
    for (const std::uint32_t t : members_) {
      facets_->facet[t] = index;
      facets_->triangles.items.push_back(t);
    }
    facets_->triangles.Close();
  }

 private:
  [[nodiscard]] bool IsOn(std::uint32_t t, const Vec3& p, const Vec3& nhat) const {
    for (const std::uint32_t v : mesh_.triangles[t]) {
      if (std::abs((mesh_.vertices[v] - p).dot(nhat)) > tolerance_) {
        return false;
      }
    }
    return mesh_.normal[t].dot(nhat) > kFlatCosine || IsSliver(t);
  }

  void Collect(std::uint32_t seed, const Vec3& p, const Vec3& nhat) {
    ++round_;
    members_.assign(1, seed);
    stamp_[seed] = round_;
    for (std::size_t i = 0; i < members_.size(); ++i) {
      for (const std::uint32_t n : mesh_.neighbour[members_[i]]) {
        if (n != kNoTriangle && stamp_[n] != round_ && facets_->facet[n] == kNoTriangle &&
            group_[n] == group_[seed] && IsOn(n, p, nhat)) {
          stamp_[n] = round_;
          members_.push_back(n);
        }
      }
    }
  }

  void FitPlane(Vec3* p, Vec3* nhat) const {
    Vec3 centre = Vec3::Zero();
    double weight = 0;
    for (const std::uint32_t t : members_) {
      for (const std::uint32_t v : mesh_.triangles[t]) {
        centre += mesh_.area[t] * mesh_.vertices[v];
        weight += mesh_.area[t];
      }
    }
    centre /= weight;
    Mat3 C = Mat3::Zero();
    for (const std::uint32_t t : members_) {
      for (const std::uint32_t v : mesh_.triangles[t]) {
        const Vec3 q = mesh_.vertices[v] - centre;
        C += mesh_.area[t] * q * q.transpose();
      }
    }
    const Vec3 axis = spatial::CalcEigensystem(C).vectors.col(0);
    *p = centre;
    *nhat = axis.dot(*nhat) < 0 ? Vec3(-axis) : axis;
  }

  const WeldedMesh& mesh_;
  std::span<const std::uint32_t> group_;
  double tolerance_;
  Facets* facets_;
  std::vector<std::uint32_t> stamp_;
  std::vector<std::uint32_t> members_;
  std::uint32_t round_{0};
};

/** Finds the vertices at which the rim of a facet bends. */
class CornerFinder {
 public:
  CornerFinder(const WeldedMesh& mesh, double tolerance) : mesh_(mesh), tolerance_(tolerance) {
    visits_.resize(mesh.vertices.size());
  }

  void Add(std::uint32_t facet, Facets* facets) {
    for (const std::uint32_t v : facets->vertices[facet]) {
      visits_[v] = {};
    }
    for (const std::uint32_t t : facets->triangles[facet]) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t n = mesh_.neighbour[t][k];
        if (n == kNoTriangle || facets->facet[n] != facet) {
          const std::uint32_t a = mesh_.triangles[t][k];
          const std::uint32_t b = mesh_.triangles[t][(k + 1) % 3];
          visits_[a].next = b;
          visits_[b].previous = a;
          ++visits_[a].count;
        }
      }
    }
    const std::size_t first = facets->corners.items.size();
    Collect(
        facet, [this](std::uint32_t v) { return visits_[v].count > 1 || Bends(v); }, facets);
    if (facets->corners.items.size() < first + 3) {  // A disc with a fine rim bends nowhere.
      facets->corners.items.resize(first);
      Collect(
          facet, [](std::uint32_t) { return true; }, facets);
    }
    facets->corners.Close();
  }

 private:
  template <class Filter>
  void Collect(std::uint32_t facet, const Filter& is_corner, Facets* facets) const {
    for (const std::uint32_t v : facets->vertices[facet]) {
      if (visits_[v].count > 0 && is_corner(v)) {
        facets->corners.items.push_back(v);
      }
    }
  }

  struct Visit {
    std::uint32_t previous{kNoTriangle};
    std::uint32_t next{kNoTriangle};
    int count{0};
  };

  [[nodiscard]] bool Bends(std::uint32_t v) const {
    if (visits_[v].previous == kNoTriangle) {
      return true;
    }
    const Vec3& p = mesh_.vertices[v];
    const Vec3 before = p - mesh_.vertices[visits_[v].previous];
    const Vec3 after = mesh_.vertices[visits_[v].next] - p;
    const Vec3 line = before + after;
    return before.dot(after) <= 0 || before.cross(line).norm() > tolerance_ * line.norm();
  }

  const WeldedMesh& mesh_;
  double tolerance_;
  std::vector<Visit> visits_;
};

void Measure(const WeldedMesh& mesh, const FacetGrower& grower, Facets* facets) {
  std::vector<std::uint32_t> seen(mesh.vertices.size(), kNoTriangle);
  for (std::uint32_t f = 0; f < facets->triangles.size(); ++f) {
    Vec3 normal = Vec3::Zero();
    Vec3 moment = Vec3::Zero();
    double area = 0;
    bool is_sliver = true;
    const auto first = static_cast<std::ptrdiff_t>(facets->vertices.items.size());
    for (const std::uint32_t t : facets->triangles[f]) {
      is_sliver = is_sliver && grower.IsSliver(t);
      normal += mesh.area[t] * mesh.normal[t];
      area += mesh.area[t];
      for (const std::uint32_t v : mesh.triangles[t]) {
        moment += mesh.area[t] / 3 * mesh.vertices[v];
        if (seen[v] != f) {
          seen[v] = f;
          facets->vertices.items.push_back(v);
        }
      }
    }
    std::sort(facets->vertices.items.begin() + first, facets->vertices.items.end());
    facets->vertices.Close();
    facets->normal.push_back(is_sliver ? Vec3::Zero() : Vec3(normal.normalized()));
    facets->centre.push_back(area > 0
                                 ? Vec3(moment / area)
                                 : mesh.vertices[mesh.triangles[facets->triangles[f].front()][0]]);
    facets->area.push_back(area);
  }
}

void Link(const WeldedMesh& mesh, Facets* facets) {
  facets->link_begin.assign(1, 0);
  std::vector<FacetLink> links;
  for (std::uint32_t f = 0; f < facets->size(); ++f) {
    links.clear();
    for (const std::uint32_t t : facets->triangles[f]) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t n = mesh.neighbour[t][k];
        if (n == kNoTriangle || facets->facet[n] == kNoTriangle || facets->facet[n] == f) {
          continue;
        }
        const Triangle& v = mesh.triangles[t];
        links.push_back(
            {facets->facet[n], (mesh.vertices[v[(k + 1) % 3]] - mesh.vertices[v[k]]).norm(), 1});
      }
    }
    std::stable_sort(links.begin(), links.end(),
                     [](const FacetLink& a, const FacetLink& b) { return a.facet < b.facet; });
    for (std::size_t i = 0; i < links.size(); ++i) {
      if (i > 0 && links[i].facet == links[i - 1].facet) {
        facets->links.back().length += links[i].length;
      } else {
        facets->links.push_back(links[i]);
        facets->links.back().cosine = facets->normal[f].dot(facets->normal[links[i].facet]);
      }
    }
    facets->link_begin.push_back(static_cast<std::uint32_t>(facets->links.size()));
  }
}

}  // namespace

Facets MakeFacets(const WeldedMesh& mesh, std::span<const std::uint32_t> group, double tolerance) {
  Facets facets;
  facets.facet.assign(mesh.triangles.size(), kNoTriangle);
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&mesh](std::uint32_t a, std::uint32_t b) {
    return mesh.area[a] != mesh.area[b] ? mesh.area[a] > mesh.area[b] : a < b;
  });
  FacetGrower grower(mesh, group, tolerance, &facets);
  for (const std::uint32_t t : order) {
    if (group[t] != kNoTriangle && facets.facet[t] == kNoTriangle) {
      grower.Add(t);
    }
  }
  Measure(mesh, grower, &facets);
  CornerFinder corners(mesh, tolerance);
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    corners.Add(f, &facets);
  }
  Link(mesh, &facets);
  return facets;
}

}  // namespace hvas::cad
