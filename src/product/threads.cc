#include "product/threads.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/units.h"
#include "product/axis_features.h"
#include "product/fastener_name.h"

namespace hvas::product {
namespace {

constexpr double kLeastPitch = 0.04;    // Of the diameter (M64x3 has 0.047).
constexpr double kLargestPitch = 0.4;   // Of the diameter (M1 has 0.25, wood screws up to 0.45).
constexpr double kLeastTurns = 1.5;     // Of a helical face, or of all that have one pitch.
constexpr double kHelixResidual = 0.2;  // RMS, relative; run-outs and coarse meshes are in it.
constexpr double kNearDiameter = 0.02;  // A drawn diameter that stands for a nominal one.

/** All holes, shafts and cones on one line. */
struct Line {
  Vec3 origin;
  Vec3 axis;
  std::vector<std::size_t> features;
};

std::vector<Line> CollectLines(const Part& part, double tolerance, RecognitionLimits* limits) {
  constexpr std::size_t kMost = 300;  // More axes than any fastener has.
  std::vector<Line> lines;
  for (std::size_t i = 0; i < part.features.size(); ++i) {
    const Feature& feature = part.features[i];
    if (!IsCylinder(feature.kind) && !IsCone(feature.kind)) {
      continue;
    }
    auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& l) {
      return IsParallel(l.axis, feature.axis_B) &&
             DistanceToAxis(feature.origin_B, l.origin, l.axis) < 2 * tolerance;
    });
    if (line == lines.end()) {
      if (lines.size() >= kMost) {
        limits->Add("more than 300 axes for threads");
        continue;
      }
      lines.push_back({feature.origin_B, Canonical(feature.axis_B), {}});
      line = std::prev(lines.end());
    }
    line->features.push_back(i);
  }
  return lines;
}

/** Extent of a feature along a line that it is on. */
std::pair<double, double> CalcSpan(const Feature& feature, const Line& line) {
  const Vec3 a = feature.origin_B + feature.span_low * feature.axis_B - line.origin;
  const Vec3 b = feature.origin_B + feature.span_high * feature.axis_B - line.origin;
  return std::minmax(a.dot(line.axis), b.dot(line.axis));
}

/** Sums for the pitch of freeform faces about one axis: with a = n.(w x r) and b = n.w the pitch
 parameter h minimises the sum of (a + h b)^2 over their area. */
struct HelixSums {
  double aa{0}, ab{0}, bb{0};
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};
  double inner{std::numeric_limits<double>::infinity()};
  double outer{0};

  void Add(const HelixSums& other) {
    aa += other.aa;
    ab += other.ab;
    bb += other.bb;
    low = std::min(low, other.low);
    high = std::max(high, other.high);
    inner = std::min(inner, other.inner);
    outer = std::max(outer, other.outer);
  }

  [[nodiscard]] double pitch() const { return bb > 0 ? units::kTurn * std::abs(ab / bb) : 0; }

  /** The parameter h is -ab / bb, positive for a right-handed thread. */
  [[nodiscard]] bool is_left_handed() const { return ab > 0; }

  /** Whether the normals fit the pitch, and would not fit a surface of revolution (a = 0). */
  [[nodiscard]] bool IsHelical() const {
    const double rest = bb > 0 ? aa - ab * ab / bb : aa;
    return aa > 0 && rest <= kHelixResidual * kHelixResidual * aa;
  }
};

/** Stops early, with an outer radius beyond `reach`, at a face that goes farther out. */
HelixSums SumFace(const Part& part, const Face& face, const Line& line, double reach) {
  HelixSums sums;
  for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count; ++t) {
    const auto& triangle = part.mesh.triangles[t];
    const Vec3& p = part.mesh.vertices[triangle[0]];
    const Vec3& q = part.mesh.vertices[triangle[1]];
    const Vec3& r = part.mesh.vertices[triangle[2]];
    const Vec3 normal = (q - p).cross(r - p);
    const double twice_area = normal.norm();
    if (!(twice_area > 0)) {
      continue;
    }
    const Vec3 c = (p + q + r) / 3 - line.origin;
    const double a = normal.dot(line.axis.cross(c)) / twice_area;
    const double b = normal.dot(line.axis) / twice_area;
    sums.aa += twice_area * a * a;
    sums.ab += twice_area * a * b;
    sums.bb += twice_area * b * b;
    for (const Vec3* vertex : {&p, &q, &r}) {
      const Vec3 offset = *vertex - line.origin;
      const double z = offset.dot(line.axis);
      const double radius = (offset - z * line.axis).norm();
      sums.low = std::min(sums.low, z);
      sums.high = std::max(sums.high, z);
      sums.inner = std::min(sums.inner, radius);
      sums.outer = std::max(sums.outer, radius);
    }
    if (sums.outer > reach) {
      break;
    }
  }
  return sums;
}

