#include "study/trial_watch.h"

#include <algorithm>
#include <cmath>

namespace hvas::study {
namespace {

constexpr std::int64_t kApartNs = 100'000'000;  // equal to that of simulation::HoldMetrics

double Seconds(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

}  // namespace

TrialWatch::TrialWatch(product::OccurrenceId part, const Vec3& extraction_W, double window_s,
                       double period_s, simulation::Sink* downstream)
    : part_(part),
      q_AW_(Quat::FromTwoVectors(extraction_W, Vec3::UnitZ())),
      downstream_(downstream),
      contact_ns_(-2 * kApartNs),
      kept_(static_cast<std::size_t>(std::ceil(window_s / (kKeepEvery * period_s)))) {}

void TrialWatch::OnTick(std::size_t hand, const device::DeviceState& device,
                        const haptics::TickOutput& out) noexcept {
  if (downstream_ != nullptr) {
    downstream_->OnTick(hand, device, out);
  }
  if (is_seated_) {
    return;
  }
  if (!has_begun_) {
    has_begun_ = true;
    first_ns_ = device.t_ns;
  }
  last_ns_ = device.t_ns;
  elapsed_ns_.store(last_ns_ - first_ns_, std::memory_order_relaxed);
  sums_.peak_felt = std::max(sums_.peak_felt, out.F_H_W.f.norm());
  if (out.occurrence.is_valid()) {
    sums_.peak_true = std::max(sums_.peak_true, out.F_true_W.f.norm());
    sums_.insertion = std::max(sums_.insertion, out.insertion_depth);
    if (out.contact_count > 0) {
      const bool is_new = device.t_ns - contact_ns_ > kApartNs;
      sums_.collisions += is_new && out.state < haptics::HoldState::kCaptured ? 1 : 0;
      contact_ns_ = device.t_ns;
    }
  }
  is_seated_ = out.occurrence == part_ && out.state == haptics::HoldState::kSeated;
  if (is_seated_ || ticks_ % kKeepEvery == 0) {
    Keep(device.t_ns, out);
  }
  ++ticks_;
}

void TrialWatch::Keep(std::int64_t t_ns, const haptics::TickOutput& out) noexcept {
  if (kept_.empty()) {
    return;
  }
  kept_[next_] = {t_ns, q_AW_ * out.F_H_W.f, q_AW_ * out.F_H_W.t};
  next_ = (next_ + 1) % kept_.size();
  ++kept_count_;
}

void TrialWatch::OnEvent(const simulation::SimulationEvent& event) {
  if (downstream_ != nullptr) {
    downstream_->OnEvent(event);
  }
}

void TrialWatch::OnFlight(const std::vector<simulation::FlightTick>& ticks) {
  if (downstream_ != nullptr) {
    downstream_->OnFlight(ticks);
  }
}

TrialResult TrialWatch::MakeResult() const {
  TrialResult result = sums_;
  result.outcome = is_seated_ ? Outcome::kDone : Outcome::kNotDone;
  result.time = Seconds(last_ns_ - first_ns_);
  const std::size_t count = std::min<std::uint64_t>(kept_count_, kept_.size());
  const std::size_t oldest = kept_count_ < kept_.size() ? 0 : next_;
  for (std::size_t i = 0; i < count; ++i) {
    const Kept& kept = kept_[(oldest + i) % kept_.size()];
    result.mating.push_back({Seconds(kept.t_ns - last_ns_), kept.f, kept.torque});
  }
  return result;
}

}  // namespace hvas::study
