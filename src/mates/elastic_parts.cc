#include "mates/elastic_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "fits/elastic_parts.h"
#include "mates/assignments.h"
#include "product/flexible.h"

namespace hvas::mates {
namespace {

using product::ElasticKind;
using product::ElasticPart;
using product::OccurrenceId;
using product::PartId;
using product::Product;
using units::ToMm;

double ShearModulusOf(const ElasticPart& part) {
  return part.modulus / (2 * (1 + part.poisson_ratio));
}

void TakeStated(const StatedElastic& stated, ElasticPart* part) {
  const auto take = [](const std::optional<double>& value, double* size) {
    *size = value.value_or(*size);
  };
  take(stated.thickness, &part->thickness);
  take(stated.outer, &part->outer);
  take(stated.inner, &part->inner);
  if (stated.lip_length) {
    part->lip_root =
        part->lip_at - std::copysign(*stated.lip_length, part->lip_at - part->lip_root);
  }
  take(stated.coils, &part->coils);
  take(stated.modulus, &part->modulus);
  take(stated.stiffness, &part->stiffness);
  take(stated.free_size, &part->free_size);
  if (part->kind == ElasticKind::kCoilSpring && stated.thickness && !stated.inner) {
    part->inner = part->outer - 2 * part->thickness;
  }
  part->reason = "the side file";
}

Result<ElasticPart> MakeStated(const Product& product, OccurrenceId id, const StatedElastic& stated,
                               const std::optional<ElasticPart>& found) {
  if (!stated.kind && !found) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("{} is not recognised as a part that pushes back",
                            product.occurrences[id.index()].path),
                stated.where, "state its \"kind\"");
  }
  ElasticPart part = found && (!stated.kind || *stated.kind == found->kind)
                         ? *found
                         : product::MeasureElasticPart(*stated.kind, product.part_of(id));
  TakeStated(stated, &part);
  part.occurrence = id;
  if (const std::string missing = FindMissingSize(part); !missing.empty()) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("{} is a {}, but its {} not known",
                            product.occurrences[id.index()].path, ToString(part.kind), missing),
                stated.where, "state it, or \"stiffness_n_per_mm\"");
  }
  return part;
}

std::string DescribeSizes(const ElasticPart& part) {
  const double outer = ToMm(part.outer);
  const double inner = ToMm(part.inner);
  const double t = ToMm(part.thickness);
  switch (part.kind) {
    case ElasticKind::kCoilSpring:
      return fmt::format("wire {:.3g} mm, mean diameter {:.4g} mm, {:.3g} active coils", t,
                         0.5 * (outer + inner), part.coils);
    case ElasticKind::kDiscSpring:
      return fmt::format("{:.4g} x {:.4g} x {:.3g} mm, cone {:.3g} mm high", outer, inner, t,
                         ToMm(std::max(0.0, part.free_size - part.thickness)));
    case ElasticKind::kLockWasher:
      return fmt::format("{:.4g} x {:.4g} x {:.3g} mm, {:.3g} mm high when free", outer, inner, t,
                         ToMm(part.free_size));
    case ElasticKind::kLeafSpring:
      return fmt::format("{:.4g} x {:.4g} x {:.3g} mm", outer, inner, t);
    case ElasticKind::kGasket:
      return fmt::format("{:.4g} mm2, {:.3g} mm thick, {:.3g} MPa", part.area * 1e6, t,
                         part.modulus / 1e6);
    case ElasticKind::kSlitPin:
      return fmt::format("free diameter {:.4g} mm, wall {:.3g} mm", ToMm(part.free_size), t);
    case ElasticKind::kLipSeal:
      return (part.lip_length() > 0
                  ? fmt::format("lip {:.3g} mm long, {:.3g} mm thick, ", ToMm(part.lip_length()), t)
                  : "") +
             fmt::format("{:.4g} mm wide when free, {:.3g} MPa", ToMm(part.free_size),
                         part.modulus / 1e6);
    case ElasticKind::kSleeve:
      break;
  }
  return fmt::format("{:.4g} x {:.4g} x {:.4g} mm, {:.3g} MPa", outer, inner, ToMm(part.length),
                     part.modulus / 1e6);
}

}  // namespace

Result<void> SetElasticParts(const std::vector<StatedElastic>& stated, Product* product) {
  std::map<PartId, std::optional<ElasticPart>> recognised;
  std::map<OccurrenceId, ElasticPart> parts;
  const auto find = [&](OccurrenceId id) -> const std::optional<ElasticPart>& {
    const PartId part = product->occurrences[id.index()].part;
    const auto [entry, is_new] = recognised.try_emplace(part);
    if (is_new) {
      entry->second = product::FindElasticPart(product->parts[part.index()]);
    }
    return entry->second;
  };
  for (const product::Occurrence& occurrence : product->occurrences) {
    const product::FlexiblePart* flexible = FindFlexible(*product, occurrence.id);
    const bool is_rigid = flexible != nullptr && flexible->allowance == 0;
    if (const auto& found = find(occurrence.id); found && !is_rigid) {
      parts[occurrence.id] = *found;
      parts[occurrence.id].occurrence = occurrence.id;
    }
  }
  for (const StatedElastic& entry : stated) {
    bool is_found = false;
    for (const product::Occurrence& occurrence : product->occurrences) {
      if (!IsCalled(*product, occurrence.id, entry.part)) {
        continue;
      }
      is_found = true;
      auto part = MakeStated(*product, occurrence.id, entry, find(occurrence.id));
      if (!part) {
        return Unexpected(part.error());
      }
      parts[occurrence.id] = *std::move(part);
    }
    if (!is_found) {
      return Fail(ErrorCode::kNotFound,
                  fmt::format("nothing in the product is called \"{}\"", entry.part), entry.where,
                  "hvas inspect lists names and paths");
    }
  }
  product->elastic.clear();
  for (auto& [id, part] : parts) {
    product->elastic.push_back(std::move(part));
  }
  return {};
}

