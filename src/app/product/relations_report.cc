#include "app/product/relations_report.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/terminal.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "base/units.h"
#include "mates/relations.h"
#include "product/names.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using product::ElementKind;
using product::Identity;
using product::Part;
using product::Product;
using product::Relation;
using product::RelationKind;
using product::RelationSide;

const char* NameOf(ElementKind kind) {
  switch (kind) {
    case ElementKind::kPlane:
      return "plane";
    case ElementKind::kCylinder:
      return "cylinder";
    case ElementKind::kSphere:
      return "sphere";
    case ElementKind::kEdge:
      break;
  }
  return "edge";
}

/** A relation of surfaces of one part: constraints of two features, and patterns of holes. */
struct SurfaceRelation {
  std::string kind;
  std::vector<product::FeatureId> features;
};

std::vector<SurfaceRelation> ListSurfaceRelations(const Part& part) {
  std::vector<SurfaceRelation> relations;
  for (const product::InnerConstraint& constraint : part.inner_constraints) {
    relations.push_back({ToString(constraint.kind), {constraint.a, constraint.b}});
  }
  for (const product::Form& form : part.forms) {
    if (form.kind == product::FormKind::kHolePattern) {
      relations.push_back({"pattern", form.features});
    }
  }
  return relations;
}

std::vector<std::uint32_t> FacesOf(const Part& part, product::FeatureId id) {
  std::vector<std::uint32_t> faces;
  for (const product::FaceId face : part.features[id.index()].faces) {
    faces.push_back(face.value());
  }
  return faces;
}

Json ToJson(const Identity& identity, const char* of, std::uint32_t id, const std::string& name) {
  return {{"of", of},
          {"id", id},
          {"name", name},
          {"number", identity.id},
          {"description", identity.description},
          {"version", identity.version},
          {"version_description", identity.version_description},
          {"designer", identity.designer},
          {"organisation", identity.organisation},
          {"created", identity.created}};
}

Json ToJson(const product::FileHeader& header) {
  return {{"format", header.format},
          {"name", header.name},
          {"description", header.description},
          {"time_stamp", header.time_stamp},
          {"authors", header.authors},
          {"organisations", header.organisations},
          {"preprocessor", header.preprocessor},
          {"originating_system", header.originating_system},
          {"authorisation", header.authorisation},
          {"schema", header.schema}};
}

Json ToJson(const RelationSide& side) {
  Json json{{"occurrence", side.occurrence.value()},
            {"element", NameOf(side.element)},
            {"feature", side.feature.value()}};
  if (side.second.is_valid()) {
    json["second_feature"] = side.second.value();
  }
  return json;
}

Json ToJson(const Relation& relation) {
  Json json{{"kind", mates::NameOf(relation.kind)},
            {"origin", relation.is_stated ? "user" : "inferred"},
            {"a", ToJson(relation.a)},
            {"b", ToJson(relation.b)}};
  if (relation.kind == RelationKind::kAngle) {
    json["angle_deg"] = units::ToDeg(relation.magnitude);
  } else if (relation.kind == RelationKind::kDistance) {
    json["distance_mm"] = units::ToMm(relation.magnitude);
  }
  json["free_translations"] = relation.free_translations;
  json["free_rotations"] = relation.free_rotations;
  json["residual_mm"] = units::ToMm(relation.residual);
  return json;
}

bool IsSelected(const Relation& relation, const Selection& selection) {
  return selection.Has(relation.a.occurrence) || selection.Has(relation.b.occurrence);
}

void PrintLine(const char* label, const std::string& text) {
  if (!text.empty()) {
    fmt::print("  {:<14}{}\n", label, Shorten(text, CountColumns() - 16));
  }
}

void PrintIdentities(const Product& product, const Selection& selection, bool is_all) {
  const product::FileHeader& header = product.header;
  fmt::print("\nFile\n");
  PrintLine("format", header.format);
  PrintLine("name", header.name);
  PrintLine("description", header.description);
  PrintLine("written", header.time_stamp);
  PrintLine("authors", header.authors);
  PrintLine("organisations", header.organisations);
  PrintLine("system", header.originating_system);
  PrintLine("translator", header.preprocessor);
  PrintLine("released by", header.authorisation);
  PrintLine("schema", header.schema);
  TextTable table({"of", "name", "number", "version", "designer", "created"}, 6);
  ListLimit limit(is_all);
  const auto add = [&](const std::string& of, const std::string& name, const Identity& identity) {
    if (identity.is_empty() || !limit.Next()) {
      return;
    }
    std::string below = identity.description;
    for (const std::string& more : {identity.version_description, identity.organisation}) {
      below += (below.empty() || more.empty() ? "" : "; ") + more;
    }
    table.Add({of, name, identity.id, identity.version, identity.designer, identity.created},
              below);
  };
  for (const product::Subassembly& subassembly : product.subassemblies) {
    add(fmt::format("s{}", subassembly.id.value()), subassembly.name, subassembly.identity);
  }
  for (const Part& part : product.parts) {
    if (selection.Has(part.id)) {
      add(fmt::format("p{}", part.id.value()), part.name, part.identity);
    }
  }
  fmt::print("\nIdentities of products (s subassembly, p part)\n{}", table.ToText(2));
  limit.PrintRest();
}

