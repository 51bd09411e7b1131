#include "shopfloor/dfa_rating.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "orders/hand_time.h"
#include "product/fastener_name.h"
#include "product/words.h"
#include "shopfloor/instruction_words.h"
#include "shopfloor/order_arrow.h"

namespace hvas::shopfloor {
namespace {

using assembly::OrderPlan;
using orders::FreeMove;
using product::FitKind;
using product::Mate;
using product::MateKind;
using product::OccurrenceId;
using simulation::Model;

// Limits of Boothroyd and Dewhurst's handling codes [m].
constexpr double kLarge = 15e-3;
constexpr double kTiny = 6e-3;
constexpr double kThin = 2e-3;
// A part that takes two hands: 10 pounds, their limit for one hand [kg], or longer than a forearm
// [m], which is a choice.
constexpr double kHeavy = 4.5;
constexpr double kLong = 0.4;
// A hand that goes in deeper than a finger's last two joints works in obstructed access [m]: a
// choice.
constexpr double kObstructed = 50e-3;
// A fit of more play than this needs no care, as the put P2 of MODAPTS [m]: a choice.
constexpr double kEasyPlay = 0.1e-3;
constexpr double kSameAxis = 0.1e-3;  // Offset of axes that are one [m]: a choice.
constexpr double kParallel = 0.999;   // Cosine of 2.6 degrees: a choice.

OccurrenceId OtherOf(const Mate& mate, OccurrenceId id) {
  return mate.a.occurrence == id ? mate.b.occurrence : mate.a.occurrence;
}

const std::string& PathOf(const Model& model, OccurrenceId id) {
  return model.product->occurrences[id.index()].path;
}

/** How a part comes in the best order. */
struct Coming {
  OccurrenceId part;
  Vec3 way_W{Vec3::UnitZ()};  // Way out, unit.
  bool is_base{false};
  bool is_bound_by_tool{false};  // A tool turns it in.
  double reach{0};               // [m]
  double press{0};               // [N]
  bool is_held{false};
  bool is_cramped{false};  // Something stands where its tool turns.
};

/** All parts in the order in which they come: what is put together by itself, then the moves. */
std::vector<Coming> ListComing(const Model& model, const OrderPlan& plan) {
  std::vector<Coming> list;
  std::set<OccurrenceId> listed;
  const auto add = [&](const Coming& coming) {
    if (model.bodies[coming.part.index()].role == simulation::BodyRole::kPart &&
        listed.insert(coming.part).second) {
      list.push_back(coming);
    }
  };
  for (const sequence::SequenceStep& step : plan.rules.first) {
    add({step.occurrence, step.extraction_W, step.kind == sequence::SequenceStep::Kind::kBase});
  }
  const orders::FoundOrder& best = assembly::BestOrder(plan);
  const std::vector<orders::HandWork> work = orders::ListHandWork(plan.rules, best);
  for (std::size_t i = 0; i < best.moves.size(); ++i) {
    const FreeMove& move = plan.rules.moves[best.moves[i]];
    Coming coming{move.parts.front(), move.ways[best.ways[i]].step.extraction_W};
    coming.is_bound_by_tool = !move.tool.empty();
    coming.reach = work[i].reach;
    coming.press = work[i].press;
    coming.is_cramped = !orders::ListInToolSpace(plan.rules, best, i).empty();
    if (!plan.statics.empty() && plan.statics.front().holds[i]) {
      const auto& holds = *plan.statics.front().holds[i];
      coming.is_held = std::find(holds.begin(), holds.end(), coming.part) != holds.end();
    }
    add(coming);
    for (const OccurrenceId member : move.parts) {
      add({member, coming.way_W});
    }
  }
  return list;
}

/** A chamfer or rounding leads into one side of a mate. */
bool HasLeadIn(const Model& model, const Mate& mate) {
  const auto leads = [&](const product::Connector& side) {
    const std::vector<product::Form>& forms = model.product->part_of(side.occurrence).forms;
    return std::any_of(forms.begin(), forms.end(), [&side](const product::Form& form) {
      return form.lead_in > 0 && std::find(form.features.begin(), form.features.end(),
                                           side.feature) != form.features.end();
    });
  };
  return leads(mate.a) || leads(mate.b);
}

/** A fit that has to be found without a chamfer that helps. */
bool IsHardToAlign(const Model& model, OccurrenceId part) {
  const auto& mates = model.mates_of[part.index()];
  return std::any_of(mates.begin(), mates.end(), [&](product::MateId id) {
    const Mate& mate = model.product->mates[id.index()];
    const bool is_close =
        mate.fit && (product::IsIsoFit(mate.fit->kind) || mate.fit->kind == FitKind::kThread) &&
        2 * (mate.hole_radius - mate.shaft_radius) < kEasyPlay;
    return is_close && !HasLeadIn(model, mate);
  });
}

/** The digit by which the size of a part is handled, from 0 to 4. */
int FindSizeDigit(double size, double thickness) {
  if (thickness > kThin) {
    return size > kLarge ? 0 : size >= kTiny ? 1 : 2;
  }
  return size > kTiny ? 3 : 4;
}

/** Parts of these kinds nest, tangle or bend in the hand. */
bool Tangles(product::FlexibleKind kind) {
  using product::FlexibleKind;
  return kind == FlexibleKind::kORing || kind == FlexibleKind::kRetainingRing ||
         kind == FlexibleKind::kSpring || kind == FlexibleKind::kCable ||
         kind == FlexibleKind::kBelt || kind == FlexibleKind::kRubber;
}

void RateHandling(const Model& model, const Coming& coming, RatedParts* rated) {
  const product::Part& part = model.product->part_of(coming.part);
  Vec3 extents = part.box_B.size();
  std::sort(extents.data(), extents.data() + 3);
  rated->size = extents[2];
  rated->thickness = extents[0];
  const bool is_round =
      rated->symmetry.beta_deg == 0 && extents[1] - extents[0] < 0.01 * extents[2];
  if (is_round && extents[1] < extents[2]) {
    rated->thickness = extents[0] / 2;  // The charts take the radius of a long round part.
  }
  const double mass = model.bodies[coming.part.index()].mass.mass;
  if (mass > kHeavy || rated->size > kLong) {
    rated->handling = "83";
    rated->handled_as =
        fmt::format("two hands: {:.2g} kg, {:.0f} mm long", mass, units::ToMm(rated->size));
    return;
  }
  const int sum_deg = rated->symmetry.sum_deg();
  const int first = sum_deg < 360 ? 0 : sum_deg < 540 ? 1 : sum_deg < 720 ? 2 : 3;
  const product::FlexiblePart* flexible = product::FindFlexible(*model.product, coming.part);
  const bool tangles = flexible != nullptr && flexible->allowance > 0 && Tangles(flexible->kind);
  const int second = FindSizeDigit(rated->size, rated->thickness) + (tangles ? 5 : 0);
  rated->handling = fmt::format("{}{}", first, second);
  rated->handled_as = fmt::format(
      "alpha {} deg, beta {} deg, {:.3g} mm large, {:.3g} mm thick{}", rated->symmetry.alpha_deg,
      rated->symmetry.beta_deg, units::ToMm(rated->size), units::ToMm(rated->thickness),
      tangles ? fmt::format(", {}", product::ToString(flexible->kind)) : "");
}

void RateInsertion(const Model& model, const Coming& coming, RatedParts* rated) {
  if (coming.is_base) {
    rated->insertion = "00";
    rated->inserted_as = "the first part, laid into its fixture";
    return;
  }
  const int access = coming.reach > kObstructed || coming.is_cramped ? 1 : 0;
  const std::string access_text =
      access == 0 ? ""
      : coming.is_cramped
          ? "; parts stand where its tool turns"
          : fmt::format("; the hand reaches in by {:.0f} mm", units::ToMm(coming.reach));
  rated->is_hard_to_align = IsHardToAlign(model, coming.part);
  const std::string align_text =
      rated->is_hard_to_align ? "; a close fit without a chamfer" : "; easy to align";
  if (coming.is_bound_by_tool) {
    rated->insertion = fmt::format("{}{}", 3 + access, rated->is_hard_to_align ? 9 : 8);
    rated->inserted_as = "turned in by a tool" + align_text + access_text;
    return;
  }
  if (coming.press > 0) {
    rated->insertion = fmt::format("{}1", 3 + access);
    rated->inserted_as = "pressed in with " + FormatForce(coming.press) + access_text;
    return;
  }
  rated->is_held = coming.is_held;
  const int second = (rated->is_hard_to_align ? 2 : 0) + (coming.is_held ? 6 : 0);
  rated->insertion = fmt::format("{}{}", access, second);
  rated->inserted_as = "laid in" + align_text +
                       (coming.is_held ? "; has to be held until something secures it" : "") +
                       access_text;
}

/** A line in W about which a part may turn. */
struct Axis {
  Vec3 p_W;
  Vec3 direction_W;
};

bool IsOnAxis(const Axis& axis, const Vec3& p_W) {
  return (p_W - axis.p_W).cross(axis.direction_W).norm() < kSameAxis;
}

bool LeavesTurning(const Model& model, const Mate& mate, const Axis& axis) {
  const spatial::Pose X_WM =
      model.product->occurrences[mate.a.occurrence.index()].X_WB * mate.a.X_BM;
  const bool is_parallel = std::abs((X_WM.q() * Vec3::UnitZ()).dot(axis.direction_W)) > kParallel;
  switch (mate.kind) {
    case MateKind::kAxisHole:
      return is_parallel && IsOnAxis(axis, X_WM.p()) && mate.fit &&
             (mate.fit->kind == FitKind::kClearance || mate.fit->kind == FitKind::kPassage);
    case MateKind::kFaceFace:
      return is_parallel;
    case MateKind::kConeSeat:
      return is_parallel && IsOnAxis(axis, X_WM.p());
    case MateKind::kSphereSeat:
      return IsOnAxis(axis, X_WM.p());
    case MateKind::kPrismatic:
      return false;
  }
  return false;
}

/** The mates of a part leave it free to turn about the axis of one of them. */
std::optional<std::string> FindTurning(const Model& model, OccurrenceId part) {
  const auto& ids = model.mates_of[part.index()];
  for (const product::MateId own : ids) {
    const Mate& mate = model.product->mates[own.index()];
    if (mate.kind != MateKind::kAxisHole || !mate.fit || mate.fit->kind != FitKind::kClearance) {
      continue;
    }
    const spatial::Pose X_WM =
        model.product->occurrences[mate.a.occurrence.index()].X_WB * mate.a.X_BM;
    const Axis axis{X_WM.p(), X_WM.q() * Vec3::UnitZ()};
    if (std::all_of(ids.begin(), ids.end(), [&](product::MateId id) {
          return LeavesTurning(model, model.product->mates[id.index()], axis);
        })) {
      return fmt::format("its mates leave it free to turn in {}",
                         PathOf(model, OtherOf(mate, part)));
    }
  }
  return std::nullopt;
}

/** A material that the file names, and that none of the neighbours has. */
std::optional<std::string> FindOtherMaterial(const Model& model, OccurrenceId part) {
  const product::Material& own = model.product->part_of(part).material;
  const auto& ids = model.mates_of[part.index()];
  const bool is_other = !own.is_standard_assumed && !ids.empty() &&
                        std::all_of(ids.begin(), ids.end(), [&](product::MateId id) {
                          const Mate& mate = model.product->mates[id.index()];
                          const product::Material& other =
                              model.product->part_of(OtherOf(mate, part)).material;
                          return !other.is_standard_assumed && other.standard != own.standard;
                        });
  return is_other ? std::optional(fmt::format("{}, as none of its neighbours is", own.standard))
                  : std::nullopt;
}

/** Symmetries of parts, each looked for once: equal parts come the same way most often. */
class SymmetryFinder {
 public:
  explicit SymmetryFinder(const product::Product& product) : product_(product) {}

