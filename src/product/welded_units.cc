#include "product/welded_units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "product/bought_name.h"
#include "product/enclosure.h"
#include "product/fastener_name.h"
#include "product/rolling_bearing.h"
#include "product/same_place.h"
#include "product/variants.h"
#include "product/words.h"
#include "spatial/box_pairs.h"

namespace hvas::product {
namespace {

constexpr std::string_view kEverything = "all";
constexpr std::size_t kMostNamed = 6;  // Bodies that a note names: a choice.
constexpr std::size_t kMostBodies =
    400;  // of a bought unit; more is a product of its own. A choice.
constexpr std::size_t kFewestComponents = 3;  // that make designators a board's. A choice.

bool IsCalled(const Product& product, OccurrenceId id, std::string_view wanted) {
  const Occurrence& occurrence = product.occurrences[id.index()];
  return IsCalledByPath(occurrence.name, occurrence.path, wanted) ||
         std::any_of(occurrence.bodies.begin(), occurrence.bodies.end(),
                     [&](const std::string& path) { return IsCalledByPath({}, path, wanted); });
}

bool IsKeptApart(const Product& product, const Weld& weld, const std::vector<KeptApart>& apart) {
  if (apart.empty()) {
    return false;
  }
  const WeldName name = FindName(product, weld);
  return std::any_of(apart.begin(), apart.end(), [&](const KeptApart& kept) {
    const std::string& wanted = kept.name;
    return wanted == kEverything || IsCalledByPath(name.name, name.path, wanted) ||
           std::any_of(weld.members.begin(), weld.members.end(),
                       [&](OccurrenceId id) { return IsCalled(product, id, wanted); });
  });
}

/** The names that CAD systems and readers give to bodies that have none of their own. */
bool IsBodyName(std::string_view name) {
  constexpr std::array<std::string_view, 8> kNames{"solid", "shell",   "compound", "compsolid",
                                                   "body",  "surface", "brep",     "face"};
  std::string text;
  for (const char c : name) {
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) {
      text += static_cast<char>(c | 0x20);
    } else if (!(c >= '0' && c <= '9') && c != ' ' && c != '_' && c != ':' && c != '#' &&
               c != '-' && c != '.') {
      return false;
    }
  }
  return std::find(kNames.begin(), kNames.end(), text) != kNames.end();
}

/** The names of bodies that a fastener is drawn with: those without a meaning, and its portions. */
bool IsPortionOfFastener(std::string_view name) {
  constexpr std::array<std::string_view, 8> kPortions{"thread", "gewinde", "head",  "kopf",
                                                      "shank",  "schaft",  "helix", "core"};
  constexpr std::array<std::string_view, 5> kWholes{"screw", "bolt", "nut", "washer", "insert"};
  const std::string folded = FoldName(name);
  return IsBodyName(name) || (HasOneOf(folded, kPortions) && !HasOneOf(folded, kWholes));
}

class UnitSearch {
 public:
  UnitSearch(const Product& product, const std::vector<KeptApart>& apart, WorkWatch* watch)
      : product_(product),
        apart_(apart),
        watch_(watch),
        is_free_(product.occurrences.size(), true) {
    for (const Occurrence& occurrence : product.occurrences) {
      boxes_.push_back(spatial::Transform(occurrence.X_WB, product.part_of(occurrence.id).box_B));
      is_fastener_.push_back(HasNameOfFastener(occurrence));
    }
  }

  std::vector<Weld> Run() {
    AddComponents();
    AddNamedUnits(SubassemblyId(0));
    for (const auto& members : FindRollingBearings(product_, is_free_, watch_)) {
      Add({members, WeldReason::kRollingBearing});
    }
    AddBodiesOfParts();
    AddEnclosed();
    std::sort(welds_.begin(), welds_.end(),
              [](const Weld& a, const Weld& b) { return a.members.front() < b.members.front(); });
    return std::move(welds_);
  }

 private:
  [[nodiscard]] const Subassembly& NodeOf(SubassemblyId id) const {
    return product_.subassemblies[id.index()];
  }

  bool Add(Weld weld) {
    std::sort(weld.members.begin(), weld.members.end());
    const bool is_free = std::all_of(weld.members.begin(), weld.members.end(),
                                     [this](OccurrenceId id) { return is_free_[id.index()]; });
    if (weld.members.size() < 2 || !is_free || IsKeptApart(product_, weld, apart_)) {
      return false;
    }
    for (const OccurrenceId id : weld.members) {
      is_free_[id.index()] = false;
    }
    welds_.push_back(std::move(weld));
    return true;
  }

