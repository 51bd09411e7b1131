#include <algorithm>
#include <cmath>

#include "contact/refine.h"

namespace hvas::contact {
namespace {

// The faces that may be the closest once all are where they were made, nearest first.
class NearFaces {
 public:
  NearFaces(const Shape::Data& shape, const FaceOffsets& offsets, const ZoneAt& at, const Vec3& p)
      : p_(p) {
    if (!at.is_known) {
      return;
    }
    if (!at.is_list()) {
      Add(at.FaceIn(shape.mesh), 0);
    } else if (!Gather(shape, offsets, at.payload(), (p - at.centre).norm())) {
      return;
    }
    for (std::size_t i = 0; i < count_; ++i) {
      const auto exact = CalcFaceDistance(shape.exact, face_[i], p);
      is_exact_ = is_exact_ && exact.is_valid;
      normals_[i] = exact.gradient;
      offsets_[i] = offsets.At(face_[i], p).offset;
      is_moved_ = is_moved_ || offsets_[i] != 0;
    }
    is_outside_ = count_ > 0 && CalcFaceDistance(shape.exact, face_[0], p).distance >= 0;
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  [[nodiscard]] std::uint32_t face(std::size_t i) const { return face_[i]; }

  [[nodiscard]] double offset(std::size_t i) const { return offsets_[i]; }

  [[nodiscard]] bool is_moved() const { return is_moved_; }

  [[nodiscard]] bool is_exact() const { return is_exact_; }

  [[nodiscard]] bool is_outside() const { return is_outside_; }

  [[nodiscard]] bool IsOpposed(std::size_t i) const { return normals_[i].dot(normals_[0]) < 0; }

  /** The shift that serves face i and as many of the others as can be. */
  [[nodiscard]] Shift ShiftFor(std::size_t i) const {
    std::array<Vec3, kMost> normals = normals_;
    std::array<double, kMost> offsets = offsets_;
    std::rotate(normals.begin(), normals.begin() + static_cast<std::ptrdiff_t>(i),
                normals.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    std::rotate(offsets.begin(), offsets.begin() + static_cast<std::ptrdiff_t>(i),
                offsets.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    return SolveShift({normals.data(), count_}, {offsets.data(), count_});
  }

 private:
  static constexpr std::size_t kMost = 4;  // Faces that meet at a point: kMaxPointFaces.
  static constexpr double kReach = 3;  // In offsets: both faces move, and edges further than faces.

  // False where no face of the list moves.
  bool Gather(const Shape::Data& shape, const FaceOffsets& offsets, std::uint32_t list,
              double from_centre) {
    const ListFaces* named = FacesOfList(shape, list);
    if (named != nullptr &&
        std::none_of(named->faces, named->faces + named->count,
                     [&offsets](std::uint32_t face) { return offsets.Moves(face); })) {
      return false;
    }
    const ListDistances faces(shape, list, p_);
    double limit = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < faces.size() && faces[k].least <= limit; ++k) {
      ForEachNearTriangle(
          shape, faces[k], p_, from_centre, limit, [](std::uint32_t) { return false; },
          [&](std::uint32_t triangle, const Vec3&, TriangleFeature, double squared) {
            const double distance = std::sqrt(squared);
            if (distance <= limit) {
              Add(shape.mesh.face[triangle], distance);
              limit = distance_[0] + kReach * offsets.largest() + 1e-6 * from_centre;
            }
          });
    }
    while (count_ > 0 && distance_[count_ - 1] > limit) {
      --count_;
    }
    return true;
  }

  void Add(std::uint32_t face, double distance) {
    std::size_t at = 0;
    while (at < count_ && face_[at] != face) {
      ++at;
    }
    if (at == count_ && count_ < kMost) {
      ++count_;
    } else if (at == count_ && distance < distance_[kMost - 1]) {
      at = kMost - 1;
    } else if (at == count_ || distance >= distance_[at]) {
      return;
    }
    for (; at > 0 && distance_[at - 1] > distance; --at) {
      face_[at] = face_[at - 1];
      distance_[at] = distance_[at - 1];
    }
    face_[at] = face;
    distance_[at] = distance;
  }

  const Vec3& p_;
  std::size_t count_{0};
  std::array<std::uint32_t, kMost> face_{};
  std::array<double, kMost> distance_{};
  std::array<Vec3, kMost> normals_;
  std::array<double, kMost> offsets_{};
  bool is_moved_{false};
  bool is_exact_{true};
  bool is_outside_{true};
};

// The nominal part's answer at p - s, which is the actual part's at p.
Refined RefineShifted(const Shape::Data& shape, const FaceOffsets& offsets, const Vec3& p,
                      const Vec3& s, const Hit& field, const FaceFilter& filter) {
  Hit moved = field;
  for (Eigen::Index k = 0; k < 3; ++k) {
    moved.distance -= field.gradient[k] * static_cast<float>(s[k]);
  }
  Refined r = Refine(shape, p - s, moved, filter);
  if (r.is_valid && r.is_exact && r.other_face == kNoFace) {
    r.gradient -= offsets.At(r.face, p).slope * shape.exact.faces[r.face].axis;
  }
  return r;
}

}  // namespace

Vec3 CalcShift(const Shape::Data& shape, const FaceOffsets& offsets, const Vec3& p) noexcept {
  const NearFaces near(shape, offsets, FindZone(shape, p), p);
  return near.is_exact() && near.is_moved() ? near.ShiftFor(0).s : Vec3::Zero();
}

Refined RefineActual(const Shape::Data& shape, const FaceOffsets* offsets, const Vec3& p,
                     const Hit& field, const FaceFilter& filter) noexcept {
  if (offsets == nullptr) {
    return Refine(shape, p, field, filter);
  }
  const ZoneAt at = FindZone(shape, p);
  if (at.is_list() && DropsAll(filter, FacesOfList(shape, at.payload()))) {
    return Nothing();
  }
  const NearFaces near(shape, *offsets, at, p);
  if (!near.is_moved()) {
    return Refine(shape, p, field, filter);
  }
  if (!near.is_exact()) {  // A freeform face has no surface to ask: the field's own direction.
    Refined r = Refine(shape, p, field, filter);
    r.distance -= near.offset(0);
    return r;
  }
  const Shift shift = near.ShiftFor(0);
  Refined best = RefineShifted(shape, *offsets, p, shift.s, field, filter);
  // Across a thin wall or a narrow gap no shift serves both sides: the other one by itself. Between
  // two walls the nearer counts, within one the nearer side too.
  for (std::size_t i = 1; i < near.count(); ++i) {
    if ((shift.used >> i & 1U) != 0 || !near.IsOpposed(i)) {
      continue;
    }
    const Refined other = RefineShifted(shape, *offsets, p, near.ShiftFor(i).s, field, filter);
    const bool is_closer =
        near.is_outside() ? other.distance < best.distance : other.distance > best.distance;
    if (other.is_valid && other.face == near.face(i) && (is_closer || !best.is_valid)) {
      best = other;
    }
  }
  return best;
}

}  // namespace hvas::contact
