#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "spatial/pose.h"

namespace hvas::device {

/** What a device can do and show. SI; 0 where it has none. A driver puts in what the device itself
 tells at run time; the rest comes from data/devices. */
struct DeviceProfile {
  std::string id;                       ///< Key, as `touch`; empty for the simulated device.
  std::string name;                     ///< What a person calls it.
  double max_force{7.9};                ///< Peak [N].
  double continuous_force{1.75};        ///< That the motors stand for ever [N].
  double max_torque{0.4};               ///< Peak [N m]; 0 for three actuated axes.
  double continuous_torque{0.1};        ///< [N m]
  double max_stiffness{1000};           ///< [N/m]
  double max_damping{8};                ///< [N s/m]
  double max_rotational_stiffness{3};   ///< [N m/rad]
  double max_rotational_damping{0.02};  ///< [N m s/rad]
  double position_resolution{23e-6};    ///< [m]
  double rotation_resolution{1e-3};     ///< [rad]
  /** The device's base frame D in the user's U: x to the right, y away, z up. */
  Quat q_UD{Quat::Identity()};
  Vec3 workspace{0.16, 0.12, 0.12};  ///< Edges of the usable box, centred at D's origin [m].
  double rate_hz{1000};              ///< Rate of its servo.
  double mass{0.1};                  ///< Felt at the handle [kg].
  double inertia{2e-4};              ///< Inertia about the handle's point [kg m^2].
  double damping{0.3};               ///< Damping of the mechanism alone [N s/m].
  double rotational_damping{5e-4};   ///< [N m s/rad]
  double friction{0.06};             ///< Coulomb's, of the mechanism [N].
  double rotational_friction{1e-3};  ///< [N m]
  double delay{1e-3};                ///< Time from a sample to the force that answers it [s].
};

/** Where a figure of a profile is from. */
struct ProfileSource {
  std::string source;
  bool is_verified{false};  ///< Against the device or its own documents.
};

/** A profile as data/devices has it, with the source of each figure by its key. */
struct SourcedProfile {
  DeviceProfile profile;
  std::string driver;               ///< Name of the driver that opens such devices.
  std::vector<std::string> models;  ///< What the device calls itself.
  std::map<std::string, ProfileSource> sources;
};

/** Reads one profile (data/schemas/device_profile.schema.json).
 Errors: kUnreadable, kInvalid; both name `where` and the key. */
Result<SourcedProfile> ParseProfile(std::string_view json, const std::string& where);

/** Checks that a device can be as a profile says, wherever its figures come from: a file, a
 plug-in, the network, a vendor's library. Errors: kInvalid names `where`, the key of the figure,
 its value and what it may be. */
[[nodiscard]] Result<void> CheckProfile(const DeviceProfile& profile, const std::string& where);

/** All profiles that HVAS brings along, by id. */
[[nodiscard]] const std::vector<SourcedProfile>& KnownProfiles();

/** Finds a profile by id, or by what a device calls itself; null where nothing is known. */
[[nodiscard]] const SourcedProfile* FindProfile(std::string_view id);
[[nodiscard]] const SourcedProfile* FindProfileOfModel(std::string_view driver,
                                                       std::string_view model);

/** Finds among a driver's devices the one with this id, or the first one when `id` is empty; null
 where there is none. */
[[nodiscard]] const SourcedProfile* FindProfileOfDriver(std::string_view driver,
                                                        std::string_view id = {});

}  // namespace hvas::device
