#include "studio/frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace hvas::studio {
namespace {

std::array<float, 3> Pack(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

std::array<float, 4> Pack(const Quat& q) {
  return {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
          static_cast<float>(q.z())};
}

bool IsSame(const spatial::Pose& a, const spatial::Pose& b) {
  return a.p() == b.p() && a.q().coeffs() == b.q().coeffs();
}

protocol::HandState MakeHand(const haptics::TickOutput& tick, std::size_t index, double peak_felt) {
  protocol::HandState hand;
  hand.hand = static_cast<std::uint32_t>(index);
  hand.state = static_cast<std::uint32_t>(tick.state);
  hand.occurrence = tick.occurrence.is_valid() ? tick.occurrence.value() : protocol::kNone;
  hand.mate = tick.axis.mate.is_valid() ? tick.axis.mate.value() : protocol::kNone;
  hand.gate_actions = tick.gate_actions;
  hand.contact_count = static_cast<std::uint32_t>(tick.contact_count);
  hand.p_WH_m = Pack(tick.X_WH.p());
  hand.q_WH = Pack(tick.X_WH.q());
  hand.p_WT_m = Pack(tick.X_WT.p());
  hand.q_WT = Pack(tick.X_WT.q());
  hand.p_WD_m = Pack(tick.X_WD.p());
  hand.q_WD = Pack(tick.X_WD.q());
  hand.f_felt_W_n = Pack(tick.F_H_W.f);
  hand.t_felt_W_nm = Pack(tick.F_H_W.t);
  hand.f_true_W_n = Pack(tick.F_true_W.f);
  hand.t_true_W_nm = Pack(tick.F_true_W.t);
  hand.peak_felt_n = static_cast<float>(peak_felt);
  hand.axial_true_n = static_cast<float>(tick.axial_true);
  hand.axial_felt_n = static_cast<float>(tick.axial_felt);
  hand.depth_m = static_cast<float>(tick.axis.depth);
  hand.depth_goal_m = static_cast<float>(tick.axis.depth_goal);
  hand.tilt_rad = static_cast<float>(tick.axis.tilt);
  hand.offset_m = static_cast<float>(tick.axis.offset);
  hand.penetration_m = std::isfinite(tick.deepest) ? static_cast<float>(-tick.deepest) : 0;
  hand.p_WAxis_m = Pack(tick.axis.p_WQ);
  hand.axis_W = Pack(tick.axis.axis_W);
  return hand;
}

std::vector<protocol::BodyPose> ListMoved(const simulation::Frame& frame,
                                          std::vector<spatial::Pose>* known) {
  std::vector<protocol::BodyPose> moved;
  const bool is_first = known->size() != frame.X_WB.size();
  for (std::size_t i = 0; i < frame.X_WB.size(); ++i) {
    if (is_first || !IsSame(frame.X_WB[i], (*known)[i])) {
      moved.push_back(
          {static_cast<std::uint32_t>(i), Pack(frame.X_WB[i].p()), Pack(frame.X_WB[i].q())});
    }
  }
  *known = frame.X_WB;
  return moved;
}

/** Lists the deformations that look different from what is known, at first all, and makes them
 * known.
 */
std::vector<protocol::Deformation> ListDeformed(const std::vector<double>& amounts,
                                                std::vector<double>* known) {
  constexpr double kLeastChange = 1e-6;  // [m]: less is not seen. A choice.
  std::vector<protocol::Deformation> changed;
  const bool is_first = known->size() != amounts.size();
  known->resize(amounts.size(), 0.0);
  for (std::size_t i = 0; i < amounts.size(); ++i) {
    double& shown = (*known)[i];
    const bool is_over = amounts[i] == 0 && shown != 0;
    if (is_first || is_over || std::abs(amounts[i] - shown) > kLeastChange) {
      shown = amounts[i];
      changed.push_back({static_cast<std::uint32_t>(i), static_cast<float>(amounts[i])});
    }
  }
  return changed;
}

/** Makes histogram counts between edges; the last bin has everything above the last edge. */
Json CountBetween(const LatencyHistogram& histogram, std::span<const int> edges_us) {
  constexpr std::int64_t kNsPerUs = 1000;  // A definition.
  Json counts = Json::array();
  std::uint64_t before = 0;
  for (const int edge_us : edges_us) {
    const std::uint64_t up_to = histogram.CountUpTo(edge_us * kNsPerUs);
    counts.push_back(up_to - before);
    before = up_to;
  }
  counts.push_back(histogram.count() - before);
  return counts;
}

Json MakeHistograms(const simulation::LoopStatus& status) {
  static constexpr std::array kEdgesUs{10,  20,  30,  50,  75,   100,  150, 200,
                                       300, 400, 500, 750, 1000, 2000, 5000};
  return {{"edges_us", kEdgesUs},
          {"compute", CountBetween(status.compute, kEdgesUs)},
          {"wake_up", CountBetween(status.wake_up, kEdgesUs)}};
}

}  // namespace

std::string MakeFrames(const LiveFrame& live, std::int64_t t_ns, std::uint32_t seq,
                       ShownState* known) {
  const simulation::Frame& frame = live.frame;
  const std::vector<protocol::BodyPose> moved = ListMoved(frame, &known->X_WB);
  std::vector<protocol::HandState> hands;
  std::vector<protocol::ContactPoint> contacts;
  for (std::size_t i = 0; i < frame.ticks.size(); ++i) {
    const haptics::TickOutput& tick = frame.ticks[i];
    hands.push_back(MakeHand(tick, i, live.peak_felt[i]));
    if (tick.contact_count > 0) {
      contacts.push_back(
          {static_cast<std::uint32_t>(i),
           tick.contact_body.is_valid() ? tick.contact_body.value() : protocol::kNone,
           Pack(tick.p_WC), Pack(tick.f_C_W)});
    }
  }
  std::string bytes;
  AppendFrame<protocol::BodyPose>(moved, seq, live.epoch, t_ns, &bytes);
  AppendFrame<protocol::HandState>(hands, seq, live.epoch, t_ns, &bytes);
  AppendFrame<protocol::ContactPoint>(contacts, seq, live.epoch, t_ns, &bytes);
  const auto deformed = ListDeformed(live.deformations, &known->deformations);
  if (!deformed.empty()) {
    AppendFrame<protocol::Deformation>(deformed, seq, live.epoch, t_ns, &bytes);
  }
  return bytes;
}

spatial::Pose PoseOf(const protocol::HandInput& input) {
  const auto& p = input.p_WH_m;
  const auto& q = input.q_WH;
  const Quat q_WH(static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2]),
                  static_cast<double>(q[3]));
  return {q_WH.normalized(),
          Vec3(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]))};
}

