#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "simulation/model.h"
#include "simulation/simulation.h"
#include "studio/json.h"

namespace hvas::studio {

/** An open product: its model and all that clients need of it. Immutable. */
struct OpenScene {
  std::uint32_t epoch{0};
  std::shared_ptr<const simulation::Model> model;
  Diagnostics diagnostics;
  std::shared_ptr<const std::string> glb;
  std::shared_ptr<const std::string> glb_gzip;  ///< `glb`, compressed for browsers.
  std::string glb_hash;
  std::filesystem::path file;  ///< CAD file that was opened.
  std::string name;            ///< Display name of the file.
  std::string digest;          ///< CalcProductDigest of the product as opened.
  /** Commands of the edits since it was opened, in order. */
  std::vector<Json> edits;
};

/** Largest force since the previous query, by hand [N]. */
using PeakForces = std::array<double, haptics::kMaxHands>;

/** The newest state of everything that moves. */
struct LiveFrame {
  std::uint32_t epoch{0};
  std::uint64_t serial{0};  ///< Differs for each frame.
  simulation::Frame frame;
  std::int64_t clock_ns{0};  ///< MonotonicNs() at its tick.
  PeakForces peak_felt{};    ///< Largest since the previous frame, by hand [N].
  std::array<double, haptics::kMaxHands>
      hand_speed{};                  ///< Mean since the previous frame, by hand [m/s].
  std::vector<double> deformations;  ///< Amounts, by the index in Model::deformables [m].
};

/** What a client has been shown. */
struct ShownState {
  std::vector<spatial::Pose> X_WB;  ///< Poses by occurrence; empty: none.
  std::vector<double>
      deformations;  ///< Amounts as in LiveFrame; what is missing is not deformed [m].
};

}  // namespace hvas::studio
