#include "fuzz/random_product.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>

#include "base/random.h"
#include "cad/scene/product_tree.h"
#include "cad/triangles/triangle_part.h"
#include "mates/side_file.h"

namespace hvas::fuzz {
namespace {

using cad::Triangle;
using cad::TriangleSoup;
using product::Part;
using product::Product;
using spatial::Pose;

constexpr double kTurn = 2 * std::numbers::pi;

/** An element of a table for any number. */
template <typename Table>
const auto& PickFrom(const Table& table, int number) {
  return table[static_cast<std::size_t>(number) % std::size(table)];
}

// Lengths for the scale of a part: equal ones fit each other, near ones fit with play or too
// tightly, and what has no length is flat, or a needle. The first one is the simplest.
constexpr std::array kLengths{1.0, 0.5, 0.25, 2.0, 0.0, 0.999, 0.501, 0.4999, 1e-3, 10.0};
// Scales of products [m]: 1e-6 to 1e3.
constexpr std::array kScales{1e-2, 1e-3, 1e-1, 1.0, 1e1, 1e2, 1e3, 1e-4, 1e-5, 1e-6};
// Scales of parts against their product.
constexpr std::array kPartScales{1.0, 1.0, 1.0, 1.0, 0.5, 0.1, 1e-3, 1e3};
constexpr std::array kStretches{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.5, 1e-6, 0.0, -1.0};

// Names that the recognisers know, and such as files have.
constexpr std::array kWords{"part",
                            "PCB",
                            "R1",
                            "C15 main",
                            "SW1",
                            "M6x20",
                            "ISO 4762 M6x20",
                            "ISO 4032 M6",
                            "hex nut M5",
                            "washer M6",
                            "DIN 127 spring washer",
                            "O-ring DIN 3770 20x2",
                            "gasket",
                            "compression spring",
                            "DIN 2093 disc spring",
                            "slit pin ISO 8752",
                            "lip seal DIN 3760 20x35x7",
                            "rubber sleeve",
                            "snap hook cover",
                            "circlip DIN 471",
                            "608ZZ",
                            "6204-2RS",
                            "ball bearing",
                            "inner ring",
                            "ball",
                            "NEMA17",
                            "SG90 servo",
                            "servo horn",
                            "motor mount",
                            "cable",
                            "SOLID",
                            "COMPOUND",
                            "shell",
                            "thread",
                            "head",
                            "dowel pin 6 h8",
                            "parallel key DIN 6885",
                            "shaft",
                            "bushing",
                            "heat-set insert M3",
                            "fixture",
                            "tools",
                            "base",
                            "part#2",
                            "a/b/c",
                            "all",
                            "%s%n{}",
                            "<b>&amp;\"'</b>]]>",
                            "\\N{",
                            "..",
                            " ",
                            "\t\r\n",
                            "\x01\x1b[31m\x7f",
                            "\u00c4\u00fc\u00df \u00d7 20",
                            "\u87ba\u4e1d M6\u00d720",
                            "\u05d1\u05d5\u05e8\u05d2",
                            "\u202eevil\u202c",
                            "e\u0301\u0301\u0301",
                            "\U0001f529",
                            "\ufeff",
                            ""};
constexpr int kLongNames = 3;  // Names after the words: long ones.
constexpr std::size_t kLong =
    20'000;  // Bytes of a long name: more than any field on a screen holds.

// Fits and sizes that a side file may state.
constexpr std::array kFits{"H7/g6", "H7/p6", "thread", "g6", "H7", "ZZ99/a1", "H7/s6", ""};

/** Points of a profile in the half plane of a lathe, from the axis outward and back to it. */
using Profile = std::vector<std::pair<double, double>>;  // Radius and height.

/** The surface of revolution of a profile, closed where the profile is, with `sides` corners
 * around. */
void AddTurned(const Profile& profile, int sides, const Vec3& at, TriangleSoup* soup) {
  const auto first = static_cast<std::uint32_t>(soup->vertices.size());
  const auto count = static_cast<std::uint32_t>(profile.size());
  for (int i = 0; i < sides; ++i) {
    const double angle = kTurn * i / sides;
    for (const auto& [r, z] : profile) {
      soup->vertices.push_back(at + Vec3(r * std::cos(angle), r * std::sin(angle), z));
    }
  }
  for (int i = 0; i < sides; ++i) {
    const std::uint32_t here = first + static_cast<std::uint32_t>(i) * count;
    const std::uint32_t next = first + static_cast<std::uint32_t>((i + 1) % sides) * count;
    for (std::uint32_t k = 0; k + 1 < count; ++k) {
      soup->triangles.push_back({here + k, next + k, next + k + 1});
      soup->triangles.push_back({here + k, next + k + 1, here + k + 1});
    }
  }
}

/** A square prism of these half widths. */
void AddBlock(const Vec3& half, const Vec3& at, TriangleSoup* soup) {
  const auto first = static_cast<std::uint32_t>(soup->vertices.size());
  for (int i = 0; i < 8; ++i) {
    soup->vertices.push_back(at + Vec3((i & 1) != 0 ? half.x() : -half.x(),
                                       (i & 2) != 0 ? half.y() : -half.y(),
                                       (i & 4) != 0 ? half.z() : -half.z()));
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kSides{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& s : kSides) {
    soup->triangles.push_back({first + s[0], first + s[1], first + s[2]});
    soup->triangles.push_back({first + s[0], first + s[2], first + s[3]});
  }
}

constexpr int kForms = 14;
constexpr int kRound = 24;  // Corners of a circle: few, for speed.

/** The profile of a ball on the ground. */
Profile MakeBall(double radius) {
  constexpr int kRows = 8;
  Profile profile;
  for (int i = 0; i <= kRows; ++i) {
    const double polar = 0.5 * kTurn * i / kRows;
    profile.emplace_back(i % kRows == 0 ? 0 : radius * std::sin(polar),
                         radius - radius * std::cos(polar));
  }
  return profile;
}

/** The profile of a ring of round section on the ground. */
Profile MakeRing(double radius, double section) {
  constexpr int kSection = 8;
  Profile profile;
  for (int i = 0; i <= kSection; ++i) {
    const double angle = kTurn * (i % kSection) / kSection;
    profile.emplace_back(radius + section * std::cos(angle), section + section * std::sin(angle));
  }
  return profile;
}

void AddAnyTriangles(std::uint64_t seed, double radius, double height, TriangleSoup* soup) {
  Random random(seed);
  const int count = 1 + static_cast<int>(random.NextBits() % 40);
  for (int i = 0; i < count; ++i) {
    soup->vertices.emplace_back(random.Uniform(-radius, radius), random.Uniform(-radius, radius),
                                random.Uniform(0, height));
    const auto size = static_cast<std::uint64_t>(i + 1);
    soup->triangles.push_back({static_cast<std::uint32_t>(random.NextBits() % size),
                               static_cast<std::uint32_t>(random.NextBits() % size),
                               static_cast<std::uint32_t>(random.NextBits() % size)});
  }
}

/** Adds a turned part of any profile, closed or not. */
void AddAnyTurned(std::uint64_t seed, double radius, double height, TriangleSoup* soup) {
  Random random(seed);
  Profile profile{{0, 0}};
  const int count = 1 + static_cast<int>(random.NextBits() % 6);
  for (int i = 0; i < count; ++i) {
    profile.emplace_back(radius * static_cast<double>(random.NextBits() % 5) / 4,
                         height * static_cast<double>(random.NextBits() % 9) / 8);
  }
  profile.emplace_back(0, profile.back().second);
  AddTurned(profile, 3 + static_cast<int>(random.NextBits() % 22), Vec3::Zero(), soup);
}

/** The triangles of a form with the dimensions of a part, in units of its scale. */
TriangleSoup MakeForm(const RandomPart& part) {
  const double r = PickFrom(kLengths, part.radius);
  const double bore = PickFrom(kLengths, part.bore);
  const double h = PickFrom(kLengths, part.length);
  TriangleSoup soup;
  const Profile full{{0, 0}, {r, 0}, {r, h}, {0, h}};
  switch (part.form % kForms) {
    case 0:
      AddBlock(Vec3(r, r, 0.5 * h), Vec3(0, 0, 0.5 * h), &soup);
      break;
    case 1:
      AddTurned(full, kRound, Vec3::Zero(), &soup);
      break;
    case 2:  // A tube.
      AddTurned({{bore, 0}, {r, 0}, {r, h}, {bore, h}, {bore, 0}}, kRound, Vec3::Zero(), &soup);
      break;
    case 3:  // A cup.
      AddTurned({{0, 0}, {r, 0}, {r, h}, {bore, h}, {bore, 0.2 * h}, {0, 0.2 * h}}, kRound,
                Vec3::Zero(), &soup);
      break;
    case 4:  // A cone.
      AddTurned({{0, 0}, {r, 0}, {bore, h}, {0, h}}, kRound, Vec3::Zero(), &soup);
      break;
    case 5:
      AddTurned(MakeBall(r), kRound, Vec3::Zero(), &soup);
      break;
    case 6:  // A hexagon, as of a nut without a hole.
      AddTurned(full, 6, Vec3::Zero(), &soup);
      break;
    case 7:  // A shaft with a shoulder.
      AddTurned({{0, 0}, {bore, 0}, {bore, 0.5 * h}, {r, 0.5 * h}, {r, h}, {0, h}}, kRound,
                Vec3::Zero(), &soup);
      break;
    case 8:  // A screw with a hexagonal head, as two bodies.
      AddTurned({{0, 0}, {bore, 0}, {bore, h}, {0, h}}, kRound, Vec3::Zero(), &soup);
      AddTurned({{0, h}, {r, h}, {r, 1.3 * h}, {0, 1.3 * h}}, 6, Vec3::Zero(), &soup);
      break;
    case 9:
      AddTurned(MakeRing(r, bore), kRound, Vec3::Zero(), &soup);
      break;
    case 10:  // A sheet.
      soup.vertices = {{-r, -r, 0}, {r, -r, 0}, {r, r, 0}, {-r, r, 0}};
      soup.triangles = {{0, 1, 2}, {0, 2, 3}};
      break;
    case 11:  // A box with a closed cavity.
      AddBlock(Vec3(r, r, 0.5 * h), Vec3(0, 0, 0.5 * h), &soup);
      AddBlock(Vec3(-bore, bore, 0.25 * h), Vec3(0, 0, 0.5 * h), &soup);
      break;
    case 12:
      AddAnyTriangles(part.seed, r, h, &soup);
      break;
    default:
      AddAnyTurned(part.seed, r, h, &soup);
      break;
  }
  return soup;
}

/** What a file may lack, or have too much of. */
void Damage(int kind, TriangleSoup* soup) {
  switch (kind) {
    case 1:  // A hole in the surface.
      if (!soup->triangles.empty()) {
        soup->triangles.pop_back();
      }
      break;
    case 2:  // Inside out.
      for (Triangle& t : soup->triangles) {
        std::swap(t[1], t[2]);
      }
      break;
    case 3:  // Every triangle twice.
      soup->triangles.insert(soup->triangles.end(), soup->triangles.begin(), soup->triangles.end());
      break;
    case 4:  // Only one triangle.
      soup->triangles.resize(std::min<std::size_t>(1, soup->triangles.size()));
      break;
    case 5:  // Nothing.
      soup->triangles.clear();
      break;
    case 6:  // A point that is none.
      if (!soup->vertices.empty()) {
        soup->vertices.back().x() = std::nan("");
      }
      break;
    case 7:  // A point far away.
      if (!soup->vertices.empty()) {
        soup->vertices.back() *= 100;
      }
      break;
    default:
      break;
  }
}

Part MakePart(const RandomPart& random, double scale) {
  Part part;
  part.name = MakeName(random.name);
  TriangleSoup soup = MakeForm(random);
  Damage(random.damage, &soup);
  const double factor = scale * PickFrom(kPartScales, random.scale);
  const double stretch = PickFrom(kStretches, random.stretch);
  for (Vec3& p : soup.vertices) {
    p *= factor;
    p[random.stretch % 3] *= stretch;
  }
  if (random.surface == 1) {
    // All triangles are of one face of no stated surface, as of a tessellated STEP file.
    soup.faces.emplace_back();
    soup.face.assign(soup.triangles.size(), 0);
  }
  Diagnostics diagnostics;
  if (!cad::BuildTrianglePart(soup, &part, &diagnostics)) {
    part.mesh = {};  // The tree takes such parts out.
  }
  return part;
}

Quat MakeTurn(int turn) {
  constexpr int kSixths = 6;
  const std::array axes{Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ()),
                        Vec3(Vec3(1, 2, 3).normalized())};
  if (turn < kSixths) {
    return Quat(Eigen::AngleAxisd(0.25 * kTurn * (turn % 4), axes[turn / 4]));
  }
  return Quat(Eigen::AngleAxisd(0.37 * turn, axes[static_cast<std::size_t>(turn) % axes.size()]));
}

constexpr int kPlaces = 7;

/** Where an occurrence is.
 @param before  The pose of the one before it. @param height  The height of that one's part. */
Pose MakePlace(const RandomOccurrence& random, const Pose& before, double height, double scale) {
  const Quat q = MakeTurn(random.turn);
  const Vec3 steps = 0.5 * scale * Vec3(random.x, random.y, random.z);
  switch (random.place % kPlaces) {
    case 0:  // On the one before it.
      return before * Pose(q, Vec3(0, 0, height));
    case 1:  // At the same place.
      return before * Pose(q, Vec3::Zero());
    case 2:  // In it, on its axis.
      return before * Pose(q, Vec3(0, 0, steps.z()));
    case 3:  // Beside it.
      return before * Pose(q, steps);
    case 4:  // Anywhere.
      return {q, steps};
    case 5:  // Nearly at the same place.
      return before * Pose(q, 1e-6 * steps);
    default:  // Far away.
      return {q, 1e4 * steps};
  }
}

/** A whole number from 0 to below `end`, of which smaller ones are simpler. */
rc::Gen<int> Below(int end) {
  return rc::gen::inRange(0, end);
}

/** The first choice most of the time. */
rc::Gen<int> Seldom(int end) {
  return rc::gen::weightedOneOf<int>({{4, rc::gen::just(0)}, {1, rc::gen::inRange(0, end)}});
}

constexpr int kNames = static_cast<int>(kWords.size()) + kLongNames;

/** Mostly a length that others have. */
rc::Gen<int> GenerateLength() {
  return rc::gen::weightedOneOf<int>({{8, Below(4)}, {1, Below(kLengths.size())}});
}

/** Mostly on the axis of the one before. */
rc::Gen<int> GeneratePlace() {
  return rc::gen::weightedOneOf<int>(
      {{4, rc::gen::just(0)}, {3, rc::gen::just(2)}, {3, Below(kPlaces)}});
}

rc::Gen<RandomPart> GeneratePart() {
  return rc::gen::build<RandomPart>(
      rc::gen::set(&RandomPart::form, Below(kForms)), rc::gen::set(&RandomPart::scale, Seldom(8)),
      rc::gen::set(&RandomPart::radius, GenerateLength()),
      rc::gen::set(&RandomPart::bore, GenerateLength()),
      rc::gen::set(&RandomPart::length, GenerateLength()),
      rc::gen::set(&RandomPart::stretch, Seldom(10)), rc::gen::set(&RandomPart::damage, Seldom(8)),
      rc::gen::set(&RandomPart::name, Below(kNames)), rc::gen::set(&RandomPart::surface, Seldom(2)),
      rc::gen::set(&RandomPart::seed, rc::gen::inRange<std::uint32_t>(0, 1'000'000)));
}

rc::Gen<RandomNode> GenerateNode() {
  const auto depth = rc::gen::weightedOneOf<int>(
      {{20, rc::gen::just(0)}, {2, rc::gen::inRange(0, 5)}, {1, rc::gen::inRange(0, 400)}});
  return rc::gen::build<RandomNode>(rc::gen::set(&RandomNode::parent, Below(8)),
                                    rc::gen::set(&RandomNode::name, Below(kNames)),
                                    rc::gen::set(&RandomNode::depth, depth));
}

rc::Gen<RandomOccurrence> GenerateOccurrence() {
  return rc::gen::build<RandomOccurrence>(rc::gen::set(&RandomOccurrence::part, Below(6)),
                                          rc::gen::set(&RandomOccurrence::node, Below(8)),
                                          rc::gen::set(&RandomOccurrence::place, GeneratePlace()),
                                          rc::gen::set(&RandomOccurrence::turn, Seldom(16)),
                                          rc::gen::set(&RandomOccurrence::x, Below(4)),
                                          rc::gen::set(&RandomOccurrence::y, Below(4)),
                                          rc::gen::set(&RandomOccurrence::z, Below(4)),
                                          rc::gen::set(&RandomOccurrence::name, Below(kNames)));
}

constexpr int kLists = 8;

rc::Gen<RandomStatement> GenerateStatement() {
  return rc::gen::build<RandomStatement>(rc::gen::set(&RandomStatement::list, Below(kLists)),
                                         rc::gen::set(&RandomStatement::a, Below(8)),
                                         rc::gen::set(&RandomStatement::b, Below(8)),
                                         rc::gen::set(&RandomStatement::face_a, Below(8)),
                                         rc::gen::set(&RandomStatement::face_b, Below(8)),
                                         rc::gen::set(&RandomStatement::choice, Below(8)));
}

/** None, few or many of something. */
template <typename T>
rc::Gen<std::vector<T>> GenerateSome(const rc::Gen<T>& one, int most) {
  return rc::gen::mapcat(rc::gen::inRange(0, most + 1), [one](int count) {
    return rc::gen::container<std::vector<T>>(static_cast<std::size_t>(count), one);
  });
}

using Json = nlohmann::ordered_json;

/** The path of an occurrence, or a name that nothing has. */
std::string PathOf(const Product& product, int number) {
  const std::size_t count = product.occurrences.size();
  return count == 0 || number == 7
             ? MakeName(number)
             : product.occurrences[static_cast<std::size_t>(number) % count].path;
}

Json MakeSide(const Product& product, int occurrence, int face, bool is_feature) {
  return {{"occurrence", PathOf(product, occurrence)}, {is_feature ? "feature" : "face", face}};
}

void AddStatement(const RandomStatement& random, const Product& product, Json* document) {
  static constexpr std::array kRelations{"parallel", "perpendicular", "angle",    "flush",
                                         "distance", "tangent",       "parallel", "hole_to_hole"};
  const std::string a = PathOf(product, random.a);
  const std::string b = PathOf(product, random.b);
  const bool is_feature = random.choice % 2 == 0;
  const double number = PickFrom(kLengths, random.choice);
  const auto add = [&](const char* list, Json entry) {
    if (!document->contains(list)) {
      (*document)[list] = Json::array();
    }
    (*document)[list].push_back(std::move(entry));
  };
  switch (random.list % kLists) {
    case 0:
    case 1:
    case 2:  // Mates contradict each other the sooner the more there are.
      add("mates", {{"a", MakeSide(product, random.a, random.face_a, is_feature)},
                    {"b", MakeSide(product, random.b, random.face_b, is_feature)}});
      break;
    case 3: {
      Json fit{{"hole", a}, {"shaft", b}};
      if (const std::string code = PickFrom(kFits, random.choice); !code.empty()) {
        fit["fit"] = code;
      }
      fit["friction"] = number;
      add("fits", std::move(fit));
      break;
    }
    case 4: {
      const std::string kind = PickFrom(kRelations, random.choice);
      Json relation{{"kind", kind},
                    {"a", MakeSide(product, random.a, random.face_a, is_feature)},
                    {"b", MakeSide(product, random.b, random.face_b, is_feature)}};
      if (kind == "angle") {
        relation["angle_deg"] = 30 * random.choice;
      } else if (kind == "distance") {
        relation["distance_mm"] = number;
      }
      add("relations", std::move(relation));
      break;
    }
    case 5:
      add("contacts", {{"a", a}, {"b", b}, {"compliance_um_per_n", number}});
      break;
    case 6:
      add("apart", {{"unit", random.choice == 0 ? "all" : a}});
      break;
    default:
      add("flexible", {{"part", a}, {"allowance_mm", number}});
      break;
  }
}

}  // namespace

std::string MakeName(int number) {
  const auto word = static_cast<std::size_t>(number);
  if (word < kWords.size()) {
    return kWords[word];
  }
  const std::string piece = word % 2 == 0 ? "long name / \u00e4 " : "x";
  std::string name;
  while (name.size() < kLong) {
    name += piece;
  }
  return name;
}

rc::Gen<RandomProduct> GenerateProduct() {
  return rc::gen::build<RandomProduct>(
      rc::gen::set(&RandomProduct::scale,
                   rc::gen::weightedOneOf<int>({{2, rc::gen::inRange(0, 3)},
                                                {1, rc::gen::inRange<int>(0, kScales.size())}})),
      rc::gen::set(&RandomProduct::name, Seldom(kNames)),
      rc::gen::set(&RandomProduct::parts, GenerateSome(GeneratePart(), 5)),
      rc::gen::set(&RandomProduct::nodes, GenerateSome(GenerateNode(), 6)),
      rc::gen::set(&RandomProduct::occurrences, GenerateSome(GenerateOccurrence(), 8)),
      rc::gen::set(&RandomProduct::statements,
                   rc::gen::weightedOneOf<std::vector<RandomStatement>>(
                       {{2, rc::gen::just(std::vector<RandomStatement>())},
                        {1, GenerateSome(GenerateStatement(), 4)}})),
      rc::gen::set(&RandomProduct::options, Seldom(64)));
}

Product Build(const RandomProduct& random) {
  const double scale = PickFrom(kScales, random.scale);
  Product product;
  product.name = MakeName(random.name);
  product.source = "storm.stl";
  std::vector<double> heights;
  for (const RandomPart& each : random.parts) {
    Part part = MakePart(each, scale);
    part.id = product::PartId(product.parts.size());
    heights.push_back(part.box_B.is_empty() ? 0 : part.box_B.size().z());
    product.parts.push_back(std::move(part));
  }
  cad::ProductTree tree(&product);
  std::vector<product::SubassemblyId> nodes{product::SubassemblyId(0)};
  for (const RandomNode& each : random.nodes) {
    product::SubassemblyId node = nodes[static_cast<std::size_t>(each.parent) % nodes.size()];
    for (int i = 0; i < each.depth; ++i) {
      node = tree.AddSubassembly(node, MakeName(each.name + i));
    }
    nodes.push_back(tree.AddSubassembly(node, MakeName(each.name)));
  }
  Pose before;
  double height = 0;
  for (const RandomOccurrence& each : random.occurrences) {
    if (product.parts.empty()) {
      break;
    }
    const std::size_t part = static_cast<std::size_t>(each.part) % product.parts.size();
    const Pose X_WB = MakePlace(each, before, height, scale);
    tree.AddOccurrence(nodes[static_cast<std::size_t>(each.node) % nodes.size()],
                       product::PartId(part), MakeName(each.name), X_WB);
    before = X_WB;
    height = heights[part];
  }
  tree.Finish();
  return product;
}

void WriteSideFile(const RandomProduct& random, const Product& product,
                   const std::filesystem::path& file) {
  const std::filesystem::path side_file = mates::FindAssignmentFile(file);
  std::filesystem::remove(side_file);
  if (random.statements.empty()) {
    return;
  }
  Json document{{"format", std::string(mates::kSideFileFormat)}};
  for (const RandomStatement& statement : random.statements) {
    AddStatement(statement, product, &document);
  }
  std::ofstream(side_file) << document.dump(1);
}

std::string Describe(const RandomProduct& random) {
  std::string text = fmt::format("scale {:g} m, name {}, options {}\n",
                                 PickFrom(kScales, random.scale), random.name, random.options);
  for (const RandomPart& p : random.parts) {
    text += fmt::format(
        "  part: form {}, scale {:g}, radius {:g}, bore {:g}, length {:g}, stretch {:g} of axis "
        "{}, damage "
        "{}, surface {}, seed {}, name {:.40}\n",
        p.form, PickFrom(kPartScales, p.scale), PickFrom(kLengths, p.radius),
        PickFrom(kLengths, p.bore), PickFrom(kLengths, p.length), PickFrom(kStretches, p.stretch),
        p.stretch % 3, p.damage, p.surface, p.seed, Json(MakeName(p.name)).dump());
  }
  for (const RandomNode& n : random.nodes) {
    text += fmt::format("  subassembly: parent {}, depth {}, name {:.40}\n", n.parent, n.depth,
                        Json(MakeName(n.name)).dump());
  }
  for (const RandomOccurrence& o : random.occurrences) {
    text +=
        fmt::format("  occurrence: part {}, node {}, place {}, turn {}, at {} {} {}, name {:.40}\n",
                    o.part, o.node, o.place, o.turn, o.x, o.y, o.z, Json(MakeName(o.name)).dump());
  }
  for (const RandomStatement& s : random.statements) {
    text += fmt::format("  statement: list {}, a {}:{}, b {}:{}, choice {}\n", s.list, s.a,
                        s.face_a, s.b, s.face_b, s.choice);
  }
  return text;
}

}  // namespace hvas::fuzz
