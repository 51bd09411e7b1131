#pragma once

#include <string>

#include "study/analysis.h"

namespace hvas::study {

/** Makes HTML <section>s of an analysis with tables and figures, for pages::MakeHtmlPage.
 @param id  Prefix of element ids, unique within a page: letters, digits, '-'. */
[[nodiscard]] std::string MakeAnalysisHtml(const Analysis& analysis, const std::string& id = "a");

/** Makes HTML <section>s of an identification: the confusion matrix and its statistics.
 @param id  As of MakeAnalysisHtml. */
[[nodiscard]] std::string MakeIdentificationHtml(const Identification& identification,
                                                 const std::string& id = "i");

}  // namespace hvas::study
