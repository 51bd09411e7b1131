#include "shopfloor/viewer_element.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pages/embedded_image.h"
#include "pages/html_page.h"
#include "shopfloor/work_animation.h"

namespace hvas::shopfloor {
namespace {

constexpr const char* kViewerStyle = R"(
.viewer-view{height:min(62vh,34rem);background:var(--tile);border-radius:.5rem;overflow:hidden;touch-action:none}
.viewer-view canvas{display:block}
.viewer-controls{display:flex;gap:.75rem;align-items:center;margin:.6rem 0;flex-wrap:wrap}
.viewer-controls input{flex:1 1 12rem}
.viewer-controls button{font:inherit;padding:.35rem .9rem;border:1px solid var(--rule);border-radius:.4rem;background:var(--tile);color:var(--ink);cursor:pointer}
.viewer-controls button:disabled{opacity:.45;cursor:default}
.viewer-title{min-height:1.5em;font-weight:600}
)";

/** A document as it may stand in an element <script>. */
std::string EscapeScript(std::string text) {
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) {
    text.replace(at, 1, "\\u003c");
  }
  return text;
}

}  // namespace

std::string MakeViewerElement(const simulation::Model& model, const WorkPlan& plan,
                              std::string_view glb, std::string_view script, Language language) {
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  const std::vector<double> starts = ListStepStarts(plan);
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    const WorkStep& step = plan.steps[i];
    if (step.kind == WorkStep::Kind::kLayAside) {
      continue;
    }
    nlohmann::ordered_json coming = nlohmann::ordered_json::array();
    for (const product::OccurrenceId id : step.coming) {
      coming.push_back(id.value());
    }
    steps.push_back({{"title", fmt::format("{}. {}", i + 1, DescribeStep(model, step, language))},
                     {"start", starts[i]},
                     {"end", starts[i] + kWaySeconds},
                     {"coming", std::move(coming)}});
  }
  const InstructionWords& words = WordsOf(language);
  const std::string data = nlohmann::ordered_json{{"steps", std::move(steps)}}.dump(
      -1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return fmt::format(
      "<style>{}</style><div id=\"hvas-viewer\" hidden><div class=\"viewer-view\"></div>"
      "<div class=\"viewer-controls\"><button type=\"button\">{}</button>"
      "<input type=\"range\" min=\"0\" step=\"1\" aria-label=\"{}\">"
      "<button type=\"button\">{}</button></div><p class=\"viewer-title\" aria-live=\"polite\"></p>"
      "</div><script type=\"application/json\" id=\"hvas-viewer-data\">{}</script>"
      "<script type=\"application/octet-stream\" id=\"hvas-viewer-glb\">{}</script>"
      "<script>{}</script>",
      kViewerStyle, pages::Escape(words.previous), pages::Escape(words.steps),
      pages::Escape(words.next), EscapeScript(data), pages::EncodeBase64(glb), script);
}

}  // namespace hvas::shopfloor
