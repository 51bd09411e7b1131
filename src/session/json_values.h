#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

/** Fields of JSON objects that anybody may have written: each function gives `missing` where the
 object is none, the field is not there or of another type, or a number is out of range. `Json` is
 any nlohmann::basic_json. */
namespace hvas::session {

/** Null where there is no such field. */
template <typename Json>
const Json* FieldOf(const Json& object, const char* name) {
  if (!object.is_object()) {
    return nullptr;
  }
  const auto found = object.find(name);
  return found != object.end() ? &*found : nullptr;
}

template <typename Json>
std::string TextOr(const Json& object, const char* name, std::string missing) {
  const Json* field = FieldOf(object, name);
  return field != nullptr && field->is_string() ? field->template get<std::string>()
                                                : std::move(missing);
}

template <typename Json>
bool FlagOr(const Json& object, const char* name, bool missing) {
  const Json* field = FieldOf(object, name);
  return field != nullptr && field->is_boolean() ? field->template get<bool>() : missing;
}

/** A finite number. */
template <typename Json>
double NumberOr(const Json& object, const char* name, double missing) {
  const Json* field = FieldOf(object, name);
  const double number =
      field != nullptr && field->is_number() ? field->template get<double>() : missing;
  return std::isfinite(number) ? number : missing;
}

/** A whole number from 0 to 2^32 - 1. */
template <typename Json>
std::uint32_t IndexOr(const Json& object, const char* name, std::uint32_t missing) {
  const Json* field = FieldOf(object, name);
  if (field == nullptr || !field->is_number_unsigned()) {
    return missing;
  }
  const auto number = field->template get<std::uint64_t>();
  return number <= std::numeric_limits<std::uint32_t>::max() ? static_cast<std::uint32_t>(number)
                                                             : missing;
}

}  // namespace hvas::session
