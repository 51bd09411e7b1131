#include "sequence/base_choice.h"

#include <algorithm>

namespace hvas::sequence {

using product::OccurrenceId;

double SizeOf(const product::Part& part) {
  return part.mass.volume > 0 ? part.mass.volume : part.box_B.size().prod();
}

OccurrenceId ChooseBase(const product::Product& product, const std::vector<OccurrenceId>& parts,
                        const Neighbours& neighbours) {
  // What most is joined to, where the largest is joined to little: a propeller's motor. Choices.
  constexpr std::size_t kTimesAsMany = 3;
  constexpr double kLeastSize = 0.1;  // Share of the largest one's volume.
  std::vector<bool> is_candidate(neighbours.size(), false);
  for (const OccurrenceId id : parts) {
    is_candidate[id.index()] = true;
  }
  const auto count_joined = [&](OccurrenceId id) {
    const std::vector<OccurrenceId>& others = neighbours[id.index()];
    return static_cast<std::size_t>(
        std::count_if(others.begin(), others.end(),
                      [&](OccurrenceId other) { return is_candidate[other.index()]; }));
  };
  const OccurrenceId largest = parts.back();
  const double least_size = kLeastSize * SizeOf(product.part_of(largest));
  OccurrenceId base = largest;
  std::size_t most = kTimesAsMany * std::max<std::size_t>(1, count_joined(largest));
  for (const OccurrenceId id : parts) {
    const std::size_t joined = count_joined(id);
    if (joined >= most && SizeOf(product.part_of(id)) >= least_size) {
      base = id;
      most = joined;
    }
  }
  return base;
}

}  // namespace hvas::sequence
