#include "product/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "base/digest.h"
#include "product/bought_name.h"
#include "product/features.h"

namespace hvas::product {
namespace {

constexpr double kSamePlace = 1e-7;  // [m], and of directions: what exports err by. A choice.

bool IsDigits(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/** A path without its last name, which may have become unique by "#2" and may hold a '/'. */
std::string WithoutName(const std::string& path, const std::string& name) {
  std::string_view rest = path;
  const std::size_t mark = rest.rfind('#');
  if (!rest.ends_with("/" + name) && mark != std::string_view::npos &&
      IsDigits(rest.substr(mark + 1))) {
    rest = rest.substr(0, mark);
  }
  if (rest.ends_with("/" + name)) {
    return std::string(rest.substr(0, rest.size() - name.size() - 1));
  }
  return path.substr(0, path.rfind('/'));
}

/** "Motor" of "Motor:3": the number of an instance is no part of its name. */
std::string WithoutInstanceNumber(const std::string& name) {
  const std::size_t mark = name.find_last_of(":#");
  return mark != std::string::npos && mark > 0 && IsDigits(std::string_view(name).substr(mark + 1))
             ? name.substr(0, mark)
             : name;
}

/** Ids of the nodes from the root down to a node. */
std::vector<SubassemblyId> ListNodesAbove(const Product& product, SubassemblyId node) {
  std::vector<SubassemblyId> nodes;
  for (SubassemblyId id = node; id.is_valid(); id = product.subassemblies[id.index()].parent) {
    nodes.push_back(id);
  }
  std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

std::size_t CountOccurrences(const Product& product, SubassemblyId node) {
  const Subassembly& subassembly = product.subassemblies[node.index()];
  std::size_t count = subassembly.occurrences.size();
  for (const SubassemblyId child : subassembly.subassemblies) {
    count += CountOccurrences(product, child);
  }
  return count;
}

/** Puts the geometry of members together in the frame of one of them. */
class PartWelder {
 public:
  PartWelder(const Product& product, const Weld& weld, OccurrenceId anchor)
      : product_(product),
        weld_(weld),
        X_BW_(product.occurrences[anchor.index()].X_WB.Inverse()),
        anchor_(product.part_of(anchor)) {}

  Part Make(const std::string& name, const Identity& identity) {
    part_.name = name;
    part_.color = anchor_.color;
    part_.material = anchor_.material;
    part_.identity = identity;
    bool has_volume = false;
    for (const OccurrenceId id : weld_.members) {
      has_volume = has_volume || product_.part_of(id).mass.volume > 0;
    }
    Digest digest;
    for (const OccurrenceId id : weld_.members) {
      const Part& member = product_.part_of(id);
      const Pose X_BM = X_BW_ * product_.occurrences[id.index()].X_WB;
      AddFaces(member, X_BM, member.mass.volume > 0 || !has_volume);
      part_.solid_count += member.solid_count;
      part_.has_brep = part_.has_brep && member.has_brep;
      AddToDigest(member, X_BM, &digest);
    }
    SumMass();
    part_.shape_hash = digest.Hex();
    BuildFeatures(&part_);
    return std::move(part_);
  }

 private:
  static void AddToDigest(const Part& member, const Pose& X_BM, Digest* digest) {
    digest->AddText(member.shape_hash);
    const Mat3 R = X_BM.R();
    for (Eigen::Index i = 0; i < 3; ++i) {
      digest->AddInt(std::llround(X_BM.p()[i] / kSamePlace));
      for (Eigen::Index k = 0; k < 3; ++k) {
        digest->AddInt(std::llround(R(i, k) / kSamePlace));
      }
    }
  }

  static void AppendMesh(const Mesh& from, const Pose& X_BM, Mesh* to) {
    const auto first = static_cast<std::uint32_t>(to->vertices.size());
    for (const Vec3& vertex : from.vertices) {
      to->vertices.push_back(X_BM * vertex);
    }
    for (const auto& [a, b, c] : from.triangles) {
      to->triangles.push_back({first + a, first + b, first + c});
    }
  }

  void AddFaces(const Part& member, const Pose& X_BM, bool has_contact) {
    const std::size_t first_face = part_.faces.size();
    const auto first = static_cast<std::uint32_t>(part_.mesh.triangles.size());
    const auto first_display = static_cast<std::uint32_t>(part_.display_mesh.triangles.size());
    for (Face face : member.faces) {
      face.surface.origin = X_BM * face.surface.origin;
      face.surface.axis = X_BM.q() * face.surface.axis;
      face.box_B = {};
      face.color = face.color ? face.color : std::optional(member.color);
      for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
        for (const std::uint32_t v : member.mesh.triangles[face.first_triangle + t]) {
          face.box_B.Add(X_BM * member.mesh.vertices[v]);
        }
      }
      part_.box_B.Add(face.box_B);
      face.first_triangle += first;
      face.first_display_triangle += first_display;
      if (!has_contact) {
        face.surface = {};
        face.first_triangle = first;
        face.triangle_count = 0;
      }
      part_.faces.push_back(std::move(face));
    }
    if (has_contact) {
      AppendMesh(member.mesh, X_BM, &part_.mesh);
    }
    AppendMesh(member.display_mesh, X_BM, &part_.display_mesh);
    const auto add_stated = [first_face](const auto& items, auto* to) {
      for (auto item : items) {
        for (FaceId& face : item.faces) {
          face = FaceId(first_face + face.index());
        }
        to->push_back(std::move(item));
      }
    };
    add_stated(member.dimensions, &part_.dimensions);
    add_stated(member.geometric_tolerances, &part_.geometric_tolerances);
  }

  /** Adds up the masses; inertias by the parallel axis theorem. */
  void SumMass() {
    MassProperties& sum = part_.mass;
    Vec3 moment = Vec3::Zero();
    for (const OccurrenceId id : weld_.members) {
      const MassProperties& mass = product_.part_of(id).mass;
      sum.volume += mass.volume;
      sum.mass += mass.mass;
      moment += mass.mass * (X_BW_ * (product_.occurrences[id.index()].X_WB * mass.p_BoBcm_B));
    }
    if (!(sum.mass > 0)) {
      return;
    }
    sum.p_BoBcm_B = moment / sum.mass;
    for (const OccurrenceId id : weld_.members) {
      const MassProperties& mass = product_.part_of(id).mass;
      const Pose X_BM = X_BW_ * product_.occurrences[id.index()].X_WB;
      const Vec3 r = X_BM * mass.p_BoBcm_B - sum.p_BoBcm_B;
      const Mat3 R = X_BM.R();
      sum.I_BBcm_B += R * mass.I_BBcm_B * R.transpose() +
                      mass.mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
    }
  }

  const Product& product_;
  const Weld& weld_;
  Pose X_BW_;
  const Part& anchor_;
  Part part_;
};

/** A welded part, and what it was made of. */
struct KnownPart {
  std::vector<std::pair<PartId, Pose>> members;  // Poses in the frame of the anchor.
  PartId part;
};

bool AreEqual(const KnownPart& a, const KnownPart& b) {
  if (a.members.size() != b.members.size()) {
    return false;
  }
  for (std::size_t i = 0; i < a.members.size(); ++i) {
    const auto& [part_a, X_a] = a.members[i];
    const auto& [part_b, X_b] = b.members[i];
    if (part_a != part_b || (X_a.p() - X_b.p()).norm() > kSamePlace ||
        (X_a.R() - X_b.R()).norm() > kSamePlace) {
      return false;
    }
  }
  return true;
}

/** Builds the new lists of occurrences, subassemblies and parts. */
class Welding {
 public:
  explicit Welding(Product* product)
      : product_(product), weld_of_(product->occurrences.size(), nullptr) {}

  void Run(const std::vector<Weld>& welds) {
    for (const Weld& weld : welds) {
      for (const OccurrenceId id : weld.members) {
        weld_of_[id.index()] = &weld;
      }
    }
    std::vector<Occurrence> occurrences;
    for (const Occurrence& occurrence : product_->occurrences) {
      const Weld* weld = weld_of_[occurrence.id.index()];
      if (weld == nullptr || weld->members.front() == occurrence.id) {
        occurrences.push_back(weld == nullptr ? occurrence : Merge(*weld));
      }
    }
    for (Part& part : made_) {
      product_->parts.push_back(std::move(part));
    }
    product_->occurrences = std::move(occurrences);
    RemoveParts();
    RemoveSubassemblies();
  }

 private:
  Occurrence Merge(const Weld& weld) {
    const WeldName name = FindName(*product_, weld);
    Occurrence merged = product_->occurrences[name.anchor.index()];
    for (const OccurrenceId id : weld.members) {
      const Occurrence& member = product_->occurrences[id.index()];
      if (member.bodies.empty()) {
        merged.bodies.push_back(member.path);
      } else {
        merged.bodies.insert(merged.bodies.end(), member.bodies.begin(), member.bodies.end());
      }
    }
    if (!DoesLeaveOut(weld.reason)) {
      merged.part = FindPart(weld, name);
    }
    merged.name = name.name;
    merged.path = name.path;
    if (name.node.is_valid()) {
      merged.parent = product_->subassemblies[name.node.index()].parent;
    }
    return merged;
  }

  PartId FindPart(const Weld& weld, const WeldName& name) {
    KnownPart wanted;
    const Pose X_BW = product_->occurrences[name.anchor.index()].X_WB.Inverse();
    for (const OccurrenceId id : weld.members) {
      const Occurrence& member = product_->occurrences[id.index()];
      wanted.members.emplace_back(member.part, X_BW * member.X_WB);
    }
    std::vector<KnownPart>& alike = known_[wanted.members.front().first];
    const auto found = std::find_if(alike.begin(), alike.end(), [&wanted](const KnownPart& other) {
      return AreEqual(other, wanted);
    });
    if (found != alike.end()) {
      return found->part;
    }
    wanted.part = PartId(product_->parts.size() + made_.size());
    const Identity& identity = name.node.is_valid()
                                   ? product_->subassemblies[name.node.index()].identity
                                   : product_->part_of(name.anchor).identity;
    Part part =
        PartWelder(*product_, weld, name.anchor).Make(WithoutInstanceNumber(name.name), identity);
    made_.push_back(std::move(part));
    alike.push_back(wanted);
    return wanted.part;
  }

  /** Leaves out parts without occurrences. */
  void RemoveParts() {
    std::vector<bool> is_used(product_->parts.size(), false);
    for (const Occurrence& occurrence : product_->occurrences) {
      is_used[occurrence.part.index()] = true;
    }
    std::vector<PartId> renumbered(product_->parts.size());
    std::vector<Part> parts;
    for (std::size_t i = 0; i < product_->parts.size(); ++i) {
      if (is_used[i]) {
        renumbered[i] = PartId(parts.size());
        parts.push_back(std::move(product_->parts[i]));
        parts.back().id = renumbered[i];
      }
    }
    product_->parts = std::move(parts);
    for (std::size_t i = 0; i < product_->occurrences.size(); ++i) {
      Occurrence& occurrence = product_->occurrences[i];
      occurrence.id = OccurrenceId(i);
      occurrence.part = renumbered[occurrence.part.index()];
    }
  }

  /** Leaves out subassemblies that hold no occurrence any more. */
  void RemoveSubassemblies() {
    std::set<SubassemblyId> used{SubassemblyId(0)};
    for (const Occurrence& occurrence : product_->occurrences) {
      for (const SubassemblyId id : ListNodesAbove(*product_, occurrence.parent)) {
        used.insert(id);
      }
    }
    std::vector<SubassemblyId> renumbered(product_->subassemblies.size());
    std::vector<Subassembly> nodes;
    for (Subassembly& node : product_->subassemblies) {
      if (used.count(node.id) == 0) {
        continue;
      }
      renumbered[node.id.index()] = SubassemblyId(nodes.size());
      node.id = SubassemblyId(nodes.size());
      node.subassemblies.clear();
      node.occurrences.clear();
      if (node.parent.is_valid()) {  // Parents come before their children.
        node.parent = renumbered[node.parent.index()];
        nodes[node.parent.index()].subassemblies.push_back(node.id);
      }
      nodes.push_back(std::move(node));
    }
    product_->subassemblies = std::move(nodes);
    for (Occurrence& occurrence : product_->occurrences) {
      occurrence.parent = renumbered[occurrence.parent.index()];
      product_->subassemblies[occurrence.parent.index()].occurrences.push_back(occurrence.id);
    }
  }

  Product* product_;
  std::vector<const Weld*> weld_of_;
  std::vector<Part> made_;
  std::map<PartId, std::vector<KnownPart>> known_;  // By the first member's part.
};

}  // namespace

const char* ToString(WeldReason reason) {
  constexpr std::array kNames{
      "copies of it at the same place",
      "they are bodies of one part of the file",
      "they are a rolling bearing",
      "their subassembly has the name of a unit that is bought as one piece",
      "they are one component of a circuit board",
      "some are enclosed by another one",
      "only one of them can be there"};
  return kNames.at(static_cast<std::size_t>(reason));
}

OccurrenceId FindAnchor(const Product& product, const Weld& weld) {
  if (DoesLeaveOut(weld.reason)) {
    return weld.members.front();
  }
  const auto size_of = [&product](OccurrenceId id) {
    const Part& part = product.part_of(id);
    return std::pair(part.mass.volume, part.box_B.is_empty() ? 0 : part.box_B.size().norm());
  };
  return *std::max_element(weld.members.begin(), weld.members.end(),
                           [&](OccurrenceId a, OccurrenceId b) { return size_of(a) < size_of(b); });
}

WeldName FindName(const Product& product, const Weld& weld) {
  WeldName name;
  name.anchor = FindAnchor(product, weld);
  const Occurrence& anchor = product.occurrences[name.anchor.index()];
  name.name = anchor.name;
  name.path = anchor.path;
  if (DoesLeaveOut(weld.reason)) {
    return name;
  }
  // The deepest node above all members is the end of what their ways from the root share.
  std::vector<SubassemblyId> shared = ListNodesAbove(product, anchor.parent);
  for (const OccurrenceId id : weld.members) {
    const auto way = ListNodesAbove(product, product.occurrences[id.index()].parent);
    const auto [end, ignored] = std::mismatch(shared.begin(), shared.end(), way.begin(), way.end());
    shared.erase(end, shared.end());
  }
  SubassemblyId node = shared.empty() ? SubassemblyId() : shared.back();
  // A component or a bought unit has its own name, not that of the model in it.
  const auto names_it = [&](SubassemblyId id) {
    return weld.reason == WeldReason::kComponent ||
           (weld.reason == WeldReason::kBoughtUnit &&
            ClassifyBoughtName(product.subassemblies[id.index()].name) != BoughtName::kNone);
  };
  const auto highest = std::find_if(shared.begin(), shared.end(), [&](SubassemblyId id) {
    return id.index() != 0 && names_it(id) && CountOccurrences(product, id) == weld.members.size();
  });
  node = highest != shared.end() ? *highest : node;
  if (weld.reason == WeldReason::kBoughtUnit) {
    // A unit that a part of its node is put on afterwards has the name of the node, too.
    const auto named = std::find_if(shared.begin(), shared.end(), [&](SubassemblyId id) {
      return id.index() != 0 && names_it(id);
    });
    name.name = named != shared.end() ? product.subassemblies[named->index()].name : name.name;
  }
  if (!node.is_valid() || node.index() == 0 ||
      CountOccurrences(product, node) != weld.members.size()) {
    return name;
  }
  name.node = node;
  name.path = WithoutName(anchor.path, anchor.name);
  for (SubassemblyId id = anchor.parent; id != node;
       id = product.subassemblies[id.index()].parent) {
    name.path = WithoutName(name.path, product.subassemblies[id.index()].name);
  }
  name.name = product.subassemblies[node.index()].name;
  return name;
}

void ApplyWelds(const std::vector<Weld>& welds, Product* product) {
  if (!welds.empty()) {
    Welding(product).Run(welds);
  }
}

}  // namespace hvas::product
