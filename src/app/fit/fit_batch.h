#pragma once

#include "app/fit/csv_table.h"

/** Tables of fits: rows in, the same rows with results out. A row that cannot be answered keeps its
 place; its results are empty and the column `reason` says why. */
namespace hvas::app {

/** Columns in: nominal_mm, class. Out: kind (hole or shaft), upper_um, lower_um, reason. */
[[nodiscard]] Result<void> AddLimits(CsvTable* table);

/** Columns in: d_F_mm, D_hub_mm, d_bore_shaft_mm, U_eff_diametral_mm, L_mm, mu, E_hub_MPa, nu_hub,
 E_shaft_MPa, nu_shaft. Out: p_MPa, hub_diam_expansion_mm, shaft_diam_contraction_mm,
 hub_bore_hoop_MPa, hub_bore_vonMises_planestress_MPa, hub_bore_Tresca_MPa,
 shaft_governing_hoop_MPa, F_axial_N, T_Nmm, reason. Without mu no force and no torque. */
[[nodiscard]] Result<void> AddPressFits(CsvTable* table);

}  // namespace hvas::app
