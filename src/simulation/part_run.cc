#include "simulation/part_run.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "mates/mate_kind.h"
#include "product/bearable_strain.h"
#include "product/flexible.h"
#include "sequence/thread_way.h"
#include "sequence/turning_way.h"

namespace hvas::simulation {

using product::OccurrenceId;

namespace {

/** Two values, the second one first unless they are in order. */
template <typename T>
std::pair<const T&, const T&> InOrder(bool is_in_order, const T& a, const T& b) {
  return is_in_order ? std::pair<const T&, const T&>(a, b) : std::pair<const T&, const T&>(b, a);
}

}  // namespace

PartRun::PartRun(Simulation* simulation, Sink* downstream)
    : dropped_(simulation->model().bodies.size()),
      has_touched_(simulation->model().bodies.size(), false),
      is_assumed_(simulation->model().bodies.size(), false),
      simulation_(simulation),
      downstream_(downstream) {
  for (const Body& body : simulation_->model().bodies) {
    lift_height_ = std::max(lift_height_, 1.2 * body.shape->box_B().size().norm());
  }
}

Execution PartRun::MakeExecution(const Operators& hands, double limit_s) {
  Execution execution;
  execution.simulation = simulation_;
  execution.hands = hands;
  execution.sink = this;
  execution.advance = [this] { Advance(); };
  execution.is_done = [this] { return is_done_; };
  execution.limit_ns = std::llround(1e9 * limit_s);
  return execution;
}

void PartRun::OnTick(std::size_t hand, const device::DeviceState& device,
                     const haptics::TickOutput& out) noexcept {
  if (downstream_ != nullptr) {
    downstream_->OnTick(hand, device, out);
  }
}

void PartRun::OnFlight(const std::vector<FlightTick>& ticks) {
  if (downstream_ != nullptr) {
    downstream_->OnFlight(ticks);
  }
}

void PartRun::OnEvent(const SimulationEvent& event) {
  if (event.kind == SimulationEvent::Kind::kDropped) {
    is_assumed_[event.occurrence.index()] = false;
    dropped_[event.occurrence.index()] = event;
    if (event.was_seated) {
      sequence::SequenceStep alone;
      alone.occurrence = event.occurrence;
      has_touched_[event.occurrence.index()] = CountNeighboursInPlace(alone) > 0;
    }
    OnDropped(event);
  }
  states_[event.hand] = event.state;
  if (downstream_ != nullptr) {
    downstream_->OnEvent(event);
  }
}

bool PartRun::IsGuidedByPlanes(const sequence::SequenceStep& step) const {
  const Model& model = this->model();
  const auto has_axis = [&](OccurrenceId id) {
    const auto& mates = model.mates_of[id.index()];
    return std::any_of(mates.begin(), mates.end(), [&](product::MateId mate_id) {
      const product::Mate& mate = model.product->mates[mate_id.index()];
      const OccurrenceId other = mate.a.occurrence == id ? mate.b.occurrence : mate.a.occurrence;
      return mates::HoldsAcross(mate.kind) && physics().placement(other) == Placement::kPlaced;
    });
  };
  return !has_axis(step.occurrence) &&
         std::none_of(step.members.begin(), step.members.end(), has_axis);
}

bool PartRun::HasOnlyPlay(const sequence::SequenceStep& step) const {
  const Model& model = this->model();
  bool has_any = false;
  for (const product::MateId mate_id : model.mates_of[step.occurrence.index()]) {
    const product::Mate& mate = model.product->mates[mate_id.index()];
    const OccurrenceId other =
        mate.a.occurrence == step.occurrence ? mate.b.occurrence : mate.a.occurrence;
    const fits::FitForce* fit = model.mates[mate_id.index()].fit.get();
    if (physics().placement(other) != Placement::kPlaced || fit == nullptr) {
      continue;
    }
    if (fit->CalcRadialPlay(fit->length()) <= 0) {
      return false;
    }
    has_any = true;
  }
  return has_any;
}

bool PartRun::HasNothingToMove(const sequence::SequenceStep& step) const {
  const Placement placement = physics().placement(step.occurrence);
  return sequence::IsWithinProduct(step.kind) && placement != Placement::kHeld &&
         placement != PlacementBefore(step.kind);
}

paths::Path PartRun::WayOf(const sequence::SequenceStep& step) {
  const bool is_in_product = step.kind == sequence::SequenceStep::Kind::kInsert ||
                             step.kind == sequence::SequenceStep::Kind::kRemove;
  if (!step.way.empty() || !is_in_product || !simulation_->options().guidance.threads_turn) {
    return step.way;
  }
  return sequence::MakeThreadWay(*physics().Describe(step), step.engage_distance);
}

PersonTask PartRun::MakeTask(const sequence::SequenceStep& step) {
  const Model& model = this->model();
  const Body& body = model.bodies[step.occurrence.index()];
  const spatial::Pose X_BG(CombineMass(model, step).p_BoBcm_B);
  PersonTask task;
  task.occurrence = step.occurrence;
  task.p_BG = X_BG.p();
  task.takes_out = step.kind == sequence::SequenceStep::Kind::kRemove;
  if (task.takes_out) {
    task.X_WG_start = body.X_WB_start * X_BG;
    task.X_WG_goal = physics().pose(step.occurrence) * X_BG;
  } else {
    task.X_WG_start = physics().pose(step.occurrence) * X_BG;
    task.X_WG_goal = sequence::GoalOf(step, body.X_WB_goal) * X_BG;
  }
  task.starts_on_way = sequence::IsWithinProduct(step.kind);
  task.extraction_W = step.extraction_W;
  task.engage_distance = step.engage_distance;
  const paths::Path way = WayOf(step);
  if (!way.empty()) {
    ways_.push_back(sequence::MakeGripWay(way, X_BG.p(), body.shape->box_B()));
    task.way = &ways_.back();
    task.is_threaded = step.way.empty();
    task.extraction_W = task.way->outward_W();
    task.engage_distance = task.way->length();
  }
  task.has_play = simulation_->options().guidance.contact_in_holes && HasOnlyPlay(step);
  task.is_guided_by_planes = !task.takes_out && IsGuidedByPlanes(step);
  task.centre_W = model.centre_W;
  task.transfer_radius = model.transfer_radius;
  task.lift_height = lift_height_;
  return task;
}

std::optional<bool> PartRun::FindMoved(const sequence::SequenceStep& step, OccurrenceId a,
                                       OccurrenceId b) const {
  const auto is_moved = [&step](OccurrenceId id) {
    return id == step.occurrence ||
           std::find(step.members.begin(), step.members.end(), id) != step.members.end();
  };
  const bool is_a = is_moved(a);
  if (is_a == is_moved(b) || physics().placement(is_a ? b : a) != Placement::kPlaced) {
    return std::nullopt;
  }
  return is_a;
}

std::vector<PartAllowance> PartRun::ListPartAllowances(const sequence::SequenceStep& step) const {
  std::vector<PartAllowance> allowances;
  for (const sequence::DrawnOverlap& overlap : model().sequence.overlaps) {
    if (const auto is_a = FindMoved(step, overlap.a, overlap.b)) {
      PartAllowance allowance;
      allowance.kind = PartAllowance::Kind::kDrawn;
      std::tie(allowance.own, allowance.other) = InOrder(*is_a, overlap.a, overlap.b);
      std::tie(allowance.own_faces, allowance.other_faces) =
          InOrder(*is_a, overlap.faces_a, overlap.faces_b);
      allowance.depth = overlap.depth;
      allowance.is_beyond = overlap.is_beyond;
      allowances.push_back(std::move(allowance));
    }
  }
  for (const sequence::GivingPair& give : model().sequence.gives) {
    if (const auto is_own = FindMoved(step, give.flexible, give.other)) {
      PartAllowance allowance;
      allowance.kind = PartAllowance::Kind::kGive;
      std::tie(allowance.own, allowance.other) = InOrder(*is_own, give.flexible, give.other);
      allowance.depth = std::max(give.width, give.depth);
      allowance.flexible = give.flexible;
      allowance.flexible_kind = give.kind;
      allowance.strain = give.strain;
      allowance.bearable_strain = give.bearable_strain;
      if (give.curve) {
        allowance.force = haptics::CalcGivingPeak(*give.curve);
      }
      allowances.push_back(std::move(allowance));
    }
  }
  return allowances;
}

std::string PartRun::DescribeAllowance(const PartAllowance& allowance, bool is_beyond,
                                       const std::string& more) const {
  if (allowance.kind == PartAllowance::Kind::kDrawn) {
    const std::string beyond = is_beyond ? fmt::format(" of up to {:.1f} mm more than drawn",
                                                       units::ToMm(sequence::kBeyondDrawn))
                                         : "";
    return fmt::format("only by an allowance{}: it lies {:.3f} mm in {}{} as drawn", beyond,
                       units::ToMm(allowance.depth), PathOf(allowance.other), more);
  }
  const std::string who =
      allowance.flexible == allowance.own ? "" : ": " + PathOf(allowance.flexible);
  const std::string force =
      allowance.force.in > 0
          ? fmt::format(", {:.3g} N in, {:.3g} N out", allowance.force.in, allowance.force.out)
          : "";
  const std::string strain =
      allowance.strain > 0 ? fmt::format(", strain {:.2g} % of {:.2g} % that {} bears",
                                         100 * allowance.strain, 100 * allowance.bearable_strain,
                                         product::DescribeBearing(
                                             model().product->part_of(allowance.flexible).material,
                                             allowance.flexible_kind == product::FlexibleKind::kForm
                                                 ? "a plastic"
                                                 : "spring steel"))
                           : "";
  return fmt::format("goes in by giving {:.2f} mm ({}{}{}{})", units::ToMm(allowance.depth),
                     product::ToString(allowance.flexible_kind), who, force, strain);
}

std::string PartRun::DescribeAllowances(const std::vector<PartAllowance>& allowances) const {
  const bool is_beyond = std::any_of(allowances.begin(), allowances.end(),
                                     [](const PartAllowance& a) { return a.is_beyond; });
  std::string text;
  for (const PartAllowance::Kind kind : {PartAllowance::Kind::kDrawn, PartAllowance::Kind::kGive}) {
    const PartAllowance* deepest = nullptr;
    int count = 0;
    for (const PartAllowance& allowance : allowances) {
      if (allowance.kind == kind) {
        ++count;
        deepest = deepest == nullptr || allowance.depth > deepest->depth ? &allowance : deepest;
      }
    }
    if (deepest != nullptr) {
      const std::string more = count > 1 ? fmt::format(" and {} more", count - 1) : "";
      text += (text.empty() ? "" : "; ") + DescribeAllowance(*deepest, is_beyond, more);
    }
  }
  return text;
}

std::vector<PressedPair> PartRun::ListPresses(const sequence::SequenceStep& step) const {
  std::vector<PressedPair> presses;
  std::copy_if(model().presses.begin(), model().presses.end(), std::back_inserter(presses),
               [&step](const PressedPair& pair) { return pair.moved == step.occurrence; });
  return presses;
}

std::string PartRun::DescribePresses(const std::vector<PressedPair>& presses) const {
  const auto hardest = std::max_element(
      presses.begin(), presses.end(),
      [](const PressedPair& a, const PressedPair& b) { return a.force < b.force; });
  if (hardest == presses.end()) {
    return {};
  }
  const std::string more =
      presses.size() > 1 ? fmt::format(", and {} more", presses.size() - 1) : "";
  const product::ElasticPart* elastic = FindElastic(*model().product, hardest->parts.front());
  if (elastic != nullptr && elastic->kind == product::ElasticKind::kLipSeal) {
    return fmt::format("the lip of {} is spread by {:.2f} mm: {:.3g} N to go on ({}){}",
                       PathOf(hardest->parts.front()), units::ToMm(hardest->compression),
                       hardest->force, hardest->source, more);
  }
  if (hardest->is_radial) {
    return fmt::format("{} is squeezed by {:.2f} mm all around: {:.3g} N to push it in ({}){}",
                       PathOf(hardest->parts.front()), units::ToMm(hardest->compression),
                       hardest->force, hardest->source, more);
  }
  const std::size_t behind = hardest->parts.size() - 1;
  return fmt::format("presses {}{} together by {:.2f} mm: {:.3g} N ({}){}",
                     PathOf(hardest->parts.front()),
                     behind > 0 ? fmt::format(" and {} behind it", behind) : "",
                     units::ToMm(hardest->compression), hardest->force, hardest->source, more);
}

std::size_t PartRun::CountNeighboursInPlace(const sequence::SequenceStep& step) const {
  const sequence::Neighbours& neighbours = model().sequence.neighbours;
  const auto is_own = [&step](OccurrenceId id) {
    return id == step.occurrence ||
           std::find(step.members.begin(), step.members.end(), id) != step.members.end();
  };
  const auto count = [&](OccurrenceId id) {
    const std::vector<OccurrenceId>& others = neighbours[id.index()];
    return std::count_if(others.begin(), others.end(), [&](OccurrenceId other) {
      return !is_own(other) && physics().placement(other) == Placement::kPlaced;
    });
  };
  auto sum = count(step.occurrence);
  for (const OccurrenceId member : step.members) {
    sum += count(member);
  }
  return static_cast<std::size_t>(sum);
}

PartResult& PartRun::ResultOf(OccurrenceId id) {
  for (PartResult& result : results_) {
    if (result.occurrence == id) {
      return result;
    }
  }
  results_.emplace_back();
  results_.back().occurrence = id;
  return results_.back();
}

void PartRun::AddHold(OccurrenceId id) {
  const std::optional<SimulationEvent>& dropped = dropped_[id.index()];
  if (!dropped) {
    return;
  }
  PartResult& result = ResultOf(id);
  const HoldMetrics& metrics = dropped->metrics;
  result.hand = dropped->hand;
  result.time += 1e-9 * static_cast<double>(dropped->t_ns - metrics.t_taken_ns);
  result.path += metrics.path;
  result.peak_true = std::max(result.peak_true, metrics.peak_true);
  result.peak_felt = std::max(result.peak_felt, metrics.peak_felt);
  result.fit_true = std::max(result.fit_true, metrics.fit_true);
  result.fit_felt = std::max(result.fit_felt, metrics.fit_felt);
  result.preload = std::max(result.preload, metrics.preload);
  result.tightening = std::max(result.tightening, metrics.tightening);
  result.deepest = std::max(result.deepest, metrics.deepest);
  result.insertion = std::max(result.insertion, metrics.insertion);
  result.arrival = metrics.arrival;
  result.arrival_angle = metrics.arrival_angle;
}

void PartRun::Assume(OccurrenceId id) {
  physics().PlaceInFixture(id);
  is_assumed_[id.index()] = true;
}

void PartRun::Update(OccurrenceId id) {
  PartResult& result = ResultOf(id);
  const bool is_placed = physics().placement(id) == Placement::kPlaced;
  result.is_assumed = is_placed && is_assumed_[id.index()];
  result.is_seated = is_placed && !result.is_assumed;
  result.has_touched = result.is_seated && has_touched_[id.index()];
  const spatial::Pose& X_WB = physics().pose(id);
  const spatial::Pose& X_goal = model().bodies[id.index()].X_WB_goal;
  result.pose_error = (X_WB.p() - X_goal.p()).norm();
  result.pose_error_angle = spatial::RotationBetween(X_goal.q(), X_WB.q()).norm();
}

const std::string& PartRun::PathOf(OccurrenceId id) const {
  return model().product->occurrences[id.index()].path;
}

std::string PartRun::DescribeHardest(const HoldMetrics& metrics) const {
  if (!metrics.hardest.is_valid()) {
    return "nothing was met";
  }
  return fmt::format("{} stood in the way with up to {:.1f} N",
                     PathOf(OccurrenceId(metrics.hardest.index())), metrics.hardest_force);
}

spatial::Pose StartOfHand(const Model& model) {
  return spatial::Pose(model.centre_W + Vec3(0, 0, 1.1 * model.transfer_radius));
}

}  // namespace hvas::simulation