std::string Describe(const Relation& relation) {
  std::string text = mates::NameOf(relation.kind);
  std::replace(text.begin(), text.end(), '_', ' ');
  if (relation.kind == RelationKind::kAngle) {
    text += fmt::format(" {:.4g} deg", units::ToDeg(relation.magnitude));
  } else if (relation.kind == RelationKind::kDistance) {
    text += fmt::format(" {:.4g} mm", units::ToMm(relation.magnitude));
  }
  return text + fmt::format(", {} on {}{}", NameOf(relation.b.element), NameOf(relation.a.element),
                            relation.is_stated ? ", stated" : "");
}

void PrintRelations(const Product& product, const Selection& selection, bool is_all) {
  fmt::print("\nRelations beside mates, with the translations and rotations that each leaves\n");
  ListLimit limit(is_all);
  const std::size_t width = (CountColumns() - 14) / 2;
  for (const Relation& relation : product.relations) {
    if (IsSelected(relation, selection) && limit.Next()) {
      const auto path = [&](const RelationSide& side) {
        return Shorten(product.occurrences[side.occurrence.index()].path, width);
      };
      fmt::print("  {} t {} r  {} - {}\n{}", relation.free_translations, relation.free_rotations,
                 path(relation.a), path(relation.b), Wrap(Describe(relation), 11));
    }
  }
  limit.PrintRest();
}

void PrintSurfaceRelations(const Product& product, const Selection& selection, bool is_all) {
  fmt::print("\nRelations of the surfaces of each part (f feature)\n");
  for (const Part& part : product.parts) {
    if (!selection.Has(part.id)) {
      continue;
    }
    fmt::print("  p{} {}\n", part.id.value(), Shorten(part.name, CountColumns() - 10));
    ListLimit limit(is_all);
    for (const SurfaceRelation& relation : ListSurfaceRelations(part)) {
      if (limit.Next()) {
        std::vector<std::string> names;
        for (const product::FeatureId id : relation.features) {
          names.push_back(
              fmt::format("f{} {}", id.value(), ToString(part.features[id.index()].kind)));
        }
        fmt::print("{}", Wrap(fmt::format("{}: {}", relation.kind, fmt::join(names, ", ")), 4));
      }
    }
    limit.PrintRest();
  }
}

}  // namespace

Json ListIdentities(const Product& product, const Selection& selection) {
  Json identities = Json::array();
  for (const product::Subassembly& subassembly : product.subassemblies) {
    if (!subassembly.identity.is_empty()) {
      identities.push_back(
          ToJson(subassembly.identity, "subassembly", subassembly.id.value(), subassembly.name));
    }
  }
  for (const Part& part : product.parts) {
    if (selection.Has(part.id) && !part.identity.is_empty()) {
      identities.push_back(ToJson(part.identity, "part", part.id.value(), part.name));
    }
  }
  return identities;
}

Json ListRelations(const Product& product, const Selection& selection) {
  Json relations = Json::array();
  for (const Relation& relation : product.relations) {
    if (IsSelected(relation, selection)) {
      relations.push_back(ToJson(relation));
    }
  }
  return relations;
}

Json ToJson(const Part& part, const SurfaceRelation& relation) {
  Json features = Json::array();
  Json faces = Json::array();
  for (const product::FeatureId id : relation.features) {
    features.push_back(id.value());
    faces.push_back(FacesOf(part, id));
  }
  return {{"part", part.id.value()},
          {"kind", relation.kind},
          {"features", std::move(features)},
          {"faces", std::move(faces)}};
}

Json ListSurfaceRelations(const Product& product, const Selection& selection) {
  Json list = Json::array();
  for (const Part& part : product.parts) {
    if (selection.Has(part.id)) {
      for (const SurfaceRelation& relation : ListSurfaceRelations(part)) {
        list.push_back(ToJson(part, relation));
      }
    }
  }
  return list;
}

void AddRequestedSections(const Product& product, const Selection& selection, Json* json) {
  if (selection.Has(Section::kIdentity)) {
    (*json)["header"] = ToJson(product.header);
    (*json)["identities"] = ListIdentities(product, selection);
  }
  if (selection.Has(Section::kRelations)) {
    (*json)["relations"] = ListRelations(product, selection);
  }
  if (selection.Has(Section::kSurfaces)) {
    (*json)["surface_relations"] = ListSurfaceRelations(product, selection);
  }
}

void PrintRequestedSections(const Product& product, const Selection& selection, bool is_all) {
  if (selection.Has(Section::kIdentity)) {
    PrintIdentities(product, selection, is_all);
  }
  if (selection.Has(Section::kRelations)) {
    PrintRelations(product, selection, is_all);
  }
  if (selection.Has(Section::kSurfaces)) {
    PrintSurfaceRelations(product, selection, is_all);
  }
}

}  // namespace hvas::app
