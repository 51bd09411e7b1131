#include "product/product_io.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "product/names.h"
#include "product/validate.h"

namespace hvas::product {
namespace {

Pose SomePose(double x) {
  return {Quat(0.5, 0.5, -0.5, 0.5), Vec3(x, 2 * x, -x)};
}

Surface SomeSurface() {
  return {SurfaceKind::kTorus, Vec3(1, 2, 3), Vec3(0, 0.6, 0.8), 0.5, 0.125, -1};
}

Mesh SomeMesh(double x) {
  return {{Vec3(x, 0, 0), Vec3(0, x, 0), Vec3(0, 0, x), Vec3(x, x, x)}, {{0, 1, 2}, {1, 2, 3}}};
}

/** A part in which no field has the value that it has by default. */
Part FullPart() {
  Part part;
  part.id = PartId(0);
  part.name = "Gehäuse";
  part.color = {0.1F, 0.2F, 0.3F};
  part.material = {"steel", 7900, false, "S235", false, 200e9, 0.29, 240e6, 11e-6};
  part.mass.volume = 1e-3;
  part.mass.mass = 7.9;
  part.mass.p_BoBcm_B = Vec3(0.1, 0.2, 0.3);
  part.mass.I_BBcm_B << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  part.solid_count = 3;
  part.has_brep = false;
  part.box_B = {Vec3(-1, -2, -3), Vec3(1, 2, 3)};
  part.mesh = SomeMesh(2);
  part.faces.resize(2);
  part.faces[1] = {SomeSurface(),
                   true,
                   0.25,
                   {Vec3(-1, 0, 0), Vec3(1, 1, 1)},
                   1,
                   1,
                   Color{0.5F, 0.6F, 0.7F},
                   4711,
                   1e-6,
                   1,
                   1};
  part.display_mesh = SomeMesh(3);
  part.features.push_back({FeatureKind::kConeSeat,
                           {FaceId(1), FaceId(0)},
                           Vec3(1, 1, 1),
                           Vec3(1, 0, 0),
                           0.1,
                           0.2,
                           -0.3,
                           0.4,
                           5,
                           0.6,
                           ThreadKind::kModelled,
                           1e-3});
  part.features.push_back({});
  part.forms.push_back({FormKind::kCountersunkHole,
                        {FeatureId(1)},
                        {FaceId(1)},
                        Vec3(3, 2, 1),
                        Vec3(0, 1, 0),
                        0.01,
                        0.02,
                        1.5,
                        4,
                        0.001});
  part.inner_constraints.push_back({InnerConstraintKind::kCoaxial, FeatureId(0), FeatureId(1)});
  part.dimensions.push_back(
      {DimensionKind::kDiameter, "diameter", 0.03, 1e-5, -2e-5, "H7/g6", {FaceId(1)}, "#12"});
  part.dimensions.push_back({});
  part.geometric_tolerances.push_back(
      {GeometricToleranceKind::kPosition, "position", 1e-4, {"A", "B-C"}, {FaceId(0)}, "#13"});
  part.shape_hash = "0123";
  return part;
}

/** A product in which every list has something, and something that differs from the defaults. */
Product FullProduct() {
  Product product;
  product.name = "ポンプ";
  product.source = "pump.step";
  product.parts.push_back(FullPart());
  product.subassemblies.resize(2);
  product.subassemblies[0] = {SubassemblyId(0), {}, "root", {SubassemblyId(1)}, {OccurrenceId(1)}};
  product.subassemblies[1] = {SubassemblyId(1), SubassemblyId(0), "sub", {}, {OccurrenceId(0)}};
  product.occurrences.push_back({OccurrenceId(0),
                                 PartId(0),
                                 SubassemblyId(1),
                                 "pin",
                                 "root/sub/pin",
                                 SomePose(1),
                                 {"root/sub/pin/SOLID", "root/sub/pin/SHELL"}});
  product.occurrences.push_back(
      {OccurrenceId(1), PartId(0), SubassemblyId(0), "pin", "root/pin#2", SomePose(2)});
  Mate mate;
  mate.id = MateId(0);
  mate.key = "0123456789";
  mate.kind = MateKind::kConeSeat;
  mate.a = {OccurrenceId(0), FeatureId(0), SomePose(3), FeatureId(1)};
  mate.b = {OccurrenceId(1), FeatureId(1), SomePose(4)};
  mate.hole_low = 1;
  mate.hole_high = 2;
  mate.shaft_low = 3;
  mate.shaft_high = 4;
  mate.hole_radius = 5;
  mate.shaft_radius = 6;
  mate.overlap = 7;
  mate.breadth = 8;
  mate.fit = Fit{FitKind::kInterference, "H7/p6", 0.02, false, "stated"};
  mate.conditions = {{{0.01, 0.1}, {0.02, 0.11}}, {{0.03, 0.2}}, 0.3, 0.4, 0.5, 0.6, 0.7};
  mate.surfaces.push_back({SurfaceConstraintKind::kSameCone, FaceId(0), FaceId(1)});
  mate.origin = MateOrigin::kUser;
  mate.confidence = 0.75;
  mate.evidence = "same axis";
  product.mates.push_back(mate);
  product.joints.push_back({OccurrenceId(0), OccurrenceId(1), {MateId(0)}, 1, 2, 3});
  product.alignments.push_back({mate.b, {OccurrenceId(0), FeatureId(0), SomePose(3)}});
  product.box_W = {Vec3(-5, -6, -7), Vec3(8, 9, 10)};
  product.parts[0].identity = {"P-1", "a pin", "B", "longer", "A. Smith", "Works", "2024-05-31"};
  product.subassemblies[1].identity.id = "S-1";
  product.header = {"STEP",     "a.step",      "model",     "2024-05-31T12:30:00",
                    "A. Smith", "Works, Mill", "converter", "CAD 1",
                    "nobody",   "AP214"};
  Relation relation;
  relation.kind = RelationKind::kTangent;
  relation.a = {OccurrenceId(0), FeatureId(0),  FeatureId(1), ElementKind::kEdge,
                Vec3(1, 2, 3),   Vec3::UnitX(), 0.5,          true};
  relation.b.occurrence = OccurrenceId(1);
  relation.magnitude = 0.25;
  relation.is_stated = true;
  relation.free_translations = 1;
  relation.free_rotations = 2;
  relation.residual = 1e-6;
  product.relations.push_back(relation);
  product.contact_pairs.push_back({OccurrenceId(0), OccurrenceId(1), 1e-7, std::nullopt});
  return product;
}

Product RoundTrip(const Product& product) {
  auto read = DeserialiseProduct(SerialiseProduct(product));
  EXPECT_TRUE(read.has_value());
  return read.value_or(Product{});
}

constexpr std::size_t kTextSize = sizeof(std::uint64_t);  // A text or list without content.

/** The bytes as a program of format 2 wrote them: without what VisitBodies adds. */
std::vector<std::byte> SerialiseSecondFormat(Product product) {
  for (Occurrence& occurrence : product.occurrences) {
    occurrence.bodies.clear();
  }
  std::vector<std::byte> bytes = SerialiseProduct(product);
  const std::size_t bodies = kTextSize * product.occurrences.size();
  const std::size_t prismatic = product.mates.size() * (2 * sizeof(FeatureId) + sizeof(double));
  bytes.resize(bytes.size() - bodies - prismatic);
  bytes.at(0) = std::byte{2};
  return bytes;
}

/** The bytes as a program of format 1 wrote them: without what VisitExtension adds. */
std::vector<std::byte> SerialiseFirstFormat(Product product) {
  for (Part& part : product.parts) {
    part.identity = {};
  }
  for (Subassembly& subassembly : product.subassemblies) {
    subassembly.identity = {};
  }
  product.header = {};
  product.relations.clear();
  product.contact_pairs.clear();
  const std::size_t identities = product.parts.size() + product.subassemblies.size();
  const std::size_t extension = kTextSize * (7 * identities + 10 + 2);
  std::vector<std::byte> bytes = SerialiseSecondFormat(product);
  bytes.resize(bytes.size() - extension);
  bytes.at(0) = std::byte{1};
  return bytes;
}

void ExpectEqual(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

void ExpectEqual(const Box& a, const Box& b) {
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
}

void ExpectEqual(const Pose& a, const Pose& b) {
  EXPECT_EQ(a.q().coeffs(), b.q().coeffs());
  EXPECT_EQ(a.p(), b.p());
}

void ExpectEqual(const Connector& a, const Connector& b) {
  EXPECT_EQ(a.occurrence, b.occurrence);
  EXPECT_EQ(a.feature, b.feature);
  ExpectEqual(a.X_BM, b.X_BM);
  EXPECT_EQ(a.opposite, b.opposite);
}

void ExpectEqual(const std::optional<Color>& a, const std::optional<Color>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (a) {
    EXPECT_TRUE(a->r == b->r && a->g == b->g && a->b == b->b);
  }
}

TEST(ProductIo, X2KeepsIdentitiesHeaderRelationsAndContactPairs) {
  const Product b = RoundTrip(FullProduct());
  const Identity& identity = b.parts.at(0).identity;
  EXPECT_EQ(identity.id, "P-1");
  EXPECT_EQ(identity.description, "a pin");
  EXPECT_EQ(identity.version, "B");
  EXPECT_EQ(identity.version_description, "longer");
  EXPECT_EQ(identity.designer, "A. Smith");
  EXPECT_EQ(identity.organisation, "Works");
  EXPECT_EQ(identity.created, "2024-05-31");
  EXPECT_EQ(b.subassemblies.at(1).identity.id, "S-1");
  EXPECT_EQ(b.header.originating_system, "CAD 1");
  EXPECT_EQ(b.header.schema, "AP214");
  const Relation& relation = b.relations.at(0);
  EXPECT_EQ(relation.kind, RelationKind::kTangent);
  EXPECT_EQ(relation.a.element, ElementKind::kEdge);
  EXPECT_EQ(relation.a.second, FeatureId(1));
  EXPECT_EQ(relation.a.radius, 0.5);
  EXPECT_TRUE(relation.a.is_inward && relation.is_stated);
  EXPECT_EQ(relation.magnitude, 0.25);
  EXPECT_EQ(relation.free_translations, 1);
  EXPECT_EQ(relation.residual, 1e-6);
  EXPECT_EQ(b.contact_pairs.at(0).compliance, 1e-7);
  EXPECT_FALSE(b.contact_pairs.at(0).friction.has_value());
}

TEST(ProductIo, X2ReadsProductsOfTheFirstFormatThatRecordsHold) {
  const auto read = DeserialiseProduct(SerialiseFirstFormat(FullProduct()));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->mates.size(), 1u);
  EXPECT_TRUE(read->parts.at(0).identity.is_empty());
  EXPECT_TRUE(read->relations.empty());
}

TEST(ProductIo, X2ReadsProductsOfTheSecondFormatThatRecordsHold) {
  const auto read = DeserialiseProduct(SerialiseSecondFormat(FullProduct()));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->relations.size(), FullProduct().relations.size());
  EXPECT_TRUE(read->occurrences.at(0).bodies.empty());
}

// The writer's list of fields is made to be complete by the compiler; here each is looked at once
// more by hand.
TEST(ProductIo, KeepsPartsToTheLastBit) {
  const Part a = FullPart();
  const Part b = RoundTrip(FullProduct()).parts.at(0);
  EXPECT_EQ(b.id, a.id);
  EXPECT_EQ(b.name, a.name);
  ExpectEqual(std::optional(b.color), a.color);
  EXPECT_EQ(b.material.name, a.material.name);
  EXPECT_EQ(b.material.density, a.material.density);
  EXPECT_EQ(b.material.is_assumed, a.material.is_assumed);
  EXPECT_EQ(b.material.standard, a.material.standard);
  EXPECT_EQ(b.material.is_standard_assumed, a.material.is_standard_assumed);
  EXPECT_EQ(b.material.youngs_modulus, a.material.youngs_modulus);
  EXPECT_EQ(b.material.poisson_ratio, a.material.poisson_ratio);
  EXPECT_EQ(b.material.yield_strength, a.material.yield_strength);
  EXPECT_EQ(b.material.thermal_expansion, a.material.thermal_expansion);
  EXPECT_EQ(b.mass.volume, a.mass.volume);
  EXPECT_EQ(b.mass.mass, a.mass.mass);
  EXPECT_EQ(b.mass.p_BoBcm_B, a.mass.p_BoBcm_B);
  EXPECT_EQ(b.mass.I_BBcm_B, a.mass.I_BBcm_B);
  EXPECT_EQ(b.solid_count, a.solid_count);
  EXPECT_EQ(b.has_brep, a.has_brep);
  ExpectEqual(b.box_B, a.box_B);
  ExpectEqual(b.mesh, a.mesh);
  ExpectEqual(b.display_mesh, a.display_mesh);
  EXPECT_EQ(b.shape_hash, a.shape_hash);
}

TEST(ProductIo, KeepsFacesFeaturesAndFormsToTheLastBit) {
  const Part a = FullPart();
  const Part b = RoundTrip(FullProduct()).parts.at(0);
  ASSERT_EQ(b.faces.size(), 2u);
  const Face& f = a.faces[1];
  const Face& g = b.faces[1];
  EXPECT_TRUE(g.surface.kind == f.surface.kind && g.surface.origin == f.surface.origin &&
              g.surface.axis == f.surface.axis && g.surface.radius == f.surface.radius &&
              g.surface.second == f.surface.second && g.surface.outward == f.surface.outward);
  EXPECT_TRUE(g.is_recognised == f.is_recognised && g.area == f.area && g.entity == f.entity &&
              g.residual == f.residual);
  EXPECT_TRUE(g.first_triangle == 1 && g.triangle_count == 1 && g.first_display_triangle == 1 &&
              g.display_triangle_count == 1);
  ExpectEqual(g.box_B, f.box_B);
  ExpectEqual(g.color, f.color);
  EXPECT_FALSE(b.faces[0].color.has_value());
  ASSERT_EQ(b.features.size(), 2u);
  const Feature& h = a.features[0];
  const Feature& i = b.features[0];
  EXPECT_TRUE(i.kind == h.kind && i.faces == h.faces && i.origin_B == h.origin_B &&
              i.axis_B == h.axis_B && i.radius == h.radius && i.half_angle == h.half_angle);
  EXPECT_TRUE(i.span_low == h.span_low && i.span_high == h.span_high && i.coverage == h.coverage &&
              i.area == h.area && i.thread == h.thread && i.thread_pitch == h.thread_pitch);
  ASSERT_EQ(b.forms.size(), 1u);
  const Form& j = a.forms[0];
  const Form& k = b.forms[0];
  EXPECT_TRUE(k.kind == j.kind && k.features == j.features && k.faces == j.faces &&
              k.origin_B == j.origin_B && k.axis_B == j.axis_B && k.diameter == j.diameter &&
              k.depth == j.depth && k.angle == j.angle && k.count == j.count &&
              k.lead_in == j.lead_in);
  ASSERT_EQ(b.inner_constraints.size(), 1u);
  EXPECT_EQ(b.inner_constraints[0].kind, InnerConstraintKind::kCoaxial);
  EXPECT_EQ(b.inner_constraints[0].a, FeatureId(0));
  EXPECT_EQ(b.inner_constraints[0].b, FeatureId(1));
}

TEST(ProductIo, KeepsTolerancesToTheLastBit) {
  const Part b = RoundTrip(FullProduct()).parts.at(0);
  ASSERT_EQ(b.dimensions.size(), 2u);
  const Dimension& d = b.dimensions[0];
  EXPECT_TRUE(d.kind == DimensionKind::kDiameter && d.name == "diameter" && d.nominal == 0.03 &&
              d.upper == 1e-5 && d.lower == -2e-5 && d.fit == "H7/g6" &&
              d.faces == std::vector{FaceId(1)} && d.entity == "#12");
  EXPECT_FALSE(b.dimensions[1].upper || b.dimensions[1].lower || b.dimensions[1].fit);
  ASSERT_EQ(b.geometric_tolerances.size(), 1u);
  const GeometricTolerance& t = b.geometric_tolerances[0];
  EXPECT_TRUE(t.kind == GeometricToleranceKind::kPosition && t.name == "position" &&
              t.magnitude == 1e-4 && t.datums == std::vector<std::string>({"A", "B-C"}) &&
              t.faces == std::vector{FaceId(0)} && t.entity == "#13");
}

TEST(ProductIo, KeepsTreeAndMatesToTheLastBit) {
  const Product a = FullProduct();
  const Product b = RoundTrip(a);
  EXPECT_EQ(b.name, a.name);
  EXPECT_EQ(b.source, a.source);
  ExpectEqual(b.box_W, a.box_W);
  ASSERT_EQ(b.subassemblies.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(b.subassemblies[i].id == a.subassemblies[i].id &&
                b.subassemblies[i].parent == a.subassemblies[i].parent &&
                b.subassemblies[i].name == a.subassemblies[i].name &&
                b.subassemblies[i].subassemblies == a.subassemblies[i].subassemblies &&
                b.subassemblies[i].occurrences == a.subassemblies[i].occurrences);
    const Occurrence& o = b.occurrences.at(i);
    EXPECT_TRUE(o.id == a.occurrences[i].id && o.part == a.occurrences[i].part &&
                o.parent == a.occurrences[i].parent && o.name == a.occurrences[i].name &&
                o.path == a.occurrences[i].path && o.bodies == a.occurrences[i].bodies);
    ExpectEqual(o.X_WB, a.occurrences[i].X_WB);
  }
  ASSERT_EQ(b.mates.size(), 1u);
  const Mate& m = a.mates[0];
  const Mate& n = b.mates[0];
  ExpectEqual(n.a, m.a);
  ExpectEqual(n.b, m.b);
  EXPECT_TRUE(n.id == m.id && n.key == m.key && n.kind == m.kind && n.hole_low == m.hole_low &&
              n.hole_high == m.hole_high && n.shaft_low == m.shaft_low &&
              n.shaft_high == m.shaft_high && n.hole_radius == m.hole_radius &&
              n.shaft_radius == m.shaft_radius && n.overlap == m.overlap &&
              n.breadth == m.breadth && n.origin == m.origin && n.confidence == m.confidence &&
              n.evidence == m.evidence);
  ASSERT_TRUE(n.fit.has_value());
  EXPECT_TRUE(n.fit->kind == m.fit->kind && n.fit->code == m.fit->code &&
              n.fit->nominal_diameter == m.fit->nominal_diameter &&
              n.fit->is_proposed == m.fit->is_proposed && n.fit->reason == m.fit->reason);
  ASSERT_EQ(n.conditions.hole_diameters.size(), 2u);
  ASSERT_EQ(n.conditions.shaft_diameters.size(), 1u);
  EXPECT_TRUE(n.conditions.hole_diameters[1].depth == 0.02 &&
              n.conditions.hole_diameters[1].diameter == 0.11 &&
              n.conditions.shaft_diameters[0].depth == 0.03 &&
              n.conditions.shaft_diameters[0].diameter == 0.2 &&
              n.conditions.hole_roughness == 0.3 && n.conditions.shaft_roughness == 0.4 &&
              n.conditions.friction == 0.5 && n.conditions.hole_temperature_c == 0.6 &&
              n.conditions.shaft_temperature_c == 0.7);
  ASSERT_EQ(n.surfaces.size(), 1u);
  EXPECT_TRUE(n.surfaces[0].kind == SurfaceConstraintKind::kSameCone &&
              n.surfaces[0].a == FaceId(0) && n.surfaces[0].b == FaceId(1));
  ASSERT_EQ(b.joints.size(), 1u);
  const Joint& j = b.joints[0];
  EXPECT_TRUE(j.a == OccurrenceId(0) && j.b == OccurrenceId(1) &&
              j.mates == std::vector{MateId(0)} && j.free_translations == 1 &&
              j.free_rotations == 2 && j.pattern_count == 3);
  ASSERT_EQ(b.alignments.size(), 1u);
  ExpectEqual(b.alignments[0].a, m.b);
  ExpectEqual(b.alignments[0].b.X_BM, m.a.X_BM);
}

TEST(ProductIo, KeepsEveryKindOfMate) {
  for (const MateKind kind : kMateKinds) {
    Product product = FullProduct();
    product.mates[0].kind = kind;
    for (Connector* side : {&product.mates[0].a, &product.mates[0].b}) {
      side->opposite = side->feature;  // Prismatic mates have two planes on each side.
    }
    ASSERT_EQ(RoundTrip(product).mates.size(), 1U) << ToString(kind);
    EXPECT_EQ(RoundTrip(product).mates[0].kind, kind);
  }
}

TEST(ProductIo, KeepsAnEmptyProductAndOddNumbers) {
  Product product;
  EXPECT_TRUE(RoundTrip(product).box_W.is_empty());
  product = FullProduct();
  product.parts[0].mass.mass = std::numeric_limits<double>::quiet_NaN();
  product.parts[0].mass.volume = -0.0;
  const Product read = RoundTrip(product);
  EXPECT_TRUE(std::isnan(read.parts.at(0).mass.mass));
  EXPECT_TRUE(std::signbit(read.parts.at(0).mass.volume));
}

TEST(ProductIo, KeepsDiagnostics) {
  Diagnostics diagnostics;
  diagnostics.Warn("code", "entity", "message", "remedy");
  diagnostics.Note("", "", "");
  ByteWriter writer;
  WriteDiagnostics(diagnostics, &writer);
  ByteReader reader(writer.bytes());
  const Diagnostics read = ReadDiagnostics(&reader);
  EXPECT_TRUE(reader.is_finished());
  ASSERT_EQ(read.items().size(), 2u);
  const Diagnostic& item = read.items()[0];
  EXPECT_TRUE(item.severity == Severity::kWarning && item.code == "code" &&
              item.entity == "entity" && item.message == "message" && item.remedy == "remedy");
  EXPECT_EQ(read.items()[1].severity, Severity::kNote);
}

TEST(ProductIo, RefusesEveryTruncation) {
  const std::vector<std::byte> bytes = SerialiseProduct(FullProduct());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(DeserialiseProduct(std::span(bytes).first(size)).has_value()) << size;
  }
  std::vector<std::byte> longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(DeserialiseProduct(longer).has_value());
}

