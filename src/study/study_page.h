#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "study/study_folder.h"
#include "study/study_results.h"

namespace hvas::study {

/** Makes the report of a study as one self-contained HTML page: method, participants, times, forces
 during mating, identification, answers, statistics, interruptions. Results of simulated
 participants are marked as such. Equal studies give equal bytes. */
[[nodiscard]] Result<std::string> MakeStudyPage(const StudyFolder& folder,
                                                const std::vector<Participant>& participants);

}  // namespace hvas::study
