#include "app/product/product_json.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/product/joint_forms.h"
#include "app/product/overlaps_report.h"
#include "app/product/relations_report.h"
#include "base/units.h"
#include "mates/infer.h"
#include "mates/mate_kind.h"
#include "product/names.h"

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
  return {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};  // Zero has no sign.
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
  return {{"hole", count(FeatureKind::kHole)},   {"shaft", count(FeatureKind::kShaft)},
          {"plane", count(FeatureKind::kPlane)}, {"cone_seat", count(FeatureKind::kConeSeat)},
          {"taper", count(FeatureKind::kTaper)}, {"socket", count(FeatureKind::kSocket)},
          {"ball", count(FeatureKind::kBall)}};
}

/** Ids of faces, features, mates, ... as numbers. */
template <typename Tag>
Json ToJson(const std::vector<Id<Tag>>& ids) {
  Json json = Json::array();
  for (const Id<Tag> id : ids) {
    json.push_back(id.value());
  }
  return json;
}

Json ToJson(const std::optional<double>& value, double scale) {
  return value ? Json(scale * *value) : Json();
}

Json DimensionToJson(product::PartId part, const product::Dimension& dimension) {
  const bool is_angle = dimension.kind == product::DimensionKind::kAngular;
  const std::string unit = is_angle ? "_deg" : "_mm";
  const double scale = is_angle ? units::ToDeg(1) : ToMm(1);
  return {{"part", part.value()},
          {"entity", dimension.entity},
          {"kind", ToString(dimension.kind)},
          {"name", dimension.name},
          {"nominal" + unit, scale * dimension.nominal},
          {"upper" + unit, ToJson(dimension.upper, scale)},
          {"lower" + unit, ToJson(dimension.lower, scale)},
          {"fit", dimension.fit ? Json(*dimension.fit) : Json()},
          {"faces", ToJson(dimension.faces)}};
}

Json ToleranceToJson(product::PartId part, const product::GeometricTolerance& tolerance) {
  return {{"part", part.value()},
          {"entity", tolerance.entity},
          {"kind", ToString(tolerance.kind)},
          {"name", tolerance.name},
          {"magnitude_mm", ToMm(tolerance.magnitude)},
          {"datums", tolerance.datums},
          {"faces", ToJson(tolerance.faces)}};
}

Json ToJson(const product::Material& material) {
  return {{"name", material.name},
          {"standard", material.standard},
          {"is_standard_assumed", material.is_standard_assumed},
          {"density_kg_per_m3", material.density},
          {"is_density_assumed", material.is_assumed},
          {"youngs_modulus_pa", material.youngs_modulus},
          {"poisson_ratio", material.poisson_ratio},
          {"yield_strength_pa", material.yield_strength},
          {"thermal_expansion_per_k", material.thermal_expansion}};
}

Json PartToJson(const Part& part) {
  Json inertia = Json::array();
  for (int row = 0; row < 3; ++row) {
    inertia.push_back(ToJson(Vec3(part.mass.I_BBcm_B.row(row))));
  }
  return {{"id", part.id.value()},
          {"name", part.name},
          {"color_srgb", ToJson(part.color)},
          {"material", ToJson(part.material)},
          {"volume_mm3", units::ToMm3(part.mass.volume)},
          {"mass_kg", part.mass.mass},
          {"centre_of_mass_mm", ToMmJson(part.mass.p_BoBcm_B)},
          {"inertia_kg_m2", inertia},
          {"solid_count", part.solid_count},
          {"has_brep", part.has_brep},
          {"box_low_mm", ToMmJson(part.box_B.low)},
          {"box_high_mm", ToMmJson(part.box_B.high)},
          {"triangle_count", part.mesh.triangles.size()},
          {"display_triangle_count", part.display_mesh.triangles.size()},
          {"face_counts", CountSurfaces(part)},
          {"feature_counts", CountFeatures(part)},
          {"shape_hash", part.shape_hash}};
}

Json FeatureToJson(product::PartId part, std::size_t id, const product::Feature& feature) {
  return {{"part", part.value()},
          {"id", id},
          {"kind", ToString(feature.kind)},
          {"faces", ToJson(feature.faces)},
          {"origin_mm", ToMmJson(feature.origin_B)},
          {"axis", ToJson(feature.axis_B)},
          {"radius_mm", ToMm(feature.radius)},
          {"half_angle_deg", units::ToDeg(feature.half_angle)},
          {"span_low_mm", ToMm(feature.span_low)},
          {"span_high_mm", ToMm(feature.span_high)},
          {"coverage_deg", units::ToDeg(feature.coverage)},
          {"area_mm2", units::ToMm(units::ToMm(feature.area))},
          {"thread", ToString(feature.thread)},
          {"thread_pitch_mm", ToMm(feature.thread_pitch)}};
}

