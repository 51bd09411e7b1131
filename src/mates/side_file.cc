#include "mates/side_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/regular_file.h"
#include "base/units.h"
#include "mates/located_json.h"

namespace hvas::mates {
namespace {

using nlohmann::ordered_json;
using Type = SideFileType;

constexpr std::size_t kLargestFile = 16'000'000;  // [bytes]: 100,000 fits. A choice.

constexpr std::array<std::string_view, 2> kFormats{"hvas-assignments-1", kSideFileFormat};
constexpr std::array<std::string_view, 5> kMateKinds{"axis_hole", "face_face", "cone_seat",
                                                     "sphere_seat", "prismatic"};
static_assert(kMateKinds.size() == product::kMateKinds.size(), "a kind of mate has no name here");

// Edges have no name in a side file: relations of them are inferred only.
constexpr std::array<std::string_view, 7> kRelationNames{
    "parallel", "perpendicular", "angle", "flush", "distance", "tangent", "hole_to_hole"};
constexpr std::array kStatedKinds{
    product::RelationKind::kParallel,  product::RelationKind::kPerpendicular,
    product::RelationKind::kAngle,     product::RelationKind::kFlush,
    product::RelationKind::kDistance,  product::RelationKind::kTangent,
    product::RelationKind::kHoleToHole};
static_assert(kRelationNames.size() == kStatedKinds.size(), "a kind of relation has no name here");
constexpr std::array<std::string_view, 1> kComplianceRules{"by_moduli"};

// What is larger is a slip of the pen or of the unit: choices, but absolute zero and the largest
// number of a face, which is 2^32 - 2.
constexpr double kLargestDiameter_mm = 100'000;
constexpr double kLargestRoughness_um = 1000;
constexpr double kLargestFriction = 2;
constexpr double kColdest_c = -273.15;
constexpr double kHottest_c = 1500;
constexpr double kLargestDistance_mm = 100'000;
constexpr double kLargestAngle_deg = 180;
constexpr double kLargestCompliance_um = 1000;  // [um/N]: softer than any solid part.
constexpr double kLargestGive_mm = 1000;        // [mm]: what gives more is no part to put in.
constexpr double kMostCoils = 10'000;           // More wire than a part has: a choice.
constexpr double kPascalsPerMegapascal = 1e6;   // By definition.
constexpr double kStiffestMaterial = 2e12;      // [Pa]: diamond has 1.1e12.
constexpr double kStiffestSpring = 10e9;        // [N/m]: stiffer than a block of steel of 0.1 m.
constexpr double kMostFaces = 4294967294;
constexpr std::size_t kMostPlaces = 1000;  // of a measured diameter: one each 0.1 mm of 100 mm

constexpr SideFileKey Text(std::string_view name, bool is_required = false) {
  return {name, Type::kText, is_required, 0, 0, false, false, {}};
}

constexpr SideFileKey Note() {
  return {"note", Type::kText, false, 0, 0, false, true, {}};
}

constexpr SideFileKey Number(std::string_view name, double low, double high,
                             bool is_low_excluded = false) {
  return {name, Type::kNumber, false, low, high, is_low_excluded, false, {}};
}

constexpr SideFileKey Needed(SideFileKey key) {
  key.is_required = true;
  return key;
}

constexpr SideFileKey Diameter(std::string_view name) {
  return Number(name, 0, kLargestDiameter_mm, true);
}

constexpr SideFileKey Diameters(std::string_view name) {
  return {name, Type::kDiameters, false, 0, kLargestDiameter_mm, true, false, {}};
}

constexpr SideFileKey Index(std::string_view name) {
  return {name, Type::kIndex, false, 0, kMostFaces, false, false, {}};
}

constexpr SideFileKey Of(Type type, std::string_view name, bool is_required) {
  return {name, type, is_required, 0, 0, false, false, {}};
}

constexpr SideFileKey Choice(std::string_view name, std::span<const std::string_view> choices,
                             bool is_required) {
  return {name, Type::kText, is_required, 0, 0, false, false, choices};
}

constexpr std::array kDocumentKeys{
    Choice("format", kFormats, true),    Note(),
    Of(Type::kList, "fits", false),      Of(Type::kList, "mates", false),
    Of(Type::kList, "removed", false),   Of(Type::kList, "relations", false),
    Of(Type::kList, "contacts", false),  Of(Type::kList, "apart", false),
    Of(Type::kList, "compliant", false), Of(Type::kList, "flexible", false),
    Of(Type::kList, "elastic", false)};

constexpr std::array kFitKeys{Text("mate"),
                              Text("hole"),
                              Text("shaft"),
                              Diameter("diameter_mm"),
                              Diameter("width_mm"),
                              Text("fit"),
                              Diameters("hole_diameter_mm"),
                              Diameters("shaft_diameter_mm"),
                              Diameters("hole_width_mm"),
                              Diameters("shaft_width_mm"),
                              Number("hole_rz_um", 0, kLargestRoughness_um),
                              Number("shaft_rz_um", 0, kLargestRoughness_um),
                              Number("friction", 0, kLargestFriction),
                              Number("hole_temperature_c", kColdest_c, kHottest_c),
                              Number("shaft_temperature_c", kColdest_c, kHottest_c),
                              Note()};

constexpr std::array kMateKeys{Choice("kind", kMateKinds, false), Of(Type::kObject, "a", true),
                               Of(Type::kObject, "b", true), Text("fit"), Note()};

constexpr std::array kSideKeys{Text("occurrence", true), Index("face"), Index("feature")};

constexpr std::array kRemovedKeys{Text("mate", true), Note()};

constexpr std::array kRelationKeys{Choice("kind", kRelationNames, true),
                                   Of(Type::kObject, "a", true),
                                   Of(Type::kObject, "b", true),
                                   Number("angle_deg", 0, kLargestAngle_deg),
                                   Number("distance_mm", -kLargestDistance_mm, kLargestDistance_mm),
                                   Note()};

constexpr std::array kContactKeys{Text("a", true),
                                  Text("b", true),
                                  Number("compliance_um_per_n", 0, kLargestCompliance_um, true),
                                  Choice("compliance", kComplianceRules, false),
                                  Number("friction", 0, kLargestFriction),
                                  Note()};

constexpr std::array kApartKeys{Text("unit", true), Note()};

constexpr std::array kFlexibleKeys{Text("part", true),
                                   Needed(Number("allowance_mm", 0, kLargestGive_mm)), Note()};

constexpr std::array<std::string_view, 8> kElasticNames{"coil_spring", "disc_spring", "lock_washer",
                                                        "leaf_spring", "gasket",      "slit_pin",
                                                        "sleeve",      "lip_seal"};
static_assert(kElasticNames.size() == static_cast<std::size_t>(product::ElasticKind::kLipSeal) + 1,
              "a kind of elastic part has no name here");

constexpr std::array kElasticKeys{
    Text("part", true),
    Choice("kind", kElasticNames, false),
    Diameter("free_length_mm"),
    Diameter("free_diameter_mm"),
    Diameter("thickness_mm"),
    Diameter("lip_length_mm"),
    Diameter("outer_diameter_mm"),
    Diameter("inner_diameter_mm"),
    Number("active_coils", 0, kMostCoils, true),
    Number("modulus_mpa", 0, kStiffestMaterial / kPascalsPerMegapascal, true),
    Number("stiffness_n_per_mm", 0, kStiffestSpring* units::kMetresPerMillimetre, true),
    Note()};

constexpr const char* kAllowanceKey = "allowance_mm";

/** Those of "elastic", and how far the part may give. */
constexpr auto kCompliantKeys = [] {
  std::array<SideFileKey, kElasticKeys.size() + 1> keys{};
  std::copy(kElasticKeys.begin(), kElasticKeys.end(), keys.begin());
  keys.back() = Number(kAllowanceKey, 0, kLargestGive_mm);
  return keys;
}();

/** One object of the file with its place in it. */
struct Place {
  const LocatedJson* document;
  std::string file;
  std::string pointer;
  std::string entry;  // "fit 3"; empty for the document.

