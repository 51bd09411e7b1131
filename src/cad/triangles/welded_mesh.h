#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "product/product.h"

namespace hvas::cad {

using Triangle = std::array<std::uint32_t, 3>;

inline constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

/** Triangles as a file has them: any bytes will do. */
struct TriangleSoup {
  /** What the file says of a face. */
  struct GivenFace {
    std::optional<spatial::Surface> surface;
    std::optional<product::Color> color;
    std::uint64_t entity{0};
  };

  std::vector<Vec3> vertices;  ///< [m]
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> face;  ///< Each triangle's index into `faces`; empty: not known.
  std::vector<GivenFace> faces;
};

/** A piece of a mesh whose triangles hang together by their edges. */
struct MeshShell {
  bool is_closed{false};
  double volume{
      0};  ///< Follows from the divergence theorem; negative for the inside of a cavity [m^3].
  double area{0};  ///< [m^2]
  spatial::Box box;
};

/** What was odd about a mesh. */
struct MeshDefects {
  std::size_t unusable{0};      ///< Triangles with an index or a coordinate that is none.
  std::size_t degenerate{0};    ///< Triangles of fewer than three points.
  std::size_t duplicate{0};     ///< Triangles that are there already.
  std::size_t open_edges{0};    ///< Edges of one triangle.
  std::size_t shared_edges{0};  ///< Edges of more than two.
  std::size_t flipped{0};       ///< Triangles turned to agree with their neighbours.
  std::size_t turned_shells{0};
  bool has_unknown_cavities{false};  ///< It has too many shells for them to be looked for.
};

/** Triangles with shared vertices and known neighbours, outward where they close. */
struct WeldedMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> source;                    ///< Each triangle's place in the soup.
  std::vector<std::array<std::uint32_t, 3>> neighbour;  ///< Across edge k, k + 1; or kNoTriangle.
  std::vector<Vec3> normal;          ///< Unit; zero where there is no area to tell.
  std::vector<double> area;          ///< [m^2]
  std::vector<std::uint32_t> shell;  ///< Each triangle's shell.
  std::vector<MeshShell> shells;
  double diagonal{0};    ///< Diagonal of the box of all [m].
  double resolution{0};  ///< Points nearer than half of this are one; its numbers' noise [m].
  MeshDefects defects;
};

/** Welds, drops what is no triangle, divides triangles where vertices of others lie on their open
 edges (T-junctions), finds neighbours and shells, turns triangles to agree with their neighbours
 and closed shells outward; a closed shell inside another is its cavity when its triangles say so. A
 shell is closed where its rims enclose no area, so that cracks between unequal edges do no harm.
 Empty where no triangle is left. */
[[nodiscard]] WeldedMesh WeldMesh(const TriangleSoup& soup);

}  // namespace hvas::cad
