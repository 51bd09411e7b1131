#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include <Eigen/Cholesky>

#include "spatial/pose.h"

namespace hvas::haptics {

inline constexpr std::size_t kMaxHands = 8;  ///< Hands in one scene: a choice.

/** One implicit Euler step of a rigid body under stiff springs, dampers and inequality constraints,
 together with free bodies that it touches.

 The unknowns are the bodies' velocities V = [w; v] at their centres of mass, in W. Springs enter
 linearised at the end of the step, which is stable for any stiffness:

   (M + dt B + dt^2 K) V = M V_0 + dt (F + B V_target) + sum J^T lambda,

 with unilateral contacts (signed distance phi, compliance c):   phi/dt + J V + c/dt^2 lambda >= 0,
 lambda >= 0, complementary; dry friction on each (Coulomb's disc, before it elastic bristles), and
 box-bounded rows for the resistance of a fit. Stewart and Trinkle, IJNME 39 (1996), made compliant;
 solved by projected Gauss-Seidel.

 No allocation after construction; RT-safe throughout. */
class ConstraintSolver {
 public:
  // Rooms that are made once, so that a step allocates nothing: what each hand holds, eight free
  // bodies and two fasteners; twice the contacts of a query; their patches; two rows for each of
  // two fits, one for each fastener, one for parts that give and three for a thread. Choices.
  static constexpr int kMaxBodies = kMaxHands + 10;
  static constexpr int kMaxContacts = 128;
  static constexpr int kMaxPatches = 32;
  static constexpr int kMaxBoundedRows = 10;
  static constexpr int kWorld = -1;  ///< Index of what does not move, in place of a body's.

  /** A body as it is before the step. */
  struct Body {
    double mass{1};
    Mat3 I_W{Mat3::Identity()};  ///< About the centre of mass.
    Vec3 p_WCm{Vec3::Zero()};
    spatial::Twist V_0;
    spatial::Wrench F_Cm_W;  ///< Wrench on it besides what the solver adds.
  };

  /** Contacts of two bodies that share their friction. */
  struct Patch {
    int body{0};
    int other{kWorld};
    double coefficient{0};
    /** Stiffness of the bristles, all contacts together [N/m]; they share it as they share the
     * load. */
    double stiffness{std::numeric_limits<double>::infinity()};
    /** Lever arm of the normal force against rolling and turning on the spot [m]. */
    double rolling_arm{0};
  };

  struct Contact {
    int patch{0};
    Vec3 p_WC{Vec3::Zero()};
    Vec3 nhat_W{Vec3::UnitZ()};  ///< Unit; the contact pushes the patch's `body` along it.
    /** What the normal velocity must at least be, -phi/dt, less what the compliance takes [m/s]. */
    double velocity_bias{0};
    double compliance{0};  ///< [m/N]
    /** The contact pushes no harder than needed to separate at this speed [m/s]. */
    double recovery_speed{std::numeric_limits<double>::infinity()};
    Vec3 stick_W{Vec3::Zero()};  ///< Bend of the bristles before the step [m].
  };

  /** Starts a step with body 0, the one that springs, dampers and bounded rows act on. Inertia
   about the centre of mass, in W. */
  void Begin(double mass, const Mat3& I_W, const Vec3& p_WCm, const spatial::Twist& V_0,
             double dt) noexcept;

  /** Starts a step without a body that is held; index 0 stands for nothing. */
  void BeginFree(double dt) noexcept;

  /** Adds a free body; its index, or -1 when there are too many. */
  int AddBody(const Body& body) noexcept;

  /** Adds a body that something else moves too: its velocity without this step's contacts, and by
   how much an impulse changes it, as [turn; shift] about its centre of mass in W. */
  int AddBody(const Vec3& p_WCm, const Vec6& V, const Mat6& inverse) noexcept;

  /** How far a wrench moves body 0 from rest in this step where nothing but its inertia answers, as
   [turn; shift] of its centre of mass. Valid after Begin. */
  [[nodiscard]] spatial::Twist CalcFreeMotion(const spatial::Wrench& F_Cm_W) const noexcept;

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

  /** The patch's index, or -1 when there are too many. */
  int AddPatch(const Patch& patch) noexcept;

  /** The contact's index, or -1 when there are too many. */
  int AddContact(const Contact& contact) noexcept;

  /** A resistance to motion J V of a body: a bristle that is stretched before the step, and pulls
   along J with a force between two bounds. Rigid unless it is given a stiffness: dry friction. */
  struct BoundedRow {
    double low{0};   ///< <= 0 [N or N m]
    double high{0};  ///< >= 0
    double stretch{0};
    double stiffness{std::numeric_limits<double>::infinity()};  ///< [N/m or N m/rad]
  };

  /** Returns the row's index, or -1 when there are too many. */
  int AddBoundedRow(const Vec6& J, const BoundedRow& bounds, int body = 0) noexcept;

  /** Solves; returns the velocity of body 0 at its centre of mass.
   @param ends_directly  Few contacts are solved for at once in the end: two points that nearly
   wedge a shaft take thousands of iterations otherwise. */
  [[nodiscard]] spatial::Twist Solve(int iterations, bool ends_directly = false) noexcept;

  /** Velocity of body 0 without any constraint row, for choosing the contact margin. Valid after
   the springs were added. */
  [[nodiscard]] spatial::Twist SolveUnconstrained() noexcept;