  [[nodiscard]] std::string Where(std::string_view key = {}) const {
    return fmt::format("{}:{}{}{}", file,
                       document->LineOf(key.empty() ? pointer : pointer + "/" + std::string(key)),
                       entry.empty() ? "" : ", ", entry);
  }
};

std::string DescribeType(const SideFileKey& key) {
  switch (key.type) {
    case Type::kText:
      return key.choices.empty() ? "a text that is not empty"
                                 : fmt::format("one of \"{}\"", fmt::join(key.choices, "\", \""));
    case Type::kNumber:
      return fmt::format("a number {} {:g} and at most {:g}",
                         key.is_low_excluded ? "above" : "of at least", key.low, key.high);
    case Type::kIndex:
      return "the number of a face or feature, as hvas inspect lists it";
    case Type::kDiameters:
      return fmt::format(
          "a number above 0 and at most {:g}, or 1 to {} places [depth_mm, diameter_mm] such as "
          "[[0, 40.004], [50, 40.007]], by ascending depth",
          key.high, kMostPlaces);
    case Type::kObject:
      return R"(an object such as {"occurrence": "housing", "face": 3})";
    case Type::kList:
      break;
  }
  return "a list [...]";
}

/** True for places [depth_mm, diameter_mm] by ascending depth. */
bool IsListOfPlaces(const SideFileKey& key, const ordered_json& value) {
  double last = -1;
  const auto is_place = [&](const ordered_json& place) {
    if (!place.is_array() || place.size() != 2 || !place[0].is_number() || !place[1].is_number()) {
      return false;
    }
    const auto depth = place[0].get<double>();
    const auto diameter = place[1].get<double>();
    const bool ascends = depth >= 0 && depth > last && depth <= key.high;
    last = depth;
    return ascends && diameter > 0 && diameter <= key.high;
  };
  return value.is_array() && !value.empty() && value.size() <= kMostPlaces &&
         std::all_of(value.begin(), value.end(), is_place);
}

bool IsOfType(const SideFileKey& key, const ordered_json& value) {
  const auto is_in_range = [&key](double x) {
    return std::isfinite(x) && x <= key.high && (key.is_low_excluded ? x > key.low : x >= key.low);
  };
  switch (key.type) {
    case Type::kText:
      return value.is_string() &&
             (key.may_be_empty || !value.get_ref<const std::string&>().empty()) &&
             (key.choices.empty() || std::find(key.choices.begin(), key.choices.end(),
                                               value.get<std::string>()) != key.choices.end());
    case Type::kNumber:
      return value.is_number() && is_in_range(value.get<double>());
    case Type::kIndex:
      return value.is_number_integer() && is_in_range(value.get<double>());
    case Type::kDiameters:
      return value.is_number() ? is_in_range(value.get<double>()) : IsListOfPlaces(key, value);
    case Type::kObject:
      return value.is_object();
    case Type::kList:
      break;
  }
  return value.is_array();
}

/** Keys known, of their types, in their ranges, and those there that have to be. */
Result<void> CheckObject(const ordered_json& object, SideFileObject kind, const Place& place) {
  const std::span<const SideFileKey> keys = KeysOf(kind);
  std::vector<std::string> names;
  std::transform(keys.begin(), keys.end(), std::back_inserter(names),
                 [](const SideFileKey& key) { return std::string(key.name); });
  const std::string all = fmt::format("the keys here are {}", fmt::join(names, ", "));
  if (!object.is_object()) {
    return Fail(ErrorCode::kInvalid, "an object {...} is expected", place.Where(), all);
  }
  for (const auto& item : object.items()) {
    const std::string& name = item.key();
    const ordered_json& value = item.value();
    const auto key = std::find_if(keys.begin(), keys.end(),
                                  [&name](const SideFileKey& known) { return known.name == name; });
    if (key == keys.end()) {
      const std::string nearest = FindNearest(name, names);
      return Fail(ErrorCode::kInvalid, fmt::format("the key \"{}\" is not known", name),
                  place.Where(name),
                  nearest.empty() ? all : fmt::format("write \"{}\"; {}", nearest, all));
    }
    if (!IsOfType(*key, value)) {
      return Fail(
          ErrorCode::kInvalid,
          fmt::format(
              "\"{}\" is {}", name,
              value.dump(-1, ' ', false, ordered_json::error_handler_t::replace).substr(0, 40)),
          place.Where(name), "write " + DescribeType(*key));
    }
  }
  for (const SideFileKey& key : keys) {
    if (key.is_required && !object.contains(key.name)) {
      return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" is missing", key.name), place.Where(),
                  fmt::format("add \"{}\": {}", key.name, DescribeType(key)));
    }
  }
  return {};
}

