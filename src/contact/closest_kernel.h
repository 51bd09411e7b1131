#pragma once

#include <cstdint>

/** Closest points on triangles, eight at once, on plain arrays: one source compiles for machines
 with AVX2, another one for those without. Both give the same bits. */
namespace hvas::contact {

/** The corners of a triangle and the dot products of its sides: what its closest point to any point
 follows from. */
struct TriangleCorners {
  double a[3];
  double b[3];
  double c[3];
  double ab_ab, ab_ac, ac_ac;
};

/** Eight points, coordinate by coordinate. */
struct EightPoints {
  double at[3][8];
};

/** The closest points on eight triangles. */
struct EightClosest {
  EightPoints q;
  double squared[8];         ///< Squares of their distances [m^2].
  std::int32_t features[8];  ///< Numbers of TriangleFeature.
};

/** The closest points on four triangles to one point. */
struct FourClosest {
  double at[3][4];           ///< The points, coordinate by coordinate.
  double squared[4];         ///< Squares of their distances [m^2].
  std::int32_t features[4];  ///< Numbers of TriangleFeature.
};

/** Triangles that share vertices, as plain arrays. */
struct TriangleArrays {
  const double (*vertices)[3];
  const std::uint32_t (*triangles)[3];
};

/** @param numbers  Which of the triangles; all four exist. */
using CalcFourClosest = void (*)(const TriangleArrays& mesh, const std::uint32_t numbers[4],
                                 const double p[3], FourClosest* out) noexcept;

void CalcFourClosestScalar(const TriangleArrays& mesh, const std::uint32_t numbers[4],
                           const double p[3], FourClosest* out) noexcept;

/** @param numbers  Which of the triangles; all eight exist.
 @param count  So many of them are wanted; what is said of the others means nothing.
 @param p  The point that is asked for with each of them. */
using CalcEightClosest = void (*)(const TriangleCorners* triangles, const std::uint32_t numbers[8],
                                  int count, const EightPoints& p, EightClosest* out) noexcept;

struct ClosestKernels {
  CalcFourClosest four;
  CalcEightClosest eight;
};

/** The fastest ones that the machine has. */
[[nodiscard]] ClosestKernels ChooseClosestKernels() noexcept;

void CalcEightClosestScalar(const TriangleCorners* triangles, const std::uint32_t numbers[8],
                            int count, const EightPoints& p, EightClosest* out) noexcept;

#ifdef HVAS_HAS_AVX2_KERNEL
void CalcEightClosestAvx2(const TriangleCorners* triangles, const std::uint32_t numbers[8],
                          int count, const EightPoints& p, EightClosest* out) noexcept;
void CalcFourClosestAvx2(const TriangleArrays& mesh, const std::uint32_t numbers[4],
                         const double p[3], FourClosest* out) noexcept;
#endif

}  // namespace hvas::contact
