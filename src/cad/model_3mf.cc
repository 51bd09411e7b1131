#include "cad/model_3mf.h"

#include <array>
#include <charconv>
#include <cstddef>
#include <utility>

#include "cad/step_text.h"

namespace hvas::cad {
namespace {

/** Character references and the five entities of XML; what is neither stays. */
std::string Unescape(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    bool is_entity = false;
    for (const auto& [entity, c] : kEntities) {
      if (text.substr(i, entity.size()) == entity) {
        out.push_back(c);
        i += entity.size();
        is_entity = true;
        break;
      }
    }
    if (!is_entity) {
      out.push_back(text[i++]);
    }
  }
  return out;
}

/** The value of an attribute in the text of a start tag. */
std::optional<std::string> FindAttribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    std::size_t end = at + name.size();
    while (end < tag.size() && IsBlank(tag[end])) {
      ++end;
    }
    if (at == 0 || !IsBlank(tag[at - 1]) || end >= tag.size() || tag[end] != '=') {
      continue;
    }
    const std::size_t quote = tag.find_first_of("\"'", end);
    const std::size_t close =
        quote == std::string_view::npos ? quote : tag.find(tag[quote], quote + 1);
    if (close == std::string_view::npos) {
      return std::nullopt;
    }
    return Unescape(tag.substr(quote + 1, close - quote - 1));
  }
  return std::nullopt;
}

/** The text of the next start tag of this name from `at` on, which moves behind it. */
std::string_view NextTag(std::string_view xml, std::string_view name, std::size_t* at) {
  while ((*at = xml.find(name, *at)) != std::string_view::npos) {
    const std::size_t begin = *at + name.size();
    const std::size_t end = xml.find('>', begin);
    const bool is_tag = *at > 0 && xml[*at - 1] == '<' && begin < xml.size() &&
                        (IsBlank(xml[begin]) || xml[begin] == '>');
    *at = begin;
    if (is_tag && end != std::string_view::npos) {
      *at = end;
      return xml.substr(begin, end - begin);
    }
  }
  *at = xml.size();
  return {};
}

}  // namespace

Model3mf ParseModel3mf(std::string_view xml) {
  constexpr std::array<std::pair<std::string_view, double>, 6> kUnits{{{"micron", 1e-6},
                                                                       {"millimeter", 1e-3},
                                                                       {"centimeter", 1e-2},
                                                                       {"inch", 0.0254},
                                                                       {"foot", 0.3048},
                                                                       {"meter", 1}}};
  Model3mf model;
  std::size_t at = 0;
  if (const auto unit = FindAttribute(NextTag(xml, "model", &at), "unit")) {
    model.is_unit_known = false;
    for (const auto& [name, metres] : kUnits) {
      if (*unit == name) {
        model.length_unit = metres;
        model.is_unit_known = true;
      }
    }
  }
  at = 0;
  for (std::string_view tag = NextTag(xml, "object", &at); !tag.empty();
       tag = NextTag(xml, "object", &at)) {
    const auto id = FindAttribute(tag, "id");
    const auto name = FindAttribute(tag, "name");
    int number = 0;
    if (id && name && !name->empty() &&
        std::from_chars(id->data(), id->data() + id->size(), number).ec == std::errc()) {
      model.names.try_emplace(number, *name);
    }
  }
  return model;
}

}  // namespace hvas::cad
