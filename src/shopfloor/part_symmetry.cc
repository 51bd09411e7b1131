#include "shopfloor/part_symmetry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/units.h"
#include "contact/shape.h"
#include "paths/part_field.h"

namespace hvas::shopfloor {
namespace {

// What a hand that grasps a part does not see or feel: shares of the part's size, and lengths [m].
// Choices, tried on the parts of the products that are shipped.
constexpr double kSmallShare = 0.01;
constexpr double kSmall = 0.2e-3;
constexpr std::size_t kPoints = 1500;  // Points of the surface that are turned: a choice.

/** Points all over a mesh: one in the middle of each small triangle, more in large ones, by area.
 Low-discrepancy, so that the same part gives the same points. */
std::vector<Vec3> SampleSurface(const product::Mesh& mesh) {
  std::vector<double> until;  // Area of the triangles up to each.
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    area += 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
    until.push_back(area);
  }
  std::vector<Vec3> points;
  if (area <= 0) {
    return points;
  }
  // Roberts' sequence R2 within the triangles (2018): 1/g and 1/g^2 with g^3 = g + 1.
  constexpr double kFirst = 0.7548776662466927;
  constexpr double kSecond = 0.5698402909980532;
  double u = 0.5;
  double v = 0.5;
  std::size_t triangle = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(kPoints) * area;
    while (until[triangle] < at) {
      ++triangle;
    }
    u = std::fmod(u + kFirst, 1);
    v = std::fmod(v + kSecond, 1);
    const bool is_beyond = u + v > 1;
    const double s = is_beyond ? 1 - u : u;
    const double t = is_beyond ? 1 - v : v;
    const auto& corners = mesh.triangles[triangle];
    const Vec3& a = mesh.vertices[corners[0]];
    points.push_back(a + s * (mesh.vertices[corners[1]] - a) + t * (mesh.vertices[corners[2]] - a));
  }
  return points;
}

/** The centroid of a surface, which each rotation that repeats the part leaves where it is. */
Vec3 CalcCentroid(const product::Mesh& mesh) {
  Vec3 sum = Vec3::Zero();
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    const double own = 0.5 * (b - a).cross(c - a).norm();
    sum += own / 3 * (a + b + c);
    area += own;
  }
  return area > 0 ? Vec3(sum / area) : sum;
}

contact::ShapeSource MakeSource(const product::Mesh& mesh) {
  contact::ShapeSource source;
  source.vertices = mesh.vertices;
  source.triangles = mesh.triangles;
  source.triangle_face.assign(mesh.triangles.size(), 0);
  source.faces.resize(1);
  return source;
}

/** Says of rotations whether they repeat a part. */
class RepeatCheck {
 public:
  explicit RepeatCheck(const product::Part& part)
      : centre_B_(CalcCentroid(part.mesh)),
        tolerance_(std::max(kSmall, kSmallShare * part.box_B.size().maxCoeff())),
        points_(SampleSurface(part.mesh)),
        field_(MakeSource(part.mesh), 2 * tolerance_, 4 * tolerance_, 1) {
    for (const Vec3& p_B : points_) {
      spread_ += (p_B - centre_B_) * (p_B - centre_B_).transpose();
    }
    spread_ /= static_cast<double>(std::max<std::size_t>(1, points_.size()));
    // Points that are far out tell soonest that a rotation repeats nothing.
    std::stable_sort(points_.begin(), points_.end(), [this](const Vec3& a, const Vec3& b) {
      return (a - centre_B_).squaredNorm() > (b - centre_B_).squaredNorm();
    });
  }

  /** All points of the surface come to lie on it again, but for some that edges of coarse meshes
   and small details take with them. */
  [[nodiscard]] bool Repeats(const Vec3& axis_B, double angle) const {
    constexpr double kMostOff = 0.01;  // Share of the points: a choice, as an engraving has.
    const Quat turn(Eigen::AngleAxisd(angle, axis_B));
    const Mat3 R = turn.toRotationMatrix();
    // Most turns are told by the second moments, which one that repeats the part leaves as they
    // are.
    constexpr double kOtherSpread = 0.05;  // Share of their sum: more than details have. A choice.
    if ((R * spread_ * R.transpose() - spread_).norm() > kOtherSpread * spread_.trace()) {
      return false;
    }
    const auto most = static_cast<std::size_t>(kMostOff * static_cast<double>(points_.size()));
    std::size_t off = 0;
    for (const Vec3& p_B : points_) {
      const double distance = field_.At(centre_B_ + turn * (p_B - centre_B_));
      off += std::abs(distance) > tolerance_ ? 1 : 0;
      if (off > most) {
        return false;
      }
    }
    return !points_.empty();
  }

 private:
  Vec3 centre_B_;
  double tolerance_;
  Mat3 spread_{Mat3::Zero()};  // Second moments of the points about their centre [m^2].
  std::vector<Vec3> points_;
  paths::PartField field_;
};

/** The least turn about an axis that repeats the part [deg]. A part that four turns with no common
 measure repeat goes on at any. */
int FindLeastTurn(const RepeatCheck& check, const Vec3& axis_B, int most_fold) {
  constexpr std::array kOdd{17.0, 37.0, 71.0, 101.0};
  if (std::all_of(kOdd.begin(), kOdd.end(), [&](double turn_deg) {
        return check.Repeats(axis_B, units::FromDeg(turn_deg));
      })) {
    return 0;
  }
  for (int fold = most_fold; fold >= 2; --fold) {
    const double turn = 2 * std::numbers::pi / fold;
    bool repeats = true;
    for (int times = 1; repeats && times <= fold / 2; ++times) {
      repeats = check.Repeats(axis_B, times * turn);
    }
    if (repeats) {
      return static_cast<int>(std::lround(360.0 / fold));
    }
  }
  return 360;
}

}  // namespace

PartSymmetry FindSymmetry(const product::Part& part, const Vec3& way_B) {
  if (part.mesh.triangles.empty()) {
    return {};
  }
  const RepeatCheck check(part);
  constexpr int kMostFold =
      60;                       // Teeth of gears; 6 degrees are a fifth of a hand's turn: a choice.
  constexpr int kMostEnds = 6;  // A hexagonal prism that lies has six ways about its length.
  PartSymmetry symmetry{360, FindLeastTurn(check, way_B, kMostFold)};
  const Vec3 first = way_B.unitOrthogonal();
  const Vec3 second = way_B.cross(first);
  // Axes normal to the way: one is as good as all where the part goes on at any turn about it.
  constexpr int kAxes = 180;  // Steps of one degree: a choice.
  const int axes = symmetry.beta_deg == 0 ? 1 : kAxes;
  for (int i = 0; i < axes; ++i) {
    const double angle = std::numbers::pi * i / kAxes;
    const Vec3 axis_B = std::cos(angle) * first + std::sin(angle) * second;
    symmetry.alpha_deg = std::min(symmetry.alpha_deg, FindLeastTurn(check, axis_B, kMostEnds));
  }
  return symmetry;
}

}  // namespace hvas::shopfloor
