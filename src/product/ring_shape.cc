#include "product/ring_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "spatial/decompose.h"

namespace hvas::product {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;  // [rad], by definition.
constexpr double kHighestRing = 0.3;  // Of the outer diameter; what is higher is a tube. A choice.
constexpr double kNarrowestBore = 0.3;  // Of the outer radius; DIN 6799 has 0.36 on.
constexpr double kLeastRingFilled =
    2.0 / 3;                              // Of the rectangle of its section: round wire has pi / 4.
constexpr double kMostRingFilled = 1.05;  // What the chords of a mesh make of a full one. A choice.
constexpr double kLeastSplit = 10e-6;     // [m]; neighbouring faces of a mesh meet within less.

/** The axis with the largest moment of inertia; one of B's where it is nearly that. */
Vec3 FindRingAxis(const Part& part) {
  constexpr double kNearAxis = 1 - 1e-6;  // Cosine of 1.4 mrad. A choice.
  const spatial::Eigensystem system = spatial::CalcEigensystem(part.mass.I_BBcm_B);
  const Vec3 axis = system.vectors.col(2).normalized();  // Eigenvalues ascend.
  for (int k = 0; k < 3; ++k) {
    if (std::abs(axis[k]) > kNearAxis) {
      return Vec3::Unit(k);
    }
  }
  return axis;
}

/** A point of the axis: that of the largest round face about it; none where no face is. */
std::optional<Vec3> FindAxisPoint(const Part& part, Vec3* axis_B) {
  constexpr double kParallel = 0.9998;  // Cosine: within 1.1 degrees. A choice.
  const Face* largest = nullptr;
  for (const Face& face : part.faces) {
    const SurfaceKind kind = face.surface.kind;
    const bool is_round =
        kind == SurfaceKind::kCylinder || kind == SurfaceKind::kTorus || kind == SurfaceKind::kCone;
    if (is_round && std::abs(face.surface.axis.dot(*axis_B)) > kParallel &&
        (largest == nullptr || face.area > largest->area)) {
      largest = &face;
    }
  }
  if (largest == nullptr) {
    return std::nullopt;
  }
  *axis_B = largest->surface.axis.normalized();
  return largest->surface.origin;
}

}  // namespace

double CalcOpenAngle(const Part& part, const Vec3& centre_B, const Vec3& axis_B, double height) {
  const Vec3 u = axis_B.unitOrthogonal();
  const Vec3 v = axis_B.cross(u);
  std::vector<std::array<double, 2>> covered;  // From and to, from below a turn on.
  for (const auto& triangle : part.mesh.triangles) {
    std::vector<double> angles;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = part.mesh.vertices[triangle[k]] - centre_B;
      const Vec3 b = part.mesh.vertices[triangle[(k + 1) % 3]] - centre_B;
      const double above_a = a.dot(axis_B) - height;
      const double above_b = b.dot(axis_B) - height;
      if ((above_a > 0) != (above_b > 0)) {
        const Vec3 p = a + above_a / (above_a - above_b) * (b - a);
        angles.push_back(std::atan2(p.dot(v), p.dot(u)));
      }
    }
    if (angles.size() == 2) {
      const double low = std::min(angles[0], angles[1]);
      const double high = std::max(angles[0], angles[1]);
      if (high - low < std::numbers::pi) {
        covered.push_back({low, high});
      } else {  // It goes across the half turn.
        covered.push_back({high, low + kFullTurn});
      }
    }
  }
  if (covered.empty()) {
    return kFullTurn;
  }
  std::sort(covered.begin(), covered.end());
  double end = covered.front()[0];
  double widest = 0;
  for (const auto& [from, to] : covered) {
    widest = std::max(widest, from - end);
    end = std::max(end, to);
  }
  // What goes across the half turn covers the beginning, too.
  return std::max(widest, covered.front()[0] + kFullTurn - end);
}

std::optional<RingShape> FindRingShape(const Part& part) {
  if (part.mesh.vertices.empty() || !(part.mass.volume > 0)) {
    return std::nullopt;
  }
  RingShape ring;
  ring.axis_B = FindRingAxis(part);
  const std::optional<Vec3> on_axis = FindAxisPoint(part, &ring.axis_B);
  const Vec3 origin_B = on_axis.value_or(part.box_B.centre());
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  double least = low;
  double largest = 0;
  for (const Vec3& vertex : part.mesh.vertices) {
    const Vec3 d = vertex - origin_B;
    const double along = d.dot(ring.axis_B);
    const double radius = (d - along * ring.axis_B).norm();
    low = std::min(low, along);
    high = std::max(high, along);
    least = std::min(least, radius);
    largest = std::max(largest, radius);
  }
  ring.centre_B = origin_B + 0.5 * (low + high) * ring.axis_B;
  ring.inner = least;
  ring.outer = largest;
  ring.height = high - low;
  if (ring.height > kHighestRing * 2 * ring.outer || ring.inner < kNarrowestBore * ring.outer) {
    return std::nullopt;
  }
  constexpr double kBesideMiddle = 0.013;  // Of the height: edges of a mesh lie in the middle.
  ring.gap = CalcOpenAngle(part, ring.centre_B, ring.axis_B, kBesideMiddle * ring.height);
  ring.gap = ring.gap * ring.inner < kLeastSplit ? 0 : ring.gap;
  const double full = 0.5 * (kFullTurn - ring.gap) *
                      (ring.outer * ring.outer - ring.inner * ring.inner) * ring.height;
  const bool is_plain =
      part.mass.volume > kLeastRingFilled * full && part.mass.volume < kMostRingFilled * full;
  return is_plain ? std::optional(ring) : std::nullopt;
}

double CalcOpeningStrain(const RingShape& ring, double growth) {
  const double r = ring.mean_radius();
  return 0.5 * ring.width() * std::abs(1 / r - 1 / (r + growth));
}

}  // namespace hvas::product
