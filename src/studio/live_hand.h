#pragma once

#include <cstdint>
#include <memory>

#include "device/opened_device.h"
#include "simulation/device_session.h"
#include "simulation/simulated_person.h"
#include "studio/live_trial.h"
#include "studio/pointer.h"

namespace hvas::studio {

/** What is put into a hand. */
struct HandSetup {
  std::shared_ptr<device::OpenedDevice> device;  ///< Null: none, a pointer moves the hand.
  double scale{0};                               ///< As in simulation::RenderOptions.
};

/** What a hand is made for. */
struct HandPurpose {
  bool has_person{false};  ///< The simulated person works, instead of whoever is at the page.
  std::uint64_t seed{1};
  spatial::Pose X_WH;  ///< Where the hand is at first.
  double rate_hz{1000};
  const LiveTrial* trial{nullptr};  ///< Of a study; may be null.
};

/** Options of the tick for a hand that is moved from afar: as for the simulated device, with full
 safety limits, and the force taken back when nothing is heard from the client. */
[[nodiscard]] haptics::TickOptions MakePointerOptions(double rate_hz);

/** One hand of a live assembly. A device moves it, a pointer, or the simulated person. An emulated
 device is held by the person or the pointer; what is held for real is not moved by anybody else, so
 that the simulated person works beside it, without a device. */
class LiveHand {
 public:
  LiveHand(const HandSetup& setup, const HandPurpose& purpose, const simulation::Model& model);

  [[nodiscard]] simulation::Operator* active() const { return active_; }

  /** Null where the simulated person does not work. */
  [[nodiscard]] simulation::SimulatedPerson* person() const { return person_.get(); }

  [[nodiscard]] PointerOperator& pointer() { return pointer_; }

  [[nodiscard]] const haptics::TickOptions& tick_options() const { return tick_options_; }

  /** Somebody at the page moves it, and not a device by itself. */
  [[nodiscard]] bool follows_pointer() const { return follows_pointer_; }

 private:
  std::shared_ptr<device::OpenedDevice> device_;
  haptics::TickOptions tick_options_;
  PointerOperator pointer_;
  std::unique_ptr<simulation::SimulatedPerson> person_;
  std::unique_ptr<simulation::Operator> at_device_;  ///< Null where nothing goes through a device.
  simulation::Operator* active_{nullptr};
  bool follows_pointer_{false};
};

}  // namespace hvas::studio
