#include "mates/polygon_fits.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "mates/fasteners.h"
#include "product/axis_features.h"
#include "spatial/box_pairs.h"

namespace hvas::mates {
namespace {

using product::Mate;
using product::OccurrenceId;
using product::Part;
using product::PolygonForm;
using product::PolygonKind;
using product::Product;

constexpr double kTolerance = 2e-6;      // [m]: that of a part's features.
constexpr double kOffAxis = 50e-6;       // [m] beside the play: what is drawn inexactly. A choice.
constexpr double kTightest = 0.1e-3;     // [m] by which the inner one may be wider: a press fit.
constexpr double kWidestPlay = 0.1;      // Of the width: printed pockets have 0.03. A choice.
constexpr double kParallelForms = 5e-3;  // [rad] between the axes of two forms. A choice.
constexpr double kSameTurn = 0.05;       // [rad] by which flats may be turned to each other: 3 deg.
constexpr double kLeastEngaged = 0.05;   // Of the width: a choice.

/** Polygons of the parts, each looked for once. */
class PartPolygons {
 public:
  explicit PartPolygons(const Product& product) : product_(product) {}

  const std::vector<PolygonForm>& Of(product::PartId id) {
    const auto known = polygons_.find(id);
    if (known != polygons_.end()) {
      return known->second;
    }
    product::RecognitionLimits limits;
    return polygons_
        .emplace(id, product::FindPolygons(product_.parts[id.index()], kTolerance, &limits))
        .first->second;
  }

