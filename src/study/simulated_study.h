#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/result.h"
#include "simulation/model.h"
#include "study/study_folder.h"

namespace hvas::study {

/** Makes the model of a study's product with the fit of a condition on a part (ApplyFit). Equal
 keys (MakeFitKey) have to give equal models. */
using ModelSource = std::function<Result<std::shared_ptr<const simulation::Model>>(
    const Condition& condition, const std::string& part)>;

/** Which trials leave a record. */
enum class KeptRecords : std::uint8_t {
  kNone,
  kLast,  ///< The last repetition of each condition in each block.
  kAll,
};

struct SimulatedStudyOptions {
  int participants{1};  ///< Number of participants, from P01 on; 1 to 999.
  KeptRecords records{KeptRecords::kLast};
  unsigned threads{0};  ///< Number of threads; 0: one for each core.
  std::function<void(std::size_t done, std::size_t total)>
      progress;  ///< Counts trials; may be null.
};

/** Runs a study with simulated participants, from consent to the last question, into its folder.
 Complete participants stay as they are; incomplete ones are resumed. Questions stay unanswered,
 because simulated participants have no opinions. Equal protocols, seeds and numbers give equal
 journals on any number of threads.
 Errors: those of models, of DrawPair, of the folder and its journals; kInvalid where a condition of
 identification has no fit. */
[[nodiscard]] Result<void> RunSimulatedStudy(const StudyFolder& folder, const ModelSource& models,
                                             const SimulatedStudyOptions& options);

}  // namespace hvas::study
