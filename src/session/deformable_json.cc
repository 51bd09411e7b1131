#include "session/deformable_json.h"

#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "base/parse_json.h"
#include "haptics/giving_curve.h"

namespace hvas::session {
namespace {

using simulation::Deformable;
using simulation::DeformationForm;
using simulation::DeformationKind;
using simulation::DeformationSource;

constexpr const char* kDeformablesAttachment = "deformed_parts.json";

Json MakeFormJson(const Deformable& part) {
  const DeformationForm& form = part.form;
  return {{"occurrence", part.occurrence.value()},
          {"kind", simulation::ToString(form.kind)},
          {"origin_m", MakeJson(form.origin_B)},
          {"axis", MakeJson(form.axis_B)},
          {"aside", MakeJson(form.aside_B)},
          {"length_m", form.length},
          {"range_m", form.range},
          {"across_m", form.across},
          {"shares", form.shares}};
}

Json MakeSourceJson(const DeformationSource& source) {
  Json one{{"moved", source.moved.value()},
           {"against", source.against.value()},
           {"out", MakeJson(source.out_W)},
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

DeformationSource ReadSource(const Json& from, const product::Product& product, JsonFields* all) {
  JsonFields fields(from);
  DeformationSource source;
  const std::size_t count = product.occurrences.size();
  fields.IdBelow("moved", count, &source.moved);
  fields.IdBelow("against", count, &source.against);
  fields("out", source.out_W);
  fields("widest_m", source.widest);
  fields("own_m", source.own);
  if (fields.has("given_m")) {
    auto curve = std::make_shared<haptics::GivingCurve>();
    bool is_pressed = false;
    fields("spacing_m", curve->spacing);
    fields("given_m", curve->given);
    fields("compression_m", curve->compression);
    fields("is_pressed", is_pressed);
    if (!(curve->spacing > 0)) {
      fields.Refuse("spacing_m");
    }
    if (is_pressed) {
      curve->pressed = {0, 0};  // Of its forces nothing is needed.
    }
    source.curve = std::move(curve);
  }
  all->Take(fields);
  return source;
}

/** @param index  Of the part in the list: it stands on parts before it. */
Deformable ReadDeformable(const product::Product& product, std::size_t index, JsonFields* fields) {
  Deformable part;
  DeformationForm& form = part.form;
  fields->IdBelow("occurrence", product.occurrences.size(), &part.occurrence);
  (*fields)("kind", form.kind, simulation::kDeformationNames);
  (*fields)("origin_m", form.origin_B);
  (*fields)("axis", form.axis_B);
  (*fields)("aside", form.aside_B);
  (*fields)("length_m", form.length);
  (*fields)("range_m", form.range);
  (*fields)("across_m", form.across);
  (*fields)("shares", form.shares);
  (*fields)("free_m", part.free);
  (*fields)("sign", part.sign);
  for (const Json& one : fields->Array("below")) {
    if (!one.is_number_unsigned() || one.get<std::size_t>() >= index) {
      fields->Refuse("below");
      break;
    }
    part.below.push_back(one.get<std::size_t>());
  }
  for (const Json& one : fields->Array("sources")) {
    part.sources.push_back(ReadSource(one, product, fields));
  }
  // A damaged record may have numbers that are none.
  const Vec3 vectors = form.origin_B + form.axis_B + form.aside_B;
  const double numbers = form.length + form.range[0] + form.range[1] + form.across[0] +
                         form.across[1] + form.shares[0] + form.shares[1] + part.free + part.sign;
  if (!(form.length > 0) || !vectors.allFinite() || !std::isfinite(numbers)) {
    fields->Refuse("length_m");
  }
  if (form.kind == DeformationKind::kShift && part.sources.empty()) {
    fields->Refuse("sources");
  }
  return part;
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
  const Json list = ParseJson<Json>(std::string_view(text, bytes->size()));
  std::vector<Deformable> parts;
  if (!list.is_array()) {
    return parts;
  }
  for (const Json& one : list) {
    JsonFields fields(one);
    parts.push_back(ReadDeformable(product, parts.size(), &fields));
    if (!fields.refused().empty()) {
      return std::vector<Deformable>();  // Others may stand on it.
    }
  }
  return parts;
}

}  // namespace hvas::session
