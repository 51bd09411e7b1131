#include "paths/clearance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "contact/scene.h"

namespace hvas::paths {
namespace {

using contact::Scene;
using spatial::Pose;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/** Distances of a part to one neighbour, pose by pose. */
class DistanceSearch {
 public:
  DistanceSearch(const contact::Shape& part, const Path& path, contact::QueryWorkspace* workspace)
      : part_(part), path_(path), workspace_(workspace) {
    for (std::size_t i = 1; i < path.size(); ++i) {
      longest_step_ = std::max(longest_step_, CalcLargestMove(path[i - 1], path[i], part.box_B()));
    }
  }

  /** Finds the least distance below a bound; its distance is infinite where none is below. */
  [[nodiscard]] Clearance FindLeast(const Neighbour& neighbour, double bound) {
    Scene scene;
    // The neighbour's shape outlives the scene, which does not own it.
    scene.Add(std::shared_ptr<const contact::Shape>(std::shared_ptr<void>(), neighbour.shape),
              neighbour.X_WN);
    Clearance least;
    least.distance = kInfinite;
    double reach = longest_step_;
    for (std::size_t i = 0; i < path_.size();) {
      const double best = std::min(bound, least.distance);
      const double margin = std::isinf(best) ? kFar : std::max(0.0, best) + reach;
      const double distance = Measure(scene, i, margin);
      if (distance < best) {
        least.distance = distance;
        least.pose = i;
        SetPlace(&least);
      }
      // No pose is nearer before a point has moved by what the distance is above the best one.
      const bool is_beyond = std::isinf(distance);
      const double spare = is_beyond ? reach : distance - std::min(best, distance);
      reach = is_beyond ? 2 * reach : longest_step_;
      i = FindNext(i, spare);
    }
    return least;
  }

 private:
  static constexpr double kFar = 1e3;  // Larger than any product [m].

  /** Distance at a pose, infinite where it is above the margin. */
  [[nodiscard]] double Measure(const Scene& scene, std::size_t i, double margin) {
    contact::QueryOptions options;
    options.margin = margin;
    options.point_budget = std::numeric_limits<std::uint32_t>::max() / 2;
    scene.Query(part_, path_[i], options, workspace_);
    return workspace_->deepest();
  }

  void SetPlace(Clearance* least) const {
    const std::span<const contact::Contact> contacts = workspace_->contacts();
    const auto nearest =
        std::min_element(contacts.begin(), contacts.end(),
                         [](const auto& x, const auto& y) { return x.distance < y.distance; });
    if (nearest != contacts.end()) {
      least->p_WC = nearest->p_WC;
      least->nhat_W = nearest->nhat_W;
    }
  }

  /** The first later pose to which a point of the part moves by more than `spare`. */
  [[nodiscard]] std::size_t FindNext(std::size_t i, double spare) const {
    std::size_t next = i + 1;
    while (next < path_.size() && CalcLargestMove(path_[i], path_[next], part_.box_B()) <= spare) {
      ++next;
    }
    return next;
  }

  const contact::Shape& part_;
  const Path& path_;
  contact::QueryWorkspace* workspace_;
  double longest_step_{0};  // Between two poses [m].
};

}  // namespace

Result<std::vector<Clearance>> CalcClearances(const contact::Shape& part, const Path& path,
                                              const std::vector<Neighbour>& neighbours,
                                              const ClearanceOptions& options) {
  if (path.empty()) {
    return Fail(ErrorCode::kInvalid, "the path has no pose", "", "give at least one pose");
  }
  contact::QueryWorkspace workspace;
  DistanceSearch search(part, path, &workspace);
  std::vector<Clearance> nearest;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    if (options.stop.stop_requested()) {
      return Fail(ErrorCode::kCancelled, "the calculation was stopped", "", "");
    }
    if (options.progress) {
      options.progress(static_cast<double>(i) / static_cast<double>(neighbours.size()));
    }
    const bool is_full = nearest.size() == options.count;
    const double bound = is_full ? nearest.back().distance : kInfinite;
    Clearance found = search.FindLeast(neighbours[i], bound);
    if (!(found.distance < bound)) {
      continue;
    }
    found.neighbour = i;
    const auto place =
        std::upper_bound(nearest.begin(), nearest.end(), found,
                         [](const auto& x, const auto& y) { return x.distance < y.distance; });
    nearest.insert(place, found);
    if (nearest.size() > options.count) {
      nearest.pop_back();
    }
  }
  return nearest;
}

}  // namespace hvas::paths
