#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace hvas::fits {

/** What the forces of a fit need to know of a material, at 20 C. */
struct Material {
  std::string_view name;   ///< EN or common designation, with its temper.
  std::string_view group;  ///< "stainless steel", "polymer", ...
  double youngs_modulus;   ///< [Pa]
  double poisson_ratio;
  double density;            ///< [kg/m^3]
  double yield_strength;     ///< Re or Rp0.2; stress at yield of polymers [Pa].
  double tensile_strength;   ///< [Pa]
  double thermal_expansion;  ///< Linear, mean from 20 to 100 C [1/K].
  std::string_view note;     ///< Where sources differ, and which value this is; may be empty.
};

/** The table: handbook values of 40 materials, each checked against a second source where there is
 one. Where two differ the strength is the lower one, so that a press fit is not thought safer than
 it is, and the other values are those of the first unless the note says otherwise. */
[[nodiscard]] std::span<const Material> Materials();

/** A material meant by a name. */
struct MaterialMatch {
  const Material* material{nullptr};  ///< One of Materials().
  bool is_stand_in{false};  ///< The table has only something like it: a plastic for a plastic.
};

/** The material that a name in a CAD file means: a designation of EN, DIN, AISI, SAE, ASTM or UNS
 ("AISI 304", "EN AW-6061-T6", "1.4301"), a trade name ("Delrin"), or a family in one of several
 languages ("Steel", "Stahl"), which stands for its most usual grade. Letters' case, blanks and
 punctuation do not matter. Names are matched in whole words and numbers, the longest first, so that
 "Document" or "Default" mean nothing. */
[[nodiscard]] std::optional<MaterialMatch> FindMaterial(std::string_view name);

/** The most usual material of a density [kg/m^3] within 4 %; with `is_stand_in` a plastic for what
 is lighter than 1700 kg/m^3 otherwise. Nothing for what is like none of them. */
[[nodiscard]] std::optional<MaterialMatch> FindMaterialByDensity(double density);

/** S235JR, for parts of which nothing is known. */
[[nodiscard]] const Material& DefaultMaterial();

}  // namespace hvas::fits
