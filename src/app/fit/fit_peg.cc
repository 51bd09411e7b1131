#include "app/fit/fit_peg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "base/units.h"
#include "fits/insertion.h"

namespace hvas::app {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/** What a number of a question measures. */
enum class Kind { kLength, kAngle, kForce, kMoment, kStiffness, kTiltStiffness, kPure };

struct Unit {
  Kind kind;
  std::string_view name;  // Without blanks.
  double factor;          // In mm, rad, N, N mm, N/mm, N mm/rad.
};

constexpr std::array<Unit, 20> kUnits{{
    {Kind::kLength, "mm", 1},
    {Kind::kLength, "um", 1e-3},
    {Kind::kLength, "cm", 10},
    {Kind::kLength, "m", 1e3},
    {Kind::kLength, "in", 25.4},
    {Kind::kAngle, "rad", 1},
    {Kind::kAngle, "deg", std::numbers::pi / 180},
    {Kind::kForce, "N", 1},
    {Kind::kForce, "kN", 1e3},
    {Kind::kMoment, "Nmm", 1},
    {Kind::kMoment, "Nm", 1e3},
    {Kind::kStiffness, "N/mm", 1},
    {Kind::kStiffness, "N/um", 1e3},
    {Kind::kStiffness, "N/m", 1e-3},
    {Kind::kTiltStiffness, "Nmm/rad", 1},
    {Kind::kTiltStiffness, "Nm/rad", 1e3},
    {Kind::kPure, "-", 1},
    {Kind::kPure, "1", 1},
    {Kind::kPure, "bool", 1},
    {Kind::kPure, "%", 1e-2},
}};

std::string WithoutBlanks(std::string_view text) {
  std::string out(text);
  std::erase(out, ' ');
  return out;
}

/** What a unit is worth; 1 where none is stated. */
std::optional<double> FindFactor(Kind kind, std::string_view name) {
  if (name.empty()) {
    return 1;
  }
  const auto unit = std::find_if(kUnits.begin(), kUnits.end(),
                                 [&](const Unit& u) { return u.kind == kind && u.name == name; });
  return unit != kUnits.end() ? std::optional(unit->factor) : std::nullopt;
}

/** "mm, um, cm, m or in". */
std::string UnitsOf(Kind kind) {
  std::string text;
  for (const Unit& unit : kUnits) {
    if (unit.kind == kind) {
      text += (text.empty() ? "" : ", ") + std::string(unit.name);
    }
  }
  return text;
}

/** An input, and the numbers that it can be. */
struct InputRule {
  std::string_view name;
  Kind kind;
  double low;
  bool includes_low;
  double high;  // Not itself.
};

constexpr double kRight = std::numbers::pi / 2;  // A right angle [rad].

constexpr std::array<InputRule, 19> kRules{{
    {"D", Kind::kLength, 0, false, kInfinity},
    {"d", Kind::kLength, 0, false, kInfinity},
    {"R", Kind::kLength, 0, false, kInfinity},
    {"r", Kind::kLength, 0, false, kInfinity},
    {"l", Kind::kLength, 0, true, kInfinity},
    {"Lg", Kind::kLength, 0, true, kInfinity},
    {"z", Kind::kLength, 0, true, kInfinity},
    {"eps0'", Kind::kLength, -kInfinity, false, kInfinity},
    {"theta", Kind::kAngle, 0, false, kRight},
    {"theta0", Kind::kAngle, -kRight, false, kRight},
    {"alpha", Kind::kAngle, 0, false, kRight},
    {"mu", Kind::kPure, 0, true, kInfinity},
    {"f1", Kind::kForce, 0, true, kInfinity},
    {"f2", Kind::kForce, 0, true, kInfinity},
    {"Fx", Kind::kForce, -kInfinity, false, kInfinity},
    {"Fz", Kind::kForce, 0, false, kInfinity},
    {"M", Kind::kMoment, -kInfinity, false, kInfinity},
    {"Kx", Kind::kStiffness, 0, false, kInfinity},
    {"Kt", Kind::kTiltStiffness, 0, false, kInfinity},
}};

/** "D=40 d=39.9 theta=4 deg": numbers by name. Keeps the first reason why it is no good. */
class Inputs {
 public:
  explicit Inputs(std::string_view text) {
    std::string name;
    std::string number;
    std::string unit;
    while (!text.empty()) {
      const std::size_t end = text.find(' ');
      const std::string_view word = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      const std::size_t equals = word.find('=');
      if (equals == std::string_view::npos) {
        unit += word;
        continue;
      }
      Take(name, number, unit);
      name = std::string(word.substr(0, equals));
      number = std::string(word.substr(equals + 1));
      unit.clear();
    }
    Take(name, number, unit);
    CheckPair("D", "d", "diameter");
    CheckPair("R", "r", "radius");
  }

