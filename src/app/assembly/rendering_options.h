#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "app/output/choice.h"
#include "fits/pair_choice.h"
#include "haptics/options.h"
#include "haptics/paper_guidance.h"

namespace hvas::app {

/** Adds `--force-map published|paper` to a command.
 @param kind  Of haptics::ForceMapKind, or optional. */
template <typename Kind>
CLI::Option* AddForceMapOption(CLI::App* command, Kind* kind) {
  const Choices<haptics::ForceMapKind> kinds{
      {haptics::ToString(haptics::ForceMapKind::kPublished), haptics::ForceMapKind::kPublished},
      {haptics::ToString(haptics::ForceMapKind::kPaper), haptics::ForceMapKind::kPaper}};
  return AddChoice(command, "--force-map", kind, kinds,
                   "Force map of fits: published (one map for all fits), or paper (factors k_r and "
                   "k_s of paper W)");
}

/** Adds `--condition collision|constraint|hybrid` to a command.
 @param condition  Of haptics::Condition, or optional. */
template <typename Condition>
CLI::Option* AddConditionOption(CLI::App* command, Condition* condition) {
  const Choices<haptics::Condition> conditions{{"collision", haptics::Condition::kCollision},
                                               {"constraint", haptics::Condition::kConstraint},
                                               {"hybrid", haptics::Condition::kHybrid}};
  return AddChoice(command, "--condition", condition, conditions,
                   "Rendering: contact, mates, or hybrid (both, and the force of the fit)");
}

/** Adds --k1, --k2, --k3 and --attract-in-fits, the constants of paper X's guidance, and
 --contact-in-holes, which ends guidance where a shaft is in its hole, to a command. */
inline void AddGuidanceOptions(CLI::App* command, haptics::PaperGuidance* guidance) {
  command
      ->add_option("--k1", guidance->k1,
                   "Attraction along the axis of a mate, as a share of the device's peak force "
                   "(K1 of paper X)")
      ->check(CLI::Range(0.0, haptics::kLargestK1));
  command
      ->add_option("--k2", guidance->k2,
                   "Stiffness by which the hand is held on the axis [N/m] (K2 of paper X); no more "
                   "than the device allows")
      ->check(CLI::Range(haptics::kSmallestK2, haptics::kLargestK2));
  command
      ->add_option("--k3", guidance->k3,
                   "Torque by which the hand is turned to the axis, at half a turn, as a multiple "
                   "of the device's peak torque (K3 of paper X)")
      ->check(CLI::Range(0.0, haptics::kLargestK3));
  command->add_flag("--attract-in-fits", guidance->attracts_in_fits,
                    "Attraction goes on inside a fitted hole, as in paper X");
  command->add_flag("--contact-in-holes", guidance->contact_in_holes,
                    "A shaft with play touches its hole where the two are: it tilts, jams and "
                    "wedges; without, its mate holds it on the axis, as in the papers");
  command->add_flag(
      "--threads-turn", guidance->threads_turn,
      "Screws and nuts go in by turning, and are tightened; without, they go straight "
      "in");
}

/** Adds `--sizes one-pair|of-kind|any` to a command. */
inline CLI::Option* AddPairsOption(CLI::App* command, fits::PairChoice* pairs) {
  Choices<fits::PairChoice> choices;
  for (const auto choice :
       {fits::PairChoice::kOnePair, fits::PairChoice::kOfKind, fits::PairChoice::kAny}) {
    choices.emplace_back(fits::ToString(choice), choice);
  }
  return AddChoice(command, "--sizes", pairs, choices,
                   "Sizes of fits: one-pair (mid zone; transition: hole and shaft of one size), "
                   "of-kind (drawn until the pair shows the kind of its fit), or any (drawn once)");
}

}  // namespace hvas::app
