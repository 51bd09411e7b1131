#include "app/output/round_json.h"

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace hvas::app {
namespace {

// Significant digits of what has no decimals of its own: a metre to a nanometre.
constexpr int kDigits = 9;

constexpr std::array<std::pair<std::string_view, int>, 7> kDecimals{
    {{"_um", 4}, {"_mm", 6}, {"_n", 3}, {"_nm", 4}, {"_mpa", 4}, {"_c", 2}, {"_deg", 6}}};

double RoundTo(double value, int decimals) {
  const double scale = std::pow(10, decimals);
  const double rounded = std::round(value * scale) / scale;
  return std::isfinite(rounded) ? rounded + 0.0 : value;
}

double Round(double value, std::string_view name) {
  for (const auto& [ending, decimals] : kDecimals) {
    if (name.ends_with(ending)) {
      return RoundTo(value, decimals);
    }
  }
  if (value == 0) {
    return 0;
  }
  return RoundTo(value, kDigits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
}

void RoundUnder(std::string_view name, nlohmann::ordered_json* json) {
  if (json->is_number_float()) {
    *json = Round(json->get<double>(), name);
  } else if (json->is_array()) {
    for (nlohmann::ordered_json& element : *json) {
      RoundUnder(name, &element);
    }
  } else if (json->is_object()) {
    for (auto it = json->begin(); it != json->end(); ++it) {
      RoundUnder(it.key(), &it.value());
    }
  }
}

}  // namespace

void RoundNumbers(nlohmann::ordered_json* json) {
  RoundUnder("", json);
}

}  // namespace hvas::app