  [[nodiscard]] double operator()(const char* name) const {
    const auto it = values_.find(name);
    if (it == values_.end()) {
      Refuse(fmt::format("the input {} is missing or not a number", name));
      return 1;
    }
    return it->second;
  }

  void Refuse(std::string reason) const {
    if (reason_.empty()) {
      reason_ = std::move(reason);
    }
  }

  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  void Take(const std::string& name, const std::string& number, const std::string& unit) {
    if (name.empty()) {
      if (!unit.empty()) {
        Refuse(fmt::format("\"{}\" belongs to no input; write inputs like D=40 d=39.9", unit));
      }
      return;
    }
    const auto rule = std::find_if(kRules.begin(), kRules.end(),
                                   [&name](const InputRule& r) { return r.name == name; });
    if (rule == kRules.end()) {
      Refuse(
          fmt::format("there is no input {}; inputs are D, d, R, r, l, Lg, z, eps0', theta, "
                      "theta0, alpha, mu, f1, f2, Fx, Fz, M, Kx and Kt",
                      name));
      return;
    }
    const std::optional<double> value = ParseNumber(number);
    if (!value || !std::isfinite(*value)) {
      Refuse(fmt::format("the input {} is not a number: \"{}\"", name, number));
      return;
    }
    const std::optional<double> factor = FindFactor(rule->kind, unit);
    if (!factor) {
      Refuse(fmt::format("the input {} has the unit \"{}\"; use one of {}", name, unit,
                         UnitsOf(rule->kind)));
      return;
    }
    const double scaled = *value * *factor;
    const bool is_above = rule->includes_low ? scaled >= rule->low : scaled > rule->low;
    if (!is_above || !(scaled < rule->high)) {
      const std::string range =
          rule->kind == Kind::kAngle
              ? fmt::format("above {:g} and below 90 degrees", units::ToDeg(rule->low))
              : fmt::format("{} {:g}", rule->includes_low ? "at least" : "over", rule->low);
      Refuse(fmt::format("the input {} is {}, but must be {}", name,
                         number + (unit.empty() ? "" : " " + unit), range));
      return;
    }
    if (!values_.emplace(name, scaled).second) {
      Refuse(fmt::format("the input {} is given twice", name));
    }
  }

  void CheckPair(const char* hole, const char* peg, const char* what) {
    const auto outer = values_.find(hole);
    const auto inner = values_.find(peg);
    if (outer != values_.end() && inner != values_.end() && !(inner->second < outer->second)) {
      Refuse(fmt::format("the peg's {} {} = {:g} mm is not below the hole's {} = {:g} mm", what,
                         peg, inner->second, hole, outer->second));
    }
  }

