#pragma once

#include <string>
#include <vector>

#include "fits/threads.h"
#include "product/product.h"

namespace hvas::mates {

/** Friction in threads and under heads of lightly oiled steel: what tightening is reckoned with. */
inline constexpr double kThreadFriction = 0.12;
/** Mean diameter of the contact under a head, in diameters of the screw: 1.27 to 1.30 for ISO 4014
 and ISO 4762 with a medium hole. */
inline constexpr double kHeadContact = 1.28;

/** How a threaded joint holds. */
enum class ThreadJointKind {
  kThreaded,     ///< A screw in a nut or in a tapped hole.
  kSelfTapping,  ///< The screw cuts or forms its thread in the hole.
};

/** What a mate with FitKind::kThread is as a joint. */
struct ThreadJoint {
  product::MateId mate;
  ThreadJointKind kind{ThreadJointKind::kThreaded};
  /** The standard thread; null where no table has its diameter. */
  const fits::Thread* thread{nullptr};
  double diameter{0};          ///< Nominal diameter [m].
  double pitch{0};             ///< [m]; 0 where it is not known.
  bool is_left_handed{false};  ///< Hand of its helical faces.
  bool is_modelled{false};     ///< Helical faces are there, on one side at least.
  double engaged{0};           ///< Engaged length [m].
  double turns{0};             ///< Turns over this length; 0 where no pitch is known.
  fits::ThreadHole hole{
      fits::ThreadHole::kWide};  ///< What the drawn hole is; kWide without `thread`.
  /** Preload and torque for steel of property class 8.8 with friction 0.12, by the short formula of
   VDI 2230-1; zero where there is no standard thread, and for self-tapping screws. */
  fits::Tightening tightening;
};

/** The threaded joints among the mates, in the order of the mates. The size of the thread is what
 the name of the screw or nut states, else the pitch of modelled helical faces and the table's
 diameter for the shaft, else the one whose core and outer diameter hole and shaft are, else the
 coarse one for the drawn diameter of the shaft, else for that of the hole. A screw is self-tapping
 where its name says so, or where the hole is in a part of plastic. */
[[nodiscard]] std::vector<ThreadJoint> FindThreadJoints(const product::Product& product);

[[nodiscard]] const char* ToString(ThreadJointKind kind);

}  // namespace hvas::mates
