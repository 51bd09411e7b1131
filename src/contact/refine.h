#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contact/face_offsets.h"
#include "contact/shape_data.h"
#include "contact/smooth_surface.h"

namespace hvas::contact {

/** Distance of a point to a shape, and what decided it. Centred frame. */
struct Refined {
  double distance{0};
  Vec3 gradient{Vec3::UnitZ()};  ///< Unit, out of the material.
  std::uint32_t face{kNoFace};
  std::uint32_t other_face{kNoFace};  ///< When an edge is closest: the other face there.
  std::uint32_t triangle{kNoFace};    ///< When it is on a freeform face: whose patch has the foot.
  bool is_exact{false};
  bool is_valid{true};  ///< False when everything near is ignored.
  /** The distance is that of the mesh of freeform faces or of the field, which was good enough. */
  bool is_rough{false};
  /** The face is continued beyond its edge with an ignored one, in material: it counts only for
   what looks at it. */
  bool is_continued{false};
};

/** Says which faces to leave out: those with mask[face] & bits. Null: none. What lies no nearer
 than `limit` need not be told exactly, only that it does not. */
struct FaceFilter {
  const std::uint8_t* mask{nullptr};
  std::uint8_t bits{0};
  double limit{std::numeric_limits<double>::infinity()};
  /** Freeform faces that their mesh puts outside beyond doubt are left at the mesh's distance. */
  bool allows_rough{false};

  [[nodiscard]] bool Drops(std::uint32_t face) const noexcept {
    return mask != nullptr && face != kNoFace && (mask[face] & bits) != 0;
  }
};

/** The distance at p on the analytic surfaces, with faces trimmed by their triangles; `field` is
 the interpolated value there, which stays where nothing better is known. Where it puts p outside
 beyond doubt, what is no nearer than the filter's limit is not looked for. RT-safe. */
[[nodiscard]] Refined Refine(const Shape::Data& shape, const Vec3& p, const Hit& field,
                             const FaceFilter& filter) noexcept;

/** Refines by the faces as made; without offsets as `Refine`. The nominal part's distance is
 taken at p less the shift of the faces near it (`SolveShift`), which is exact for planes and to
 |s|^2 / 2R for others. RT-safe. */
[[nodiscard]] Refined RefineActual(const Shape::Data& shape, const FaceOffsets* offsets,
                                   const Vec3& p, const Hit& field,
                                   const FaceFilter& filter) noexcept;

/** Refines where no interpolated value is at hand: outside, where nothing better is known.
 RT-safe. */
[[nodiscard]] inline Refined RefineAlone(const Shape::Data& shape, const FaceOffsets* offsets,
                                         const Vec3& p, const FaceFilter& filter) noexcept {
  constexpr Hit kNowhere{0, 1.0F, {0.0F, 0.0F, 1.0F}};
  return RefineActual(shape, offsets, p, kNowhere, filter);
}

/** How far a point of the nominal surface goes when all faces near it move: with the edge where it
 lies near one, so that it stays on its trimmed face. RT-safe. */
[[nodiscard]] Vec3 CalcShift(const Shape::Data& shape, const FaceOffsets& offsets,
                             const Vec3& p) noexcept;

/** The zone of the field in which a point lies: its code, and the centre its list goes by. */
struct ZoneAt {
  std::uint32_t code{0};
  Vec3 centre{Vec3::Zero()};
  double slack{0};       ///< Bound of the interpolation's error there [m].
  bool is_known{false};  ///< False outside the field and where it has no block.

  [[nodiscard]] bool is_list() const noexcept {
    return is_known && (code & ~zone::kPayload) == zone::kList;
  }

  [[nodiscard]] bool is_smooth() const noexcept {
    return is_known && (code & ~zone::kPayload) == zone::kSmooth;
  }

  [[nodiscard]] std::uint32_t payload() const noexcept { return code & zone::kPayload; }

