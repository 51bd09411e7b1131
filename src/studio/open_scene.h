#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/diagnostics.h"
#include "simulation/model.h"
#include "simulation/simulation.h"

namespace hvas::studio {

/** What is open: a model and all that a viewer needs of it. Immutable. */
struct OpenScene {
  std::uint32_t epoch{0};
  std::shared_ptr<const simulation::Model> model;
  Diagnostics diagnostics;
  std::shared_ptr<const std::string> glb;
  std::string glb_hash;
  std::filesystem::path file;  ///< That was opened.
  std::string name;            ///< What people call the file.
  std::string digest;          ///< CalcProductDigest of it as it was opened.
  /** Commands that have changed the product since, in their order. */
  std::vector<nlohmann::ordered_json> edits;
};

/** Of each hand: the largest force since it was asked for last [N]. */
using PeakForces = std::array<double, 2>;

/** The newest state of everything that moves. */
struct LiveFrame {
  std::uint32_t epoch{0};
  std::uint64_t serial{0};  ///< Another one for each frame.
  simulation::Frame frame;
  std::int64_t clock_ns{0};            ///< When its tick ran, by MonotonicNs().
  PeakForces peak_felt{};              ///< Since the last one [N].
  std::array<double, 2> hand_speed{};  ///< By hand, since the last one [m/s].
};

}  // namespace hvas::studio
