#pragma once

#include <string>
#include <string_view>

/** HTML pages that need nothing else: no network, no scripts; light and dark by what the reader
 prefers, light on paper. Same content, same bytes. */
namespace hvas::pages {

/** A text as it may stand in HTML and SVG, between tags or in quotes. */
[[nodiscard]] std::string Escape(std::string_view text);

/** A figure with its name, for a list of class "tiles". `value` is HTML, `name` too. */
[[nodiscard]] std::string MakeTile(std::string_view name, std::string_view value);

/** The whole page around `body`, which is HTML; `title` is plain text. What the styles are for:
 "soft", "good", "bad", "verdict", "l" (cells to the left), "scroll" around wide tables, "tiles" for
 a list of MakeTile; `extra_style` is CSS of this page alone, `language` that of its words
 ("en", "de"). */
[[nodiscard]] std::string MakeHtmlPage(std::string_view title, std::string_view body,
                                       std::string_view extra_style = {},
                                       std::string_view language = "en");

}  // namespace hvas::pages
