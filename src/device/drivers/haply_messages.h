#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "spatial/pose.h"

/** What is said to and by Haply's Inverse Service, as JSON. */
namespace hvas::device::haply {

/** How a force is written: services since 3.5 read "vector", those before "values". */
enum class Dialect : std::uint8_t { kVector, kValues };

/** Finds the dialect by the version that a service tells, as "3.5.1"; none where it tells none. */
[[nodiscard]] std::optional<Dialect> DialectOf(std::string_view version);

/** One state of one device. What a service leaves out has its default; what is there but no number
 is not a number. */
struct Message {
  bool is_readable{false};  ///< It was JSON.
  std::string version;      ///< Version of the service; may be empty.
  bool is_emulated{false};
  bool has_device{false};
  std::string device_id;
  Vec3 p{Vec3::Zero()};
  Vec3 v{Vec3::Zero()};
  std::optional<Vec3> force;  ///< That the device shows, where it says so.
  bool is_calibrated{true};
  bool has_power{true};
  bool has_handle{false};  ///< A wireless VerseGrip is paired.
  Quat q{Quat::Identity()};
  std::uint32_t buttons{0};
};

/** @param device_id  Which one; empty: the first. */
[[nodiscard]] Message ParseMessage(std::string_view text, const std::string& device_id);

/** A force for a device; the first one on a connection says who is talking. */
[[nodiscard]] std::string ForceMessage(Dialect dialect, const std::string& device_id,
                                       const Vec3& force, bool is_first);

/** Asks for everything that there is, also what has not changed. */
[[nodiscard]] std::string FullStateMessage();

}  // namespace hvas::device::haply
