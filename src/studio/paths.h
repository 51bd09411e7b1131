#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "base/job_thread.h"
#include "base/result.h"
#include "paths/swept_volume.h"
#include "simulation/model.h"
#include "simulation/simulation.h"

namespace hvas::studio {

/** Paths of parts while they were held: for each part that of its last hold, one pose a frame, and
 fewer where the hold was long. Any thread may call it. */
class PathLog {
 public:
  /** Capacity for one part; beyond it every second pose is dropped. */
  static constexpr std::size_t kMaxPoses = 4096;

  void Add(const simulation::Frame& frame);
  void Clear();

  /** Path of a part in its last hold. */
  struct HeldPath {
    paths::Path path;       ///< Empty for a part that was never held.
    std::size_t stride{1};  ///< One frame is kept of so many in which the part moved.
  };

  [[nodiscard]] HeldPath PathOf(product::OccurrenceId id) const;

 private:
  struct Hold : HeldPath {
    std::size_t passed{0};  ///< Frames since the last one that was kept.
    spatial::Pose newest;
  };

  static void Append(const spatial::Pose& X_WB, Hold* hold);

  mutable std::mutex mutex_;
  std::map<product::OccurrenceId, Hold> holds_;
  std::vector<product::OccurrenceId> held_;  ///< Held part, indexed by hand.
};

/** A swept volume in the form that clients get. */
struct SweptGlb {
  std::string id;    ///< Digest of `glb`.
  std::string glb;   ///< Binary glTF in the conventions of cad::MakeGlb: in W, metres, Y up.
  double volume{0};  ///< [m^3]
  double error{0};   ///< Bound of the surface's error [m].
};

/** Makes the binary glTF of a closed mesh. Errors: those of cad::MakeGlb. */
[[nodiscard]] Result<std::string> MakeGlb(const paths::SurfaceMesh& mesh, const std::string& name);

/** Computes swept volumes, one after the other, on a thread of its own. */
class Sweeper {
 public:
  // Swept volumes that are asked for and not yet made, and those that are kept: choices.
  static constexpr std::size_t kMaxWaiting = 8;
  static constexpr std::size_t kMaxKept = 16;

  using DoneFn = std::function<void(const Result<std::shared_ptr<const SweptGlb>>& swept)>;

  struct Task {
    std::shared_ptr<const simulation::Model> model;
    product::OccurrenceId occurrence;
    paths::Path path;
    double resolution{0};  ///< [m]; 0: chosen.
    DoneFn done;           ///< Called on the sweeper's thread; never after Stop().
  };

  /** Queues a task. Errors: kOutOfResource when kMaxWaiting tasks wait already. */
  [[nodiscard]] Result<void> Post(Task task);

  /** Finds one of the kMaxKept volumes computed last by its id; null where there is none. */
  [[nodiscard]] std::shared_ptr<const SweptGlb> Find(std::string_view id) const;

  /** Cancels the current task and drops the queue. */
  void Stop() { thread_.Stop(); }

 private:
  void Do(const Task& task, const std::stop_token& stop);

  mutable std::mutex mutex_;
  std::deque<std::shared_ptr<const SweptGlb>> kept_;
  JobThread thread_;  ///< Last member, so that it ends before the others are destroyed.
};

}  // namespace hvas::studio
