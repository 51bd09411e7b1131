#include "orders/gap_reason.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "sequence/gap_proof.h"
#include "sequence/giving_width.h"

namespace hvas::orders {
namespace {

using product::MateKind;
using product::OccurrenceId;

bool Contains(const sequence::Unit& unit, OccurrenceId id) {
  return std::find(unit.begin(), unit.end(), id) != unit.end();
}

/** A straight way out, and what is met on it. */
struct StraightWay {
  Vec3 direction_W{Vec3::UnitZ()};
  std::vector<product::MateId> mates;  // They forbid it.
  std::vector<sequence::MetFaces> stops;
  sequence::Unit others;  // Parts met, in the order in which they are met.
  double travelled{0};    // Before the first of them [m].
  double need{0};         // The largest depth or width of what is met [m].
  bool is_hard{false};    // A mate forbids it that clearance does not open.
};

/** A way out that was found. */
struct WayOut {
  sequence::SequenceStep step;
  bool does_give{false};  // Parts give on it, or bend.
};

class GapExplainer {
 public:
  GapExplainer(const simulation::Model& model, OccurrenceId id, const GapReasonOptions& options)
      : model_(model),
        product_(*model.product),
        options_(options),
        input_(simulation::MakeSequenceInput(model, &scene_)),
        give_limits_(input_.give_limits) {
    reason_.occurrence = id;
    input_.way_looks = options.way_looks;
    input_.stop = options.stop;
    Restart();
  }

  GapReason Explain();

 private:
  /** Begins anew with the parts of reason_.present, what is explained, and the fixtures. */
  void Restart();
  /** Lists the parts that are there as far as the order goes. */
  [[nodiscard]] sequence::Unit ListAllButGaps() const;
  /** Chooses the parts that are there, and begins with them. Returns whether they are given, by the
   caller or by the order. */
  bool ChoosePresent();
  /** The parts that are there when the step of the part comes; none where it has no step. */
  [[nodiscard]] std::optional<sequence::Unit> FindEarlier() const;
  /** Leaves those that do not come out while the part is there. */
  void KeepWhatStays();
  /** Takes the parts of a step out, along its own way, or a single part along any straight one. */
  [[nodiscard]] bool TakeOut(const sequence::SequenceStep& step);

  /** How a way may be, besides straight. */
  struct Freedom {
    bool may_turn{false};
    bool may_bend{false};  // Walls may that no name tells of.
  };

  /** Looks for a way out of a part, as the planner of the order does; it stays where it is. */
  [[nodiscard]] std::optional<WayOut> FindWayOut(OccurrenceId id, const Freedom& freedom);
  void MeasureWays();
  [[nodiscard]] StraightWay MeasureWay(const Vec3& direction_W);
  void Prove();
  [[nodiscard]] sequence::Unit ListCandidates() const;
  void TryOthers();
  /** Tries what comes of it when others are put in later, or not at all. */
  void TryWithout(const sequence::Unit& others);
  /** Whether all of these come out while the part is there, in any order; notes how. */
  [[nodiscard]] bool DoComeOut(sequence::Unit others, GapChange* change);
  /** How thick the part is where it is thickest, or the thinnest of others where that is more [m].
   */
  [[nodiscard]] double FindThickness(const sequence::Unit& others) const;
  /** Tries clearance from what is met on the best way, and where that is not enough, on all. */
  void TryClearances();
  void TryClearance(const sequence::Unit& others);
  /** Tries what comes of it when the part, or one that it meets on the best way, yields. */
  void TryFlexibles();
  void TryFlexible(OccurrenceId gives);
  void RankChanges();
  /** The least amount that lets the part out, to the resolution, and the way; none: not even the
   largest does. */
  template <typename Try>
  [[nodiscard]] bool Bisect(double largest, const Try& try_amount, GapChange* change);
  [[nodiscard]] bool IsOver();

  void ReportProgress(double fraction) const {
    if (options_.progress) {
      options_.progress(fraction);
    }
  }

