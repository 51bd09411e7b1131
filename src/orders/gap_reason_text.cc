#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "mates/drawing_errors.h"
#include "orders/gap_reason.h"
#include "product/names.h"

namespace hvas::orders {
namespace {

using product::FeatureKind;
using product::OccurrenceId;
using spatial::SurfaceKind;

std::string PathOfPart(const simulation::Model& model, OccurrenceId id) {
  return id.is_valid() ? model.product->occurrences[id.index()].path : std::string("the table");
}

/** Joins names of parts: "a, b and c". */
std::string JoinPaths(const simulation::Model& model, const sequence::Unit& unit) {
  std::string text;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const char* separator = i == 0 ? "" : i + 1 == unit.size() ? " and " : ", ";
    text += separator + PathOfPart(model, unit[i]);
  }
  return text;
}

std::string DescribeWay(const simulation::Model& model, const GapReason& reason) {
  if (reason.stops.empty() && !reason.mates.empty()) {
    sequence::Unit partners;
    for (const product::MateId id : reason.mates) {
      const product::Mate& mate = model.product->mates[id.index()];
      const OccurrenceId other =
          mate.a.occurrence == reason.occurrence ? mate.b.occurrence : mate.a.occurrence;
      if (std::find(partners.begin(), partners.end(), other) == partners.end()) {
        partners.push_back(other);
      }
    }
    return fmt::format("its mates with {} forbid all straight ways out",
                       JoinPaths(model, partners));
  }
  if (reason.stops.empty()) {
    return "no straight way out was looked at";
  }
  std::string pairs;
  std::size_t shown = 0;
  for (const sequence::MetFaces& stop : reason.stops) {
    if (shown == kToldStops) {
      break;
    }
    pairs += fmt::format("{}its {} meets the {} of {} {:.2f} mm deep", shown == 0 ? "" : "; ",
                         DescribeFace(*model.product, reason.occurrence, stop.own_face),
                         stop.other.is_valid()
                             ? DescribeFace(*model.product, stop.other, stop.other_face)
                             : std::string("surface"),
                         PathOfPart(model, stop.other), units::ToMm(stop.depth));
    ++shown;
  }
  if (reason.stops.size() > shown) {
    pairs += fmt::format("; {} more pairs of faces meet", reason.stops.size() - shown);
  }
  return fmt::format("its best straight way out, along {}, ends after {:.1f} of {:.1f} mm: {}",
                     sequence::DescribeDirection(reason.direction_W), units::ToMm(reason.travelled),
                     units::ToMm(reason.way_length), pairs);
}

std::string DescribeProof(const simulation::Model& model, const GapReason& reason) {
  switch (reason.proof) {
    case GapProof::kHeld:
      return fmt::format("proven while {} stay{} as drawn: contacts hold it in every direction",
                         JoinPaths(model, reason.present), reason.present.size() == 1 ? "s" : "");
    case GapProof::kCaged:
      return fmt::format(
          "proven while {} stay{} as drawn: a ball of {:.2f} mm in diameter inside of it has no "
          "opening to leave by",
          reason.present.size() > 4 ? fmt::format("{} parts", reason.present.size())
                                    : JoinPaths(model, reason.present),
          reason.present.size() == 1 ? "s" : "", 2 * units::ToMm(reason.caged_radius));
    case GapProof::kDrawn: {
      const product::DrawingError* error =
          product::FindDrawingError(*model.product, reason.occurrence, reason.present.front());
      return error == nullptr ? std::string("an error of the drawing")
                              : "an error of the drawing: " +
                                    mates::DescribeDrawingError(*model.product, *error);
    }
    case GapProof::kNotFound:
      return fmt::format("not proven: no way was found with {} looks", reason.looks);
  }
  return {};
}

std::string DescribeOrderChange(const GapChange& change, const std::string& parts,
                                const std::string& along) {
  const bool is_one = change.parts.size() == 1;
  if (change.has_worked) {
    return fmt::format("order: it goes in before {}, which go{} in after it{}{}{}", parts,
                       is_one ? "es" : "", change.do_others_turn ? " by a way that turns" : "",
                       change.do_others_give ? " where parts give" : "", along);
  }
  return change.does_go_without
             ? fmt::format("order: it goes in before {}, which then {} not go in any more", parts,
                           is_one ? "does" : "do")
             : fmt::format("order: it does not go in before {} either", parts);
}

}  // namespace

