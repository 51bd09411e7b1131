#include "cad/step/step_measure.h"

#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "cad/length_unit.h"

namespace hvas::cad {
namespace {

using Kind = StepValue::Kind;

constexpr int kMaxUnitDepth = 8;  // Of units by other units.

struct Unit {
  double scale{1};
  Quantity quantity{Quantity::kOther};
};

/** A number and the unit that it refers to. */
struct Raw {
  double number{0};
  std::uint64_t unit{0};
  Quantity quantity{Quantity::kOther};  // By the type of the number.
  std::string name;
};

Quantity ToQuantity(std::string_view type) {
  if (type.find("LENGTH") != std::string_view::npos) {
    return Quantity::kLength;
  }
  return type.find("PLANE_ANGLE") != std::string_view::npos ? Quantity::kAngle : Quantity::kOther;
}

std::optional<Raw> ReadRaw(const StepText& text, std::uint64_t id) {
  Raw raw;
  bool has_number = false;
  for (const StepRecord& record : text.Find(id)) {
    for (const StepValue& value : record.values) {
      const bool is_typed = value.kind == Kind::kTyped && value.items.size() == 1 &&
                            value.items.front().kind == Kind::kNumber;
      if (!has_number && (is_typed || value.kind == Kind::kNumber)) {
        has_number = true;
        raw.number = is_typed ? value.items.front().number : value.number;
        raw.quantity = ToQuantity(is_typed ? value.text : record.name);
      } else if (has_number && raw.unit == 0 && value.kind == Kind::kReference) {
        raw.unit = value.reference;
      } else if (value.kind == Kind::kText && raw.name.empty()) {
        raw.name = value.text;
      }
    }
  }
  return has_number ? std::optional(raw) : std::nullopt;
}

/** NaN for a prefix that ISO 10303-41 does not have. */
double PrefixScale(std::string_view prefix) {
  static constexpr std::array<std::pair<std::string_view, double>, 16> kPrefixes{{{"EXA", 1e18},
                                                                                  {"PETA", 1e15},
                                                                                  {"TERA", 1e12},
                                                                                  {"GIGA", 1e9},
                                                                                  {"MEGA", 1e6},
                                                                                  {"KILO", 1e3},
                                                                                  {"HECTO", 1e2},
                                                                                  {"DECA", 10},
                                                                                  {"DECI", 0.1},
                                                                                  {"CENTI", 1e-2},
                                                                                  {"MILLI", 1e-3},
                                                                                  {"MICRO", 1e-6},
                                                                                  {"NANO", 1e-9},
                                                                                  {"PICO", 1e-12},
                                                                                  {"FEMTO", 1e-15},
                                                                                  {"ATTO", 1e-18}}};
  for (const auto& [name, scale] : kPrefixes) {
    if (prefix == name) {
      return scale;
    }
  }
  return prefix.empty() ? 1 : std::numeric_limits<double>::quiet_NaN();
}

Unit MakeSiUnit(const StepText& text, const StepRecord& record) {
  std::string prefix;
  std::string name;
  for (const StepValue& value : record.values) {
    if (value.kind == Kind::kEnum) {
      prefix = std::exchange(name, value.text);
    }
  }
  const Quantity quantity = name == "METRE"    ? Quantity::kLength
                            : name == "RADIAN" ? Quantity::kAngle
                                               : Quantity::kOther;
  const double scale = quantity == Quantity::kLength ? text.length_scale() : 1;
  return {scale * PrefixScale(prefix), quantity};
}

/** Nothing where it cannot be read; without a number where units are defined by one another. */
std::optional<Unit> ReadUnit(const StepText& text, std::uint64_t id, int depth) {
  if (depth > kMaxUnitDepth) {
    return Unit{std::numeric_limits<double>::quiet_NaN(), Quantity::kOther};
  }
  for (const StepRecord& record : text.Find(id)) {
    if (record.name == "SI_UNIT") {
      return MakeSiUnit(text, record);
    }
    const bool is_converted = record.name.find("CONVERSION_BASED_UNIT") == 0;
    if (is_converted && record.values.size() > 1) {
      const auto raw = ReadRaw(text, record.values.back().reference);
      const auto base = raw ? ReadUnit(text, raw->unit, depth + 1) : std::nullopt;
      if (base) {
        return Unit{raw->number * base->scale, base->quantity};
      }
      return std::nullopt;  // Looks at no second one: many in each step would take for ever.
    }
  }
  return std::nullopt;
}

/** The unit of a quantity that a context assigns. */
std::optional<Unit> ReadAssignedUnit(const StepText& text, std::uint64_t context,
                                     Quantity quantity) {
  for (const StepRecord& record : text.Find(context)) {
    if (record.name != "GLOBAL_UNIT_ASSIGNED_CONTEXT" || record.values.empty()) {
      continue;
    }
    for (const StepValue& value : record.values.back().items) {
      const auto unit = ReadUnit(text, value.reference, 0);
      if (unit && unit->quantity == quantity && std::isfinite(unit->scale)) {
        return unit;
      }
    }
  }
  return std::nullopt;
}

/** The unit of a quantity in the context of a representation. */
std::optional<Unit> ReadContextUnit(const StepText& text, std::uint64_t representation,
                                    Quantity quantity) {
  std::uint64_t context = 0;
  for (const StepRecord& record : text.Find(representation)) {
    if (record.values.size() > 2) {
      context = record.values[2].reference;
    }
  }
  return ReadAssignedUnit(text, context, quantity);
}

/** The unit where the text names none. */
Unit MakeDefaultUnit(const StepText& text, Quantity quantity) {
  const bool is_length = quantity == Quantity::kLength;
  return {is_length ? units::kMetresPerMillimetre * text.length_scale() : 1, quantity};
}

}  // namespace

Result<void> CheckLengthUnits(const StepText& text, const std::string& file) {
  for (const StepText::Statement& statement : text.statements()) {
    if (statement.body.find("LENGTH_UNIT") == std::string_view::npos) {
      continue;
    }
    const auto unit = ReadUnit(text, statement.id, 0);
    if (!unit) {
      continue;
    }
    auto checked = CheckLengthUnit(unit->scale / text.length_scale(), file,
                                   fmt::format("entity #{}", statement.id));
    if (!checked) {
      return checked;
    }
  }
  return {};
}

double FindLengthUnit(const StepText& text) {
  for (const StepText::Statement& statement : text.statements()) {
    if (statement.body.find("GLOBAL_UNIT_ASSIGNED_CONTEXT") == std::string_view::npos) {
      continue;
    }
    const auto unit = ReadAssignedUnit(text, statement.id, Quantity::kLength);
    if (unit && unit->scale > 0) {
      return unit->scale / text.length_scale();
    }
  }
  return units::kMetresPerMillimetre;
}

double ReadUnitOf(const StepText& text, std::uint64_t representation, Quantity quantity) {
  const std::optional<Unit> unit = ReadContextUnit(text, representation, quantity);
  return unit && unit->scale > 0 ? unit->scale : MakeDefaultUnit(text, quantity).scale;
}

std::optional<StepMeasure> ReadMeasure(const StepText& text, std::uint64_t id,
                                       std::uint64_t representation) {
  const auto raw = ReadRaw(text, id);
  if (!raw) {
    return std::nullopt;
  }
  auto unit = ReadUnit(text, raw->unit, 0);
  if (!unit || !std::isfinite(unit->scale)) {
    unit = ReadContextUnit(text, representation, raw->quantity);
  }
  if (!unit) {
    unit = MakeDefaultUnit(text, raw->quantity);
  }
  const double value = raw->number * unit->scale + 0.0;  // Files have -0.
  constexpr double kAbsurd =
      1e12;  // Larger than any product; sums and products of less are finite.
  if (!(std::abs(value) < kAbsurd)) {
    return std::nullopt;
  }
  return StepMeasure{value, unit->quantity, raw->name};
}

}  // namespace hvas::cad
