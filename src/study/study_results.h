#pragma once

#include <optional>
#include <vector>

#include "study/analysis.h"
#include "study/study_folder.h"

/** What participants did, as tables for the statistics. */
namespace hvas::study {

/** Completion times of one condition in all blocks but those of identification. */
struct ConditionTimes {
  std::size_t condition{0};  ///< Index into Protocol::conditions.
  std::size_t trials{0};     ///< Number of completed trials.
  std::size_t done{0};       ///< Number of them with the part seated: the sample of `mean`.
  double mean{0};            ///< Mean time [s].
  /** Restricted mean of survival analysis, in which trials without success count with their time
   limit [s]. The plain mean would make a condition look fast that few complete. */
  double restricted_mean{0};
};

/** Summarises the times of all conditions with trials in such blocks, in the protocol's order. */
[[nodiscard]] std::vector<ConditionTimes> SummariseTimes(
    const Protocol& protocol, const std::vector<Participant>& participants);

/** Makes a table of mean times of a block's successful trials [s], one row for each participant.
 The cell of a condition without such trials is missing. */
[[nodiscard]] Table MakeTimesTable(const Protocol& protocol, std::size_t block,
                                   const std::vector<Participant>& participants);

/** Makes a table of the counts of correct answers in a block of identification, one row for each
 participant. The cell of a condition with trials to do is missing. */
[[nodiscard]] Table MakeRightAnswersTable(const Protocol& protocol, std::size_t block,
                                          const std::vector<Participant>& participants);

/** Collects all answers of a block of identification. */
[[nodiscard]] std::vector<IdentificationAnswer> CollectAnswers(
    const Protocol& protocol, std::size_t block, const std::vector<Participant>& participants);

/** Makes a table of the answers to scales that are asked once, one column for each question. */
[[nodiscard]] Table MakeScalesTable(const Protocol& protocol,
                                    const std::vector<Participant>& participants);

/** Removes rows without any value. */
[[nodiscard]] Table RemoveEmptyRows(Table table);

}  // namespace hvas::study
