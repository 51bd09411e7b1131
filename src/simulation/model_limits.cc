#include "simulation/model_limits.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

#include "haptics/mate_guide.h"
#include "mates/mate_kind.h"
#include "simulation/held_part_maker.h"

namespace hvas::simulation {
namespace {

using product::OccurrenceId;

/** Counts of the mates that a step's parts have with parts outside of the step. */
struct MateCount {
  std::size_t all{0};
  OccurrenceId held;    ///< The held part with most mates that replace contact with one other part,
  OccurrenceId placed;  ///< that other part,
  std::size_t replacing{0};  ///< and how many these mates are.
};

bool IsHeld(const sequence::SequenceStep& step, OccurrenceId id) {
  return id == step.occurrence ||
         std::find(step.members.begin(), step.members.end(), id) != step.members.end();
}

void CountMates(const Model& model, const sequence::SequenceStep& step, OccurrenceId held,
                MateCount* count) {
  std::map<OccurrenceId, std::size_t> replacing;  // By the other part.
  for (const product::MateId id : model.mates_of[held.index()]) {
    const product::Mate& mate = model.product->mates[id.index()];
    const OccurrenceId other = mate.a.occurrence == held ? mate.b.occurrence : mate.a.occurrence;
    if (IsHeld(step, other)) {
      continue;
    }
    ++count->all;
    const product::Connector& placed = mate.a.occurrence == held ? mate.b : mate.a;
    const Vec3 axis_W =
        model.bodies[other.index()].X_WB_goal.q() * (placed.X_BM.q() * Vec3::UnitZ());
    const bool is_guide =
        mate.kind == product::MateKind::kFaceFace && !IsStop(mate, axis_W, step.extraction_W);
    if (!is_guide && !mates::HasFit(mate.kind)) {
      continue;
    }
    if (const std::size_t number = ++replacing[other]; number > count->replacing) {
      count->held = held;
      count->placed = other;
      count->replacing = number;
    }
  }
}

MateCount CountMates(const Model& model, const sequence::SequenceStep& step) {
  MateCount count;
  CountMates(model, step, step.occurrence, &count);
  for (const OccurrenceId member : step.members) {
    CountMates(model, step, member, &count);
  }
  return count;
}

void ReportMates(const Model& model, Diagnostics* diagnostics) {
  constexpr std::size_t kMost = haptics::MateGuide::kMaxMates;                 // The tick's room.
  constexpr std::size_t kMostPairs = contact::QueryOptions::kMaxPairsPerBody;  // A query's.
  const auto path_of = [&model](OccurrenceId id) -> const std::string& {
    return model.product->occurrences[id.index()].path;
  };
  std::set<product::PartId> many_mates;
  std::set<product::PartId> many_pairs;
  for (const sequence::SequenceStep& step : model.sequence.steps) {
    if (step.kind == sequence::SequenceStep::Kind::kPark) {
      continue;  // Nothing guides it to the shelf.
    }
    const MateCount count = CountMates(model, step);
    const product::PartId part = model.product->occurrences[step.occurrence.index()].part;
    if (count.all > kMost && many_mates.insert(part).second) {
      diagnostics->Warn(
          "limit-mates", path_of(step.occurrence),
          fmt::format("it has {} mates with other parts, of which {} guide and seat it at a time: "
                      "the faces of the others stay in contact",
                      count.all, kMost),
          "remove mates that are not needed in the side file");
    }
    const std::size_t pairs = haptics::MateGuide::kPairsPerMate * count.replacing;
    if (pairs > kMostPairs && many_pairs.insert(part).second) {
      diagnostics->Note(
          "limit-face-pairs", path_of(count.held),
          fmt::format("{} mates with {} take {} pairs of sets of faces out of contact, of which "
                      "the last {} are one set: contact between any of their faces is left out",
                      count.replacing, path_of(count.placed), pairs, pairs - kMostPairs + 1),
          "remove mates that are not needed in the side file");
    }
  }
}

void ReportLightParts(const Model& model, Diagnostics* diagnostics) {
  std::set<product::PartId> light;
  for (const Body& body : model.bodies) {
    const product::Part& part = model.product->part_of(body.occurrence);
    if (part.mass.mass < body.mass.mass) {
      light.insert(part.id);
    }
  }
  if (light.empty()) {
    return;
  }
  diagnostics->Note(
      "limit-mass", model.product->parts[light.begin()->index()].name,
      fmt::format("{} in the hand and on the table as if it weighed 0.1 g, with the inertia of a "
                  "ball, because it weighs less",
                  light.size() == 1 ? "it moves"
                                    : fmt::format("it and {} other part{} move", light.size() - 1,
                                                  light.size() == 2 ? "" : "s")));
}

}  // namespace

void ReportModelLimits(const Model& model, Diagnostics* diagnostics) {
  ReportMates(model, diagnostics);
  ReportLightParts(model, diagnostics);
}

}  // namespace hvas::simulation
