#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "base/clock.h"
#include "base/units.h"
#include "haptics/test/rig.h"

namespace hvas::haptics::testing {

/** How a scripted hand turns a nut on a bolt along z. */
struct TurnedNut {
  double turns{5};      ///< Turns after the play is taken up.
  double rate{1};       ///< [turns/s]
  double push{2e-3};    ///< How far the hand is ahead along the axis [m]: 2 N.
  double run_in{0.25};  ///< [turns] until the play is taken up.
  double handed{1};     ///< +1: its thread is right-handed.
};

/** What a nut did after its play was taken up. */
struct NutLeg {
  double turns{0};     ///< Positive counter-clockwise, seen from above.
  double advanced{0};  ///< Along z [m].
};

/** Turns the held nut and presses the way it goes; the hand follows it along the axis.
 @param sense  +1: up; -1: down.
 @param times_us  Gets the processor time of each tick; null: not wanted. */
inline NutLeg Turn(const TurnedNut& script, double sense, HeldRig* rig,
                   std::vector<double>* times_us = nullptr) {
  const double rate = sense * script.handed * script.rate * units::kTurn;
  const int ticks =
      static_cast<int>(std::lround((script.run_in + script.turns) / script.rate / kDt));
  const int run_in = static_cast<int>(std::lround(script.run_in / script.rate / kDt));
  NutLeg leg;
  double z_start = 0;
  Quat q_before = rig->hand->last().X_WD.q();
  for (int i = 0; i < ticks; ++i) {
    const double z = (rig->hand->last().X_WD * rig->part.p_BoBcm_B).z() + sense * script.push;
    const std::int64_t begin_ns = ThreadCpuNs();
    rig->hand->LeadTo(Vec3(0, 0, z), Vec3(0, 0, rate));
    if (times_us != nullptr) {
      times_us->push_back(1e-3 * static_cast<double>(ThreadCpuNs() - begin_ns));
    }
    const spatial::Pose& X_WD = rig->hand->last().X_WD;
    if (i >= run_in) {
      leg.turns += spatial::RotationBetween(q_before, X_WD.q()).z() / units::kTurn;
    } else {
      z_start = X_WD.p().z();
    }
    q_before = X_WD.q();
  }
  leg.advanced = rig->hand->last().X_WD.p().z() - z_start;
  return leg;
}

}  // namespace hvas::haptics::testing