Json FormToJson(product::PartId part, std::size_t id, const product::Form& form) {
  return {{"part", part.value()},         {"id", id},
          {"kind", ToString(form.kind)},  {"features", ToJson(form.features)},
          {"faces", ToJson(form.faces)},  {"origin_mm", ToMmJson(form.origin_B)},
          {"axis", ToJson(form.axis_B)},  {"diameter_mm", ToMm(form.diameter)},
          {"depth_mm", ToMm(form.depth)}, {"angle_deg", units::ToDeg(form.angle)},
          {"count", form.count},          {"lead_in_mm", ToMm(form.lead_in)}};
}

Json FaceToJson(product::PartId part, std::size_t id, const product::Face& face) {
  const product::Surface& surface = face.surface;
  const bool is_cone = surface.kind == SurfaceKind::kCone;
  return {{"part", part.value()},
          {"id", id},
          {"kind", ToString(surface.kind)},
          {"origin_mm", ToMmJson(surface.origin)},
          {"axis", ToJson(surface.axis)},
          {"radius_mm", ToMm(surface.radius)},
          {"minor_radius_mm", is_cone ? 0 : ToMm(surface.second)},
          {"half_angle_deg", is_cone ? units::ToDeg(surface.second) : 0},
          {"is_outward", surface.outward > 0},
          {"is_recognised", face.is_recognised},
          {"residual_mm", ToMm(face.residual)},
          {"area_mm2", units::ToMm(units::ToMm(face.area))},
          {"triangle_count", face.triangle_count},
          {"color_srgb", face.color ? ToJson(*face.color) : Json()},
          {"entity", face.entity}};
}

