#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/digest.h"
#include "person/simulated_person.h"
#include "simulation/assembly_run.h"
#include "simulation/executors.h"
#include "simulation/test/small_models.h"

namespace hvas::person::testing {

using namespace simulation::testing;  // NOLINT(google-build-using-namespace): small products and
                                      // models.

/** Keeps what a session gave, and its fingerprint. */
class Watch final : public simulation::Sink {
 public:
  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;

  void OnEvent(const simulation::SimulationEvent& event) override { events.push_back(event); }

  [[nodiscard]] std::string Hex() const { return digest_.Hex(); }

  std::uint64_t ticks{0};
  double largest_jump{0};  ///< Largest change of the force on the hand, from tick to tick [N].
  std::int64_t t_of_jump_ns{0};
  double largest_force{0};  ///< Force on the hand [N].
  double deepest{0};        ///< Penetration, >= 0 [m].
  bool is_finite{true};
  std::vector<simulation::SimulationEvent> events;

 private:
  Digest digest_;
  Vec3 last_force_{Vec3::Zero()};
};

/** A session with the simulated person. */
struct Session {
  explicit Session(const std::shared_ptr<const simulation::Model>& model, std::uint64_t seed = 1,
                   const haptics::TickOptions& options = {}, const PersonOptions& habits = {})
      : simulation(model, options),
        person(habits, seed, simulation::StartOfHand(*model)),
        run(&simulation, &person, &watch) {}

  [[nodiscard]] simulation::Execution MakeExecution(double limit_s) {
    return run.MakeExecution(&person, limit_s);
  }

  simulation::Simulation simulation;
  SimulatedPerson person;
  Watch watch;
  simulation::AssemblyRun run;
};

inline void AddTo(Digest* digest, const Vec3& v) {
  for (int k = 0; k < 3; ++k) {
    digest->AddDouble(v[k]);
  }
}

inline void AddTo(Digest* digest, const spatial::Pose& X) {
  AddTo(digest, X.p());
  for (const double c : X.q().coeffs()) {
    digest->AddDouble(c);
  }
}

inline void Watch::OnTick(std::size_t, const device::DeviceState& device,
                          const haptics::TickOutput& out) noexcept {
  const double jump = (out.F_H_W.f - last_force_).norm();
  if (jump > largest_jump) {
    largest_jump = jump;
    t_of_jump_ns = device.t_ns;
  }
  last_force_ = out.F_H_W.f;
  largest_force = std::max(largest_force, out.F_H_W.f.norm());
  deepest = std::max(deepest, -out.deepest);
  is_finite = is_finite && out.F_H_W.f.allFinite() && out.F_H_W.t.allFinite() &&
              spatial::IsFinite(out.X_WD);
  ++ticks;
  digest_.AddInt(device.t_ns);
  AddTo(&digest_, device.X_DH);
  for (const spatial::Wrench& F : {out.F_H_W, out.F_true_W, out.F_felt_W}) {
    AddTo(&digest_, F.t);
    AddTo(&digest_, F.f);
  }
  AddTo(&digest_, out.X_WT);
  AddTo(&digest_, out.X_WD);
  AddTo(&digest_, out.p_WC);
  AddTo(&digest_, out.f_C_W);
  for (const double x : {out.insertion_depth, out.axial_true, out.axial_felt, out.deepest}) {
    digest_.AddDouble(x);
  }
  digest_.AddInt(static_cast<std::int64_t>(out.state));
  digest_.AddInt(out.occurrence.value());
  digest_.AddInt(out.contact_body.value());
  digest_.AddInt(out.contact_count);
  digest_.AddInt(out.gate_actions);
  digest_.AddInt(out.is_truncated ? 1 : 0);
}

}  // namespace hvas::person::testing
