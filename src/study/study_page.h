#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "study/study_folder.h"
#include "study/study_results.h"

namespace hvas::study {

/** A study as one HTML page that needs nothing else: what was done, with whom, times, forces of the
 mating, identification, answers, statistics, interruptions. Simulated participants are marked as
 such wherever their numbers stand. The same study, the same bytes. */
[[nodiscard]] Result<std::string> MakeStudyPage(const StudyFolder& folder,
                                                const std::vector<Participant>& participants);

}  // namespace hvas::study
