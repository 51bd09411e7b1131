#pragma once

#include <string_view>

#include "fits/materials.h"

/** Joining by heating the hub, cooling the shaft, or both (N4). Temperatures in degrees Celsius as
 people state them, with the suffix _c; differences in kelvin. */
namespace hvas::fits {

inline constexpr double kAbsoluteZero_c = -273.15;  ///< A definition.
inline constexpr double kDryIce_c = -78;            ///< Boils off at -78.5 C at ambient pressure.
inline constexpr double kNitrogen_c = -196;  ///< Liquid, boils at -195.8 C: as cold as shafts get.

/** How a material takes heat and cold while it is joined. */
struct JoiningMaterial {
  double heating{11e-6};  ///< alpha, mean from room temperature upwards [1/K], > 0.
  double cooling{
      8.5e-6};            ///< alpha, mean from room temperature down to liquid nitrogen [1/K], > 0.
  double hottest_c{200};  ///< Hotter than this a hub loses strength or hardness [C].
  std::string_view source;        ///< Source of the coefficients.
  std::string_view limit_source;  ///< Source of `hottest_c`, and why.
};

/** The values of a material of the table: coefficients for heating and for cooling of DIN 7190
 where it has its group (steel 11 and 8.5, cast iron 10 and 8, aluminium 23 and 18, magnesium 26 and
 21, copper and bronze 16 and 14, brass 18 and 16, in 1e-6/K). Elsewhere the handbook's for heating,
 and of it for cooling 0.77, as of steel, or 0.5 of polymers, which is on the safe side. The limit
 of temperature is that of its tempering: DIN 7190 for steels and ductile iron, handbooks for
 others. */
[[nodiscard]] JoiningMaterial FindJoiningMaterial(const Material& material) noexcept;

struct ThermalJoint {
  double joint_diameter{0};        ///< D_F [m], > 0.
  double interference{0};          ///< U at room temperature, the largest, never smoothed [m].
  double hub_expansion{11e-6};     ///< alpha_A, heating [1/K], > 0.
  double shaft_expansion{8.5e-6};  ///< alpha_I, cooling [1/K], > 0.
  double room_c{20};
  double hub_contraction{8.5e-6};  ///< Expansion of the hub below room temperature [1/K], > 0.
  double shaft_heating{11e-6};     ///< Expansion of the shaft above room temperature [1/K], > 0.
};

/** The clearance that DIN 7190-1 asks for while joining: S_f = D_F / 1000 [m]. */
[[nodiscard]] double CalcJoiningClearance(double joint_diameter) noexcept;

/** Diametral clearance with hub and shaft at their temperatures [m]:
   D_F (alpha_A (theta_A - theta_R) - alpha_I (theta_I - theta_R)) - U,
 each side with its coefficient for heating above theta_R and for cooling below. */
[[nodiscard]] double CalcHotClearance(const ThermalJoint& joint, double hub_c,
                                      double shaft_c) noexcept;

/** Temperature of the hub for a clearance, with the shaft at its own (DIN 7190-1, thermal joining):
   theta_A = theta_R + (U + S) / (alpha_A D_F) + (alpha_I / alpha_A) (theta_I - theta_R). */
[[nodiscard]] double CalcHubTemperature(const ThermalJoint& joint, double clearance,
                                        double shaft_c) noexcept;

/** Temperature of the shaft for a clearance, with the hub at its own. A number below kNitrogen_c,
 or even below kAbsoluteZero_c, means that cold alone does not do it. */
[[nodiscard]] double CalcShaftTemperature(const ThermalJoint& joint, double clearance,
                                          double hub_c) noexcept;

/** How heat goes from hub to shaft while they slide together. */
struct HeatExchange {
  double hub_capacity{0};    ///< Mass times specific heat [J/K], > 0.
  double shaft_capacity{0};  ///< [J/K], > 0.
  double conductance{
      0};           ///< Conductance of the joint, for each square metre engaged [W/(m2 K)], > 0.
  double speed{0};  ///< Speed of insertion [m/s], > 0.
};

/** Specific heat of a material's group in Materials(), handbook values near 100 C [J/(kg K)]: steel
 480, cast iron 500, aluminium 900, magnesium 1020, copper alloys and zinc 390, titanium 530,
 polymers 1500. */
[[nodiscard]] double SpecificHeatOf(std::string_view group) noexcept;

/** What still air in a gap of parts beside each other carries, 0.03 W/(m K) at about 100 C, over
 the gap [W/(m2 K)]. @param clearance  Of the diameters [m], > 0: the gap is half of it. */
[[nodiscard]] double CalcGapConductance(double clearance) noexcept;

/** The depth at which the shaft sticks [m], +inf if it never does.

 Both parts are lumps; heat flows through the area pi D_F l that is engaged at the depth l = v t, so
 their difference falls as
   Delta(t) = Delta_0 exp(-k v t^2 / 2),  k = h pi D_F (1 / C_A + 1 / C_I),
 about a mean that stays. It sticks where the clearance is gone. What the surroundings take is
 neglected: seconds against minutes. */
[[nodiscard]] double CalcStickingDepth(const ThermalJoint& joint, double hub_c, double shaft_c,
                                       const HeatExchange& exchange) noexcept;

}  // namespace hvas::fits