  /** The face of a zone that is no list. */
  [[nodiscard]] std::uint32_t FaceIn(const Mesh& mesh) const noexcept {
    return is_smooth() ? mesh.face[payload()] : payload();
  }
};

[[nodiscard]] ZoneAt FindZone(const Shape::Data& shape, const Vec3& p) noexcept;

/** The faces of a zone's list; null where there are too many to be named. RT-safe. */
[[nodiscard]] inline const ListFaces* FacesOfList(const Shape::Data& shape,
                                                  std::uint32_t list) noexcept {
  const auto& faces = shape.exact.list_faces;
  return list < faces.size() && faces[list].count > 0 ? &faces[list] : nullptr;
}

/** The answer where everything near is left out. */
[[nodiscard]] inline Refined Nothing() noexcept {
  Refined nothing;
  nothing.is_valid = false;
  return nothing;
}

/** True where every face of a zone's list is left out: then nothing is near. RT-safe. */
[[nodiscard]] inline bool DropsAll(const FaceFilter& filter, const ListFaces* list) noexcept {
  return filter.bits != 0 && list != nullptr &&
         std::all_of(list->faces, list->faces + list->count,
                     [&filter](std::uint32_t face) { return filter.Drops(face); });
}

/** The faces of a zone's list as seen from a point: the unbounded surface of each, and how near its
 triangles can be. RT-safe. */
class ListDistances {
 public:
  /** The entries of one face of the list, or of all. */
  struct Entries {
    std::uint32_t begin;
    std::uint32_t end;
    double least;        ///< No triangle among them is nearer than this [m].
    std::uint32_t face;  ///< kNoFace: of several.
  };

  ListDistances(const Shape::Data& shape, std::uint32_t list, const Vec3& p) noexcept
      : faces_(FacesOfList(shape, list)),
        begin_(shape.exact.list_begin[list]),
        end_(shape.exact.list_begin[list + 1]) {
    constexpr double kRounding = 1e-9;  // [m]: the rounding of the deviations in single precision.
    for (std::size_t i = 0; i < count(); ++i) {
      const std::uint32_t f = face(i);
      surface_[i] = CalcFaceDistance(shape.exact, f, p);
      least_[i] = surface_[i].is_valid ? std::abs(surface_[i].distance) -
                                             1.001 * shape.exact.deviation[f] - kRounding
                                       : 0;
      std::size_t k = i;
      for (; k > 0 && least_[order_[k - 1]] > least_[i]; --k) {
        order_[k] = order_[k - 1];
      }
      order_[k] = static_cast<std::uint8_t>(i);
    }
  }

  /** How many faces are named. */
  [[nodiscard]] std::size_t count() const noexcept { return faces_ == nullptr ? 0 : faces_->count; }

  [[nodiscard]] std::uint32_t face(std::size_t i) const noexcept { return faces_->faces[i]; }

  [[nodiscard]] const spatial::SurfaceDistance& surface(std::size_t i) const noexcept {
    return surface_[i];
  }

  [[nodiscard]] ListFaces::Kind kind() const noexcept {
    return faces_ == nullptr ? ListFaces::Kind::kMixed : faces_->kind;
  }

  /** How many groups of entries there are. */
  [[nodiscard]] std::size_t size() const noexcept { return faces_ == nullptr ? 1 : faces_->count; }

  /** The i-th of them, those that can come nearest first. */
  [[nodiscard]] Entries operator[](std::size_t i) const noexcept {
    if (faces_ == nullptr) {
      return {begin_, end_, 0, kNoFace};
    }
    const std::size_t k = order_[i];
    const bool is_last = k + 1 == count();
    return {begin_ + faces_->begin[k], is_last ? end_ : begin_ + faces_->begin[k + 1], least_[k],
            face(k)};
  }