Json MakeHandStatus(const LiveFrame& frame, std::size_t hand) {
  const haptics::TickOutput& tick = frame.frame.ticks[hand];
  return {{"hand", hand},
          {"speed_m_s", frame.hand_speed[hand]},
          {"force_n", tick.F_H_D.f.norm()},
          {"torque_nm", tick.F_H_D.t.norm()},
          {"energy_j", tick.energy.in - tick.energy.out}};
}

Json MakeStatus(const simulation::LoopStatus& status) {
  const auto us = [](std::int64_t ns) { return 1e-3 * static_cast<double>(ns); };
  // The shares that are told: half, and all but a hundredth.
  constexpr double kP50 = 0.5;
  constexpr double kP99 = 0.99;
  const std::string scheduling = status.is_fifo ? "SCHED_FIFO" : "normal priority";
  return {{"event", "status"},
          {"tick_hz", static_cast<double>(status.compute.count())},
          {"compute_p50_us", us(status.compute.Quantile(kP50))},
          {"compute_p99_us", us(status.compute.Quantile(kP99))},
          {"compute_max_us", us(status.compute.max_ns())},
          {"wake_up_p99_us", us(status.wake_up.Quantile(kP99))},
          {"late_ticks", status.late_wake_ups},
          {"overruns", status.overruns},
          {"lost_events", status.lost_events},
          {"truncated_ticks", status.contact_limits.truncated_ticks},
          {"crowded_ticks", status.contact_limits.crowded_ticks},
          {"effort_level", status.effort_level},
          {"scheduling", scheduling},
          {"is_memory_locked", status.is_memory_locked},
          {"physics_hz", 1e9 / static_cast<double>(simulation::Simulation::kPhysicsStepNs)},
          {"histograms", MakeHistograms(status)}};
}

}  // namespace hvas::studio
