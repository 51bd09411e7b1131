// One step of the displayed part under springs, contacts and fits: X7, X11, W4..W6.

#include "haptics/constraint_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"
#include "haptics/test/values.h"
#include "spatial/test/random_pose.h"

namespace hvas::haptics {
namespace {

using spatial::RandomVector;
using spatial::Skew;
using spatial::Twist;
using spatial::Wrench;
using testing::kDt;

constexpr double kBodyMass = 0.7;
constexpr double kGravity = 9.81;
const Vec3 kInertia(2e-4, 3e-4, 4e-4);

Mat3 Inertia() {
  return kInertia.asDiagonal();
}

Mat3 DrawPositive(Random* random, double size) {
  Mat3 A;
  A << RandomVector(random, 1), RandomVector(random, 1), RandomVector(random, 1);
  return size * A * A.transpose();
}

Vec6 Stack(const Twist& V) {
  Vec6 out;
  out << V.w, V.v;
  return out;
}

/** A peg of 10 mm that is pressed into its hole and touches it at two points, one of them `length`
 under the other: they wedge it from mu times the diameter on, 3 mm. Forces of both points. */
std::array<Vec3, 2> PressTilted(double length, int iterations, bool ends_directly) {
  constexpr double kRadius = 5e-3;
  ConstraintSolver solver;
  solver.Begin(kBodyMass, Inertia(), Vec3(0, 0, 0.03), {}, kDt);
  solver.AddWrench({Vec3::Zero(), Vec3(0, 0, -5)});
  solver.AddAngularSpring(Vec3(0, 0.02, 0), Mat3::Identity());
  ConstraintSolver::Patch patch;
  patch.coefficient = 0.3;
  patch.stiffness = 1e8;
  ConstraintSolver::Contact contact;
  contact.patch = solver.AddPatch(patch);
  contact.compliance = 2e-8;
  contact.p_WC = Vec3(-kRadius, 0, 0);
  contact.nhat_W = Vec3::UnitX();
  solver.AddContact(contact);
  contact.p_WC = Vec3(kRadius, 0, length);
  contact.nhat_W = -Vec3::UnitX();
  solver.AddContact(contact);
  (void)solver.Solve(iterations, ends_directly);
  return {solver.contact_force(0), solver.contact_force(1)};
}

// What is solved at once is what sweeps come to in the end, where as many as a tick has are far
// from it: two points that nearly wedge, and slide.
TEST(ConstraintSolver, EndsDirectlyWhereManySweepsWould) {
  constexpr int kOfATick = 30;
  for (const double length : {3.1e-3, 3.5e-3, 5e-3, 10e-3}) {
    SCOPED_TRACE(length);
    const std::array<Vec3, 2> swept = PressTilted(length, 1000000, false);
    const std::array<Vec3, 2> few = PressTilted(length, kOfATick, false);
    const std::array<Vec3, 2> direct = PressTilted(length, kOfATick, true);
    for (std::size_t i = 0; i < swept.size(); ++i) {
      EXPECT_GT((few[i] - swept[i]).norm(), 0.1);
      EXPECT_LT((direct[i] - swept[i]).norm(), 1e-4);
    }
  }
}

// A constant force changes the velocity by F t / m, whatever the step.
TEST(ConstraintSolver, FallsFreely) {
  for (const double dt : {1e-4, 1e-3, 1e-2}) {
    ConstraintSolver solver;
    Twist V{Vec3(0.3, 0, 0), Vec3(0.1, 0, 2)};
    double z = 0;
    const int steps = static_cast<int>(std::lround(1 / dt));
    for (int i = 0; i < steps; ++i) {
      solver.Begin(kBodyMass, Inertia(), Vec3::Zero(), V, dt);
      solver.AddWrench({Vec3(2e-4, 0, 0), Vec3(0, 0, -kBodyMass * kGravity)});
      V = solver.Solve(30);
      z += dt * V.v.z();
    }
    EXPECT_NEAR((V.v - Vec3(0.1, 0, 2 - kGravity)).norm(), 0, 1e-11);
    EXPECT_NEAR(V.w.x(), 0.3 + 2e-4 / kInertia.x(), 1e-11);
    // Implicit Euler takes the velocity at the end of each step: off by g t dt / 2 exactly.
    EXPECT_NEAR(z, 2 - 0.5 * kGravity - 0.5 * kGravity * dt, 1e-10);
  }
}

// The step in closed form: (m + dt b + dt^2 k) v = m v_0 - dt k x, and the same about an axis.
TEST(ConstraintSolver, SpringStepIsImplicitEuler) {
  ConstraintSolver solver;
  for (const double k : {1.0, 1e3, 1e7, 1e12}) {
    for (const double b : {0.0, 8.0, 1e4}) {
      const double x = 2e-3;
      const double v_0 = -0.4;
      solver.Begin(kBodyMass, Inertia(), Vec3::Zero(), {Vec3::Zero(), Vec3(v_0, 0, 0)}, kDt);
      solver.AddPointSpring(Vec3::Zero(), Vec3(-k * x, 0, 0), k * Mat3::Identity());
      solver.AddPointDamper(Vec3::Zero(), Vec3::Zero(), b);
      const double expected =
          (kBodyMass * v_0 - kDt * k * x) / (kBodyMass + kDt * b + kDt * kDt * k);
      EXPECT_NEAR(solver.Solve(30).v.x(), expected, 1e-12 * std::abs(expected));

      solver.Begin(kBodyMass, Inertia(), Vec3::Zero(), {Vec3(0, v_0, 0), Vec3::Zero()}, kDt);
      solver.AddAngularSpring(Vec3(0, -k * x, 0), k * Mat3::Identity());
      solver.AddAngularDamper(Vec3::Zero(), b);
      const double turn =
          (kInertia.y() * v_0 - kDt * k * x) / (kInertia.y() + kDt * b + kDt * kDt * k);
      EXPECT_NEAR(solver.Solve(30).w.y(), turn, 1e-12 * std::abs(turn));
    }
  }
}

/** Largest error of a damped oscillator over half a second, against its closed form. */
double CalcOscillatorError(double dt) {
  const double k = 1000;
  const double b = 8;
  const double x_0 = 5e-3;
  const double decay = 0.5 * b / kBodyMass;
  const double omega = std::sqrt(k / kBodyMass - decay * decay);
  ConstraintSolver solver;
  Twist V;
  double x = x_0;
  double worst = 0;
  const int steps = static_cast<int>(std::lround(0.5 / dt));
  for (int i = 1; i <= steps; ++i) {
    solver.Begin(kBodyMass, Inertia(), Vec3(x, 0, 0), V, dt);
    solver.AddPointSpring(Vec3(x, 0, 0), Vec3(-k * x, 0, 0), k * Mat3::Identity());
    solver.AddPointDamper(Vec3(x, 0, 0), Vec3::Zero(), b);
    V = solver.Solve(30);
    x += dt * V.v.x();
    const double t = i * dt;
    const double exact =
        x_0 * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
    worst = std::max(worst, std::abs(x - exact));
  }
  return worst;
}

TEST(ConstraintSolver, ConvergesToTheOscillatorWithOrderOne) {
  double before = CalcOscillatorError(1e-3);
  EXPECT_LT(before, 0.3e-3);
  for (const double dt : {5e-4, 2.5e-4, 1.25e-4, 6.25e-5}) {
    const double error = CalcOscillatorError(dt);
    EXPECT_NEAR(before / error, 2, 0.15) << dt;
    before = error;
  }
}

// Stiff springs must not blow up: the coupling's energy falls at any stiffness (N6).
TEST(ConstraintSolver, StaysStableAtAnyStiffness) {
  for (const double k : {1e3, 1e6, 1e9}) {
    ConstraintSolver solver;
    Twist V;
    double x = 1e-3;
    double energy = 0.5 * k * x * x;
    for (int i = 0; i < 2000; ++i) {
      solver.Begin(kBodyMass, Inertia(), Vec3(x, 0, 0), V, kDt);
      solver.AddPointSpring(Vec3(x, 0, 0), Vec3(-k * x, 0, 0), k * Mat3::Identity());
      V = solver.Solve(30);
      x += kDt * V.v.x();
      const double now = 0.5 * k * x * x + 0.5 * kBodyMass * V.v.squaredNorm();
      ASSERT_LE(now, energy * (1 + 1e-12));
      energy = now;
    }
    EXPECT_LT(energy, 0.5 * k * 1e-6 * 0.5);
  }
}

// Springs and dampers off the centre of mass, against (M + dt B + dt^2 K) V = rhs put together from
// the point's Jacobian, which is found by moving the body.
TEST(ConstraintSolver, OffCentreSpringsAndDampersMatchTheirJacobians) {
  Random random(3);
  double worst = 0;
  for (int draw = 0; draw < 200; ++draw) {
    const Vec3 p_WCm = RandomVector(&random, 0.5);
    const Vec3 p_WQ = p_WCm + RandomVector(&random, 0.1);
    const Vec3 f0 = RandomVector(&random, 10);
    const Vec3 target = RandomVector(&random, 0.5);
    const Mat3 K = DrawPositive(&random, 1e5);
    const Mat3 K_rot = DrawPositive(&random, 10);
    const Mat3 I = DrawPositive(&random, 1e-3) + 1e-4 * Mat3::Identity();
    const double b = random.Uniform(0, 50);
    const Twist V_0{RandomVector(&random, 1), RandomVector(&random, 1)};
    Eigen::Matrix<double, 3, 6> J;
    constexpr double kStep = 1e-6;
    for (int k = 0; k < 6; ++k) {
      Vec6 d = kStep * Vec6::Unit(k);
      const auto move = [&](double sign) -> Vec3 {
        return p_WCm + sign * d.tail<3>() +
               spatial::RotationFromVector(sign * d.head<3>()) * (p_WQ - p_WCm);
      };
      J.col(k) = (move(1) - move(-1)) / (2 * kStep);
    }
    Mat6 M = Mat6::Zero();
    M.topLeftCorner<3, 3>() = I;
    M.bottomRightCorner<3, 3>() = kBodyMass * Mat3::Identity();
    Mat6 A = M + J.transpose() * (kDt * b * Mat3::Identity() + kDt * kDt * K) * J;
    A.topLeftCorner<3, 3>() += kDt * kDt * K_rot;
    Vec6 rhs = M * Stack(V_0) + kDt * J.transpose() * (f0 + b * target);
    rhs.head<3>() += kDt * target;  // As a torque, for once.
    const Vec6 expected = A.fullPivLu().solve(rhs);

    ConstraintSolver solver;
    solver.Begin(kBodyMass, I, p_WCm, V_0, kDt);
    solver.AddPointSpring(p_WQ, f0, K);
    solver.AddAngularSpring(target, K_rot);
    solver.AddPointDamper(p_WQ, target, b);
    const Vec6 free = Stack(solver.SolveUnconstrained());
    const Vec6 V = Stack(solver.Solve(30));
    EXPECT_EQ(free, V);
    worst = std::max(worst, (V - expected).norm() / expected.norm());
  }
  EXPECT_LT(worst, 1e-8);
}

TEST(ConstraintSolver, ForceOffTheCentreTurnsTheBody) {
  ConstraintSolver solver;
  const Vec3 p_WCm(0.1, 0.2, 0.3);
  solver.Begin(kBodyMass, Inertia(), p_WCm, {}, kDt);
  solver.AddPointSpring(p_WCm + Vec3(0.05, 0, 0), Vec3(0, 2, 0), Mat3::Zero());
  const Twist V = solver.Solve(30);
  EXPECT_NEAR((V.w - Vec3(0, 0, kDt * 0.1 / kInertia.z())).norm(), 0, 1e-15);
  EXPECT_NEAR((V.v - Vec3(0, kDt * 2 / kBodyMass, 0)).norm(), 0, 1e-15);
}

/** A box on four corners of a plane through the origin, for small tilts. */
struct BoxOnPlane {
  double compliance{2e-6};
  double friction{0};
  Mat3 R{Mat3::Identity()};  // z is the plane's normal
  Vec3 half{0.05, 0.03, 0.02};
  Wrench load;
  double gap[4]{};  // of the corners over the plane
  Twist V;
  ConstraintSolver solver;

