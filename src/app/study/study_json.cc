#include "app/study/study_json.h"

#include <optional>

namespace hvas::app {
namespace {

using nlohmann::ordered_json;

ordered_json ToJson(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json ToJson(const statistics::Interval& interval) {
  return {interval.low, interval.high};
}

ordered_json ToJson(const std::optional<statistics::Interval>& interval) {
  return interval ? ToJson(*interval) : ordered_json(nullptr);
}

ordered_json ToJson(const statistics::Summary& s) {
  return {{"n", s.n},
          {"mean", s.mean},
          {"mean_ci", ToJson(s.mean_ci)},
          {"sd", ToJson(s.sd)},
          {"min", s.min},
          {"lower_quartile", s.lower_quartile},
          {"median", s.median},
          {"upper_quartile", s.upper_quartile},
          {"max", s.max}};
}

ordered_json ToJson(const statistics::Share& share) {
  return {{"right", share.right},
          {"trials", share.trials},
          {"share", share.share},
          {"share_ci", ToJson(share.ci)},
          {"chance_p", ToJson(share.chance_p)}};
}

ordered_json ToJson(const statistics::Friedman& f) {
  return {{"n", f.row_count},
          {"dof", f.condition_count - 1},
          {"mean_ranks", f.mean_ranks},
          {"chi_square", ToJson(f.chi_square)},
          {"p", ToJson(f.p)},
          {"exact_p", ToJson(f.exact_p)},
          {"kendall_w", ToJson(f.kendall_w)},
          {"iman_davenport_f", ToJson(f.iman_davenport_f)},
          {"iman_davenport_p", ToJson(f.iman_davenport_p)}};
}

ordered_json ToJson(const study::Analysis& analysis, const study::PairResult& pair) {
  const statistics::Wilcoxon& w = pair.wilcoxon;
  ordered_json d_z = nullptr;
  if (pair.d_z) {
    d_z = {{"value", pair.d_z->d_z}, {"ci", ToJson(pair.d_z->ci)}};
  }
  return {{"first", analysis.table.conditions[pair.first]},
          {"second", analysis.table.conditions[pair.second]},
          {"difference", ToJson(pair.difference.summary)},
          {"first_mean", pair.difference.first_mean},
          {"second_mean", pair.difference.second_mean},
          {"difference_percent", ToJson(pair.difference.percent)},
          {"wilcoxon",
           {{"n", w.n},
            {"zeros", w.zero_count},
            {"positive_rank_sum", w.positive_rank_sum},
            {"negative_rank_sum", w.negative_rank_sum},
            {"z", ToJson(w.z)},
            {"p", ToJson(w.p)},
            {"continuity_p", ToJson(w.continuity_p)},
            {"pratt_z", ToJson(w.pratt_z)},
            {"pratt_p", ToJson(w.pratt_p)},
            {"bonferroni_p", pair.bonferroni_p},
            {"holm_p", pair.holm_p},
            {"exact_p", ToJson(w.exact_p)},
            {"exact_bonferroni_p", ToJson(pair.exact_bonferroni_p)},
            {"exact_holm_p", ToJson(pair.exact_holm_p)}}},
          {"rank_biserial", ToJson(w.rank_biserial)},
          {"r", ToJson(w.r)},
          {"d_z", d_z},
          {"is_different", pair.is_different}};
}

const char* ToText(study::Direction direction) {
  switch (direction) {
    case study::Direction::kHigherIsBetter:
      return "higher";
    case study::Direction::kLowerIsBetter:
      return "lower";
    case study::Direction::kNotStated:
      break;
  }
  return "not stated";
}

std::vector<std::string> Join(std::vector<std::string> notes,
                              const std::vector<std::string>& more) {
  notes.insert(notes.end(), more.begin(), more.end());
  return notes;
}

}  // namespace

ordered_json ToJson(const study::Analysis& analysis, const std::vector<std::string>& notes) {
  ordered_json json{{"schema", "hvas-study-analysis-1"},
                    {"quantity", analysis.table.quantity},
                    {"unit", analysis.table.unit},
                    {"participants", analysis.table.rows.size()},
                    {"complete_participants", analysis.complete_rows},
                    {"alpha", analysis.options.alpha},
                    {"better", ToText(analysis.options.direction)},
                    {"trials_per_cell", nullptr},
                    {"chance", nullptr},
                    {"conditions", ordered_json::array()},
                    {"friedman", nullptr},
                    {"bonferroni_level", analysis.bonferroni_level},
                    {"pairs", ordered_json::array()},
                    {"notes", Join(notes, analysis.notes)}};
  if (analysis.options.of) {
    json["trials_per_cell"] = *analysis.options.of;
    json["chance"] = analysis.chance;
  }
  for (const study::ConditionResult& condition : analysis.conditions) {
    ordered_json entry{{"name", condition.name}};
    entry.update(ToJson(condition.summary));
    entry["right_answers"] = condition.share ? ToJson(*condition.share) : ordered_json(nullptr);
    json["conditions"].push_back(std::move(entry));
  }
  if (analysis.friedman) {
    json["friedman"] = ToJson(*analysis.friedman);
  }
  for (const study::PairResult& pair : analysis.pairs) {
    json["pairs"].push_back(ToJson(analysis, pair));
  }
  return json;
}

ordered_json ToJson(const study::Identification& identification,
                    const std::vector<std::string>& notes) {
  ordered_json json{{"schema", "hvas-study-identification-1"},
                    {"participants", identification.participant_count},
                    {"confidence", identification.confidence},
                    {"chance", ToJson(identification.chance)},
                    {"names", identification.names},
                    {"counts", identification.confusion.counts},
                    {"accuracy", ToJson(identification.confusion.accuracy)},
                    {"recall", ordered_json::array()},
                    {"kappa", ToJson(identification.confusion.kappa)},
                    {"notes", notes}};
  for (const std::optional<statistics::Share>& recall : identification.confusion.recall) {
    json["recall"].push_back(recall ? ToJson(*recall) : ordered_json(nullptr));
  }
  return json;
}

}  // namespace hvas::app
