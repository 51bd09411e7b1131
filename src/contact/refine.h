#pragma once

#include "contact/shape_data.h"

namespace hvas::contact {

/** Distance of a point to a shape, and what decided it. Centred frame. */
struct Refined {
  double distance{0};
  Vec3 gradient{Vec3::UnitZ()};  ///< Unit, out of the material.
  std::uint32_t face{kNoFace};
  std::uint32_t other_face{kNoFace};  ///< When an edge is closest: the other face there.
  bool is_exact{false};
  bool is_valid{true};  ///< False when everything near is ignored.
};

/** Says which faces to leave out: those with mask[face] & bits. Null: none. */
struct FaceFilter {
  const std::uint8_t* mask{nullptr};
  std::uint8_t bits{0};

  [[nodiscard]] bool Drops(std::uint32_t face) const noexcept {
    return mask != nullptr && face != kNoFace && (mask[face] & bits) != 0;
  }
};

/** The distance at p on the analytic surfaces, with faces trimmed by their triangles; `field` is
 the interpolated value there, which stays where nothing better is known. RT-safe. */
[[nodiscard]] Refined Refine(const Shape::Data& shape, const Vec3& p, const Hit& field,
                             const FaceFilter& filter) noexcept;

/** The closest point to p on the curve where two analytic surfaces meet, from a start near it: a
 few steps of Newton's method. False when they do not meet there. RT-safe. */
[[nodiscard]] bool ProjectOnEdge(const spatial::Surface& a, const spatial::Surface& b,
                                 const Vec3& p, Vec3* q) noexcept;

}  // namespace hvas::contact
