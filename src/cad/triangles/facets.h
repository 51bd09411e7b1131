#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cad/triangles/welded_mesh.h"

namespace hvas::cad {

/** Lists of numbers, end to end. */
struct Lists {
  std::vector<std::uint32_t> begin{0};  ///< One more than there are lists.
  std::vector<std::uint32_t> items;

  [[nodiscard]] std::size_t size() const { return begin.size() - 1; }

  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t i) const {
    return std::span(items).subspan(begin[i], begin[i + 1] - begin[i]);
  }

  void Close() { begin.push_back(static_cast<std::uint32_t>(items.size())); }
};

/** An edge line between two facets. */
struct FacetLink {
  std::uint32_t facet{0};  ///< The other one.
  double length{0};        ///< [m]
  double cosine{1};        ///< Cosine of the angle between the normals.
};

/** Flat pieces of a mesh: neighbouring triangles in one plane. A facet of a tessellated cylinder is
 one strip, a flat face is one facet. */
struct Facets {
  Lists triangles;  ///< Each facet's triangles.
  Lists vertices;   ///< Each facet's vertices, each once, rising.
  /** Each facet's vertices, rising, at which its rim bends. Those along a straight line or
   inside may be there only because a program divided the triangles. The whole rim where it bends
   at fewer than three. */
  Lists corners;
  std::vector<std::uint32_t> facet;  ///< Each triangle's facet; kNoTriangle for one left out.
  std::vector<Vec3> normal;          ///< Unit; zero for a sliver.
  std::vector<Vec3> centre;          ///< Centroid [m].
  std::vector<double> area;          ///< [m^2]
  std::vector<std::uint32_t> link_begin;
  std::vector<FacetLink> links;  ///< Each facet's links, by the other's number.

  [[nodiscard]] std::size_t size() const { return normal.size(); }

  [[nodiscard]] std::span<const FacetLink> links_of(std::size_t i) const {
    return std::span(links).subspan(link_begin[i], link_begin[i + 1] - link_begin[i]);
  }
};

/** Gathers triangles into facets, the largest first.
 @param group      Of each triangle: facets keep within a group; kNoTriangle leaves it out.
 @param tolerance  How far a corner may lie off the plane of its facet [m]. */
[[nodiscard]] Facets MakeFacets(const WeldedMesh& mesh, std::span<const std::uint32_t> group,
                                double tolerance);

}  // namespace hvas::cad