std::string TextAt(const ordered_json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() ? std::string() : found->get<std::string>();
}

std::optional<double> NumberAt(const ordered_json& object, const char* key, double unit) {
  const auto found = object.find(key);
  return found == object.end() ? std::nullopt : std::optional(found->get<double>() * unit);
}

/** The diameters of a key: one for the whole length, or by place. */
std::vector<product::MeasuredDiameter> DiametersAt(const ordered_json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) {
    return {};
  }
  if (found->is_number()) {
    return {{0, found->get<double>() * units::kMetresPerMillimetre}};
  }
  std::vector<product::MeasuredDiameter> diameters;
  for (const ordered_json& place : *found) {
    diameters.push_back({place[0].get<double>() * units::kMetresPerMillimetre,
                         place[1].get<double>() * units::kMetresPerMillimetre});
  }
  return diameters;
}

std::optional<std::uint32_t> IndexAt(const ordered_json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() ? std::nullopt : std::optional(found->get<std::uint32_t>());
}

Result<FitEntry> ReadFit(const ordered_json& item, const Place& place) {
  if (const auto checked = CheckObject(item, SideFileObject::kFit, place); !checked) {
    return Unexpected(checked.error());
  }
  FitEntry entry;
  entry.where = place.Where();
  entry.mate = TextAt(item, "mate");
  entry.hole = TextAt(item, "hole");
  entry.shaft = TextAt(item, "shaft");
  entry.fit = TextAt(item, "fit");
  entry.diameter = NumberAt(item, "diameter_mm", units::kMetresPerMillimetre);
  entry.width = NumberAt(item, "width_mm", units::kMetresPerMillimetre);
  entry.has_diameters = item.contains("hole_diameter_mm") || item.contains("shaft_diameter_mm");
  entry.has_widths = item.contains("hole_width_mm") || item.contains("shaft_width_mm");
  if ((entry.has_diameters || entry.diameter) && (entry.has_widths || entry.width)) {
    return Fail(ErrorCode::kInvalid, "the entry has diameters and widths", entry.where,
                "write diameters for a hole and a shaft, or widths for a slot and a tongue");
  }
  product::FitConditions& conditions = entry.conditions;
  conditions.hole_diameters =
      DiametersAt(item, entry.has_widths ? "hole_width_mm" : "hole_diameter_mm");
  conditions.shaft_diameters =
      DiametersAt(item, entry.has_widths ? "shaft_width_mm" : "shaft_diameter_mm");
  conditions.hole_roughness = NumberAt(item, "hole_rz_um", units::kMetresPerMicrometre);
  conditions.shaft_roughness = NumberAt(item, "shaft_rz_um", units::kMetresPerMicrometre);
  conditions.friction = NumberAt(item, "friction", 1);
  conditions.hole_temperature_c = NumberAt(item, "hole_temperature_c", 1);
  conditions.shaft_temperature_c = NumberAt(item, "shaft_temperature_c", 1);
  const bool has_names = item.contains("hole") && item.contains("shaft");
  const bool has_a_name = item.contains("hole") || item.contains("shaft");
  const bool has_a_size = entry.diameter || entry.width;
  if (item.contains("mate") ? has_a_name || has_a_size : !has_names) {
    return Fail(ErrorCode::kInvalid, "the entry does not identify a mate", entry.where,
                R"(write "mate": "KEY" alone, or "hole": "..." and "shaft": "...")");
  }
  const bool says_something = std::any_of(item.begin(), item.end(), [&item](const auto& value) {
    constexpr std::array kWhich{"mate", "hole", "shaft", "diameter_mm", "width_mm", "note"};
    return std::none_of(kWhich.begin(), kWhich.end(), [&](const char* key) {
      return item.contains(key) && &item[key] == &value;
    });
  });
  if (!says_something) {
    return Fail(ErrorCode::kInvalid, "the entry has no data for its mate", entry.where,
                R"(add "fit": "H7/g6", or a measured size, or remove the entry)");
  }
  return entry;
}

