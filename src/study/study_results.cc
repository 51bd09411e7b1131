#include "study/study_results.h"

#include <algorithm>
#include <utility>

namespace hvas::study {
namespace {

/** Visits the completed trials of a block. */
template <typename Visit>
void ForEachTrial(const Participant& participant, std::size_t block, const Visit& visit) {
  for (const DoneTrial& done : participant.session->done()) {
    const PlannedTrial& planned = participant.session->schedule()[done.index];
    if (planned.block == block) {
      visit(planned, done);
    }
  }
}

/** Index of a condition in a block. */
std::size_t PlaceOf(const Block& block, std::size_t condition) {
  return static_cast<std::size_t>(
      std::find(block.conditions.begin(), block.conditions.end(), condition) -
      block.conditions.begin());
}

struct Sum {
  double value{0};
  int count{0};
};

/** Makes a table with one row for each participant; `cell` makes a cell of a condition's sums. */
template <typename Add, typename Cell>
Table MakeBlockTable(const Protocol& protocol, std::size_t block_index,
                     const std::vector<Participant>& participants, const Add& add,
                     const Cell& cell) {
  const Block& block = protocol.blocks[block_index];
  Table table;
  for (const std::size_t condition : block.conditions) {
    table.conditions.push_back(protocol.conditions[condition].id);
  }
  for (const Participant& participant : participants) {
    std::vector<Sum> sums(block.conditions.size());
    ForEachTrial(participant, block_index, [&](const PlannedTrial& planned, const DoneTrial& done) {
      add(planned, done, &sums[PlaceOf(block, planned.condition)]);
    });
    Row row{participant.id, {}};
    for (const Sum& sum : sums) {
      row.values.push_back(cell(sum));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

std::vector<ConditionTimes> SummariseTimes(const Protocol& protocol,
                                           const std::vector<Participant>& participants) {
  std::vector<ConditionTimes> all(protocol.conditions.size());
  std::vector<bool> is_timed(protocol.conditions.size());
  for (std::size_t b = 0; b < protocol.blocks.size(); ++b) {
    const Block& block = protocol.blocks[b];
    if (block.is_identification) {
      continue;
    }
    for (const std::size_t condition : block.conditions) {
      is_timed[condition] = true;
    }
    for (const Participant& participant : participants) {
      ForEachTrial(participant, b, [&](const PlannedTrial& planned, const DoneTrial& done) {
        ConditionTimes& times = all[planned.condition];
        ++times.trials;
        if (done.result.outcome == Outcome::kDone && done.result.time) {
          ++times.done;
          times.mean += *done.result.time;
          times.restricted_mean += *done.result.time;
        } else {
          times.restricted_mean += protocol.conditions[planned.condition].time_limit;
        }
      });
    }
  }
  std::vector<ConditionTimes> timed;
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (is_timed[c]) {
      all[c].condition = c;
      all[c].mean /= static_cast<double>(std::max<std::size_t>(1, all[c].done));
      all[c].restricted_mean /= static_cast<double>(std::max<std::size_t>(1, all[c].trials));
      timed.push_back(all[c]);
    }
  }
  return timed;
}

Table MakeTimesTable(const Protocol& protocol, std::size_t block,
                     const std::vector<Participant>& participants) {
  Table table = MakeBlockTable(
      protocol, block, participants,
      [](const PlannedTrial&, const DoneTrial& done, Sum* sum) {
        if (done.result.outcome == Outcome::kDone && done.result.time) {
          sum->value += *done.result.time;
          ++sum->count;
        }
      },
      [](const Sum& sum) {
        return sum.count > 0 ? std::optional<double>(sum.value / sum.count) : std::nullopt;
      });
  table.quantity = "completion time";
  table.unit = "s";
  return table;
}

Table MakeRightAnswersTable(const Protocol& protocol, std::size_t block,
                            const std::vector<Participant>& participants) {
  Table table = MakeBlockTable(
      protocol, block, participants,
      [&](const PlannedTrial& planned, const DoneTrial& done, Sum* sum) {
        if (!done.answer.empty()) {
          sum->value += done.answer == AnswerNameOf(protocol.conditions[planned.condition]) ? 1 : 0;
          ++sum->count;
        }
      },
      [&](const Sum& sum) {
        const bool is_whole = sum.count == protocol.blocks[block].repetitions;
        return is_whole ? std::optional<double>(sum.value) : std::nullopt;
      });
  table.quantity = "right answers";
  return table;
}

std::vector<IdentificationAnswer> CollectAnswers(const Protocol& protocol, std::size_t block,
                                                 const std::vector<Participant>& participants) {
  std::vector<IdentificationAnswer> answers;
  for (const Participant& participant : participants) {
    ForEachTrial(participant, block, [&](const PlannedTrial& planned, const DoneTrial& done) {
      if (!done.answer.empty()) {
        answers.push_back(
            {participant.id, AnswerNameOf(protocol.conditions[planned.condition]), done.answer});
      }
    });
  }
  return answers;
}

Table MakeScalesTable(const Protocol& protocol, const std::vector<Participant>& participants) {
  Table table;
  table.quantity = "answer";
  for (const Question& question : protocol.questions) {
    const bool is_once = question.asked == Asked::kAtEnd ||
                         (question.asked == Asked::kAfterBlock && !question.block.empty());
    if (question.kind == QuestionKind::kScale && is_once) {
      table.conditions.push_back(question.id);
    }
  }
  for (const Participant& participant : participants) {
    Row row{participant.id, std::vector<std::optional<double>>(table.conditions.size())};
    for (const GivenAnswer& answer : participant.session->answers()) {
      const auto column =
          std::find(table.conditions.begin(), table.conditions.end(), answer.question);
      const int* number = std::get_if<int>(&answer.value);
      if (column != table.conditions.end() && number != nullptr) {
        row.values[static_cast<std::size_t>(column - table.conditions.begin())] = *number;
      }
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table RemoveEmptyRows(Table table) {
  std::erase_if(table.rows, [](const Row& row) {
    return std::none_of(row.values.begin(), row.values.end(),
                        [](const auto& value) { return value.has_value(); });
  });
  return table;
}

}  // namespace hvas::study
