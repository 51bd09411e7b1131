#include "mates/assignments.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "fits/iso286.h"

namespace hvas::mates {
namespace {

using nlohmann::json;
using product::Fit;
using product::FitKind;
using product::Mate;
using product::MateKind;
using product::Occurrence;
using product::Product;

constexpr double kSameDiameter = 0.01;  // As a part of the diameter.

/** By its name, its path, or the end of its path ("tier 1/post 1"). */
bool IsCalled(const Product& product, product::OccurrenceId id, std::string_view name) {
  const Occurrence& occurrence = product.occurrences[id.index()];
  const std::string_view path = occurrence.path;
  return occurrence.name == name || path == name ||
         (path.size() > name.size() && path.ends_with(name) &&
          path[path.size() - name.size() - 1] == '/' && !name.empty());
}

/** The fit for one mate from what somebody wrote. */
Result<Fit> MakeFit(std::string_view text, double nominal, std::string reason) {
  if (text == "thread") {
    return Fit{FitKind::kThread, "", nominal, false, std::move(reason)};
  }
  const Result<fits::FitClass> parsed = fits::ParseFit(text);
  if (!parsed) {
    return Unexpected(parsed.error());
  }
  const Result<fits::FitLimits> limits = fits::CalcFitLimits(*parsed, nominal);
  if (!limits) {
    return Unexpected(limits.error());
  }
  Fit fit{FitKind::kClearance, parsed->ToString(), nominal, false, std::move(reason)};
  if (limits->kind == fits::FitKind::kTransition) {
    fit.kind = FitKind::kTransition;
  } else if (limits->kind == fits::FitKind::kInterference) {
    fit.kind = FitKind::kInterference;
  }
  return fit;
}

double NominalOf(const Mate& mate) {
  return mate.fit && mate.fit->nominal_diameter > 0 ? mate.fit->nominal_diameter
                                                    : 2 * mate.hole_radius;
}

/** The mates to change with their new fits; applied only when all of them are right. */
struct Change {
  std::size_t mate;
  Fit fit;
};

void Apply(std::vector<Change> changes, Product* product) {
  for (Change& change : changes) {
    product->mates[change.mate].fit = std::move(change.fit);
  }
}

struct Entry {
  std::string hole;
  std::string shaft;
  std::optional<double> diameter;  // [m]
  std::string fit;
};

Result<Entry> ReadEntry(const json& item, const std::string& where) {
  const auto fail = [&](const std::string& message) {
    return Fail(ErrorCode::kInvalid, message, where,
                R"(write {"hole": "...", "shaft": "...", "diameter_mm": 6, "fit": "H7/k6"})");
  };
  if (!item.is_object()) {
    return fail("the entry is no object");
  }
  Entry entry;
  for (const auto& [key, field] : {std::pair("hole", &entry.hole), std::pair("shaft", &entry.shaft),
                                   std::pair("fit", &entry.fit)}) {
    const auto found = item.find(key);
    if (found == item.end() || !found->is_string()) {
      return fail(fmt::format("\"{}\" is missing or no text", key));
    }
    *field = found->get<std::string>();
  }
  if (const auto found = item.find("diameter_mm"); found != item.end()) {
    if (!found->is_number() || !(found->get<double>() > 0)) {
      return fail("\"diameter_mm\" is no positive number");
    }
    entry.diameter = units::FromMm(found->get<double>());
  }
  return entry;
}

bool Matches(const Product& product, const Mate& mate, const Entry& entry) {
  const auto is_near = [&](double radius) {
    return std::abs(2 * radius - *entry.diameter) <= kSameDiameter * *entry.diameter;
  };
  return mate.kind == MateKind::kAxisHole && IsCalled(product, mate.a.occurrence, entry.hole) &&
         IsCalled(product, mate.b.occurrence, entry.shaft) &&
         (!entry.diameter || is_near(mate.hole_radius) || is_near(mate.shaft_radius));
}

Result<std::vector<Change>> FindChanges(const Product& product, const Entry& entry,
                                        const std::string& file, const std::string& where) {
  std::vector<Change> changes;
  for (std::size_t i = 0; i < product.mates.size(); ++i) {
    if (!Matches(product, product.mates[i], entry)) {
      continue;
    }
    const double nominal = entry.diameter.value_or(NominalOf(product.mates[i]));
    Result<Fit> fit = MakeFit(entry.fit, nominal, "stated in " + file);
    if (!fit) {
      Error error = fit.error();
      error.where = where;
      return Unexpected(std::move(error));
    }
    changes.push_back({i, *std::move(fit)});
  }
  if (changes.empty()) {
    return Fail(
        ErrorCode::kNotFound,
        fmt::format(
            "no axis-hole mate of hole \"{}\" and shaft \"{}\"{}", entry.hole, entry.shaft,
            entry.diameter ? fmt::format(" with {:g} mm", units::ToMm(*entry.diameter)) : ""),
        where, "list the mates with hvas inspect, and use the occurrences' names from there");
  }
  return changes;
}

Result<json> ReadJson(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) {
    return Fail(ErrorCode::kNotFound, "the fits cannot be read", file.string(),
                "check the path and its permissions");
  }
  json document = json::parse(stream, nullptr, /*allow_exceptions=*/false);
  if (document.is_discarded()) {
    return Fail(ErrorCode::kUnreadable, "the file is not JSON", file.string(),
                "check it with a JSON validator");
  }
  const auto format = document.is_object() ? document.find("format") : document.end();
  if (!document.is_object() || format == document.end() || *format != "hvas-assignments-1" ||
      !document.contains("fits") || !document["fits"].is_array()) {
    return Fail(ErrorCode::kUnsupported, "the file holds no assignments", file.string(),
                R"(begin with {"format": "hvas-assignments-1", "fits": [...]})");
  }
  return document;
}

/** The index in "m12", if it is one. */
std::optional<std::size_t> ReadMateId(std::string_view text) {
  std::size_t index = 0;
  if (text.size() < 2 || text.front() != 'm') {
    return std::nullopt;
  }
  const auto [end, code] = std::from_chars(text.data() + 1, text.data() + text.size(), index);
  return code == std::errc() && end == text.data() + text.size() ? std::optional(index)
                                                                 : std::nullopt;
}

}  // namespace

