#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "fits/contact_compliance.h"
#include "mates/assignments.h"
#include "mates/relations.h"

namespace hvas::mates {
namespace {

using product::ContactPair;
using product::FeatureId;
using product::OccurrenceId;
using product::Part;
using product::Product;
using product::Relation;
using product::RelationSide;

Unexpected FailAt(const std::string& where, const Error& error) {
  return Fail(error.code, error.message, where, error.remedy);
}

/** The feature that a side names, or that has the face that it names. */
Result<RelationSide> FindSide(const Product& product, const SideEntry& entry,
                              const std::string& where) {
  const Result<OccurrenceId> occurrence = FindOccurrence(product, entry.occurrence);
  if (!occurrence) {
    return FailAt(where, occurrence.error());
  }
  const Part& part = product.part_of(*occurrence);
  std::size_t index = entry.feature.value_or(static_cast<std::uint32_t>(part.features.size()));
  if (entry.face) {
    const auto has_face = [&entry](const product::Feature& feature) {
      return std::any_of(feature.faces.begin(), feature.faces.end(),
                         [&entry](product::FaceId face) { return face.value() == *entry.face; });
    };
    const auto found = std::find_if(part.features.begin(), part.features.end(), has_face);
    index = static_cast<std::size_t>(found - part.features.begin());
  }
  if (index >= part.features.size() || product::IsCone(part.features[index].kind)) {
    return Fail(
        ErrorCode::kNotFound,
        fmt::format("\"{}\" has no plane, cylinder or sphere of this number", entry.occurrence),
        where, "write a face or feature that hvas inspect --only features lists");
  }
  return MakeSide(product, *occurrence, FeatureId(index));
}

Result<Relation> MakeStated(const Product& product, const StatedRelation& stated) {
  const Result<RelationSide> a = FindSide(product, stated.a, stated.where);
  if (!a) {
    return Unexpected(a.error());
  }
  const Result<RelationSide> b = FindSide(product, stated.b, stated.where);
  if (!b) {
    return Unexpected(b.error());
  }
  if (a->occurrence == b->occurrence) {
    return Fail(ErrorCode::kInvalid, "both sides are the same occurrence", stated.where,
                "name two occurrences");
  }
  if (!CanTie(stated.kind, a->element, b->element)) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("these surfaces cannot be in the relation \"{}\"", NameOf(stated.kind)),
                stated.where, "name surfaces of other kinds (docs/side-file.md)");
  }
  Relation relation;
  relation.kind = stated.kind;
  relation.a = *a;
  relation.b = *b;
  relation.magnitude = stated.angle.value_or(stated.distance.value_or(0));
  relation.is_stated = true;
  Measure(product, &relation);
  return relation;
}

fits::Elasticity ElasticityOf(const Product& product, OccurrenceId id) {
  const product::Material& material = product.part_of(id).material;
  return {material.youngs_modulus, material.poisson_ratio};
}

Result<ContactPair> MakeContact(const Product& product, const StatedContact& stated) {
  ContactPair pair;
  for (const auto& [name, id] : {std::pair(&stated.a, &pair.a), std::pair(&stated.b, &pair.b)}) {
    const Result<OccurrenceId> occurrence = FindOccurrence(product, *name);
    if (!occurrence) {
      return FailAt(stated.where, occurrence.error());
    }
    *id = *occurrence;
  }
  if (pair.a == pair.b) {
    return Fail(ErrorCode::kInvalid, "both sides are the same occurrence", stated.where,
                "name two occurrences");
  }
  pair.compliance = stated.is_by_moduli ? fits::CalcContactCompliance(ElasticityOf(product, pair.a),
                                                                      ElasticityOf(product, pair.b))
                                        : stated.compliance;
  pair.friction = stated.friction;
  return pair;
}

}  // namespace

Result<void> ApplyRelations(const SideFile& file, Product* product) {
  std::vector<Relation> relations;
  for (const StatedRelation& stated : file.relations) {
    Result<Relation> relation = MakeStated(*product, stated);
    if (!relation) {
      return Unexpected(relation.error());
    }
    relations.push_back(*std::move(relation));
  }
  std::vector<ContactPair> contacts;
  for (const StatedContact& stated : file.contacts) {
    Result<ContactPair> contact = MakeContact(*product, stated);
    if (!contact) {
      return Unexpected(contact.error());
    }
    contacts.push_back(*std::move(contact));
  }
  product->relations = std::move(relations);
  product->contact_pairs = std::move(contacts);
  return {};
}

}  // namespace hvas::mates