  void ListBelow(SubassemblyId node, std::vector<OccurrenceId>* ids) const {
    const std::vector<OccurrenceId>& own = NodeOf(node).occurrences;
    ids->insert(ids->end(), own.begin(), own.end());
    for (const SubassemblyId child : NodeOf(node).subassemblies) {
      ListBelow(child, ids);
    }
  }

  /** Levels of subassemblies below a node. */
  [[nodiscard]] int CountLevels(SubassemblyId node) const {
    int levels = 0;
    for (const SubassemblyId child : NodeOf(node).subassemblies) {
      levels = std::max(levels, 1 + CountLevels(child));
    }
    return levels;
  }

  [[nodiscard]] bool HasNameOfFastener(const Occurrence& occurrence) const {
    return ClassifyName(product_.part_of(occurrence.id).name) != FastenerKind::kNone ||
           ClassifyName(occurrence.name) != FastenerKind::kNone ||
           (IsBodyName(occurrence.name) &&
            ClassifyName(NodeOf(occurrence.parent).name) != FastenerKind::kNone);
  }

  [[nodiscard]] bool IsFastener(OccurrenceId id) const { return is_fastener_[id.index()]; }

  [[nodiscard]] std::vector<Box> BoxesOf(const std::vector<OccurrenceId>& ids) const {
    std::vector<Box> boxes;
    boxes.reserve(ids.size());
    for (const OccurrenceId id : ids) {
      boxes.push_back(boxes_[id.index()]);
    }
    return boxes;
  }

  /** Rule 3, from the root downwards. */
  void AddNamedUnits(SubassemblyId node) {
    for (const SubassemblyId child : NodeOf(node).subassemblies) {
      const BoughtName bought = ClassifyBoughtName(NodeOf(child).name);
      std::vector<OccurrenceId> members;
      if (bought != BoughtName::kNone && CountLevels(child) <= 1) {
        ListBelow(child, &members);
        std::sort(members.begin(), members.end());
        RemoveMounted(IsServoName(NodeOf(child).name), &members);
      }
      const bool may_be_unit = members.size() >= 2 && members.size() <= kMostBodies &&
                               (bought == BoughtName::kDesignation ||
                                std::none_of(members.begin(), members.end(),
                                             [this](OccurrenceId id) { return IsFastener(id); })) &&
                               !IsAssembledAround(members);
      if (!may_be_unit || !Add({members, WeldReason::kBoughtUnit})) {
        AddNamedUnits(child);
      }
    }
  }

  /** Whether a part of a servo has the holes of a horn: five or more of one size in a row or on a
   circle, in a small part. */
  [[nodiscard]] static bool HasFormOfHorn(const Part& part, double volume_of_unit) {
    constexpr int kFewestHoles = 5;        // A lid has four screws: a choice.
    constexpr double kLargestHorn = 0.25;  // Of the volume of the unit: a choice.
    return part.mass.volume < kLargestHorn * volume_of_unit &&
           std::any_of(part.forms.begin(), part.forms.end(), [](const Form& form) {
             return form.kind == FormKind::kHolePattern && form.count >= kFewestHoles;
           });
  }

  /** Takes out what is put on the shaft of a unit afterwards, such as the horn of a servo, if it
   can go straight away from the others, and the fasteners through it. */
  void RemoveMounted(bool is_servo, std::vector<OccurrenceId>* members) const {
    double volume = 0;
    for (const OccurrenceId id : *members) {
      volume += product_.part_of(id).mass.volume;
    }
    std::vector<OccurrenceId> mounted;
    for (const OccurrenceId id : *members) {
      if (IsMountedOnUnit(product_.occurrences[id.index()].name) ||
          IsMountedOnUnit(product_.part_of(id).name) ||
          (is_servo && HasFormOfHorn(product_.part_of(id), volume))) {
        mounted.push_back(id);
      }
    }
    std::vector<OccurrenceId> rest;
    for (const OccurrenceId id : *members) {
      const bool is_out = std::find(mounted.begin(), mounted.end(), id) != mounted.end() ||
                          (IsFastener(id) && CountHeld(product_, id, mounted) > 0);
      if (!is_out) {
        rest.push_back(id);
      }
    }
    const bool can_come_off = std::all_of(mounted.begin(), mounted.end(), [&](OccurrenceId id) {
      return HasStraightWayOut(product_, id, rest, watch_);
    });
    if (!mounted.empty() && can_come_off) {
      *members = std::move(rest);
    }
  }