  [[nodiscard]] PartSymmetry Find(OccurrenceId id, const Vec3& way_B) {
    const product::PartId part = product_.occurrences[id.index()].part;
    for (const Found& found : found_) {
      if (found.part == part && std::abs(found.way_B.dot(way_B)) > kParallel) {
        return found.symmetry;
      }
    }
    found_.push_back({part, way_B, FindSymmetry(product_.part_of(id), way_B)});
    return found_.back().symmetry;
  }

 private:
  struct Found {
    product::PartId part;
    Vec3 way_B;
    PartSymmetry symmetry;
  };

  const product::Product& product_;
  std::vector<Found> found_;
};

/** "Lock washer", "Scheibe 8,4". */
bool IsWasherName(const std::string& name) {
  const std::string folded = product::FoldName(name);
  constexpr std::array kWords{"washer", "lockwasher", "scheibe", "unterlegscheibe", "federring"};
  return std::any_of(kWords.begin(), kWords.end(),
                     [&folded](const char* word) { return product::HasWord(folded, word); });
}

bool IsFastener(const Model& model, OccurrenceId id) {
  const auto is_named = [](const std::string& name) {
    return product::ClassifyName(name) != product::FastenerKind::kNone ||
           product::IsPinName(name) || IsWasherName(name);
  };
  return is_named(model.product->occurrences[id.index()].name) ||
         is_named(model.product->part_of(id).name);
}

/** A part that each part would lock out, were it there before: it stands in all of its ways.
 Fasteners do not count: whether they are needed is asked themselves. */
std::map<OccurrenceId, OccurrenceId> FindLockedOut(const Model& model, const OrderPlan& plan) {
  std::map<OccurrenceId, OccurrenceId> locked;
  for (const OrderArrow& arrow : ListArrows(plan.rules)) {
    const OccurrenceId first = plan.rules.moves[arrow.first].parts.front();
    if (arrow.is_certain && !arrow.is_implied && !IsFastener(model, first)) {
      locked.emplace(plan.rules.moves[arrow.then].parts.front(), first);
    }
  }
  return locked;
}

NeedOfPart FindNeed(const Model& model, const Coming& coming,
                    const std::map<OccurrenceId, OccurrenceId>& locked_out) {
  NeedOfPart need;
  need.is_first = coming.is_base && coming.part == sequence::FindBase(model.sequence);
  need.is_fastener = IsFastener(model, coming.part);
  if (need.is_fastener) {
    return need;
  }
  need.moves = FindTurning(model, coming.part);
  need.material = FindOtherMaterial(model, coming.part);
  if (const auto found = locked_out.find(coming.part); found != locked_out.end()) {
    need.apart = fmt::format("{} could not be put in behind it", PathOf(model, found->second));
  }
  return need;
}

/** The worksheet's row of a group. */
DfaRow RowOf(const Model& model, const RatedParts& rated) {
  const int count = static_cast<int>(rated.parts.size());
  return {PathOf(model, rated.parts.front()), count, rated.handling, rated.insertion,
          rated.need.is_needed() ? count : 0};
}

/** Tries changes of a worksheet. */
class AdviceFinder {
 public:
  AdviceFinder(const Model& model, const OrderPlan& plan, const DfaRating& rating)
      : model_(model), plan_(plan), rating_(rating) {}

