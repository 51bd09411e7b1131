#include "product/product_io.h"

#include <algorithm>
#include <array>
#include <concepts>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "product/validate.h"

namespace hvas::product {
namespace {

template <typename T, typename Value>
concept Is = std::same_as<std::remove_const_t<T>, Value>;

// What a value's fields are is written once for both directions: T is const where an archive
// writes. All fields are named in the order of the declaration, so that a field that is added there
// does not compile here until it is written; then kProductFormat is to be raised.
#define HVAS_FIELDS(Value, ...)      \
  template <typename A, Is<Value> T> \
  void Visit(A& archive, T& value) { \
    auto& [__VA_ARGS__] = value;     \
    archive(__VA_ARGS__);            \
  }
HVAS_FIELDS(Color, r, g, b)
HVAS_FIELDS(Box, low, high)
HVAS_FIELDS(Surface, kind, origin, axis, radius, second, outward)
HVAS_FIELDS(Material, name, density, is_assumed, standard, is_standard_assumed, youngs_modulus,
            poisson_ratio, yield_strength, thermal_expansion)
HVAS_FIELDS(MassProperties, volume, mass, p_BoBcm_B, I_BBcm_B)
HVAS_FIELDS(Face, surface, is_recognised, area, box_B, first_triangle, triangle_count, color,
            entity, residual, first_display_triangle, display_triangle_count)
HVAS_FIELDS(Mesh, vertices, triangles)
HVAS_FIELDS(Feature, kind, faces, origin_B, axis_B, radius, half_angle, span_low, span_high,
            coverage, area, thread, thread_pitch)
HVAS_FIELDS(Form, kind, features, faces, origin_B, axis_B, diameter, depth, angle, count, lead_in)
HVAS_FIELDS(InnerConstraint, kind, a, b)
HVAS_FIELDS(Dimension, kind, name, nominal, upper, lower, fit, faces, entity)
HVAS_FIELDS(GeometricTolerance, kind, name, magnitude, datums, faces, entity)
HVAS_FIELDS(Identity, id, description, version, version_description, designer, organisation,
            created)
HVAS_FIELDS(FileHeader, format, name, description, time_stamp, authors, organisations, preprocessor,
            originating_system, authorisation, schema)
HVAS_FIELDS(RelationSide, occurrence, feature, second, element, origin_B, axis_B, radius, is_inward)
HVAS_FIELDS(Relation, kind, a, b, magnitude, is_stated, free_translations, free_rotations, residual)
HVAS_FIELDS(ContactPair, a, b, compliance, friction)
HVAS_FIELDS(Fit, kind, code, nominal_diameter, is_proposed, reason)
HVAS_FIELDS(MeasuredDiameter, depth, diameter)
HVAS_FIELDS(FitConditions, hole_diameters, shaft_diameters, hole_roughness, shaft_roughness,
            friction, hole_temperature_c, shaft_temperature_c)
HVAS_FIELDS(SurfaceConstraint, kind, a, b)
HVAS_FIELDS(Joint, a, b, mates, free_translations, free_rotations, pattern_count)
HVAS_FIELDS(Alignment, a, b)
HVAS_FIELDS(Diagnostic, severity, code, entity, message, remedy)
#undef HVAS_FIELDS

// What older formats have not stands behind the rest (VisitExtension, VisitBodies, VisitPrismatic),
// so that records of these can be read.
template <typename A, Is<Connector> T>
void Visit(A& archive, T& value) {
  auto& [occurrence, feature, X_BM, opposite] = value;
  archive(occurrence, feature, X_BM);
}

template <typename A, Is<Mate> T>
void Visit(A& archive, T& value) {
  auto& [id, key, kind, a, b, hole_low, hole_high, shaft_low, shaft_high, hole_radius, shaft_radius,
         overlap, breadth, fit, conditions, surfaces, origin, confidence, evidence] = value;
  archive(id, key, kind, a, b, hole_low, hole_high, shaft_low, shaft_high, hole_radius,
          shaft_radius, overlap, fit, conditions, surfaces, origin, confidence, evidence);
}

template <typename A, Is<Part> T>
void Visit(A& archive, T& value) {
  auto& [id, name, color, material, mass, solid_count, has_brep, box_B, mesh, faces, display_mesh,
         features, forms, inner_constraints, dimensions, geometric_tolerances, shape_hash,
         identity] = value;
  archive(id, name, color, material, mass, solid_count, has_brep, box_B, mesh, faces, display_mesh,
          features, forms, inner_constraints, dimensions, geometric_tolerances, shape_hash);
}

template <typename A, Is<Occurrence> T>
void Visit(A& archive, T& value) {
  auto& [id, part, parent, name, path, X_WB, bodies] = value;
  archive(id, part, parent, name, path, X_WB);
}

template <typename A, Is<Subassembly> T>
void Visit(A& archive, T& value) {
  auto& [id, parent, name, subassemblies, occurrences, identity] = value;
  archive(id, parent, name, subassemblies, occurrences);
}

template <typename A, Is<Product> T>
void Visit(A& archive, T& value) {
  auto& [name, source, parts, subassemblies, occurrences, mates, joints, alignments, box_W,
         removed_mates, placement, header, relations, contact_pairs, flexible, elastic,
         drawing_errors] = value;
  archive(name, source, parts, subassemblies, occurrences, mates, joints, alignments, box_W);
}

/** The fields that format 2 adds. */
template <typename A, Is<Product> T>
void VisitExtension(A& archive, T& product) {
  for (auto& part : product.parts) {
    archive(part.identity);
  }
  for (auto& subassembly : product.subassemblies) {
    archive(subassembly.identity);
  }
  archive(product.header, product.relations, product.contact_pairs);
}

/** The fields that format 3 adds. */
template <typename A, Is<Product> T>
void VisitBodies(A& archive, T& product) {
  for (auto& occurrence : product.occurrences) {
    archive(occurrence.bodies);
  }
}

/** The fields that format 4 adds. */
template <typename A, Is<Product> T>
void VisitPrismatic(A& archive, T& product) {
  for (auto& mate : product.mates) {
    archive(mate.a.opposite, mate.b.opposite, mate.breadth);
  }
}

// The last enumerator of each kind: larger numbers are no enumerators.
constexpr Severity LastOf(Severity /*kind*/) {
  return Severity::kError;
}

constexpr SurfaceKind LastOf(SurfaceKind /*kind*/) {
  return SurfaceKind::kFreeform;
}

constexpr FeatureKind LastOf(FeatureKind /*kind*/) {
  return FeatureKind::kBall;
}

constexpr ThreadKind LastOf(ThreadKind /*kind*/) {
  return ThreadKind::kModelled;
}

constexpr FormKind LastOf(FormKind /*kind*/) {
  return FormKind::kHolePattern;
}

constexpr InnerConstraintKind LastOf(InnerConstraintKind /*kind*/) {
  return InnerConstraintKind::kConcentric;
}

constexpr DimensionKind LastOf(DimensionKind /*kind*/) {
  return DimensionKind::kOther;
}

constexpr GeometricToleranceKind LastOf(GeometricToleranceKind /*kind*/) {
  return GeometricToleranceKind::kOther;
}

constexpr MateKind LastOf(MateKind /*kind*/) {
  return product::kMateKinds.back();
}

constexpr RelationKind LastOf(RelationKind /*kind*/) {
  return kRelationKinds.back();
}

constexpr ElementKind LastOf(ElementKind /*kind*/) {
  return ElementKind::kEdge;
}

constexpr FitKind LastOf(FitKind /*kind*/) {
  return FitKind::kPassage;
}

constexpr SurfaceConstraintKind LastOf(SurfaceConstraintKind /*kind*/) {
  return SurfaceConstraintKind::kConcentric;
}

constexpr MateOrigin LastOf(MateOrigin /*kind*/) {
  return MateOrigin::kUser;
}

// Copied as they lie in memory, as blocks.
template <typename T>
inline constexpr bool kIsPlain = std::is_same_v<T, Vec3> || std::is_same_v<T, Mat3> ||
                                 std::is_same_v<T, std::array<std::uint32_t, 3>> ||
                                 (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>);
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Mat3) == 9 * sizeof(double));

