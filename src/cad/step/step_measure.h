#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/result.h"
#include "cad/step/step_text.h"

namespace hvas::cad {

enum class Quantity { kOther, kLength, kAngle };

/** A number with the unit that its entity names, in SI. */
struct StepMeasure {
  double value{0};  ///< [m], StepText::length_scale() applied; [rad]; or as written for kOther.
  Quantity quantity{Quantity::kOther};
  std::string name;  ///< "nominal value", "upper limit", ...; mostly empty.
};

/** Reads a measure with unit, a measure or value representation item, in one record or complex.
 Without a unit of its own it has that of the context of `representation` (0: none), else
 millimetres or radians. Empty where there is no number. Follows at most eight references. */
[[nodiscard]] std::optional<StepMeasure> ReadMeasure(const StepText& text, std::uint64_t id,
                                                     std::uint64_t representation);

/** One unit of a quantity in the context of a representation [m or rad]; a millimetre or a radian
 where it names none. StepText::length_scale() is applied. */
[[nodiscard]] double ReadUnitOf(const StepText& text, std::uint64_t representation,
                                Quantity quantity);

/** Checks all units of length of a text before anything is converted by them. Errors: those of
 CheckLengthUnit, naming the entity. @param file  Its name. */
[[nodiscard]] Result<void> CheckLengthUnits(const StepText& text, const std::string& file);

/** The unit of length of the first context of the text that has one [m], as it is written; a
 millimetre where there is none. */
[[nodiscard]] double FindLengthUnit(const StepText& text);

}  // namespace hvas::cad