  [[nodiscard]] std::vector<DfaAdvice> Find() {
    for (std::size_t i = 0; i < rating_.groups.size(); ++i) {
      const RatedParts& rated = rating_.groups[i];
      TryFewer(i, rated);
      TryChamfer(i, rated);
      TryHold(i, rated);
      TrySymmetry(i, rated);
    }
    TryOneDirection();
    std::stable_sort(advice_.begin(), advice_.end(),
                     [](const DfaAdvice& a, const DfaAdvice& b) { return a.seconds > b.seconds; });
    return std::move(advice_);
  }

 private:
  /** Reckons the worksheet with another row, and keeps what it saves. */
  void Try(std::size_t row, const DfaRow& other, const std::string& text) {
    std::vector<DfaRow> rows = rating_.sheet.rows;
    if (other.count == 0) {
      rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(row));
    } else {
      rows[row] = other;
    }
    const auto sheet = MakeDfaSheet(std::move(rows));
    if (sheet && sheet->seconds < rating_.sheet.seconds) {
      advice_.push_back({text, rating_.sheet.seconds - sheet->seconds});
    }
  }

  void TryFewer(std::size_t i, const RatedParts& rated) {
    constexpr int kEnoughScrews = 2;  // They hold a part in its plane: a choice.
    const DfaRow& row = rating_.sheet.rows[i];
    const std::string name = PathOf(model_, rated.parts.front());
    if (rated.need.is_fastener && row.count > kEnoughScrews) {
      DfaRow fewer = row;
      fewer.count = kEnoughScrews;
      Try(i, fewer,
          fmt::format("{} fasteners like {} instead of {}", kEnoughScrews, name, row.count));
    }
    if (!rated.need.is_needed()) {
      DfaRow gone = row;
      gone.count = 0;
      const std::string more = row.count == 1 ? "" : fmt::format(" (and {} more)", row.count - 1);
      Try(i, gone,
          rated.need.is_fastener
              ? fmt::format("snap fits, or one piece, instead of {}{}", name, more)
              : fmt::format("make {}{} one with a neighbour: nothing says that it has to be a part "
                            "of its own",
                            name, more));
    }
  }

