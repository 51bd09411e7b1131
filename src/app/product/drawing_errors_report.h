#pragma once

#include <functional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "product/product.h"

/** Errors of the drawing (mates/drawing_errors.h): in the documents and the pages of all commands.
 */
namespace hvas::app {

/** Which errors are listed; null: all. */
using ErrorFilter = std::function<bool(const product::DrawingError&)>;

/** The errors of a product as a JSON list, the largest volume first. */
[[nodiscard]] nlohmann::ordered_json MakeDrawingErrorsJson(const product::Product& product,
                                                           const ErrorFilter& filter = nullptr);

/** Prints the errors as a table, as far as there are any. */
void PrintDrawingErrors(const product::Product& product, bool is_all,
                        const ErrorFilter& filter = nullptr);

/** The errors as a section of a page; empty where there are none. */
[[nodiscard]] std::string MakeDrawingErrorsSection(const product::Product& product);

}  // namespace hvas::app
