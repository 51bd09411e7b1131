#include "record/tick_record.h"

#include "spatial/rounding.h"

namespace hvas::record {

TickRecord Rounded(const TickRecord& tick) noexcept {
  TickRecord rounded = tick;
  rounded.device_pose = spatial::Rounded(tick.device_pose);
  rounded.device_twist = spatial::Rounded(tick.device_twist);
  rounded.X_WH = spatial::Rounded(tick.X_WH);
  rounded.X_WD = spatial::Rounded(tick.X_WD);
  rounded.F_true_W = spatial::Rounded(tick.F_true_W);
  rounded.F_felt_W = spatial::Rounded(tick.F_felt_W);
  rounded.depth = spatial::RoundTo(spatial::kLengthStep, tick.depth);
  rounded.deepest = spatial::RoundTo(spatial::kLengthStep, tick.deepest);
  for (ContactRecord& contact : rounded.contacts) {
    const auto round = [](double step, const Eigen::Vector3f& v) -> Eigen::Vector3f {
      return spatial::RoundTo(step, v.cast<double>()).cast<float>();
    };
    contact.p_WC = round(kContactStep, contact.p_WC);
    contact.nhat_W = round(kContactStep, contact.nhat_W);
    contact.distance = static_cast<float>(spatial::RoundTo(spatial::kLengthStep, contact.distance));
  }
  return rounded;
}

}  // namespace hvas::record