Result<SideEntry> ReadSide(const ordered_json& item, const Place& place) {
  if (const auto checked = CheckObject(item, SideFileObject::kSide, place); !checked) {
    return Unexpected(checked.error());
  }
  SideEntry side{TextAt(item, "occurrence"), IndexAt(item, "face"), IndexAt(item, "feature")};
  if (side.face.has_value() == side.feature.has_value()) {
    return Fail(ErrorCode::kInvalid, "the side needs either a face or a feature", place.Where(),
                R"(write "face": 3 or "feature": 1, as hvas inspect lists them)");
  }
  return side;
}

/** Reads the sides "a" and "b" of an entry. */
Result<void> ReadSides(const ordered_json& item, const Place& place, SideEntry* a, SideEntry* b) {
  for (const auto& [key, side] : {std::pair("a", a), std::pair("b", b)}) {
    Place inner = place;
    inner.pointer += std::string("/") + key;
    Result<SideEntry> read = ReadSide(item[key], inner);
    if (!read) {
      return Unexpected(read.error());
    }
    *side = *std::move(read);
  }
  return {};
}

Result<AddedMate> ReadMate(const ordered_json& item, const Place& place) {
  if (const auto checked = CheckObject(item, SideFileObject::kMate, place); !checked) {
    return Unexpected(checked.error());
  }
  AddedMate mate;
  mate.where = place.Where();
  mate.fit = TextAt(item, "fit");
  if (const auto kind =
          std::find(kMateKinds.begin(), kMateKinds.end(), std::string_view(TextAt(item, "kind")));
      kind != kMateKinds.end()) {
    mate.kind = static_cast<product::MateKind>(kind - kMateKinds.begin());
  }
  if (const auto read = ReadSides(item, place, &mate.a, &mate.b); !read) {
    return Unexpected(read.error());
  }
  return mate;
}

