#include "relations.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Common.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <fmt/format.h>
#include <gp_Ax3.hxx>
#include <gp_Lin.hxx>

namespace hvas::products {
namespace {

constexpr double kLineTolerance = 1e-5;
constexpr double kAngleTolerance = 1e-9;
constexpr double kLargestRadialClearance = 0.6;
constexpr double kLeastEngagement = 0.5;
constexpr double kLeastArea = 1.0;
constexpr int kLeastTurn_deg = 200;

Bnd_Box BoxOf(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::AddOptimal(shape, box, /*useTriangulation=*/Standard_False,
                         /*useShapeTolerance=*/Standard_False);
  return box;
}

bool SameLine(const gp_Ax1& a, const gp_Ax1& b) {
  return a.IsParallel(b, kAngleTolerance) && gp_Lin(a).Distance(b.Location()) < kLineTolerance;
}

/** Where along `axis` the point `p` is. */
double Along(const gp_Ax1& axis, const gp_Pnt& p) {
  return gp_Vec(axis.Location(), p).Dot(gp_Vec(axis.Direction()));
}

gp_Ax1 CanonicalAxis(const gp_Ax1& axis) {
  gp_Dir d = axis.Direction();
  const double first = std::abs(d.X()) > 1e-9 ? d.X() : std::abs(d.Y()) > 1e-9 ? d.Y() : d.Z();
  if (first < 0) d.Reverse();
  const double t = Along(gp_Ax1(axis.Location(), d), gp_Pnt(0, 0, 0));
  return {axis.Location().Translated(gp_Vec(d) * t), d};
}

gp_Trsf RelativePose(const PlacedPart& a, const PlacedPart& b) {
  return a.X_WB.Inverted() * b.X_WB;
}

double AreaOf(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties);
  return std::abs(properties.Mass());
}

}  // namespace

Relations::Key Relations::MakeKey(const PlacedPart& a, const PlacedPart& b) {
  const gp_Trsf X_AB = RelativePose(a, b);
  std::string place;
  for (int row = 1; row <= 3; ++row) {
    for (int column = 1; column <= 4; ++column) {
      place += fmt::format("{} ", std::llround(X_AB.Value(row, column) * 1e6));
    }
  }
  return {{a.part, b.part}, place};
}

void Relations::AddCylinder(const TopoDS_Face& face, std::vector<CylinderFeature>& cylinders) {
  const BRepAdaptor_Surface surface(face);
  const gp_Cylinder cylinder = surface.Cylinder();
  const bool reversed = face.Orientation() == TopAbs_REVERSED;
  CylinderFeature found;
  found.axis = CanonicalAxis(cylinder.Axis());
  found.radius = cylinder.Radius();
  found.is_hole = reversed == cylinder.Position().Direct();
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  const double s0 = Along(found.axis, surface.Value(u0, v0));
  const double s1 = Along(found.axis, surface.Value(u0, v1));
  found.low = std::min(s0, s1);
  found.high = std::max(s0, s1);
  found.turn.assign(360, false);
  const gp_Ax2 frame(found.axis.Location(), found.axis.Direction());  // Same for equal axes.
  constexpr double kDegree = std::numbers::pi / 180;
  const int samples = std::max(1, static_cast<int>((u1 - u0) / kDegree * 2));
  for (int i = 0; i < samples; ++i) {
    const gp_Vec radial(found.axis.Location(),
                        surface.Value(u0 + (i + 0.5) / samples * (u1 - u0), v0));
    const double angle =
        std::atan2(radial.Dot(gp_Vec(frame.YDirection())), radial.Dot(gp_Vec(frame.XDirection())));
    found.turn[static_cast<std::size_t>(std::floor(angle / kDegree) + 360) % 360] = true;
  }
  for (CylinderFeature& known : cylinders) {
    if (known.is_hole != found.is_hole || !SameLine(known.axis, found.axis) ||
        std::abs(known.radius - found.radius) > kLineTolerance ||
        found.low > known.high + kLineTolerance || known.low > found.high + kLineTolerance) {
      continue;
    }
    known.low = std::min(known.low, found.low);
    known.high = std::max(known.high, found.high);
    for (std::size_t i = 0; i < 360; ++i)
      known.turn[i] = known.turn[i] || found.turn[i];
    return;
  }
  cylinders.push_back(found);
}