  [[nodiscard]] Vec3 Corner(int i) const {
    return R *
           Vec3(i == 0 || i == 3 ? -half.x() : half.x(), i < 2 ? -half.y() : half.y(), -half.z());
  }

  void Step(int iterations = 30) {
    solver.Begin(kBodyMass, R * Inertia() * R.transpose(), Vec3::Zero(), V, kDt);
    solver.AddWrench(load);
    const int patch = solver.AddPatch({0, ConstraintSolver::kWorld, friction});
    for (int i = 0; i < 4; ++i) {
      solver.AddContact({patch, Corner(i), R.col(2), -gap[i] / kDt, compliance});
    }
    V = solver.Solve(iterations);
    for (int i = 0; i < 4; ++i) {
      gap[i] += kDt * R.col(2).dot(V.v + V.w.cross(Corner(i)));
    }
  }

  [[nodiscard]] double TotalNormalForce() const {
    double sum = 0;
    for (int i = 0; i < solver.contact_count(); ++i) {
      sum += solver.normal_force(i);
    }
    return sum;
  }
};

// N in = N out: the contacts carry the weight, and the box sinks by their compliance.
TEST(ConstraintSolver, FourContactsCarryTheWeight) {
  struct Case {
    double compliance;
    int iterations;
    double tolerance;  // Of one contact's share [N].
  };

  const double weight = kBodyMass * kGravity;
  for (const Case& c : {Case{2e-6, 30, 2e-4}, Case{2e-7, 300, 1e-3}}) {
    BoxOnPlane box;
    box.compliance = c.compliance;
    box.load.f = Vec3(0, 0, -weight);
    for (int i = 0; i < 500; ++i) {
      box.Step(c.iterations);
    }
    EXPECT_NEAR(box.TotalNormalForce(), weight, 1e-6);
    Vec3 total = Vec3::Zero();
    double depth = 0;
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(box.solver.normal_force(i), 0.25 * weight, c.tolerance);
      EXPECT_NEAR(-box.gap[i] / c.compliance, 0.25 * weight, c.tolerance);
      total += box.solver.contact_force(i);
      depth -= 0.25 * box.gap[i];
    }
    EXPECT_NEAR((total + box.load.f).norm(), 0, 1e-6);
    EXPECT_NEAR(depth / c.compliance, 0.25 * weight, 1e-4);
  }
}

// A force 10 mm off the centre is carried as the lever rule has it.
TEST(ConstraintSolver, ContactsShareAnEccentricLoad) {
  BoxOnPlane box;
  box.compliance = 1e-9;  // nearly rigid: the box does not tilt
  box.load = {Vec3(0.01, 0, 0).cross(Vec3(0, 0, -8)), Vec3(0, 0, -8)};
  for (int i = 0; i < 3; ++i) {
    box.Step(3000);
  }
  const double far = box.solver.normal_force(0) + box.solver.normal_force(3);
  const double near = box.solver.normal_force(1) + box.solver.normal_force(2);
  EXPECT_NEAR(near, 8 * (0.05 + 0.01) / 0.1, 1e-3);
  EXPECT_NEAR(far, 8 * (0.05 - 0.01) / 0.1, 1e-3);
}

// A contact that would have to pull lets go.
TEST(ConstraintSolver, ContactsDoNotPull) {
  BoxOnPlane box;
  box.load.f = Vec3(0, 0, 3);
  box.Step();
  EXPECT_EQ(box.TotalNormalForce(), 0);
  EXPECT_NEAR(box.V.v.z(), kDt * 3 / kBodyMass, 1e-15);
}

// A gap is closed within the step, not overshot: the box stops at the surface.
TEST(ConstraintSolver, FallOntoASurfaceEndsAtIt) {
  BoxOnPlane box;
  box.compliance = 0;
  std::fill_n(box.gap, 4, 0.3e-3);
  box.V.v = Vec3(0, 0, -1);
  for (int i = 0; i < 3; ++i) {
    box.Step(300);
    for (const double gap : box.gap) {
      EXPECT_NEAR(gap, 0, 1e-9);
    }
  }
}

/** Acceleration down a slope [m/s^2] in the steady state, straight down it. */
Vec3 SlideDown(double slope, double heading, double friction) {
  BoxOnPlane box;
  box.friction = friction;
  box.R = (Eigen::AngleAxisd(slope, Vec3(-std::sin(heading), std::cos(heading), 0))).matrix();
  box.load.f = Vec3(0, 0, -kBodyMass * kGravity);
  for (int i = 0; i < 300; ++i) {
    box.Step();
  }
  const Vec3 before = box.V.v;
  for (int i = 0; i < 100; ++i) {
    box.Step();
  }
  return box.R.transpose() * (box.V.v - before) / (100 * kDt);
}

// X11: a body on a slope sticks while tan(slope) < mu and slides above with g (sin - mu cos), to
// whichever side the slope falls.
TEST(ConstraintSolver, FrictionHoldsWithinCoulombsCone) {
  const double mu = 0.15;
  for (int i = 0; i < 8; ++i) {
    const double heading = i * std::numbers::pi / 7;
    EXPECT_LT(SlideDown(std::atan(0.97 * mu), heading, mu).norm(), 1e-6) << heading;
    const double steep = std::atan(1.2 * mu);
    const double expected = kGravity * (std::sin(steep) - mu * std::cos(steep));
    const Vec3 a = SlideDown(steep, heading, mu);
    EXPECT_NEAR(a.head<2>().norm(), expected, 0.01 * expected) << heading;
    // Down the slope, and no other way.
    EXPECT_NEAR(a.head<2>().normalized().dot(Eigen::Vector2d(std::cos(heading), std::sin(heading))),
                1, 1e-3)
        << heading;
  }
}

// Dry friction of a fit, W8 and W9: holds below its bound at exactly no motion, and opposes with
// exactly the bound above it.
TEST(ConstraintSolver, BoundedRowSticksBelowItsBoundAndSlidesAbove) {
  Vec6 J;
  J << Vec3::Zero(), Vec3::UnitZ();
  const double bound = 5;
  for (const double push : {-4.99, -1.0, 0.0, 2.0, 4.99}) {
    ConstraintSolver solver;
    solver.Begin(kBodyMass, Inertia(), Vec3::Zero(), {}, kDt);
    solver.AddWrench({Vec3::Zero(), Vec3(0, 0, push)});
    const int row = solver.AddBoundedRow(J, {-bound, bound});
    EXPECT_NEAR(solver.Solve(30).v.z(), 0, 1e-18) << push;
    EXPECT_NEAR(solver.bounded_force(row), -push, 1e-12);
  }
  for (const double push : {-9.0, -5.01, 5.01, 7.0}) {
    ConstraintSolver solver;
    solver.Begin(kBodyMass, Inertia(), Vec3::Zero(), {}, kDt);
    solver.AddWrench({Vec3::Zero(), Vec3(0, 0, push)});
    const int row = solver.AddBoundedRow(J, {-bound, bound});
    const double rest = push - std::copysign(bound, push);
    EXPECT_NEAR(solver.Solve(30).v.z(), kDt * rest / kBodyMass, 1e-15);
    EXPECT_EQ(solver.bounded_force(row), -std::copysign(bound, push));
  }
}

// A moving shaft is braked to a stop and never turned round.
TEST(ConstraintSolver, BoundedRowNeverReversesTheMotion) {
  Vec6 J;
  J << Vec3::Zero(), Vec3::UnitX();
  Twist V{Vec3::Zero(), Vec3(0.0123, 0, 0)};
  double before = V.v.x();
  for (int i = 0; i < 10; ++i) {
    ConstraintSolver solver;
    solver.Begin(kBodyMass, Inertia(), Vec3::Zero(), V, kDt);
    (void)solver.AddBoundedRow(J, {-2, 2});
    V = solver.Solve(30);
    EXPECT_GE(V.v.x(), 0);
    EXPECT_NEAR(V.v.x(), std::max(0.0, before - kDt * 2 / kBodyMass), 1e-15);
    before = V.v.x();
  }
  EXPECT_EQ(V.v.x(), 0);
}

struct RandomScene {
  Mat3 I;
  Vec3 p_WCm;
  Twist V_0;
  Vec3 p_WQ, f0;
  Mat3 K;
  Vec3 points[6];
  Vec3 normals[6];
  Vec6 J;
};

Twist SolveTurned(const RandomScene& s, const Mat3& R, Vec3* total) {
  ConstraintSolver solver;
  solver.Begin(kBodyMass, R * s.I * R.transpose(), R * s.p_WCm, {R * s.V_0.w, R * s.V_0.v}, kDt);
  solver.AddPointSpring(R * s.p_WQ, R * s.f0, R * s.K * R.transpose());
  const int patch = solver.AddPatch({0, ConstraintSolver::kWorld, 0.3});
  for (int i = 0; i < 6; ++i) {
    solver.AddContact({patch, R * s.points[i], R * s.normals[i], 0.01 * i, 2e-6});
  }
  Vec6 J;
  J << R * s.J.head<3>(), R * s.J.tail<3>();
  (void)solver.AddBoundedRow(J, {-1, 1});
  Twist V = solver.Solve(20'000);
  *total = Vec3::Zero();
  for (int i = 0; i < 6; ++i) {
    *total += solver.contact_force(i);
  }
  return V;
}

// No direction of the world is special: what is turned before is turned after.
TEST(ConstraintSolver, DoesNotDependOnTheFrame) {
  Random random(11);
  double worst = 0;
  int pressing = 0;
  for (int draw = 0; draw < 30; ++draw) {
    RandomScene s;
    s.I = DrawPositive(&random, 1e-3) + 2e-4 * Mat3::Identity();
    s.p_WCm = RandomVector(&random, 0.2);
    s.V_0 = {RandomVector(&random, 1), RandomVector(&random, 0.2) - Vec3(0, 0, 0.3)};
    s.p_WQ = s.p_WCm + RandomVector(&random, 0.05);
    s.f0 = RandomVector(&random, 5);
    s.K = DrawPositive(&random, 1000);
    for (int i = 0; i < 6; ++i) {
      s.points[i] = s.p_WCm + RandomVector(&random, 0.05);
      s.normals[i] = (Vec3(0, 0, 1) + RandomVector(&random, 0.5)).normalized();
    }
    s.J << RandomVector(&random, 0.05), RandomVector(&random, 1);
    const Mat3 R = Quat(random.Normal(), random.Normal(), random.Normal(), random.Normal())
                       .normalized()
                       .toRotationMatrix();
    Vec3 force;
    Vec3 turned_force;
    const Twist V = SolveTurned(s, Mat3::Identity(), &force);
    const Twist turned = SolveTurned(s, R, &turned_force);
    pressing += force.norm() > 1 ? 1 : 0;
    worst = std::max(worst, (R * V.v - turned.v).norm());
    worst = std::max(worst, 0.05 * (R * V.w - turned.w).norm());
  }
  EXPECT_LT(worst, 1e-6);
  EXPECT_GT(pressing, 20);
}

// So many contacts and no more: further ones change nothing, and the count says so.
TEST(ConstraintSolver, CapacityIsKept) {
  const auto solve = [](int contacts, ConstraintSolver* solver) {
    solver->Begin(kBodyMass, Inertia(), Vec3::Zero(), {Vec3::Zero(), Vec3(0, 0, -0.2)}, kDt);
    const int patch = solver->AddPatch({0, ConstraintSolver::kWorld, 0.1});
    for (int i = 0; i < contacts; ++i) {
      const double a = 0.1 * i;
      // Those beyond the capacity would push upwards hard.
      solver->AddContact({patch, 0.03 * Vec3(std::cos(a), std::sin(a), -0.2), Vec3::UnitZ(),
                          i < ConstraintSolver::kMaxContacts ? 0.0 : 1.0, 2e-6});
    }
    return solver->Solve(30);
  };
  ConstraintSolver full;
  ConstraintSolver over;
  const Twist V = solve(ConstraintSolver::kMaxContacts, &full);
  const Twist V_over = solve(ConstraintSolver::kMaxContacts + 10, &over);
  EXPECT_EQ(full.contact_count(), ConstraintSolver::kMaxContacts);
  EXPECT_EQ(over.contact_count(), ConstraintSolver::kMaxContacts);
  EXPECT_EQ(V.v, V_over.v);
  EXPECT_EQ(V.w, V_over.w);

  ConstraintSolver solver;
  solver.Begin(kBodyMass, Inertia(), Vec3::Zero(), {}, kDt);
  for (int i = 0; i < ConstraintSolver::kMaxBoundedRows; ++i) {
    EXPECT_EQ(solver.AddBoundedRow(Vec6::Unit(i), {-1, 1}), i);
  }
  EXPECT_EQ(solver.AddBoundedRow(Vec6::Unit(5), {-1, 1}), -1);
  (void)solver.Solve(30);
  EXPECT_EQ(solver.bounded_force(-1), 0);
}

// The solver of one step leaves nothing behind for the next.
TEST(ConstraintSolver, IsReusable) {
  BoxOnPlane used;
  used.load.f = Vec3(1, 0, -5);
  used.friction = 0.2;
  used.Step();
  Vec6 J;
  J << Vec3::Zero(), Vec3::UnitX();
  const auto step = [&J](ConstraintSolver* solver) {
    solver->Begin(kBodyMass, Inertia(), Vec3::Zero(), {Vec3(1, 0, 0), Vec3(0, 1, -1)}, kDt);
    const int patch = solver->AddPatch({0, ConstraintSolver::kWorld, 0.3});
    solver->AddContact({patch, Vec3(0.01, 0, 0), Vec3::UnitZ(), 0, 2e-6});
    (void)solver->AddBoundedRow(J, {-1, 1});
    return solver->Solve(30);
  };
  ConstraintSolver fresh;
  EXPECT_EQ(Stack(step(&used.solver)), Stack(step(&fresh)));
}

}  // namespace
}  // namespace hvas::haptics
