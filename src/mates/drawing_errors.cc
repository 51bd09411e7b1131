#include "mates/drawing_errors.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "fits/iso286.h"
#include "mates/elastic_parts.h"
#include "product/wall.h"

namespace hvas::mates {
namespace {

using product::DrawingError;
using product::ElasticPart;
using product::FaceId;
using product::FitKind;
using product::Mate;
using product::OccurrenceId;
using product::Product;
using product::SurfaceKind;
using units::ToMm;

constexpr double kTouchingDepth = 50e-6;  // [m]: faces of meshes that touch may lie this deep.

/** How deep what a part gives may let another lie in it, or it in another [m]. */
double CalcGiven(const Product& product, OccurrenceId id) {
  const product::FlexiblePart* flexible = product::FindFlexible(product, id);
  const ElasticPart* elastic = product::FindElastic(product, id);
  return std::max(flexible != nullptr ? flexible->allowance : 0.0,
                  elastic != nullptr ? CalcCompression(*elastic) : 0.0);
}

double CalcGiven(const Product& product, OccurrenceId a, OccurrenceId b) {
  return std::max(CalcGiven(product, a), CalcGiven(product, b));
}

bool HasTeeth(const Mate& mate) {
  return mate.fit && (mate.fit->kind == FitKind::kThread || mate.fit->kind == FitKind::kInsert);
}

/** How deep threads, and teeth that are pushed on others, lie in one another. */
double CalcToothDepth(const Mate& mate) {
  // A nut's minor diameter is 0.8 of a screw's diameter, that of a tapping screw's core 0.75, and
  // the ring that locks a nut (ISO 7040) is narrower by 0.22.
  constexpr double kDepth = 0.3;  // Of the radius: a choice.
  return kDepth * mate.shaft_radius;
}

double SizeOf(const product::Part& part) {
  return part.box_B.is_empty() ? 0.0 : part.box_B.size().prod();
}

const product::Surface* SurfaceOf(const Product& product, OccurrenceId id, FaceId face) {
  const product::Part& part = product.part_of(id);
  return face.is_valid() && face.index() < part.faces.size() ? &part.faces[face.index()].surface
                                                             : nullptr;
}

/** The normal of the plane among two faces in W; none where neither is one. */
std::optional<Vec3> FindNormal(const Product& product, const SharedVolume& shared,
                               const FaceOverlap& faces) {
  for (const auto& [id, face] : {std::pair(shared.a, faces.a), std::pair(shared.b, faces.b)}) {
    const product::Surface* surface = SurfaceOf(product, id, face);
    if (surface != nullptr && surface->kind == SurfaceKind::kPlane) {
      return product.occurrences[id.index()].X_WB.q() * surface->axis;
    }
  }
  return std::nullopt;
}

/** The size on which the largest interference of two faces depends: the smaller part's width along
 the contact, or the least side of its box where the faces have no such direction [m]. */
double CalcContactSize(const Product& product, const SharedVolume& shared,
                       const FaceOverlap& faces) {
  const bool is_a = SizeOf(product.part_of(shared.a)) < SizeOf(product.part_of(shared.b));
  const OccurrenceId smaller = is_a ? shared.a : shared.b;
  const product::Part& part = product.part_of(smaller);
  if (const auto normal_W = FindNormal(product, shared, faces)) {
    return product::CalcExtentAlong(
        part, product.occurrences[smaller.index()].X_WB.q().inverse() * *normal_W);
  }
  return part.box_B.size().minCoeff();
}

/** The mate with the deepest teeth of two parts; null where they have none. */
const Mate* FindTeeth(const Product& product, OccurrenceId a, OccurrenceId b) {
  const Mate* deepest = nullptr;
  for (const Mate& mate : product.mates) {
    if (HasTeeth(mate) && mate.Joins(a, b) &&
        (deepest == nullptr || mate.shaft_radius > deepest->shaft_radius)) {
      deepest = &mate;
    }
  }
  return deepest;
}

/** The faces that are furthest beyond their bound. A shaft in a hole goes before all others: its
 depth is exact, and what lies about it comes of it. */
std::optional<DrawingError> FindError(const Product& product, const SharedVolume& shared) {
  std::optional<DrawingError> worst;
  std::pair<bool, double> most(false, kTouchingDepth);
  for (const FaceOverlap& faces : shared.faces) {
    if (faces.depth <= kTouchingDepth) {
      continue;
    }
    const double largest = CalcLargestDepth(product, shared, faces);
    const std::pair beyond(faces.is_coaxial, faces.depth - largest);
    if (beyond.second > kTouchingDepth && beyond > most) {
      most = beyond;
      worst = DrawingError{shared.a,    shared.b, faces.a,       faces.b,
                           faces.depth, largest,  shared.volume, faces.is_coaxial};
    }
  }
  return worst;
}

std::string PathInProduct(const Product& product, OccurrenceId id) {
  return product.occurrences[id.index()].path;
}

/** Names a face: "shaft 28.575 mm", "plane". */
std::string NameFace(const product::Surface* surface) {
  if (surface == nullptr) {
    return "surface";
  }
  const double diameter = ToMm(2 * surface->radius);
  switch (surface->kind) {
    case SurfaceKind::kPlane:
      return "plane";
    case SurfaceKind::kCylinder:
      return fmt::format("{} of {:.6g} mm", surface->outward > 0 ? "cylinder" : "hole", diameter);
    case SurfaceKind::kSphere:
      return fmt::format("{} of {:.6g} mm", surface->outward > 0 ? "ball" : "socket", diameter);
    case SurfaceKind::kCone:
      return "cone";
    case SurfaceKind::kTorus:
      return "torus";
    case SurfaceKind::kFreeform:
      break;
  }
  return "freeform face";
}

}  // namespace

double CalcLargestDepth(const Product& product, const Mate& mate) {
  const double joint =
      HasTeeth(mate) ? CalcToothDepth(mate) : 0.5 * fits::CalcLargestPress(2 * mate.hole_radius);
  return std::max(joint, CalcGiven(product, mate.a.occurrence, mate.b.occurrence));
}

double CalcLargestDepth(const Product& product, const SharedVolume& shared,
                        const FaceOverlap& faces) {
  double largest = CalcGiven(product, shared.a, shared.b);
  if (const Mate* teeth = FindTeeth(product, shared.a, shared.b)) {
    largest = std::max(largest, CalcToothDepth(*teeth));
  }
  if (!faces.is_coaxial) {
    return std::max(largest,
                    fits::CalcLargestInterference(CalcContactSize(product, shared, faces)));
  }
  const double radius = std::min(SurfaceOf(product, shared.a, faces.a)->radius,
                                 SurfaceOf(product, shared.b, faces.b)->radius);
  return std::max(largest, 0.5 * fits::CalcLargestPress(2 * radius));
}

double CalcLargestDepth(const Product& product, OccurrenceId a, OccurrenceId b) {
  const SharedVolume shared = MeasureSharedVolume(product, a, b);
  // Where rays find nothing, contact may.
  double largest = shared.faces.empty() ? CalcLargestDepth(product, shared, FaceOverlap()) : 0;
  for (const FaceOverlap& faces : shared.faces) {
    largest = std::max(largest, CalcLargestDepth(product, shared, faces));
  }
  return largest;
}

bool IsBeyondAnyFit(const Product& product, const Mate& mate) {
  return mate.kind == product::MateKind::kAxisHole &&
         mate.shaft_radius - mate.hole_radius > CalcLargestDepth(product, mate);
}

std::vector<DrawingError> ListDrawingErrors(const Product& product, WorkWatch* watch) {
  std::vector<DrawingError> errors;
  for (const SharedVolume& shared : ListSharedVolumes(product, watch)) {
    if (const auto error = FindError(product, shared)) {
      errors.push_back(*error);
    }
  }
  std::stable_sort(errors.begin(), errors.end(), [](const DrawingError& x, const DrawingError& y) {
    return x.volume > y.volume;
  });
  return errors;
}

OccurrenceId SmallerOf(const Product& product, const DrawingError& error) {
  return SizeOf(product.part_of(error.a)) < SizeOf(product.part_of(error.b)) ? error.a : error.b;
}

std::string DescribeDrawingError(const Product& product, const DrawingError& error) {
  const bool is_a = SmallerOf(product, error) == error.a;
  const product::Surface* own =
      SurfaceOf(product, is_a ? error.a : error.b, is_a ? error.face_a : error.face_b);
  const product::Surface* other =
      SurfaceOf(product, is_a ? error.b : error.a, is_a ? error.face_b : error.face_a);
  const std::string path = PathInProduct(product, is_a ? error.b : error.a);
  const std::string where = error.is_in_hole && own->outward > 0
                                ? fmt::format("{:.6g} mm in a hole of {:.6g} mm of {}",
                                              ToMm(2 * own->radius), ToMm(2 * other->radius), path)
                            : error.is_in_hole
                                ? fmt::format("a hole of {:.6g} mm on {:.6g} mm of {}",
                                              ToMm(2 * own->radius), ToMm(2 * other->radius), path)
                                : fmt::format("its {} behind the {} of {}, in the material",
                                              NameFace(own), NameFace(other), path);
  return fmt::format(
      "{}: {:.3f} mm deep, {:.3g} mm3; no joint of this kind and size has more than "
      "{:.3f} mm",
      where, ToMm(error.depth), units::ToMm3(error.volume), ToMm(error.largest));
}

void ReportDrawingErrors(const Product& product, Diagnostics* diagnostics) {
  struct Entry {
    const DrawingError* first{nullptr};
    int count{0};
  };

  std::map<std::pair<product::PartId, product::PartId>, Entry> entries;
  std::vector<Entry*> order;  // That of the errors: the largest volume first.
  for (const DrawingError& error : product.drawing_errors) {
    Entry& entry = entries[std::minmax(product.occurrences[error.a.index()].part,
                                       product.occurrences[error.b.index()].part)];
    if (++entry.count == 1) {
      entry.first = &error;
      order.push_back(&entry);
    }
  }
  for (const Entry* entry : order) {
    const std::string more =
        entry->count > 1 ? fmt::format(" (and {} more pairs of these two parts)", entry->count - 1)
                         : std::string();
    diagnostics->Warn("drawing-error", PathInProduct(product, SmallerOf(product, *entry->first)),
                      "is drawn with " + DescribeDrawingError(product, *entry->first) + more,
                      "correct the sizes or the position in the CAD system, or state what gives "
                      "under \"flexible\" in the side file");
  }
}

}  // namespace hvas::mates