/** Pitch of the helical faces around a line, with the extent and radii of them all. */
std::optional<HelixSums> FindHelix(const Part& part, const Line& line) {
  double reach = 0;
  for (const std::size_t i : line.features) {
    reach = std::max(reach, 1.5 * part.features[i].radius);
  }
  HelixSums all;
  for (const Face& face : part.faces) {
    if (face.surface.kind != SurfaceKind::kFreeform || face.triangle_count == 0 ||
        DistanceToAxis(face.box_B.centre(), line.origin, line.axis) > reach) {
      continue;
    }
    const HelixSums sums = SumFace(part, face, line, reach);
    if (sums.outer <= reach && sums.IsHelical() && sums.pitch() >= kLeastPitch * 2 * sums.outer &&
        sums.pitch() <= kLargestPitch * 2 * sums.outer) {
      all.Add(sums);
    }
  }
  const bool is_thread = all.aa > 0 && all.IsHelical() &&
                         all.high - all.low >= kLeastTurns * all.pitch() &&
                         all.pitch() >= kLeastPitch * 2 * all.outer;
  return is_thread ? std::optional(all) : std::nullopt;
}

/** Pitch of rings drawn for a thread: five or more cones of one angle and nappe on a line, evenly
 spaced, with as many of the other nappe between them. */
std::optional<HelixSums> FindRingThread(const Part& part, const Line& line) {
  // Cones of each nappe (docs/algorithms/features.md, "Threads").
  constexpr std::size_t kLeastRings = 5;
  std::vector<std::pair<double, double>> spans[2];
  HelixSums all;
  for (const std::size_t i : line.features) {
    const Feature& feature = part.features[i];
    if (IsCone(feature.kind)) {
      const auto span = CalcSpan(feature, line);
      spans[feature.axis_B.dot(line.axis) > 0 ? 1 : 0].push_back(span);
      all.low = std::min(all.low, span.first);
      all.high = std::max(all.high, span.second);
      all.outer = std::max(all.outer, feature.radius);
      all.inner = std::min(all.inner, feature.span_low * std::tan(feature.half_angle));
    }
  }
  const auto find_spacing = [](std::vector<std::pair<double, double>>& rows) {
    std::sort(rows.begin(), rows.end());
    if (rows.size() < kLeastRings) {
      return 0.0;
    }
    const double step = rows[rows.size() / 2].first - rows[rows.size() / 2 - 1].first;
    std::size_t even = 0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      even += std::abs(rows[i].first - rows[i - 1].first - step) < 0.02 * step ? 1 : 0;
    }
    return even + 3 >= rows.size() && even + 1 >= kLeastRings ? step : 0.0;
  };
  const double up = find_spacing(spans[1]);
  const double down = find_spacing(spans[0]);
  if (!(up > 0) || std::abs(up - down) > 0.02 * up || up > kLargestPitch * 2 * all.outer) {
    return std::nullopt;
  }
  all.ab = up / units::kTurn;  // So that pitch() tells it.
  all.bb = 1;
  return all;
}

/** Marks the cylinders of a line that a modelled thread lies on: within its radii, or its core or
 blank, and along it. */
bool MarkModelled(const HelixSums& helix, const Line& line, Part* part) {
  bool is_marked = false;
  const double slack = 0.1 * helix.outer;
  for (const std::size_t i : line.features) {
    Feature& feature = part->features[i];
    if (!IsCylinder(feature.kind)) {
      continue;
    }
    const auto [low, high] = CalcSpan(feature, line);
    const double common = std::min(high, helix.high) - std::max(low, helix.low);
    if (feature.radius > helix.inner - slack && feature.radius < helix.outer + slack &&
        common > 0.5 * std::min(high - low, helix.high - helix.low)) {
      feature.thread = ThreadKind::kModelled;
      feature.thread_pitch = helix.pitch();
      is_marked = true;
    }
  }
  return is_marked;
}

/** Six flats at 60 deg around a line, at one distance from it. */
struct Hexagon {
  double inner_radius{0};  // Half the width across flats [m].
  double low{0}, high{0};
  bool is_socket{false};
};

