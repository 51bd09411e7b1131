#include "app/assembly/gap_reason_json.h"

#include "app/assembly/run_report.h"
#include "base/units.h"

namespace hvas::app {
namespace {

using orders::GapChange;
using orders::GapChangeKind;
using orders::GapReason;
using sequence::MetFaces;
using simulation::Model;

nlohmann::ordered_json ListElements(const Vec3& direction_W) {
  const Vec3 plain_W = direction_W + Vec3::Zero();  // A zero has no sign for people.
  return nlohmann::ordered_json::array({plain_W.x(), plain_W.y(), plain_W.z()});
}

nlohmann::ordered_json ListPaths(const Model& model, const sequence::Unit& unit) {
  auto paths = nlohmann::ordered_json::array();
  for (const product::OccurrenceId id : unit) {
    paths.push_back(PathOf(model, id));
  }
  return paths;
}

nlohmann::ordered_json ToJson(const Model& model, const GapReason& reason, const MetFaces& stop) {
  nlohmann::ordered_json json;
  const auto face = [&model](product::OccurrenceId id, std::uint32_t index) {
    nlohmann::ordered_json json_face;
    if (index != contact::kNoFace) {  // Deep inside, contact does not know the face.
      json_face["index"] = index;
    }
    json_face["text"] = orders::DescribeFace(*model.product, id, index);
    return json_face;
  };
  json["face"] = face(reason.occurrence, stop.own_face);
  json["with"] = stop.other.is_valid() ? PathOf(model, stop.other) : std::string("the table");
  if (stop.other.is_valid()) {
    json["other_face"] = face(stop.other, stop.other_face);
  }
  json["too_tight_mm"] = units::ToMm(stop.depth);
  json["met_after_mm"] = units::ToMm(stop.travelled);
  return json;
}

nlohmann::ordered_json ToJson(const Model& model, const GapReason& reason,
                              const GapChange& change) {
  nlohmann::ordered_json json{{"kind", orders::NameOf(change.kind)},
                              {"parts", ListPaths(model, change.parts)},
                              {"works", change.has_worked}};
  if (change.kind == GapChangeKind::kClearance) {
    json["each_side_mm"] = units::ToMm(change.amount);
    json["diameter_mm"] = 2 * units::ToMm(change.amount);
  }
  if (change.kind == GapChangeKind::kFlexible) {
    json["gives_mm"] = units::ToMm(change.amount);
  }
  if (change.kind == GapChangeKind::kOrder) {
    json["goes_without_them"] = change.does_go_without;
    json["they_go_in_after_it"] = change.has_worked;
    json["they_turn"] = change.do_others_turn;
    json["they_give"] = change.do_others_give;
  }
  if (change.has_worked) {
    json["out_W"] = ListElements(change.direction_W);
    json["turns"] = change.does_turn;
    json["gives"] = change.does_give;
  }
  json["text"] = orders::DescribeGapChange(model, reason, change);
  return json;
}

}  // namespace

nlohmann::ordered_json MakeGapReasonJson(const Model& model, const GapReason& reason) {
  nlohmann::ordered_json json{{"id", reason.occurrence.value()},
                              {"name", PathOf(model, reason.occurrence)},
                              {"has_way", reason.has_way},
                              {"present", ListPaths(model, reason.present)}};
  if (reason.direction_W != Vec3::Zero()) {
    json["best_way"] = {{"out_W", ListElements(reason.direction_W)},
                        {"travelled_mm", units::ToMm(reason.travelled)},
                        {"length_mm", units::ToMm(reason.way_length)}};
    json["best_way"]["stops"] = nlohmann::ordered_json::array();
    for (const MetFaces& stop : reason.stops) {
      json["best_way"]["stops"].push_back(ToJson(model, reason, stop));
    }
    json["best_way"]["mates"] = nlohmann::ordered_json::array();
    for (const product::MateId mate : reason.mates) {
      json["best_way"]["mates"].push_back(mate.value());
    }
  }
  json["proof"] = {{"kind", orders::NameOf(reason.proof)},
                   {"is_proven", reason.proof != orders::GapProof::kNotFound}};
  if (reason.proof == orders::GapProof::kCaged) {
    json["proof"]["ball_diameter_mm"] = 2 * units::ToMm(reason.caged_radius);
  }
  json["changes"] = nlohmann::ordered_json::array();
  for (const GapChange& change : reason.changes) {
    json["changes"].push_back(ToJson(model, reason, change));
  }
  json["looks"] = reason.looks;
  json["is_limit_reached"] = reason.is_limit_reached;
  json["is_stopped"] = reason.is_stopped;
  json["text"] = orders::FormatGapReason(model, reason);
  return json;
}

}  // namespace hvas::app
