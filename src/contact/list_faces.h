#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace hvas::contact {

struct Mesh;
struct ExactTable;

/** The faces of a zone's list, and how the solid comes of them there. */
struct ListFaces {
  static constexpr std::size_t kMost = 5;

  enum class Kind : std::uint8_t {
    kMixed,         ///< The triangles decide.
    kIntersection,  ///< Inside all faces: each two meet in a convex edge, or are sides of a wall.
    kUnion          ///< Inside any: each two meet in a concave edge, or are sides of a gap.
  };

  std::array<std::uint16_t, kMost> faces{};
  std::uint8_t count{0};  ///< 0: more than kMost.
  Kind kind{Kind::kMixed};
};

/** Of every list of the table. */
[[nodiscard]] std::vector<ListFaces> MakeListFaces(const Mesh& mesh, const ExactTable& exact);

}  // namespace hvas::contact
