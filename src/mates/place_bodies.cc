#include "mates/place_bodies.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "mates/limits.h"
#include "mates/mate_kind.h"

namespace hvas::mates {
namespace {

using product::MateKind;

constexpr int kMaxTries = 64;        // Combinations of senses: a choice.
constexpr std::size_t kMaxOpen = 4;  // Axes of different directions whose sense is tried. A choice.
constexpr double kParallelCosine = 0.999;  // Of axes in one body.

/** A mate between a body that is to be placed and one that is placed. */
struct HeldMateView {
  const BodyMate* mate;
  bool holds_b;
};

Vec3 AxisInBody(const HeldMateView& view) {
  return (view.holds_b ? view.mate->X_BN : view.mate->X_AM).q() * Vec3::UnitZ();
}

/** Tries the bodies one after the other. */
class BodyChain {
 public:
  BodyChain(const BodyProblem& problem, const std::vector<bool>& is_used)
      : problem_(problem),
        is_used_(is_used),
        poses_(problem.is_fixed.size()),
        is_placed_(problem.is_fixed) {}

  /** Places all bodies that mates lead to. @param choices  Which alternative to take, at each body
   that has several; the first one beyond the end. */
  void Run(const std::vector<std::size_t>& choices) {
    candidates_.assign(poses_.size(), std::nullopt);
    is_stale_.assign(poses_.size(), true);
    while (const auto best = FindMostBound()) {
      const std::vector<Pose>& alternatives = candidates_[*best]->alternatives;
      std::size_t choice = 0;
      if (alternatives.size() > 1) {
        choice = counts_.size() < choices.size() ? choices[counts_.size()] : 0;
        counts_.push_back(alternatives.size());
      }
      poses_[*best] = alternatives[std::min(choice, alternatives.size() - 1)];
      is_placed_[*best] = true;
      for (const BodyMate& mate : problem_.mates) {
        if (mate.a == *best || mate.b == *best) {
          is_stale_[mate.a] = is_stale_[mate.b] = true;
        }
      }
    }
  }

  [[nodiscard]] const std::vector<Pose>& poses() const { return poses_; }

  /** Numbers of alternatives, of the bodies with several in the order of placing. */
  [[nodiscard]] const std::vector<std::size_t>& counts() const { return counts_; }

 private:
  struct Candidate {
    std::vector<Pose> alternatives;  // The best first.
    int free_count{0};
  };

  struct Trial {
    Pose X_WB;
    bool is_fulfilled{false};
    double residual{0};
    double turn{0};  // From the drawn pose [rad].
    int free_count{0};
  };

  /** Finds the body that is free in the fewest directions of those that mates lead to. */
  [[nodiscard]] std::optional<std::size_t> FindMostBound() {
    std::optional<std::size_t> best;
    for (std::size_t body = 0; body < poses_.size(); ++body) {
      if (is_placed_[body]) {
        continue;
      }
      if (is_stale_[body]) {
        candidates_[body] = MakeCandidate(body);
        is_stale_[body] = false;
      }
      if (candidates_[body] &&
          (!best || candidates_[body]->free_count < candidates_[*best]->free_count)) {
        best = body;
      }
    }
    return best;
  }

  [[nodiscard]] std::vector<HeldMateView> ListMates(std::size_t body) const {
    std::vector<HeldMateView> views;
    for (std::size_t i = 0; i < problem_.mates.size(); ++i) {
      const BodyMate& mate = problem_.mates[i];
      if (!is_used_[i] || (mate.a != body && mate.b != body)) {
        continue;
      }
      if (is_placed_[mate.a == body ? mate.b : mate.a]) {
        views.push_back({&mate, mate.b == body});
      }
    }
    return views;
  }

  [[nodiscard]] const Pose& OtherPose(const HeldMateView& view) const {
    return poses_[view.holds_b ? view.mate->a : view.mate->b];
  }

  /** The direction that the held axis has to take, but for its sense. */
  [[nodiscard]] Vec3 AxisInWorld(const HeldMateView& view) const {
    return (OtherPose(view) * (view.holds_b ? view.mate->X_AM : view.mate->X_BN)).q() *
           Vec3::UnitZ();
  }

  /** The first of each set of parallel axes whose sense is open. */
  [[nodiscard]] static std::vector<std::size_t> FindLeaders(
      const std::vector<HeldMateView>& views) {
    std::vector<std::size_t> leader_of(views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
      leader_of[i] = i;
      for (std::size_t j = 0; j < i && views[i].mate->is_sense_open; ++j) {
        if (views[j].mate->is_sense_open && leader_of[j] == j &&
            std::abs(AxisInBody(views[i]).dot(AxisInBody(views[j]))) > kParallelCosine) {
          leader_of[i] = j;
          break;
        }
      }
    }
    return leader_of;
  }

