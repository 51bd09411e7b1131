#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/result.h"
#include "contact/shape.h"

namespace hvas::contact {

struct Shell;

/** How far a face as made lies outside the face as drawn, along its normal out of the material [m].
 A shaft that is thinner and a hole that is wider than drawn both have negative offsets of half the
 deviation of the diameter. */
struct FaceOffset {
  double uniform{0};
  /** What faces of revolution add to `uniform`, at equal steps of height from `begin` to `end`,
   linear between, constant beyond. None, or at least two. Heights count along the surface's axis
   from its origin [m]. */
  std::vector<double> stations;
  double begin{0};
  double end{0};
};

/** The translation that moves planes with these unit normals outwards by these offsets: the least
 that does. Planes are taken in order, at most three; one that is nearly parallel to the span of
 those before it is passed over. RT-safe. */
struct Shift {
  Vec3 s{Vec3::Zero()};
  unsigned used{0};  ///< Bit i when plane i was taken.
};

[[nodiscard]] Shift SolveShift(std::span<const Vec3> normals,
                               std::span<const double> offsets) noexcept;

/** A part's faces as made: the offsets of all its faces from one shape. Immutable; the shape stays
 shared by all parts of its kind. */
class FaceOffsets {
 public:
  /** Larger offsets than this [m] are refused: the field is that of the nominal part. */
  static constexpr double kLargest = 0.25e-3;

  /** Offsets by face, as many as the shape has faces or fewer; the rest are zero.
   Errors: kInvalid for more faces than the shape has, an offset that is not finite or larger than
   kLargest, a single station, heights without extent, or stations on a face that has no axis. */
  static Result<std::shared_ptr<const FaceOffsets>> Make(std::shared_ptr<const Shape> shape,
                                                         std::span<const FaceOffset> offsets);

  /** Value, and its slope over the height, at a point of the shape's centred frame. RT-safe. */
  struct Value {
    double offset{0};
    double slope{0};
  };

  [[nodiscard]] Value At(std::uint32_t face, const Vec3& p) const noexcept;

  /** False for a face as drawn. RT-safe. */
  [[nodiscard]] bool Moves(std::uint32_t face) const noexcept {
    return faces_[face].uniform != 0 || faces_[face].count > 0;
  }

  /** Distance and gradient of a face as made; of a profile the gradient leans with its slope and is
   longer than one by half its square. RT-safe. */
  [[nodiscard]] spatial::SurfaceDistance CalcDistance(std::uint32_t face,
                                                      const Vec3& p) const noexcept;

  /** How far sample i of one of the shape's shells lies from where it is drawn. RT-safe. */
  [[nodiscard]] Vec3 ShiftOf(const Shell& shell, std::uint32_t i) const noexcept;

  /** The largest of all offsets and shifts of samples [m]. */
  [[nodiscard]] double largest() const noexcept { return largest_; }

  /** How far the part as made may reach beyond the part as drawn [m]. */
  [[nodiscard]] double growth() const noexcept { return growth_; }

  [[nodiscard]] const std::shared_ptr<const Shape>& shape() const noexcept { return shape_; }

  /** A number that no other offsets of the process have. */
  [[nodiscard]] std::uint64_t serial() const noexcept { return serial_; }

 private:
  struct Face {
    double uniform{0};
    double begin{0};
    double per_height{0};  // Stations per metre.
    std::uint32_t first{0};
    std::uint32_t count{0};
  };

  FaceOffsets() = default;
  void Place(const Shell& shell, std::vector<std::array<float, 3>>* shifts);

  std::shared_ptr<const Shape> shape_;
  std::vector<Face> faces_;
  std::vector<double> stations_;
  std::vector<std::array<float, 3>> shell_, features_;  // Shift of each sample.
  double largest_{0};
  double growth_{0};
  std::uint64_t serial_{0};
};

}  // namespace hvas::contact
