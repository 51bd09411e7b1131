#pragma once

#include <optional>
#include <vector>

#include "study/analysis.h"
#include "study/study_folder.h"

/** What participants did, as tables for the statistics. */
namespace hvas::study {

/** Times of one condition in the blocks that are no identification. */
struct ConditionTimes {
  std::size_t condition{0};  ///< Index into Protocol::conditions.
  std::size_t trials{0};     ///< That are over.
  std::size_t done{0};       ///< Of these, with the part in its place: those of the mean.
  double mean{0};            ///< [s]
  /** With those that were not done as if they had ended at their time limit: the restricted mean of
   survival analysis. Without it a condition that few get through would look quick. [s] */
  double restricted_mean{0};
};

/** Of the conditions that have trials planned in such blocks, in the protocol's order. */
[[nodiscard]] std::vector<ConditionTimes> SummariseTimes(
    const Protocol& protocol, const std::vector<Participant>& participants);

/** Mean times of the trials that were done, of a block, a row a participant [s]. Whoever has done
 none under a condition has no number there. */
[[nodiscard]] Table MakeTimesTable(const Protocol& protocol, std::size_t block,
                                   const std::vector<Participant>& participants);

/** Right answers in a block of identification, a row a participant. Whoever has not done all of the
 block's trials of a condition has no number there. */
[[nodiscard]] Table MakeRightAnswersTable(const Protocol& protocol, std::size_t block,
                                          const std::vector<Participant>& participants);

/** All answers of such a block. */
[[nodiscard]] std::vector<Answer> CollectAnswers(const Protocol& protocol, std::size_t block,
                                                 const std::vector<Participant>& participants);

/** Answers to the scales that are asked once a participant, a column a question. */
[[nodiscard]] Table MakeScalesTable(const Protocol& protocol,
                                    const std::vector<Participant>& participants);

/** Table of only those rows that have any number. */
[[nodiscard]] Table WithoutEmptyRows(Table table);

}  // namespace hvas::study
