#include "mates/assignments.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "fits/iso286.h"
#include "mates/make_fit.h"
#include "mates/mate_kind.h"
#include "mates/stated_fits.h"
#include "product/names.h"

namespace hvas::mates {
namespace {

using product::Fit;
using product::FitConditions;
using product::FitKind;
using product::Mate;
using product::MateKind;
using product::MeasuredDiameter;
using product::Occurrence;
using product::Product;

constexpr double kSameDiameter = 0.01;  // As a part of the diameter.
constexpr double kMostMeasured = 0.05;  // A measured size from the drawn or nominal one.
constexpr const char* kSeeMates = "use the names that hvas inspect lists";

std::string NearestOccurrence(const Product& product, std::string_view name) {
  std::vector<std::string> names;
  for (const Occurrence& occurrence : product.occurrences) {
    names.push_back(occurrence.name);
    names.push_back(occurrence.path);
  }
  return FindNearest(name, names);
}

double NominalOf(const Mate& mate) {
  return mate.fit && mate.fit->nominal_diameter > 0 ? mate.fit->nominal_diameter
                                                    : 2 * mate.hole_radius;
}

/** One side of a mate has a class, the other keeps its own or is as drawn. */
Result<Fit> MakeSideFit(const fits::ToleranceClass& side, const Mate& mate,
                        std::optional<double> nominal, const std::string& reason) {
  const char* other = side.is_hole() ? "shaft" : "hole";
  if (mate.fit && mate.fit->kind != FitKind::kThread) {
    Result<fits::FitClass> whole = fits::ParseFit(mate.fit->code);
    if (!whole) {  // The other side may have been stated alone before.
      whole = fits::ParseFit(side.is_hole() ? side.ToString() + "/" + mate.fit->code
                                            : mate.fit->code + "/" + side.ToString());
    }
    if (whole) {
      (side.is_hole() ? whole->hole : whole->shaft) = side;
      return MakeWholeFit(*whole, nominal.value_or(NominalOf(mate)),
                          fmt::format("{}; the {} {}", reason, other,
                                      mate.fit->is_proposed ? "as proposed" : "as stated before"));
    }
  }
  const double diameter = 2 * (side.is_hole() ? mate.hole_radius : mate.shaft_radius);
  const Result<fits::Limits> limits = fits::CalcLimits(side, nominal.value_or(diameter));
  if (!limits) {
    return Unexpected(limits.error());
  }
  const double least = nominal.value_or(diameter) + limits->lower;
  const double most = nominal.value_or(diameter) + limits->upper;
  const fits::FitKind kind =
      side.is_hole()
          ? fits::ClassifyFit(least - 2 * mate.shaft_radius, most - 2 * mate.shaft_radius)
          : fits::ClassifyFit(2 * mate.hole_radius - most, 2 * mate.hole_radius - least);
  return Fit{ToKind(kind), side.ToString(), nominal.value_or(diameter), false,
             fmt::format("{}; the {} as drawn", reason, other)};
}

/** The fit for one mate from what somebody wrote. @param nominal  Where it is stated [m]. */
Result<Fit> MakeFit(std::string_view text, const Mate& mate, std::optional<double> nominal,
                    std::string reason) {
  if (text == "thread" && mate.kind == MateKind::kPrismatic) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("mate m{} is prismatic and cannot be a thread", mate.id.value()), {},
                "write a fit of widths, as H7/g6");
  }
  if (text == "thread") {
    return Fit{FitKind::kThread, "", nominal.value_or(NominalOf(mate)), false, std::move(reason)};
  }
  if (const Result<void> checked = CheckDrawnPress(mate); !checked) {
    return Unexpected(checked.error());
  }
  if (const Result<fits::ToleranceClass> side = fits::ParseToleranceClass(text)) {
    return MakeSideFit(*side, mate, nominal, reason);
  }
  const Result<fits::FitClass> parsed = fits::ParseFit(text);
  if (!parsed) {
    return Unexpected(parsed.error());
  }
  return MakeWholeFit(*parsed, nominal.value_or(NominalOf(mate)), std::move(reason));
}

/** A mate by its number ("m12") or its key. */
bool IsMate(const Mate& mate, std::string_view text) {
  std::size_t index = 0;
  if (text.size() > 1 && text.front() == 'm') {
    const auto [end, code] = std::from_chars(text.data() + 1, text.data() + text.size(), index);
    if (code == std::errc() && end == text.data() + text.size()) {
      return mate.id.index() == index;
    }
  }
  return !mate.key.empty() && mate.key == text;
}

/** The kind of the mates that an entry identifies by names. */
MateKind KindOf(const FitEntry& entry) {
  return entry.width || entry.has_widths ? MateKind::kPrismatic : MateKind::kAxisHole;
}

bool Matches(const Product& product, const Mate& mate, const FitEntry& entry) {
  if (!entry.mate.empty()) {
    return IsMate(mate, entry.mate);
  }
  const std::optional<double> size = entry.width ? entry.width : entry.diameter;
  const auto is_near = [&](double radius) {
    return std::abs(2 * radius - *size) <= kSameDiameter * *size;
  };
  return mate.kind == KindOf(entry) && IsCalled(product, mate.a.occurrence, entry.hole) &&
         IsCalled(product, mate.b.occurrence, entry.shaft) &&
         (!size || is_near(mate.hole_radius) || is_near(mate.shaft_radius));
}