std::vector<Hexagon> FindHexagons(const Part& part, const Line& line, double tolerance) {
  struct Flat {
    double distance{0};
    double angle{0};
    double low{0}, high{0};
  };

  std::vector<Flat> flats;
  const Mat3 R = spatial::FrameFromZ(line.axis).toRotationMatrix();
  for (const Face& face : part.faces) {
    if (face.surface.kind != SurfaceKind::kPlane || face.triangle_count == 0 ||
        std::abs(face.surface.axis.dot(line.axis)) > 1e-3) {
      continue;
    }
    const Vec3 n = R.transpose() * face.surface.axis;
    Flat flat{(face.surface.origin - line.origin).dot(face.surface.axis), std::atan2(n.y(), n.x()),
              std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count;
         ++t) {
      for (const std::uint32_t v : part.mesh.triangles[t]) {
        const double z = (part.mesh.vertices[v] - line.origin).dot(line.axis);
        flat.low = std::min(flat.low, z);
        flat.high = std::max(flat.high, z);
      }
    }
    flats.push_back(flat);
  }
  std::stable_sort(flats.begin(), flats.end(),
                   [](const Flat& a, const Flat& b) { return a.distance < b.distance; });
  std::vector<Hexagon> found;
  const double slack = 4 * tolerance;
  for (std::size_t begin = 0; begin < flats.size();) {
    std::size_t end = begin;
    while (end < flats.size() && flats[end].distance < flats[begin].distance + slack) {
      ++end;
    }
    // Every flat must be at a multiple of 60 deg from the first, all six must be there.
    unsigned seen = 0;
    bool is_even = end - begin >= 6 && std::abs(flats[begin].distance) > slack;
    Hexagon hexagon{std::abs(flats[begin].distance), flats[begin].low, flats[begin].high,
                    flats[begin].distance < 0};
    for (std::size_t i = begin; i < end && is_even; ++i) {
      const double sixths = 6 * (flats[i].angle - flats[begin].angle) / units::kTurn;
      is_even = std::abs(sixths - std::round(sixths)) < 0.01;
      seen |= 1U << static_cast<unsigned>((std::lround(sixths) % 6 + 6) % 6);
      hexagon.low = std::min(hexagon.low, flats[i].low);
      hexagon.high = std::max(hexagon.high, flats[i].high);
    }
    if (is_even && seen == 0x3F) {
      found.push_back(hexagon);
    }
    begin = end;
  }
  return found;
}

void MarkNominal(Feature* feature, const std::optional<ThreadSize>& stated) {
  feature->thread = ThreadKind::kNominal;
  if (stated && stated->pitch > 0) {
    feature->thread_pitch = stated->pitch;
  } else {
    feature->thread_pitch =
        FindCoarsePitch(2 * feature->radius, kNearDiameter * 2 * feature->radius);
  }
}

/** The shank of a screw: the shaft at the end away from the widest thing on its line. @param wide
 Where the head is along the line; none where the screw has no head. */
std::optional<std::size_t> FindShank(const Part& part, const Line& line,
                                     std::optional<double> head) {
  std::optional<std::size_t> shank;
  double farthest = 0;
  for (const std::size_t i : line.features) {
    const Feature& feature = part.features[i];
    if (feature.kind != FeatureKind::kShaft) {
      continue;
    }
    const auto [low, high] = CalcSpan(feature, line);
    // Necks, tips and collars are shorter than half their diameter.
    if (high - low < feature.radius) {
      continue;
    }
    const double distance = head ? std::abs(0.5 * (low + high) - *head) : high - low;
    if (!shank || distance > farthest) {
      shank = i;
      farthest = distance;
    }
  }
  return shank;
}

/** The line with most of the part's round area. */
std::optional<std::size_t> FindMainLine(const Part& part, const std::vector<Line>& lines,
                                        FeatureKind kind) {
  std::optional<std::size_t> best;
  double largest = 0;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    double area = 0;
    for (const std::size_t i : lines[k].features) {
      area += part.features[i].kind == kind ? part.features[i].area : 0;
    }
    if (area > largest) {
      largest = area;
      best = k;
    }
  }
  return best;
}

/** Middle of the head along the line: the widest shaft or hexagon, where it is wider than the
 slimmest shaft. */
