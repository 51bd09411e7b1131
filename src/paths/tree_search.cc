#include "paths/tree_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "base/random.h"
#include "paths/check_way.h"
#include "paths/push.h"
#include "paths/shorten_way.h"

namespace hvas::paths {
namespace {

using spatial::Box;
using spatial::Pose;

constexpr double kNodesApart = 0.05;    // Of the part's size, along a push: a choice.
constexpr double kLongestGrowth = 0.4;  // Of the part's size: a push towards a sample.
constexpr double kShareLocal = 0.35;    // Of pushes from a new place in a random direction.
constexpr double kShareEscape = 0.15;   // Of new nodes from which a straight way out is tried.
constexpr double kFirstDomain = 0.6;    // Of the part's size: limit of a node that failed once.
constexpr double kLeastDomain = 0.1;    // Of the part's size: limits shrink no further: a choice.
constexpr double kDomainShrink = 0.7;   // Factor of a limit for each further failure: a choice.
constexpr double kCell = 0.08;          // Of the part's size: cells in which novelty is counted.

class TreeSearch {
 public:
  TreeSearch(SearchState* state, const std::vector<Vec3>& directions,
             const std::vector<ScrewAxis>& axes, const WayOptions& options)
      : state_(*state),
        probe_(*state->probe),
        directions_(directions),
        axes_(axes),
        random_(options.seed) {
    const auto& goal = probe_.problem().X_WB_goal;
    if (goal) {
      goal_tree_.emplace(probe_, *goal);
    }
    region_W_ = probe_.around_W();
    const double beyond = (goal ? 0.35 : 0.8) * probe_.size();
    const auto add = [&](const Pose& X) {
      const Vec3 c = X * probe_.centre_B();
      region_W_.Add(Box{c, c});
    };
    add(probe_.problem().X_WB_start);
    if (goal) {
      add(*goal);
    }
    region_W_ = region_W_.Expanded(beyond);
    for (std::size_t i = 0; i < state_.tree.size(); ++i) {
      Count(0, i);
    }
    if (goal_tree_) {
      Count(1, 0);
    }
  }

  std::optional<Path> Run() {
    std::size_t side = 0;
    while (!probe_.is_over()) {
      if (goal_tree_) {
        // The smaller tree grows, so that one in the open does not take all.
        side = tree(0).size() <= tree(1).size() ? 0 : 1;
        side = random_.Uniform() < 0.25 ? 1 - side : side;
      }
      const std::size_t grown =
          random_.Uniform() < kShareLocal ? GrowLocally(side) : GrowToSample(side);
      if (grown == PoseTree::kNone) {
        continue;
      }
      std::optional<Path> way = goal_tree_ ? Connect(side, grown) : FindOut(grown);
      if (way) {
        return way;
      }
    }
    return std::nullopt;
  }

 private:
  PoseTree& tree(std::size_t side) { return side == 0 ? state_.tree : *goal_tree_; }