Unexpected FailToFind(const Product& product, const FitEntry& entry) {
  if (!entry.mate.empty()) {
    return Fail(ErrorCode::kNotFound, fmt::format("there is no mate \"{}\"", entry.mate),
                entry.where, "list the mates and their keys with hvas mate list");
  }
  std::string remedy = kSeeMates;
  for (const std::string* name : {&entry.hole, &entry.shaft}) {
    const bool is_there = std::any_of(
        product.occurrences.begin(), product.occurrences.end(),
        [&](const Occurrence& occurrence) { return IsCalled(product, occurrence.id, *name); });
    const std::string nearest = is_there ? "" : NearestOccurrence(product, *name);
    if (!nearest.empty()) {
      remedy = fmt::format("\"{}\" may be \"{}\"; {}", *name, nearest, kSeeMates);
    }
  }
  const bool is_prismatic = KindOf(entry) == MateKind::kPrismatic;
  const std::optional<double> size = entry.width ? entry.width : entry.diameter;
  FitEntry prismatic = entry;
  prismatic.has_widths = true;
  if (!is_prismatic && !size &&
      std::any_of(product.mates.begin(), product.mates.end(),
                  [&](const Mate& mate) { return Matches(product, mate, prismatic); })) {
    remedy = R"(add "width_mm" for their slot and tongue)";
  }
  return Fail(ErrorCode::kNotFound,
              fmt::format("no {} mate of hole \"{}\" and shaft \"{}\"{}",
                          is_prismatic ? "prismatic" : "axis-hole", entry.hole, entry.shaft,
                          size ? fmt::format(" with {:g} mm", units::ToMm(*size)) : ""),
              entry.where, std::move(remedy));
}

Result<void> CheckMeasured(const char* name, const std::vector<MeasuredDiameter>& measured,
                           double drawn, double nominal, const std::string& where) {
  for (const auto& [depth, diameter] : measured) {
    if (std::abs(diameter - drawn) > kMostMeasured * drawn &&
        std::abs(diameter - nominal) > kMostMeasured * nominal) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("the measured size of the {}, {:g} mm, is far from the drawn {:g} mm",
                              name, units::ToMm(diameter), units::ToMm(drawn)),
                  where, "give the size in mm, or another mate");
    }
  }
  return {};
}

void Override(const std::vector<MeasuredDiameter>& measured,
              std::vector<MeasuredDiameter>* target) {
  if (!measured.empty()) {
    *target = measured;
  }
}

template <typename T>
void Override(const std::optional<T>& value, std::optional<T>* target) {
  if (value) {
    *target = value;
  }
}

void Merge(const FitConditions& from, FitConditions* to) {
  Override(from.hole_diameters, &to->hole_diameters);
  Override(from.shaft_diameters, &to->shaft_diameters);
  Override(from.hole_roughness, &to->hole_roughness);
  Override(from.shaft_roughness, &to->shaft_roughness);
  Override(from.friction, &to->friction);
  Override(from.hole_temperature_c, &to->hole_temperature_c);
  Override(from.shaft_temperature_c, &to->shaft_temperature_c);
}

Result<void> ApplyEntry(const FitEntry& entry, const std::string& reason, Mate* mate) {
  if (!HasFit(mate->kind)) {
    return Fail(
        ErrorCode::kInvalid,
        fmt::format("mate \"{}\" is {}, a kind without a fit", entry.mate, ToString(mate->kind)),
        entry.where, "give an axis-hole or prismatic mate");
  }
  const bool is_prismatic = mate->kind == MateKind::kPrismatic;
  if (is_prismatic ? entry.has_diameters : entry.has_widths) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("mate \"{}\" is {} and has no {}", mate->key, ToString(mate->kind),
                            is_prismatic ? "diameters" : "widths"),
                entry.where,
                is_prismatic ? R"(write "hole_width_mm" and "shaft_width_mm")"
                             : R"(write "hole_diameter_mm" and "shaft_diameter_mm")");
  }
  if (!entry.fit.empty()) {
    Result<Fit> fit =
        MakeFit(entry.fit, *mate, is_prismatic ? entry.width : entry.diameter, reason);
    if (!fit) {
      Error error = fit.error();
      error.where = entry.where;
      return Unexpected(std::move(error));
    }
    mate->fit = *std::move(fit);
  }
  const double nominal = NominalOf(*mate);
  Result<void> checked = CheckMeasured("hole", entry.conditions.hole_diameters,
                                       2 * mate->hole_radius, nominal, entry.where);
  if (checked) {
    checked = CheckMeasured("shaft", entry.conditions.shaft_diameters, 2 * mate->shaft_radius,
                            nominal, entry.where);
  }
  Merge(entry.conditions, &mate->conditions);
  return checked;
}

}  // namespace