  /** Whether a fastener from outside holds two members together, or a part from outside lies so
   between members that it has no straight way out. */
  [[nodiscard]] bool IsAssembledAround(const std::vector<OccurrenceId>& members) const {
    Box box;
    for (const OccurrenceId id : members) {
      box.Add(boxes_[id.index()]);
    }
    for (const Occurrence& other : product_.occurrences) {
      if (!MayGoOn(watch_)) {
        return true;
      }
      if (std::binary_search(members.begin(), members.end(), other.id)) {
        continue;
      }
      const Box& other_box = boxes_[other.id.index()];
      if (!other_box.Overlaps(box)) {
        continue;
      }
      if (IsFastener(other.id) ? CountHeld(product_, other.id, members) >= 2
                               : box.Contains(other_box.low) && box.Contains(other_box.high) &&
                                     !HasStraightWayOut(product_, other.id, members, watch_)) {
        return true;
      }
    }
    return false;
  }

  /** Components of a circuit board: nodes with reference designators beside a board. */
  void AddComponents() {
    for (const Subassembly& node : product_.subassemblies) {
      std::vector<SubassemblyId> components;
      bool has_board = false;
      for (const SubassemblyId child : node.subassemblies) {
        if (IsReferenceDesignator(NodeOf(child).name)) {
          components.push_back(child);
        } else {
          has_board = has_board || IsCircuitBoard(NodeOf(child).name);
        }
      }
      for (const OccurrenceId id : node.occurrences) {
        has_board = has_board || IsCircuitBoard(product_.occurrences[id.index()].name) ||
                    IsCircuitBoard(product_.part_of(id).name);
      }
      if (!has_board || components.size() < kFewestComponents) {
        continue;
      }
      for (const SubassemblyId component : components) {
        std::vector<OccurrenceId> members;
        ListBelow(component, &members);
        std::sort(members.begin(), members.end());
        if (members.size() <= kMostBodies && AreConnected(members)) {
          Add({members, WeldReason::kComponent});
        }
      }
    }
  }

  /** Whether the boxes of all touch, one by one; 2 % of the whole count as touching. */
  [[nodiscard]] bool AreConnected(const std::vector<OccurrenceId>& members) const {
    constexpr double kTouching = 0.02;  // Part of the whole: a choice.
    const std::vector<Box> boxes = BoxesOf(members);
    Box all;
    for (const Box& box : boxes) {
      all.Add(box);
    }
    const double slack = kTouching * (all.is_empty() ? 0.0 : all.size().norm());
    return spatial::AreConnected(boxes, slack, watch_);
  }

  /** Rule 1: bodies that one part of the file is drawn with. */
  void AddBodiesOfParts() {
    for (const Subassembly& node : product_.subassemblies) {
      if (node.occurrences.size() < 2) {
        continue;
      }
      const auto are_all = [&](bool (*is_kind)(std::string_view)) {
        return node.subassemblies.empty() &&
               std::all_of(node.occurrences.begin(), node.occurrences.end(), [&](OccurrenceId id) {
                 return is_kind(product_.occurrences[id.index()].name);
               });
      };
      const bool is_fastener =
          node.parent.is_valid() && ClassifyName(node.name) != FastenerKind::kNone;
      if (is_fastener && are_all(IsPortionOfFastener) && AreConnected(node.occurrences)) {
        Add({node.occurrences, WeldReason::kBodiesOfPart});
      } else {
        AddSurfaces(node, are_all(IsBodyName));
      }
    }
  }

  /** Gives each solid of a node the bodies without volume that belong to it: those that lie in its
   box, or, among bodies of one part, those whose box touches that of the solid. At the root, where
   all parts of a flat file are, only fasteners have such. */
  void AddSurfaces(const Subassembly& node, bool are_bodies) {
    constexpr double kInside = 0.01;  // Part of the box that a surface may stand out. A choice.
    std::vector<OccurrenceId> surfaces;
    std::vector<OccurrenceId> solids;
    std::vector<Box> near;  // Of each solid, what stands out a little.
    for (const OccurrenceId id : node.occurrences) {
      if (!(product_.part_of(id).mass.volume > 0)) {
        surfaces.push_back(id);
      } else if (is_free_[id.index()] && (node.parent.is_valid() || are_bodies || IsFastener(id))) {
        const Box& box = boxes_[id.index()];
        solids.push_back(id);
        near.push_back(box.is_empty() ? Box() : box.Expanded(kInside * box.size().norm()));
      }
    }
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> solid_of(surfaces.size(), kNone);
    const std::vector<Box> boxes = BoxesOf(surfaces);
    const auto size_of = [&](std::size_t k) { return boxes_[solids[k].index()].size().norm(); };
    spatial::ForEachPair(boxes, near, 0, watch_, [&](std::size_t i, std::size_t k) {
      const bool is_inside = near[k].Contains(boxes[i].low) && near[k].Contains(boxes[i].high);
      if ((is_inside || are_bodies) &&
          (solid_of[i] == kNone || size_of(k) < size_of(solid_of[i]))) {
        solid_of[i] = k;
      }
      return true;
    });
    std::map<OccurrenceId, std::vector<OccurrenceId>> surfaces_of;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      if (solid_of[i] != kNone) {
        surfaces_of[solids[solid_of[i]]].push_back(surfaces[i]);
      }
    }
    for (auto& [solid, members] : surfaces_of) {
      members.push_back(solid);
      Add({members, WeldReason::kBodiesOfPart});
    }
  }