Result<RemovedMate> ReadRemoved(const ordered_json& item, const Place& place) {
  if (const auto checked = CheckObject(item, SideFileObject::kRemoved, place); !checked) {
    return Unexpected(checked.error());
  }
  return RemovedMate{TextAt(item, "mate"), place.Where()};
}

Result<StatedRelation> ReadRelation(const ordered_json& item, const Place& place) {
  if (const auto checked = CheckObject(item, SideFileObject::kRelation, place); !checked) {
    return Unexpected(checked.error());
  }
  StatedRelation relation;
  relation.where = place.Where();
  const std::string name = TextAt(item, "kind");
  const auto kind = std::find(kRelationNames.begin(), kRelationNames.end(), name);
  relation.kind = kStatedKinds[static_cast<std::size_t>(kind - kRelationNames.begin())];
  relation.angle = NumberAt(item, "angle_deg", units::FromDeg(1));
  relation.distance = NumberAt(item, "distance_mm", units::kMetresPerMillimetre);
  const bool needs_angle = relation.kind == product::RelationKind::kAngle;
  const bool needs_distance = relation.kind == product::RelationKind::kDistance;
  if (relation.angle.has_value() != needs_angle ||
      relation.distance.has_value() != needs_distance) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("the relation \"{}\" {}", name,
                            needs_angle      ? "needs \"angle_deg\" alone"
                            : needs_distance ? "needs \"distance_mm\" alone"
                                             : "has neither an angle nor a distance"),
                relation.where, R"(write "angle_deg" for an angle, "distance_mm" for a distance)");
  }
  if (const auto read = ReadSides(item, place, &relation.a, &relation.b); !read) {
    return Unexpected(read.error());
  }
  return relation;
}

