#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study/protocol.h"

namespace hvas::study {

/** One trial of a participant. */
struct PlannedTrial {
  std::size_t block{0};      ///< Index into Protocol::blocks.
  std::size_t condition{0};  ///< Index into Protocol::conditions.
  int repetition{1};         ///< Number of the condition's trial in its block, from 1.
};

/** Makes a Latin square: permutations of 0 to count-1, one row for each participant, which are
 repeated once there are more participants than rows. Each number is in each position equally often.
 With `is_balanced` each also follows each other equally often: the cyclic square of the sequence 0,
 1, n-1, 2, n-2 ..., and for odd counts its mirror image as well (Williams, Aust. J. Sci. Res. A 2,
 1949).
 @pre count >= 1 */
[[nodiscard]] std::vector<std::vector<std::size_t>> MakeSquare(std::size_t count, bool is_balanced);

/** Makes the schedule of a participant: all trials, in order. The study's seed assigns conditions
 to the symbols of the squares and shuffles what is random. Equal arguments give equal schedules.
 @param participant  From 1. */
[[nodiscard]] std::vector<PlannedTrial> MakeSchedule(const Protocol& protocol, int participant,
                                                     std::uint64_t seed);

/** Derives a seed for one purpose from the study's seed and the numbers of the purpose. */
[[nodiscard]] std::uint64_t MixSeed(std::uint64_t seed, std::uint64_t a, std::uint64_t b);

/** Formats the id of a participant: "P03". @param number  From 1. */
[[nodiscard]] std::string FormatParticipantId(int number);

/** Parses the number in an id such as "P03". Errors: kInvalid for any other text, such as a
 name. */
[[nodiscard]] Result<int> ParseParticipantId(std::string_view id);

}  // namespace hvas::study
