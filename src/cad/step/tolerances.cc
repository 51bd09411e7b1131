#include "cad/step/tolerances.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "cad/step/step_measure.h"
#include "cad/step/step_text.h"

namespace hvas::cad {
namespace {

using product::Dimension;
using product::DimensionKind;
using product::GeometricTolerance;
using product::GeometricToleranceKind;
using product::Part;
using product::Product;
using EntityId = std::uint64_t;
using Kind = StepValue::Kind;

constexpr double kSameSize = 0.01;           // Of a diameter and its cylinder's, relative.
constexpr int kMaxDatumSteps = 1000;         // Of one tolerance; circles of references end with it.
constexpr int kMaxDatumDepth = 8;            // Of datum systems; files have three levels.
constexpr std::size_t kMaxNamed = 5;         // Damaged entities that a diagnostic names.
constexpr std::size_t kMaxAspects = 100000;  // That one dimension may be about.

struct KindName {
  std::string_view name;
  GeometricToleranceKind kind;
};

constexpr std::array kToleranceKinds{
    KindName{"ANGULARITY_TOLERANCE", GeometricToleranceKind::kAngularity},
    KindName{"CIRCULAR_RUNOUT_TOLERANCE", GeometricToleranceKind::kCircularRunout},
    KindName{"COAXIALITY_TOLERANCE", GeometricToleranceKind::kCoaxiality},
    KindName{"CONCENTRICITY_TOLERANCE", GeometricToleranceKind::kConcentricity},
    KindName{"CYLINDRICITY_TOLERANCE", GeometricToleranceKind::kCylindricity},
    KindName{"FLATNESS_TOLERANCE", GeometricToleranceKind::kFlatness},
    KindName{"LINE_PROFILE_TOLERANCE", GeometricToleranceKind::kLineProfile},
    KindName{"PARALLELISM_TOLERANCE", GeometricToleranceKind::kParallelism},
    KindName{"PERPENDICULARITY_TOLERANCE", GeometricToleranceKind::kPerpendicularity},
    KindName{"POSITION_TOLERANCE", GeometricToleranceKind::kPosition},
    KindName{"ROUNDNESS_TOLERANCE", GeometricToleranceKind::kRoundness},
    KindName{"STRAIGHTNESS_TOLERANCE", GeometricToleranceKind::kStraightness},
    KindName{"SURFACE_PROFILE_TOLERANCE", GeometricToleranceKind::kSurfaceProfile},
    KindName{"SYMMETRY_TOLERANCE", GeometricToleranceKind::kSymmetry},
    KindName{"TOTAL_RUNOUT_TOLERANCE", GeometricToleranceKind::kTotalRunout},
    KindName{"GEOMETRIC_TOLERANCE", GeometricToleranceKind::kOther},
};

constexpr std::array<std::string_view, 3> kSizes{"DIMENSIONAL_SIZE", "ANGULAR_SIZE",
                                                 "DIMENSIONAL_SIZE_WITH_PATH"};
constexpr std::array<std::string_view, 4> kLocations{"DIMENSIONAL_LOCATION", "ANGULAR_LOCATION",
                                                     "DIRECTED_DIMENSIONAL_LOCATION",
                                                     "DIMENSIONAL_LOCATION_WITH_PATH"};

template <typename Names>
bool IsOneOf(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

EntityId RefAt(const StepRecord& record, std::size_t i) {
  return i < record.values.size() ? record.values[i].reference : 0;
}

std::string TextAt(const StepRecord& record, std::size_t i) {
  return i < record.values.size() && record.values[i].kind == Kind::kText ? record.values[i].text
                                                                          : std::string();
}

void CollectRefs(const StepValue& value, std::vector<EntityId>* refs) {
  if (value.kind == Kind::kReference) {
    refs->push_back(value.reference);
  }
  for (const StepValue& item : value.items) {
    CollectRefs(item, refs);
  }
}

/** A dimension or a tolerance before it is given to a part. */
template <typename T>
struct Found {
  T item;
  std::vector<EntityId> aspects;
};

/** Reads everything in one pass over the entities, then follows references. */
class ToleranceReader {
 public:
  ToleranceReader(const StepText& text, Product* product, Diagnostics* diagnostics)
      : text_(text), product_(product), diagnostics_(diagnostics) {}

  void Read();

 private:
  void Index();
  void IndexEntity(EntityId id, const StepEntity& entity);
  void IndexRecord(const StepRecord& record);
  void ReadDimension(EntityId id, const StepEntity& entity);
  [[nodiscard]] std::vector<EntityId> ListItems(EntityId representation) const;
  bool ReadSizes(EntityId representation, Dimension* dimension);
  void ReadLimits(EntityId range, Dimension* dimension);
  void ReadGeometric(EntityId id, const StepEntity& entity);
  void ReadDatums(const StepValue& value, int depth, int* steps, std::vector<std::string>* datums);
  [[nodiscard]] std::vector<EntityId> ToAspects(EntityId id) const;
  [[nodiscard]] std::vector<EntityId> CollectFaces(const std::vector<EntityId>& aspects);
  [[nodiscard]] EntityId ShapeOf(const std::vector<EntityId>& aspects) const;
  void IndexFaces();
  [[nodiscard]] std::size_t ChooseOwner(const std::set<std::size_t>& parts) const;
  template <typename T>
  void Distribute(std::vector<Found<T>>* found, std::vector<T> Part::*member);
  void CheckSizes(Part* part);
  /** Converts a dimension whose value is that of a face in another unit, and reports one that is
   another value. @param sizes  Of its faces [m]. */
  void CheckSize(const std::string& part, const std::vector<double>& sizes, Dimension* dimension);
  void Report();

  const StepText& text_;
  Product* product_;
  Diagnostics* diagnostics_;
  bool has_more_aspects_{false};  // Than kMaxAspects.
  bool has_more_datums_{false};   // Than kMaxDatumSteps, or deeper than kMaxDatumDepth.
  std::vector<EntityId> dimension_ids_;
  std::vector<EntityId> tolerance_ids_;
  std::map<EntityId, std::vector<EntityId>> items_of_;           // Aspect to faces.
  std::map<EntityId, std::vector<EntityId>> children_of_;        // Aspect to aspects.
  std::map<EntityId, std::vector<EntityId>> representation_of_;  // Dimension to its values.
  std::map<EntityId, std::vector<EntityId>> range_of_;           // Dimension to its limits.
  std::vector<Found<Dimension>> dimensions_;
  std::vector<Found<GeometricTolerance>> tolerances_;
  std::map<EntityId, std::vector<std::pair<std::size_t, product::FaceId>>> faces_;  // By entity.
  std::map<EntityId, std::set<std::size_t>> parts_of_;  // By the shape that aspects belong to.
  std::vector<EntityId> damaged_;
  std::size_t homeless_{0};
};

/** The name at the start of an entity; empty for complex ones. */
std::string_view FirstName(std::string_view body) {
  const std::size_t begin = body.find_first_not_of(" \t\r\n");
  return begin == std::string_view::npos
             ? std::string_view()
             : body.substr(begin, body.find_first_of("( \r\n", begin) - begin);
}

void ToleranceReader::Index() {
  static constexpr std::array<std::string_view, 6> kParts{
      "TOLERANCE", "DIMENSIONAL_", "ANGULAR_", "SHAPE_ASPECT_", "_USAGE", "_RELATIONSHIP"};
  for (const StepText::Statement& statement : text_.statements()) {
    std::string_view where = FirstName(statement.body);
    if (where.empty()) {
      where = statement.body;
      if (where.size() > 20000) {
        continue;  // A surface with very many points.
      }
    }
    if (std::any_of(kParts.begin(), kParts.end(), [where](std::string_view part) {
          return where.find(part) != std::string_view::npos;
        })) {
      IndexEntity(statement.id, ParseStepEntity(statement.body));
    }
  }
}

void ToleranceReader::IndexEntity(EntityId id, const StepEntity& entity) {
  for (const StepRecord& record : entity) {
    if (IsOneOf(kSizes, record.name) || IsOneOf(kLocations, record.name)) {
      dimension_ids_.push_back(id);
      return;
    }
    if (std::any_of(kToleranceKinds.begin(), kToleranceKinds.end(),
                    [&record](const KindName& kind) { return kind.name == record.name; })) {
      tolerance_ids_.push_back(id);
      return;
    }
  }
  for (const StepRecord& record : entity) {
    IndexRecord(record);
  }
}

void ToleranceReader::IndexRecord(const StepRecord& record) {
  if (record.name == "PLUS_MINUS_TOLERANCE") {
    range_of_[RefAt(record, 1)].push_back(RefAt(record, 0));
  } else if (record.name == "DIMENSIONAL_CHARACTERISTIC_REPRESENTATION") {
    representation_of_[RefAt(record, 0)].push_back(RefAt(record, 1));
  } else if (record.name == "GEOMETRIC_ITEM_SPECIFIC_USAGE" ||
             record.name == "ITEM_IDENTIFIED_REPRESENTATION_USAGE") {
    if (record.values.size() > 4) {
      CollectRefs(record.values[4], &items_of_[RefAt(record, 2)]);
    }
  } else if (record.name == "SHAPE_ASPECT_RELATIONSHIP" ||
             record.name == "SHAPE_ASPECT_DERIVING_RELATIONSHIP") {
    children_of_[RefAt(record, 2)].push_back(RefAt(record, 3));
  }
}

DimensionKind ToKind(std::string_view record, std::string_view name) {
  if (record.find("ANGULAR") != std::string_view::npos) {
    return DimensionKind::kAngular;
  }
  if (name.find("diameter") != std::string_view::npos) {
    return DimensionKind::kDiameter;
  }
  if (name.find("radius") != std::string_view::npos) {
    return DimensionKind::kRadius;
  }
  const bool is_location = IsOneOf(kLocations, record);
  return is_location || name.find("linear") != std::string_view::npos ||
                 name.find("thickness") != std::string_view::npos ||
                 name.find("length") != std::string_view::npos
             ? DimensionKind::kLinear
             : DimensionKind::kOther;
}

std::string ToLower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

void ToleranceReader::ReadDimension(EntityId id, const StepEntity& entity) {
  Found<Dimension> found;
  Dimension& dimension = found.item;
  dimension.entity = fmt::format("#{}", id);
  std::string_view kind_name;
  for (const StepRecord& record : entity) {
    if (IsOneOf(kSizes, record.name)) {
      kind_name = record.name;
      dimension.name = dimension.name.empty() ? TextAt(record, 1) : dimension.name;
    } else if (IsOneOf(kLocations, record.name)) {
      // Of a complex one the subtypes name the kind, the supertype has the values.
      kind_name = kind_name.empty() || record.name == "ANGULAR_LOCATION" ? record.name : kind_name;
      dimension.name = dimension.name.empty() ? TextAt(record, 0) : dimension.name;
    } else if (record.name == "SHAPE_ASPECT_RELATIONSHIP") {
      dimension.name = TextAt(record, 0);
    }
  }
  dimension.kind = ToKind(kind_name, ToLower(dimension.name));
  found.aspects = ToAspects(id);
  bool has_size = false;
  for (const EntityId representation : representation_of_[id]) {
    has_size |= ReadSizes(representation, &dimension);
  }
  for (const EntityId range : range_of_[id]) {
    ReadLimits(range, &dimension);
  }
  if (!has_size && (dimension.upper || dimension.lower || dimension.fit)) {
    damaged_.push_back(id);  // Limits of nothing.
  }
  if (has_size) {
    dimensions_.push_back(std::move(found));
  }
}

/** Reads a fit in a note; in a note "M8" is a thread. */
void ReadFitNote(const StepRecord& note, Dimension* dimension) {
  const auto code = NormaliseFitCode(TextAt(note, 1));
  const bool is_thread = code && code->front() == 'M' && code->find('/') == std::string::npos;
  if (code && !is_thread) {
    dimension->fit = code;
  }
}

std::vector<EntityId> ToleranceReader::ListItems(EntityId representation) const {
  std::vector<EntityId> items;
  const StepEntity entity = text_.Find(representation);
  for (const StepRecord& record : entity) {
    const bool is_whole = record.name == "REPRESENTATION" || entity.size() == 1;
    if (is_whole && record.values.size() > 2) {
      CollectRefs(record.values[1], &items);
    }
  }
  return items;
}

bool ToleranceReader::ReadSizes(EntityId representation, Dimension* dimension) {
  std::optional<double> nominal;
  std::optional<double> upper;
  std::optional<double> lower;
  for (const EntityId item : ListItems(representation)) {
    const StepEntity value = text_.Find(item);
    if (const StepRecord* note = FindRecord(value, "DESCRIPTIVE_REPRESENTATION_ITEM")) {
      ReadFitNote(*note, dimension);
      continue;
    }
    const auto measure = ReadMeasure(text_, item, representation);
    if (!measure) {
      continue;
    }
    const std::string name = ToLower(measure->name);
    if (name.find("upper") != std::string::npos) {
      upper = measure->value;
    } else if (name.find("lower") != std::string::npos) {
      lower = measure->value;
    } else if (!nominal || name.find("nominal") != std::string::npos) {
      nominal = measure->value;
      if (measure->quantity == Quantity::kAngle) {
        dimension->kind = DimensionKind::kAngular;
      }
    }
  }
  if (!nominal && upper && lower) {
    nominal = 0.5 * (*upper + *lower);
  }
  if (!nominal) {
    return false;
  }
  dimension->nominal = *nominal;
  if (upper) {
    dimension->upper = *upper - *nominal;
  }
  if (lower) {
    dimension->lower = *lower - *nominal;
  }
  return true;
}

void ToleranceReader::ReadLimits(EntityId range, Dimension* dimension) {
  const StepEntity entity = text_.Find(range);
  if (const StepRecord* values = FindRecord(entity, "TOLERANCE_VALUE")) {
    const auto lower = ReadMeasure(text_, RefAt(*values, 0), 0);
    const auto upper = ReadMeasure(text_, RefAt(*values, 1), 0);
    if (lower) {
      dimension->lower = lower->value;
    }
    if (upper) {
      dimension->upper = upper->value;
    }
  } else if (const StepRecord* fit = FindRecord(entity, "LIMITS_AND_FITS")) {
    // (form variance, zone variance, grade, source); systems write "G", "hole", "6" or all of it
    // into the first.
    for (const std::string& text : {TextAt(*fit, 0), TextAt(*fit, 0) + TextAt(*fit, 2),
                                    TextAt(*fit, 1) + TextAt(*fit, 2), TextAt(*fit, 2)}) {
      if (const auto code = NormaliseFitCode(text)) {
        dimension->fit = code;
        return;
      }
    }
    damaged_.push_back(range);
  }
}

void ToleranceReader::ReadDatums(const StepValue& value, int depth, int* steps,
                                 std::vector<std::string>* datums) {
  if (depth > kMaxDatumDepth || ++*steps > kMaxDatumSteps) {
    has_more_datums_ = true;
    return;
  }
  if (value.kind == Kind::kTyped || value.kind == Kind::kList) {
    std::vector<std::string> parts;
    for (const StepValue& item : value.items) {
      ReadDatums(item, depth + 1, steps, &parts);
    }
    if (value.kind == Kind::kTyped && !parts.empty()) {  // COMMON_DATUM_LIST
      parts = {fmt::format("{}", fmt::join(parts, "-"))};
    }
    datums->insert(datums->end(), parts.begin(), parts.end());
    return;
  }
  for (const StepRecord& record : text_.Find(value.reference)) {
    if (record.name == "DATUM") {
      datums->push_back(TextAt(record, record.values.empty() ? 0 : record.values.size() - 1));
    } else if (record.name == "DATUM_REFERENCE" && record.values.size() > 1) {
      ReadDatums(record.values[1], depth + 1, steps, datums);
    } else if (record.name.find("DATUM_") == 0 && record.values.size() > 4) {
      ReadDatums(record.values[4], depth + 1, steps, datums);  // System, compartment, or element.
    }
  }
}

void ToleranceReader::ReadGeometric(EntityId id, const StepEntity& entity) {
  Found<GeometricTolerance> found;
  found.item.entity = fmt::format("#{}", id);
  EntityId magnitude = 0;
  int datum_steps = 0;
  for (const StepRecord& record : entity) {
    const auto kind =
        std::find_if(kToleranceKinds.begin(), kToleranceKinds.end(),
                     [&record](const KindName& entry) { return entry.name == record.name; });
    if (kind != kToleranceKinds.end() && kind->kind != GeometricToleranceKind::kOther) {
      found.item.kind = kind->kind;
    }
    if (kind != kToleranceKinds.end() && record.values.size() >= 4) {
      found.item.name = TextAt(record, 0);
      magnitude = RefAt(record, 2);
      found.aspects = ToAspects(RefAt(record, 3));
      if (record.values.size() > 4) {
        ReadDatums(record.values[4], 0, &datum_steps, &found.item.datums);
      }
    } else if (record.name == "GEOMETRIC_TOLERANCE_WITH_DATUM_REFERENCE" &&
               !record.values.empty()) {
      ReadDatums(record.values[0], 0, &datum_steps, &found.item.datums);
    }
  }
  const auto measure = ReadMeasure(text_, magnitude, 0);
  if (!measure) {
    damaged_.push_back(id);
    return;
  }
  found.item.magnitude = measure->value;
  tolerances_.push_back(std::move(found));
}

/** The aspects of the shape that a dimension is about; an aspect is about itself. */
std::vector<EntityId> ToleranceReader::ToAspects(EntityId id) const {
  std::vector<EntityId> aspects;
  for (const StepRecord& record : text_.Find(id)) {
    if (IsOneOf(kSizes, record.name) && !record.values.empty()) {
      aspects.push_back(RefAt(record, 0));
    } else if ((IsOneOf(kLocations, record.name) || record.name == "SHAPE_ASPECT_RELATIONSHIP") &&
               record.values.size() > 3) {
      aspects.push_back(RefAt(record, 2));
      aspects.push_back(RefAt(record, 3));
    }
  }
  return aspects.empty() ? std::vector<EntityId>{id} : aspects;
}

std::vector<EntityId> ToleranceReader::CollectFaces(const std::vector<EntityId>& aspects) {
  std::vector<EntityId> open = aspects;
  std::set<EntityId> seen(aspects.begin(), aspects.end());
  std::vector<EntityId> faces;
  std::set<EntityId> seen_faces;
  for (std::size_t i = 0; i < open.size() && open.size() < kMaxAspects; ++i) {
    if (const auto items = items_of_.find(open[i]); items != items_of_.end()) {
      std::copy_if(items->second.begin(), items->second.end(), std::back_inserter(faces),
                   [&seen_faces](EntityId id) { return seen_faces.insert(id).second; });
    }
    if (const auto children = children_of_.find(open[i]); children != children_of_.end()) {
      std::copy_if(children->second.begin(), children->second.end(), std::back_inserter(open),
                   [&seen](EntityId id) { return seen.insert(id).second; });
    }
  }
  has_more_aspects_ = has_more_aspects_ || open.size() >= kMaxAspects;
  return faces;
}

/** The shape (of a product) that an aspect belongs to; 0 where that cannot be told. */
EntityId ToleranceReader::ShapeOf(const std::vector<EntityId>& aspects) const {
  for (const EntityId aspect : aspects) {
    for (const StepRecord& record : text_.Find(aspect)) {
      if (record.name == "PRODUCT_DEFINITION_SHAPE") {
        return aspect;
      }
      if (record.values.size() >= 4 && RefAt(record, 2) != 0) {
        return RefAt(record, 2);  // (name, description, of shape, ...) of every kind of aspect.
      }
    }
  }
  return 0;
}

void ToleranceReader::IndexFaces() {
  for (std::size_t i = 0; i < product_->parts.size(); ++i) {
    const Part& part = product_->parts[i];
    for (std::size_t face = 0; face < part.faces.size(); ++face) {
      if (part.faces[face].entity != 0) {
        faces_[part.faces[face].entity].emplace_back(i, product::FaceId(face));
      }
    }
  }
  for (const auto& [aspect, items] : items_of_) {
    const EntityId shape = ShapeOf({aspect});
    for (const EntityId item : items) {
      const auto found = faces_.find(item);
      if (shape != 0 && found != faces_.end()) {
        for (const auto& [part, face] : found->second) {
          parts_of_[shape].insert(part);
        }
      }
    }
  }
}

/** Of parts of one shape (a solid with surfaces beside it) the first solid one. */
std::size_t ToleranceReader::ChooseOwner(const std::set<std::size_t>& parts) const {
  const auto solid = std::find_if(parts.begin(), parts.end(), [this](std::size_t i) {
    return product_->parts[i].solid_count > 0;
  });
  return solid != parts.end() ? *solid : *parts.begin();
}

template <typename T>
void ToleranceReader::Distribute(std::vector<Found<T>>* found, std::vector<T> Part::*member) {
  for (Found<T>& entry : *found) {
    std::map<std::size_t, std::vector<product::FaceId>> faces_by_part;
    for (const EntityId id : CollectFaces(entry.aspects)) {
      if (const auto faces = faces_.find(id); faces != faces_.end()) {
        for (const auto& [part, face] : faces->second) {
          faces_by_part[part].push_back(face);
        }
      }
    }
    if (faces_by_part.empty()) {
      const auto parts = parts_of_.find(ShapeOf(entry.aspects));
      if (parts != parts_of_.end()) {
        faces_by_part[ChooseOwner(parts->second)];
      } else if (product_->parts.size() == 1) {
        faces_by_part[0];
      }
    }
    homeless_ += faces_by_part.empty() ? 1 : 0;
    for (auto& [part, faces] : faces_by_part) {
      T item = entry.item;
      item.faces = std::move(faces);
      (product_->parts[part].*member).push_back(std::move(item));
    }
  }
}

void ToleranceReader::CheckSize(const std::string& part, const std::vector<double>& sizes,
                                Dimension* dimension) {
  const auto explains = [&](double factor) {
    return std::any_of(sizes.begin(), sizes.end(), [&](double size) {
      return std::abs(factor * dimension->nominal - size) <= kSameSize * size;
    });
  };
  if (sizes.empty() || explains(1)) {
    return;
  }
  const std::string where = fmt::format("{} {}", part, dimension->entity);
  const std::string problem =
      fmt::format("the {} is {:.6g} mm but its face has {:.6g} mm", dimension->name,
                  units::ToMm(dimension->nominal), units::ToMm(sizes.front()));
  constexpr std::array kFactors{25.4, 1000.0, 1 / 25.4, 1e-3};
  const auto* const factor = std::find_if(kFactors.begin(), kFactors.end(), explains);
  if (factor == kFactors.end()) {
    diagnostics_->Warn("dimension-differs", where, problem,
                       "check which face the dimension belongs to in the CAD system");
    return;
  }
  diagnostics_->Warn("dimension-unit", where,
                     fmt::format("{}; the value is multiplied by {:.6g}", problem, *factor),
                     "check the units of the dimensions in the CAD system");
  dimension->nominal *= *factor;
  if (dimension->upper) {
    *dimension->upper *= *factor;
  }
  if (dimension->lower) {
    *dimension->lower *= *factor;
  }
}

/** Catches dimensions in a unit other than that which the file names. */
void ToleranceReader::CheckSizes(Part* part) {
  for (Dimension& dimension : part->dimensions) {
    if (dimension.kind != DimensionKind::kDiameter && dimension.kind != DimensionKind::kRadius) {
      continue;
    }
    const double times = dimension.kind == DimensionKind::kDiameter ? 2 : 1;
    std::vector<double> sizes;
    for (const product::FaceId face : dimension.faces) {
      const spatial::Surface& surface = part->faces[face.index()].surface;
      if (surface.kind == spatial::SurfaceKind::kCylinder ||
          surface.kind == spatial::SurfaceKind::kSphere) {
        sizes.push_back(times * surface.radius);
      }
    }
    CheckSize(part->name, sizes, &dimension);
  }
}

void ToleranceReader::Report() {
  if (!damaged_.empty()) {
    std::string names;
    for (std::size_t i = 0; i < std::min(damaged_.size(), kMaxNamed); ++i) {
      names += fmt::format("{}#{}", i > 0 ? ", " : "", damaged_[i]);
    }
    diagnostics_->Warn(
        "tolerance-damaged", product_->source,
        fmt::format("{} dimensions or tolerances have no readable value ({}{}) and are omitted",
                    damaged_.size(), names, damaged_.size() > kMaxNamed ? ", ..." : ""),
        "check the dimensions in the CAD system and export the file again");
  }
  if (has_more_aspects_) {
    diagnostics_->Warn(
        "limit-aspects", product_->source,
        fmt::format("a dimension or tolerance is about {} or more aspects of the shape; it counts "
                    "for the faces of the first ones only",
                    kMaxAspects));
  }
  if (has_more_datums_) {
    diagnostics_->Warn("limit-datums", product_->source,
                       fmt::format("a tolerance has more than {} references to datums, or nests "
                                   "them deeper than {} levels; the rest is left out",
                                   kMaxDatumSteps, kMaxDatumDepth));
  }
  if (homeless_ > 0) {
    diagnostics_->Note(
        "tolerance-without-face", product_->source,
        fmt::format("{} dimensions or tolerances belong to no face of any part and are omitted",
                    homeless_));
  }
}

void ToleranceReader::Read() {
  Index();
  for (const EntityId id : dimension_ids_) {
    ReadDimension(id, text_.Find(id));
  }
  for (const EntityId id : tolerance_ids_) {
    ReadGeometric(id, text_.Find(id));
  }
  IndexFaces();
  Distribute(&dimensions_, &Part::dimensions);
  Distribute(&tolerances_, &Part::geometric_tolerances);
  for (Part& part : product_->parts) {
    CheckSizes(&part);
  }
  Report();
}

/** Takes "H7" from the front of a text. */
std::optional<std::string> TakeClass(std::string_view* text) {
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t letters = 0;
  while (letters < text->size() && is_letter((*text)[letters])) {
    ++letters;
  }
  std::size_t end = letters;
  while (end < text->size() && is_digit((*text)[end])) {
    ++end;
  }
  const bool is_one_case =
      letters < 2 || (std::isupper(static_cast<unsigned char>((*text)[0])) != 0) ==
                         (std::isupper(static_cast<unsigned char>((*text)[1])) != 0);
  if (letters < 1 || letters > 2 || end == letters || end > letters + 2 || !is_one_case) {
    return std::nullopt;
  }
  std::string code(text->substr(0, end));
  text->remove_prefix(end);
  return code;
}

}  // namespace

std::optional<std::string> NormaliseFitCode(std::string_view text) {
  std::string packed;  // Without blanks within a class: "G 6" is "G6".
  std::copy_if(text.begin(), text.end(), std::back_inserter(packed),
               [](unsigned char c) { return std::isspace(c) == 0; });
  std::string_view rest = packed;
  auto first = TakeClass(&rest);
  if (!first || rest.empty()) {
    return first;
  }
  if (rest.front() != '/' && rest.front() != '-') {
    return std::nullopt;  // "M10x1"
  }
  rest.remove_prefix(1);
  const auto second = TakeClass(&rest);
  const auto is_hole = [](const std::string& code) {
    return std::isupper(static_cast<unsigned char>(code.front())) != 0;
  };
  if (!second || !rest.empty() || is_hole(*first) == is_hole(*second)) {
    return std::nullopt;
  }
  return is_hole(*first) ? *first + "/" + *second : *second + "/" + *first;
}

bool MayHoldTolerances(std::string_view step_text) {
  static constexpr std::array<std::string_view, 3> kNames{"DIMENSIONAL_SIZE",
                                                          "DIMENSIONAL_LOCATION", "_TOLERANCE"};
  return std::any_of(kNames.begin(), kNames.end(), [step_text](std::string_view name) {
    return std::search(step_text.begin(), step_text.end(),
                       std::boyer_moore_horspool_searcher(name.begin(), name.end())) !=
           step_text.end();
  });
}

void ReadTolerances(const StepText& text, Product* product, Diagnostics* diagnostics) {
  ToleranceReader(text, product, diagnostics).Read();
}

}  // namespace hvas::cad
