#include "pages/html_page.h"

#include <fmt/format.h>

namespace hvas::pages {
namespace {

constexpr const char* kPageStyle = R"(
:root{color-scheme:light dark;--page:#fff;--ink:#1d2126;--soft:#4a525b;--rule:#dfe3e8;--good:#1b7f3b;--bad:#b3261e;--tile:#f4f6f8}
@media(prefers-color-scheme:dark){:root{--page:#15181c;--ink:#e8ebee;--soft:#aeb6bf;--rule:#2d333a;--good:#6fd08c;--bad:#ff8a80;--tile:#1e2329}}
*{box-sizing:border-box}
body{margin:0 auto;max-width:66rem;padding:2rem 1.25rem 4rem;background:var(--page);color:var(--ink);font:16px/1.5 system-ui,sans-serif}
h1{font-size:1.9rem;line-height:1.2;margin:0}h2{font-size:1.25rem;margin:2.5rem 0 .5rem}
p{margin:.4rem 0}.soft,figcaption,small{color:var(--soft)}
.verdict{font-size:1.15rem;margin:1rem 0}.good{color:var(--good);font-weight:600}.bad{color:var(--bad);font-weight:600}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(9.5rem,1fr));gap:.75rem;margin:1.25rem 0;padding:0}
.tiles div{background:var(--tile);border-radius:.5rem;padding:.75rem 1rem}
.tiles dt{color:var(--soft);font-size:.85rem}.tiles dd{margin:0;font-size:1.35rem;font-variant-numeric:tabular-nums}
figure{margin:1rem 0}figure img,figure svg{display:block;width:100%;height:auto}
.scroll{overflow-x:auto}
table{border-collapse:collapse;width:100%;font-size:.82rem;font-variant-numeric:tabular-nums}
th,td{padding:.25rem .4rem;text-align:right;border-bottom:1px solid var(--rule);white-space:nowrap}
th{font-weight:600;color:var(--soft);vertical-align:bottom}
th:first-child,td:first-child,.l{text-align:left!important;white-space:normal}
td:first-child{min-width:11rem}
@media print{:root{color-scheme:light;--page:#fff;--ink:#000;--soft:#444;--rule:#ccc;--good:#14602c;--bad:#8f1d17;--tile:#f4f6f8}
body{max-width:none;padding:0;font-size:10.5pt}table{font-size:7.5pt}th,td{padding:.2rem}td:first-child{min-width:7rem}.scroll{overflow:visible}h2,h3{break-after:avoid}figure,tr,.tiles{break-inside:avoid}figure svg{max-height:225mm}
figure svg .page{fill:#fff!important}figure svg text{fill:#000!important}figure svg .onsolid{fill:#fff!important}figure svg .grid{stroke:#ddd!important}}
@page{margin:16mm}
)";

}  // namespace

std::string Escape(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string MakeTile(std::string_view name, std::string_view value) {
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, value);
}

std::string MakeHtmlPage(std::string_view title, std::string_view body,
                         std::string_view extra_style, std::string_view language) {
  return fmt::format(
      "<!doctype html><html lang=\"{}\"><head><meta charset=\"utf-8\"><meta "
      "name=\"viewport\" content=\"width=device-width,initial-scale=1\"><title>{}</title>"
      "<style>{}{}</style></head><body><main>{}</main></body></html>\n",
      language, Escape(title), kPageStyle, extra_style, body);
}

}  // namespace hvas::pages
