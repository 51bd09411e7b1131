#pragma once

#include <cstddef>
#include <string>

namespace hvas::session {

/** Hands whose devices each record names in its meta, also those that it has not. */
inline constexpr std::size_t kHandsOfMeta = 2;

/** "first", "second" and so on, for people. @pre hand < haptics::kMaxHands. */
[[nodiscard]] const char* OrdinalOfHand(std::size_t hand);

/** Key of the device of a hand, in a record's meta and in JSON: "device", "second_device",
 "third_device" and so on. @pre hand < haptics::kMaxHands. */
[[nodiscard]] std::string MakeDeviceKey(std::size_t hand);

}  // namespace hvas::session