 private:
  const ListFaces* faces_;
  std::uint32_t begin_;
  std::uint32_t end_;
  std::array<spatial::SurfaceDistance, ListFaces::kMost> surface_;
  std::array<double, ListFaces::kMost> least_{};
  std::array<std::uint8_t, ListFaces::kMost> order_{};
};

/** Finds the closest points of those triangles of a list that can be nearer than a limit, in the
 order of the list, four at a time. RT-safe.
 @param from_centre  How far p is from the centre of the list's zone [m].
 @param limit  [m]; `visit` may lower it.
 @param is_left_out  Says it of a triangle.
 @param visit  Is told the triangle, its closest point, its feature and the square of the distance.
 */
template <typename IsLeftOut, typename Visit>
void ForEachNearTriangle(const Shape::Data& shape, const ListDistances::Entries& entries,
                         const Vec3& p, double from_centre, const double& limit,
                         IsLeftOut is_left_out, Visit visit) {
  const TriangleArrays mesh = shape.mesh.arrays();
  std::uint32_t i = entries.begin;
  while (i < entries.end) {
    std::uint32_t numbers[4];
    int count = 0;
    for (; i < entries.end && count < 4; ++i) {
      const ListedTriangle entry = shape.exact.Listed(i);
      if (entry.distance - from_centre > limit) {
        i = entries.end;
        break;
      }
      if (!is_left_out(entry.triangle)) {
        numbers[count++] = entry.triangle;
      }
    }
    if (count == 0) {
      return;
    }
    for (int k = count; k < 4; ++k) {
      numbers[k] = numbers[0];
    }
    FourClosest found;
    shape.closest(mesh, numbers, p.data(), &found);
    for (int k = 0; k < count; ++k) {
      visit(numbers[k], Vec3(found.at[0][k], found.at[1][k], found.at[2][k]),
            static_cast<TriangleFeature>(found.features[k]), found.squared[k]);
    }
  }
}

/** A face's surface, as drawn or as made; of a freeform face the smooth one near a triangle. */
class FaceSurface {
 public:
  /** @param triangle  Of a freeform face, near where the distance is wanted; else any. */
  FaceSurface(const Shape::Data& shape, const FaceOffsets* offsets, std::uint32_t face,
              std::uint32_t triangle = kNoFace)
      : shape_(shape), offsets_(offsets), face_(face), triangle_(triangle) {}

  [[nodiscard]] bool is_freeform() const noexcept { return shape_.exact.IsFreeform(face_); }

  /** A freeform face is, where a triangle of it is. */
  [[nodiscard]] bool is_known() const noexcept { return !is_freeform() || triangle_ != kNoFace; }

  /** Whether the last foot on a freeform face was not beyond its rim. */
  [[nodiscard]] bool is_on_face() const noexcept { return is_on_face_; }

  /** The distance of a point; of a freeform face, from near where it was asked last. */
  [[nodiscard]] spatial::SurfaceDistance CalcDistance(const Vec3& p) noexcept {
    if (is_freeform()) {
      return CalcCurvedDistance(p);
    }
    return offsets_ == nullptr ? CalcFaceDistance(shape_.exact, face_, p)
                               : offsets_->CalcDistance(face_, p);
  }

 private:
  [[nodiscard]] spatial::SurfaceDistance CalcCurvedDistance(const Vec3& p) noexcept {
    CurvedPoint foot;
    if (triangle_ == kNoFace || (offsets_ != nullptr && offsets_->Moves(face_)) ||
        !FindFoot(shape_.mesh, triangle_, p, FootOn::kFace, &foot)) {
      return {};
    }
    triangle_ = foot.triangle;
    is_on_face_ = foot.is_inside;
    return {(p - foot.q).dot(foot.normal), foot.normal, true};
  }

  const Shape::Data& shape_;
  const FaceOffsets* offsets_;
  std::uint32_t face_;
  std::uint32_t triangle_;
  bool is_on_face_{true};
};

/** The closest point to p on the curve where two analytic surfaces meet, from a start near it: a
 few steps of Newton's method. False when they do not meet there. RT-safe. */
[[nodiscard]] bool ProjectOnEdge(FaceSurface a, FaceSurface b, const Vec3& p, Vec3* q) noexcept;

}  // namespace hvas::contact
