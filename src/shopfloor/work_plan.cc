#include "shopfloor/work_plan.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "orders/order_search.h"

namespace hvas::shopfloor {
namespace {

using assembly::OrderPlan;
using orders::FreeMove;
using product::Mate;
using product::OccurrenceId;
using sequence::SequenceStep;
using simulation::Model;

bool IsIn(const std::vector<OccurrenceId>& parts, OccurrenceId id) {
  return std::find(parts.begin(), parts.end(), id) != parts.end();
}

void Append(const std::vector<OccurrenceId>& parts, std::vector<OccurrenceId>* list) {
  list->insert(list->end(), parts.begin(), parts.end());
}

/** Adds what the mates of a part with those that are there ask of the step. */
void AddMates(const Model& model, OccurrenceId part, WorkStep* step) {
  for (const product::MateId id : model.mates_of[part.index()]) {
    const Mate& mate = model.product->mates[id.index()];
    const OccurrenceId other = mate.a.occurrence == part ? mate.b.occurrence : mate.a.occurrence;
    if (!mate.fit || !IsIn(step->there, other)) {
      continue;
    }
    const simulation::ModelMate& prepared = model.mates[id.index()];
    if (product::IsIsoFit(mate.fit->kind)) {
      const double force = prepared.fit == nullptr ? 0 : prepared.fit->max_resistance();
      step->fits.push_back(
          {other, fmt::format("{:.4g} {}", units::ToMm(mate.fit->nominal_diameter), mate.fit->code),
           mate.fit->kind, mate.fit->is_proposed, force});
    } else if (prepared.thread != nullptr) {
      const mates::ThreadJoint& joint = *prepared.thread;
      step->threads.push_back({fmt::format("M{:.4g}", units::ToMm(joint.diameter)), joint.turns,
                               joint.tightening.torque, joint.tightening.preload});
    }
  }
}

/** Makes the steps, one move after the other. */
class WorkPlanMaker {
 public:
  WorkPlanMaker(const Model& model, const OrderPlan& plan)
      : model_(model),
        plan_(plan),
        best_(assembly::BestOrder(plan)),
        arrows_(ListArrows(plan.rules)) {}

  [[nodiscard]] WorkPlan Make() {
    for (const SequenceStep& step : plan_.rules.first) {
      AddFirst(step);
    }
    const std::vector<orders::HandWork> work = orders::ListHandWork(plan_.rules, best_);
    const std::vector<Vec3> ups = orders::ListUpSides(plan_.rules, best_);
    for (std::size_t i = 0; i < best_.moves.size(); ++i) {
      AddMove(i, work[i], ups);
    }
    for (const WorkStep& step : result_.steps) {
      result_.mods += step.mods;
    }
    for (const sequence::SequenceGap& gap : model_.sequence.gaps) {
      result_.left_out.push_back(gap.occurrence);
    }
    AddBill();
    return std::move(result_);
  }

 private:
  void AddFirst(const SequenceStep& from) {
    WorkStep step;
    step.leading = {from.occurrence};
    step.coming = step.leading;
    Append(from.members, &step.coming);
    step.out_W = from.extraction_W;
    step.engaged = from.engage_distance;
    step.way = from.way;
    switch (from.kind) {
      case SequenceStep::Kind::kBase:
        step.kind = WorkStep::Kind::kBase;
        there_.clear();
        break;
      case SequenceStep::Kind::kPark:
        step.kind = WorkStep::Kind::kLayAside;
        result_.steps.push_back(std::move(step));
        there_.clear();
        return;
      default:
        step.kind = WorkStep::Kind::kInsert;
    }
    step.there = there_;
    for (const OccurrenceId part : step.coming) {
      AddMates(model_, part, &step);
    }
    AddOrJoin(std::move(step));
  }

