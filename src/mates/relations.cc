#include "mates/relations.h"

#include <algorithm>
#include <cmath>

#include "mates/mate_kind.h"
#include "mates/singular_values.h"

namespace hvas::mates {
namespace {

using product::ElementKind;
using product::Relation;
using product::RelationKind;

constexpr double kLoneLength = 10e-3;     // As for mates (resolve.cc) [m].
constexpr double kSmallestLength = 1e-3;  // [m]: as for mates (resolve.cc).
constexpr double kConverged = 1e-10;      // [m]: the rounding of poses of some metres.
constexpr int kMaxIterations = 60;        // Newton's steps at most: a choice.
constexpr int kMaxHalvings = 10;          // Of one step: a choice.
constexpr double kNoDistance = 1e-12;  // [m]: axes that meet have no direction of their distance.

/** One equation: its value [m] and its derivative by the held part's twist about `p_B`. */
struct Equation {
  double value{0};
  Vec3 by_turn;   // By w of B [m/rad].
  Vec3 by_shift;  // By v of the point of the held element.
  Vec3 p_W;       // That point.
};

/** Two unit vectors square to a direction. */
std::pair<Vec3, Vec3> MakeBasis(const Vec3& axis) {
  const Vec3 e1 = axis.unitOrthogonal();
  return {e1, axis.cross(e1)};
}

bool HasAxis(ElementKind kind) {
  return kind != ElementKind::kSphere;
}

/** The equations of mates and relations at one pose of the held part. */
class EquationList {
 public:
  EquationList(const Pose& X_WB, double length) : X_WB_(X_WB), length_(length) {}

  void Add(const RelationConstraint& relation);
  void Add(const MateConstraint& mate);

  [[nodiscard]] const std::vector<Equation>& items() const { return items_; }

  /** Row of the derivative by (L w, v of B's origin). */
  [[nodiscard]] Vec6 RowOf(const Equation& equation) const {
    Vec6 row;
    const Vec3 arm = equation.p_W - X_WB_.p();
    row << (equation.by_turn + arm.cross(equation.by_shift)) / length_, equation.by_shift;
    return row;
  }

 private:
  void AddParallel(const Vec3& target, const Vec3& axis);
  void AddAngle(const Vec3& placed, const Vec3& axis, double angle);

  void AddAlong(const Vec3& direction, double value, const Vec3& p_W) {
    items_.push_back({value, Vec3::Zero(), direction, p_W});
  }

  void AddAcross(const Vec3& axis, const Vec3& d, const Vec3& p_W);
  void AddAxisDistance(const Vec3& axis, const Vec3& d, double distance, const Vec3& p_W);
  void AddTangent(const RelationConstraint& relation, const Vec3& p_W, const Vec3& axis_W);

