#include "product/elastic_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "product/flexible.h"
#include "product/mesh_ray.h"
#include "product/product.h"
#include "product/words.h"
#include "spatial/decompose.h"

namespace hvas::product {
namespace {

// Moduli where the file names no material, or one that cannot be that of such a part [Pa]: those of
// spring steel, and of the rubber in the example of Green and English (1994). Usual values, and
// choices.
constexpr double kSpringModulus = 206e9;
constexpr double kSealModulus = 5e6;
constexpr double kSoftestSpring = 10e9;
constexpr double kStiffestSeal = 10e9;
constexpr double kSpringPoisson = 0.3;  // DIN 2092.
constexpr double kSealPoisson = 0.5;    // Rubber keeps its volume.

constexpr std::array<std::string_view, 8> kDiscNames{
    "disc spring", "disk spring", "belleville",   "tellerfeder",
    "din 2093",    "din 6796",    "spannscheibe", "conical spring washer"};
constexpr std::array<std::string_view, 9> kLockNames{
    "lock washer", "lockwasher", "spring washer", "federring",         "split washer",
    "din 127",     "din 7980",   "din 128",       "spring lock washer"};
constexpr std::array<std::string_view, 4> kLeafNames{"leaf spring", "flat spring", "blattfeder",
                                                     "ressort a lame"};
constexpr std::array<std::string_view, 11> kSlitNames{
    "slit pin",           "spring pin", "roll pin",   "slotted pin",
    "slotted spring pin", "spannstift", "spannhulse", "spannhuelse",
    "iso 8752",           "iso 13337",  "din 1481"};
constexpr std::array<std::string_view, 4> kPullNames{"tension spring", "extension spring",
                                                     "zugfeder", "torsion spring"};

/** A size of DIN 2093, series A [mm], as printed by xmdiscsprings.com. */
struct DiscSize {
  double outer, inner, thickness, cone_height;
};

constexpr std::array<DiscSize, 11> kDiscSizes{{{8, 4.2, 0.4, 0.2},
                                               {10, 5.2, 0.5, 0.25},
                                               {12.5, 6.2, 0.7, 0.3},
                                               {14, 7.2, 0.8, 0.3},
                                               {16, 8.2, 0.9, 0.35},
                                               {18, 9.2, 1, 0.4},
                                               {20, 10.2, 1.1, 0.45},
                                               {22.5, 11.2, 1.25, 0.5},
                                               {25, 12.2, 1.5, 0.55},
                                               {28, 14.2, 1.5, 0.65},
                                               {31.5, 16.3, 1.75, 0.7}}};

/** A size of ISO 8752 [mm]: nominal diameter, least and largest free diameter, wall. As printed by
 vogelsangfastener.com and torqbolt.com; the least one of 1 mm is printed as 1.02. */
struct PinSize {
  double nominal, least, largest, wall;
};

constexpr std::array<PinSize, 11> kPinSizes{{{1, 1.2, 1.3, 0.2},
                                             {1.5, 1.7, 1.8, 0.3},
                                             {2, 2.3, 2.4, 0.4},
                                             {2.5, 2.8, 2.9, 0.5},
                                             {3, 3.3, 3.5, 0.6},
                                             {3.5, 3.8, 4, 0.75},
                                             {4, 4.4, 4.6, 0.8},
                                             {4.5, 4.9, 5.1, 1},
                                             {5, 5.4, 5.6, 1},
                                             {6, 6.4, 6.7, 1.2},
                                             {8, 8.5, 8.8, 1.5}}};

constexpr double kMm = 1e-3;  // [m], by definition.

/** How a round part stands and how large it is about its axis. */
struct RoundSize {
  Vec3 axis_B{Vec3::UnitZ()};
  Vec3 centre_B{Vec3::Zero()};
  double length{0};
  double outer{0};  // Diameters.
  double inner{0};
  double volume{0};

