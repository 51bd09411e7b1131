#include "app/product/drawing_errors_report.h"

#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "base/units.h"
#include "mates/drawing_errors.h"
#include "pages/html_page.h"
#include "product/names.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using product::DrawingError;
using product::OccurrenceId;
using product::Product;
using units::ToMm;

Json ToJson(const Product& product, OccurrenceId id, product::FaceId face) {
  Json json{{"occurrence", id.value()}, {"name", product.occurrences[id.index()].path}};
  if (!face.is_valid()) {
    return json;
  }
  const product::Surface& surface = product.part_of(id).faces[face.index()].surface;
  json["face"] = face.value();
  json["surface"] = ToString(surface.kind);
  if (surface.kind == product::SurfaceKind::kCylinder ||
      surface.kind == product::SurfaceKind::kSphere) {
    json["diameter_mm"] = ToMm(2 * surface.radius);
  }
  return json;
}

Json ToJson(const Product& product, const DrawingError& error) {
  return {{"a", ToJson(product, error.a, error.face_a)},
          {"b", ToJson(product, error.b, error.face_b)},
          {"depth_mm", ToMm(error.depth)},
          {"largest_depth_mm", ToMm(error.largest)},
          {"volume_mm3", units::ToMm3(error.volume)},
          {"is_shaft_in_hole", error.is_in_hole},
          {"description", product.occurrences[mates::SmallerOf(product, error).index()].path +
                              ": " + mates::DescribeDrawingError(product, error)}};
}

std::vector<DrawingError> Filter(const Product& product, const ErrorFilter& filter) {
  std::vector<DrawingError> errors = product.drawing_errors;
  if (filter) {
    std::erase_if(errors, [&filter](const DrawingError& error) { return !filter(error); });
  }
  return errors;
}

}  // namespace

Json MakeDrawingErrorsJson(const Product& product, const ErrorFilter& filter) {
  Json list = Json::array();
  for (const DrawingError& error : Filter(product, filter)) {
    list.push_back(ToJson(product, error));
  }
  return list;
}

void PrintDrawingErrors(const Product& product, bool is_all, const ErrorFilter& filter) {
  const std::vector<DrawingError> errors = Filter(product, filter);
  if (errors.empty()) {
    return;
  }
  fmt::print("\nErrors of the drawing: parts in one another that no joint explains\n");
  TextTable table({"part", "depth\nmm", "volume\nmm3"}, 1);
  ListLimit limit(is_all);
  for (const DrawingError& error : errors) {
    if (limit.Next()) {
      table.Add({product.occurrences[mates::SmallerOf(product, error).index()].path,
                 fmt::format("{:.3f}", ToMm(error.depth)),
                 fmt::format("{:.3g}", units::ToMm3(error.volume))},
                mates::DescribeDrawingError(product, error));
    }
  }
  fmt::print("{}", table.ToText(2));
  limit.PrintRest();
}

std::string MakeDrawingErrorsSection(const Product& product) {
  if (product.drawing_errors.empty()) {
    return {};
  }
  std::string html =
      "<h2 id=\"drawing-errors\">Errors of the drawing</h2><p>Parts that are drawn in one another, "
      "deeper than any joint of this kind and size is.</p><div class=\"scroll\"><table><thead><tr>"
      "<th>Part</th><th class=\"l\">Drawn with</th><th>Depth<br>[mm]</th><th>Volume<br>[mm&sup3;]"
      "</th></tr></thead><tbody>";
  for (const DrawingError& error : product.drawing_errors) {
    const OccurrenceId part = mates::SmallerOf(product, error);
    html += fmt::format(
        "<tr><td>{}</td><td class=\"l\">{}</td><td class=\"bad\">{:.3f}</td><td>{:.3g}</td></tr>",
        pages::Escape(product.occurrences[part.index()].path),
        pages::Escape(mates::DescribeDrawingError(product, error)), ToMm(error.depth),
        units::ToMm3(error.volume));
  }
  return html + "</tbody></table></div>";
}

}  // namespace hvas::app