  /** Velocity of a body at its centre of mass. Valid after Solve. */
  [[nodiscard]] spatial::Twist velocity(int body) const noexcept {
    const Vec6& V = V_[static_cast<std::size_t>(body)];
    return {V.head<3>(), V.tail<3>()};
  }

  /** How much impulse a change of the velocity of body 0 takes, with springs and dampers, as [turn;
   shift]; and its inverse. Valid after Solve. */
  [[nodiscard]] const Mat6& matrix() const noexcept { return A_; }

  [[nodiscard]] const Mat6& inverse() const noexcept { return inverse_[0]; }

  /** Impulse of all rows and contacts on body 0, as [turn; shift] about its centre of mass. Valid
   after Solve. */
  [[nodiscard]] Vec6 row_impulse() const noexcept { return A_ * V_[0] - rhs_; }

  [[nodiscard]] int contact_count() const noexcept { return contact_count_; }

  [[nodiscard]] int patch_count() const noexcept { return patch_count_; }

  [[nodiscard]] int patch_of(int i) const noexcept {
    return contacts_[static_cast<std::size_t>(i)].patch;
  }

  /** Force of contact i on its patch's body [N], in W. Valid after Solve. */
  [[nodiscard]] Vec3 contact_force(int i) const noexcept;
  [[nodiscard]] double normal_force(int i) const noexcept;
  /** Speed of the body's point of contact i over the other body, in W, with its normal part [m/s].
   Valid after Solve. */
  [[nodiscard]] Vec3 contact_velocity(int i) const noexcept;

  /** Generalised force of a bounded row (N or N m), positive along +J. Valid after Solve. */
  [[nodiscard]] double bounded_force(int row) const noexcept;

 private:
  struct Row {
    Vec6 J{Vec6::Zero()};  // Of the one body, and of the other.
    Vec6 J_other{Vec6::Zero()};
    Vec6 W{Vec6::Zero()};  // A^-1 J^T of either.
    Vec6 W_other{Vec6::Zero()};
    double slack{0};  // J A^-1 J^T
    double bias{0};
    double softness{0};
    double lambda{0};  // [N s]
  };

  struct ContactRows {
    Row normal;
    Row tangent[2];
    int patch{0};
    double recovery_speed{0};
    double coupling{0};  // Of the two tangents: J_0 A^-1 J_1^T
    double larger{0};    // Larger eigenvalue of the tangents' block.
    bool is_prepared{false};
  };

  struct PatchRows {
    Patch of;
    double load{0};             // Sum of the normal lambdas [N s].
    double stick_softness{0};   // 1 / (dt^2 k)
    Vec3 lambda{Vec3::Zero()};  // Against rolling [N m s].
    Mat3 rolling_inverse{Mat3::Zero()};
    Mat3 W_top[2], W_bottom[2];  // A^-1 [1; 0] of body and other.
  };

  struct Pair {
    std::size_t body;
    int other;
  };

  void Factor() noexcept;
  void PrepareRow(const Pair& pair, Row* row) noexcept;
  void PrepareFriction(ContactRows* rows) noexcept;
  void PrepareRolling(PatchRows* patch) noexcept;
  [[nodiscard]] double Velocity(const Pair& pair, const Row& row) const noexcept;
  void Push(const Pair& pair, const Row& row, double change) noexcept;
  class DirectSolution;

  /** Solves few contacts at once, from what the sweeps have found. False where that is not
   possible; nothing changes then. */
  [[nodiscard]] bool SolveDirectly() noexcept;
  void RelaxBounded() noexcept;
  void RelaxNormal(ContactRows* rows) noexcept;
  void RelaxFriction(ContactRows* rows) noexcept;
  void RelaxRolling(PatchRows* patch) noexcept;

  [[nodiscard]] Pair PairOf(const PatchRows& patch) const noexcept {
    return {static_cast<std::size_t>(patch.of.body), patch.of.other};
  }

  [[nodiscard]] Pair PairOf(const ContactRows& rows) const noexcept {
    return PairOf(patches_[static_cast<std::size_t>(rows.patch)]);
  }

  double mass_{1};  ///< Mass of body 0; its inertia is next.
  Mat3 I_W_{Mat3::Identity()};
  Mat6 A_{Mat6::Identity()};
  Vec6 rhs_{Vec6::Zero()};
  Eigen::LLT<Mat6> factor_;
  bool is_factored_{false};
  Vec6 V_free_{Vec6::Zero()};  ///< Velocity of body 0 without any row.
  double dt_{1e-3};
  std::array<Vec6, kMaxBodies> V_;
  std::array<Mat6, kMaxBodies> inverse_;
  std::array<Vec3, kMaxBodies> p_WCm_;
  std::size_t body_count_{1};
  std::array<ContactRows, kMaxContacts> contacts_;
  int contact_count_{0};
  std::array<PatchRows, kMaxPatches> patches_;
  int patch_count_{0};
  std::array<Row, kMaxBoundedRows> bounded_;
  std::array<std::array<double, 2>, kMaxBoundedRows> bounds_{};  // [N s]
  std::array<std::size_t, kMaxBoundedRows> bounded_body_{};
  int bounded_count_{0};
};

}  // namespace hvas::haptics