bool IsCalled(const Product& product, product::OccurrenceId id, std::string_view name) {
  const Occurrence& occurrence = product.occurrences[id.index()];
  return product::IsCalledByPath(occurrence.name, occurrence.path, name) ||
         std::any_of(
             occurrence.bodies.begin(), occurrence.bodies.end(),
             [&name](const std::string& path) { return product::IsCalledByPath({}, path, name); });
}

Result<int> ApplyFits(const SideFile& file, const MateChanges& changes, Product* product,
                      WorkWatch* watch) {
  const std::string reason = "stated in " + file.path.filename().string();
  std::vector<Mate> mates = product->mates;  // Changed whole, or not at all.
  std::vector<bool> is_changed(mates.size(), false);
  for (std::size_t i = 0; i < file.added.size(); ++i) {
    const AddedMate& added = file.added[i];
    if (added.fit.empty()) {
      continue;
    }
    Mate& mate = mates[changes.added[i].index()];
    FitEntry entry;
    entry.mate = mate.key;
    entry.fit = added.fit;
    entry.where = added.where;
    if (const auto applied = ApplyEntry(entry, reason, &mate); !applied) {
      return Unexpected(applied.error());
    }
    is_changed[changes.added[i].index()] = true;
  }
  for (const FitEntry& entry : file.fits) {
    if (!MayGoOn(watch)) {
      return Unexpected(watch->Explain("assigning the fits", entry.where));
    }
    bool is_found = std::any_of(changes.removed.begin(), changes.removed.end(),
                                [&](const Mate& mate) { return Matches(*product, mate, entry); });
    // A removed mate has no number any more: it is another's now.
    is_found = is_found && !(entry.mate.size() > 1 && entry.mate.front() == 'm');
    for (std::size_t i = 0; i < mates.size(); ++i) {
      if (!Matches(*product, mates[i], entry)) {
        continue;
      }
      if (const auto applied = ApplyEntry(entry, reason, &mates[i]); !applied) {
        return Unexpected(applied.error());
      }
      is_found = is_changed[i] = true;
    }
    if (!is_found) {
      return FailToFind(*product, entry);
    }
  }
  if (!MayGoOn(watch)) {
    return Unexpected(watch->Explain("assigning the fits", file.path.string()));
  }
  product->mates = std::move(mates);
  return static_cast<int>(std::count(is_changed.begin(), is_changed.end(), true));
}

Result<MateChanges> ApplySideFile(const SideFile& file, Product* product, WorkWatch* watch) {
  Product changed = *product;
  Result<MateChanges> changes = ApplyMates(file, &changed, watch);
  if (!changes) {
    return changes;
  }
  AssignStatedFits(&changed, watch);
  const Result<int> count = ApplyFits(file, *changes, &changed, watch);
  if (!count) {
    return Unexpected(count.error());
  }
  changes->fits = *count;
  if (const auto applied = ApplyRelations(file, &changed); !applied) {
    return Unexpected(applied.error());
  }
  *product = std::move(changed);
  return changes;
}

Result<MateChanges> ApplyAssignments(const std::filesystem::path& file, Product* product,
                                     WorkWatch* watch) {
  const Result<SideFile> side_file = ReadSideFile(file);
  if (!side_file) {
    return Unexpected(side_file.error());
  }
  return ApplySideFile(*side_file, product, watch);
}

Result<void> AssignFit(Product* product, std::string_view assignment) {
  const std::size_t split = assignment.rfind('=');
  if (split == std::string_view::npos || split == 0) {
    return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" does not assign a fit", assignment),
                "--fit", "write AXIS=H7/p6 with a mate (m12), an occurrence's name, or all");
  }
  const std::string_view axis = assignment.substr(0, split);
  std::vector<std::pair<std::size_t, Fit>> changes;
  for (std::size_t i = 0; i < product->mates.size(); ++i) {
    const Mate& mate = product->mates[i];
    const bool is_thread =
        mate.fit && (mate.fit->kind == FitKind::kThread || mate.fit->kind == FitKind::kInsert);
    const bool is_named =
        IsMate(mate, axis) ||
        (!is_thread && (axis == "all" || IsCalled(*product, mate.a.occurrence, axis) ||
                        IsCalled(*product, mate.b.occurrence, axis)));
    if (!HasFit(mate.kind) || !is_named) {
      continue;
    }
    Result<Fit> fit =
        MakeFit(assignment.substr(split + 1), mate, std::nullopt, "stated by the user");
    if (!fit) {
      Error error = fit.error();
      error.where = fmt::format("--fit {}", assignment);
      return Unexpected(std::move(error));
    }
    changes.emplace_back(i, *std::move(fit));
  }
  if (changes.empty()) {
    return Fail(ErrorCode::kNotFound,
                fmt::format("\"{}\" does not identify an axis-hole or prismatic mate", axis),
                fmt::format("--fit {}", assignment),
                "hvas inspect lists mates and occurrences; threads and inserts can be given by "
                "their mate only");
  }
  for (auto& [mate, fit] : changes) {
    product->mates[mate].fit = std::move(fit);
  }
  return {};
}

}  // namespace hvas::mates