  const Pose& X_WB_;
  double length_;
  std::vector<Equation> items_;
};

/** The axis of B lies along the target, in the sense that it has. */
void EquationList::AddParallel(const Vec3& target, const Vec3& axis) {
  const auto [e1, e2] = MakeBasis(target);
  for (const Vec3& e : {e1, e2}) {
    items_.push_back({length_ * e.dot(axis), length_ * axis.cross(e), Vec3::Zero(), X_WB_.p()});
  }
}

void EquationList::AddAngle(const Vec3& placed, const Vec3& axis, double angle) {
  const double scale = length_ / std::max(std::sin(angle), 1e-6);
  items_.push_back({scale * (placed.dot(axis) - std::cos(angle)), scale * axis.cross(placed),
                    Vec3::Zero(), X_WB_.p()});
}

/** The point of B lies on the axis. */
void EquationList::AddAcross(const Vec3& axis, const Vec3& d, const Vec3& p_W) {
  const auto [e1, e2] = MakeBasis(axis);
  AddAlong(e1, e1.dot(d), p_W);
  AddAlong(e2, e2.dot(d), p_W);
}

void EquationList::AddAxisDistance(const Vec3& axis, const Vec3& d, double distance,
                                   const Vec3& p_W) {
  const Vec3 across = d - axis.dot(d) * axis;
  const double norm = across.norm();
  const Vec3 direction = norm > kNoDistance ? Vec3(across / norm) : MakeBasis(axis).first;
  AddAlong(direction, norm - distance, p_W);
}

void EquationList::AddTangent(const RelationConstraint& r, const Vec3& p_W, const Vec3& axis_W) {
  const Vec3 d = p_W - r.p_W;
  const bool is_plane_placed = r.placed == ElementKind::kPlane;
  if (is_plane_placed || r.held == ElementKind::kPlane) {
    const ElementKind round = is_plane_placed ? r.held : r.placed;
    if (round == ElementKind::kCylinder) {
      constexpr double kSquare = 1.57079632679489662;  // A right angle [rad].
      AddAngle(r.axis_W, axis_W, kSquare);
    }
    if (is_plane_placed) {
      AddAlong(r.axis_W, r.axis_W.dot(d) - r.contact_distance, p_W);
    } else {  // The plane turns with B: about the foot of the placed centre on it.
      const Vec3 centre = r.p_W;
      items_.push_back({-axis_W.dot(d) - r.contact_distance, Vec3::Zero(), Vec3(-axis_W), centre});
    }
    return;
  }
  if (r.placed == ElementKind::kSphere && r.held == ElementKind::kSphere) {
    const double norm = d.norm();
    const Vec3 direction = norm > kNoDistance ? Vec3(d / norm) : Vec3(Vec3::UnitX());
    AddAlong(direction, norm - r.contact_distance, p_W);
  } else if (r.held == ElementKind::kSphere) {
    AddAxisDistance(r.axis_W, d, r.contact_distance, p_W);
  } else if (r.placed == ElementKind::kSphere) {  // The axis turns with B.
    const Vec3 across = d - axis_W.dot(d) * axis_W;
    const double norm = across.norm();
    const Vec3 direction = norm > kNoDistance ? Vec3(across / norm) : MakeBasis(axis_W).first;
    AddAlong(direction, norm - r.contact_distance, r.p_W + across);
  } else {
    AddParallel(r.axis_W, axis_W);
    AddAxisDistance(r.axis_W, d, r.contact_distance, p_W);
  }
}

void EquationList::Add(const RelationConstraint& r) {
  const Vec3 p_W = X_WB_ * r.p_B;
  const Vec3 axis_W = X_WB_.q() * r.axis_B;
  const Vec3 d = p_W - r.p_W;
  switch (r.kind) {
    case RelationKind::kParallel:
      return AddParallel(r.axis_W, axis_W);
    case RelationKind::kPerpendicular:
    case RelationKind::kAngle:
      return AddAngle(r.axis_W, axis_W, r.magnitude);
    case RelationKind::kFlush:
      AddParallel(r.axis_W, axis_W);
      return AddAlong(r.axis_W, r.axis_W.dot(d), p_W);
    case RelationKind::kDistance:
      AddParallel(r.axis_W, axis_W);
      if (r.placed == ElementKind::kPlane) {
        const double sense = r.axis_W.dot(axis_W) < 0 ? 1 : -1;
        const double target = r.is_reversed ? sense * r.magnitude : r.magnitude;
        return AddAlong(r.axis_W, r.axis_W.dot(d) - target, p_W);
      }
      return AddAxisDistance(r.axis_W, d, r.magnitude, p_W);
    case RelationKind::kTangent:
      return AddTangent(r, p_W, axis_W);
    case RelationKind::kEdgeOnEdge:
    case RelationKind::kHoleToHole:
      AddParallel(r.axis_W, axis_W);
      return AddAcross(r.axis_W, d, p_W);
  }
}

void EquationList::Add(const MateConstraint& mate) {
  const Pose X_WN = X_WB_ * mate.X_BN;
  const Vec3 axis = mate.X_WM.q() * Vec3::UnitZ();
  const Vec3 d = X_WN.p() - mate.X_WM.p();
  if (HoldsDirection(mate.kind)) {
    AddParallel(axis, X_WN.q() * Vec3::UnitZ());
  }
  if (HoldsAcross(mate.kind)) {
    AddAcross(axis, d, X_WN.p());
  }
  if (HoldsAlong(mate.kind)) {
    AddAlong(axis, axis.dot(d), X_WN.p());
  }
}

/** How far the held elements spread from their mean, or a length where there is one alone. */
double CalcLength(std::span<const MateConstraint> mates,
                  std::span<const RelationConstraint> relations) {
  std::vector<Vec3> points;
  for (const MateConstraint& mate : mates) {
    points.push_back(mate.X_BN.p());
  }
  for (const RelationConstraint& relation : relations) {
    points.push_back(relation.p_B);
  }
  Vec3 mean = Vec3::Zero();
  for (const Vec3& point : points) {
    mean += point / static_cast<double>(points.size());
  }
  double spread = 0;
  for (const Vec3& point : points) {
    spread = std::max(spread, (point - mean).norm());
  }
  return spread > kSmallestLength ? spread : kLoneLength;
}

EquationList ListEquations(std::span<const MateConstraint> mates,
                           std::span<const RelationConstraint> relations, const Pose& X_WB,
                           double length) {
  EquationList list(X_WB, length);
  for (const MateConstraint& mate : mates) {
    list.Add(mate);
  }
  for (const RelationConstraint& relation : relations) {
    list.Add(relation);
  }
  return list;
}

double NormOf(const EquationList& list) {
  double sum = 0;
  for (const Equation& equation : list.items()) {
    sum += equation.value * equation.value;
  }
  return std::sqrt(sum);
}

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6>;

Rows MakeRows(const EquationList& list) {
  Rows rows(static_cast<Eigen::Index>(list.items().size()), 6);
  for (std::size_t i = 0; i < list.items().size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = list.RowOf(list.items()[i]).transpose();
  }
  return rows;
}

/** Rank of a matrix against the largest singular value of `whole`. */
int CountRank(const Eigen::MatrixXd& matrix, double largest) {
  return static_cast<int>(CalcSingularValues(matrix).CountAbove(kRankTolerance * largest));
}

}  // namespace

const char* NameOf(RelationKind kind) {
  switch (kind) {
    case RelationKind::kParallel:
      return "parallel";
    case RelationKind::kPerpendicular:
      return "perpendicular";
    case RelationKind::kAngle:
      return "angle";
    case RelationKind::kFlush:
      return "flush";
    case RelationKind::kDistance:
      return "distance";
    case RelationKind::kTangent:
      return "tangent";
    case RelationKind::kEdgeOnEdge:
      return "edge_on_edge";
    case RelationKind::kHoleToHole:
      break;
  }
  return "hole_to_hole";
}

bool CanTie(RelationKind kind, ElementKind a, ElementKind b) {
  const auto both = [a, b](ElementKind kind_of) { return a == kind_of && b == kind_of; };
  switch (kind) {
    case RelationKind::kParallel:
    case RelationKind::kPerpendicular:
    case RelationKind::kAngle:
      return HasAxis(a) && HasAxis(b);
    case RelationKind::kFlush:
      return both(ElementKind::kPlane);
    case RelationKind::kDistance:
      return both(ElementKind::kPlane) || both(ElementKind::kCylinder);
    case RelationKind::kTangent:
      return a != ElementKind::kEdge && b != ElementKind::kEdge && !both(ElementKind::kPlane);
    case RelationKind::kEdgeOnEdge:
      return both(ElementKind::kEdge);
    case RelationKind::kHoleToHole:
      break;
  }
  return both(ElementKind::kCylinder);
}

RelationConstraint MakeConstraint(const Relation& relation, product::OccurrenceId held,
                                  const Pose& X_WP) {
  const bool holds_b = relation.b.occurrence == held;
  const product::RelationSide& placed = holds_b ? relation.a : relation.b;
  const product::RelationSide& moving = holds_b ? relation.b : relation.a;
  RelationConstraint constraint;
  constraint.kind = relation.kind;
  constraint.magnitude =
      relation.kind == RelationKind::kPerpendicular ? std::acos(0.0) : relation.magnitude;
  constraint.placed = placed.element;
  constraint.held = moving.element;
  constraint.p_W = X_WP * placed.origin_B;
  constraint.axis_W = X_WP.q() * placed.axis_B;
  constraint.p_B = moving.origin_B;
  constraint.axis_B = moving.axis_B;
  if (relation.kind == RelationKind::kTangent) {
    constraint.contact_distance = placed.is_inward || moving.is_inward
                                      ? std::abs(placed.radius - moving.radius)
                                      : placed.radius + moving.radius;
  }
  constraint.is_reversed = !holds_b;
  return constraint;
}

double CalcResidual(const RelationConstraint& relation, const Pose& X_WB, double length) {
  return NormOf(ListEquations({}, std::span(&relation, 1), X_WB, length));
}

std::vector<Vec6> CalcJacobian(const RelationConstraint& relation, const Pose& X_WB,
                               double length) {
  const EquationList list = ListEquations({}, std::span(&relation, 1), X_WB, length);
  std::vector<Vec6> rows;
  for (const Equation& equation : list.items()) {
    rows.push_back(list.RowOf(equation));
  }
  return rows;
}

FreeCount CountFree(std::span<const MateConstraint> mates,
                    std::span<const RelationConstraint> relations, const Pose& X_WB) {
  const double length = CalcLength(mates, relations);
  const Rows rows = MakeRows(ListEquations(mates, relations, X_WB, length));
  if (rows.rows() == 0) {
    return {};
  }
  const double largest = rows.norm();
  FreeCount free;
  free.translations = 3 - CountRank(rows.rightCols<3>(), largest);
  free.rotations = 6 - CountRank(rows, largest) - free.translations;
  return free;
}

Resolution ResolveAll(std::span<const MateConstraint> mates,
                      std::span<const RelationConstraint> relations, const Pose& X_WBStart) {
  const double length = CalcLength(mates, relations);
  Resolution result;
  result.X_WB = Resolve(mates, X_WBStart).X_WB;  // From anywhere, where mates decide the sense.
  result.residual = NormOf(ListEquations(mates, relations, result.X_WB, length));
  for (; result.iterations < kMaxIterations && result.residual > 1e-3 * kConverged;
       ++result.iterations) {
    const EquationList list = ListEquations(mates, relations, result.X_WB, length);
    Eigen::VectorXd right(static_cast<Eigen::Index>(list.items().size()));
    for (std::size_t i = 0; i < list.items().size(); ++i) {
      right[static_cast<Eigen::Index>(i)] = -list.items()[i].value;
    }
    Vec6 step = CalcSingularValues(MakeRows(list)).Solve(right, kRankTolerance);
    bool is_better = false;
    for (int halving = 0; halving <= kMaxHalvings && !is_better; ++halving, step *= 0.5) {
      const Quat turn = spatial::RotationFromVector(Vec3(step.head<3>() / length));
      const Pose X_WB((turn * result.X_WB.q()).normalized(),
                      Vec3(result.X_WB.p() + step.tail<3>()));
      const double residual = NormOf(ListEquations(mates, relations, X_WB, length));
      if (residual < result.residual) {
        result.X_WB = X_WB;
        result.residual = residual;
        is_better = true;
      }
    }
    if (!is_better) {
      break;  // What is left contradicts itself.
    }
  }
  result.is_converged = result.residual < kConverged;
  return result;
}

void Measure(const product::Product& product, Relation* relation) {
  const Pose& X_WA = product.occurrences[relation->a.occurrence.index()].X_WB;
  const Pose& X_WB = product.occurrences[relation->b.occurrence.index()].X_WB;
  const RelationConstraint constraint = MakeConstraint(*relation, relation->b.occurrence, X_WA);
  const FreeCount free = CountFree({}, std::span(&constraint, 1), X_WB);
  relation->free_translations = free.translations;
  relation->free_rotations = free.rotations;
  relation->residual = CalcResidual(constraint, X_WB, kLoneLength);
}

}  // namespace hvas::mates
