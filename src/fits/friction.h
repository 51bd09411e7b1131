#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace hvas::fits {

/** Dry friction of a pair of surfaces that slide on each other: the coefficient falls from its
 static to its kinetic value with the speed v (Stribeck), rises with viscosity, and before anything
 slides the surfaces give elastically (bristles, Canudas de Wit et al., IEEE TAC 40(3), 1995). */
struct FrictionLaw {
  double static_coefficient{0.15};
  double kinetic_coefficient{0.15};
  double stribeck_speed{1e-3};  ///< v_s [m/s]
  double viscous{0};            ///< [s/m]
  double stiffness{1e6};        ///< Stiffness of the bristles of one contact [N/m].

  /** mu(v) = mu_k + (mu_s - mu_k) exp(-(v / v_s)^2) + viscous v, v >= 0 [m/s]. RT-safe. */
  [[nodiscard]] double CalcCoefficient(double v) const noexcept;
};

/** What a surface is made of, as far as friction is concerned. */
enum class FrictionSurface : std::uint8_t {
  kUnknown,
  kSteel,
  kCastIron,
  kLightMetal,  ///< Aluminium and magnesium.
  kCopperAlloy,
  kPolymer,
};

/** One row of the table. */
struct FrictionEntry {
  FrictionSurface a;
  FrictionSurface b;
  double static_coefficient;
  double kinetic_coefficient;
  std::string_view source;
  std::string_view status;
};

[[nodiscard]] std::span<const FrictionEntry> FrictionTable() noexcept;

/** What is known of the friction of joints that are pressed, shrunk or oiled together:
 FrictionTable() takes its values from here. Ranges where sources give ranges. */
struct JointFriction {
  std::string_view pair;
  std::string_view condition;
  std::string_view symbol;  ///< nu_ll to start along, nu_rl sliding along, nu_ru about the axis.
  double low;
  double high;
  std::string_view source;
  std::string_view status;  ///< How far it was checked.
};

[[nodiscard]] std::span<const JointFriction> JointFrictionTable() noexcept;

/** The row of a pair, in either order; null where the table has none. RT-safe. */
[[nodiscard]] const FrictionEntry* FindFrictionEntry(FrictionSurface a, FrictionSurface b) noexcept;

/** The law of a pair, in either order; of a pair that the table has not, `otherwise`. RT-safe. */
[[nodiscard]] FrictionLaw FindFriction(FrictionSurface a, FrictionSurface b,
                                       const FrictionLaw& otherwise) noexcept;

/** The surface of a material's group in Materials(). */
[[nodiscard]] FrictionSurface SurfaceOf(std::string_view group) noexcept;

}  // namespace hvas::fits
