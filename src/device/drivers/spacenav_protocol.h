#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "device/drivers/rate_control.h"

/** What spacenavd sends to a client that said nothing: eight numbers, kind first. For motion x, y,
 z, rx, ry, rz and the time since the last one [ms] follow, for buttons the number of it. */
namespace hvas::device::spacenav {

using Frame = std::array<std::int32_t, 8>;

// Kinds of messages of spacenavd.
inline constexpr std::int32_t kMotion = 0;
inline constexpr std::int32_t kPress = 1;
inline constexpr std::int32_t kRelease = 2;
inline constexpr std::int32_t kFullScale = 350;  // of raw deflections, "roughly"

/** A file beside the socket that says that an emulator made it; spacenavd makes none. */
inline constexpr const char* kEmulatedMark = ".emulated";

/** The daemon's axes are x right, y up, z away from the person, and its rotations are right-handed
 about x right, y up, z towards the person with the sign of rz turned, as spnav_posrot_moveobj() of
 libspnav takes them; the axes of D are x right, y away, z up. RT-safe. */
[[nodiscard]] inline Deflection DeflectionOf(const Frame& frame) noexcept {
  const auto share = [&frame](std::size_t i) { return static_cast<double>(frame[i]) / kFullScale; };
  return {Vec3(share(1), share(3), share(2)), Vec3(share(4), share(6), share(5))};
}

/** The other way round. */
[[nodiscard]] inline Frame FrameOf(const Deflection& deflection) noexcept {
  const auto raw = [](double share) {
    return static_cast<std::int32_t>(std::lround(kFullScale * share));
  };
  const Vec3& m = deflection.move;
  const Vec3& t = deflection.turn;
  return {kMotion, raw(m.x()), raw(m.z()), raw(m.y()), raw(t.x()), raw(t.z()), raw(t.y()), 8};
}

}  // namespace hvas::device::spacenav