double CalcCompression(const ElasticPart& part) {
  return IsPressedAlongAxis(part.kind) ? std::max(0.0, part.free_size - part.length) : 0;
}

std::string FindMissingSize(const ElasticPart& part) {
  if (part.stiffness > 0) {
    return {};
  }
  const bool is_ring = part.outer > part.inner && part.inner > 0;
  const bool has_thickness = part.thickness > 0;
  const auto missing = [](bool has_it, const char* what) { return has_it ? "" : what; };
  switch (part.kind) {
    case ElasticKind::kCoilSpring:
      return !has_thickness || !is_ring ? "wire or diameter is"
                                        : missing(part.coils > 0, "number of active coils is");
    case ElasticKind::kDiscSpring:
      return !has_thickness || !is_ring
                 ? "thickness or diameter is"
                 : missing(part.free_size > part.thickness, "free length is");
    case ElasticKind::kLockWasher:
    case ElasticKind::kSleeve:
      return missing(has_thickness && is_ring, "thickness or diameter is");
    case ElasticKind::kLeafSpring:
      return missing(has_thickness && part.outer > 0, "thickness or length is");
    case ElasticKind::kGasket:
      return missing(part.area > 0, "area is");
    case ElasticKind::kLipSeal:
      return missing(has_thickness && part.lip_length() > 0 && part.free_size > 0,
                     "lip's length or thickness is");
    case ElasticKind::kSlitPin:
      return missing(has_thickness && part.free_size > 2 * part.thickness, "wall or diameter is");
  }
  return {};
}

std::optional<fits::PressedPart> MakePressedPart(const ElasticPart& part) {
  if (!IsPressedAlongAxis(part.kind) || !FindMissingSize(part).empty()) {
    return std::nullopt;
  }
  if (part.stiffness > 0) {
    return fits::StatedSpring{part.stiffness};
  }
  switch (part.kind) {
    case ElasticKind::kCoilSpring:
      return fits::CoilSpring{part.thickness, 0.5 * (part.outer + part.inner), part.coils,
                              ShearModulusOf(part)};
    case ElasticKind::kDiscSpring:
      return fits::DiscSpring{part.outer,     part.inner,
                              part.thickness, part.free_size - part.thickness,
                              part.modulus,   part.poisson_ratio};
    case ElasticKind::kLockWasher:
      return fits::LockWasher{part.outer, part.inner, part.thickness, ShearModulusOf(part)};
    case ElasticKind::kLeafSpring:
      return fits::LeafSpring{part.outer, part.inner, part.thickness, part.modulus};
    case ElasticKind::kGasket:
      return fits::FlatGasket{part.area, part.free_area, part.free_size, part.modulus};
    case ElasticKind::kSlitPin:
    case ElasticKind::kSleeve:
    case ElasticKind::kLipSeal:
      break;
  }
  return std::nullopt;
}

double CalcLipStiffness(const ElasticPart& seal) {
  return seal.stiffness > 0 ? seal.stiffness
                            : fits::CalcLipStiffness({0.5 * seal.free_size, seal.lip_length(),
                                                      seal.thickness, seal.modulus});
}

std::string DescribeElastic(const ElasticPart& part) {
  std::string text = DescribeSizes(part);
  if (const std::string missing = FindMissingSize(part); !missing.empty()) {
    return text + "; no force, as its " + missing + " not known";
  }
  if (part.kind == ElasticKind::kLipSeal) {
    return text +
           fmt::format("; its shaft spreads it: {:.3g} N/mm around it (short shell, Hetenyi)",
                       CalcLipStiffness(part) * units::kMetresPerMillimetre);
  }
  const std::optional<fits::PressedPart> pressed = MakePressedPart(part);
  if (!pressed) {
    return text + "; its hole presses it";
  }
  text += fmt::format(": {:.3g} N/mm", fits::CalcPressRate(*pressed) * units::kMetresPerMillimetre);
  if (const double compression = CalcCompression(part); compression > 0) {
    text += fmt::format("; pressed together by {:.3g} mm in its place: {:.3g} N", ToMm(compression),
                        fits::CalcPressForce(*pressed, compression));
  }
  return text + " (" + fits::DescribeForce(*pressed) + ")";
}

}  // namespace hvas::mates
