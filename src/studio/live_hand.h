#pragma once

#include <cstdint>
#include <memory>

#include "base/loop_clock.h"
#include "device/opened_device.h"
#include "haptics/paper_guidance.h"
#include "person/simulated_person.h"
#include "simulation/device_session.h"
#include "studio/live_trial.h"
#include "studio/pointer.h"

namespace hvas::studio {

/** Device of a hand. */
struct HandSetup {
  std::shared_ptr<device::OpenedDevice> device;  ///< Null: the client's pointer moves the hand.
  double scale{0};                               ///< See simulation::RenderOptions.
};

/** Conditions under which a hand is used. */
struct HandPurpose {
  bool has_person{false};  ///< The simulated person works, instead of the user at the page.
  std::uint64_t seed{1};
  spatial::Pose X_WH;  ///< Initial pose of the hand.
  double rate_hz{1000};
  const LiveTrial* trial{nullptr};    ///< Trial of a study; may be null.
  haptics::PaperGuidance guidance;    ///< Guidance outside trials, which have their own.
  LoopClock* clock{&MachineClock()};  ///< Clock of the session.
};

/** Makes the tick options of a hand that a remote client moves: those of the simulated device, with
 full safety limits, and no force once the client's input times out. */
[[nodiscard]] haptics::TickOptions MakePointerOptions(double rate_hz);

/** One hand of a live assembly, moved by a device, the client's pointer, or the simulated person.
 The person or the pointer can hold an emulated device. A real device is moved by its user alone, so
 that the simulated person works without a device there. */
class LiveHand {
 public:
  LiveHand(const HandSetup& setup, const HandPurpose& purpose, const simulation::Model& model);

  [[nodiscard]] simulation::Operator* active() const { return active_; }

  /** Null where the simulated person does not move this hand. */
  [[nodiscard]] person::SimulatedPerson* person() const { return person_.get(); }

  [[nodiscard]] PointerOperator& pointer() { return pointer_; }

  [[nodiscard]] const haptics::TickOptions& tick_options() const { return tick_options_; }

  /** Whether the client's pointer moves it, and not a device or the simulated person. */
  [[nodiscard]] bool follows_pointer() const { return follows_pointer_; }

 private:
  std::shared_ptr<device::OpenedDevice> device_;
  haptics::TickOptions tick_options_;
  PointerOperator pointer_;
  std::unique_ptr<person::SimulatedPerson> person_;
  std::unique_ptr<simulation::Operator> at_device_;  ///< Null where no device is in the loop.
  simulation::Operator* active_{nullptr};
  bool follows_pointer_{false};
};

}  // namespace hvas::studio
