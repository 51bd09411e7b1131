// What does one implicit step of the held part cost, by the number of contacts that press?
// Per step: assembly of the coupling, factorisation, and projected Gauss-Seidel up to 30 sweeps.

#include <cmath>

#include <benchmark/benchmark.h>

#include "haptics/constraint_solver.h"
#include "haptics/options.h"

namespace hvas::haptics {
namespace {

/** A part of 0.2 kg pressed on a plane by a coupling spring: contacts on a circle of 20 mm. */
void BM_SolverStep(benchmark::State& state) {
  const auto contacts = static_cast<int>(state.range(0));
  const TickOptions options;
  const Mat3 inertia = 5e-5 * Mat3::Identity();
  ConstraintSolver solver;
  double sum = 0;
  for (auto step : state) {
    solver.Begin(0.2, inertia, Vec3::Zero(), {}, options.dt);
    solver.AddPointSpring(Vec3::Zero(), Vec3(0.5, 0, -5),
                          options.coupling.k_lin * Mat3::Identity());
    solver.AddPointDamper(Vec3::Zero(), Vec3::Zero(), options.coupling.b_lin);
    solver.AddAngularSpring(Vec3::Zero(), options.coupling.k_rot * Mat3::Identity());
    const int patch =
        solver.AddPatch({0, ConstraintSolver::kWorld, options.contact.friction.kinetic_coefficient,
                         options.contact.friction.stiffness});
    for (int i = 0; i < contacts; ++i) {
      const double angle = 2 * 3.14159265358979 * i / contacts;
      solver.AddContact({patch, 0.02 * Vec3(std::cos(angle), std::sin(angle), -0.5), Vec3::UnitZ(),
                         0, options.contact.compliance});
    }
    sum += solver.Solve(hvas::haptics::Effort{}.iterations).v.x();
  }
  benchmark::DoNotOptimize(sum);
}

BENCHMARK(BM_SolverStep)->Arg(0)->Arg(1)->Arg(4)->Arg(16)->Arg(ConstraintSolver::kMaxContacts);

}  // namespace
}  // namespace hvas::haptics

BENCHMARK_MAIN();
