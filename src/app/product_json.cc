#include "app/product_json.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "base/units.h"
#include "mates/infer.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using product::FeatureKind;
using product::Part;
using product::Product;
using product::SurfaceKind;
using units::ToMm;

Json ToMmJson(const Vec3& v) {
  return {ToMm(v.x()), ToMm(v.y()), ToMm(v.z())};
}

Json ToJson(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json ToJson(const product::Color& color) {
  return {color.r, color.g, color.b};
}

Json CountSurfaces(const Part& part) {
  const auto count = [&part](SurfaceKind kind) {
    return std::count_if(part.faces.begin(), part.faces.end(),
                         [kind](const product::Face& f) { return f.surface.kind == kind; });
  };
  return {{"plane", count(SurfaceKind::kPlane)},
          {"cylinder", count(SurfaceKind::kCylinder)},
          {"cone", count(SurfaceKind::kCone)},
          {"sphere", count(SurfaceKind::kSphere)},
          {"torus", count(SurfaceKind::kTorus)},
          {"freeform", count(SurfaceKind::kFreeform)},
          {"recognised", std::count_if(part.faces.begin(), part.faces.end(),
                                       [](const product::Face& f) { return f.is_recognised; })}};
}

Json CountFeatures(const Part& part) {
  const auto count = [&part](FeatureKind kind) {
    return std::count_if(part.features.begin(), part.features.end(),
                         [kind](const product::Feature& f) { return f.kind == kind; });
  };
  return {{"hole", count(FeatureKind::kHole)},
          {"shaft", count(FeatureKind::kShaft)},
          {"plane", count(FeatureKind::kPlane)}};
}

Json ToJson(const std::vector<product::FaceId>& faces) {
  Json ids = Json::array();
  for (const product::FaceId face : faces) {
    ids.push_back(face.value());
  }
  return ids;
}

Json ToJson(const product::Dimension& dimension) {
  const bool is_angle = dimension.kind == product::DimensionKind::kAngular;
  const std::string unit = is_angle ? "_deg" : "_mm";
  const auto number = [is_angle](const std::optional<double>& value) {
    return value ? Json(is_angle ? units::ToDeg(*value) : ToMm(*value)) : Json();
  };
  return {{"entity", dimension.entity},
          {"kind", ToString(dimension.kind)},
          {"name", dimension.name},
          {"nominal" + unit, number(dimension.nominal)},
          {"upper" + unit, number(dimension.upper)},
          {"lower" + unit, number(dimension.lower)},
          {"fit", dimension.fit ? Json(*dimension.fit) : Json()},
          {"faces", ToJson(dimension.faces)}};
}

Json ToJson(const product::GeometricTolerance& tolerance) {
  return {{"entity", tolerance.entity}, {"kind", ToString(tolerance.kind)},
          {"name", tolerance.name},     {"magnitude_mm", ToMm(tolerance.magnitude)},
          {"datums", tolerance.datums}, {"faces", ToJson(tolerance.faces)}};
}

template <typename T>
Json ToArray(const std::vector<T>& items);

Json ToJson(const Part& part) {
  Json inertia = Json::array();
  for (int row = 0; row < 3; ++row) {
    inertia.push_back(ToJson(Vec3(part.mass.I_BBcm_B.row(row))));
  }
  return {{"id", part.id.value()},
          {"name", part.name},
          {"color_srgb", ToJson(part.color)},
          {"material", part.material.name},
          {"density_kg_per_m3", part.material.density},
          {"is_density_assumed", part.material.is_assumed},
          {"volume_mm3", units::ToMm3(part.mass.volume)},
          {"mass_kg", part.mass.mass},
          {"centre_of_mass_mm", ToMmJson(part.mass.p_BoBcm_B)},
          {"inertia_kg_m2", inertia},
          {"solid_count", part.solid_count},
          {"box_low_mm", ToMmJson(part.box_B.low)},
          {"box_high_mm", ToMmJson(part.box_B.high)},
          {"triangle_count", part.mesh.triangles.size()},
          {"faces", CountSurfaces(part)},
          {"features", CountFeatures(part)},
          {"dimensions", ToArray(part.dimensions)},
          {"geometric_tolerances", ToArray(part.geometric_tolerances)},
          {"shape_hash", part.shape_hash}};
}

Json ToJson(const product::Occurrence& occurrence) {
  const Quat& q = occurrence.X_WB.q();
  return {{"id", occurrence.id.value()},
          {"part", occurrence.part.value()},
          {"subassembly", occurrence.parent.value()},
          {"name", occurrence.name},
          {"path", occurrence.path},
          {"position_mm", ToMmJson(occurrence.X_WB.p())},
          {"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}}};
}

Json ToJson(const product::Subassembly& subassembly) {
  Json json{{"id", subassembly.id.value()},
            {"parent", nullptr},
            {"name", subassembly.name},
            {"subassemblies", Json::array()},
            {"occurrences", Json::array()}};
  if (subassembly.parent.is_valid()) {
    json["parent"] = subassembly.parent.value();
  }
  for (const auto id : subassembly.subassemblies) {
    json["subassemblies"].push_back(id.value());
  }
  for (const auto id : subassembly.occurrences) {
    json["occurrences"].push_back(id.value());
  }
  return json;
}

Json ToJson(const product::Connector& connector) {
  return {{"occurrence", connector.occurrence.value()}, {"feature", connector.feature.value()}};
}

Json ToJson(const product::Mate& mate) {
  Json json{{"id", mate.id.value()}, {"kind", ToString(mate.kind)}};
  if (mate.kind == product::MateKind::kFaceFace) {
    json["a"] = ToJson(mate.a);
    json["b"] = ToJson(mate.b);
    json["overlap_mm2"] = mate.overlap * 1e6;
    return json;
  }
  json["hole"] = ToJson(mate.a);
  json["shaft"] = ToJson(mate.b);
  json["hole_diameter_mm"] = ToMm(2 * mate.hole_radius);
  json["shaft_diameter_mm"] = ToMm(2 * mate.shaft_radius);
  json["engaged_mm"] = ToMm(mate.overlap);
  json["fit"] = nullptr;
  if (mate.fit) {
    json["fit"] = {{"kind", ToString(mate.fit->kind)},
                   {"code", mate.fit->code},
                   {"nominal_diameter_mm", ToMm(mate.fit->nominal_diameter)},
                   {"is_proposed", mate.fit->is_proposed},
                   {"reason", mate.fit->reason}};
  }
  return json;
}

Json Summarise(const Product& product, const Diagnostics& diagnostics) {
  const auto count = [&product](product::MateKind kind) {
    return std::count_if(product.mates.begin(), product.mates.end(),
                         [kind](const product::Mate& mate) { return mate.kind == kind; });
  };
  const mates::Linkage linkage = mates::CalcLinkage(product);
  const ToleranceCounts tolerances = CountTolerances(product);
  return {{"name", product.name},
          {"source", product.source},
          {"occurrences", product.occurrences.size()},
          {"unique_parts", product.parts.size()},
          {"depth", product.depth()},
          {"volume_mm3", units::ToMm3(product.volume())},
          {"mass_kg", product.mass()},
          {"size_mm", ToMmJson(product.box_W.size())},
          {"linked_parts", linkage.linked_parts},
          {"linked_groups", linkage.components},
          {"mates",
           {{"axis_hole", count(product::MateKind::kAxisHole)},
            {"face_face", count(product::MateKind::kFaceFace)}}},
          {"tolerances",
           {{"dimensions", tolerances.dimensions},
            {"geometric", tolerances.geometric},
            {"fits", tolerances.fits}}},
          {"warnings", diagnostics.Count(Severity::kWarning)}};
}

template <typename T>
Json ToArray(const std::vector<T>& items) {
  Json array = Json::array();
  for (const T& item : items) {
    array.push_back(ToJson(item));
  }
  return array;
}

}  // namespace

const char* ToString(Severity severity) {
  switch (severity) {
    case Severity::kNote:
      return "note";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      break;
  }
  return "error";
}

const char* ToString(product::MateKind kind) {
  return kind == product::MateKind::kAxisHole ? "axis_hole" : "face_face";
}

const char* ToString(product::FitKind kind) {
  switch (kind) {
    case product::FitKind::kClearance:
      return "clearance";
    case product::FitKind::kTransition:
      return "transition";
    case product::FitKind::kInterference:
      return "interference";
    case product::FitKind::kThread:
      break;
  }
  return "thread";
}

const char* ToString(product::DimensionKind kind) {
  switch (kind) {
    case product::DimensionKind::kDiameter:
      return "diameter";
    case product::DimensionKind::kRadius:
      return "radius";
    case product::DimensionKind::kLinear:
      return "linear";
    case product::DimensionKind::kAngular:
      return "angular";
    case product::DimensionKind::kOther:
      break;
  }
  return "other";
}

const char* ToString(product::GeometricToleranceKind kind) {
  constexpr std::array<const char*, 16> kNames{
      "angularity",       "circular_runout", "coaxiality",   "concentricity",
      "cylindricity",     "flatness",        "line_profile", "parallelism",
      "perpendicularity", "position",        "roundness",    "straightness",
      "surface_profile",  "symmetry",        "total_runout", "other"};
  return kNames.at(static_cast<std::size_t>(kind));
}

ToleranceCounts CountTolerances(const Product& product) {
  ToleranceCounts counts;
  for (const Part& part : product.parts) {
    counts.dimensions += part.dimensions.size();
    counts.geometric += part.geometric_tolerances.size();
    counts.fits += static_cast<std::size_t>(
        std::count_if(part.dimensions.begin(), part.dimensions.end(),
                      [](const product::Dimension& d) { return d.fit.has_value(); }));
  }
  return counts;
}

Json ToJson(const Product& product, const Diagnostics& diagnostics) {
  Json notes = Json::array();
  for (const Diagnostic& item : diagnostics.items()) {
    notes.push_back({{"severity", ToString(item.severity)},
                     {"code", item.code},
                     {"entity", item.entity},
                     {"message", item.message},
                     {"remedy", item.remedy}});
  }
  return {{"summary", Summarise(product, diagnostics)},
          {"parts", ToArray(product.parts)},
          {"subassemblies", ToArray(product.subassemblies)},
          {"occurrences", ToArray(product.occurrences)},
          {"mates", ToArray(product.mates)},
          {"diagnostics", notes}};
}

}  // namespace hvas::app
