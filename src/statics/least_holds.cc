#include "statics/least_holds.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>

#include "statics/programme.h"

namespace hvas::statics {
namespace {

// Nodes of the search for the fewest bodies that hit all proofs, after which it is not known
// whether they are the fewest. A choice: some milliseconds.
constexpr int kMostNodes = 100'000;

using Group = std::vector<int>;  // Sorted.

/** The fewest bodies that hit all groups, by depth-first search with rising depth. */
class HittingSearch {
 public:
  /** @param preferences  Of bodies that hit the same, those with the higher one come first. */
  HittingSearch(const std::vector<Group>& groups, const std::vector<double>& preferences)
      : groups_(groups) {
    for (Group& group : groups_) {
      std::stable_sort(group.begin(), group.end(), [&](int a, int b) {
        return preferences[static_cast<std::size_t>(a)] > preferences[static_cast<std::size_t>(b)];
      });
    }
    is_hit_.assign(preferences.size(), false);
  }

  /** @returns none where the nodes do not suffice. `least` is the largest depth that is refuted,
   plus one. */
  std::optional<std::vector<int>> Find(int* least) {
    for (int depth = CountDisjoint();; ++depth) {
      *least = std::max(*least, depth);
      if (Descend(depth)) {
        return chosen_;
      }
      if (nodes_ > kMostNodes) {
        return std::nullopt;
      }
    }
  }

 private:
  [[nodiscard]] bool IsHit(const Group& group) const {
    return std::any_of(group.begin(), group.end(),
                       [&](int body) { return is_hit_[static_cast<std::size_t>(body)]; });
  }

  /** Groups without a body in common, picked one after the other: each needs a body of its own. */
  [[nodiscard]] int CountDisjoint() const {
    std::vector<bool> is_used(is_hit_);
    int count = 0;
    for (const Group& group : groups_) {
      const bool is_apart = std::none_of(group.begin(), group.end(), [&](int body) {
        return is_used[static_cast<std::size_t>(body)];
      });
      if (is_apart) {
        ++count;
        for (const int body : group) {
          is_used[static_cast<std::size_t>(body)] = true;
        }
      }
    }
    return count;
  }

  bool Descend(int left) {
    if (++nodes_ > kMostNodes) {
      return false;
    }
    const Group* smallest = nullptr;
    for (const Group& group : groups_) {
      if (!IsHit(group) && (smallest == nullptr || group.size() < smallest->size())) {
        smallest = &group;
      }
    }
    if (smallest == nullptr) {
      return true;
    }
    if (CountDisjoint() > left) {
      return false;
    }
    for (const int body : *smallest) {
      is_hit_[static_cast<std::size_t>(body)] = true;
      chosen_.push_back(body);
      if (Descend(left - 1)) {
        return true;
      }
      chosen_.pop_back();
      is_hit_[static_cast<std::size_t>(body)] = false;
    }
    return false;
  }

  std::vector<Group> groups_;
  std::vector<bool> is_hit_;
  std::vector<int> chosen_;
  int nodes_{0};
};

std::vector<bool> MarkBodies(const std::vector<int>& bodies, std::size_t count) {
  std::vector<bool> is_marked(count, false);
  for (const int body : bodies) {
    is_marked[static_cast<std::size_t>(body)] = true;
  }
  return is_marked;
}

/** Adds what each programme holds until all stands, then takes holds away that are not needed. */
Result<void> HoldGreedily(Programme* programme, std::vector<bool> is_held, LeastHolds* holds) {
  for (;;) {
    auto answer = programme->Solve(is_held);
    ++holds->programmes;
    if (!answer) {
      return Unexpected(answer.error());
    }
    if (answer->stands) {
      break;
    }
    const std::vector<bool> before = is_held;
    for (std::size_t i = 0; i < is_held.size(); ++i) {
      is_held[i] = is_held[i] || (answer->moves[i] && programme->hold_sizes()[i] > 0);
    }
    if (is_held == before) {
      is_held.assign(is_held.size(), true);  // Rounding hides what moves.
    }
  }
  for (std::size_t i = 0; i < is_held.size(); ++i) {
    if (!is_held[i]) {
      continue;
    }
    is_held[i] = false;
    auto answer = programme->Solve(is_held);
    ++holds->programmes;
    if (!answer) {
      return Unexpected(answer.error());
    }
    is_held[i] = !answer->stands;
  }
  for (std::size_t i = 0; i < is_held.size(); ++i) {
    if (is_held[i]) {
      holds->bodies.push_back(static_cast<int>(i));
    }
  }
  holds->is_proven = static_cast<int>(holds->bodies.size()) == holds->least;
  return {};
}

}  // namespace

Result<LeastHolds> FindLeastHolds(const StaticProblem& problem, const StaticOptions& options) {
  if (auto checked = CheckProblem(problem); !checked) {
    return Unexpected(checked.error());
  }
  const std::size_t count = problem.bodies.size();
  Programme programme(problem, options);
  LeastHolds holds;
  std::vector<Group> proofs;
  std::vector<double> preferences(count, 0);
  std::vector<int> chosen;
  while (holds.programmes < options.most_programmes) {
    auto answer = programme.Solve(MarkBodies(chosen, count));
    ++holds.programmes;
    if (!answer) {
      return Unexpected(answer.error());
    }
    if (chosen.empty()) {
      holds.unheld = *answer;
    }
    if (answer->stands) {
      std::sort(chosen.begin(), chosen.end());
      holds.bodies = std::move(chosen);
      holds.is_proven = true;
      return holds;
    }
    if (programme.moving_groups().empty()) {
      break;  // Rounding hides the proof.
    }
    proofs.insert(proofs.end(), programme.moving_groups().begin(), programme.moving_groups().end());
    for (std::size_t i = 0; i < count; ++i) {
      preferences[i] += answer->moves[i] ? programme.hold_sizes()[i] : 0;
    }
    HittingSearch search(proofs, preferences);
    auto hit = search.Find(&holds.least);
    if (!hit) {
      break;
    }
    chosen = *std::move(hit);
  }
  if (auto held = HoldGreedily(&programme, MarkBodies(chosen, count), &holds); !held) {
    return Unexpected(held.error());
  }
  return holds;
}

}  // namespace hvas::statics