Json OccurrenceToJson(const product::Occurrence& occurrence) {
  const Quat& q = occurrence.X_WB.q();
  return {{"id", occurrence.id.value()},
          {"part", occurrence.part.value()},
          {"subassembly", occurrence.parent.value()},
          {"name", occurrence.name},
          {"path", occurrence.path},
          {"bodies", occurrence.bodies},
          {"position_mm", ToMmJson(occurrence.X_WB.p())},
          {"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}}};
}

Json SubassemblyToJson(const product::Subassembly& subassembly) {
  return {{"id", subassembly.id.value()},
          {"parent", subassembly.parent.is_valid() ? Json(subassembly.parent.value()) : Json()},
          {"name", subassembly.name},
          {"subassemblies", ToJson(subassembly.subassemblies)},
          {"occurrences", ToJson(subassembly.occurrences)}};
}

Json ToJson(const product::Connector& connector) {
  Json json{{"occurrence", connector.occurrence.value()}, {"feature", connector.feature.value()}};
  if (connector.opposite.is_valid()) {
    json["opposite"] = connector.opposite.value();
  }
  return json;
}

Json ToJson(const product::Fit& fit) {
  return {{"kind", ToString(fit.kind)},
          {"code", fit.code},
          {"nominal_diameter_mm", ToMm(fit.nominal_diameter)},
          {"is_proposed", fit.is_proposed},
          {"reason", fit.reason}};
}

/** One number for the whole length, or places [depth_mm, diameter_mm]. */
Json ToJson(const std::vector<product::MeasuredDiameter>& measured) {
  if (measured.size() == 1) {
    return ToMm(measured.front().diameter);
  }
  Json json = Json::array();
  for (const auto& [depth, diameter] : measured) {
    json.push_back({ToMm(depth), ToMm(diameter)});
  }
  return json;
}

}  // namespace

Json ConditionsToJson(const product::Mate& mate) {
  const product::FitConditions& conditions = mate.conditions;
  const bool is_prismatic = mate.kind == product::MateKind::kPrismatic;
  Json json = Json::object();
  const auto add = [&json](const char* key, const std::optional<double>& value, double scale) {
    if (value) {
      json[key] = scale * *value;
    }
  };
  if (!conditions.hole_diameters.empty()) {
    json[is_prismatic ? "hole_width_mm" : "hole_diameter_mm"] = ToJson(conditions.hole_diameters);
  }
  if (!conditions.shaft_diameters.empty()) {
    json[is_prismatic ? "shaft_width_mm" : "shaft_diameter_mm"] =
        ToJson(conditions.shaft_diameters);
  }
  add("hole_rz_um", conditions.hole_roughness, units::ToUm(1));
  add("shaft_rz_um", conditions.shaft_roughness, units::ToUm(1));
  add("friction", conditions.friction, 1);
  add("hole_temperature_c", conditions.hole_temperature_c, 1);
  add("shaft_temperature_c", conditions.shaft_temperature_c, 1);
  return json;
}

namespace {

Json MateToJson(const product::Mate& mate) {
  Json json{{"id", mate.id.value()},         {"key", mate.key},
            {"kind", ToString(mate.kind)},   {"origin", ToString(mate.origin)},
            {"confidence", mate.confidence}, {"evidence", mate.evidence}};
  const bool is_prismatic = mate.kind == product::MateKind::kPrismatic;
  const bool has_fit = mates::HasFit(mate.kind);
  json[has_fit ? "hole" : "a"] = ToJson(mate.a);
  json[has_fit ? "shaft" : "b"] = ToJson(mate.b);
  Json surfaces = Json::array();
  for (const product::SurfaceConstraint& surface : mate.surfaces) {
    surfaces.push_back(
        {{"kind", ToString(surface.kind)}, {"a", surface.a.value()}, {"b", surface.b.value()}});
  }
  json["surfaces"] = std::move(surfaces);
  const bool is_area =
      mate.kind == product::MateKind::kFaceFace || mate.kind == product::MateKind::kSphereSeat;
  if (is_area) {
    json["overlap_mm2"] = ToMm(ToMm(mate.overlap));
  } else {
    json["engaged_mm"] = ToMm(mate.overlap);
  }
  if (!has_fit) {
    return json;
  }
  json[is_prismatic ? "hole_width_mm" : "hole_diameter_mm"] = ToMm(2 * mate.hole_radius);
  json[is_prismatic ? "shaft_width_mm" : "shaft_diameter_mm"] = ToMm(2 * mate.shaft_radius);
  if (is_prismatic) {
    json["breadth_mm"] = ToMm(mate.breadth);
  }
  json["fit"] = mate.fit ? ToJson(*mate.fit) : Json();
  json["conditions"] = ConditionsToJson(mate);
  return json;
}

Json JointToJson(const product::Joint& joint) {
  return {{"a", joint.a.value()},
          {"b", joint.b.value()},
          {"mates", ToJson(joint.mates)},
          {"free_translations", joint.free_translations},
          {"free_rotations", joint.free_rotations},
          {"pattern_count", joint.pattern_count}};
}

Json Summarise(const Product& product, const Diagnostics& diagnostics) {
  const auto count = [&product](product::MateKind kind) {
    return std::count_if(product.mates.begin(), product.mates.end(),
                         [kind](const product::Mate& mate) { return mate.kind == kind; });
  };
  Json mates_of_kind = Json::object();
  for (const product::MateKind kind : product::kMateKinds) {
    mates_of_kind[ToString(kind)] = count(kind);
  }
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
          {"mates", std::move(mates_of_kind)},
          {"joints", product.joints.size()},
          {"alignments", product.alignments.size()},
          {"tolerances",
           {{"dimensions", tolerances.dimensions},
            {"geometric", tolerances.geometric},
            {"fits", tolerances.fits}}},
          {"warnings", diagnostics.Count(Severity::kWarning)}};
}

/** What `convert` makes of the items of one part after another, of those that are selected. */
template <typename Items, typename Convert>
Json ListOfParts(const Product& product, const Selection& selection, Items items, Convert convert) {
  Json list = Json::array();
  for (const Part& part : product.parts) {
    if (!selection.Has(part.id)) {
      continue;
    }
    for (std::size_t i = 0; i < (part.*items).size(); ++i) {
      list.push_back(convert(part.id, i, (part.*items)[i]));
    }
  }
  return list;
}

/** Items with ids, of those that are selected. */
template <typename Item, typename Convert>
Json ListSelected(const std::vector<Item>& items, const Selection& selection, Convert convert) {
  Json list = Json::array();
  for (const Item& item : items) {
    if (selection.Has(item.id)) {
      list.push_back(convert(item));
    }
  }
  return list;
}

void AddTree(const Product& product, const Selection& selection, Json* json) {
  Json& subassemblies = (*json)["subassemblies"] = Json::array();
  for (const product::Subassembly& subassembly : product.subassemblies) {
    subassemblies.push_back(SubassemblyToJson(subassembly));
  }
  (*json)["occurrences"] = ListSelected(product.occurrences, selection, OccurrenceToJson);
}

void AddJoints(const Product& product, const Selection& selection, Json* json) {
  Json& joints = (*json)["joints"] = Json::array();
  for (const product::Joint& joint : product.joints) {
    if (std::any_of(joint.mates.begin(), joint.mates.end(),
                    [&](product::MateId id) { return selection.Has(id); })) {
      joints.push_back(JointToJson(joint));
    }
  }
  Json& alignments = (*json)["alignments"] = Json::array();
  for (const product::Alignment& alignment : product.alignments) {
    if (selection.Has(alignment.a.occurrence) || selection.Has(alignment.b.occurrence)) {
      alignments.push_back({{"a", ToJson(alignment.a)}, {"b", ToJson(alignment.b)}});
    }
  }
}

/** The mates by their fit, in the order of their first mates. */
Json GroupFits(const Product& product, const Selection& selection) {
  Json groups = Json::array();
  for (const product::Mate& mate : product.mates) {
    if (!mate.fit || !selection.Has(mate.id)) {
      continue;
    }
    Json group{{"kind", ToString(mate.fit->kind)},
               {"code", mate.fit->code},
               {"nominal_diameter_mm", ToMm(mate.fit->nominal_diameter)},
               {"is_proposed", mate.fit->is_proposed}};
    const auto found = std::find_if(groups.begin(), groups.end(), [&group](const Json& other) {
      return std::all_of(group.items().begin(), group.items().end(),
                         [&other](const auto& item) { return other[item.key()] == item.value(); });
    });
    if (found == groups.end()) {
      group["mates"] = {mate.id.value()};
      groups.push_back(std::move(group));
    } else {
      (*found)["mates"].push_back(mate.id.value());
    }
  }
  return groups;
}

}  // namespace

