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
  int repetition{1};         ///< Of the condition in its block, from 1.
};

/** Orders of 0 to count-1, a row a participant: after CountRows() of them they repeat. Each number
 is in each place equally often. With `is_balanced` each also follows each equally often: a cyclic
 square of the sequence 0, 1, n-1, 2, n-2 ..., and for odd counts its mirror image besides
 (Williams, Aust. J. Sci. Res. A 2, 1949).
 @pre count >= 1 */
[[nodiscard]] std::vector<std::vector<std::size_t>> MakeSquare(std::size_t count, bool is_balanced);

/** All trials of a participant, in their order. The study's seed says which condition is which in
 the squares and shuffles what is random; the same number and seed give the same trials.
 @param participant  From 1. */
[[nodiscard]] std::vector<PlannedTrial> MakeSchedule(const Protocol& protocol, int participant,
                                                     std::uint64_t seed);

/** A seed for one purpose, from the study's and the purpose's numbers. */
[[nodiscard]] std::uint64_t MixSeed(std::uint64_t seed, std::uint64_t a, std::uint64_t b);

/** "P03". @param number  From 1. */
[[nodiscard]] std::string ParticipantId(int number);

/** The number in "P03". Errors: kInvalid for anything else: participants have no names here. */
[[nodiscard]] Result<int> ParseParticipantId(std::string_view id);

}  // namespace hvas::study
