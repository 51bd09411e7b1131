#pragma once

#include <string>

#include "study/analysis.h"

namespace hvas::study {

/** An analysis as HTML <section>s with tables and figures, for pages::MakeHtmlPage. `id` is for
 the page that has several: letters, digits, '-', and another one each time. */
[[nodiscard]] std::string AnalysisHtml(const Analysis& analysis, const std::string& id = "a");

/** The same of an identification: the confusion matrix and what follows from it. */
[[nodiscard]] std::string IdentificationHtml(const Identification& identification,
                                             const std::string& id = "i");

}  // namespace hvas::study