const Relations::Features& Relations::FeaturesOf(const PartDefinition& part) {
  if (const auto known = features_.find(&part); known != features_.end()) return known->second;
  Features features;
  features.box = BoxOf(part.solid.shape);
  for (TopExp_Explorer it(part.solid.shape, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face face = TopoDS::Face(it.Current());
    const BRepAdaptor_Surface surface(face);
    if (surface.GetType() == GeomAbs_Cylinder) AddCylinder(face, features.cylinders);
    if (surface.GetType() != GeomAbs_Plane) continue;
    gp_Pln plane = surface.Plane();
    if ((face.Orientation() == TopAbs_REVERSED) == plane.Direct()) {
      plane.SetAxis(plane.Axis().Reversed());
    }
    Bnd_Box box = BoxOf(face);
    box.SetGap(kLineTolerance);  // Faces that touch have boxes that touch, give or take a rounding.
    features.planes.push_back({plane, face, box});
  }
  std::erase_if(features.cylinders, [](const CylinderFeature& cylinder) {
    return std::ranges::count(cylinder.turn, true) < kLeastTurn_deg;
  });
  return features_.emplace(&part, std::move(features)).first->second;
}

std::optional<DrawnMate> Relations::MatchPair(const CylinderFeature& ca, const CylinderFeature& cb,
                                              const gp_Trsf& X_AB) {
  const gp_Ax1 axis_b = cb.axis.Transformed(X_AB);
  if (ca.is_hole == cb.is_hole || !SameLine(ca.axis, axis_b)) return std::nullopt;
  const double hole = ca.is_hole ? ca.radius : cb.radius;
  const double shaft = ca.is_hole ? cb.radius : ca.radius;
  if (hole - shaft < -kLineTolerance || hole - shaft > kLargestRadialClearance) return std::nullopt;
  const auto at = [&](double s) {
    return Along(ca.axis, axis_b.Location().Translated(gp_Vec(axis_b.Direction()) * s));
  };
  const double low_b = std::min(at(cb.low), at(cb.high));
  const double high_b = std::max(at(cb.low), at(cb.high));
  const double overlap = std::min(ca.high, high_b) - std::max(ca.low, low_b);
  if (overlap < kLeastEngagement) return std::nullopt;
  return DrawnMate{DrawnMate::Kind::kAxisHole, ca.is_hole, 2 * hole, 2 * shaft, overlap, 0};
}

std::vector<DrawnMate> Relations::MatchCylinders(const Features& a, const Features& b,
                                                 const gp_Trsf& X_AB) {
  std::vector<DrawnMate> mates;
  std::vector<gp_Ax1> lines;
  for (const CylinderFeature& ca : a.cylinders) {
    for (const CylinderFeature& cb : b.cylinders) {
      const std::optional<DrawnMate> mate = MatchPair(ca, cb, X_AB);
      if (!mate) continue;
      const auto same =
          std::ranges::find_if(lines, [&](const gp_Ax1& line) { return SameLine(line, ca.axis); });
      if (same == lines.end()) {
        lines.push_back(ca.axis);
        mates.push_back(*mate);
        continue;
      }
      DrawnMate& best = mates[static_cast<std::size_t>(same - lines.begin())];
      const double gain =
          (best.hole_diameter - best.shaft_diameter) - (mate->hole_diameter - mate->shaft_diameter);
      if (gain > kLineTolerance ||
          (gain > -kLineTolerance && mate->overlap_length > best.overlap_length)) {
        best = *mate;
      }
    }
  }
  return mates;
}

std::vector<DrawnMate> Relations::MatchPlanes(const Features& a, const Features& b,
                                              const gp_Trsf& X_AB) {
  std::vector<DrawnMate> mates;
  std::vector<gp_Pln> planes;
  for (const PlaneFeature& pb : b.planes) {
    const gp_Pln plane_b = pb.plane.Transformed(X_AB);
    const Bnd_Box box_b = pb.box.Transformed(X_AB);
    for (const PlaneFeature& pa : a.planes) {
      if (!pa.plane.Axis().IsOpposite(plane_b.Axis(), kAngleTolerance) ||
          pa.plane.Distance(plane_b.Location()) > kLineTolerance || pa.box.IsOut(box_b)) {
        continue;
      }
      const double area =
          AreaOf(BRepAlgoAPI_Common(pa.face, pb.face.Moved(TopLoc_Location(X_AB))).Shape());
      if (area < 1e-6) continue;
      const auto same = std::ranges::find_if(planes, [&](const gp_Pln& plane) {
        return plane.Axis().Direction().IsEqual(pa.plane.Axis().Direction(), kAngleTolerance) &&
               plane.Distance(pa.plane.Location()) < kLineTolerance;
      });
      if (same == planes.end()) {
        planes.push_back(pa.plane);
        mates.push_back({DrawnMate::Kind::kFaceFace, true, 0, 0, 0, area});
      } else {
        mates[static_cast<std::size_t>(same - planes.begin())].overlap_area += area;
      }
    }
  }
  std::erase_if(mates, [](const DrawnMate& mate) { return mate.overlap_area < kLeastArea; });
  return mates;
}

bool Relations::BoxesOverlap(const PlacedPart& a, const PlacedPart& b, double margin) {
  Bnd_Box box_a = FeaturesOf(*a.part).box.Transformed(a.X_WB);
  const Bnd_Box box_b = FeaturesOf(*b.part).box.Transformed(b.X_WB);
  box_a.SetGap(box_a.GetGap() + margin);
  return !box_a.IsOut(box_b);
}

const std::vector<DrawnMate>& Relations::FindMates(const PlacedPart& a, const PlacedPart& b) {
  const auto [entry, is_new] = mates_.try_emplace(MakeKey(a, b));
  if (is_new && BoxesOverlap(a, b, kLineTolerance)) {
    const gp_Trsf X_AB = RelativePose(a, b);
    const Features& features_a = FeaturesOf(*a.part);
    const Features& features_b = FeaturesOf(*b.part);
    entry->second = MatchCylinders(features_a, features_b, X_AB);
    std::ranges::copy(MatchPlanes(features_a, features_b, X_AB), std::back_inserter(entry->second));
  }
  return entry->second;
}

double Relations::CalcCommonVolume(const PlacedPart& a, const PlacedPart& b) {
  if (!BoxesOverlap(a, b, -1e-6)) return 0;
  const auto [entry, is_new] = common_volumes_.try_emplace(MakeKey(a, b), 0.0);
  if (is_new) {
    const TopLoc_Location X_AB(RelativePose(a, b));
    entry->second = std::abs(CalcVolume(
        BRepAlgoAPI_Common(a.part->solid.shape, b.part->solid.shape.Moved(X_AB)).Shape()));
  }
  return entry->second;
}

}  // namespace hvas::products
