#pragma once

#include <array>
#include <limits>
#include <span>

#include "spatial/pose.h"

namespace hvas::haptics {

/** One implicit Euler step of a rigid body under stiff springs, dampers and inequality constraints.

 The unknown is the body's velocity V = [w; v] at its centre of mass, in W. Springs enter linearised
 at the end of the step, which is stable for any stiffness:

   (M + dt B + dt^2 K) V = M V_0 + dt (F + B V_target) + sum J^T lambda,

 with unilateral contacts (signed distance phi, compliance c):   phi/dt + J V + c/dt^2 lambda >= 0,
 lambda >= 0, complementary; Coulomb friction on each, and box-bounded rows for the resistance of a
 fit. Stewart and Trinkle, IJNME 39 (1996), made compliant; solved by projected Gauss-Seidel.

 No allocation after construction; RT-safe throughout. */
class ConstraintSolver {
 public:
  static constexpr int kMaxContacts = 128;
  static constexpr int kMaxBoundedRows = 4;

  /** Starts a step. Inertia about the centre of mass, in W. */
  void Begin(double mass, const Mat3& I_W, const Vec3& p_WCm, const spatial::Twist& V_0,
             double dt) noexcept;

  /** A constant force f at the centre of mass and torque t. */
  void AddWrench(const spatial::Wrench& F_Cm_W) noexcept;

  /** A spring that pulls with force f0 at point p_WQ of the body now and loses stiffness K (3x3,
   symmetric positive semidefinite, N/m) times the displacement of Q. */
  void AddPointSpring(const Vec3& p_WQ, const Vec3& f0, const Mat3& K) noexcept;

  /** A torsional spring: torque t0 now, stiffness K (3x3, N m/rad). */
  void AddAngularSpring(const Vec3& t0, const Mat3& K) noexcept;

  /** A damper between the body's point Q and a moving target: b [N s/m], w [rad/s], v [m/s]. */
  void AddPointDamper(const Vec3& p_WQ, const Vec3& v_target, double b) noexcept;
  void AddAngularDamper(const Vec3& w_target, double b) noexcept;

  /** A unilateral contact at p_WC with unit normal away from the obstacle. `velocity_bias` is what
   the normal velocity must at least be, -phi/dt, less what the compliance takes; the contact pushes
   no harder than needed to separate at `recovery_speed`. */
  void AddContact(const Vec3& p_WC, const Vec3& nhat_W, double velocity_bias, double friction,
                  double compliance,
                  double recovery_speed = std::numeric_limits<double>::infinity()) noexcept;

  /** Resists motion J V with a force of at most `bound` (dry friction). Returns the row's index. */
  int AddBoundedRow(const Vec6& J, double bound) noexcept;

  /** Solves; returns the velocity at the centre of mass. */
  [[nodiscard]] spatial::Twist Solve(int iterations) noexcept;

  /** Velocity without any constraint row, for choosing the contact margin. Valid after the springs
   were added. */
  [[nodiscard]] spatial::Twist SolveUnconstrained() noexcept;

  [[nodiscard]] int contact_count() const noexcept { return contact_count_; }

  /** Force of contact i on the body [N], in W. Valid after Solve. */
  [[nodiscard]] Vec3 contact_force(int i) const noexcept;
  [[nodiscard]] double normal_force(int i) const noexcept;
  /** Generalised force of a bounded row (N or N m), positive along +J. Valid after Solve. */
  [[nodiscard]] double bounded_force(int row) const noexcept;

 private:
  struct Row {
    Vec6 J{Vec6::Zero()};
    Vec6 W{Vec6::Zero()};  // A^-1 J^T
    double inverse{0};
    double bias{0};
    double softness{0};
    double lambda{0};  // [N s]
  };

  struct ContactRows {
    Row normal;
    Row tangent[2];
    double friction{0};
    double recovery_speed{0};
    double coupling{0};       // Of the two tangents: J_0 A^-1 J_1^T
    double gradient_step{0};  // One over the larger eigenvalue of the tangents' block
  };

  void Factor() noexcept;
  void Prepare(Row* row) noexcept;
  void PrepareFriction(ContactRows* rows) noexcept;
  void Relax(Row* row, double low, double high) noexcept;
  void RelaxNormal(ContactRows* rows) noexcept;
  void RelaxFriction(ContactRows* rows) noexcept;

  Mat6 A_{Mat6::Identity()};
  Vec6 rhs_{Vec6::Zero()};
  Vec6 V_{Vec6::Zero()};
  Eigen::LLT<Mat6> factor_;
  bool is_factored_{false};
  Vec3 p_WCm_{Vec3::Zero()};
  double dt_{1e-3};
  std::array<ContactRows, kMaxContacts> contacts_;
  int contact_count_{0};
  std::array<Row, kMaxBoundedRows> bounded_;
  std::array<double, kMaxBoundedRows> bounds_{};
  int bounded_count_{0};
};

}  // namespace hvas::haptics