Result<StatedContact> ReadContact(const ordered_json& item, const Place& place) {
  if (const auto checked = CheckObject(item, SideFileObject::kContact, place); !checked) {
    return Unexpected(checked.error());
  }
  StatedContact contact;
  contact.where = place.Where();
  contact.a = TextAt(item, "a");
  contact.b = TextAt(item, "b");
  contact.compliance = NumberAt(item, "compliance_um_per_n", units::kMetresPerMicrometre);
  contact.is_by_moduli = item.contains("compliance");
  contact.friction = NumberAt(item, "friction", 1);
  if (contact.compliance.has_value() == contact.is_by_moduli &&
      (contact.is_by_moduli || !contact.friction)) {
    return Fail(ErrorCode::kInvalid,
                contact.is_by_moduli ? "the compliance is given twice"
                                     : "the entry has no data for its contact",
                contact.where,
                R"(write one of "compliance_um_per_n": 0.5 and "compliance": "by_moduli", )"
                R"(or "friction": 0.2)");
  }
  return contact;
}

Result<product::KeptApart> ReadApart(const ordered_json& item, const Place& place) {
  if (const auto checked = CheckObject(item, SideFileObject::kApart, place); !checked) {
    return Unexpected(checked.error());
  }
  return product::KeptApart{TextAt(item, "unit"), place.Where()};
}

Result<StatedFlexible> ReadFlexible(const ordered_json& item, const Place& place) {
  if (const auto checked = CheckObject(item, SideFileObject::kFlexible, place); !checked) {
    return Unexpected(checked.error());
  }
  return StatedFlexible{TextAt(item, "part"),
                        NumberAt(item, "allowance_mm", units::kMetresPerMillimetre).value_or(0),
                        place.Where()};
}

/** Reads the kind and the sizes of a part that pushes back. */
Result<StatedElastic> ReadSizes(const ordered_json& item, const Place& place) {
  StatedElastic stated;
  stated.part = TextAt(item, "part");
  if (const std::string kind = TextAt(item, "kind"); !kind.empty()) {
    stated.kind = static_cast<product::ElasticKind>(
        std::find(kElasticNames.begin(), kElasticNames.end(), kind) - kElasticNames.begin());
  }
  const auto length = NumberAt(item, "free_length_mm", units::kMetresPerMillimetre);
  const auto diameter = NumberAt(item, "free_diameter_mm", units::kMetresPerMillimetre);
  if (length && diameter) {
    return Fail(ErrorCode::kInvalid,
                "\"free_length_mm\" is for a part that is pressed along its axis, and "
                "\"free_diameter_mm\" for one that its hole presses: no part has both",
                place.Where("free_diameter_mm"), "remove one of the two");
  }
  stated.free_size = length ? length : diameter;
  stated.thickness = NumberAt(item, "thickness_mm", units::kMetresPerMillimetre);
  stated.outer = NumberAt(item, "outer_diameter_mm", units::kMetresPerMillimetre);
  stated.inner = NumberAt(item, "inner_diameter_mm", units::kMetresPerMillimetre);
  stated.lip_length = NumberAt(item, "lip_length_mm", units::kMetresPerMillimetre);
  stated.coils = NumberAt(item, "active_coils", 1);
  stated.modulus = NumberAt(item, "modulus_mpa", kPascalsPerMegapascal);
  stated.stiffness = NumberAt(item, "stiffness_n_per_mm", 1 / units::kMetresPerMillimetre);
  stated.where = place.Where();
  return stated;
}

