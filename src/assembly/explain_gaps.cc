#include "assembly/explain_gaps.h"

#include <algorithm>
#include <utility>

namespace hvas::assembly {

std::vector<orders::GapReason> ExplainGaps(const simulation::Model& model,
                                           const ExplainGapsOptions& options) {
  using Clock = std::chrono::steady_clock;
  const std::vector<sequence::SequenceGap>& gaps = model.sequence.gaps;
  const std::size_t count = std::min(options.most, gaps.size());
  orders::GapReasonOptions each;
  each.stop = options.stop;
  if (options.time) {
    each.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(*options.time);
  }
  std::vector<orders::GapReason> reasons;
  while (reasons.size() < count && !options.stop.stop_requested() &&
         (!each.deadline || Clock::now() < *each.deadline)) {
    each.progress = [&](double fraction) {
      if (options.progress) {
        options.progress((static_cast<double>(reasons.size()) + fraction) /
                         static_cast<double>(count));
      }
    };
    auto reason = orders::ExplainGap(model, gaps[reasons.size()].occurrence, each);
    if (!reason) {
      break;
    }
    reasons.push_back(std::move(*reason));
  }
  return reasons;
}

}  // namespace hvas::assembly
