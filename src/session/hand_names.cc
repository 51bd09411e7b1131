#include "session/hand_names.h"

#include <array>

#include "haptics/constraint_solver.h"

namespace hvas::session {

const char* OrdinalOfHand(std::size_t hand) {
  constexpr std::array<const char*, haptics::kMaxHands> kOrdinals{
      "first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth"};
  return kOrdinals.at(hand);
}

std::string MakeDeviceKey(std::size_t hand) {
  return hand == 0 ? "device" : std::string(OrdinalOfHand(hand)) + "_device";
}

}  // namespace hvas::session