std::string DescribeFace(const product::Product& product, OccurrenceId id, std::uint32_t face) {
  const product::Part& part = product.part_of(id);
  if (face >= part.faces.size()) {
    return "inside";
  }
  const auto feature = std::find_if(
      part.features.begin(), part.features.end(), [face](const product::Feature& candidate) {
        return std::find(candidate.faces.begin(), candidate.faces.end(), product::FaceId(face)) !=
               candidate.faces.end();
      });
  if (feature != part.features.end() && feature->kind != FeatureKind::kPlane) {
    const char* name =
        feature->kind == FeatureKind::kConeSeat ? "conical seat" : product::ToString(feature->kind);
    return fmt::format("{} {:.2f} mm", name, units::ToMm(2 * feature->radius));
  }
  const spatial::Surface& surface = part.faces[face].surface;
  const bool is_out = surface.outward > 0;
  const double diameter_mm = units::ToMm(2 * surface.radius);
  switch (surface.kind) {
    case SurfaceKind::kPlane:
      return fmt::format("plane face {}", face);
    case SurfaceKind::kCylinder:
      return fmt::format("{} {:.2f} mm", is_out ? "shaft" : "hole", diameter_mm);
    case SurfaceKind::kSphere:
      return fmt::format("{} {:.2f} mm", is_out ? "ball" : "socket", diameter_mm);
    case SurfaceKind::kCone:
      return fmt::format("conical face {}", face);
    case SurfaceKind::kTorus:
      return fmt::format("torus face {}", face);
    case SurfaceKind::kFreeform:
      return fmt::format("freeform face {}", face);
  }
  return fmt::format("face {}", face);
}

std::string DescribeGapChange(const simulation::Model& model, const GapReason& reason,
                              const GapChange& change) {
  const std::string parts = JoinPaths(model, change.parts);
  const double amount_mm = units::ToMm(change.amount);
  const std::string along =
      change.has_worked || change.does_go_without
          ? fmt::format(", {} {}",
                        change.does_turn ? "by a way that turns and begins" : "out along",
                        sequence::DescribeDirection(change.direction_W))
          : std::string();
  const bool is_own = !change.parts.empty() && change.parts.front() == reason.occurrence;
  const std::string who = is_own ? std::string("the part itself") : parts;
  switch (change.kind) {
    case GapChangeKind::kOrder:
      return DescribeOrderChange(change, parts, along);
    case GapChangeKind::kClearance:
      return change.has_worked
                 ? fmt::format(
                       "clearance: it goes in with {:.2f} mm less on each side ({:.2f} mm "
                       "in a diameter) of it, or of {}{}",
                       amount_mm, 2 * amount_mm, parts, along)
                 : fmt::format(
                       "clearance: {:.2f} mm on each side of it against {} does not let "
                       "it in",
                       amount_mm, parts);
    case GapChangeKind::kFlexible:
      return change.has_worked
                 ? fmt::format("flexible: it goes in where {} may give by {:.2f} mm{}", who,
                               amount_mm, along)
                 : fmt::format("flexible: {:.2f} mm by which {} may give do not let it in",
                               amount_mm, who);
    case GapChangeKind::kLeaveOut:
      return change.has_worked
                 ? fmt::format("left out: it goes in without {}{}", parts, along)
                 : fmt::format("left out: it does not go in without {} either", parts);
  }
  return {};
}

std::vector<std::string> FormatGapReason(const simulation::Model& model, const GapReason& reason) {
  std::vector<std::string> lines;
  if (reason.has_way) {
    lines.push_back(fmt::format(
        "it has a way in, out along {}, while {} parts are there that cannot come out before it: "
        "the search for an order did not get there",
        sequence::DescribeDirection(reason.direction_W), reason.present.size()));
    return lines;
  }
  if (reason.proof == GapProof::kDrawn) {
    lines.push_back(DescribeProof(model, reason));
    return lines;
  }
  lines.push_back(DescribeWay(model, reason));
  lines.push_back(DescribeProof(model, reason));
  const GapChange* best = reason.best();
  lines.push_back(best != nullptr ? DescribeGapChange(model, reason, *best)
                                  : fmt::format("none of {} changes that were tried lets it in",
                                                reason.changes.size()));
  if (reason.is_stopped || reason.is_limit_reached) {
    lines.push_back(reason.is_stopped
                        ? std::string("a stop was asked for before all changes were tried")
                        : fmt::format("the limit ended the trials after {} looks", reason.looks));
  } else if (best != nullptr) {
    std::string others;
    for (const GapChange& change : reason.changes) {
      if (change.has_worked && &change != best) {
        others += (others.empty() ? "also " : "; ") + DescribeGapChange(model, reason, change);
        if (change.kind != best->kind) {
          break;  // One that changes more is enough to compare.
        }
      }
    }
    if (!others.empty()) {
      lines.push_back(others);
    }
  }
  return lines;
}

const char* NameOf(GapProof proof) {
  switch (proof) {
    case GapProof::kNotFound:
      return "not_found";
    case GapProof::kHeld:
      return "held";
    case GapProof::kCaged:
      return "caged";
    case GapProof::kDrawn:
      return "drawn";
  }
  return "";
}

const char* NameOf(GapChangeKind kind) {
  switch (kind) {
    case GapChangeKind::kOrder:
      return "order";
    case GapChangeKind::kClearance:
      return "clearance";
    case GapChangeKind::kFlexible:
      return "flexible";
    case GapChangeKind::kLeaveOut:
      return "leave_out";
  }
  return "";
}

}  // namespace hvas::orders
