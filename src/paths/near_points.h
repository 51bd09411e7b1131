#pragma once

#include <span>
#include <vector>

#include "paths/probe.h"

namespace hvas::paths {

/** Samples of the part and of others that are near each other, taken evenly over their faces, as
 measures of play need them: a query's contacts are the deepest ones. */
class NearPoints {
 public:
  explicit NearPoints(const Probe& probe);

  /** Lists what is nearer than `near` [m] at a pose of the part. */
  void Find(const spatial::Pose& X_WB, double near);

  [[nodiscard]] std::span<const NearPoint> list() const { return list_; }

  /** The least distance of what is listed; infinite where nothing is. */
  [[nodiscard]] double CalcLeast() const;

 private:
  struct Samples {
    const contact::Shape* shape{nullptr};
    contact::BodyId body;
    spatial::Pose X_WS;      // Of a body that stands.
    std::vector<Vec3> p_SQ;  // [m]
  };

  static Samples MakeSamples(const contact::Shape& shape);
  void AddNear(const Samples& of, const spatial::Pose& X_WO, const Samples& to,
               const spatial::Pose& X_WF, double near);

  Samples part_;
  std::vector<Samples> bodies_;
  std::vector<NearPoint> list_;
};

}  // namespace hvas::paths