 private:
  const Product& product_;
  std::map<product::PartId, std::vector<PolygonForm>> polygons_;
};

/** Whether flats of two forms are parallel, for one in the other. */
bool AreFlatsParallel(const PolygonForm& outer, const PolygonForm& inner, const Quat& q_WO,
                      const Quat& q_WI) {
  const Vec3 axis_W = q_WO * outer.axis_B;
  const Vec3 a_W = q_WO * outer.flat_B;
  const Vec3 b_W = q_WI * inner.flat_B;
  const double angle = std::atan2(axis_W.dot(a_W.cross(b_W)), a_W.dot(b_W));
  // Flats of a D face each other; all others come again at each side.
  const double step = outer.kind == PolygonKind::kFlatted
                          ? 2 * std::numbers::pi / outer.sides
                          : 2 * std::numbers::pi / (outer.sides * (outer.sides % 2 == 0 ? 1 : 2));
  const double turns = (angle - std::numbers::pi) / step;
  return std::abs(turns - std::round(turns)) * step < kSameTurn;
}

/** The length over which a form is in another one; 0 where it is not. */
double CalcEngaged(const PolygonForm& outer, const spatial::Pose& X_WO, const PolygonForm& inner,
                   const spatial::Pose& X_WI) {
  const double play = outer.width - inner.width;
  if (outer.kind != inner.kind || outer.sides != inner.sides || play < -kTightest ||
      play > kWidestPlay * outer.width) {
    return 0;
  }
  const Vec3 axis_W = X_WO.q() * outer.axis_B;
  const Vec3 other_W = X_WI.q() * inner.axis_B;
  const Vec3 d_W = X_WI * inner.origin_B - X_WO * outer.origin_B;
  if (axis_W.cross(other_W).norm() > kParallelForms ||
      axis_W.cross(d_W).norm() > 0.5 * std::max(0.0, play) + kOffAxis ||
      !AreFlatsParallel(outer, inner, X_WO.q(), X_WI.q())) {
    return 0;
  }
  const double at = axis_W.dot(d_W);
  const double end = at + axis_W.dot(other_W) * inner.depth;
  const double engaged =
      std::min(outer.depth, std::max(at, end)) - std::max(0.0, std::min(at, end));
  return engaged > kLeastEngaged * outer.width ? engaged : 0;
}

/** The prismatic mates of two parts of which both walls are flats of a form. */
std::vector<product::MateId> ListMatesOn(const Product& product, const PolygonFit& fit) {
  std::vector<product::MateId> mates;
  for (const Mate& mate : product.mates) {
    if (mate.kind != product::MateKind::kPrismatic || mate.a.occurrence != fit.outer ||
        mate.b.occurrence != *fit.inner) {
      continue;
    }
    const std::vector<product::FaceId> walls = product::FacesOf(product, mate.a);
    const bool is_on = std::all_of(walls.begin(), walls.end(), [&](product::FaceId wall) {
      return std::binary_search(fit.form.faces.begin(), fit.form.faces.end(), wall);
    });
    if (is_on) {
      mates.push_back(mate.id);
    }
  }
  return mates;
}

/** Whether a bore that no part is in is made to hold one. */
bool HoldsSomething(const Part& part, const PolygonForm& form) {
  constexpr double kRoundAbout = 3;  // Of the width: what is larger is a plate. A choice.
  if (form.kind != PolygonKind::kRegular || form.sides != 4) {
    return true;
  }
  return std::any_of(
      part.features.begin(), part.features.end(), [&form](const product::Feature& feature) {
        return feature.kind == product::FeatureKind::kShaft &&
               2 * feature.radius < kRoundAbout * form.width &&
               product::IsParallel(feature.axis_B, form.axis_B) &&
               product::DistanceToAxis(feature.origin_B, form.origin_B, form.axis_B) < kOffAxis;
      });
}

}  // namespace

std::vector<PolygonFit> FindPolygonFits(const Product& product, WorkWatch* watch) {
  const std::vector<FastenerKind> kinds = ClassifyOccurrences(product);
  PartPolygons polygons(product);
  std::vector<spatial::Box> boxes;
  std::vector<std::vector<PolygonFit>> of_outer(product.occurrences.size());
  for (const product::Occurrence& occurrence : product.occurrences) {
    const Part& part = product.part_of(occurrence.id);
    boxes.push_back(spatial::Transform(occurrence.X_WB, part.box_B));
    if (kinds[occurrence.id.index()] == FastenerKind::kScrew || !MayGoOn(watch)) {
      continue;
    }
    for (const PolygonForm& form : polygons.Of(part.id)) {
      if (form.is_recess) {
        of_outer[occurrence.id.index()].push_back({occurrence.id, form, {}, 0, 0, {}});
      }
    }
  }
  const auto fill = [&](OccurrenceId outer, OccurrenceId inner) {
    for (PolygonFit& fit : of_outer[outer.index()]) {
      for (const PolygonForm& form : polygons.Of(product.part_of(inner).id)) {
        const double engaged = form.is_recess
                                   ? 0.0
                                   : CalcEngaged(fit.form, product.occurrences[outer.index()].X_WB,
                                                 form, product.occurrences[inner.index()].X_WB);
        if (engaged > fit.engaged) {
          fit.inner = inner;
          fit.inner_width = form.width;
          fit.engaged = engaged;
        }
      }
    }
  };
  spatial::ForEachPair(boxes, 0, watch, [&](std::size_t i, std::size_t k) {
    fill(OccurrenceId(i), OccurrenceId(k));
    fill(OccurrenceId(k), OccurrenceId(i));
    return true;
  });
  std::vector<PolygonFit> fits;
  for (std::vector<PolygonFit>& list : of_outer) {
    for (PolygonFit& fit : list) {
      if (!fit.inner && !HoldsSomething(product.part_of(fit.outer), fit.form)) {
        continue;
      }
      if (fit.inner) {
        fit.mates = ListMatesOn(product, fit);
      }
      fits.push_back(std::move(fit));
    }
  }
  return fits;
}

std::string DescribePolygon(const PolygonForm& form) {
  const char* const thing = form.is_through ? "bore" : "pocket";
  switch (form.kind) {
    case PolygonKind::kRegular:
      return fmt::format("{} {}",
                         form.sides == 4   ? "square"
                         : form.sides == 6 ? "hexagonal"
                                           : "octagonal",
                         thing);
    case PolygonKind::kFlatted:
      return fmt::format("{} {}", form.sides == 1 ? "D" : "double D", thing);
    case PolygonKind::kSpline:
      return fmt::format("splined {} with {} teeth", thing, form.sides);
  }
  return {};
}

}  // namespace hvas::mates
