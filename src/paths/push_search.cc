#include "paths/push_search.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "paths/push.h"

namespace hvas::paths {
namespace {

using spatial::Pose;

constexpr double kSamePose = 0.004;  // Of the part's size: poses nearer than this are one.
constexpr double kApart = 0.06;  // Of the part's size: poses along a push from which others start.
constexpr int kDeepest = 6;      // Pushes, one after the other: a choice.
// The first step of a push over the least: most pushes are blocked at once, and are soon known to
// be.
constexpr double kFirstSteps = 4;
constexpr double kMostTurns = 60;  // Of a thread: a choice.
constexpr int kRankOfTurns = 2;    // Turns count as so many pushes more than straight ones.
// Of the part's size: a way along an axis is open where it leads so much further than before a
// turn.
constexpr double kOpening = 0.03;
// Turns whose openings are looked for: pushes before one, and its least length, of the part's size.
// Choices.
constexpr int kDeepestOpening = 1;
constexpr double kLeastTurn = 0.15;

struct PushMove {
  std::optional<Vec3> direction;
  ScrewAxis axis;
  double sign{1};
};

struct Waiting {
  int rank;  // Pushes so far; turns, and poses on the way of a push, count as more.
  std::size_t order;
  std::size_t node;
  int depth;
  int last;    // The move that led here; -1 for none.
  bool turns;  // Whether it is to be turned, or to go straight.

  bool operator<(const Waiting& o) const {
    return std::pair(rank, order) > std::pair(o.rank, o.order);
  }
};

class PushSearch {
 public:
  PushSearch(SearchState* state, const std::vector<Vec3>& directions,
             const std::vector<ScrewAxis>& axes)
      : state_(*state), probe_(*state->probe) {
    // What is given comes first.
    const std::size_t given_axes = probe_.problem().axes.size();
    const std::size_t given = std::min(directions.size(), probe_.problem().directions_W.size());
    AddStraight(directions, 0, given);
    AddTurns(axes, 0, given_axes);
    AddStraight(directions, given, directions.size());
    AddTurns(axes, given_axes, axes.size());
  }

  std::optional<Path> Run(std::uint64_t budget) {
    const std::uint64_t last = probe_.queries() + budget;
    Wait({0, 0, 0, 0, -1, false});
    if (IsThere(&state_, 0)) {
      return state_.tree.ListPath(0);
    }
    while (!waiting_.empty() && probe_.queries() < last && !probe_.is_over()) {
      const Waiting from = waiting_.top();
      waiting_.pop();
      if (from.depth == kDeepest) {
        continue;
      }
      for (int m = 0; m < static_cast<int>(moves_.size()) && probe_.queries() < last; ++m) {
        const bool is_straight = moves_[static_cast<std::size_t>(m)].direction.has_value();
        const bool is_due = m != from.last && is_straight != from.turns;
        const std::size_t there = is_due ? PushOn(from, m) : PoseTree::kNone;
        if (there != PoseTree::kNone) {
          return state_.tree.ListPath(there);
        }
      }
    }
    return std::nullopt;
  }

 private:
  // Straight pieces are tried before turns.
  void Wait(Waiting waiting) {
    waiting.order = ++order_;
    waiting_.push(waiting);
    waiting.turns = true;
    waiting.rank += kRankOfTurns;
    waiting_.push(waiting);
  }

  void AddStraight(const std::vector<Vec3>& directions, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      moves_.push_back({directions[i], {}, 1});
    }
  }

  void AddTurns(const std::vector<ScrewAxis>& axes, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      moves_.push_back({std::nullopt, axes[i], 1});
      moves_.push_back({std::nullopt, axes[i], -1});
    }
  }

  // A turn about an axis brings the part to where it was: it ends where it does not go along, too.
  [[nodiscard]] Push PushAbout(const Pose& from, const PushMove& move) {
    const Vec3 centre = from * probe_.centre_B();
    const double arm = (centre - move.axis.p_WQ).cross(move.axis.axis_W).norm() + probe_.reach();
    const double turn = 2 * 3.14159265358979 * arm;
    Push whole;
    Pose X = from;
    const double exit = probe_.CalcOverlap(from);
    for (int i = 0; i < 4 * kMostTurns; ++i) {
      PushOptions options = MakePushOptions(probe_, 0.25 * turn);
      options.first_step = i == 0 ? kFirstSteps * options.least_step : options.first_step;
      const Push push = PushPart(&probe_, X, MakePushAbout(probe_, move.axis, move.sign), options);
      whole.path.insert(whole.path.end(), push.path.begin(), push.path.end());
      whole.is_blocked = push.is_blocked;
      whole.length += push.length;
      if (push.path.empty()) {
        break;
      }
      const double along =
          (push.path.back() * probe_.centre_B() - X * probe_.centre_B()).dot(move.axis.axis_W);
      X = push.path.back();
      const bool is_thread = std::abs(along) > std::max(1e-4 * probe_.size(), probe_.grain());
      const bool is_out = exit > 0 && probe_.CalcOverlap(X) <= 0;
      if (push.is_blocked || is_out || (i >= 3 && !is_thread)) {
        break;
      }
    }
    return whole;
  }