Result<StatedElastic> ReadElastic(const ordered_json& item, const Place& place) {
  if (const auto checked = CheckObject(item, SideFileObject::kElastic, place); !checked) {
    return Unexpected(checked.error());
  }
  return ReadSizes(item, place);
}

/** An entry of "compliant": how far a part gives, what pushes back, or both. */
struct StatedCompliant {
  std::optional<StatedFlexible> flexible;
  std::optional<StatedElastic> elastic;
};

Result<StatedCompliant> ReadCompliant(const ordered_json& item, const Place& place) {
  if (const auto checked = CheckObject(item, SideFileObject::kCompliant, place); !checked) {
    return Unexpected(checked.error());
  }
  StatedCompliant stated;
  if (const auto allowance = NumberAt(item, kAllowanceKey, units::kMetresPerMillimetre)) {
    stated.flexible = StatedFlexible{TextAt(item, "part"), *allowance, place.Where()};
  }
  const bool has_sizes =
      std::any_of(kElasticKeys.begin(), kElasticKeys.end(), [&item](const SideFileKey& key) {
        return key.name != "part" && key.name != "note" && item.contains(key.name);
      });
  if (has_sizes || !stated.flexible) {
    auto elastic = ReadSizes(item, place);
    if (!elastic) {
      return Unexpected(elastic.error());
    }
    stated.elastic = std::move(*elastic);
  }
  return stated;
}

/** Reads the list under `key`, if it is there; `name` is what its entries are called. */
template <typename Entry, typename Read>
Result<void> ReadList(const Place& top, const char* key, const char* name, Read read,
                      std::vector<Entry>* entries) {
  const auto list = top.document->root.find(key);
  if (list == top.document->root.end()) {
    return {};
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    const Place place{top.document, top.file, fmt::format("/{}/{}", key, i),
                      fmt::format("{} {}", name, i + 1)};
    auto entry = read((*list)[i], place);
    if (!entry) {
      return Unexpected(entry.error());
    }
    entries->push_back(*std::move(entry));
  }
  return {};
}

/** "{"a": 1, "b": [1, 2]}" in one line, with spaces as people write them. */
std::string FormatInline(const ordered_json& value) {
  const auto dump = [](const auto& scalar) {
    return ordered_json(scalar).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  };
  if (!value.is_structured()) {
    return dump(value);
  }
  std::vector<std::string> items;
  for (const auto& [key, item] : value.items()) {
    items.push_back((value.is_object() ? dump(key) + ": " : "") + FormatInline(item));
  }
  return fmt::format("{}{}{}", value.is_object() ? '{' : '[', fmt::join(items, ", "),
                     value.is_object() ? '}' : ']');
}

}  // namespace

std::span<const SideFileKey> KeysOf(SideFileObject object) {
  switch (object) {
    case SideFileObject::kDocument:
      return kDocumentKeys;
    case SideFileObject::kFit:
      return kFitKeys;
    case SideFileObject::kMate:
      return kMateKeys;
    case SideFileObject::kSide:
      return kSideKeys;
    case SideFileObject::kRelation:
      return kRelationKeys;
    case SideFileObject::kContact:
      return kContactKeys;
    case SideFileObject::kApart:
      return kApartKeys;
    case SideFileObject::kCompliant:
      return kCompliantKeys;
    case SideFileObject::kFlexible:
      return kFlexibleKeys;
    case SideFileObject::kElastic:
      return kElasticKeys;
    case SideFileObject::kRemoved:
      break;
  }
  return kRemovedKeys;
}

std::filesystem::path FindAssignmentFile(const std::filesystem::path& product_file) {
  std::filesystem::path file = product_file;
  if (!file.has_filename()) {
    file = file.parent_path();  // A folder that ends in a slash.
  }
  return file.replace_extension(".hvas.json");
}

