#include "assembly/stepped_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "assembly/hand.h"
#include "base/check.h"

namespace hvas::assembly {
namespace {

using sequence::SequenceStep;
using simulation::Placement;

void Write(const spatial::Pose& X, double out[7]) noexcept {
  const Vec3& p = X.p();
  const Quat& q = X.q();
  const double numbers[7] = {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
  std::copy(std::begin(numbers), std::end(numbers), out);
}

void Write(const Vec3& v, double out[3]) noexcept {
  for (int i = 0; i < 3; ++i) {
    out[i] = v[i];
  }
}

void Write(const spatial::Wrench& F, double out[6]) noexcept {
  Write(F.f, out);
  Write(F.t, out + 3);
}

TickRow MakeRow(std::int64_t t_ns, const haptics::TickOutput& out) noexcept {
  TickRow row;
  row.t_s = 1e-9 * static_cast<double>(t_ns);
  Write(out.X_WH, row.X_WH);
  Write(out.X_WD, row.X_WB);
  Write(out.F_H_W, row.F_felt_W);
  Write(out.F_true_W, row.F_true_W);
  if (out.contact_count > 0) {
    Write(out.p_WC, row.p_WC);
    Write(out.f_C_W, row.f_C_W);
  }
  row.deepest = out.deepest;
  row.insertion = out.insertion_depth;
  row.axial_true = out.axial_true;
  row.preload = out.preload;
  row.tightening = out.tightening;
  row.offset = out.axis.offset;
  row.tilt = out.axis.tilt;
  row.contacts = out.contact_count;
  row.state = static_cast<std::int32_t>(out.state);
  return row;
}

ContactRow MakeRow(const haptics::PressingContact& contact) {
  ContactRow row;
  Write(contact.p_WC, row.p_WC);
  Write(contact.f_C_W, row.f_C_W);
  row.distance = contact.distance;
  row.other = contact.body.is_valid() ? static_cast<std::int32_t>(contact.body.value()) : -1;
  return row;
}

}  // namespace

class SteppedRun::RowKeeper final : public simulation::Sink {
 public:
  explicit RowKeeper(std::vector<TickRow>* rows) : rows_(*rows) {}

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override {
    (void)hand;
    rows_.push_back(MakeRow(device.t_ns, out));
  }

  void OnEvent(const simulation::SimulationEvent& event) override { (void)event; }

  void OnFlight(const std::vector<simulation::FlightTick>& ticks) override { (void)ticks; }