  /** Rule 4: parts in a closed cavity. */
  void AddEnclosed() {
    for (const auto& [inner, outer] : FindEnclosed(product_, watch_)) {
      if (!is_free_[inner.index()] || IsFastener(inner)) {
        continue;
      }
      const auto unit = std::find_if(welds_.begin(), welds_.end(), [outer = outer](const Weld& w) {
        return std::binary_search(w.members.begin(), w.members.end(), outer);
      });
      if (unit == welds_.end()) {
        Add({{inner, outer}, WeldReason::kEnclosed});
      } else if (Weld grown = *unit;
                 !IsKeptApart(product_, {{inner, outer}, grown.reason}, apart_)) {
        grown.members.push_back(inner);
        std::sort(grown.members.begin(), grown.members.end());
        *unit = std::move(grown);
        is_free_[inner.index()] = false;
      }
    }
  }

  const Product& product_;
  const std::vector<KeptApart>& apart_;
  WorkWatch* watch_;
  std::vector<Box> boxes_;  // Of the occurrences, in W.
  std::vector<bool> is_fastener_;
  std::vector<bool> is_free_;
  std::vector<Weld> welds_;
};

/** Whether each name is that of something in the product. */
Result<void> CheckNames(const Product& product, const std::vector<KeptApart>& apart) {
  for (const auto& [wanted, where] : apart) {
    const auto is_called = [&product, &name = wanted](const Occurrence& occurrence) {
      return IsCalled(product, occurrence.id, name) ||
             ("/" + occurrence.path).find("/" + name + "/") != std::string::npos;
    };
    const bool is_known =
        wanted == kEverything ||
        std::any_of(product.occurrences.begin(), product.occurrences.end(), is_called);
    if (!is_known) {
      return Fail(ErrorCode::kInvalid,
                  "nothing in the product is called \"" + wanted + "\", which is to stay apart",
                  where.empty() ? product.source : where,
                  "take a name or a path from hvas inspect");
    }
  }
  return {};
}

std::string JoinNames(const Product& product, const Weld& weld) {
  std::vector<std::pair<std::string, int>> names;
  for (const OccurrenceId id : weld.members) {
    const std::string& name = product.occurrences[id.index()].name;
    const auto known = std::find_if(names.begin(), names.end(),
                                    [&name](const auto& item) { return item.first == name; });
    if (known == names.end()) {
      names.emplace_back(name, 1);
    } else {
      ++known->second;
    }
  }
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNamed); ++i) {
    text += (i == 0 ? "" : ", ") +
            (names[i].second > 1 ? std::to_string(names[i].second) + " x " : std::string()) +
            names[i].first;
  }
  return names.size() > kMostNamed
             ? text + " and " + std::to_string(names.size() - kMostNamed) + " more"
             : text;
}

/** One note for each unit and those that have the same parts for the same reason. */
void ReportUnits(const Product& product, const std::vector<Weld>& welds, Diagnostics* diagnostics) {
  std::map<std::pair<WeldReason, std::vector<PartId>>, std::vector<const Weld*>> groups;
  for (const Weld& weld : welds) {
    std::vector<PartId> parts;
    for (const OccurrenceId id : weld.members) {
      parts.push_back(product.occurrences[id.index()].part);
    }
    groups[{weld.reason, parts}].push_back(&weld);
  }
  std::map<OccurrenceId, const std::vector<const Weld*>*> in_order;
  for (const auto& [key, group] : groups) {
    in_order[group.front()->members.front()] = &group;
  }
  for (const auto& [first, group] : in_order) {
    const Weld& weld = *group->front();
    diagnostics->Note(
        "welded-unit", FindName(product, weld).path,
        "is one body of " + std::to_string(weld.members.size()) + " parts (" +
            JoinNames(product, weld) + "), because " + ToString(weld.reason) +
            (group->size() > 1 ? "; so are " + std::to_string(group->size() - 1) + " more of these"
                               : ""),
        "list it under \"apart\" in the side file, or name it with --apart, to "
        "assemble its parts");
  }
}