  [[nodiscard]] std::vector<MateConstraint> MakeConstraints(
      const std::vector<HeldMateView>& views, const std::vector<std::size_t>& leader_of,
      std::uint32_t senses) const {
    std::vector<MateConstraint> constraints;
    std::vector<bool> is_turned(views.size(), false);
    std::size_t leader = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (views[i].mate->is_sense_open && leader_of[i] == i) {
        is_turned[i] = leader < kMaxOpen && ((senses >> leader) & 1U) != 0;
        ++leader;
      } else if (views[i].mate->is_sense_open) {
        const std::size_t j = leader_of[i];
        const bool is_opposed_in_body = AxisInBody(views[i]).dot(AxisInBody(views[j])) < 0;
        const bool is_opposed_in_world = AxisInWorld(views[i]).dot(AxisInWorld(views[j])) < 0;
        is_turned[i] = is_turned[j] != (is_opposed_in_body != is_opposed_in_world);
      }
      constraints.push_back(
          MakeBodyConstraint(*views[i].mate, views[i].holds_b, OtherPose(views[i]), is_turned[i]));
    }
    return constraints;
  }

  /** How far a body has to move along an axis until the middle of the shaft is in that of the hole;
   zero where they engage. */
  [[nodiscard]] Vec3 CalcEngagingShift(const HeldMateView& view, const Pose& X_WB) const {
    const BodyMate& mate = *view.mate;
    if (mate.kind != MateKind::kAxisHole || mate.hole_low == mate.hole_high) {
      return Vec3::Zero();
    }
    const Pose X_WM = (view.holds_b ? OtherPose(view) : X_WB) * mate.X_AM;
    const Pose X_WN = (view.holds_b ? X_WB : OtherPose(view)) * mate.X_BN;
    const Vec3 zhat_W = X_WM.q() * Vec3::UnitZ();
    const double sense = zhat_W.dot(X_WN.q() * Vec3::UnitZ()) < 0 ? -1.0 : 1.0;
    const double origin = zhat_W.dot(X_WN.p() - X_WM.p());
    const double one = origin + sense * mate.shaft_low;
    const double other = origin + sense * mate.shaft_high;
    const double engaged = std::min(mate.hole_high, std::max(one, other)) -
                           std::max(mate.hole_low, std::min(one, other));
    if (engaged > InferenceLimits().axial_overlap) {
      return Vec3::Zero();
    }
    const double shift = 0.5 * (mate.hole_low + mate.hole_high) - 0.5 * (one + other);
    return (view.holds_b ? shift : -shift) * zhat_W;
  }

  [[nodiscard]] Trial Try(std::size_t body, const std::vector<HeldMateView>& views,
                          const std::vector<MateConstraint>& constraints) const {
    Trial trial;
    Resolution resolution = ResolveToward(constraints, Pose(), Pose());
    for (const HeldMateView& view : views) {
      const Vec3 shift_W = CalcEngagingShift(view, resolution.X_WB);
      if (shift_W.norm() > 0) {
        const Pose goal(resolution.X_WB.q(), resolution.X_WB.p() + shift_W);
        resolution = ResolveToward(constraints, resolution.X_WB, goal);
      }
    }
    trial.X_WB = resolution.X_WB;
    trial.residual = resolution.residual;
    trial.turn = spatial::RotationVector(trial.X_WB.q()).norm();
    trial.free_count = CalcFreeTwists(constraints, trial.X_WB).count();
    std::vector<Pose> poses = poses_;
    poses[body] = trial.X_WB;
    trial.is_fulfilled = std::all_of(views.begin(), views.end(), [&](const HeldMateView& view) {
      return IsFulfilled(*view.mate, poses);
    });
    return trial;
  }