std::filesystem::path FindAssignmentFile(const std::filesystem::path& product_file) {
  std::filesystem::path file = product_file;
  return file.replace_extension(".hvas.json");
}

Result<int> ApplyAssignments(const std::filesystem::path& file, Product* product) {
  const Result<json> document = ReadJson(file);
  if (!document) {
    return Unexpected(document.error());
  }
  std::vector<Change> all;
  int number = 0;
  for (const json& item : (*document)["fits"]) {
    const std::string where = fmt::format("{}, fit {}", file.string(), ++number);
    const Result<Entry> entry = ReadEntry(item, where);
    if (!entry) {
      return Unexpected(entry.error());
    }
    Result<std::vector<Change>> changes =
        FindChanges(*product, *entry, file.filename().string(), where);
    if (!changes) {
      return Unexpected(changes.error());
    }
    std::move(changes->begin(), changes->end(), std::back_inserter(all));
  }
  const int count = static_cast<int>(all.size());
  Apply(std::move(all), product);
  return count;
}

Result<void> AssignFit(Product* product, std::string_view assignment) {
  const std::size_t split = assignment.rfind('=');
  if (split == std::string_view::npos || split == 0) {
    return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" assigns no fit", assignment), "--fit",
                "write AXIS=H7/p6 with a mate (m12), an occurrence's name, or all");
  }
  const std::string_view axis = assignment.substr(0, split);
  const std::optional<std::size_t> index = ReadMateId(axis);
  std::vector<Change> changes;
  for (std::size_t i = 0; i < product->mates.size(); ++i) {
    const Mate& mate = product->mates[i];
    const bool is_thread = mate.fit && mate.fit->kind == FitKind::kThread;
    const bool is_named =
        index == i ||
        (!is_thread && (axis == "all" || IsCalled(*product, mate.a.occurrence, axis) ||
                        IsCalled(*product, mate.b.occurrence, axis)));
    if (mate.kind != MateKind::kAxisHole || !is_named) {
      continue;
    }
    Result<Fit> fit = MakeFit(assignment.substr(split + 1), NominalOf(mate), "stated by the user");
    if (!fit) {
      Error error = fit.error();
      error.where = fmt::format("--fit {}", assignment);
      return Unexpected(std::move(error));
    }
    changes.push_back({i, *std::move(fit)});
  }
  if (changes.empty()) {
    return Fail(ErrorCode::kNotFound, fmt::format("\"{}\" names no axis-hole mate", axis),
                fmt::format("--fit {}", assignment),
                "list mates and occurrences with hvas inspect; threads go by their mate only");
  }
  Apply(std::move(changes), product);
  return {};
}

}  // namespace hvas::mates
