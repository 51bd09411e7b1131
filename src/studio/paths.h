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
#include "simulation/model.h"
#include "simulation/simulation.h"
#include "sweep/swept_volume.h"

namespace hvas::studio {

/** The ways that parts went in a hand: of each part that of its last hold, pose by pose as frames
 come, or fewer of them where it took long. Any thread. */
class PathLog {
 public:
  static constexpr std::size_t kMostPoses = 4096;  ///< Of one part; beyond, every other one goes.

  void Add(const simulation::Frame& frame);
  void Clear();

  /** None for a part that was in no hand. */
  [[nodiscard]] sweep::Path PathOf(product::OccurrenceId id) const;

 private:
  struct Hold {
    sweep::Path path;
    std::size_t stride{1};  ///< Of so many frames in which it moved one is kept.
    std::size_t passed{0};  ///< Since the last one that was.
    spatial::Pose newest;
  };

  static void Append(const spatial::Pose& X_WB, Hold* hold);

  mutable std::mutex mutex_;
  std::map<product::OccurrenceId, Hold> holds_;
  std::vector<product::OccurrenceId> held_;  ///< By hand.
};

/** A swept volume as clients get it. */
struct SweptGlb {
  std::string id;    ///< Digest of the bytes.
  std::string glb;   ///< As cad::MakeGlb makes it: in W, metres, Y up.
  double volume{0};  ///< [m^3]
  double error{0};   ///< [m]
};

/** Writes a closed mesh as binary glTF. */
[[nodiscard]] Result<std::string> MakeGlb(const sweep::SurfaceMesh& mesh, const std::string& name);

/** Computes swept volumes, one after the other, on a thread of its own. */
class Sweeper {
 public:
  // Swept volumes that are asked for and not yet made, and those that are kept: choices.
  static constexpr std::size_t kMostWaiting = 8;
  static constexpr std::size_t kMostKept = 16;

  using DoneFn = std::function<void(const Result<std::shared_ptr<const SweptGlb>>& swept)>;

  struct Task {
    std::shared_ptr<const simulation::Model> model;
    product::OccurrenceId occurrence;
    sweep::Path path;
    double resolution{0};  ///< [m]; 0: chosen.
    DoneFn done;           ///< Called by the sweeper's thread; not after Stop.
  };

  /** Errors (kOutOfResource): so many wait already. */
  [[nodiscard]] Result<void> Post(Task task);

  /** Of those computed last; null: none of this id. */
  [[nodiscard]] std::shared_ptr<const SweptGlb> Find(std::string_view id) const;

  /** Ends what is being computed, and forgets what waits. */
  void Stop() { thread_.Stop(); }

 private:
  void Do(const Task& task, const std::stop_token& stop);

  mutable std::mutex mutex_;
  std::deque<std::shared_ptr<const SweptGlb>> kept_;
  JobThread thread_;  ///< The last member: the first that ends.
};

}  // namespace hvas::studio
