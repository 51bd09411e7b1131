#include "app/fit_batch.h"

#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "app/sized_fit.h"
#include "base/units.h"
#include "fits/insertion.h"
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
    const std::optional<double> value = table_.GetNumber(row_, column);
    if ((value && !std::isfinite(*value)) || (!value && !otherwise)) {
      reason_ = reason_.empty() ? fmt::format("{} is {}", column, value ? "no number" : "missing")
                                : reason_;
    }
    return value.value_or(otherwise.value_or(0));
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
    table->Set(i, "reason",
               has_text ? "nominal_mm is no number; write millimetres, or inches as in 1.5 in"
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
  const bool has_friction = table->GetNumber(i, "mu").has_value();
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

/** "D=40 d=39.9 theta=4 deg": numbers by name, in mm, N, N mm, rad; an angle may say deg. */
class Inputs {
 public:
  explicit Inputs(std::string_view text) {
    std::string last;
    while (!text.empty()) {
      const std::size_t end = text.find(' ');
      const std::string_view word = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      const std::size_t equals = word.find('=');
      if (equals != std::string_view::npos) {
        last = std::string(word.substr(0, equals));
        const std::string_view number = word.substr(equals + 1);
        double value = 0;
        const auto [stop, error] =
            std::from_chars(number.data(), number.data() + number.size(), value);
        values_[last] =
            error == std::errc() && stop == number.data() + number.size() ? value : std::nan("");
      } else if (word == "deg" && values_.count(last) > 0) {
        values_[last] = units::FromDeg(values_[last]);
      }
    }
  }

  [[nodiscard]] double operator()(const char* name) const {
    const auto it = values_.find(name);
    if (it == values_.end() || !std::isfinite(it->second)) {
      reason_ =
          reason_.empty() ? fmt::format("the input {} is missing or no number", name) : reason_;
      return 1;
    }
    return it->second;
  }

  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::map<std::string, double> values_;
  mutable std::string reason_;
};

/** In the units of a table: mm, N, N mm. */
struct Question {
  std::string_view kind;
  std::string_view output;
  bool is_deg;
  const Inputs& in;
};

bool Begins(std::string_view text, std::string_view with) {
  return text.starts_with(with);
}

std::optional<std::string> AnswerTwoPoint(const Question& q) {
  const bool has_radii = q.kind == "two_point_depth";
  const fits::PegInHole pair = has_radii ? fits::PegInHole{2 * q.in("R"), 2 * q.in("r")}
                                         : fits::PegInHole{q.in("D"), q.in("d")};
  const auto angle = [&](double value) { return Number(q.is_deg ? units::ToDeg(value) : value); };
  if (has_radii) {
    return Number(fits::CalcTipDepth(pair, q.in("theta")));
  }
  if (Begins(q.output, "theta2")) {
    return angle(fits::CalcTwoPointTilt(pair, q.in("l")));
  }
  if (Begins(q.output, "theta_m approx")) {
    return angle(std::sqrt(2 * pair.relative_clearance()));
  }
  if (Begins(q.output, "theta_m")) {
    return angle(fits::CalcLargestTilt(pair));
  }
  if (Begins(q.output, "Whitney")) {
    return angle(pair.relative_clearance() * pair.hole_diameter / q.in("l"));
  }
  if (Begins(q.output, "l_min")) {
    return Number(fits::CalcLeastTwoPointLength(pair));
  }
  if (Begins(q.output, "l2") || q.output == "l") {
    return Number(fits::CalcTwoPointLength(pair, q.in("theta")));
  }
  if (q.output == "c" || Begins(q.output, "c=")) {
    return Number(pair.relative_clearance());
  }
  return std::nullopt;
}

std::optional<std::string> AnswerJamming(const Question& q) {
  const double lambda = fits::CalcLambda(q.in("l"), q.in("r"), q.in("mu"));
  if (Begins(q.output, "wedging")) {
    const double d = 2 * q.in("r");
    return fits::CanWedge({d, d}, q.in("l"), q.in("mu")) ? "1" : "0";
  }
  if (Begins(q.output, "lambda")) {
    return Number(lambda);
  }
  if (Begins(q.output, "vertices")) {
    std::string text;
    for (const fits::DiagramPoint& p : fits::CalcJammingDiagram(lambda, q.in("mu"))) {
      text +=
          fmt::format("{}({:.6g};{:.6g})", text.empty() ? "" : " ", p.f_x_over_f_z, p.m_over_r_f_z);
    }
    return text;
  }
  if (Begins(q.output, "slides")) {
    return fits::IsSliding({q.in("Fx"), q.in("Fz"), q.in("M")}, q.in("l"), q.in("r"), q.in("mu"))
               ? "1"
               : "0";
  }
  return std::nullopt;
}

std::optional<std::string> AnswerStatics(const Question& q) {
  const fits::PegLoad load =
      fits::CalcTwoPointLoad(q.in("f1"), q.in("f2"), q.in("l"), q.in("r"), q.in("mu"));
  if (q.output == "Fx") {
    return Number(load.f_x);
  }
  if (q.output == "Fz") {
    return Number(load.f_z);
  }
  if (q.output == "M") {
    return Number(load.m);
  }
  if (Begins(q.output, "M/(r")) {
    return Number(load.m / (q.in("r") * load.f_z));
  }
  return std::nullopt;
}

std::optional<std::string> AnswerSupport(const Question& q) {
  const fits::CompliantSupport support{q.in("Kx"), q.in("Kt"), q.in("Lg")};
  const fits::InsertionForce f =
      q.kind == "chamfer"
          ? fits::CalcChamferForce(support, q.in("r"), q.in("mu"), q.in("alpha"), q.in("z"))
          : fits::CalcOnePointForce(support, q.in("r"), q.in("mu"), q.in("eps0'"), q.in("theta0"),
                                    q.in("l"));
  if (q.output == "Fz") {
    return Number(f.f_z);
  }
  if (q.output == "Fx") {
    return Number(f.f_x);
  }
  if (q.output == "f" || q.output == "f normal") {
    return Number(f.normal);
  }
  return std::nullopt;
}

std::optional<std::string> Answer(const Question& q) {
  if (Begins(q.kind, "two_point")) {
    return AnswerTwoPoint(q);
  }
  if (q.kind == "jamming" || q.kind == "wedging") {
    return AnswerJamming(q);
  }
  if (q.kind == "statics") {
    return AnswerStatics(q);
  }
  if (q.kind == "chamfer" || q.kind == "one_point") {
    return AnswerSupport(q);
  }
  return std::nullopt;
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

Result<void> AddInsertions(CsvTable* table) {
  if (Result<void> check = table->Require({"kind", "id", "inputs", "output"}); !check) {
    return check;
  }
  std::string inputs;
  std::string id;
  for (std::size_t i = 0; i < table->row_count(); ++i) {
    const std::string own(table->Get(i, "inputs"));
    if (!own.empty() || table->Get(i, "id") != id) {
      inputs = own;
      id = std::string(table->Get(i, "id"));
    }
    const Inputs in(inputs);
    const std::string kind(table->Get(i, "kind"));
    const std::string output(table->Get(i, "output"));
    const std::optional<std::string> value =
        Answer({kind, output, table->Get(i, "unit") == "deg", in});
    const bool is_good = value && in.reason().empty();
    table->Set(i, "value", is_good ? *value : "");
    table->Set(i, "reason",
               is_good
                   ? ""
                   : (in.reason().empty()
                          ? fmt::format("there is no output \"{}\" of kind \"{}\"", output, kind)
                          : in.reason()));
  }
  return {};
}

}  // namespace hvas::app