template <typename T>
inline constexpr bool kIsId = false;
template <typename Tag>
inline constexpr bool kIsId<Id<Tag>> = sizeof(Id<Tag>) == sizeof(std::uint32_t);

class Writer {
 public:
  explicit Writer(ByteWriter* bytes) : bytes_(*bytes) {}

  template <typename... T>
  void operator()(const T&... values) {
    (One(values), ...);
  }

 private:
  template <typename T>
  void One(const T& value) {
    if constexpr (kIsPlain<T> || kIsId<T>) {
      bytes_.Plain(reinterpret_cast<const std::byte*>(&value), sizeof(T));
    } else if constexpr (std::is_enum_v<T> || std::is_same_v<T, bool>) {
      const auto byte = static_cast<std::uint8_t>(value);
      bytes_.Plain(&byte, 1);
    } else {
      Visit(*this, value);
    }
  }

  void One(const std::string& text) { bytes_.Text(text); }

  void One(const Pose& X) {
    const double numbers[] = {X.q().w(), X.q().x(), X.q().y(), X.q().z(),
                              X.p().x(), X.p().y(), X.p().z()};
    bytes_.Plain(numbers, std::size(numbers));
  }

  template <typename T>
  void One(const std::optional<T>& value) {
    One(value.has_value());
    if (value) {
      One(*value);
    }
  }

  template <typename T>
  void One(const std::vector<T>& values) {
    bytes_.Size(values.size());
    if constexpr (kIsPlain<T> || kIsId<T>) {
      bytes_.Plain(reinterpret_cast<const std::byte*>(values.data()), values.size() * sizeof(T));
    } else {
      for (const T& value : values) {
        One(value);
      }
    }
  }

