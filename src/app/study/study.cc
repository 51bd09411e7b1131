#include "app/study/study.h"

#include <CLI/CLI.hpp>

#include "app/study/study_analyse.h"
#include "app/study/study_power.h"
#include "app/study/study_run.h"

namespace hvas::app {

void AddStudy(CLI::App* app, int* status) {
  CLI::App* study = app->add_subcommand("study", "Run and analyse studies with participants");
  study->require_subcommand(1);
  AddStudyAnalyse(study, status);
  AddStudyPower(study, status);
  AddStudyRun(study, status);
}

}  // namespace hvas::app