  void TryChamfer(std::size_t i, const RatedParts& rated) {
    if (!rated.is_hard_to_align) {
      return;
    }
    DfaRow row = rating_.sheet.rows[i];
    char& digit = row.insertion[1];
    digit = static_cast<char>(digit == '9' ? '8' : digit - 2);
    Try(i, row,
        fmt::format("a chamfer that leads {} in{}", PathOf(model_, rated.parts.front()),
                    AndMore(rated)));
  }

  void TryHold(std::size_t i, const RatedParts& rated) {
    if (!rated.is_held) {
      return;
    }
    DfaRow row = rating_.sheet.rows[i];
    row.insertion[1] = static_cast<char>(row.insertion[1] - 6);
    Try(i, row,
        fmt::format("a shoulder or a snap that keeps {} in its place until it is secured{}",
                    PathOf(model_, rated.parts.front()), AndMore(rated)));
  }

  void TrySymmetry(std::size_t i, const RatedParts& rated) {
    if (rated.handling[0] < '2' || rated.handling[0] > '3') {
      return;
    }
    DfaRow row = rating_.sheet.rows[i];
    row.handling[0] = '1';
    Try(i, row,
        fmt::format("make {} symmetrical, end for end or about its way in{}",
                    PathOf(model_, rated.parts.front()), AndMore(rated)));
  }

