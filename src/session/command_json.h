#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/result.h"
#include "record/tick_record.h"
#include "session/exact_json.h"
#include "simulation/simulation.h"

/** What a record's commands say (docs/record.md), and back; errors are kUnreadable and name the
 field. */
namespace hvas::session {

inline constexpr const char* kBeginKind = "begin";
inline constexpr std::array kCommandKinds{"take", "place",
                                          "help"};  ///< Names of TickCommand::Kind.

/** How a stretch begins: each hand's options, and where all parts are. */
struct Beginning {
  std::vector<haptics::TickOptions> hands;
  std::vector<simulation::PartState> parts;  ///< One for each OccurrenceId.
};

[[nodiscard]] std::string MakeBeginningJson(const Beginning& beginning);

/** @param part_count  Of the model. */
[[nodiscard]] Result<Beginning> ParseBeginning(const std::string& json, std::size_t part_count);

/** Where all parts are, by OccurrenceId. */
[[nodiscard]] Json MakePartsJson(const std::vector<simulation::PartState>& parts);
[[nodiscard]] Result<std::vector<simulation::PartState>> ParseParts(const Json& json);

/** A command as it goes into a record.
 @param before  The parts as the command before it, or the beginning, had them. */
[[nodiscard]] record::Command MakeCommand(const simulation::GivenCommand& given,
                                          const std::vector<simulation::PartState>& before);

[[nodiscard]] Result<simulation::GivenCommand> ParseCommand(
    const record::Command& command, const std::vector<simulation::PartState>& before,
    std::size_t hands);

[[nodiscard]] Json MakeStepsJson(const std::vector<sequence::SequenceStep>& steps);
[[nodiscard]] Result<std::vector<sequence::SequenceStep>> ParseSteps(const Json& json,
                                                                     std::size_t part_count);

}  // namespace hvas::session
