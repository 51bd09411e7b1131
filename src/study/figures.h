#pragma once

#include <string>

#include "study/analysis.h"

/** Figures of an analysis as SVG (pages/svg_plot.h). `id` is unique for each figure of a page. */
namespace hvas::study {

/** Draws a box plot for each condition: quartiles and median, whiskers to the last value within 1.5
 interquartile ranges of the box (Tukey), and every value as a dot. */
[[nodiscard]] std::string DrawBoxes(const Analysis& analysis, const std::string& id);

/** Draws the values of each participant over the conditions, joined by lines. */
[[nodiscard]] std::string DrawPairs(const Analysis& analysis, const std::string& id);

/** Draws means as bars with confidence intervals; where cells are counts, shares of correct answers
 with theirs and the chance level. */
[[nodiscard]] std::string DrawMeans(const Analysis& analysis, const std::string& id);

/** Draws the confusion matrix: counts and row shares, in fields shaded in three steps by share. */
[[nodiscard]] std::string DrawConfusion(const Identification& identification,
                                        const std::string& id);

}  // namespace hvas::study