 private:
  std::vector<TickRow>& rows_;
};

Result<std::unique_ptr<SteppedRun>> SteppedRun::Create(
    std::shared_ptr<const simulation::Model> model, const SteppedOptions& options) {
  HVAS_DEMAND(model != nullptr);
  const auto& steps = model->sequence.steps;
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    return Fail(ErrorCode::kInvalid, what, model->product->source, remedy);
  };
  if (options.step >= steps.size() || steps[options.step].kind != SequenceStep::Kind::kInsert) {
    return refuse(fmt::format("step {} puts no part in", options.step),
                  fmt::format("choose one of the steps that insert a part, 1 to {}",
                              steps.empty() ? 0 : steps.size() - 1));
  }
  if (options.X_WB_start && !spatial::IsFinite(*options.X_WB_start)) {
    return refuse("the pose at which the part is taken is not finite", "give a finite pose");
  }
  if (!(options.rate_hz >= 1000 && options.rate_hz <= 8000)) {
    return refuse(fmt::format("a haptic rate of {} Hz", options.rate_hz),
                  "choose a rate from 1000 to 8000 Hz");
  }
  std::unique_ptr<SteppedRun> run(new SteppedRun(std::move(model), options));
  if (!run->TakeUp()) {
    return Fail(ErrorCode::kInvalid, "the part cannot be taken",
                run->model().product->occurrences[run->step().occurrence.index()].path,
                "give a pose at which nothing else is within the hand's reach");
  }
  return run;
}

SteppedRun::SteppedRun(std::shared_ptr<const simulation::Model> model,
                       const SteppedOptions& options)
    : model_(std::move(model)), options_(options) {
  const SequenceStep& step = this->step();
  const simulation::Body& body = model_->bodies[step.occurrence.index()];
  X_WB_goal_ = sequence::GoalOf(step, body.X_WB_goal);
  haptics::TickOptions tick = MakePersonTick({0, options.rate_hz});
  tick.condition = options.condition;
  tick.guidance.contact_in_holes = options.contact_in_holes;
  tick.guidance.threads_turn = options.threads_turn;
  simulation_ = std::make_unique<simulation::Simulation>(model_, tick);
  const std::vector<simulation::PartState> parts = ListBeginning();
  simulation_->Restore(parts);
  simulation_->physics().Prepare(step);
  const spatial::Pose& X_WB = parts[step.occurrence.index()].X_WB;
  const spatial::Pose X_WH(X_WB * simulation::CombineMass(*model_, step).p_BoBcm_B);
  X_HB_ = X_WH.Inverse() * X_WB;
  hand_ = std::make_unique<person::ArmHand>(options.arm, X_WH);
  keeper_ = std::make_shared<RowKeeper>(&rows_);
  simulation::Execution execution;
  execution.simulation = simulation_.get();
  execution.hands = {hand_.get()};
  execution.sink = keeper_.get();
  execution.limit_ns = std::numeric_limits<std::int64_t>::max();
  lockstep_ = std::make_unique<simulation::Lockstep>(execution);
}

std::vector<simulation::PartState> SteppedRun::ListBeginning() const {
  std::vector<simulation::PartState> parts;
  for (const simulation::Body& body : model_->bodies) {
    parts.push_back({simulation::BeginningOf(body.role), body.X_WB_start});
  }
  const auto move = [&](const SequenceStep& step, product::OccurrenceId id) {
    const bool is_away =
        step.kind == SequenceStep::Kind::kPark || step.kind == SequenceStep::Kind::kAside;
    parts[id.index()] = {is_away ? Placement::kParked : Placement::kPlaced,
                         sequence::GoalOf(step, model_->bodies[id.index()].X_WB_goal)};
  };
  for (std::size_t i = 0; i < options_.step; ++i) {
    const SequenceStep& step = model_->sequence.steps[i];
    move(step, step.occurrence);
    for (const product::OccurrenceId member : step.members) {
      move(step, member);
    }
  }
  if (options_.X_WB_start) {
    parts[step().occurrence.index()].X_WB = *options_.X_WB_start;
    const simulation::Body& leader = model_->bodies[step().occurrence.index()];
    for (const product::OccurrenceId member : step().members) {
      parts[member.index()].X_WB = *options_.X_WB_start * leader.X_WB_goal.Inverse() *
                                   model_->bodies[member.index()].X_WB_goal;
    }
  }
  return parts;
}

// The hand closes around the part's centre of mass, and is there until the tick has the part.
bool SteppedRun::TakeUp() {
  constexpr std::size_t kMostTicks = 100;  // Ten steps of physics; two are needed. A choice.
  simulation::HandReference reference;
  reference.X_WR = hand_->X_WH();
  reference.is_gripping = true;
  for (std::size_t i = 0; i < kMostTicks; ++i) {
    if (Step(reference, 1).back().state != static_cast<std::int32_t>(haptics::HoldState::kEmpty)) {
      return true;
    }
  }
  return false;
}

std::span<const TickRow> SteppedRun::Step(const simulation::HandReference& reference,
                                          std::size_t ticks) {
  HVAS_DEMAND(ticks > 0);
  rows_.clear();
  rows_.reserve(ticks);
  hand_->Lead(reference);
  for (std::size_t i = 0; i < ticks; ++i) {
    lockstep_->Tick();
  }
  contacts_.clear();
  for (const haptics::PressingContact& contact : simulation_->haptics().pressing(0)) {
    contacts_.push_back(MakeRow(contact));
  }
  return rows_;
}

std::vector<simulation::PartState> SteppedRun::ListParts() const {
  std::vector<simulation::PartState> parts = simulation_->physics().parts();
  const auto* held = simulation_->physics().held(0);
  if (held != nullptr) {
    const double* X = last().X_WB;
    parts[step().occurrence.index()].X_WB = {Quat(X[3], X[4], X[5], X[6]), Vec3(X[0], X[1], X[2])};
  }
  return parts;
}

}  // namespace hvas::assembly