  [[nodiscard]] double ring_area() const {
    return 0.25 * std::numbers::pi * (outer * outer - inner * inner);
  }
};

/** The axis about which the two other moments of inertia are most alike; one of B's where it is
 near to that. */
Vec3 FindAxis(const Part& part) {
  constexpr double kNearAxis =
      0.9986;  // Cosine of 3 degrees: the turns of a coil tilt it. A choice.
  const spatial::Eigensystem system = spatial::CalcEigensystem(part.mass.I_BBcm_B);
  const Vec3 moments = system.values;  // Ascending.
  const bool is_lowest = moments[2] - moments[1] <= moments[1] - moments[0];
  Vec3 axis = system.vectors.col(is_lowest ? 0 : 2).normalized();
  for (int k = 0; k < 3; ++k) {
    if (std::abs(axis[k]) > kNearAxis) {
      return Vec3::Unit(k);
    }
  }
  return axis;
}

RoundSize MeasureRound(const Part& part, const Vec3& axis_B) {
  RoundSize size;
  size.axis_B = axis_B;
  size.volume = part.mass.volume;
  const Vec3 u = axis_B.unitOrthogonal();
  const Vec3 v = axis_B.cross(u);
  spatial::Box box;
  for (const Vec3& p : part.mesh.vertices) {
    box.Add(Vec3(u.dot(p), v.dot(p), axis_B.dot(p)));
  }
  if (part.mesh.vertices.empty()) {
    return size;
  }
  const Vec3 middle = box.centre();
  size.centre_B = middle.x() * u + middle.y() * v + middle.z() * axis_B;
  size.length = box.size().z();
  double least = std::numeric_limits<double>::infinity();
  double largest = 0;
  for (const Vec3& p : part.mesh.vertices) {
    const Vec3 off = p - size.centre_B;
    const double radius = (off - off.dot(axis_B) * axis_B).norm();
    least = std::min(least, radius);
    largest = std::max(largest, radius);
  }
  size.outer = 2 * largest;
  size.inner = 2 * least;
  return size;
}

/** Measures a ring about the axis near to one along which its wall is thinnest: the turns of a coil
 tilt its axes of inertia. */
RoundSize MeasureThinnest(const Part& part, const Vec3& near_B) {
  constexpr double kFirst = 0.12;   // [rad] that the axis is tried to either side. A choice.
  constexpr double kLast = 0.2e-3;  // [rad]: moves the end of a long spring by less than meshes do.
  const auto wall_of = [](const RoundSize& size) { return size.outer - size.inner; };
  RoundSize best = MeasureRound(part, near_B);
  for (int k = 0; k < 3; ++k) {
    if (std::abs(near_B[k]) > std::cos(kFirst)) {
      const RoundSize along = MeasureRound(part, Vec3::Unit(k));
      best = wall_of(along) < wall_of(best) ? along : best;
    }
  }
  for (double step = kFirst; step > kLast;) {
    const Vec3 u = best.axis_B.unitOrthogonal();
    const Vec3 v = best.axis_B.cross(u);
    const RoundSize before = best;
    for (const Vec3& aside : {u, Vec3(-u), v, Vec3(-v)}) {
      const RoundSize tilted = MeasureRound(part, (before.axis_B + step * aside).normalized());
      best = wall_of(tilted) < wall_of(best) ? tilted : best;
    }
    step = wall_of(best) < wall_of(before) ? step : 0.5 * step;
  }
  return best;
}

bool IsPlaneAcross(const Face& face, const Vec3& axis_B) {
  constexpr double kAlong = 0.9999;  // Cosine: within 0.8 degrees. A choice.
  return face.surface.kind == SurfaceKind::kPlane &&
         std::abs(face.surface.axis.dot(axis_B)) > kAlong;
}

/** Takes the part's own material where the file names one that such a part can have. */
void SetMaterial(const Material& own, bool is_possible, double usual_modulus, double usual_poisson,
                 ElasticPart* elastic) {
  const bool is_own = !own.is_standard_assumed && is_possible;
  elastic->modulus = is_own ? own.youngs_modulus : usual_modulus;
  elastic->poisson_ratio = is_own ? own.poisson_ratio : usual_poisson;
}

void SetSpringMaterial(const Part& part, ElasticPart* elastic) {
  SetMaterial(part.material, part.material.youngs_modulus > kSoftestSpring, kSpringModulus,
              kSpringPoisson, elastic);
}

void SetSealMaterial(const Part& part, ElasticPart* elastic) {
  SetMaterial(part.material, part.material.youngs_modulus < kStiffestSeal, kSealModulus,
              kSealPoisson, elastic);
}

void SetRound(const RoundSize& size, ElasticPart* elastic) {
  elastic->axis_B = size.axis_B;
  elastic->centre_B = size.centre_B;
  elastic->length = size.length;
  elastic->outer = size.outer;
  elastic->inner = size.inner;
  elastic->free_size = size.length;
}

/** What lines along the axis meet of a coil. */
struct CoilCount {
  double turns{0};        // All, the mean over the lines.
  double sum_of_gaps{0};  // The mean over the lines [m].
  double widest_gap{0};   // [m]
  double first_gap{0};    // The least at either end [m].
  double longest{0};      // That a line is in the wire at once [m].
};

CoilCount CountCoils(const Part& part, const RoundSize& size) {
  constexpr int kLines = 24;  // A choice: turns are counted to a twenty-fourth.
  CoilCount count;
  count.first_gap = std::numeric_limits<double>::infinity();
  const double radius = 0.25 * (size.outer + size.inner);
  const Vec3 u = size.axis_B.unitOrthogonal();
  const Vec3 v = size.axis_B.cross(u);
  for (int i = 0; i < kLines; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.31) / kLines;  // Off edges of the mesh.
    const Vec3 start = size.centre_B + radius * (std::cos(angle) * u + std::sin(angle) * v) -
                       size.length * size.axis_B;
    const std::vector<Crossing> crossings =
        ListCrossings(part, start, size.axis_B, 2 * size.length);
    for (std::size_t k = 0; k + 1 < crossings.size(); ++k) {
      const double span = crossings[k + 1].distance - crossings[k].distance;
      if (crossings[k].is_entering) {
        count.turns += 1.0 / kLines;
        count.longest = std::max(count.longest, span);
        continue;
      }
      count.sum_of_gaps += span / kLines;
      count.widest_gap = std::max(count.widest_gap, span);
      if (k == 1 || k + 3 == crossings.size()) {
        count.first_gap = std::min(count.first_gap, span);
      }
    }
  }
  return count;
}

double CountActiveCoils(const Part& part, const RoundSize& size, const CoilCount& count) {
  constexpr double kClosed = 0.3;  // Of the widest gap; closed ends have none. A choice.
  if (!(count.widest_gap > 0)) {
    return 0;
  }
  const bool is_closed = count.first_gap < kClosed * count.widest_gap;
  const bool is_ground = std::any_of(part.faces.begin(), part.faces.end(), [&](const Face& face) {
    return IsPlaneAcross(face, size.axis_B);
  });
  // Shigley, Mechanical Engineering Design, table 10-1: coils with plain ends are all active,
  // ground ones lose one, closed ones two.
  return count.sum_of_gaps / count.widest_gap + (is_closed || is_ground ? 0 : 1);
}

/** Turns of round wire with gaps between them: the volume is that of the wire. */
bool IsCoil(const RoundSize& size, const CoilCount& count) {
  constexpr double kLeastTurns = 2;    // A choice.
  constexpr double kVolume = 0.2;      // How far the volume may be off: ends are ground. A choice.
  constexpr double kSteepest = 1.5;    // Of the wire, that a line along the axis is in it.
  constexpr double kNarrowest = 0.05;  // Of the wire: tension springs have no gaps. A choice.
  const double wire = 0.5 * (size.outer - size.inner);
  const double mean = 0.5 * (size.outer + size.inner);
  if (!(wire > 0) || !(size.inner > wire) || count.turns < kLeastTurns) {
    return false;
  }
  const double turn = std::hypot(std::numbers::pi * mean, wire + count.widest_gap);
  const double volume = 0.25 * std::numbers::pi * wire * wire * turn * count.turns;
  return count.widest_gap > kNarrowest * wire && count.longest < kSteepest * wire &&
         std::abs(size.volume - volume) < kVolume * volume;
}

ElasticPart MakeCoil(const Part& part, const RoundSize& size, const CoilCount& count) {
  ElasticPart elastic;
  SetRound(size, &elastic);
  elastic.thickness = 0.5 * (size.outer - size.inner);
  elastic.coils = CountActiveCoils(part, size, count);
  SetSpringMaterial(part, &elastic);
  return elastic;
}

ElasticPart MeasureCoil(const Part& part) {
  const RoundSize size = MeasureThinnest(part, FindAxis(part));
  return MakeCoil(part, size, CountCoils(part, size));
}

/** The free height of a disc that is drawn flat; 0 where its size is none of the table. */
double FindConeHeight(double outer, double inner, double thickness) {
  constexpr double kSame = 0.03;  // How far a drawn size may be off. A choice.
  const auto is_same = [](double drawn, double listed_mm) {
    return std::abs(drawn - listed_mm * kMm) < kSame * listed_mm * kMm;
  };
  const auto* const found =
      std::find_if(kDiscSizes.begin(), kDiscSizes.end(), [&](const DiscSize& size) {
        return is_same(outer, size.outer) && is_same(inner, size.inner) &&
               is_same(thickness, size.thickness);
      });
  return found == kDiscSizes.end() ? 0 : found->cone_height * kMm;
}

ElasticPart MeasureDisc(const Part& part) {
  constexpr double kFlat = 0.1;  // Of the thickness: what is lower is drawn flat. A choice.
  ElasticPart elastic;
  const RoundSize size = MeasureRound(part, FindAxis(part));
  SetRound(size, &elastic);
  elastic.thickness = size.ring_area() > 0 ? size.volume / size.ring_area() : 0;
  if (size.length < (1 + kFlat) * elastic.thickness) {
    elastic.thickness = size.length;
    elastic.free_size = size.length + FindConeHeight(size.outer, size.inner, elastic.thickness);
  }
  SetSpringMaterial(part, &elastic);
  return elastic;
}

ElasticPart MeasureLockWasher(const Part& part) {
  constexpr double kSlit = 0.97;      // Share of the turn, less a slit of 10 degrees. A choice.
  constexpr double kDrawnOpen = 1.3;  // Of the thickness: what is lower is drawn flat. A choice.
  ElasticPart elastic;
  const RoundSize size = MeasureRound(part, FindAxis(part));
  SetRound(size, &elastic);
  elastic.thickness =
      size.ring_area() > 0 ? std::min(size.length, size.volume / (kSlit * size.ring_area())) : 0;
  if (size.length < kDrawnOpen * elastic.thickness) {
    elastic.thickness = size.length;
  }
  SetSpringMaterial(part, &elastic);
  return elastic;
}

/** The box's axis along which it is shortest. */
Vec3 FindFlatAxis(const Part& part) {
  int least = 0;
  part.box_B.size().minCoeff(&least);
  return Vec3::Unit(least);
}

ElasticPart MeasureLeaf(const Part& part) {
  ElasticPart elastic;
  const Vec3 size = part.box_B.size();
  elastic.axis_B = FindFlatAxis(part);
  elastic.centre_B = part.box_B.centre();
  elastic.length = size.minCoeff();
  elastic.free_size = elastic.length;
  elastic.outer = size.maxCoeff();
  elastic.inner = size.sum() - size.maxCoeff() - size.minCoeff();
  const double area = elastic.outer * elastic.inner;
  elastic.thickness = area > 0 ? std::min(elastic.length, part.mass.volume / area) : 0;
  SetSpringMaterial(part, &elastic);
  return elastic;
}

ElasticPart MeasureGasket(const Part& part) {
  ElasticPart elastic;
  elastic.axis_B = FindFlatAxis(part);
  elastic.centre_B = part.box_B.centre();
  elastic.length = part.box_B.size().minCoeff();
  elastic.thickness = elastic.length;
  elastic.free_size = elastic.length;
  elastic.area = elastic.length > 0 ? part.mass.volume / elastic.length : 0;
  for (const Face& face : part.faces) {
    elastic.free_area += IsPlaneAcross(face, elastic.axis_B) ? 0 : face.area;
  }
  SetSealMaterial(part, &elastic);
  return elastic;
}

/** Its two faces have the area of a sheet of its volume, and are broad: a seal of a shaft is not.
 */
bool IsSheet(const Part& part, const ElasticPart& gasket) {
  constexpr double kBroad = 0.8;  // Area over free edges: a ring that is 1.6 times as wide as
                                  // thick. A choice.
  constexpr double kArea = 0.1;   // How far the area may be off. A choice.
  double area = 0;
  for (const Face& face : part.faces) {
    area += IsPlaneAcross(face, gasket.axis_B) ? 0.5 * face.area : 0;
  }
  return gasket.length > 0 && gasket.area > kBroad * gasket.free_area &&
         std::abs(area - gasket.area) < kArea * gasket.area;
}

ElasticPart MeasureSlitPin(const Part& part) {
  constexpr double kNominal = 0.02;  // How far a diameter is from its nominal one. A choice.
  ElasticPart elastic;
  const RoundSize size = MeasureRound(part, FindAxis(part));
  SetRound(size, &elastic);
  elastic.free_size = size.outer;
  elastic.thickness = 0.5 * (size.outer - size.inner);
  const auto* const found =
      std::find_if(kPinSizes.begin(), kPinSizes.end(), [&](const PinSize& pin) {
        return std::abs(size.outer - pin.nominal * kMm) < kNominal * pin.nominal * kMm;
      });
  if (found != kPinSizes.end()) {
    elastic.free_size = 0.5 * (found->least + found->largest) * kMm;
    elastic.thickness = found->wall * kMm;  // It may be drawn solid.
  }
  SetSpringMaterial(part, &elastic);
  return elastic;
}

ElasticPart MeasureSleeve(const Part& part) {
  ElasticPart elastic;
  const RoundSize size = MeasureRound(part, FindAxis(part));
  SetRound(size, &elastic);
  elastic.free_size = size.outer;
  elastic.thickness = 0.5 * (size.outer - size.inner);
  SetSealMaterial(part, &elastic);
  return elastic;
}

/** What a line from the axis of a ring outwards meets first of it. */
struct Wall {
  double height{0};     // Of the line, along the axis from the centre [m].
  double inner{0};      // Radius at which it begins [m].
  double thickness{0};  // [m]; 0: nothing is there.
};

/** The walls inside of a ring, from one end of it to the other. */
std::vector<Wall> ListInnerWalls(const Part& part, const RoundSize& size) {
  constexpr int kLines = 96;  // Along the axis: a lip is some tenth of a seal. A choice.
  const Vec3 u = size.axis_B.unitOrthogonal();
  const Vec3 v = size.axis_B.cross(u);
  const Vec3 out = std::cos(0.31) * u + std::sin(0.31) * v;  // Off edges of the mesh.
  std::vector<Wall> walls;
  for (int i = 0; i < kLines; ++i) {
    Wall wall;
    wall.height = size.length * ((i + 0.5) / kLines - 0.5);
    const std::vector<Crossing> crossings =
        ListCrossings(part, size.centre_B + wall.height * size.axis_B, out, size.outer);
    if (crossings.size() >= 2 && crossings[0].is_entering) {
      wall.inner = crossings[0].distance;
      wall.thickness = crossings[1].distance - crossings[0].distance;
    }
    walls.push_back(wall);
  }
  return walls;
}

/** Follows the wall from the narrowest place to one side, until it is a body that bears it.
 @returns whether it comes to one; the walls between are those of an arm. */
bool FollowLip(const std::vector<Wall>& walls, std::size_t narrowest, int side,
               std::vector<Wall>* arm) {
  constexpr double kThick = 2.5;  // Times the thinnest wall, as of arms that bend. A choice.
  double thinnest = walls[narrowest].thickness;
  arm->assign(1, walls[narrowest]);
  for (std::size_t i = narrowest + static_cast<std::size_t>(side); i < walls.size();
       i += static_cast<std::size_t>(side)) {
    if (!(walls[i].thickness > 0)) {
      return false;
    }
    if (walls[i].thickness > kThick * thinnest) {
      return true;
    }
    thinnest = std::min(thinnest, walls[i].thickness);
    arm->push_back(walls[i]);
  }
  return false;
}

/** The lip of a seal: the wall that goes from its narrowest place to the ring's body. Its thickness
 is the mean along it. */
void MeasureLip(const Part& part, const RoundSize& size, ElasticPart* seal) {
  const std::vector<Wall> walls = ListInnerWalls(part, size);
  std::size_t narrowest = walls.size();
  for (std::size_t i = 0; i < walls.size(); ++i) {
    if (walls[i].thickness > 0 &&
        (narrowest == walls.size() || walls[i].inner < walls[narrowest].inner)) {
      narrowest = i;
    }
  }
  if (narrowest == walls.size()) {
    return;
  }
  seal->lip_at = walls[narrowest].height;
  seal->lip_root = seal->lip_at;
  std::vector<Wall> longest;
  int to_root = 1;
  for (const int side : {1, -1}) {
    std::vector<Wall> arm;
    if (FollowLip(walls, narrowest, side, &arm) && arm.size() > longest.size()) {
      longest = arm;
      to_root = side;
    }
  }
  double sum = 0;
  for (const Wall& wall : longest) {
    sum += wall.thickness;
    seal->lip_radius = std::max(seal->lip_radius, wall.inner + wall.thickness);
  }
  const double step = size.length / static_cast<double>(walls.size());
  const double length = step * static_cast<double>(longest.size());
  const double thickness = longest.empty() ? 0 : sum / static_cast<double>(longest.size());
  if (length > thickness) {  // What is thicker than long does not bend.
    seal->lip_root = seal->lip_at + to_root * length;
    seal->thickness = thickness;
  }
}

ElasticPart MeasureLipSeal(const Part& part) {
  ElasticPart elastic;
  const RoundSize size = MeasureRound(part, FindAxis(part));
  SetRound(size, &elastic);
  elastic.free_size = size.inner;
  MeasureLip(part, size, &elastic);
  SetSealMaterial(part, &elastic);
  return elastic;
}

bool IsTube(const Part& part, const ElasticPart& sleeve) {
  constexpr double kTubeVolume = 0.15;  // Collars and lips are more. A choice.
  constexpr double kThinnest = 0.02;    // Bore over the outer diameter: a solid has none. A choice.
  const double volume = 0.25 * std::numbers::pi * sleeve.length *
                        (sleeve.outer * sleeve.outer - sleeve.inner * sleeve.inner);
  return sleeve.inner > kThinnest * sleeve.outer && volume > 0 &&
         std::abs(part.mass.volume - volume) < kTubeVolume * volume;
}

/** A ring between cones that is higher than it is thick. */
bool IsConeRing(const Part& part, const ElasticPart& disc) {
  constexpr std::size_t kMostDiscFaces = 12;  // With rounded edges. A choice.
  constexpr double kLowest = 0.15;            // h_0 / t; DIN 2093 has 0.4 to 1.3.
  constexpr double kHighest = 1.6;            // The same, with room above. A choice.
  constexpr double kThickest = 0.12;          // t / D_e; DIN 2093 has 1/18 to 1/40.
  constexpr double kLeastRatio = 1.4;         // D_e / D_i; DIN 2093 has 1.9 to 2.
  constexpr double kMostRatio = 3.5;          // The same, with room above. A choice.
  const double cone = disc.length - disc.thickness;
  const auto cones = std::count_if(part.faces.begin(), part.faces.end(), [&](const Face& face) {
    return face.surface.kind == SurfaceKind::kCone &&
           face.surface.axis.cross(disc.axis_B).norm() < 1e-3;
  });
  return part.faces.size() <= kMostDiscFaces && cones >= 2 && cone > kLowest * disc.thickness &&
         cone < kHighest * disc.thickness && disc.thickness < kThickest * disc.outer &&
         disc.outer > kLeastRatio * disc.inner && disc.outer < kMostRatio * disc.inner;
}

bool IsRing(const ElasticPart& ring) {
  return ring.inner > 0.2 * ring.outer && ring.length < ring.outer;  // A washer. Choices.
}

ElasticPart WithReason(ElasticPart elastic, const char* reason) {
  elastic.reason = reason;
  return elastic;
}

std::optional<ElasticPart> FindByName(const Part& part, const std::string& name) {
  if (HasOneOf(name, kSlitNames)) {
    return WithReason(MeasureElasticPart(ElasticKind::kSlitPin, part), "its name");
  }
  if (HasOneOf(name, kDiscNames)) {
    const ElasticPart disc = MeasureElasticPart(ElasticKind::kDiscSpring, part);
    return IsRing(disc) ? std::optional(WithReason(disc, "its name")) : std::nullopt;
  }
  if (HasOneOf(name, kLockNames)) {
    const ElasticPart washer = MeasureElasticPart(ElasticKind::kLockWasher, part);
    return IsRing(washer) ? std::optional(WithReason(washer, "its name")) : std::nullopt;
  }
  if (HasOneOf(name, kLeafNames)) {
    return WithReason(MeasureElasticPart(ElasticKind::kLeafSpring, part), "its name");
  }
  const std::optional<FlexiblePart> flexible = ClassifyFlexibleByWords(part);
  if (flexible && flexible->kind == FlexibleKind::kGasket) {
    const ElasticPart gasket = MeasureElasticPart(ElasticKind::kGasket, part);
    return IsSheet(part, gasket)
               ? std::optional(WithReason(gasket, "its name, and the form of a sheet"))
               : std::nullopt;
  }
  if (flexible && flexible->kind == FlexibleKind::kLipSeal) {
    const ElasticPart seal = MeasureElasticPart(ElasticKind::kLipSeal, part);
    return IsRing(seal) ? std::optional(WithReason(seal, "its name, and the form of a ring"))
                        : std::nullopt;
  }
  if (flexible && flexible->kind == FlexibleKind::kRubber) {
    const ElasticPart sleeve = MeasureElasticPart(ElasticKind::kSleeve, part);
    return IsTube(part, sleeve)
               ? std::optional(WithReason(sleeve, "its rubber, and the form of a tube"))
               : std::nullopt;
  }
  return std::nullopt;
}

/** Lines through its mesh are only worth it where it may be a coil: it fills little of its tube. */
bool MayBeCoil(const Part& part, const RoundSize& size) {
  constexpr double kMostFilled = 0.8;    // pi / 4 where its coils touch.
  constexpr double kLargestBore = 0.95;  // Bore over outside: coils of thicker wire. A choice.
  return size.inner > 0 && size.inner < kLargestBore * size.outer && part.mass.volume > 0 &&
         part.mass.volume < kMostFilled * size.ring_area() * size.length;
}

/** Its volume, as a wire, is long enough for some turns that have room behind each other. */
bool HasVolumeOfCoil(const RoundSize& size) {
  constexpr double kFewestTurns = 1.5;  // Two, less what the mesh makes thinner. A choice.
  constexpr double kShareOfTurn =
      0.8;  // Of the wire, that each turn takes of the length. A choice.
  const double wire = 0.5 * (size.outer - size.inner);
  const double mean = 0.5 * (size.outer + size.inner);
  if (!(wire > 0) || !(size.inner > wire)) {
    return false;
  }
  const double turns =
      size.volume / (0.25 * std::numbers::pi * wire * wire * std::numbers::pi * mean);
  return turns > kFewestTurns && turns * kShareOfTurn * wire < size.length;
}

std::optional<ElasticPart> FindByForm(const Part& part, const std::string& name) {
  const RoundSize first = MeasureRound(part, FindAxis(part));
  if (!(first.outer > 0) || !(first.inner > 0)) {
    return std::nullopt;
  }
  if (MayBeCoil(part, first) && !HasOneOf(name, kPullNames)) {
    const RoundSize size = MeasureThinnest(part, first.axis_B);
    const CoilCount count = HasVolumeOfCoil(size) ? CountCoils(part, size) : CoilCount();
    if (IsCoil(size, count)) {
      return WithReason(MakeCoil(part, size, count), "its form, a coil of wire");
    }
  }
  const ElasticPart disc = MeasureElasticPart(ElasticKind::kDiscSpring, part);
  if (IsConeRing(part, disc)) {
    return WithReason(disc, "its form, a cone");
  }
  return std::nullopt;
}

}  // namespace

