#pragma once

#include <string>

#include "study/analysis.h"

/** Figures of an analysis as SVG (pages/svg_plot.h). `id` is another one for each figure of a page.
 */
namespace hvas::study {

/** Boxes from quartile to quartile with the median, whiskers to the last value within one and a
 half boxes, and every value as a dot. */
[[nodiscard]] std::string DrawBoxes(const Analysis& analysis, const std::string& id);

/** The values of each participant, joined. */
[[nodiscard]] std::string DrawPairs(const Analysis& analysis, const std::string& id);

/** Means as bars with their intervals; where cells are counts, shares of right answers with theirs
 and the chance. */
[[nodiscard]] std::string DrawMeans(const Analysis& analysis, const std::string& id);

/** What was shown against what was answered, as counts in fields that are the fuller the larger
 their share of what was shown. */
[[nodiscard]] std::string DrawConfusion(const Identification& identification,
                                        const std::string& id);

}  // namespace hvas::study