  [[nodiscard]] std::optional<Candidate> MakeCandidate(std::size_t body) const {
    const std::vector<HeldMateView> views = ListMates(body);
    if (views.empty()) {
      return std::nullopt;
    }
    const std::vector<std::size_t> leader_of = FindLeaders(views);
    std::size_t open = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
      open += views[i].mate->is_sense_open && leader_of[i] == i ? 1 : 0;
    }
    std::vector<Trial> trials;
    for (std::uint32_t senses = 0; senses < (1U << std::min(open, kMaxOpen)); ++senses) {
      trials.push_back(Try(body, views, MakeConstraints(views, leader_of, senses)));
    }
    std::stable_sort(trials.begin(), trials.end(), [](const Trial& x, const Trial& y) {
      return x.is_fulfilled != y.is_fulfilled ? x.is_fulfilled
             : x.is_fulfilled                 ? x.turn < y.turn
                                              : x.residual < y.residual;
    });
    Candidate candidate;
    candidate.free_count = trials.front().free_count;
    for (const Trial& trial : trials) {
      if (candidate.alternatives.empty() || trial.is_fulfilled) {
        candidate.alternatives.push_back(trial.X_WB);
      }
    }
    return candidate;
  }

  const BodyProblem& problem_;
  const std::vector<bool>& is_used_;
  std::vector<Pose> poses_;
  std::vector<bool> is_placed_;
  std::vector<std::size_t> counts_;
  std::vector<std::optional<Candidate>> candidates_;
  std::vector<bool> is_stale_;  // Whether mates have come to a body since its candidate was made.
};

/** The next combination of choices; false after the last one. */
bool Advance(const std::vector<std::size_t>& counts, std::vector<std::size_t>* choices) {
  choices->resize(counts.size(), 0);
  while (!choices->empty()) {
    if (choices->back() + 1 < counts[choices->size() - 1]) {
      ++choices->back();
      return true;
    }
    choices->pop_back();
  }
  return false;
}

}  // namespace

BodyMate MakeBodyMate(const product::Product& product, const product::Mate& mate) {
  BodyMate made;
  made.kind = mate.kind;
  made.X_AM = product.occurrences[mate.a.occurrence.index()].X_WB * mate.a.X_BM;
  made.X_BN = product.occurrences[mate.b.occurrence.index()].X_WB * mate.b.X_BM;
  made.hole_low = mate.hole_low;
  made.hole_high = mate.hole_high;
  made.shaft_low = mate.shaft_low;
  made.shaft_high = mate.shaft_high;
  const InferenceLimits limits;
  const double size = std::min(product.part_of(mate.a.occurrence).box_B.size().norm(),
                               product.part_of(mate.b.occurrence).box_B.size().norm());
  made.distance_limit =
      (mate.kind == MateKind::kFaceFace ? limits.plane_gap : limits.axis_distance) *
      CalcLengthScale(size);
  made.angle_limit = limits.angle;
  return made;
}

bool IsContradicted(const product::Product& product, const product::Mate& mate) {
  if (mate.origin != product::MateOrigin::kUser) {
    return false;
  }
  BodyMate made = MakeBodyMate(product, mate);
  made.b = 1;
  made.is_sense_open = made.kind == MateKind::kAxisHole;
  return !IsFulfilled(made, {Pose(), Pose()});
}

BodyPoses PlaceBodies(const BodyProblem& problem, const std::vector<bool>& is_used,
                      WorkWatch* watch) {
  std::vector<BodyMate> used;
  for (std::size_t i = 0; i < problem.mates.size(); ++i) {
    if (is_used[i]) {
      used.push_back(problem.mates[i]);
    }
  }
  const std::vector<double> weights(used.size(), 1.0);
  BodyPoses best{std::vector<Pose>(problem.is_fixed.size()), false, false};
  double least = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> choices;
  for (int i = 0; i < kMaxTries && MayGoOn(watch); ++i) {
    BodyChain chain(problem, is_used);
    chain.Run(choices);
    std::vector<Pose> poses = chain.poses();
    const auto is_fulfilled = [&] {
      return std::all_of(used.begin(), used.end(),
                         [&](const BodyMate& mate) { return IsFulfilled(mate, poses); });
    };
    if (!is_fulfilled()) {
      SolveTogether(used, weights, problem.is_fixed, &poses);
    }
    if (is_fulfilled()) {
      return {std::move(poses), true, false};
    }
    double sum = 0;
    for (const BodyMate& mate : used) {
      const MateError error = CalcError(mate, poses);
      // Angles count as lengths of the order of parts.
      constexpr double kLength = 10e-3;  // [m], as that of one mate alone in `Resolve`.
      sum += std::pow(error.distance, 2) + std::pow(kLength * error.angle, 2);
    }
    if (sum < least) {
      least = sum;
      best.X_WB = std::move(poses);
    }
    best.is_given_up = Advance(chain.counts(), &choices);
    if (!best.is_given_up) {
      break;
    }
  }
  return best;
}

}  // namespace hvas::mates