const char* ToString(ElasticKind kind) {
  switch (kind) {
    case ElasticKind::kCoilSpring:
      return "coil spring";
    case ElasticKind::kDiscSpring:
      return "disc spring";
    case ElasticKind::kLockWasher:
      return "lock washer";
    case ElasticKind::kLeafSpring:
      return "leaf spring";
    case ElasticKind::kGasket:
      return "gasket";
    case ElasticKind::kSlitPin:
      return "slit pin";
    case ElasticKind::kLipSeal:
      return "lip seal";
    case ElasticKind::kSleeve:
      break;
  }
  return "rubber sleeve";
}

ElasticPart MeasureElasticPart(ElasticKind kind, const Part& part) {
  ElasticPart elastic;
  switch (kind) {
    case ElasticKind::kCoilSpring:
      elastic = MeasureCoil(part);
      break;
    case ElasticKind::kDiscSpring:
      elastic = MeasureDisc(part);
      break;
    case ElasticKind::kLockWasher:
      elastic = MeasureLockWasher(part);
      break;
    case ElasticKind::kLeafSpring:
      elastic = MeasureLeaf(part);
      break;
    case ElasticKind::kGasket:
      elastic = MeasureGasket(part);
      break;
    case ElasticKind::kSlitPin:
      elastic = MeasureSlitPin(part);
      break;
    case ElasticKind::kSleeve:
      elastic = MeasureSleeve(part);
      break;
    case ElasticKind::kLipSeal:
      elastic = MeasureLipSeal(part);
      break;
  }
  elastic.kind = kind;
  return elastic;
}

std::optional<ElasticPart> FindElasticPart(const Part& part) {
  const std::string name = FoldName(part.name);
  if (auto by_name = FindByName(part, name)) {
    return by_name;
  }
  return FindByForm(part, name);
}

const ElasticPart* FindElastic(const Product& product, OccurrenceId id) {
  const auto found = std::find_if(product.elastic.begin(), product.elastic.end(),
                                  [id](const ElasticPart& part) { return part.occurrence == id; });
  return found == product.elastic.end() ? nullptr : &*found;
}

}  // namespace hvas::product
