#include "cad/scene/model_3mf.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cad/step/step_text.h"

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

/** The text of the tag that begins at `at`, without its brackets; `at` moves behind it. */
std::string_view TakeTag(std::string_view xml, std::size_t* at) {
  const std::size_t begin = *at + 1;
  const std::size_t end = std::min(xml.find('>', begin), xml.size());
  *at = end;
  return xml.substr(begin, end - begin);
}

/** What follows the name of a start tag; nothing where it has another name. */
std::optional<std::string_view> AfterName(std::string_view tag, std::string_view name) {
  const bool is_it =
      tag.starts_with(name) &&
      (tag.size() == name.size() || IsBlank(tag[name.size()]) || tag[name.size()] == '/');
  return is_it ? std::optional(tag.substr(name.size())) : std::nullopt;
}

std::optional<int> FindNumber(std::string_view tag, std::string_view name) {
  const auto text = FindAttribute(tag, name);
  int number = 0;
  const bool is_number =
      text && std::from_chars(text->data(), text->data() + text->size(), number).ec == std::errc();
  return is_number ? std::optional(number) : std::nullopt;
}

/** The unit that the tag of the model names. */
void TakeUnit(std::string_view tag, Model3mf* model) {
  constexpr std::array<std::pair<std::string_view, double>, 6> kUnits{{{"micron", 1e-6},
                                                                       {"millimeter", 1e-3},
                                                                       {"centimeter", 1e-2},
                                                                       {"inch", 0.0254},
                                                                       {"foot", 0.3048},
                                                                       {"meter", 1}}};
  const auto unit = FindAttribute(tag, "unit");
  model->is_unit_known = !unit;
  for (const auto& [name, metres] : kUnits) {
    if (unit == name) {
      model->length_unit = metres;
      model->is_unit_known = true;
    }
  }
}

}  // namespace

Model3mf ParseModel3mf(std::string_view xml) {
  Model3mf model;
  // One pass does, as the components belong to the object that they stand in.
  Uses uses;
  std::vector<std::uint64_t> items;
  std::optional<int> object;
  bool is_model_found = false;
  for (std::size_t at = xml.find('<'); at != std::string_view::npos; at = xml.find('<', at)) {
    const std::string_view tag = TakeTag(xml, &at);
    if (const auto of_model = AfterName(tag, "model"); of_model && !is_model_found) {
      is_model_found = true;
      TakeUnit(*of_model, &model);
    }
    if (const auto rest = AfterName(tag, "object")) {
      const auto name = FindAttribute(*rest, "name");
      object = FindNumber(*rest, "id");
      if (object && name && !name->empty()) {
        model.names.try_emplace(*object, *name);
      }
    } else if (const auto of_component = AfterName(tag, "component")) {
      const auto used = FindNumber(*of_component, "objectid");
      if (object && used) {
        uses[static_cast<std::uint64_t>(*object)].push_back(static_cast<std::uint64_t>(*used));
      }
    } else if (const auto of_item = AfterName(tag, "item")) {
      if (const auto used = FindNumber(*of_item, "objectid")) {
        items.push_back(static_cast<std::uint64_t>(*used));
      }
    }
  }
  model.placed = ExamineTree(uses, items);
  return model;
}

}  // namespace hvas::cad
