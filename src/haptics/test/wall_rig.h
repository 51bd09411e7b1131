#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "device/emulation/emulated_device.h"
#include "haptics/passivity_controller.h"
#include "haptics/safety_gate.h"

namespace hvas::haptics::testing {

/** A hand by how firmly it holds: arm and grip, at the handle. */
struct Grip {
  const char* name;
  double stiffness;  ///< [N/m]
  double damping;    ///< [N s/m]
  double mass;       ///< [kg]
};

inline constexpr Grip kGrips[] = {{"loose", 40, 2, 0.05},
                                  {"soft", 100, 5, 0.2},
                                  {"normal", 400, 25, 0.8},
                                  {"stiff", 1500, 40, 1.2}};

inline device::HandIntent MakeHand(const Grip& grip) {
  device::HandIntent hand;
  hand.stiffness = grip.stiffness;
  hand.damping = grip.damping;
  hand.mass = grip.mass;
  return hand;
}

/** State of a movement along x from `from` to `to` in `time` by minimum jerk; p and v. */
struct Reach {
  double p;
  double v;
};

inline Reach CalcReach(double from, double to, double time, double t) {
  const double s = std::clamp(t / time, 0.0, 1.0);
  return {from + (to - from) * s * s * s * (10 + s * (-15 + 6 * s)),
          (to - from) / time * 30 * s * s * (1 - s) * (1 - s)};
}

inline void SetTarget(const Reach& reach, device::HandIntent* hand) {
  hand->X_DR = spatial::Pose(Vec3(reach.p, 0, 0));
  hand->V_DR.v = Vec3(reach.v, 0, 0);
}

/** A virtual wall at x > 0, as a loop renders it to an emulated device: sampled, quantised, held,
 and late by whole ticks. */
class WallRig {
 public:
  WallRig(const device::DeviceProfile& profile, double stiffness, double damping)
      : device(profile), k_(stiffness), b_(damping) {}

  device::EmulatedDevice device;
  PassivityController* controller{nullptr};
  SafetyGate* gate{nullptr};
  int delay{0};     ///< Ticks from a command to the motors.
  double drive{0};  ///< Everywhere, along the velocity: gives energy [N s/m].
  bool is_gripping{true};
  Vec3 written{Vec3::Zero()};
  Vec3 wanted{Vec3::Zero()};

  void Tick(const device::HandIntent& hand, double dt) {
    device.SetHand(hand);
    Render(dt);
  }

  void TickWithoutHand(double dt) {
    device.ReleaseHand();
    Render(dt);
  }

 private:
  void Render(double dt) {
    const device::EmulatedSample sample = device.Sense();
    const double x = sample.X_DH.p().x();
    const double v = sample.V_DH.v.x();
    wanted = drive * sample.V_DH.v;
    double stored = 0;
    if (x > 0) {
      wanted.x() += std::min(0.0, -k_ * x - b_ * v);
      stored = 0.5 * k_ * x * x;
    }
    spatial::Wrench F;
    F.f = wanted;
    if (controller != nullptr) {
      F = controller->Limit(sample.X_DH, F, stored, 0, dt);
    }
    if (gate != nullptr) {
      GateInput input;
      input.F = F;
      input.p = sample.X_DH.p();
      input.V = sample.V_DH;
      input.dt = dt;
      input.is_gripping = is_gripping;
      F = gate->Pass(input);
    } else if (const double most = device.profile().max_force; F.f.norm() > most) {
      F.f *= most / F.f.norm();
    }
    if (controller != nullptr) {
      controller->Write(F);
    }
    written = F.f;
    late_.push_back(F);
    if (late_.size() > static_cast<std::size_t>(delay)) {
      device.Command(late_.front());
      late_.pop_front();
    }
    device.Advance(std::llround(1e9 * dt));
  }

  double k_;
  double b_;
  std::deque<spatial::Wrench> late_;
};

/** Ticks that a profile's delay is. */
inline int CountDelay(const device::DeviceProfile& profile, double dt) {
  return static_cast<int>(std::lround(profile.delay / dt));
}

/** The hand presses on a wall; does the loop come to rest? */
struct PressRun {
  double swing{0};    ///< Swing of the handle over the last 0.3 s, from end to end [m].
  double allowed{0};  ///< More is not stable [m].
  double work{0};     ///< Work of the motors on the hand, over all [J].

  double force{0};     ///< That the wall gave over the same time, on average [N].
  double expected{0};  ///< That it gives at rest, in series with the hand's spring [N].

  /** The handle is at rest, and the wall is still there. */
  [[nodiscard]] bool is_stable() const { return swing <= allowed && force >= 0.5 * expected; }
};

inline PressRun Press(const device::DeviceProfile& profile, const Grip& grip, double stiffness,
                      double damping, bool is_controlled) {
  const double dt = 1 / profile.rate_hz;
  WallRig rig(profile, stiffness, damping);
  rig.delay = CountDelay(profile, dt);
  PassivityController controller = MakePassivityController(profile, dt);
  rig.controller = is_controlled ? &controller : nullptr;
  device::HandIntent hand = MakeHand(grip);
  constexpr double kStart = -0.01;
  PressRun run;
  const double pressure = std::min(2.0, 0.3 * profile.max_force);
  run.expected = pressure * stiffness / (stiffness + grip.stiffness);
  // A few steps of the encoder, or what nobody sees.
  run.allowed = std::max(0.2e-3, 8 * profile.position_resolution);
  double low = INFINITY;
  double high = -INFINITY;
  constexpr double kTime = 1.0;
  constexpr double kRest = 0.3;
  for (double t = 0; t < kTime; t += dt) {
    SetTarget(CalcReach(kStart, pressure / grip.stiffness, 0.25, t), &hand);
    rig.Tick(hand, dt);
    if (t > kTime - kRest) {
      const double x = rig.device.truth().X_DH.p().x();
      low = std::min(low, x);
      high = std::max(high, x);
      run.force -= rig.device.truth().F_H_D.f.x() * dt / kRest;
    }
  }
  run.swing = high - low;
  run.work = rig.device.truth().work;
  return run;
}

}  // namespace hvas::haptics::testing
