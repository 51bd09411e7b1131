#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/result.h"
#include "simulation/model.h"
#include "study/study_folder.h"

namespace hvas::study {

/** The model of a study's product, with the part's fit; empty: as the product has it. The same fit
 gives the same model. */
using ModelSource =
    std::function<Result<std::shared_ptr<const simulation::Model>>(const std::string& fit)>;

/** Of which trials the sessions are recorded. */
enum class KeptRecords : std::uint8_t {
  kNone,
  kLast,  ///< The last repetition of each condition in each block.
  kAll,
};

struct SimulatedStudyOptions {
  int participants{1};  ///< P01 to so many, 1 to 999.
  KeptRecords records{KeptRecords::kLast};
  unsigned threads{0};  ///< 0: as many as there are cores.
  std::function<void(std::size_t done, std::size_t total)> progress;  ///< Of trials; may be null.
};

/** Runs a study with simulated participants, from consent to the last question, into its folder.
 Participants who are done already are left as they are; those who are not go on where they stopped.
 They answer no questions: they have no opinions. The same protocol, seed and number give the same
 journals, on however many threads.
 Errors: those of models, the folder and its journals; kUnsupported for fits in identification that
 the observer does not know. */
[[nodiscard]] Result<void> RunSimulatedStudy(const StudyFolder& folder, const ModelSource& models,
                                             const SimulatedStudyOptions& options);

}  // namespace hvas::study