Json DiagnosticsToJson(const Diagnostics& diagnostics) {
  Json notes = Json::array();
  for (const Diagnostic& item : diagnostics.items()) {
    notes.push_back({{"severity", ToString(item.severity)},
                     {"code", item.code},
                     {"entity", item.entity},
                     {"message", item.message},
                     {"remedy", item.remedy}});
  }
  return notes;
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

Json ToJson(const Product& product, const Diagnostics& diagnostics, const Selection& selection,
            WorkWatch* watch) {
  Json json{{"format", kInspectFormat}, {"summary", Summarise(product, diagnostics)}};
  if (selection.Has(Section::kParts)) {
    json["parts"] = ListSelected(product.parts, selection, PartToJson);
  }
  if (selection.Has(Section::kTree)) {
    AddTree(product, selection, &json);
  }
  if (selection.Has(Section::kFeatures)) {
    json["features"] = ListOfParts(product, selection, &Part::features, FeatureToJson);
    json["forms"] = ListOfParts(product, selection, &Part::forms, FormToJson);
    json["inner_constraints"] = ListOfParts(
        product, selection, &Part::inner_constraints,
        [](product::PartId part, std::size_t /*id*/, const product::InnerConstraint& constraint) {
          return Json{{"part", part.value()},
                      {"kind", ToString(constraint.kind)},
                      {"a", constraint.a.value()},
                      {"b", constraint.b.value()}};
        });
  }
  if (selection.Has(Section::kFaces)) {
    json["faces"] = ListOfParts(product, selection, &Part::faces, FaceToJson);
  }
  if (selection.Has(Section::kMates)) {
    json["mates"] = ListSelected(product.mates, selection, MateToJson);
  }
  if (selection.Has(Section::kJoints)) {
    AddJoints(product, selection, &json);
  }
  if (selection.Has(Section::kFits)) {
    json["fits"] = GroupFits(product, selection);
    AddJointForms(product, selection, &json);
  }
  if (selection.Has(Section::kOverlaps)) {
    AddOverlaps(product, selection, watch, &json);
  }
  if (selection.Has(Section::kTolerances)) {
    const auto without_id = [](auto convert) {
      return [convert](product::PartId part, std::size_t /*id*/, const auto& item) {
        return convert(part, item);
      };
    };
    json["dimensions"] =
        ListOfParts(product, selection, &Part::dimensions, without_id(DimensionToJson));
    json["geometric_tolerances"] =
        ListOfParts(product, selection, &Part::geometric_tolerances, without_id(ToleranceToJson));
  }
  if (selection.Has(Section::kDiagnostics)) {
    json["diagnostics"] = DiagnosticsToJson(diagnostics);
  }
  AddRequestedSections(product, selection, &json);
  return json;
}

Json MatesToJson(const std::vector<product::Mate>& mates) {
  Json json = Json::array();
  for (const product::Mate& mate : mates) {
    json.push_back(MateToJson(mate));
  }
  return json;
}

void AddMeshes(const Product& product, const Selection& selection, bool is_fine, Json* json) {
  Json& meshes = (*json)["meshes"] = Json::array();
  for (const Part& part : product.parts) {
    if (!selection.Has(part.id)) {
      continue;
    }
    const bool is_display = !is_fine && !part.display_mesh.triangles.empty();
    const product::Mesh& mesh = is_display ? part.display_mesh : part.mesh;
    Json vertices = Json::array();
    for (const Vec3& vertex : mesh.vertices) {
      vertices.push_back(ToMmJson(vertex));
    }
    Json ranges = Json::array();
    for (const product::Face& face : part.faces) {
      ranges.push_back(is_display ? Json{face.first_display_triangle, face.display_triangle_count}
                                  : Json{face.first_triangle, face.triangle_count});
    }
    meshes.push_back({{"part", part.id.value()},
                      {"vertices_mm", std::move(vertices)},
                      {"triangles", mesh.triangles},
                      {"face_ranges", std::move(ranges)}});
  }
}

}  // namespace hvas::app