  const simulation::Model& model_;
  const product::Product& product_;
  const GapReasonOptions& options_;
  contact::Scene scene_;
  sequence::SequenceInput input_;
  const std::vector<double> give_limits_;
  std::optional<sequence::Extraction> extraction_;
  std::uint64_t looks_before_{0};  // Of extractions that are gone.
  std::vector<StraightWay> ways_;  // The best first.
  OccurrenceId base_;              // Of the parts that are there.
  GapReason reason_;
};

void GapExplainer::Restart() {
  looks_before_ += extraction_ ? extraction_->looks() : 0;
  input_.give_limits = give_limits_;
  extraction_.emplace(input_, &model_.sequence);
  sequence::Unit all;
  for (const product::Occurrence& occurrence : product_.occurrences) {
    all.push_back(occurrence.id);
  }
  extraction_->SetPresent(all, false);
  extraction_->SetPresent(input_.fixtures, true);
  extraction_->SetPresent(reason_.present, true);
  extraction_->SetPresent({reason_.occurrence}, true);
}

bool GapExplainer::IsOver() {
  reason_.looks = looks_before_ + extraction_->looks();
  reason_.is_limit_reached =
      reason_.is_limit_reached || reason_.looks >= options_.looks ||
      (options_.deadline && std::chrono::steady_clock::now() > *options_.deadline);
  reason_.is_stopped = reason_.is_stopped || options_.stop.stop_requested();
  return reason_.is_limit_reached || reason_.is_stopped;
}

std::optional<sequence::Unit> GapExplainer::FindEarlier() const {
  sequence::Unit present;
  for (const sequence::SequenceStep& step : model_.sequence.steps) {
    const sequence::Unit unit = sequence::UnitOf(step);
    switch (step.kind) {
      case sequence::SequenceStep::Kind::kBase:
        present = {step.occurrence};
        break;
      case sequence::SequenceStep::Kind::kInsert:
      case sequence::SequenceStep::Kind::kAssume:
        if (step.occurrence == reason_.occurrence) {
          return present;
        }
        present.insert(present.end(), unit.begin(), unit.end());
        break;
      case sequence::SequenceStep::Kind::kPark:
        present.clear();
        break;
      case sequence::SequenceStep::Kind::kRemove:
        std::erase_if(present, [&unit](OccurrenceId part) { return Contains(unit, part); });
        break;
      case sequence::SequenceStep::Kind::kAside:
      case sequence::SequenceStep::Kind::kReturn:
        break;  // The part stays in the product.
    }
  }
  return std::nullopt;
}

bool GapExplainer::TakeOut(const sequence::SequenceStep& step) {
  const sequence::Unit unit = sequence::UnitOf(step);
  if (!step.way.empty()) {
    if (!extraction_->IsWayFree(step.occurrence, step.way)) {
      return false;
    }
    extraction_->SetPresent(unit, false);
    return true;
  }
  if (extraction_->TryRemoveAlong(unit, step.extraction_W)) {
    return true;
  }
  const bool may_give =
      std::any_of(model_.sequence.gives.begin(), model_.sequence.gives.end(),
                  [&](const sequence::GivingPair& give) {
                    return give.flexible == step.occurrence || give.other == step.occurrence;
                  });
  if (may_give && unit.size() == 1 && FindWayOut(step.occurrence, {false, true})) {
    extraction_->SetPresent(unit, false);
    return true;
  }
  sequence::Unit rest{step.occurrence, step.occurrence};  // The last one is never tried.
  return unit.size() == 1 && extraction_->TryRemoveOne(&rest).has_value();
}

void GapExplainer::KeepWhatStays() {
  const std::vector<sequence::SequenceStep>& steps = model_.sequence.steps;
  const auto is_there = [this](OccurrenceId id) { return extraction_->is_present(id); };
  for (bool is_moving = true; is_moving && !IsOver();) {
    is_moving = false;
    for (auto step = steps.rbegin(); step != steps.rend() && !IsOver(); ++step) {
      const sequence::Unit unit = sequence::UnitOf(*step);
      const bool is_all_there = std::all_of(unit.begin(), unit.end(), is_there);
      if (step->kind == sequence::SequenceStep::Kind::kInsert && is_all_there && TakeOut(*step)) {
        is_moving = true;
      }
    }
  }
  std::erase_if(reason_.present, [&is_there](OccurrenceId id) { return !is_there(id); });
}

std::optional<WayOut> GapExplainer::FindWayOut(OccurrenceId id, const Freedom& freedom) {
  sequence::Unit rest{id, id};  // The last one is never tried.
  extraction_->Forget({id});
  std::optional<sequence::SequenceStep> step = extraction_->TryRemoveOne(&rest);
  bool does_give = false;
  if (!step && !input_.give_limits.empty()) {
    step = extraction_->TryRemoveWithLimits(id);
    does_give = step.has_value();
  }
  if (!step && freedom.may_turn) {
    step = extraction_->TryRemoveTurning(&rest, {}, sequence::TurningEffort::kBrief);
    step = step ? step : extraction_->TryRemoveTurning(&rest, {}, sequence::TurningEffort::kLong);
  }
  bool does_bend = false;
  if (!step && freedom.may_bend) {
    step = extraction_->TryRemoveBending(&rest, {});
    does_bend = step.has_value();
  }
  extraction_->SetPresent({id}, true);
  if (does_bend) {  // What was found to give is not to count for the next look.
    std::vector<bool> is_present;
    for (const product::Occurrence& occurrence : product_.occurrences) {
      is_present.push_back(extraction_->is_present(occurrence.id));
    }
    Restart();
    for (const product::Occurrence& occurrence : product_.occurrences) {
      extraction_->SetPresent({occurrence.id}, is_present[occurrence.id.index()]);
    }
  }
  return step ? std::optional(WayOut{std::move(*step), does_give || does_bend}) : std::nullopt;
}

StraightWay GapExplainer::MeasureWay(const Vec3& direction_W) {
  StraightWay way;
  const OccurrenceId id = reason_.occurrence;
  way.direction_W = direction_W;
  way.mates = extraction_->ListForbidding(id, direction_W);
  way.is_hard = std::any_of(way.mates.begin(), way.mates.end(), [this](product::MateId mate) {
    const MateKind kind = product_.mates[mate.index()].kind;
    return kind != MateKind::kFaceFace && kind != MateKind::kPrismatic;
  });
  if (way.is_hard) {
    return way;
  }
  way.stops = extraction_->MeasureFaces(id, direction_W);
  way.travelled = extraction_->CalcWayLength({id}, direction_W);
  for (const sequence::MetFaces& stop : way.stops) {
    way.travelled = std::min(way.travelled, stop.travelled);
    way.need = std::max(way.need, stop.depth);
    if (stop.other.is_valid() && !Contains(way.others, stop.other)) {
      way.others.push_back(stop.other);
      way.need = std::max(way.need, sequence::CalcGivingWidth(product_, id, stop.other, direction_W,
                                                              options_.largest_clearance));
    }
  }
  way.travelled = way.mates.empty() ? way.travelled : 0;
  return way;
}

void GapExplainer::MeasureWays() {
  const OccurrenceId id = reason_.occurrence;
  std::vector<Vec3> directions = extraction_->ListDirections({id});
  for (const Vec3& direction : extraction_->ListContactDirections(id)) {
    const bool is_known =
        std::any_of(directions.begin(), directions.end(),
                    [&direction](const Vec3& known) { return known.dot(direction) > 1 - 1e-6; });
    if (!is_known) {
      directions.push_back(direction);
    }
  }
  for (const Vec3& direction : directions) {
    if (IsOver()) {
      break;
    }
    ways_.push_back(MeasureWay(direction));
  }
  constexpr double kSame = 20e-6;  // [m]: needs that differ by less are one, as widths are coarse.
  std::stable_sort(ways_.begin(), ways_.end(), [](const StraightWay& a, const StraightWay& b) {
    const auto rank = [](const StraightWay& way) {
      return std::tuple(way.is_hard, !way.mates.empty(), std::floor(way.need / kSame),
                        -way.travelled);
    };
    return rank(a) < rank(b);
  });
  if (!ways_.empty()) {
    const StraightWay& best = ways_.front();
    reason_.direction_W = best.direction_W;
    reason_.travelled = best.travelled;
    reason_.way_length = extraction_->CalcWayLength({id}, best.direction_W);
    reason_.stops = best.stops;
    reason_.mates = best.mates;
  }
}

void GapExplainer::Prove() {
  const OccurrenceId id = reason_.occurrence;
  double allowed = 0;
  for (const sequence::DrawnOverlap& overlap : model_.sequence.overlaps) {
    const bool is_own = overlap.a == id || overlap.b == id;
    allowed = is_own ? std::max({allowed, overlap.depth, overlap.allowed}) : allowed;
  }
  sequence::Unit others = reason_.present;
  others.insert(others.end(), input_.fixtures.begin(), input_.fixtures.end());
  const sequence::Cage cage = sequence::FindCage(product_, id, others, allowed);
  if (cage.is_closed) {
    reason_.proof = GapProof::kCaged;
    reason_.caged_radius = cage.radius;
    return;
  }
  std::vector<contact::IgnoredPair> threads;
  for (const simulation::ModelMate& mate : model_.mates) {
    const product::Mate& drawn = product_.mates[mate.id.index()];
    const bool is_thread = drawn.fit && drawn.fit->kind == product::FitKind::kThread;
    const bool is_a = drawn.a.occurrence == id;
    if (!is_thread || (!is_a && drawn.b.occurrence != id)) {
      continue;
    }
    const contact::BodyId body((is_a ? drawn.b : drawn.a).occurrence.index());
    const haptics::MateFaces& own = is_a ? *mate.faces_a : *mate.faces_b;
    const haptics::MateFaces& its = is_a ? *mate.faces_b : *mate.faces_a;
    threads.push_back({body, own.with_neighbours, its.with_neighbours});
  }
  // A proof that a look along a straight way contradicts is none: faces that end where they touch.
  constexpr double kMoved = 1e-4;  // [m]: less than a step of a way.
  const bool does_move = std::any_of(ways_.begin(), ways_.end(), [](const StraightWay& way) {
    const bool is_open = way.mates.empty() && way.travelled > kMoved;
    const auto is_deep = [](const sequence::MetFaces& stop) {
      return stop.travelled <= 2e-3 + kMoved;
    };
    return is_open && std::none_of(way.stops.begin(), way.stops.end(), is_deep);
  });
  if (!does_move && sequence::IsHeldByContacts(product_, scene_, id, threads)) {
    reason_.proof = GapProof::kHeld;
  }
}

sequence::Unit GapExplainer::ListCandidates() const {
  sequence::Unit candidates;
  std::map<OccurrenceId, std::size_t> counts;
  const auto add = [&](OccurrenceId id) {
    if (Contains(reason_.present, id) && !Contains(candidates, id)) {
      candidates.push_back(id);
    }
  };
  if (!ways_.empty()) {
    for (const OccurrenceId id : ways_.front().others) {
      add(id);
    }
  }
  for (const StraightWay& way : ways_) {
    for (const OccurrenceId id : way.others) {
      ++counts[id];
    }
    for (const product::MateId mate : way.mates) {
      const product::Mate& forbids = product_.mates[mate.index()];
      const bool is_a = forbids.a.occurrence == reason_.occurrence;
      ++counts[is_a ? forbids.b.occurrence : forbids.a.occurrence];
    }
  }
  std::vector<std::pair<std::size_t, OccurrenceId>> ranked;
  ranked.reserve(counts.size());
  for (const auto& [id, count] : counts) {
    ranked.emplace_back(count, id);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [count, id] : ranked) {
    add(id);
  }
  if (candidates.size() > options_.most_others) {
    candidates.resize(options_.most_others);
  }
  return candidates;
}

bool GapExplainer::DoComeOut(sequence::Unit others, GapChange* change) {
  for (bool is_moving = true; is_moving && !others.empty() && !IsOver();) {
    is_moving = false;
    for (std::size_t i = 0; i < others.size() && !is_moving; ++i) {
      if (const std::optional<WayOut> way = FindWayOut(others[i], {true, false})) {
        change->do_others_turn = change->do_others_turn || !way->step.way.empty();
        change->do_others_give = change->do_others_give || way->does_give;
        extraction_->SetPresent({others[i]}, false);
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        is_moving = true;
      }
    }
  }
  return others.empty();
}

void GapExplainer::TryWithout(const sequence::Unit& others) {
  GapChange leave_out;
  leave_out.kind = GapChangeKind::kLeaveOut;
  leave_out.parts = others;
  Restart();
  extraction_->SetPresent(others, false);
  const std::optional<WayOut> way = FindWayOut(reason_.occurrence, {true, true});
  GapChange order = leave_out;
  order.kind = GapChangeKind::kOrder;
  if (way) {
    for (GapChange* change : {&leave_out, &order}) {
      change->direction_W = way->step.extraction_W;
      change->does_turn = !way->step.way.empty();
      change->does_give = way->does_give;
    }
    leave_out.has_worked = true;
    order.does_go_without = true;
    extraction_->SetPresent(others, true);
    order.has_worked = !Contains(others, base_) && DoComeOut(others, &order);
  }
  // The part that stands in the fixture cannot come later than what is put into it.
  if (!Contains(others, base_)) {
    reason_.changes.push_back(std::move(order));
  }
  reason_.changes.push_back(std::move(leave_out));
}

void GapExplainer::TryOthers() {
  const sequence::Unit candidates = ListCandidates();
  bool has_worked = false;
  for (std::size_t i = 0; i < candidates.size() && !IsOver(); ++i) {
    TryWithout({candidates[i]});
    has_worked = has_worked || reason_.changes.back().has_worked;
    ReportProgress(0.4 + 0.3 * static_cast<double>(i + 1) / static_cast<double>(candidates.size()));
  }
  if (has_worked || IsOver()) {
    return;
  }
  // None alone: all of those that stand in one straight way, the fewest.
  const StraightWay* fewest = nullptr;
  for (const StraightWay& way : ways_) {
    const bool is_open = way.mates.empty() && way.others.size() > 1 &&
                         std::all_of(way.others.begin(), way.others.end(), [this](OccurrenceId id) {
                           return Contains(reason_.present, id);
                         });
    if (is_open && (fewest == nullptr || way.others.size() < fewest->others.size())) {
      fewest = &way;
    }
  }
  if (fewest != nullptr) {
    TryWithout(sequence::Unit(fewest->others));
  }
}

template <typename Try>
bool GapExplainer::Bisect(double largest, const Try& try_amount, GapChange* change) {
  const auto does_work = [&](double amount) {
    const std::optional<sequence::SequenceStep> step = try_amount(amount);
    extraction_->SetPresent({reason_.occurrence}, true);
    if (step) {
      change->direction_W = step->extraction_W;
    }
    return step.has_value();
  };
  change->amount = largest;
  if (!does_work(largest)) {
    return false;
  }
  double too_little = 0;
  double enough = largest;
  while (enough - too_little > options_.resolution && !IsOver()) {
    const double middle = 0.5 * (too_little + enough);
    (does_work(middle) ? enough : too_little) = middle;
  }
  change->amount = enough;
  return true;
}

double GapExplainer::FindThickness(const sequence::Unit& others) const {
  double radius = std::numeric_limits<double>::infinity();
  for (const OccurrenceId other : others) {
    radius = std::min(radius, sequence::FindInnerRadius(product_.part_of(other)));
  }
  return 2 * std::max(radius, sequence::FindInnerRadius(product_.part_of(reason_.occurrence)));
}

void GapExplainer::TryClearance(const sequence::Unit& others) {
  // Half of the part, or of what stops it, is left where it is thickest: a choice.
  constexpr double kMostOfThickness = 0.25;
  GapChange change;
  change.kind = GapChangeKind::kClearance;
  change.parts = others;
  Restart();
  change.has_worked = Bisect(
      std::min(options_.largest_clearance, kMostOfThickness * FindThickness(others)),
      [&](double amount) {
        return extraction_->TryRemoveCleared(reason_.occurrence, others, amount);
      },
      &change);
  reason_.changes.push_back(std::move(change));
}

void GapExplainer::TryFlexible(OccurrenceId gives) {
  GapChange change;
  change.kind = GapChangeKind::kFlexible;
  change.parts = {gives};
  Restart();
  if (input_.give_limits.empty()) {
    input_.give_limits.assign(product_.occurrences.size(), 0);
  }
  change.has_worked = Bisect(
      options_.largest_give,
      [&](double amount) {
        const std::vector<double>& known = give_limits_;
        input_.give_limits[gives.index()] =
            std::max(amount, known.empty() ? 0.0 : known[gives.index()]);
        return extraction_->TryRemoveWithLimits(reason_.occurrence);
      },
      &change);
  reason_.changes.push_back(std::move(change));
}

sequence::Unit GapExplainer::ListAllButGaps() const {
  sequence::Unit gone = input_.absent;
  for (const sequence::SequenceGap& gap : model_.sequence.gaps) {
    if (gap.occurrence == reason_.occurrence) {
      break;
    }
    gone.push_back(gap.occurrence);
  }
  sequence::Unit present;
  for (const product::Occurrence& occurrence : product_.occurrences) {
    if (!Contains(gone, occurrence.id) && !Contains(input_.fixtures, occurrence.id)) {
      present.push_back(occurrence.id);
    }
  }
  return present;
}

bool GapExplainer::ChoosePresent() {
  const std::optional<sequence::Unit> given = options_.present ? options_.present : FindEarlier();
  reason_.present = given ? *given : ListAllButGaps();
  std::erase(reason_.present, reason_.occurrence);
  base_ = sequence::FindBase(model_.sequence);
  if (!Contains(reason_.present, base_)) {  // A subassembly: its base comes first.
    base_ = reason_.present.empty() ? OccurrenceId() : reason_.present.front();
  }
  Restart();
  if (!given) {
    KeepWhatStays();
    Restart();
  }
  return given.has_value();
}

void GapExplainer::TryClearances() {
  if (ways_.empty() || ways_.front().others.empty() || IsOver()) {
    return;
  }
  const sequence::Unit& stopping = ways_.front().others;
  TryClearance(stopping);
  sequence::Unit all = stopping;
  for (const StraightWay& way : ways_) {
    for (const OccurrenceId other : way.others) {
      if (!Contains(all, other)) {
        all.push_back(other);
      }
    }
  }
  if (!reason_.changes.back().has_worked && all.size() > stopping.size() && !IsOver()) {
    TryClearance(all);
  }
}

void GapExplainer::TryFlexibles() {
  sequence::Unit giving{reason_.occurrence};
  for (const OccurrenceId other : ways_.empty() ? sequence::Unit() : ways_.front().others) {
    if (giving.size() <= options_.most_others) {
      giving.push_back(other);
    }
  }
  for (std::size_t i = 0; i < giving.size() && !IsOver(); ++i) {
    TryFlexible(giving[i]);
  }
}

void GapExplainer::RankChanges() {
  std::stable_sort(
      reason_.changes.begin(), reason_.changes.end(), [](const GapChange& a, const GapChange& b) {
        const auto rank = [](const GapChange& change) {
          return std::tuple(!change.has_worked, change.kind, change.parts.size(), change.amount);
        };
        return rank(a) < rank(b);
      });
}

GapReason GapExplainer::Explain() {
  const bool is_order_given = ChoosePresent();
  ReportProgress(0.1);
  if (!IsOver()) {
    const std::optional<WayOut> way = FindWayOut(reason_.occurrence, {is_order_given, true});
    reason_.has_way = way.has_value();
    reason_.direction_W = way ? way->step.extraction_W : Vec3::Zero();
  }
  if (reason_.has_way || IsOver()) {
    return std::move(reason_);
  }
  MeasureWays();
  ReportProgress(0.3);
  Prove();
  ReportProgress(0.4);
  TryOthers();
  TryClearances();
  ReportProgress(0.8);
  TryFlexibles();
  RankChanges();
  (void)IsOver();
  ReportProgress(1);
  return std::move(reason_);
}

/** The error of the drawing for which a part was left out: one with a part that was not; null where
 there is none. */
const product::DrawingError* FindOwnError(const simulation::Model& model, OccurrenceId id) {
  const auto is_gap = [&model](OccurrenceId part) {
    return std::any_of(model.sequence.gaps.begin(), model.sequence.gaps.end(),
                       [part](const sequence::SequenceGap& gap) { return gap.occurrence == part; });
  };
  const std::vector<product::DrawingError>& errors = model.product->drawing_errors;
  const auto found =
      std::find_if(errors.begin(), errors.end(), [&](const product::DrawingError& error) {
        return (error.a == id && !is_gap(error.b)) || (error.b == id && !is_gap(error.a));
      });
  return found == errors.end() || !is_gap(id) ? nullptr : &*found;
}

}  // namespace

Result<GapReason> ExplainGap(const simulation::Model& model, OccurrenceId id,
                             const GapReasonOptions& options) {
  if (!id.is_valid() || id.index() >= model.bodies.size()) {
    return Fail(ErrorCode::kNotFound, "the model has no such part", model.product->source);
  }
  if (model.bodies[id.index()].role != simulation::BodyRole::kPart) {
    return Fail(ErrorCode::kNotFound, "tools and fixtures are not put in by the assembly",
                model.product->occurrences[id.index()].path);
  }
  if (const product::DrawingError* error = FindOwnError(model, id)) {
    GapReason reason;
    reason.occurrence = id;
    reason.present = {error->a == id ? error->b : error->a};
    reason.proof = GapProof::kDrawn;
    return reason;
  }
  return GapExplainer(model, id, options).Explain();
}

}  // namespace hvas::orders
