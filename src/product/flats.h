#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "product/product.h"
#include "product/recognition_limits.h"

/** Plane faces around an axis, as polygons and drives are found by them. */
namespace hvas::product {

inline constexpr double kSameFlatWidth = 1e-3;  // Share by which widths of one form may differ.
inline constexpr double kSameFlatAngle = 2e-3;  // [rad]: what exports err by. Choices.

/** A plane face with a point of its plane near its middle. */
struct Flat {
  FaceId face;
  Vec3 normal;
  Vec3 centre;
};

struct FlatExtent {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};

  void Add(double x);

  [[nodiscard]] double length() const { return high - low; }
};

/** The plane faces of a part; at most 600 of them. */
[[nodiscard]] std::vector<Flat> CollectFlats(const Part& part, RecognitionLimits* limits);

/** Extent of a face along a direction, from a point. */
[[nodiscard]] FlatExtent CalcFlatExtent(const Part& part, FaceId id, const Vec3& origin,
                                        const Vec3& dir);

/** The end of a form at which a counterpart is put on. */
struct OpenEnd {
  Vec3 origin_B{Vec3::Zero()};  ///< Point of the axis.
  Vec3 axis_B{Vec3::UnitZ()};   ///< Unit, from the open end along the flats.
  double depth{0};              ///< Length of the flats along the axis [m].
  bool is_through{false};       ///< Open at the other end, too.
};

/** Finds the open end of a form with flats of a distance `width` from `along.low` to `along.high`
 on an axis. None where the material goes on beside the flats at both ends. */
[[nodiscard]] std::optional<OpenEnd> FindOpenEnd(const Part& part, const std::vector<FaceId>& faces,
                                                 bool is_recess, double width, const Vec3& origin,
                                                 const Vec3& axis, const FlatExtent& along);

}  // namespace hvas::product
