#include "session/deformable_json.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "session/json_values.h"

namespace hvas::session {
namespace {

using simulation::Deformable;
using simulation::DeformationForm;
using simulation::DeformationKind;
using simulation::DeformationSource;

constexpr const char* kDeformablesAttachment = "deformed_parts.json";

Json ToList(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json MakeFormJson(const Deformable& part) {
  const DeformationForm& form = part.form;
  return {{"occurrence", part.occurrence.value()},
          {"kind", simulation::ToString(form.kind)},
          {"origin_m", ToList(form.origin_B)},
          {"axis", ToList(form.axis_B)},
          {"aside", ToList(form.aside_B)},
          {"length_m", form.length},
          {"range_m", form.range},
          {"across_m", form.across},
          {"shares", form.shares}};
}

Json MakeSourceJson(const DeformationSource& source) {
  Json one{{"moved", source.moved.value()},
           {"against", source.against.value()},
           {"out", ToList(source.out_W)},
           {"widest_m", source.widest},
           {"own_m", source.own}};
  if (source.curve != nullptr) {
    one["spacing_m"] = source.curve->spacing;
    one["given_m"] = source.curve->given;
    one["compression_m"] = source.curve->compression;
    one["is_pressed"] = !source.curve->pressed.empty();
  }
  return one;
}

/** Takes the numbers of a list of that many; false where it has others. */
template <typename List>
bool TakeNumbers(const Json& from, const char* key, List* to) {
  const Json* list = FieldOf(from, key);
  if (list == nullptr || !list->is_array() || list->size() != to->size()) {
    return false;
  }
  for (std::size_t i = 0; i < to->size(); ++i) {
    if (!(*list)[i].is_number()) {
      return false;
    }
    (*to)[static_cast<decltype(to->size())>(i)] = (*list)[i].get<double>();
  }
  return true;
}

bool TakeVector(const Json& from, const char* key, Vec3* to) {
  std::array<double, 3> numbers{};
  const bool is_read = TakeNumbers(from, key, &numbers);
  *to = Vec3(numbers[0], numbers[1], numbers[2]);
  return is_read;
}

/** Takes a list of any length. */
bool TakeList(const Json& from, const char* key, std::vector<double>* to) {
  const Json* list = FieldOf(from, key);
  to->resize(list != nullptr && list->is_array() ? list->size() : 0);
  return TakeNumbers(from, key, to);
}

bool TakeOccurrence(const Json& from, const char* key, const product::Product& product,
                    product::OccurrenceId* to) {
  const std::uint32_t index = IndexOr(from, key, 0xffffffffU);
  *to = product::OccurrenceId(index);
  return index < product.occurrences.size();
}

bool ParseSource(const Json& from, const product::Product& product, DeformationSource* source) {
  bool is_sound = TakeOccurrence(from, "moved", product, &source->moved) &&
                  TakeOccurrence(from, "against", product, &source->against) &&
                  TakeVector(from, "out", &source->out_W) && TakeList(from, "own_m", &source->own);
  source->widest = NumberOr(from, "widest_m", 0);
  if (FieldOf(from, "given_m") != nullptr) {
    auto curve = std::make_shared<haptics::GivingCurve>();
    is_sound = is_sound && TakeList(from, "given_m", &curve->given);
    curve->spacing = NumberOr(from, "spacing_m", 0);
    curve->compression = NumberOr(from, "compression_m", 0);
    is_sound = is_sound && curve->spacing > 0;
    if (FlagOr(from, "is_pressed", false)) {
      curve->pressed = {0, 0};  // Of its forces nothing is needed.
    }
    source->curve = std::move(curve);
  }
  return is_sound;
}

bool ParseDeformable(const Json& from, const product::Product& product, std::size_t index,
                     Deformable* part) {
  DeformationForm& form = part->form;
  const std::string kind = TextOr(from, "kind", "");
  bool is_sound = false;
  for (int k = 0; k <= static_cast<int>(DeformationKind::kShift); ++k) {
    if (kind == simulation::ToString(static_cast<DeformationKind>(k))) {
      form.kind = static_cast<DeformationKind>(k);
      is_sound = true;
    }
  }
  is_sound =
      is_sound && TakeOccurrence(from, "occurrence", product, &part->occurrence) &&
      TakeVector(from, "origin_m", &form.origin_B) && TakeVector(from, "axis", &form.axis_B) &&
      TakeVector(from, "aside", &form.aside_B) && TakeNumbers(from, "range_m", &form.range) &&
      TakeNumbers(from, "across_m", &form.across) && TakeNumbers(from, "shares", &form.shares);
  form.length = NumberOr(from, "length_m", 0);
  part->free = NumberOr(from, "free_m", 0);
  part->sign = NumberOr(from, "sign", 1);
  const Json* below = FieldOf(from, "below");
  for (const Json& one : below != nullptr ? *below : Json::array()) {
    if (!one.is_number_unsigned() || one.get<std::uint64_t>() >= index) {
      return false;
    }
    part->below.push_back(one.get<std::size_t>());
  }
  const Json* sources = FieldOf(from, "sources");
  for (const Json& one : sources != nullptr ? *sources : Json::array()) {
    is_sound = is_sound && ParseSource(one, product, &part->sources.emplace_back());
  }
  const bool has_place = form.kind != DeformationKind::kShift || !part->sources.empty();
  return is_sound && form.length > 0 && has_place;
}

}  // namespace

Json MakeFormsJson(const std::vector<Deformable>& deformables) {
  Json list = Json::array();
  for (const Deformable& part : deformables) {
    list.push_back(MakeFormJson(part));
  }
  return list;
}

void AttachDeformables(const std::vector<Deformable>& deformables, record::Recorder* recorder) {
  if (deformables.empty()) {
    return;
  }
  Json list = Json::array();
  for (const Deformable& part : deformables) {
    Json one = MakeFormJson(part);
    one["free_m"] = part.free;
    one["sign"] = part.sign;
    one["below"] = part.below;
    one["sources"] = Json::array();
    for (const DeformationSource& source : part.sources) {
      one["sources"].push_back(MakeSourceJson(source));
    }
    list.push_back(std::move(one));
  }
  const std::string text = list.dump();
  const auto bytes = std::as_bytes(std::span(text));
  recorder->AddAttachment({kDeformablesAttachment, {bytes.begin(), bytes.end()}});
}

Result<std::vector<Deformable>> ReadDeformables(const product::Product& product,
                                                record::Reader* reader) {
  const auto bytes = reader->ReadAttachment(kDeformablesAttachment);
  if (!bytes) {
    return bytes.error().code == ErrorCode::kNotFound ? Result<std::vector<Deformable>>({})
                                                      : Unexpected(bytes.error());
  }
  const auto* text = reinterpret_cast<const char*>(bytes->data());
  const Json list = Json::parse(text, text + bytes->size(), nullptr, false);
  std::vector<Deformable> parts;
  if (!list.is_array()) {
    return parts;
  }
  for (const Json& one : list) {
    Deformable part;
    if (!ParseDeformable(one, product, parts.size(), &part)) {
      return std::vector<Deformable>();  // Others may stand on it.
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace hvas::session