std::optional<double> FindHead(const Part& part, const Line& line,
                               const std::vector<Hexagon>& hexagons) {
  double slim = std::numeric_limits<double>::infinity();
  double wide = 0;
  double middle = 0;
  const auto look = [&](double radius, double low, double high) {
    if (radius > wide) {
      wide = radius;
      middle = 0.5 * (low + high);
    }
  };
  for (const std::size_t i : line.features) {
    const Feature& feature = part.features[i];
    if (feature.kind == FeatureKind::kShaft || feature.kind == FeatureKind::kTaper) {
      const auto [low, high] = CalcSpan(feature, line);
      look(feature.radius, low, high);
      slim = feature.kind == FeatureKind::kShaft ? std::min(slim, feature.radius) : slim;
    }
  }
  for (const Hexagon& hexagon : hexagons) {
    if (!hexagon.is_socket) {
      look(hexagon.inner_radius, hexagon.low, hexagon.high);
    }
  }
  constexpr double kHeaded = 1.2;  // A head is so many times as wide as the shank: a choice.
  return wide > kHeaded * slim ? std::optional(middle) : std::nullopt;
}

void MarkScrew(const std::vector<Line>& lines, const std::optional<ThreadSize>& size,
               double tolerance, Part* part) {
  const auto main = FindMainLine(*part, lines, FeatureKind::kShaft);
  if (!main) {
    return;
  }
  const Line& line = lines[*main];
  if (size) {  // The name says which: drawn as the major or the minor diameter.
    constexpr double kMinor = 0.75;  // Least share of the major diameter: a choice.
    bool is_marked = false;
    for (const std::size_t i : line.features) {
      Feature& feature = part->features[i];
      const double ratio = 2 * feature.radius / size->diameter;
      const auto [low, high] = CalcSpan(feature, line);
      if (feature.kind == FeatureKind::kShaft && ratio >= kMinor && ratio <= 1 + kNearDiameter &&
          high - low >= feature.radius && feature.thread == ThreadKind::kNone) {
        MarkNominal(&feature, size);
        is_marked = true;
      }
    }
    if (is_marked) {
      return;
    }
  }
  const auto head = FindHead(*part, line, FindHexagons(*part, line, tolerance));
  if (const auto shank = FindShank(*part, line, head)) {
    MarkNominal(&part->features[*shank], std::nullopt);
  }
}

void MarkNut(const std::vector<Line>& lines, const std::optional<ThreadSize>& size, Part* part) {
  const auto main = FindMainLine(*part, lines, FeatureKind::kHole);
  if (!main) {
    return;
  }
  // Its longest bore; the slimmest of equally long ones.
  std::optional<std::size_t> bore;
  for (const std::size_t i : lines[*main].features) {
    const Feature& feature = part->features[i];
    if (feature.kind == FeatureKind::kHole &&
        (!bore || feature.span_high > 1.01 * part->features[*bore].span_high ||
         (feature.span_high > 0.99 * part->features[*bore].span_high &&
          feature.radius < part->features[*bore].radius))) {
      bore = i;
    }
  }
  if (bore) {
    MarkNominal(&part->features[*bore], size);
  }
}

/** Whether a shank may belong to a hexagonal head (1.5 to 1.85 of its diameter across flats in ISO
 4014, up to 2.3 drawn with its minor diameter) or socket (0.5 in ISO 4026 to 0.85 in ISO 4762); a
 trap for a nut in a knob is wider than the knob's stem. */
bool FitsHexagon(double radius, const std::vector<Hexagon>& hexagons) {
  return std::any_of(hexagons.begin(), hexagons.end(), [radius](const Hexagon& hexagon) {
    const double ratio = hexagon.inner_radius / radius;
    return hexagon.is_socket ? ratio > 0.4 && ratio < 1.1 : ratio > 1.3 && ratio < 2.5;
  });
}

/** Whether hexagons on a line are the part's own, not a boss on something larger: nothing of the
 part may be farther across than a screw's head or a nut's corners and flange are.
 @param widest  Largest radius on the line [m]. */
bool IsWholePart(const Part& part, const Line& line, double widest) {
  double reach = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) != 0 ? part.box_B.high.x() : part.box_B.low.x(),
                 (corner & 2) != 0 ? part.box_B.high.y() : part.box_B.low.y(),
                 (corner & 4) != 0 ? part.box_B.high.z() : part.box_B.low.z());
    reach = std::max(reach, DistanceToAxis(p, line.origin, line.axis));
  }
  constexpr double kBoxCorner = 1.7;  // Of a flange's or hexagon's box, over its own radius.
  return part.box_B.size().norm() > 0 && reach <= kBoxCorner * widest;
}