Result<std::string> ReadSideText(const std::filesystem::path& file) {
  return ReadRegularFile(file, kLargestFile);
}

Result<SideFile> ReadSideFile(const std::filesystem::path& file) {
  const Result<std::string> text = ReadSideText(file);
  return text ? ParseSideFile(*text, file) : Unexpected(text.error());
}

Result<SideFile> ParseSideFile(std::string_view text, const std::filesystem::path& file) {
  const Result<LocatedJson> document = ParseLocatedJson(text, file.string());
  if (!document) {
    return Unexpected(document.error());
  }
  const Place top{&*document, file.string(), "", ""};
  const ordered_json& root = document->root;
  if (!root.is_object() || !root.contains("format")) {
    return Fail(ErrorCode::kUnsupported, "the file holds no assignments", top.Where(),
                fmt::format(R"(begin with {{"format": "{}", "fits": [...]}})", kSideFileFormat));
  }
  SideFile result;
  result.path = file;
  Result<void> read = CheckObject(root, SideFileObject::kDocument, top);
  if (read) {
    read = ReadList(top, "fits", "fit", ReadFit, &result.fits);
  }
  if (read) {
    read = ReadList(top, "mates", "mate", ReadMate, &result.added);
  }
  if (read) {
    read = ReadList(top, "removed", "removed", ReadRemoved, &result.removed);
  }
  if (read) {
    read = ReadList(top, "relations", "relation", ReadRelation, &result.relations);
  }
  if (read) {
    read = ReadList(top, "contacts", "contact", ReadContact, &result.contacts);
  }
  if (read) {
    read = ReadList(top, "apart", "apart", ReadApart, &result.apart);
  }
  if (read) {
    read = ReadList(top, "flexible", "flexible", ReadFlexible, &result.flexible);
  }
  if (read) {
    read = ReadList(top, "elastic", "elastic", ReadElastic, &result.elastic);
  }
  std::vector<StatedCompliant> compliant;
  if (read) {
    read = ReadList(top, "compliant", "compliant", ReadCompliant, &compliant);
  }
  for (StatedCompliant& stated : compliant) {
    if (stated.flexible) {
      result.flexible.push_back(std::move(*stated.flexible));
    }
    if (stated.elastic) {
      result.elastic.push_back(std::move(*stated.elastic));
    }
  }
  if (!read) {
    return Unexpected(read.error());
  }
  return result;
}

std::string FormatSideFile(const ordered_json& document) {
  std::string text = "{";
  const char* separator = "\n";
  for (const auto& [key, value] : document.items()) {
    text += fmt::format("{}  {}: ", separator, FormatInline(key));
    separator = ",\n";
    if (!value.is_array() || value.empty()) {
      text += FormatInline(value);
      continue;
    }
    const char* begin = "[\n    ";
    for (const ordered_json& entry : value) {
      text += begin + FormatInline(entry);
      begin = ",\n    ";
    }
    text += "\n  ]";
  }
  return text + "\n}\n";
}

std::string FindNearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::size_t least = 1 + word.size() / 3;  // Edits that a slip may have made.
  std::string nearest;
  for (const std::string& candidate : candidates) {
    if (std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size()) > least) {
      continue;  // So many edits at least.
    }
    // Levenshtein's distance, a row at a time.
    std::vector<std::size_t> row(candidate.size() + 1);
    std::iota(row.begin(), row.end(), 0U);
    for (std::size_t i = 0; i < word.size(); ++i) {
      std::size_t diagonal = std::exchange(row[0], i + 1);
      for (std::size_t j = 0; j < candidate.size(); ++j) {
        const std::size_t changed = diagonal + (word[i] == candidate[j] ? 0U : 1U);
        diagonal = std::exchange(row[j + 1], std::min({changed, row[j] + 1, row[j + 1] + 1}));
      }
    }
    if (row.back() < least || (row.back() == least && nearest.empty())) {
      least = row.back();
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace hvas::mates