TEST(ProductIo, RefusesAnotherFormat) {
  std::vector<std::byte> bytes = SerialiseProduct(FullProduct());
  const std::uint32_t format = kProductFormat + 1;
  std::memcpy(bytes.data(), &format, sizeof(format));
  EXPECT_FALSE(DeserialiseProduct(bytes).has_value());
}

// What is still taken for a product is a valid one; and no count asks for memory that the bytes
// cannot fill (a run under a limit of memory would fail).
TEST(ProductIo, TakesTwentyThousandDamagedProducts) {
  const std::vector<std::byte> whole = SerialiseProduct(FullProduct());
  Random random(20260101);
  const auto below = [&random](std::size_t n) {
    return static_cast<std::size_t>(random.NextBits() % n);
  };
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::byte> bytes = whole;
    const auto changes = 1 + below(4);
    for (std::size_t change = 0; change < changes; ++change) {
      const std::size_t at = 4 + below(bytes.size() - 4);
      static constexpr std::uint8_t kTelling[] = {0, 1, 2, 0x7f, 0x80, 0xff};
      bytes[at] = static_cast<std::byte>(below(2) == 0 ? kTelling[below(6)] : below(256));
    }
    if (below(8) == 0) {
      bytes.resize(below(bytes.size()));
    }
    const auto product = DeserialiseProduct(bytes);
    refused += product ? 0 : 1;
    EXPECT_TRUE(!product || Validate(*product)) << i;
  }
  EXPECT_GT(refused, 4000);
  EXPECT_LT(refused, 19000);
}

