#pragma once

#include <string>
#include <vector>

#include "speed.h"

namespace hvas::bench {

/** How a method answers along one of the tests of accuracy. */
struct AccuracyRow {
  std::string test, method;
  double depth_error_mean{0}, depth_error_max{0};  ///< Error of the deepest contact [m].
  double force_change{0};                          ///< Largest, of the pooled force, per ms [N].
  int poses{0};
};

/** Tests C, A, P and D (shaft in bore turning, sliding over grooves, plate on plate, dowel) and
 seats on a cone, a sphere and a torus, 0.1 mm deep or nearly so, the contact moving at 50 mm/s.
 `make` gets the parts and meshes of a test: held 0, other 1. */
using MakeMethod =
    std::function<std::unique_ptr<Method>(const std::vector<BenchPart>* parts, MeshOf mesh_of)>;

struct AccuracyEntrant {
  std::string name;
  double deviation{1e-6};   ///< Deviation of the mesh that a method on triangles gets [m].
  std::size_t at_least{0};  ///< Triangles.
  int poses{200};
  MakeMethod make;
};

[[nodiscard]] std::vector<AccuracyRow> RunAccuracy(const std::vector<AccuracyEntrant>& entrants);

}  // namespace hvas::bench
