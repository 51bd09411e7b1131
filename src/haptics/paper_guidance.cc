#include "haptics/paper_guidance.h"

#include <algorithm>
#include <numbers>

namespace hvas::haptics {

void Apply(const PaperGuidance& guidance, TickOptions* tick) {
  if (guidance.k1) {
    tick->guidance.attraction_force = *guidance.k1 * tick->device.max_force;
  }
  if (guidance.k2) {
    tick->coupling.k_lin = std::min(tick->coupling.k_lin, *guidance.k2);
  }
  if (guidance.k3) {
    tick->coupling.k_rot =
        std::min(tick->coupling.k_rot, *guidance.k3 * tick->device.max_torque / std::numbers::pi);
  }
  tick->guidance.attracts_in_fits = guidance.attracts_in_fits;
  tick->guidance.contact_in_holes = guidance.contact_in_holes;
  tick->guidance.threads_turn = guidance.threads_turn;
}

}  // namespace hvas::haptics
