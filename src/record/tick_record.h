#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "spatial/pose.h"

namespace hvas::record {

inline constexpr std::uint32_t kNoOccurrence = std::numeric_limits<std::uint32_t>::max();

/** The place [m] and the normal of a contact are multiples of it: no picture shows a micrometre. */
inline constexpr double kContactStep = 0x1p-20;

/** One contact of a tick, in single precision: for display and statistics, not for replay. */
struct ContactRecord {
  Eigen::Vector3f p_WC{Eigen::Vector3f::Zero()};    ///< [m]
  Eigen::Vector3f nhat_W{Eigen::Vector3f::Zero()};  ///< Out of the part that is touched.
  float distance{0};                                ///< [m]; negative is penetration.
};

/** Bits of TickRecord::device_flags. */
inline constexpr std::uint32_t kDeviceGripping = 1;
inline constexpr std::uint32_t kDeviceClutching = 1u << 1;
inline constexpr std::uint32_t kDeviceNotValid = 1u << 2;  ///< It had no pose.

/** All that a haptic tick took in and gave out, by which it can be replayed and judged. What the
 clock of the machine decides (compute time) is not here: equal sessions have equal records. Fields
 after the contacts came with schema 2, the last one with schema 3; in older records they are as
 below. */
struct TickRecord {
  /** The two that press most; all would be the larger part of a record. */
  static constexpr int kContacts = 2;

  std::int64_t t_ns{0};               ///< Session time.
  spatial::Pose device_pose;          ///< Handle in the device's base frame, as the device gave it.
  spatial::Twist device_twist;        ///< Likewise [rad/s, m/s].
  std::uint32_t device_flags{0};      ///< Bit mask: kDeviceGripping and so on.
  std::uint32_t status{0};            ///< Bit mask of what the tick had to report; 0: all well.
  spatial::Pose X_WH;                 ///< Tracked: the hand in the world.
  spatial::Pose X_WD;                 ///< Displayed: where the held part (or the pointer) is shown.
  spatial::Wrench F_true_W;           ///< The true wrench, about Do [N m, N].
  spatial::Wrench F_felt_W;           ///< The wrench that the hand was given, about Do [N m, N].
  std::uint32_t held{kNoOccurrence};  ///< Occurrence in the hand.
  std::uint8_t state{0};              ///< State of the held part.
  std::uint16_t contact_count{0};     ///< Contacts found; the deepest ones are kept below.
  double depth{0};                    ///< Insertion depth [m], growing inwards.
  double deepest{std::numeric_limits<double>::infinity()};  ///< Smallest gap met [m].
  std::array<ContactRecord, kContacts> contacts{};
  std::uint8_t hand{0};              ///< Whose tick; hands of a period follow one another.
  std::int64_t sample_ns{0};         ///< When the device took the sample, by its clock; 0: now.
  std::uint32_t device_buttons{0};   ///< Bit mask; the first one is bit 0.
  std::uint8_t device_condition{0};  ///< device::Condition; 0: ready.
  std::int32_t vendor_code{0};       ///< What the device's own software said last.
  double device_grip{std::numeric_limits<double>::quiet_NaN()};  ///< 0 open .. 1 closed; NaN: none.
  std::int64_t model_age_ns{0};   ///< Since the physics loop last answered.
  std::int64_t client_age_ns{0};  ///< Since whoever steers from afar was last heard of.
  std::uint8_t effort_level{0};   ///< What the tick left out to be in time; 0: nothing.
  std::uint32_t commands{0};      ///< Obeyed before it, of all since the stretch began.
};

/** The tick in the steps of a record (spatial/rounding.h): all that has a unit but times, grips and
 what is counted. */
[[nodiscard]] TickRecord Rounded(const TickRecord& tick) noexcept;

/** Something that happened, with what is worth knowing about it. */
struct Event {
  std::int64_t t_ns{0};                     ///< Session time.
  std::string kind;                         ///< Stable key, for example "seated".
  std::uint32_t occurrence{kNoOccurrence};  ///< The part that it is about, if any.
  std::string json;                         ///< Details as a JSON object; may be empty.
};

/** What reached the ticks from outside, between one and the next: the first of a stretch begins it,
 the others follow by their number. What it says is between those who write and who replay it. */
struct Command {
  std::int64_t t_ns{0};    ///< Session time.
  std::int64_t number{0};  ///< 0 begins a stretch; TickRecord::commands counts the others.
  std::string kind;        ///< Stable key, for example "take".
  std::string json;        ///< Details as a JSON object, numbers exact to the last bit.
};

/** What a viewer was shown; this room does not look into it. */
struct Frame {
  std::int64_t t_ns{0};  ///< Session time.
  std::vector<std::byte> bytes;
};

/** A file that goes with the record: the product, or what a viewer needs to show it. */
struct Attachment {
  std::string name;
  std::vector<std::byte> bytes;
};

}  // namespace hvas::record
