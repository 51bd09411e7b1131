#include "product/validate.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace hvas::product {
namespace {

template <typename Tag, typename T>
bool IsIn(Id<Tag> id, const std::vector<T>& list) {
  return id.index() < list.size();
}

template <typename Tag, typename T>
bool IsInOrNone(Id<Tag> id, const std::vector<T>& list) {
  return !id.is_valid() || IsIn(id, list);
}

template <typename Tag, typename T>
bool AreIn(const std::vector<Id<Tag>>& ids, const std::vector<T>& list) {
  return std::all_of(ids.begin(), ids.end(), [&list](Id<Tag> id) { return IsIn(id, list); });
}

template <typename T>
bool AreNumbered(const std::vector<T>& list) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].id.is_valid() || list[i].id.index() != i) {
      return false;
    }
  }
  return true;
}

bool IsRange(std::uint64_t first, std::uint64_t count, std::size_t size) {
  return first + count <= size;
}

bool IsValid(const Mesh& mesh) {
  std::uint32_t largest = 0;
  for (const auto& triangle : mesh.triangles) {
    largest = std::max({largest, triangle[0], triangle[1], triangle[2]});
  }
  return mesh.triangles.empty() || largest < mesh.vertices.size();
}

bool IsValid(const Part& part) {
  const auto is_face_valid = [&part](const Face& face) {
    return IsRange(face.first_triangle, face.triangle_count, part.mesh.triangles.size()) &&
           IsRange(face.first_display_triangle, face.display_triangle_count,
                   part.display_mesh.triangles.size());
  };
  const auto has_faces = [&part](const auto& item) { return AreIn(item.faces, part.faces); };
  return IsValid(part.mesh) && IsValid(part.display_mesh) &&
         std::all_of(part.faces.begin(), part.faces.end(), is_face_valid) &&
         std::all_of(part.features.begin(), part.features.end(), has_faces) &&
         std::all_of(part.dimensions.begin(), part.dimensions.end(), has_faces) &&
         std::all_of(part.geometric_tolerances.begin(), part.geometric_tolerances.end(),
                     has_faces) &&
         std::all_of(part.forms.begin(), part.forms.end(),
                     [&part](const Form& form) {
                       return AreIn(form.faces, part.faces) && AreIn(form.features, part.features);
                     }) &&
         std::all_of(part.inner_constraints.begin(), part.inner_constraints.end(),
                     [&part](const InnerConstraint& constraint) {
                       return IsIn(constraint.a, part.features) &&
                              IsIn(constraint.b, part.features);
                     });
}

/** Every child is listed once, by its parent, which comes before it. */
bool IsTree(const Product& product) {
  std::size_t children = 0;
  std::size_t leaves = 0;
  std::vector<bool> is_child_listed(product.subassemblies.size());
  std::vector<bool> is_leaf_listed(product.occurrences.size());
  for (const Subassembly& node : product.subassemblies) {
    if (node.parent.is_valid() != (node.id.index() > 0)) {
      return false;
    }
    for (const SubassemblyId child : node.subassemblies) {
      if (!IsIn(child, product.subassemblies) || child <= node.id ||
          product.subassemblies[child.index()].parent != node.id ||
          is_child_listed[child.index()]) {
        return false;
      }
      is_child_listed[child.index()] = true;
      ++children;
    }
    for (const OccurrenceId leaf : node.occurrences) {
      if (!IsIn(leaf, product.occurrences) || product.occurrences[leaf.index()].parent != node.id ||
          is_leaf_listed[leaf.index()]) {
        return false;
      }
      is_leaf_listed[leaf.index()] = true;
      ++leaves;
    }
  }
  return leaves == product.occurrences.size() &&
         children + (product.subassemblies.empty() ? 0 : 1) == product.subassemblies.size();
}

bool IsValid(const Product& product, const Connector& connector) {
  return IsIn(connector.occurrence, product.occurrences) &&
         IsInOrNone(connector.feature, product.part_of(connector.occurrence).features) &&
         IsInOrNone(connector.opposite, product.part_of(connector.occurrence).features);
}

bool IsValid(const Product& product, const Mate& mate) {
  const auto has_walls = [](const Connector& side) {
    return side.feature.is_valid() && side.opposite.is_valid();
  };
  return IsValid(product, mate.a) && IsValid(product, mate.b) &&
         (mate.kind != MateKind::kPrismatic || (has_walls(mate.a) && has_walls(mate.b))) &&
         std::all_of(mate.surfaces.begin(), mate.surfaces.end(),
                     [&product, &mate](const SurfaceConstraint& surface) {
                       return IsInOrNone(surface.a, product.part_of(mate.a.occurrence).faces) &&
                              IsInOrNone(surface.b, product.part_of(mate.b.occurrence).faces);
                     });
}

bool IsValid(const Product& product, const RelationSide& side) {
  return IsIn(side.occurrence, product.occurrences) &&
         IsInOrNone(side.feature, product.part_of(side.occurrence).features) &&
         IsInOrNone(side.second, product.part_of(side.occurrence).features);
}

}  // namespace

bool Validate(const Product& product) {
  return AreNumbered(product.parts) && AreNumbered(product.subassemblies) &&
         AreNumbered(product.occurrences) && AreNumbered(product.mates) &&
         std::all_of(product.parts.begin(), product.parts.end(),
                     [](const Part& part) { return IsValid(part); }) &&
         std::all_of(product.occurrences.begin(), product.occurrences.end(),
                     [&product](const Occurrence& occurrence) {
                       return IsIn(occurrence.part, product.parts);
                     }) &&
         IsTree(product) &&
         std::all_of(product.mates.begin(), product.mates.end(),
                     [&product](const Mate& mate) { return IsValid(product, mate); }) &&
         std::all_of(product.joints.begin(), product.joints.end(),
                     [&product](const Joint& joint) {
                       return IsIn(joint.a, product.occurrences) &&
                              IsIn(joint.b, product.occurrences) &&
                              AreIn(joint.mates, product.mates);
                     }) &&
         std::all_of(product.alignments.begin(), product.alignments.end(),
                     [&product](const Alignment& alignment) {
                       return IsValid(product, alignment.a) && IsValid(product, alignment.b);
                     }) &&
         std::all_of(product.relations.begin(), product.relations.end(),
                     [&product](const Relation& relation) {
                       return IsValid(product, relation.a) && IsValid(product, relation.b);
                     }) &&
         std::all_of(product.contact_pairs.begin(), product.contact_pairs.end(),
                     [&product](const ContactPair& pair) {
                       return IsIn(pair.a, product.occurrences) &&
                              IsIn(pair.b, product.occurrences);
                     });
}

}  // namespace hvas::product