  void TryOneDirection() {
    const orders::OrderCounts& counts = assembly::BestOrder(plan_).counts;
    const double seconds = orders::kModSeconds * (orders::kTurnMods * counts.turns +
                                                  orders::kOtherWayMods * counts.direction_changes);
    if (seconds > 0) {
      advice_.push_back(
          {fmt::format("all parts from one direction: {} turns of the product and {} changes of "
                       "direction less, by MODAPTS beside the worksheet",
                       counts.turns, counts.direction_changes),
           seconds});
    }
  }

  [[nodiscard]] static std::string AndMore(const RatedParts& rated) {
    return rated.parts.size() == 1 ? "" : fmt::format(" (and {} more)", rated.parts.size() - 1);
  }

  const Model& model_;
  const OrderPlan& plan_;
  const DfaRating& rating_;
  std::vector<DfaAdvice> advice_;
};

}  // namespace

Result<DfaRating> RateAssembly(const Model& model, const OrderPlan& plan) {
  DfaRating rating;
  const std::map<OccurrenceId, OccurrenceId> locked_out = FindLockedOut(model, plan);
  SymmetryFinder symmetries(*model.product);
  std::map<std::tuple<product::PartId, std::string, std::string, bool>, std::size_t> group_of;
  for (const Coming& coming : ListComing(model, plan)) {
    const product::Occurrence& occurrence = model.product->occurrences[coming.part.index()];
    RatedParts rated;
    rated.parts = {coming.part};
    rated.symmetry = symmetries.Find(coming.part, occurrence.X_WB.q().conjugate() * coming.way_W);
    RateHandling(model, coming, &rated);
    RateInsertion(model, coming, &rated);
    rated.need = FindNeed(model, coming, locked_out);
    const auto [group, is_new] = group_of.try_emplace(
        {occurrence.part, rated.handling, rated.insertion, rated.need.is_needed()},
        rating.groups.size());
    if (is_new) {
      rating.groups.push_back(std::move(rated));
    } else {
      rating.groups[group->second].parts.push_back(coming.part);
    }
  }
  std::vector<DfaRow> rows;
  for (const RatedParts& rated : rating.groups) {
    rows.push_back(RowOf(model, rated));
  }
  auto sheet = MakeDfaSheet(std::move(rows));
  if (!sheet) {
    return Unexpected(sheet.error());
  }
  rating.sheet = std::move(*sheet);
  rating.advice = AdviceFinder(model, plan, rating).Find();
  return rating;
}

}  // namespace hvas::shopfloor
