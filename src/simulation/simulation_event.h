#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "contact/scene.h"
#include "device/device.h"
#include "haptics/tick_output.h"
#include "product/ids.h"
#include "simulation/flight_recorder.h"
#include "spatial/pose.h"

namespace hvas::simulation {

/** What one hold of a part amounted to. */
struct HoldMetrics {
  std::int64_t t_taken_ns{0};
  double path{0};                 ///< Path of the displayed centre of mass [m].
  double peak_true{0};            ///< Largest true force [N].
  double peak_felt{0};            ///< Largest force given to the device [N].
  double fit_true{0};             ///< Largest axial force of fits, true [N].
  double fit_felt{0};             ///< Largest axial force of fits, as felt [N].
  double preload{0};              ///< Largest force in it as a screw or nut, true [N].
  double tightening{0};           ///< Largest torque of its thread and head, true [N m].
  bool is_thread_crossed{false};  ///< It came into its thread tilted.
  double deepest{0};              ///< Deepest penetration, >= 0 [m].
  double insertion{0};            ///< Longest engagement of a captured axis [m].
  double arrival{0};              ///< Distance from its place when it was moved exactly there [m].
  double arrival_angle{0};        ///< Angle from its place then [rad].
  int collisions{0};              ///< Contacts that began before a mate guided the part.
  contact::BodyId hardest;  ///< Body pressed hardest while the hand was inserting; may be invalid.
  double hardest_force{0};  ///< [N]
};

/** Something that happened in a tick. */
struct SimulationEvent {
  enum class Kind : std::uint8_t {
    kTaken,
    kState,
    kDropped,
    kSafety,  ///< The gate began to do something.
    kDevice,  ///< The device's condition changed.
    kEffort,  ///< The tick does less, or more again.
    kEnergy,  ///< Once a second with a device: what went to the hand and came from it.
  };
  std::int64_t t_ns{0};
  Kind kind{Kind::kState};
  std::size_t hand{0};
  product::OccurrenceId occurrence;
  haptics::HoldState state{haptics::HoldState::kEmpty};
  spatial::Pose X_WB;             ///< kDropped: where the part was let go.
  bool was_seated{false};         ///< kDropped: it is in its place.
  double to_place{0};             ///< kDropped: distance of its centre of mass from there [m].
  product::OccurrenceId onto;     ///< kDropped: leads the loose parts that it was put to (X1).
  HoldMetrics metrics;            ///< kDropped: the whole hold's.
  std::uint32_t gate_actions{0};  ///< kSafety: those that are new.
  device::Condition condition{device::Condition::kReady};  ///< kDevice
  std::int32_t vendor_code{0};                             ///< kDevice
  int effort_level{0};                                     ///< kEffort
  haptics::PassivityAccount energy;                        ///< kEnergy, of forces
  haptics::PassivityAccount turning_energy;                ///< kEnergy, of torques
};

/** Receives what the loops produce. OnTick runs on the haptic thread and must be RT-safe; OnEvent
 runs on the physics thread. */
class Sink {
 public:
  Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  virtual ~Sink() = default;
  virtual void OnTick(std::size_t hand, const device::DeviceState& device,
                      const haptics::TickOutput& out) noexcept = 0;
  virtual void OnEvent(const SimulationEvent& event) = 0;

  /** The second before a fault, and what came after. Physics thread. */
  virtual void OnFlight(const std::vector<FlightTick>& ticks) { (void)ticks; }
};

}  // namespace hvas::simulation
