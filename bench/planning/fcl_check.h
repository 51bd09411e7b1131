#pragma once

#include <memory>

#include "puzzles.h"

namespace hvas::bench {

struct FclFinding {
  std::size_t samples{0}, colliding{0};
};

/** The meshes of a puzzle in FCL's trees of OBBRSS. */
class FclPair {
 public:
  explicit FclPair(const Puzzle& puzzle);
  ~FclPair();
  FclPair(const FclPair&) = delete;
  FclPair& operator=(const FclPair&) = delete;

  /** Whether a triangle of the part meets one of what is around it. */
  [[nodiscard]] bool Collides(const spatial::Pose& X_WB) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/** Asks FCL along a way, every `step` [m] and at most `most` times, evenly. */
[[nodiscard]] FclFinding CheckByFcl(const Puzzle& puzzle, const paths::Path& path, double step,
                                    std::size_t most);

}  // namespace hvas::bench
