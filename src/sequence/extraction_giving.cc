// Ways on which parts give: docs/algorithms/flexible.md.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "product/bearable_strain.h"
#include "product/ring_shape.h"
#include "sequence/bending_form.h"
#include "sequence/bent_arms.h"
#include "sequence/extraction.h"
#include "sequence/giving_force.h"
#include "sequence/giving_width.h"

namespace hvas::sequence {
namespace {

using product::MateKind;
using product::OccurrenceId;

// How far a wall or an arm is bent aside at most, whatever its strain is: choices.
constexpr double kUndercut = 0.05;         // Of the longest side of the smaller part.
constexpr double kLargestUndercut = 5e-3;  // [m]
constexpr double kSideways = 0.5;          // Normals within 30 degrees of across the way: a choice.
constexpr double kDownwards = -0.5;        // Within 60 degrees of down: a choice.
// Share of an O-ring's section; usual glands squeeze it by 10 to 30 %. A choice.
constexpr double kMostSqueeze = 0.4;

bool IsGivingRing(const product::Product& product, OccurrenceId id) {
  const product::FlexiblePart* flexible = FindFlexible(product, id);
  return flexible != nullptr && (flexible->kind == product::FlexibleKind::kRetainingRing ||
                                 flexible->kind == product::FlexibleKind::kGrooveRing ||
                                 flexible->kind == product::FlexibleKind::kORing);
}

/** How far one of two parts has to give, as CalcGivingWidth() has it: on a grid by the width
 itself, where it is within the limit. */
double MeasureWidth(const product::Product& product, OccurrenceId moving, OccurrenceId other,
                    const Vec3& way_W, double limit) {
  constexpr double kFinest = 0.1e-3;  // [m]: parts give by a tenth of a millimetre or more.
  constexpr double kShare = 0.25;     // Of the width, so that it is good to a twentieth. A choice.
  const double width = CalcGivingWidth(product, moving, other, way_W, limit);
  return width > 0 && width < limit
             ? CalcGivingWidth(product, moving, other, way_W, std::max(kShare * width, kFinest))
             : width;
}

/** Notes how far a part that bends or opens is strained, and what it bears. */
void NoteStrain(const product::Product& product, const WhatBends* arm, GivingPair* give) {
  const product::Part& part = product.part_of(give->flexible);
  const auto ring = give->kind == product::FlexibleKind::kRetainingRing
                        ? product::FindRingShape(part)
                        : std::nullopt;
  if (ring) {
    give->strain = product::CalcOpeningStrain(*ring, give->width);
    give->bearable_strain = product::FindBearableRingStrain(part.material);
  } else if (give->kind == product::FlexibleKind::kForm && arm != nullptr &&
             arm->part == give->flexible) {
    give->strain = arm->bending.strain;
    give->bearable_strain = product::FindBearableStrain(part.material);
  }
}

}  // namespace

void Extraction::Meeting::Add(const MeetingSide& side) {
  constexpr double kSameSide = 0.7;  // Cosine: normals within 45 degrees are of one leg. A choice.
  const auto known = std::find_if(sides.begin(), sides.end(), [&](const MeetingSide& other) {
    return other.contact.nhat_W.dot(side.contact.nhat_W) > kSameSide;
  });
  if (known == sides.end()) {
    sides.push_back(side);
  } else if (side.contact.distance < known->contact.distance) {
    *known = side;
  }
}

Extraction::MeetingSide Extraction::Meeting::deepest() const {
  const auto deepest =
      std::min_element(sides.begin(), sides.end(), [](const MeetingSide& a, const MeetingSide& b) {
        return a.contact.distance < b.contact.distance;
      });
  return deepest == sides.end() ? MeetingSide() : *deepest;
}

bool Extraction::MayPass(const MateView& view, OccurrenceId id, const Vec3& direction) const {
  const bool is_wall =
      view.mate->kind == MateKind::kFaceFace || view.mate->kind == MateKind::kPrismatic;
  return giving_ != Giving::kNone && CalcGiveLimit(id, view.other) > 0 &&
         (is_wall || IsAcrossOpenAxis(view, direction));
}

double Extraction::CalcGiveLimit(OccurrenceId id, OccurrenceId other) const {
  if (giving_ == Giving::kByClearance) {
    return is_cleared_[other.index()] ? clearance_ : 0;
  }
  double known = 0;
  if (!input_.give_limits.empty()) {
    const double own = input_.give_limits[id.index()];
    const double others = input_.give_limits[other.index()];
    // What is put over a land is not put over a ring beside it.
    const bool are_rings =
        own > 0 && others > 0 && IsGivingRing(product_, id) && IsGivingRing(product_, other);
    known = are_rings ? 0 : std::max(own, others);
  }
  if (giving_ != Giving::kByForm ||
      (IsStatedRigid(product_, id) && IsStatedRigid(product_, other))) {
    return giving_ == Giving::kNone ? 0 : known;
  }
  const auto longest = [this](OccurrenceId part) {
    return product_.part_of(part).box_B.size().maxCoeff();
  };
  return std::max(known,
                  std::min(kLargestUndercut, kUndercut * std::min(longest(id), longest(other))));
}

bool Extraction::GivesAsKnown(OccurrenceId id, OccurrenceId other, double width) const {
  const double limit = input_.give_limits.empty() ? 0.0
                                                  : std::max(input_.give_limits[id.index()],
                                                             input_.give_limits[other.index()]);
  return limit > 0 && width <= limit;
}

bool Extraction::MayGive(OccurrenceId id) const {
  const auto gives = [this](OccurrenceId other) {
    return input_.give_limits[other.index()] > 0 && is_present_[other.index()];
  };
  if (input_.give_limits.empty() || gives(id)) {
    return !input_.give_limits.empty();
  }
  // A rigid part may pass where what was in its way gives.
  return std::any_of(memories_[id.index()].attempts.begin(), memories_[id.index()].attempts.end(),
                     [&gives](const Attempt& attempt) {
                       return attempt.blocker && attempt.blocker->occurrence.is_valid() &&
                              gives(attempt.blocker->occurrence);
                     });
}

std::optional<SequenceStep> Extraction::TryRemoveWith(Giving giving, Unit* rest,
                                                      const Unit& deferred) {
  std::vector<Memory>& memories = giving == Giving::kByForm ? bending_memories_ : giving_memories_;
  // What can be put in from above is: the product is not turned over for a ring.
  for (const auto& [is_deferred, may_go_down] :
       {std::pair(false, false), {false, true}, {true, false}, {true, true}}) {
    for (std::size_t i = 0; i + 1 < rest->size(); ++i) {
      const OccurrenceId id = (*rest)[i];
      if ((giving == Giving::kAsKnown && !MayGive(id)) ||
          std::binary_search(deferred.begin(), deferred.end(), id) != is_deferred) {
        continue;
      }
      giving_ = giving;
      std::optional<SequenceStep> step = TryRemove({id}, &memories[id.index()]);
      giving_ = Giving::kNone;
      if (step && !may_go_down && step->extraction_W.z() < kDownwards) {
        SetPresent({id}, true);
        memories[id.index()] = {};
        continue;
      }
      if (step) {
        if (auto rigid = giving == Giving::kByForm ? FindRigidWay(id) : std::nullopt) {
          step = std::move(rigid);
        } else {
          NoteGives(id, step->extraction_W);
        }
        rest->erase(rest->begin() + static_cast<std::ptrdiff_t>(i));
        return step;
      }
    }
  }
  return std::nullopt;
}

std::optional<SequenceStep> Extraction::TryRemoveGiving(Unit* rest, const Unit& deferred) {
  return TryRemoveWith(Giving::kAsKnown, rest, deferred);
}

std::optional<SequenceStep> Extraction::TryRemoveBending(Unit* rest, const Unit& deferred) {
  return TryRemoveWith(Giving::kByForm, rest, deferred);
}

void Extraction::VisitContacts(
    OccurrenceId id, const Vec3& direction,
    const std::function<void(const contact::Contact&, double travelled)>& visit) {
  const std::vector<Member> members = ListMembers({id}, direction);
  const double exit = CalcExitDistance({id}, direction);
  const double step = CalcStep({id}, exit);
  VisitContacts(id, direction, MakeQuery(members[0], kDepthTolerance), step,
                static_cast<int>(exit / step), visit);
}

void Extraction::VisitContacts(
    OccurrenceId id, const Vec3& direction, const contact::QueryOptions& query, double step,
    int last, const std::function<void(const contact::Contact&, double travelled)>& visit) {
  for (int i = 0; i <= last && !input_.stop.stop_requested(); ++i) {
    input_.scene->Query(input_.scene->shape(query.self), CalcPoseAlong(id, i * step * direction),
                        query, &workspace_);
    CountQuery();
    for (const contact::Contact& contact : workspace_.contacts()) {
      visit(contact, i * step);
    }
  }
}

std::map<OccurrenceId, Extraction::Meeting> Extraction::MeasureMeetings(OccurrenceId id,
                                                                        const Vec3& direction) {
  std::map<OccurrenceId, Meeting> meetings;
  VisitContacts(id, direction, [&](const contact::Contact& contact, double travelled) {
    if (!contact.body.is_valid()) {
      return;
    }
    Meeting& meeting = meetings[OccurrenceId(contact.body.index())];
    meeting.depth = std::max(meeting.depth, -contact.distance);
    if (contact.distance < 0 && std::abs(contact.nhat_W.dot(direction)) < kSideways) {
      meeting.Add({contact, travelled});
    }
  });
  return meetings;
}

BendingAnswer Extraction::FindWhatBends(OccurrenceId id, OccurrenceId other,
                                        const MeetingSide& side, const Vec3& direction,
                                        double width) const {
  if (!(side.contact.distance < 0)) {
    return {};  // It would have to be pushed through, not aside.
  }
  return sequence::FindWhatBends(
      product_,
      {id, other, side.contact.p_WC, side.contact.nhat_W, direction, side.travelled, width},
      is_present_);
}

bool Extraction::MayBend(OccurrenceId id, OccurrenceId other, const Meeting& meeting,
                         const Vec3& direction, double width) {
  constexpr double kShareOfDeepest = 0.5;  // Another leg is as deep as this, or more. A choice.
  const MeetingSide deepest = meeting.deepest();
  bool does_bend = FindWhatBends(id, other, deepest, direction, width).bends.has_value();
  for (const MeetingSide& side : meeting.sides) {
    if (side.contact.distance > kShareOfDeepest * deepest.contact.distance) {
      continue;
    }
    const BendingAnswer answer = FindWhatBends(id, other, side, direction, width);
    if (answer.no_room) {
      no_rooms_.try_emplace(id, *answer.no_room);
      does_bend = false;
    }
  }
  return does_bend;
}

std::string Extraction::ExplainBending(OccurrenceId id) const {
  const auto found = no_rooms_.find(id);
  if (found == no_rooms_.end() || !is_present_[found->second.against.index()]) {
    return {};
  }
  const NoRoom& no_room = found->second;
  const bool is_own = no_room.part == id;
  return fmt::format(
      "no room to bend: {} would have to bend by {:.2f} mm, and {} leaves {:.2f} mm "
      "behind it",
      is_own ? std::string("an arm or wall of it") : "an arm or wall of " + Describe(no_room.part),
      units::ToMm(no_room.needed), Describe(no_room.against), units::ToMm(no_room.free));
}

GivingSamples Extraction::SampleGiving(OccurrenceId id, OccurrenceId other, bool gives_itself,
                                       const Vec3& direction) {
  constexpr int kSamples = 120;         // A choice: ramps of a hook have some tens of them.
  constexpr double kFinest = 10e-6;     // [m]; contact is no finer.
  constexpr double kLeastAcross = 0.3;  // Normals that lead on say nothing of how far it gives.
  const auto calc_aside = [&direction](const contact::Contact& contact) {
    return (contact.nhat_W - contact.nhat_W.dot(direction) * direction).norm();
  };
  const auto counts = [&](const contact::Contact& contact) {
    return contact.body.is_valid() && OccurrenceId(contact.body.index()) == other &&
           contact.distance < 0 && calc_aside(contact) > kLeastAcross;
  };
  // All of what overlaps, whatever is allowed or answered for by a mate.
  contact::QueryOptions query;
  query.margin = 0;
  query.self = contact::BodyId(id.index());
  const double exit = CalcExitDistance({id}, direction);
  const double step = CalcStep({id}, exit);
  double until = 0;
  GivingSamples samples;
  contact::Contact& deepest = samples.deepest;
  VisitContacts(
      id, direction, query, step, static_cast<int>(exit / step),
      [&](const contact::Contact& contact, double travelled) {
        if (counts(contact)) {
          until = travelled;
          samples.travelled = contact.distance < deepest.distance ? travelled : samples.travelled;
          deepest = contact.distance < deepest.distance ? contact : deepest;
          MetFace& met = samples.by_face[gives_itself ? contact.held_face : contact.scene_face];
          if (met.contact.distance < 0 &&
              met.contact.nhat_W.dot(contact.nhat_W) < kOppositeNormals) {
            met.opposite = contact;
            met.opposite_travelled = travelled;
          }
          if (contact.distance < met.contact.distance) {
            met.contact = contact;
            met.travelled = travelled;
          }
        }
      });
  samples.spacing = std::max(kFinest, (until + step) / kSamples);
  samples.given.assign(kSamples + 1, 0.0);
  // Two hooks grip from both sides, and a bead all around.
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Vec3 across_W = direction.cross(deepest.nhat_W).normalized();
  std::array<double, 2> low{kNone, kNone};
  std::array<double, 2> high{-kNone, -kNone};
  VisitContacts(
      id, direction, query, samples.spacing, kSamples,
      [&](const contact::Contact& contact, double travelled) {
        if (!counts(contact)) {
          return;
        }
        double& given =
            samples.given[static_cast<std::size_t>(std::lround(travelled / samples.spacing))];
        given = std::max(given, -contact.distance / calc_aside(contact));
        const std::size_t side = contact.nhat_W.dot(deepest.nhat_W) > 0 ? 0 : 1;
        low[side] = std::min(low[side], across_W.dot(contact.p_WC));
        high[side] = std::max(high[side], across_W.dot(contact.p_WC));
      });
  samples.breadth = std::max(0.0, high[0] - low[0]) + std::max(0.0, high[1] - low[1]);
  return samples;
}

double Extraction::CalcWidestGiven(OccurrenceId id, OccurrenceId other, const Vec3& direction,
                                   double limit) const {
  if (giving_ != Giving::kByClearance && giving_ != Giving::kByLimits) {
    return limit;
  }
  // The grid of the width is good to two cells, of which there are 600 across.
  constexpr double kTwoCells = 1.0 / 300;
  const double longest = product_.part_of(id).box_B.size().maxCoeff();
  const double room =
      giving_ == Giving::kByClearance ? 2 * kDepthTolerance + kTwoCells * longest : 0;
  // What a part blocks of itself, seen along the way, is its outline.
  constexpr double kMostOfOutline = 0.75;    // More goes through, and not past: a choice.
  constexpr double kOutlineAccuracy = 0.05;  // Of the longest side: cells are a tenth. A choice.
  const auto calc_outline = [&](OccurrenceId part) {
    const double side = product_.part_of(part).box_B.size().maxCoeff();
    return CalcGivingWidth(product_, part, part, direction,
                           std::max(limit, kOutlineAccuracy * side));
  };
  const double narrowest = std::min(calc_outline(id), calc_outline(other));
  return std::min(limit + room, kMostOfOutline * narrowest);
}

std::optional<Obstacle> Extraction::FindSqueezed(OccurrenceId id, const Vec3& direction) {
  const product::FlexiblePart* flexible = FindFlexible(product_, id);
  if (flexible == nullptr || flexible->kind != product::FlexibleKind::kORing) {
    return std::nullopt;
  }
  const product::Part& ring = product_.part_of(id);
  const double section = ring.box_B.size().minCoeff();
  const Vec3 middle_B = ring.box_B.centre();
  const std::vector<Member> members = ListMembers({id}, direction);
  contact::QueryOptions query = MakeQuery(members[0], kDepthTolerance);
  query.margin = section;  // What it is stretched over pushes it against what is around it.
  query.allowances = {};
  query.ignored = {};
  const double exit = CalcExitDistance({id}, direction);
  const double step = CalcStep({id}, exit);
  const int last = static_cast<int>(exit / step);

  // At each look along the way, how deep it is in what is inside of it, and in what is around it.
  // Past the middle of its section the nearest way out leads on: what is deepest tells the side.
  struct Side {
    double depth{-std::numeric_limits<double>::infinity()};
    bool is_inside{false};
  };

  for (int i = 0; i <= last && !input_.stop.stop_requested(); ++i) {
    const spatial::Pose X_WB = CalcPoseAlong(id, i * step * direction);
    input_.scene->Query(input_.scene->shape(query.self), X_WB, query, &workspace_);
    CountQuery();
    std::map<OccurrenceId, Side> sides;
    for (const contact::Contact& contact : workspace_.contacts()) {
      const Vec3& n_W = contact.nhat_W;
      const double aside = (n_W - n_W.dot(direction) * direction).norm();
      if (contact.body.is_valid() && aside > kSideways) {
        Side& side = sides[OccurrenceId(contact.body.index())];
        const bool is_inside = n_W.dot(contact.p_WC - X_WB * middle_B) > 0;
        side = -contact.distance / aside > side.depth ? Side{-contact.distance / aside, is_inside}
                                                      : side;
      }
    }
    double inside = 0;
    for (const auto& [other, side] : sides) {
      inside = side.is_inside ? std::max(inside, side.depth) : inside;
    }
    for (const auto& [other, side] : sides) {
      if (inside > 0 && !side.is_inside && inside + side.depth > kMostSqueeze * section) {
        return Obstacle{other, i * step, {}};
      }
    }
  }
  return std::nullopt;
}

std::optional<Obstacle> Extraction::FindTooWide(OccurrenceId id, const Vec3& direction) {
  const Giving giving = std::exchange(giving_, Giving::kNone);  // What is met without giving.
  const std::map<OccurrenceId, Meeting> meetings = MeasureMeetings(id, direction);
  const std::optional<Obstacle> squeezed = FindSqueezed(id, direction);
  giving_ = giving;
  if (squeezed) {
    return squeezed;
  }
  for (const auto& [other, meeting] : meetings) {
    const double limit = CalcGiveLimit(id, other);
    if (!(limit > 0)) {
      continue;
    }
    const double width = MeasureWidth(product_, id, other, direction, limit);
    const bool is_too_wide = width > 0 && width > CalcWidestGiven(id, other, direction, limit);
    const bool has_to_bend = giving_ == Giving::kByForm && !GivesAsKnown(id, other, width);
    Meeting seen = meeting;
    if (!is_too_wide && has_to_bend && seen.sides.empty()) {
      // Faces that a fit answers for meet as well where a barb is next to them.
      contact::QueryOptions query;
      query.margin = -kDepthTolerance;
      query.self = contact::BodyId(id.index());
      const double exit = CalcExitDistance({id}, direction);
      const double step = CalcStep({id}, exit);
      VisitContacts(
          id, direction, query, step, static_cast<int>(exit / step),
          [&seen, &direction, other = other](const contact::Contact& contact, double travelled) {
            if (contact.body.is_valid() && OccurrenceId(contact.body.index()) == other &&
                contact.distance < 0 && std::abs(contact.nhat_W.dot(direction)) < kSideways) {
              seen.Add({contact, travelled});
            }
          });
    }
    if (is_too_wide || (has_to_bend && !MayBend(id, other, seen, direction, width))) {
      return Obstacle{other, 0, {}};
    }
  }
  return std::nullopt;
}

void Extraction::NoteForm(const GivingSamples& samples, const WhatBends* arm, const Vec3& direction,
                          GivingPair* give) const {
  if (give->curve == nullptr) {
    return;
  }
  const product::Part& part = product_.part_of(give->flexible);
  const bool is_own = give->moved == give->flexible;
  const Vec3 p_W = samples.deepest.p_WC - (is_own ? samples.travelled : 0.0) * direction;
  const Vec3 p_B = product_.occurrences[give->flexible.index()].X_WB.Inverse() * p_W;
  if (give->curve->squeezed) {
    const Vec3 size = part.box_B.size();
    const double middle = 0.5 * (size.maxCoeff() - size.minCoeff());
    Vec3 off_B = p_B - part.box_B.centre();
    Eigen::Index axis = 0;
    (void)size.minCoeff(&axis);
    off_B[axis] = 0;
    give->is_outside = off_B.norm() > middle;
  } else if (arm != nullptr && arm->part == give->flexible) {
    give->arms = FindBentArms(product_, *give, samples, arm->inward_sign, direction);
  }
}

void Extraction::NoteGives(OccurrenceId id, const Vec3& direction) {
  SetUnit({id}, true);
  const std::map<OccurrenceId, Meeting> meetings = MeasureMeetings(id, direction);
  SetUnit({id}, false);
  for (const auto& [other, meeting] : meetings) {
    GivingPair give;
    give.flexible = id;
    give.other = other;
    give.depth = meeting.depth;
    const product::FlexiblePart* own = FindFlexible(product_, id);
    const product::FlexiblePart* others = FindFlexible(product_, other);
    const auto limit_of = [](const product::FlexiblePart* part) {
      return part == nullptr ? 0.0 : part->allowance;
    };
    const double limit = std::max(limit_of(own), limit_of(others));
    give.width = MeasureWidth(product_, id, other, direction, limit > 0 ? limit : kLargestUndercut);
    const auto bending = FindWhatBends(id, other, meeting.deepest(), direction, give.width).bends;
    const bool is_known = limit > 0 && give.width <= limit;
    const bool is_own =
        is_known || !bending ? limit_of(own) >= limit_of(others) : bending->part == id;
    give.kind = !is_known ? product::FlexibleKind::kForm : is_own ? own->kind : others->kind;
    if (!is_own) {
      std::swap(give.flexible, give.other);
    }
    give.moved = id;
    const GivingSamples samples = SampleGiving(id, other, give.flexible == id, direction);
    // The nearest way out of a small hook leads along its way: its ramp tells where its arm is.
    const MeetingSide on_ramp{samples.deepest, samples.travelled};
    const auto arm =
        bending ? bending : FindWhatBends(id, other, on_ramp, direction, give.width).bends;
    give.curve = MakeGivingCurve(product_, give, samples,
                                 arm && arm->part == give.flexible ? &arm->bending : nullptr);
    NoteForm(samples, arm ? &*arm : nullptr, direction, &give);
    NoteStrain(product_, arm ? &*arm : nullptr, &give);
    gives_.push_back(give);
    allowances_[id.index()] = ListAllowances(overlaps_, gives_, id);
    allowances_[other.index()] = ListAllowances(overlaps_, gives_, other);
  }
}

}  // namespace hvas::sequence