  void AddMove(std::size_t place, const orders::HandWork& work, const std::vector<Vec3>& ups) {
    const std::size_t number = best_.moves[place];
    const FreeMove& move = plan_.rules.moves[number];
    const SequenceStep& from = move.ways[best_.ways[place]].step;
    WorkStep step;
    step.leading = {from.occurrence};
    step.coming = move.parts;
    step.there = there_;
    step.out_W = from.extraction_W;
    step.engaged = from.engage_distance;
    step.way = from.way;
    step.up_W = ups[place];
    step.is_turned = place > 0 && ups[place] != ups[place - 1];
    if (move.aside) {
      step.moved_aside = move.aside->occurrence;
    }
    step.tool = move.tool;
    step.press = work.press;
    step.force = work.force;
    step.motions = work.motions;
    step.mods = work.mods;
    if (!plan_.statics.empty() && plan_.statics.front().holds[place]) {
      step.holds = *plan_.statics.front().holds[place];
    }
    std::copy_if(arrows_.begin(), arrows_.end(), std::back_inserter(step.before),
                 [number](const OrderArrow& arrow) {
                   return arrow.first == number && arrow.is_certain && !arrow.is_implied;
                 });
    for (const OccurrenceId part : step.coming) {
      AddMates(model_, part, &step);
    }
    AddOrJoin(std::move(step));
  }

  /** Whether a step is the one before it with an equal part. */
  [[nodiscard]] bool IsRepeated(const WorkStep& step) const {
    if (result_.steps.empty()) {
      return false;
    }
    const WorkStep& last = result_.steps.back();
    const auto part_of = [this](const WorkStep& of) {
      return model_.product->occurrences[of.leading.front().index()].part;
    };
    constexpr double kSameWay = 0.999;  // Cosine of 2.6 degrees: a choice.
    return step.kind == WorkStep::Kind::kInsert && last.kind == WorkStep::Kind::kInsert &&
           step.coming.size() == 1 && last.coming.size() == last.leading.size() &&
           part_of(step) == part_of(last) && step.tool == last.tool && !step.is_turned &&
           !step.moved_aside.is_valid() && !last.moved_aside.is_valid() && step.way.empty() &&
           last.way.empty() && step.out_W.dot(last.out_W) > kSameWay;
  }

  void AddOrJoin(WorkStep step) {
    Append(step.coming, &there_);
    if (!IsRepeated(step)) {
      result_.steps.push_back(std::move(step));
      return;
    }
    WorkStep& last = result_.steps.back();
    Append(step.leading, &last.leading);
    Append(step.coming, &last.coming);
    last.holds = step.holds;
    last.press = std::max(last.press, step.press);
    last.force = std::max(last.force, step.force);
    last.motions.insert(last.motions.end(), step.motions.begin(), step.motions.end());
    last.mods += step.mods;
    // What all of them have to come before is told once.
    for (const OrderArrow& arrow : step.before) {
      const bool is_told =
          std::any_of(last.before.begin(), last.before.end(),
                      [&arrow](const OrderArrow& told) { return told.then == arrow.then; });
      if (!is_told) {
        last.before.push_back(arrow);
      }
    }
  }

  void AddBill() {
    std::map<product::PartId, std::size_t> line_of;
    const auto add = [&](OccurrenceId id) {
      if (model_.bodies[id.index()].role != simulation::BodyRole::kPart) {
        return;
      }
      const product::Occurrence& occurrence = model_.product->occurrences[id.index()];
      const product::Part& part = model_.product->part_of(id);
      const auto [line, is_new] = line_of.try_emplace(occurrence.part, result_.bill.size());
      if (is_new) {
        result_.bill.push_back({id, part.name.empty() ? occurrence.name : part.name, 0,
                                model_.bodies[id.index()].mass.mass, part.material.name});
      }
      ++result_.bill[line->second].count;
    };
    for (const WorkStep& step : result_.steps) {
      for (const OccurrenceId id : step.coming) {
        if (!IsIn(billed_, id)) {
          billed_.push_back(id);
          add(id);
        }
      }
    }
    for (const OccurrenceId id : result_.left_out) {
      add(id);
    }
  }

  const Model& model_;
  const OrderPlan& plan_;
  const orders::FoundOrder& best_;
  std::vector<OrderArrow> arrows_;
  std::vector<OccurrenceId> there_;   // What is there of the product, or of the subassembly.
  std::vector<OccurrenceId> billed_;  // Those of a subassembly come twice.
  WorkPlan result_;
};

}  // namespace

WorkPlan MakeWorkPlan(const Model& model, const OrderPlan& plan) {
  return WorkPlanMaker(model, plan).Make();
}

}  // namespace hvas::shopfloor
