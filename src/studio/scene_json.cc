#include "studio/scene_json.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "fits/iso286.h"
#include "product/names.h"
#include "session/deformable_json.h"
#include "studio/event_json.h"

namespace hvas::studio {
namespace {

using product::OccurrenceId;
using sequence::SequenceStep;
using simulation::Model;

std::string HexOf(const product::Color& color) {
  const auto byte = [](float channel) {
    return std::lround(255 * std::min(1.0F, std::max(0.0F, channel)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(color.r), byte(color.g), byte(color.b));
}

const char* NameOf(SequenceStep::Kind kind) {
  switch (kind) {
    case SequenceStep::Kind::kBase:
      return "base";
    case SequenceStep::Kind::kInsert:
      return "insert";
    case SequenceStep::Kind::kPark:
      return "park";
    case SequenceStep::Kind::kRemove:
      return "remove";
    case SequenceStep::Kind::kAside:
      return "aside";
    case SequenceStep::Kind::kReturn:
      return "return";
    case SequenceStep::Kind::kAssume:
      return "assume";
  }
  return "insert";
}

Json SubassembliesOf(const product::Product& product) {
  Json all = Json::array();
  for (const product::Subassembly& subassembly : product.subassemblies) {
    Json children = Json::array();
    for (const product::SubassemblyId child : subassembly.subassemblies) {
      children.push_back(child.value());
    }
    all.push_back({{"id", subassembly.id.value()},
                   {"parent", subassembly.parent.is_valid() ? Json(subassembly.parent.value())
                                                            : Json(nullptr)},
                   {"name", subassembly.name},
                   {"subassemblies", std::move(children)},
                   {"occurrences", ToJson(subassembly.occurrences)}});
  }
  return all;
}

/** "first, second", of those that are there. */
std::string Join(const std::string& first, const std::string& second) {
  return first + (first.empty() || second.empty() ? "" : ", ") + second;
}

/** What the file states of a part as an item of a company's data; many files repeat the name. */
void AddIdentity(const product::Part& part, Json* occurrence) {
  const product::Identity& identity = part.identity;
  const std::string number = Join(identity.id, identity.version);
  if (!number.empty() && number != part.name) {
    (*occurrence)["number"] = number;
  }
  if (const std::string designer = Join(identity.designer, identity.created); !designer.empty()) {
    (*occurrence)["designer"] = designer;
  }
}

Json OccurrencesOf(const Model& model, const LiveState& state) {
  Json all = Json::array();
  for (const product::Occurrence& occurrence : model.product->occurrences) {
    const product::Part& part = model.product->part_of(occurrence.id);
    const simulation::Body& body = model.bodies[occurrence.id.index()];
    const bool is_base = IsBase(model.sequence, occurrence.id);
    // The base stands in its place from the beginning, also before the first tick of the run has
    // put it there.
    const simulation::Placement placement =
        is_base ? simulation::Placement::kPlaced : state.parts[occurrence.id.index()].placement;
    all.push_back(
        {{"id", occurrence.id.value()},
         {"name", occurrence.name},
         {"path", occurrence.path},
         {"parent", occurrence.parent.value()},
         {"part", occurrence.part.value()},
         {"color", HexOf(part.color)},
         {"placement", ToString(placement)},
         {"start", ToJson(body.X_WB_start)},
         {"goal", ToJson(body.X_WB_goal)},
         {"mass_kg", body.mass.mass},
         {"material", part.material.name.empty() ? part.material.standard : part.material.name},
         {"p_BoBcm_m", ToJson(body.mass.p_BoBcm_B)},
         {"is_base", is_base}});
    if (const auto leader = state.parts[occurrence.id.index()].leader; leader.is_valid()) {
      all.back()["leader"] = leader.value();
    }
    AddIdentity(part, &all.back());
  }
  return all;
}

/** Describes the fit with its limits by ISO 286 and the size drawn from the population; diametral,
 or of the width. */
Json FitOf(const Model& model, const product::Mate& mate) {
  if (!mate.fit) {
    return nullptr;
  }
  const product::Fit& fit = *mate.fit;
  Json json{{"code", fit.code},
            {"kind", ToString(fit.kind)},
            {"diameter_mm", units::ToMm(fit.nominal_diameter)},
            {"clearance_min_um", nullptr},
            {"clearance_max_um", nullptr},
            {"hole_um", nullptr},
            {"shaft_um", nullptr},
            {"clearance_actual_um", nullptr},
            {"clearance_along_um", nullptr},
            {"is_proposed", fit.is_proposed},
            {"reason", fit.reason}};
  if (const auto code = fits::ParseFit(fit.code)) {
    if (const auto limits = fits::CalcFitLimits(*code, fit.nominal_diameter)) {
      json["clearance_min_um"] = units::ToUm(limits->min_clearance);
      json["clearance_max_um"] = units::ToUm(limits->max_clearance);
      json["hole_um"] = {units::ToUm(limits->hole.lower), units::ToUm(limits->hole.upper)};
      json["shaft_um"] = {units::ToUm(limits->shaft.lower), units::ToUm(limits->shaft.upper)};
    }
  }
  if (const auto& force = model.mates[mate.id.index()].fit; force != nullptr) {
    const auto s = force->clearances();
    const auto [least, largest] = std::minmax_element(s.begin(), s.end());
    json["clearance_actual_um"] = units::ToUm(2 * force->mean_clearance());
    json["clearance_along_um"] = {units::ToUm(2 * *least), units::ToUm(2 * *largest)};
  }
  return json;
}

Json MatesOf(const Model& model) {
  const product::Product& product = *model.product;
  Json all = Json::array();
  for (const product::Mate& mate : product.mates) {
    const auto faces_of = [&](const product::Connector& side) {
      Json faces = Json::array();
      for (const product::FaceId face : FacesOf(product, side)) {
        faces.push_back(face.value());
      }
      return faces;
    };
    const spatial::Pose X_WM = model.bodies[mate.a.occurrence.index()].X_WB_goal * mate.a.X_BM;
    const Vec3 along = mate.kind == product::MateKind::kPrismatic ? Vec3::UnitX() : Vec3::UnitZ();
    all.push_back({{"id", mate.id.value()},
                   {"key", mate.key},
                   {"kind", ToString(mate.kind)},
                   {"a", mate.a.occurrence.value()},
                   {"b", mate.b.occurrence.value()},
                   {"faces_a", faces_of(mate.a)},
                   {"faces_b", faces_of(mate.b)},
                   {"origin", ToString(mate.origin)},
                   {"p_m", ToJson(X_WM.p())},
                   {"axis", ToJson(Vec3(X_WM.q() * along))},
                   {"confidence", mate.confidence},
                   {"evidence", mate.evidence},
                   {"fit", FitOf(model, mate)}});
  }
  return all;
}

Json LeftOutOf(const simulation::Model& model) {
  Json left_out = Json::array();
  for (const sequence::SequenceGap& gap : model.sequence.gaps) {
    left_out.push_back({{"occurrence", gap.occurrence.value()}, {"reason", gap.reason}});
  }
  return left_out;
}

Json StepsOf(const Model& model) {
  Json all = Json::array();
  for (const SequenceStep& step : model.sequence.steps) {
    all.push_back({{"kind", NameOf(step.kind)},
                   {"occurrence", step.occurrence.value()},
                   {"members", ToJson(step.members)},
                   {"way_in", ToJson(Vec3(-step.extraction_W))},
                   {"distance_m", step.engage_distance}});
  }
  return all;
}

Json DiagnosticsOf(const Diagnostics& diagnostics) {
  Json all = Json::array();
  for (const Diagnostic& item : diagnostics.items()) {
    all.push_back({{"severity", ToString(item.severity)},
                   {"code", item.code},
                   {"entity", item.entity},
                   {"message", item.message},
                   {"remedy", item.remedy}});
  }
  return all;
}

std::size_t CountTriangles(const product::Product& product) {
  std::size_t count = 0;
  for (const product::Occurrence& occurrence : product.occurrences) {
    const product::Part& part = product.part_of(occurrence.id);
    count += part.display_mesh.triangles.empty() ? part.mesh.triangles.size()
                                                 : part.display_mesh.triangles.size();
  }
  return count;
}

}  // namespace

Json MakeSceneJson(const OpenScene& scene, const LiveState& state) {
  const Model& model = *scene.model;
  const product::Product& product = *model.product;
  return {{"epoch", scene.epoch},
          {"name", product.name},
          {"source", product.source},
          {"glb", fmt::format("/api/model/{}.glb", scene.glb_hash)},
          {"glb_bytes", scene.glb->size()},
          {"triangles", CountTriangles(product)},
          {"table_z_m", model.table_z},
          {"centre_m", ToJson(model.centre_W)},
          {"radius_m", model.transfer_radius},
          {"seed", std::to_string(model.seed)},
          {"next_step", state.next_step},
          {"subassemblies", SubassembliesOf(product)},
          {"occurrences", OccurrencesOf(model, state)},
          {"mates", MatesOf(model)},
          {"steps", StepsOf(model)},
          {"deformables", session::MakeFormsJson(model.deformables)},
          {"left_out", LeftOutOf(model)},
          {"pending", simulation::CountPending(model)},
          {"diagnostics", DiagnosticsOf(scene.diagnostics)}};
}

Json MakeShieldedSceneJson(const OpenScene& scene, const LiveState& state) {
  Json json = MakeSceneJson(scene, state);
  json["diagnostics"] = Json::array();
  json["left_out"] = Json::array();
  json.erase("seed");
  for (Json& mate : json["mates"]) {
    mate["fit"] = nullptr;
    mate["evidence"] = "";
  }
  return json;
}

}  // namespace hvas::studio