TEST(Validate, RefusesIndicesThatLeadNowhereAndTreesThatAreNone) {
  using Change = void (*)(Product*);
  const Change changes[] = {
      [](Product* p) { p->parts[0].mesh.triangles[0][1] = 4; },
      [](Product* p) { p->parts[0].display_mesh.triangles[1][2] = 1U << 31; },
      [](Product* p) { p->parts[0].faces[1].triangle_count = 2; },
      [](Product* p) { p->parts[0].faces[1].first_display_triangle = 0xffffffff; },
      [](Product* p) { p->parts[0].features[0].faces[0] = FaceId(2); },
      [](Product* p) { p->parts[0].forms[0].features[0] = FeatureId(2); },
      [](Product* p) { p->parts[0].inner_constraints[0].b = FeatureId(); },
      [](Product* p) { p->parts[0].dimensions[0].faces[0] = FaceId(2); },
      [](Product* p) { p->parts[0].id = PartId(1); },
      [](Product* p) { p->occurrences[0].part = PartId(1); },
      [](Product* p) { p->occurrences[0].parent = SubassemblyId(0); },
      [](Product* p) { p->subassemblies[0].parent = SubassemblyId(1); },
      [](Product* p) { p->subassemblies[1].subassemblies.push_back(SubassemblyId(1)); },
      [](Product* p) { p->subassemblies[0].subassemblies.push_back(SubassemblyId(1)); },
      [](Product* p) { p->subassemblies[0].occurrences.clear(); },
      [](Product* p) { p->mates[0].a.occurrence = OccurrenceId(2); },
      [](Product* p) { p->mates[0].b.feature = FeatureId(2); },
      [](Product* p) { p->mates[0].surfaces[0].a = FaceId(2); },
      [](Product* p) { p->joints[0].mates[0] = MateId(1); },
      [](Product* p) { p->alignments[0].a.occurrence = OccurrenceId(); },
  };
  EXPECT_TRUE(Validate(FullProduct()));
  for (std::size_t i = 0; i < std::size(changes); ++i) {
    Product product = FullProduct();
    changes[i](&product);
    EXPECT_FALSE(Validate(product)) << "change " << i;
  }
}

}  // namespace
}  // namespace hvas::product