  std::map<std::string, double> values_;
  mutable std::string reason_;
};

struct Question {
  std::string_view kind;
  std::string_view output;
  const Inputs& in;
};

/** A number and what it measures, or a text. */
struct Reply {
  double value{0};
  Kind kind{Kind::kPure};
  std::string text{};
};

bool StartsWith(std::string_view text, std::string_view with) {
  return text.starts_with(with);
}

void RefuseTilt(const Question& q, const fits::PegInHole& pair, double tilt) {
  const double largest = fits::CalcLargestTilt(pair);
  if (tilt > largest) {
    q.in.Refuse(
        fmt::format("at a tilt of {:g} deg the peg does not enter: the largest is {:.6g} deg",
                    units::ToDeg(tilt), units::ToDeg(largest)));
  }
}

std::optional<Reply> SolveTwoPoint(const Question& q) {
  if (q.kind == "two_point_depth") {
    const fits::PegInHole pair{2 * q.in("R"), 2 * q.in("r")};
    RefuseTilt(q, pair, q.in("theta"));
    return Reply{fits::CalcTipDepth(pair, q.in("theta")), Kind::kLength};
  }
  const fits::PegInHole pair{q.in("D"), q.in("d")};
  if (StartsWith(q.output, "theta2")) {
    const double least = fits::CalcLeastTwoPointLength(pair);
    if (q.in("l") < least) {
      q.in.Refuse(
          fmt::format("at l = {:g} mm there is no two-point contact: l is at least {:.6g} mm",
                      q.in("l"), least));
    }
    return Reply{fits::CalcTwoPointTilt(pair, q.in("l")), Kind::kAngle};
  }
  if (StartsWith(q.output, "theta_m approx")) {
    return Reply{std::sqrt(2 * pair.relative_clearance()), Kind::kAngle};
  }
  if (StartsWith(q.output, "theta_m")) {
    return Reply{fits::CalcLargestTilt(pair), Kind::kAngle};
  }
  if (StartsWith(q.output, "Whitney")) {
    return Reply{pair.relative_clearance() * pair.hole_diameter / q.in("l"), Kind::kAngle};
  }
  if (StartsWith(q.output, "l_min")) {
    return Reply{fits::CalcLeastTwoPointLength(pair), Kind::kLength};
  }
  if (StartsWith(q.output, "l2") || q.output == "l") {
    RefuseTilt(q, pair, q.in("theta"));
    return Reply{fits::CalcTwoPointLength(pair, q.in("theta")), Kind::kLength};
  }
  if (q.output == "c" || StartsWith(q.output, "c=")) {
    return Reply{pair.relative_clearance()};
  }
  return std::nullopt;
}

std::optional<Reply> SolveWedging(const Question& q) {
  if (StartsWith(q.output, "wedging")) {
    const double d = 2 * q.in("r");
    return Reply{fits::CanWedge({d, d}, q.in("l"), q.in("mu")) ? 1.0 : 0.0};
  }
  if (StartsWith(q.output, "theta_w")) {  // The worst case is the one of the least clearance.
    return Reply{fits::CalcWedgingTilt({q.in("D"), q.in("d")}, q.in("mu")), Kind::kAngle};
  }
  return std::nullopt;
}

/** Whether a load moves the peg on, and where it is in the diagram. */
std::optional<Reply> SolveJammingPoint(const Question& q) {
  const double f_z = q.in("Fz");
  if (StartsWith(q.output, "slides") || StartsWith(q.output, "jams")) {
    const bool is_sliding =
        fits::IsSliding({q.in("Fx"), f_z, q.in("M")}, q.in("l"), q.in("r"), q.in("mu"));
    return Reply{is_sliding == StartsWith(q.output, "slides") ? 1.0 : 0.0};
  }
  if (StartsWith(q.output, "Fx/Fz")) {
    return Reply{q.in("Fx") / f_z};
  }
  if (StartsWith(q.output, "M/(r")) {
    return Reply{q.in("M") / (q.in("r") * f_z)};
  }
  return std::nullopt;
}

std::optional<Reply> SolveJamming(const Question& q) {
  if (!(q.in("mu") > 0)) {
    q.in.Refuse("there is no jamming without friction; give a positive mu");
  }
  if (q.kind == "jamming_point" || StartsWith(q.output, "slides")) {
    return SolveJammingPoint(q);
  }
  const double lambda = fits::CalcLambda(q.in("l"), q.in("r"), q.in("mu"));
  if (StartsWith(q.output, "lambda")) {
    return Reply{lambda};
  }
  if (StartsWith(q.output, "vertices")) {
    std::string text;
    for (const fits::DiagramPoint& p : fits::CalcJammingDiagram(lambda, q.in("mu"))) {
      text +=
          fmt::format("{}({:.6g};{:.6g})", text.empty() ? "" : " ", p.f_x_over_f_z, p.m_over_r_f_z);
    }
    return Reply{0, Kind::kPure, text};
  }
  return std::nullopt;
}

std::optional<Reply> SolveStatics(const Question& q) {
  const fits::PegLoad load =
      fits::CalcTwoPointLoad(q.in("f1"), q.in("f2"), q.in("l"), q.in("r"), q.in("mu"));
  if (q.output == "Fx") {
    return Reply{load.f_x, Kind::kForce};
  }
  if (q.output == "Fz") {
    return Reply{load.f_z, Kind::kForce};
  }
  if (q.output == "M") {
    return Reply{load.m, Kind::kMoment};
  }
  if (StartsWith(q.output, "M/(r")) {
    if (!(load.f_z > 0)) {
      q.in.Refuse("M / (r Fz) needs an axial force; give a positive mu, and a positive f1 or f2");
    }
    return Reply{load.m / (q.in("r") * load.f_z)};
  }
  return std::nullopt;
}

std::optional<Reply> SolveSupport(const Question& q) {
  const bool is_chamfer = q.kind == "chamfer";
  const fits::CompliantSupport support{q.in("Kx"), q.in("Kt"), q.in("Lg")};
  const fits::InsertionForce f =
      is_chamfer ? fits::CalcChamferForce(support, q.in("r"), q.in("mu"), q.in("alpha"), q.in("z"))
                 : fits::CalcOnePointForce(support, q.in("r"), q.in("mu"), q.in("eps0'"),
                                           q.in("theta0"), q.in("l"));
  if (std::isnan(f.normal)) {
    q.in.Refuse(is_chamfer
                    ? "there is no equilibrium: tan alpha of the chamfer has to be above mu, and "
                      "the support needs a larger Kt or a smaller Lg"
                    : "there is no equilibrium: the support needs a larger Kt or a smaller mu");
  } else if (f.normal < 0) {
    q.in.Refuse("the peg touches the other side: eps0' + l theta0 must be 0 or more");
  }
  if (q.output == "Fz") {
    return Reply{f.f_z, Kind::kForce};
  }
  if (q.output == "Fx") {
    return Reply{f.f_x, Kind::kForce};
  }
  if (q.output == "f" || q.output == "f normal") {
    return Reply{f.normal, Kind::kForce};
  }
  return std::nullopt;
}

std::optional<Reply> SolveOne(const Question& q) {
  if (q.kind == "two_point" || q.kind == "two_point_depth") {
    return SolveTwoPoint(q);
  }
  if (q.kind == "wedging") {
    return SolveWedging(q);
  }
  if (q.kind == "jamming" || q.kind == "jamming_point") {
    return SolveJamming(q);
  }
  if (q.kind == "statics") {
    return SolveStatics(q);
  }
  if (q.kind == "chamfer" || q.kind == "one_point") {
    return SolveSupport(q);
  }
  return std::nullopt;
}

/** The reply in the unit that is asked for; refuses where it has none such. */
std::string ToText(const Reply& reply, std::string_view unit, const Question& q) {
  const std::optional<double> factor = FindFactor(reply.kind, WithoutBlanks(unit));
  if (!factor) {
    q.in.Refuse(
        fmt::format("{} has no unit \"{}\"; use one of {}", q.output, unit, UnitsOf(reply.kind)));
    return "";
  }
  if (!reply.text.empty()) {
    return reply.text;
  }
  const double value = reply.value / *factor;
  if (!std::isfinite(value)) {
    q.in.Refuse(fmt::format("{} has no finite value for these inputs", q.output));
  }
  return fmt::format("{:.10g}", value == 0 ? 0.0 : value);
}

}  // namespace

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
    const Question question{kind, output, in};
    const std::optional<Reply> reply = SolveOne(question);
    const std::string value = reply ? ToText(*reply, table->Get(i, "unit"), question) : "";
    if (!reply) {
      in.Refuse(fmt::format("there is no output \"{}\" of kind \"{}\"", output, kind));
    }
    table->Set(i, "value", in.reason().empty() ? value : "");
    table->Set(i, "reason", in.reason());
  }
  return {};
}

}  // namespace hvas::app
