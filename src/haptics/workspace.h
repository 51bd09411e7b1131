#pragma once

#include <limits>

#include "device/device.h"
#include "haptics/workspace_mapping.h"

namespace hvas::haptics {

/** The device's room in the scene, and how one gets beyond it. */
struct WorkspaceOptions {
  WorkspaceMapping mapping;  ///< Mapping at first.
  /** Edges of the box that the handle moves in, about D's origin [m]; infinite: no border. */
  Vec3 box{Vec3::Constant(std::numeric_limits<double>::infinity())};
  double border_speed{0.4};  ///< Speed of the scene with the handle at the very edge [m/s].
  double border_force{1.2};  ///< That the border pushes back with there [N].
  double border_share{0.2};  ///< Share of each half edge that belongs to the border.
};

/** Maps the handle to the hand in the scene (X5). Inside the box the hand follows the handle; in
 the border it also drifts on, the faster the further out, against a soft spring that is felt
 (bubble technique: Dominjon et al., World Haptics 2005). While the clutch is pressed the hand stays
 where it is, and the handle can be brought to a better place; after a gap in the samples the hand
 goes on from where it was. The hand never jumps, whatever the handle does. RT-safe. */
class Workspace {
 public:
  explicit Workspace(const WorkspaceOptions& options)
      : options_(options), mapping_(options.mapping) {}

  /** The hand for a valid sample. */
  [[nodiscard]] Hand Update(const device::DeviceState& state, double dt) noexcept;

  /** There is no valid sample: the next one goes on from the last hand. */
  void Lose() noexcept { is_lost_ = has_hand_; }

  /** The wrench on the handle in D, with what the border adds. */
  [[nodiscard]] spatial::Wrench ToDevice(const spatial::Wrench& F_H_W) const noexcept;

  [[nodiscard]] const WorkspaceMapping& mapping() const noexcept { return mapping_; }

  /** How fast the border moves the scene under the hand, in D [m/s of the scene]. */
  [[nodiscard]] const Vec3& drift_D() const noexcept { return drift_D_; }

  [[nodiscard]] bool is_in_border() const noexcept { return !border_.isZero(); }

 private:
  /** Changes the mapping so that this handle is at the last hand. */
  void Index(const spatial::Pose& X_DH) noexcept;

  WorkspaceOptions options_;
  WorkspaceMapping mapping_;
  Hand hand_;
  Vec3 border_{Vec3::Zero()};  ///< How far into the border, outwards; 1 at the edge.
  Vec3 drift_D_{Vec3::Zero()};
  bool has_hand_{false};
  bool is_lost_{false};
};

}  // namespace hvas::haptics