  [[nodiscard]] std::uint64_t CellOf(const Pose& X) const {
    const double cell = kCell * probe_.size();
    const Vec3 c = X * probe_.centre_B() / cell;
    // Two directions of the part as coarse as the cells, by its gyration.
    const Vec3 u = X.q() * Vec3(probe_.gyration() / cell, 0, 0);
    const Vec3 v = X.q() * Vec3(0, probe_.gyration() / cell, 0);
    std::uint64_t hash = 1469598103934665603ULL;
    for (const double value : {c.x(), c.y(), c.z(), u.x(), u.y(), u.z(), v.x(), v.y(), v.z()}) {
      hash ^= static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value)));
      hash *= 1099511628211ULL;
    }
    return hash;
  }

  void Count(std::size_t side, std::size_t node) {
    ++visits_[side][CellOf(tree(side).node(node).X_WB)];
  }

  [[nodiscard]] Quat SampleTurn() {
    // Uniform: Shoemake, Uniform random rotations, 1992.
    const double a = random_.Uniform(), b = 2 * std::numbers::pi * random_.Uniform(),
                 c = 2 * std::numbers::pi * random_.Uniform();
    const double r = std::sqrt(1 - a), s = std::sqrt(a);
    return {s * std::cos(c), r * std::sin(b), r * std::cos(b), s * std::sin(c)};
  }

  [[nodiscard]] Vec3 SampleDirection() {
    return Vec3(random_.Normal(), random_.Normal(), random_.Normal()).normalized();
  }

  [[nodiscard]] Pose Sample() {
    Vec3 c;
    for (int i = 0; i < 3; ++i) {
      c[i] = random_.Uniform(region_W_.low[i], region_W_.high[i]);
    }
    const Quat q = SampleTurn();
    return {q, Vec3(c - q * probe_.centre_B())};
  }

  /** Adds the poses of a push; returns the last node, or kNone. */
  std::size_t AddPush(std::size_t side, std::size_t from, const Push& push) {
    std::size_t parent = from;
    std::size_t added = PoseTree::kNone;
    Path via;
    double since = 0;
    Pose last = tree(side).node(from).X_WB;
    for (std::size_t i = 0; i < push.path.size(); ++i) {
      const Pose& X = push.path[i];
      via.push_back(X);
      since += probe_.CalcLength(probe_.CalcDisplacement(last, X));
      last = X;
      if (i + 1 < push.path.size() && since < kNodesApart * probe_.size()) {
        continue;
      }
      if (since < 0.02 * kNodesApart * probe_.size() && !push.is_reached) {
        break;
      }
      since = 0;
      parent = tree(side).Add(parent, std::exchange(via, {}));
      Count(side, parent);
      added = parent;
    }
    return added;
  }

  std::size_t GrowToSample(std::size_t side) {
    const Pose X_sample = Sample();
    double distance = 0;
    const std::size_t nearest = tree(side).FindNearest(X_sample, &distance);
    PoseTree::Node& node = tree(side).node(nearest);
    if (node.domain > 0 && distance > node.domain) {
      return PoseTree::kNone;
    }
    PushOptions options = MakePushOptions(probe_, kLongestGrowth * probe_.size());
    options.ends_in_gain = true;
    options.least_step *= random_.Uniform() < 0.8 ? 3 : 1;
    const Push push = PushPart(&probe_, node.X_WB, MakePushTo(probe_, X_sample), options);
    const bool has_grown = push.length > 0.5 * kNodesApart * probe_.size();
    if (!has_grown) {
      const double least = kLeastDomain * probe_.size();
      node.domain = node.domain > 0 ? std::max(least, kDomainShrink * node.domain)
                                    : kFirstDomain * probe_.size();
    } else if (node.domain > 0) {
      node.domain /= kDomainShrink;
    }
    return has_grown ? AddPush(side, nearest, push) : PoseTree::kNone;
  }

  /** Of some nodes, the one whose cell is the least known. */
  [[nodiscard]] std::size_t PickNovel(std::size_t side) {
    constexpr int kCandidates = 12;  // A choice.
    std::size_t best = 0;
    double least = 1e300;
    for (int i = 0; i < kCandidates; ++i) {
      const auto k =
          static_cast<std::size_t>(random_.Uniform() * static_cast<double>(tree(side).size()));
      const PoseTree::Node& node = tree(side).node(k);
      if (node.is_dead) {
        continue;
      }
      const double known = visits_[side][CellOf(node.X_WB)] + 2.0 * node.tries;
      if (known < least) {
        least = known;
        best = k;
      }
    }
    return best;
  }

  [[nodiscard]] WantedPose MakeRandomPush(std::size_t side, std::size_t from) {
    const PoseTree::Node& node = tree(side).node(from);
    const double kind = random_.Uniform();
    if (kind < 0.3 && node.parent != PoseTree::kNone) {
      // On as it came, with some noise.
      Displacement d = probe_.CalcDisplacement(tree(side).node(node.parent).X_WB, node.X_WB);
      const double noise = 0.3 * probe_.CalcLength(d);
      d.v_W += noise * SampleDirection();
      d.w_W += noise / probe_.gyration() * SampleDirection();
      return MakePushBy(probe_, d);
    }
    if (kind < 0.5) {
      return MakePushBy(probe_, {Vec3::Zero(), SampleDirection()});
    }
    if (kind < 0.6 && !directions_.empty()) {
      return MakePushBy(probe_, {Vec3::Zero(), directions_[Pick(directions_.size())]});
    }
    if (kind < 0.7 && !axes_.empty()) {
      // About a line of the part, where it is now.
      const Pose moved = node.X_WB * probe_.problem().X_WB_start.Inverse();
      ScrewAxis axis = axes_[Pick(axes_.size())];
      axis.p_WQ = moved * axis.p_WQ;
      axis.axis_W = moved.q() * axis.axis_W;
      return MakePushAbout(probe_, axis, random_.Uniform() < 0.5 ? 1 : -1);
    }
    const double turn = kind < 0.8 ? 1 : random_.Uniform();
    return MakePushBy(probe_, {Vec3(turn / probe_.gyration() * SampleDirection()),
                               Vec3((1 - turn) * SampleDirection())});
  }

  [[nodiscard]] std::size_t Pick(std::size_t count) {
    return std::min(count - 1,
                    static_cast<std::size_t>(random_.Uniform() * static_cast<double>(count)));
  }

  std::size_t GrowLocally(std::size_t side) {
    const std::size_t from = PickNovel(side);
    ++tree(side).node(from).tries;
    const double longest = probe_.size() * std::pow(10.0, random_.Uniform(-1.5, 0));
    PushOptions options = MakePushOptions(probe_, longest);
    options.first_step = std::min(options.first_step, 0.25 * longest);
    options.least_step *= random_.Uniform() < 0.8 ? 3 : 1;
    const Push push =
        PushPart(&probe_, tree(side).node(from).X_WB, MakeRandomPush(side, from), options);
    return push.path.empty() ? PoseTree::kNone : AddPush(side, from, push);
  }

  /** Checks what was found, and forgets what does not hold. */
  std::optional<Path> Confirm(const Path& path, std::size_t node0, std::size_t node1) {
    std::size_t edge = 0;
    std::optional<Path> way = RepairWay(&probe_, path, CheckStepOf(probe_.tolerance()), &edge);
    if (!way && !probe_.is_over()) {
      const std::size_t count0 = tree(0).ListPath(node0).size();
      if (edge + 1 < count0) {
        tree(0).Kill(tree(0).FindNodeOf(node0, edge + 1));
      } else if (node1 != PoseTree::kNone) {
        const std::size_t from_goal = path.size() - 1 - edge;  // Pose index from the goal's end.
        if (from_goal > 0) {
          const std::size_t blocked = tree(1).FindNodeOf(node1, from_goal);
          if (blocked != 0) {
            tree(1).Kill(blocked);
          }
        }
      }
    }
    return way;
  }

  std::optional<Path> Connect(std::size_t side, std::size_t grown) {
    const std::size_t other = 1 - side;
    if (side == 0) {
      (void)IsThere(&state_, grown);
    }
    const Pose X = tree(side).node(grown).X_WB;
    double distance = 0;
    const std::size_t nearest = tree(other).FindNearest(X, &distance);
    PushOptions options = MakePushOptions(probe_, 3 * distance + probe_.size());
    options.ends_in_gain = true;
    options.least_step *= 3;
    const Push push =
        PushPart(&probe_, tree(other).node(nearest).X_WB, MakePushTo(probe_, X), options);
    const std::size_t met = AddPush(other, nearest, push);
    if (met == PoseTree::kNone || !push.is_reached) {
      return std::nullopt;
    }
    const std::size_t node0 = side == 0 ? grown : met;
    const std::size_t node1 = side == 0 ? met : grown;
    Path path = tree(0).ListPath(node0);
    Path back = tree(1).ListPath(node1);
    path.insert(path.end(), back.rbegin() + 1, back.rend());
    return Confirm(path, node0, node1);
  }

  std::optional<Path> FindOut(std::size_t grown) {
    if (IsThere(&state_, grown)) {
      return Confirm(tree(0).ListPath(grown), grown, PoseTree::kNone);
    }
    if (random_.Uniform() > kShareEscape) {
      return std::nullopt;
    }
    const Pose X = tree(0).node(grown).X_WB;
    const Vec3 outward = X * probe_.centre_B() - probe_.around_W().centre();
    Vec3 direction = random_.Uniform() < 0.5 && !directions_.empty()
                         ? directions_[Pick(directions_.size())]
                         : SampleDirection();
    if (direction.dot(outward) < 0 && random_.Uniform() < 0.7) {
      direction = -direction;
    }
    const double exit = probe_.CalcExit(X, direction) + 1e-9;
    const double step = probe_.size() / 48;
    for (double s = step; s < exit + step; s += step) {
      if (!probe_.IsFree(Pose(X.q(), Vec3(X.p() + std::min(s, exit) * direction)))) {
        return std::nullopt;
      }
    }
    const std::size_t out =
        state_.tree.Add(grown, {Pose(X.q(), Vec3(X.p() + (exit + 1e-6) * direction))});
    return IsThere(&state_, out) ? Confirm(tree(0).ListPath(out), out, PoseTree::kNone)
                                 : std::nullopt;
  }

  SearchState& state_;
  Probe& probe_;
  const std::vector<Vec3>& directions_;
  const std::vector<ScrewAxis>& axes_;
  Random random_;
  std::optional<PoseTree> goal_tree_;
  Box region_W_;
  // Looked up only, never listed.
  std::array<std::unordered_map<std::uint64_t, std::uint32_t>, 2> visits_;
};

}  // namespace

std::optional<Path> SearchByTree(SearchState* state, const std::vector<Vec3>& directions,
                                 const std::vector<ScrewAxis>& axes, const WayOptions& options) {
  return TreeSearch(state, directions, axes, options).Run();
}

}  // namespace hvas::paths