/** Finds the bore of a nut: a hole through its hexagon. */
std::optional<std::size_t> FindNutBore(const Part& part, const Line& line, const Hexagon& outer) {
  for (const std::size_t i : line.features) {
    const Feature& feature = part.features[i];
    const double ratio = feature.radius / outer.inner_radius;
    if (feature.kind == FeatureKind::kHole && ratio > 0.4 && ratio < 0.72 &&
        feature.span_high - feature.span_low > 0.5 * (outer.high - outer.low)) {
      return i;
    }
  }
  return std::nullopt;
}

/** Whether flats go all along a part: those of a hub's bore, not of a screw's socket. */
bool GoesThrough(const Part& part, const Line& line, const Hexagon& hexagon) {
  constexpr double kAllAlong = 0.9;  // Of the part: mouths are chamfered. A choice.
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Vec3& vertex : part.mesh.vertices) {
    const double at = (vertex - line.origin).dot(line.axis);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return hexagon.high - hexagon.low > kAllAlong * (high - low);
}

/** Finds the thread of a fastener with hexagons on a line: its shank, or the bore of a nut. */
std::optional<std::size_t> FindThreadAtHexagons(const Part& part, const Line& line,
                                                const std::vector<Hexagon>& hexagons) {
  const auto outer =
      std::find_if(hexagons.begin(), hexagons.end(), [](const Hexagon& h) { return !h.is_socket; });
  const bool has_outer = outer != hexagons.end();
  const bool has_socket =
      std::any_of(hexagons.begin(), hexagons.end(), [](const Hexagon& h) { return h.is_socket; });
  double widest = has_outer ? outer->inner_radius : 0;
  for (const std::size_t i : line.features) {
    widest = std::max(widest, part.features[i].radius);
  }
  if (!IsWholePart(part, line, widest)) {
    return std::nullopt;
  }
  const auto head = FindHead(part, line, hexagons);
  const auto shank = FindShank(part, line, head);
  if (shank && (has_socket || head) && FitsHexagon(part.features[*shank].radius, hexagons)) {
    return *shank;
  }
  return has_outer && !shank ? FindNutBore(part, line, *outer) : std::nullopt;
}

/** By shape alone: hexagonal heads, sockets and nuts. Dowels and shafts have none of them. */
void MarkByShape(const std::vector<Line>& lines, double tolerance, Part* part) {
  constexpr std::size_t kMostFaces = 400;  // Of a fastener.
  if (part->faces.size() > kMostFaces) {
    return;
  }
  for (const Line& line : lines) {
    std::vector<Hexagon> hexagons = FindHexagons(*part, line, tolerance);
    std::erase_if(hexagons, [&](const Hexagon& hexagon) {
      return hexagon.is_socket && GoesThrough(*part, line, hexagon);
    });
    const auto thread =
        hexagons.empty() ? std::nullopt : FindThreadAtHexagons(*part, line, hexagons);
    if (thread) {
      MarkNominal(&part->features[*thread], std::nullopt);
      return;
    }
  }
}

}  // namespace

void MarkThreads(Part* part, double tolerance, RecognitionLimits* limits) {
  const std::vector<Line> lines = CollectLines(*part, tolerance, limits);
  bool is_modelled = false;
  const bool has_freeform = std::any_of(part->faces.begin(), part->faces.end(), [](const Face& f) {
    return f.surface.kind == SurfaceKind::kFreeform;
  });
  for (const Line& line : lines) {
    auto helix = has_freeform ? FindHelix(*part, line) : std::nullopt;
    if (!helix) {
      helix = FindRingThread(*part, line);
    }
    if (helix && MarkModelled(*helix, line, part)) {
      is_modelled = true;
    }
  }
  if (is_modelled) {
    return;
  }
  const auto size = ParseThreadSize(part->name);
  switch (ClassifyName(part->name)) {
    case FastenerKind::kScrew:
      MarkScrew(lines, size, tolerance, part);
      break;
    case FastenerKind::kNut:
      MarkNut(lines, size, part);
      break;
    case FastenerKind::kNone:
      MarkByShape(lines, tolerance, part);
      break;
  }
}

bool IsLeftHanded(const Part& part, const Feature& feature) {
  Line line{feature.origin_B, Canonical(feature.axis_B), {}};
  for (std::size_t i = 0; i < part.features.size(); ++i) {
    if (&part.features[i] == &feature) {
      line.features.push_back(i);
    }
  }
  const auto helix = FindHelix(part, line);
  return helix && helix->is_left_handed();
}

}  // namespace hvas::product