  // Lists the poses of a turn at which the part may go along the axis, other than before the turn,
  // as a key does at the slot of its hole: the middle of each range of them.
  std::vector<std::size_t> ListOpenings(const Pose& from, const Push& turn, const Vec3& axis_W) {
    std::vector<std::size_t> openings;
    for (const double sign : {1.0, -1.0}) {
      const Vec3 along = sign * axis_W;
      PushOptions options = MakePushOptions(probe_, 0.5 * probe_.size());
      options.first_step = kFirstSteps * options.least_step;
      const Push before =
          PushPart(&probe_, from, MakePushBy(probe_, {Vec3::Zero(), along}), options);
      if (!before.is_blocked) {
        continue;
      }
      const Vec3 further = (before.length + kOpening * probe_.size()) * along;
      std::size_t first = turn.path.size();
      for (std::size_t i = 0; i < turn.path.size(); ++i) {
        const Pose& X = turn.path[i];
        const bool is_open = probe_.IsFree(Pose(X.q(), Vec3(X.p() + further)));
        first = is_open ? std::min(first, i) : first;
        const bool ends = !is_open || i + 1 == turn.path.size();
        if (ends && first < turn.path.size()) {
          openings.push_back((first + (is_open ? i : i - 1)) / 2);
          first = turn.path.size();
        }
      }
    }
    return openings;
  }

  // @returns a node that is where the part has to go; kNone if there is none.
  std::size_t PushOn(const Waiting& from, int m) {
    const PushMove& move = moves_[static_cast<std::size_t>(m)];
    const Pose X = state_.tree.node(from.node).X_WB;
    Push push;
    std::vector<std::size_t> openings;
    if (move.direction) {
      const double exit = probe_.CalcExit(X, *move.direction);
      const bool has_goal = probe_.problem().X_WB_goal.has_value();
      PushOptions options =
          MakePushOptions(probe_, has_goal ? probe_.around_W().size().norm() + probe_.size()
                                           : 1.5 * exit + 0.05 * probe_.size());
      options.first_step = kFirstSteps * options.least_step;
      push = PushPart(&probe_, X, MakePushBy(probe_, {Vec3::Zero(), *move.direction}), options);
    } else {
      push = PushAbout(X, move);
      if (from.depth <= kDeepestOpening && push.length > kLeastTurn * probe_.size()) {
        openings = ListOpenings(X, push, move.axis.axis_W);
      }
    }
    return AddPoses(from, m, push, openings);
  }

  std::size_t AddPoses(const Waiting& from, int m, const Push& push,
                       const std::vector<std::size_t>& openings) {
    std::size_t parent = from.node;
    Path via;
    double since = 0;
    Pose last = state_.tree.node(parent).X_WB;
    for (std::size_t i = 0; i < push.path.size(); ++i) {
      const Pose& X = push.path[i];
      via.push_back(X);
      since += probe_.CalcLength(probe_.CalcDisplacement(last, X));
      last = X;
      const bool is_opening = std::find(openings.begin(), openings.end(), i) != openings.end();
      const bool is_end = i + 1 == push.path.size();
      if (!is_end && !is_opening && since < kApart * probe_.size()) {
        continue;
      }
      since = 0;
      double nearest = 0;
      (void)state_.tree.FindNearest(X, &nearest);
      const bool is_new = nearest > kSamePose * probe_.size();
      parent = state_.tree.Add(parent, std::exchange(via, {}));
      if (IsThere(&state_, parent)) {
        return parent;
      }
      if (is_new) {
        const int rank = from.rank + (is_opening ? 0 : is_end ? 1 : 3);
        Wait({rank, 0, parent, from.depth + 1, is_end ? m : -1, false});
      }
    }
    return PoseTree::kNone;
  }

  SearchState& state_;
  Probe& probe_;
  std::vector<PushMove> moves_;
  std::priority_queue<Waiting> waiting_;
  std::size_t order_{0};
};

}  // namespace

bool IsThere(SearchState* state, std::size_t node) {
  Probe& probe = *state->probe;
  const Pose& X = state->tree.node(node).X_WB;
  const auto& goal = probe.problem().X_WB_goal;
  const double to_go =
      goal ? probe.CalcLength(probe.CalcDisplacement(X, *goal)) : probe.CalcOverlap(X);
  if (state->best_to_go < 0 || to_go < state->best_to_go) {
    state->best_to_go = to_go;
    state->best = node;
  }
  return to_go <= (goal ? 1e-9 : 0.0);
}

std::optional<Path> SearchByPushes(SearchState* state, const std::vector<Vec3>& directions,
                                   const std::vector<ScrewAxis>& axes, std::uint64_t budget) {
  return PushSearch(state, directions, axes).Run(budget);
}

}  // namespace hvas::paths
