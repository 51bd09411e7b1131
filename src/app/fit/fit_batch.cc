#include "app/fit/fit_batch.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "app/fit/sized_fit.h"
#include "base/units.h"
#include "fits/iso286.h"
#include "fits/press_fit.h"

namespace hvas::app {
namespace {

/** Ten digits: more than any input has. */
std::string Number(double value) {
  return fmt::format("{:.10g}", value == 0 ? 0.0 : value);
}

/** Micrometres as tables print them: the numbers are multiples of 0.05. */
std::string Micrometres(double length) {
  return Number(std::round(units::ToUm(length) * 1e6) / 1e6);
}

std::string Explain(const Error& error) {
  return error.remedy.empty() ? error.message : error.message + "; " + error.remedy;
}

/** The numbers of a row, or the first that is missing or none. */
class Row {
 public:
  Row(const CsvTable& table, std::size_t row) : table_(table), row_(row) {}

  double operator()(const char* column, std::optional<double> otherwise = std::nullopt) {
    const std::string_view cell = table_.Get(row_, column);
    const std::optional<double> value = ParseNumber(cell);
    const bool is_number = value && std::isfinite(*value);
    if (!is_number && (!cell.empty() || !otherwise) && reason_.empty()) {
      reason_ = cell.empty() ? fmt::format("{} is missing", column)
                             : fmt::format("{} is not a number: \"{}\"", column, cell);
    }
    return is_number ? *value : otherwise.value_or(0);
  }

  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  const CsvTable& table_;
  std::size_t row_;
  std::string reason_;
};

void SetLimits(std::size_t i, CsvTable* table) {
  for (const char* column : {"kind", "upper_um", "lower_um", "reason"}) {
    table->Set(i, column, "");
  }
  std::string_view text = table->Get(i, "nominal_mm");
  const bool has_text = !text.empty();
  const std::optional<double> number = table->GetNumber(i, "nominal_mm");
  const bool is_number = number && std::isfinite(*number);
  const std::optional<double> length = TakeLength(&text);  // "1.5 in" converts.
  if (!is_number && (!length || !text.empty())) {
    table->Set(
        i, "reason",
        has_text
            ? "nominal_mm is not a number; write millimetres, or inches with their unit: 1.5 in"
            : "nominal_mm is missing");
    return;
  }
  const double nominal = is_number ? units::FromMm(*number) : *length;
  const auto parsed = fits::ParseToleranceClass(table->Get(i, "class"));
  if (!parsed) {
    table->Set(i, "reason", Explain(parsed.error()));
    return;
  }
  table->Set(i, "kind", parsed->is_hole() ? "hole" : "shaft");
  const auto limits = fits::CalcLimits(*parsed, nominal);
  if (!limits) {
    table->Set(i, "reason", Explain(limits.error()));
    return;
  }
  table->Set(i, "upper_um", Micrometres(limits->upper));
  table->Set(i, "lower_um", Micrometres(limits->lower));
}

void SetPressFit(std::size_t i, CsvTable* table) {
  Row row(*table, i);
  const bool has_friction = !table->Get(i, "mu").empty();
  fits::PressFitParameters p;
  p.joint_diameter = units::FromMm(row("d_F_mm"));
  p.hub_diameter = units::FromMm(row("D_hub_mm"));
  p.shaft_bore = units::FromMm(row("d_bore_shaft_mm", 0));
  p.interference = units::FromMm(row("U_eff_diametral_mm"));
  p.length = units::FromMm(row("L_mm"));
  p.friction_in = p.friction_torque = row("mu", 0);
  p.hub.youngs_modulus = units::FromMpa(row("E_hub_MPa"));
  p.hub.poisson_ratio = row("nu_hub");
  p.shaft.youngs_modulus = units::FromMpa(row("E_shaft_MPa"));
  p.shaft.poisson_ratio = row("nu_shaft");
  const auto fit = fits::CalcPressFit(p);
  const bool is_good = row.reason().empty() && fit.has_value();
  const auto set = [&](const char* column, double value) {
    table->Set(i, column, is_good ? Number(value) : "");
  };
  const fits::PressFit f = fit.value_or(fits::PressFit{});
  set("p_MPa", units::ToMpa(f.pressure));
  set("hub_diam_expansion_mm", units::ToMm(f.hub_expansion));
  set("shaft_diam_contraction_mm", units::ToMm(f.shaft_contraction));
  set("hub_bore_hoop_MPa", units::ToMpa(f.hub_bore.hoop));
  set("hub_bore_vonMises_planestress_MPa", units::ToMpa(f.hub_bore.von_mises()));
  set("hub_bore_Tresca_MPa", units::ToMpa(f.hub_bore.tresca()));
  set("shaft_governing_hoop_MPa", units::ToMpa(f.shaft_governing.hoop));
  set("F_axial_N", f.press_in_force);
  set("T_Nmm", 1e3 * f.torque);
  if (is_good && !has_friction) {
    table->Set(i, "F_axial_N", "");
    table->Set(i, "T_Nmm", "");
  }
  table->Set(i, "reason",
             is_good ? "" : (row.reason().empty() ? Explain(fit.error()) : row.reason()));
}

}  // namespace

Result<void> AddLimits(CsvTable* table) {
  if (Result<void> check = table->Require({"nominal_mm", "class"}); !check) {
    return check;
  }
  for (std::size_t i = 0; i < table->row_count(); ++i) {
    SetLimits(i, table);
  }
  return {};
}

Result<void> AddPressFits(CsvTable* table) {
  if (Result<void> check = table->Require({"d_F_mm", "D_hub_mm", "U_eff_diametral_mm", "L_mm",
                                           "E_hub_MPa", "nu_hub", "E_shaft_MPa", "nu_shaft"});
      !check) {
    return check;
  }
  for (std::size_t i = 0; i < table->row_count(); ++i) {
    SetPressFit(i, table);
  }
  return {};
}

}  // namespace hvas::app