  ByteWriter& bytes_;
};

/** The bytes of the smallest value of a kind: its texts and lists empty. */
template <typename T>
std::size_t SmallestSize() {
  static const std::size_t size = [] {
    ByteWriter bytes;
    Writer writer(&bytes);
    writer(T());
    return bytes.bytes().size();
  }();
  return size;
}

class Reader {
 public:
  explicit Reader(ByteReader* bytes) : bytes_(*bytes) {}

  template <typename... T>
  void operator()(T&... values) {
    (One(values), ...);
  }

 private:
  template <typename T>
  void One(T& value) {
    if constexpr (kIsPlain<T> || kIsId<T>) {
      bytes_.Plain(reinterpret_cast<std::byte*>(&value), sizeof(T));
    } else if constexpr (std::is_same_v<T, bool>) {
      value = Byte(1) != 0;
    } else if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(Byte(static_cast<std::uint8_t>(LastOf(T()))));
    } else {
      Visit(*this, value);
    }
  }

  void One(std::string& text) { bytes_.Text(&text); }

  void One(Pose& X) {
    double n[7] = {1, 0, 0, 0, 0, 0, 0};
    bytes_.Plain(n, std::size(n));
    X = Pose(Quat(n[0], n[1], n[2], n[3]), Vec3(n[4], n[5], n[6]));
  }

  template <typename T>
  void One(std::optional<T>& value) {
    value.reset();
    if (Byte(1) != 0) {
      One(value.emplace());
    }
  }

  template <typename T>
  void One(std::vector<T>& values) {
    values.clear();
    if constexpr (kIsPlain<T> || kIsId<T>) {
      values.resize(bytes_.Size(sizeof(T)));
      bytes_.Plain(reinterpret_cast<std::byte*>(values.data()), values.size() * sizeof(T));
    } else {
      const std::size_t size = bytes_.Size(SmallestSize<T>());
      values.reserve(size);
      while (values.size() < size && !bytes_.has_failed()) {
        One(values.emplace_back());
      }
    }
  }

  std::uint8_t Byte(std::uint8_t last) {
    std::uint8_t byte = 0;
    bytes_.Plain(&byte, 1);
    if (byte > last) {
      bytes_.Fail();
      return 0;
    }
    return byte;
  }

  ByteReader& bytes_;
};

}  // namespace

void WriteProduct(const Product& product, ByteWriter* writer) {
  std::size_t size = 0;
  for (const Part& part : product.parts) {
    for (const Mesh* mesh : {&part.mesh, &part.display_mesh}) {
      size += mesh->vertices.size() * sizeof(Vec3) + mesh->triangles.size() * 12;
    }
    size += part.faces.size() * 300;
  }
  writer->bytes().reserve(writer->bytes().size() + size);
  Writer visitor(writer);
  visitor(product);
  VisitExtension(visitor, product);
  VisitBodies(visitor, product);
  VisitPrismatic(visitor, product);
}

void WriteDiagnostics(const Diagnostics& diagnostics, ByteWriter* writer) {
  Writer visitor(writer);
  visitor(diagnostics.items());
}

Product ReadProduct(ByteReader* reader, std::uint32_t format) {
  Product product;
  Reader visitor(reader);
  visitor(product);
  if (format > kFirstProductFormat) {
    VisitExtension(visitor, product);
  }
  constexpr std::uint32_t kFormatWithBodies = 3;  // A definition: the first that has them.
  if (format >= kFormatWithBodies) {
    VisitBodies(visitor, product);
  }
  constexpr std::uint32_t kFormatWithPrismatic = 4;  // A definition: the first that has them.
  if (format >= kFormatWithPrismatic) {
    VisitPrismatic(visitor, product);
  }
  if (!reader->has_failed() && Validate(product)) {
    return product;
  }
  reader->Fail();
  return {};
}

Diagnostics ReadDiagnostics(ByteReader* reader) {
  std::vector<Diagnostic> items;
  Reader visitor(reader);
  visitor(items);
  Diagnostics diagnostics;
  if (!reader->has_failed()) {
    for (Diagnostic& item : items) {
      diagnostics.Add(std::move(item));
    }
  }
  return diagnostics;
}

std::vector<std::byte> SerialiseProduct(const Product& product) {
  ByteWriter writer;
  writer.Plain(&kProductFormat, 1);
  WriteProduct(product, &writer);
  return std::move(writer.bytes());
}

Result<Product> DeserialiseProduct(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  std::uint32_t format = 0;
  reader.Plain(&format, 1);
  if (reader.has_failed() || format < kFirstProductFormat || format > kProductFormat) {
    return Fail(ErrorCode::kUnreadable, "the data are not a product of this version of HVAS", {},
                "read the CAD file again");
  }
  Product product = ReadProduct(&reader, format);
  if (!reader.is_finished()) {
    return Fail(ErrorCode::kUnreadable, "the data of the product are damaged", {},
                "read the CAD file again");
  }
  return product;
}

}  // namespace hvas::product