void ReportDuplicates(const Product& product, const std::vector<Weld>& welds,
                      Diagnostics* diagnostics) {
  for (const Weld& weld : welds) {
    const std::size_t count = weld.members.size() - 1;
    diagnostics->Note("duplicate-part", product.occurrences[weld.members.front().index()].path,
                      count == 1
                          ? std::string("a copy of this part has the same pose and is left "
                                        "out of the assembly")
                          : std::to_string(count) +
                                " copies of this part have the same pose and are left out of "
                                "the assembly",
                      "delete the copies in the CAD system, or name the part with --apart or under "
                      "\"apart\" in the side file");
  }
}

/** The variants that are to be left out, each with the part that stays; warns of them. */
std::vector<Weld> LeaveOutVariants(const Product& product, const std::vector<KeptApart>& apart,
                                   WorkWatch* watch, Diagnostics* diagnostics) {
  std::map<OccurrenceId, Weld> welds;
  for (const auto& [first, second, shared] : FindVariants(product, watch)) {
    if (IsKeptApart(product, {{first, second}, WeldReason::kVariant}, apart)) {
      continue;
    }
    diagnostics->Warn(
        "variant-part", product.occurrences[second.index()].path,
        "shares " + std::to_string(std::lround(100 * shared)) + " % of its volume, or of that of " +
            product.occurrences[first.index()].path +
            ", with it: one of them can be there, so this one is left out of the assembly",
        "delete one of them in the CAD system, or name it with --apart or under \"apart\" in the "
        "side file");
    welds.try_emplace(first, Weld{{first}, WeldReason::kVariant})
        .first->second.members.push_back(second);
  }
  std::vector<Weld> list;
  for (auto& [first, weld] : welds) {
    std::sort(weld.members.begin(), weld.members.end());
    list.push_back(std::move(weld));
  }
  return list;
}

}  // namespace

bool IsCalledByPath(const std::string& name, const std::string& path, std::string_view wanted) {
  return !wanted.empty() && (name == wanted || path == wanted ||
                             (path.size() > wanted.size() && path.ends_with(wanted) &&
                              path[path.size() - wanted.size() - 1] == '/'));
}

std::vector<Weld> FindDuplicates(const Product& product, const std::vector<KeptApart>& apart) {
  const std::vector<OccurrenceId> original_of = FindOriginals(product);
  std::map<OccurrenceId, std::vector<OccurrenceId>> copies;
  for (std::size_t i = 0; i < original_of.size(); ++i) {
    if (original_of[i].is_valid()) {
      copies[original_of[i]].push_back(OccurrenceId(i));
    }
  }
  std::vector<Weld> welds;
  for (const auto& [original, others] : copies) {
    Weld weld{{original}, WeldReason::kDuplicate};
    weld.members.insert(weld.members.end(), others.begin(), others.end());
    if (!IsKeptApart(product, weld, apart)) {
      welds.push_back(std::move(weld));
    }
  }
  return welds;
}

std::vector<Weld> FindWelds(const Product& product, const std::vector<KeptApart>& apart,
                            WorkWatch* watch) {
  return UnitSearch(product, apart, watch).Run();
}

Result<void> WeldUnits(const std::vector<KeptApart>& apart, Product* product,
                       Diagnostics* diagnostics, WorkWatch* watch) {
  if (auto checked = CheckNames(*product, apart); !checked) {
    return checked;
  }
  const std::vector<Weld> duplicates = FindDuplicates(*product, apart);
  ReportDuplicates(*product, duplicates, diagnostics);
  ApplyWelds(duplicates, product);
  const std::vector<Weld> variants = LeaveOutVariants(*product, apart, watch, diagnostics);
  ApplyWelds(variants, product);
  const std::vector<Weld> units = FindWelds(*product, apart, watch);
  if (!MayGoOn(watch)) {
    return Unexpected(watch->Explain("finding bought units", product->source));
  }
  ReportUnits(*product, units, diagnostics);
  ApplyWelds(units, product);
  return {};
}

}  // namespace hvas::product
