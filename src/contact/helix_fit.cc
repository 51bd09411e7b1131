#include "contact/helix_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "base/units.h"
#include "spatial/box.h"

namespace hvas::contact {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr std::size_t kMaxAxes = 8;  // Those of the most area are looked at. A choice.

struct Axis {
  Vec3 origin{Vec3::Zero()};
  Vec3 direction{Vec3::UnitZ()};
  double area{0};
};

/** A triangle of the mesh about an axis. */
struct Facet {
  std::uint32_t triangle{0};
  double radius{0};  // Of its middle.
  double area{0};
  double pitch{0};  // With the sign of the sense; 0 where it has none.
};

double CalcArea(const Mesh& mesh, std::uint32_t t) {
  const auto& v = mesh.triangles[t];
  const Vec3& a = mesh.vertices[v[0]];
  return 0.5 * (mesh.vertices[v[1]] - a).cross(mesh.vertices[v[2]] - a).norm();
}

/** The axes of the faces of revolution, each once, those with the most area first. */
std::vector<Axis> ListAxes(const Mesh& mesh, const std::vector<spatial::Surface>& faces,
                           double size) {
  constexpr double kSameDirection = 2e-3;  // [rad]
  constexpr double kSamePlace = 2e-3;      // Of the part's size. Both are choices.
  std::vector<double> area(faces.size(), 0.0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    area[mesh.face[t]] += CalcArea(mesh, t);
  }
  std::vector<Axis> axes;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const spatial::Surface& face = faces[f];
    if (face.kind != spatial::SurfaceKind::kCylinder && face.kind != spatial::SurfaceKind::kCone) {
      continue;
    }
    const auto same = std::find_if(axes.begin(), axes.end(), [&](const Axis& axis) {
      const Vec3 d = face.origin - axis.origin;
      return axis.direction.cross(face.axis).norm() < kSameDirection &&
             axis.direction.cross(d).norm() < kSamePlace * size;
    });
    if (same == axes.end()) {
      axes.push_back({face.origin, face.axis, area[f]});
    } else {
      same->area += area[f];
    }
  }
  std::stable_sort(axes.begin(), axes.end(),
                   [](const Axis& a, const Axis& b) { return a.area > b.area; });
  axes.resize(std::min(axes.size(), kMaxAxes));
  return axes;
}

std::vector<Facet> ListFacets(const Mesh& mesh, const Axis& axis) {
  constexpr double kFlat = 0.1;    // Cosine: less along the axis tells no pitch.
  constexpr double kLevel = 2e-3;  // Tangent of the rise: less is a surface of revolution.
  // Both are choices: threads rise by a hundredth at least, and their flanks lean.
  std::vector<Facet> facets;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    const Vec3 d =
        (mesh.vertices[v[0]] + mesh.vertices[v[1]] + mesh.vertices[v[2]]) / 3 - axis.origin;
    Facet facet;
    facet.triangle = t;
    const Vec3 across = d - d.dot(axis.direction) * axis.direction;
    facet.radius = across.norm();
    if (facet.radius <= 0) {
      continue;
    }
    facet.area = CalcArea(mesh, t);
    const Vec3 n = mesh.NormalOf(t);
    const double along = n.dot(axis.direction);
    const double around = n.dot(axis.direction.cross(across)) / facet.radius;
    if (std::abs(along) > kFlat && std::abs(around) > kLevel * std::abs(along) &&
        std::abs(around) < std::abs(along)) {
      facet.pitch = -units::kTurn * facet.radius * around / along;
    }
    facets.push_back(facet);
  }
  return facets;
}

/** The pitch around which the most area is, and that area. The two triangles of a facet with four
 corners lean to either side of it. */
std::pair<double, double> FindPitch(const std::vector<Facet>& facets) {
  constexpr double kWidest = 1.5;  // Largest pitch over the least one. A choice.
  std::vector<std::pair<double, const Facet*>> pitches;
  for (const Facet& facet : facets) {
    if (facet.pitch != 0) {
      pitches.emplace_back(facet.pitch, &facet);
    }
  }
  std::stable_sort(pitches.begin(), pitches.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  // Sums of a window's area, and of its area times the pitch.
  double area = 0;
  double moment = 0;
  std::pair<double, double> best{0, 0};
  const auto is_together = [](double a, double b) {
    return a * b > 0 &&
           std::max(std::abs(a), std::abs(b)) <= kWidest * std::min(std::abs(a), std::abs(b));
  };
  for (std::size_t begin = 0, end = 0; end < pitches.size(); ++end) {
    area += pitches[end].second->area;
    moment += pitches[end].second->area * pitches[end].first;
    for (; !is_together(pitches[begin].first, pitches[end].first); ++begin) {
      area -= pitches[begin].second->area;
      moment -= pitches[begin].second->area * pitches[begin].first;
    }
    if (area > best.second) {
      best = {moment / area, area};
    }
  }
  return best;
}

/** A vertex in the coordinates of a helix. */
struct Place {
  double z{0};  // Along the axis at azimuth zero, not reduced to a pitch.
  double r{0};
  double height{0};
};

Place PlaceOf(const Helix& helix, const Vec3& p) {
  const HelixPoint at = Locate(helix, p);
  const double azimuth =
      std::atan2(at.radial.dot(helix.axis.cross(helix.u)), at.radial.dot(helix.u));
  return {at.height - helix.sense * helix.pitch * azimuth / units::kTurn, at.radius, at.height};
}

double Reduced(double z, double pitch) {
  const double reduced = z - pitch * std::floor(z / pitch);
  return reduced < pitch ? reduced : 0.0;
}

/** How far vertices of the same height on the profile are from having the same radius [m^2]. */
double CalcSpread(const Helix& helix, const std::vector<Vec3>& points) {
  constexpr std::size_t kSpreadBins = 48;  // A choice.

  struct Bin {
    double count{0}, z{0}, r{0}, zz{0}, zr{0}, rr{0};
  };

  std::array<Bin, kSpreadBins> bins;
  for (const Vec3& p : points) {
    const Place place = PlaceOf(helix, p);
    const double z = Reduced(place.z, helix.pitch) / helix.pitch * kSpreadBins;
    const auto i = std::min(static_cast<std::size_t>(z), kSpreadBins - 1);
    const double along = z - static_cast<double>(i);
    Bin& bin = bins[i];
    bin.count += 1;
    bin.z += along;
    bin.r += place.r;
    bin.zz += along * along;
    bin.zr += along * place.r;
    bin.rr += place.r * place.r;
  }
  double spread = 0;
  for (const Bin& bin : bins) {
    if (bin.count < 3) {
      continue;
    }
    // What a straight side leaves.
    const double zz = bin.zz - bin.z * bin.z / bin.count;
    const double zr = bin.zr - bin.z * bin.r / bin.count;
    const double rr = bin.rr - bin.r * bin.r / bin.count;
    spread += zz > 1e-6 ? rr - zr * zr / zz : rr;
  }
  return spread;
}

/** Moves axis, phase and pitch of a helix that has its profile to where the points are nearest to
 it: Gauss and Newton's steps, each point with the inverse of its distance as its weight, so that a
 few that are on chords count for no more than the others. */
void MoveTo(const std::vector<Vec3>& points, double noise, Helix* helix) {
  constexpr int kSteps = 12;  // The last ones move nothing. A choice.
  for (int step = 0; step < kSteps; ++step) {
    const std::array<Vec3, 3> ways = {helix->u, helix->axis.cross(helix->u), helix->axis};
    Mat6 matrix = Mat6::Zero();
    Vec6 rhs = Vec6::Zero();
    for (const Vec3& p : points) {
      const HelixDistance found = CalcHelixDistance(*helix, p);
      const Vec3 d = p - helix->origin;
      const Vec3 moment = d.cross(found.gradient);
      const double along = found.gradient.dot(ways[2]);
      // By lean, lean, shift, shift, phase, and by the share that the pitch grows.
      Vec6 row;
      row << moment.dot(ways[0]), moment.dot(ways[1]), found.gradient.dot(ways[0]),
          found.gradient.dot(ways[1]), along, along * d.dot(ways[2]);
      const double weight = 1 / std::max(noise, std::abs(found.distance));
      matrix += weight * row * row.transpose();
      rhs += weight * found.distance * row;
    }
    const Vec6 x = matrix.ldlt().solve(rhs);
    if (!x.allFinite()) {
      return;
    }
    const Vec3 lean = x[0] * ways[0] + x[1] * ways[1];
    helix->axis = (helix->axis + lean.cross(helix->axis)).normalized();
    helix->u = (helix->u - helix->u.dot(helix->axis) * helix->axis).normalized();
    helix->origin += x[2] * ways[0] + x[3] * ways[1] + x[4] * ways[2];
    helix->pitch *= 1 + x[5];
  }
}

/** Finds the pitch within some per cent of what the normals say: the one with the least spread. */
void SearchPitch(const std::vector<Vec3>& points, Helix* helix) {
  constexpr double kWidest = 0.05;  // Of the pitch: what facets' normals may be wrong by.
  constexpr double kStep = 5e-4;    // 20 turns then differ by a hundredth. Both are choices.
  const double start = helix->pitch;
  double best = std::numeric_limits<double>::infinity();
  double pitch = start;
  for (int i = -static_cast<int>(kWidest / kStep); i <= static_cast<int>(kWidest / kStep); ++i) {
    helix->pitch = start * (1 + i * kStep);
    const double spread = CalcSpread(*helix, points);
    if (spread < best) {
      best = spread;
      pitch = helix->pitch;
    }
  }
  helix->pitch = pitch;
}

/** The profile by heights in equal steps: what the edges of the mesh draw between two heights.
 Chords of a mesh are nearer to the axis than its vertices, so the furthest counts. */
class ProfileDrawing {
 public:
  explicit ProfileDrawing(double pitch)
      : pitch_(pitch), radius_(kSteps, -std::numeric_limits<double>::infinity()) {}

  void AddEdge(const Place& a, const Place& b) {
    const Place& first = a.z < b.z ? a : b;
    const Place& last = a.z < b.z ? b : a;
    const double step = pitch_ / kSteps;
    const auto begin = static_cast<long>(std::ceil(first.z / step));
    const auto end = static_cast<long>(std::floor(last.z / step));
    for (long i = begin; i <= end; ++i) {
      const double way = last.z - first.z;
      const double share = way > 0 ? (static_cast<double>(i) * step - first.z) / way : 0;
      Raise(i, first.r + share * (last.r - first.r));
    }
  }

  /** False where the edges leave a part of the pitch out. */
  [[nodiscard]] bool is_whole() const {
    return std::all_of(radius_.begin(), radius_.end(), [](double r) { return std::isfinite(r); });
  }

  /** Corners between which the profile is straight within a tolerance [m]. */
  [[nodiscard]] std::vector<HelixCorner> MakeCorners(double tolerance) const {
    const auto most = std::max_element(radius_.begin(), radius_.end()) - radius_.begin();
    const auto least = std::min_element(radius_.begin(), radius_.end()) - radius_.begin();
    const auto from = static_cast<std::size_t>(std::min(most, least));
    const auto to = static_cast<std::size_t>(std::max(most, least));
    std::vector<std::size_t> kept;
    Divide(from, to, tolerance, &kept);
    Divide(to, from + kSteps, tolerance, &kept);
    return Sharpen(kept);
  }

 private:
  static constexpr std::size_t kSteps = 512;  // A choice: 2.4 um of an M8.

  void Raise(long i, double r) {
    constexpr auto kCount = static_cast<long>(kSteps);
    double& radius = radius_[static_cast<std::size_t>((i % kCount + kCount) % kCount)];
    radius = std::max(radius, r);
  }

  [[nodiscard]] Vec2 At(std::size_t i) const {
    return {static_cast<double>(i) * pitch_ / kSteps, radius_[i % kSteps]};
  }

  /** Douglas and Peucker's; keeps the first one and what is between. */
  void Divide(std::size_t from, std::size_t to, double tolerance,
              std::vector<std::size_t>* kept) const {
    const Vec2 a = At(from);
    const Vec2 way = (At(to) - a).normalized();
    double most = tolerance;
    std::size_t at = from;
    for (std::size_t i = from + 1; i < to; ++i) {
      const Vec2 d = At(i) - a;
      const double off = std::abs(way.x() * d.y() - way.y() * d.x());
      if (off > most) {
        most = off;
        at = i;
      }
    }
    if (at == from) {
      kept->push_back(from);
      return;
    }
    Divide(from, at, tolerance, kept);
    Divide(at, to, tolerance, kept);
  }

  /** Corners where the sides' best lines meet, rather than at one of the equal steps. */
  [[nodiscard]] std::vector<HelixCorner> Sharpen(const std::vector<std::size_t>& kept) const {
    const std::size_t count = kept.size();
    std::vector<HelixCorner> corners;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t before = k > 0 ? kept[k - 1] : kept[count - 1] - kSteps;
      const std::size_t behind = k + 1 < count ? kept[k + 1] : kept[0] + kSteps;
      // Unsigned numbers wrap alike: heights below zero are counted from a pitch up.
      const Vec2 at = Meet(before + kSteps, kept[k] + kSteps, behind + kSteps);
      HelixCorner corner;
      corner.z = Reduced(at.x(), pitch_);
      corner.r = at.y();
      corners.push_back(corner);
    }
    std::sort(corners.begin(), corners.end(),
              [](const HelixCorner& a, const HelixCorner& b) { return a.z < b.z; });
    return corners;
  }

  [[nodiscard]] Vec2 Meet(std::size_t before, std::size_t corner, std::size_t behind) const {
    constexpr std::size_t kLong = 6;  // Steps; a line through fewer is no better. A choice.
    constexpr double kFar = 2;        // Steps that a corner may move: more is another corner.
    const Vec2 at = At(corner);
    if (corner - before < kLong || behind - corner < kLong) {
      return at;
    }
    const auto [p, m] = FitLine(before + 1, corner - 1);
    const auto [q, n] = FitLine(corner + 1, behind - 1);
    const double cross = m.x() * n.y() - m.y() * n.x();
    if (std::abs(cross) < 1e-3) {
      return at;
    }
    const Vec2 d = q - p;
    const Vec2 meet = p + (d.x() * n.y() - d.y() * n.x()) / cross * m;
    return (meet - at).norm() < kFar * pitch_ / kSteps * 2 ? meet : at;
  }

  /** A point and the direction of the best line through steps. */
  [[nodiscard]] std::pair<Vec2, Vec2> FitLine(std::size_t from, std::size_t to) const {
    Vec2 middle = Vec2::Zero();
    for (std::size_t i = from; i <= to; ++i) {
      middle += At(i);
    }
    middle /= static_cast<double>(to - from + 1);
    Vec2 slope = Vec2::Zero();
    for (std::size_t i = from; i <= to; ++i) {
      const Vec2 d = At(i) - middle;
      slope += d.x() * d;
    }
    return {middle, slope.normalized()};
  }

  double pitch_;
  std::vector<double> radius_;
};

/** The thread of one pitch about one axis. */
class HelixFit {
 public:
  HelixFit(const Mesh& mesh, const std::vector<Facet>& facets, const Axis& axis, double pitch)
      : mesh_(mesh), facets_(facets) {
    helix_.origin = axis.origin;
    helix_.axis = axis.direction;
    helix_.u = spatial::FrameFromZ(axis.direction) * Vec3::UnitX();
    helix_.pitch = std::abs(pitch);
    helix_.sense = pitch > 0 ? 1 : -1;
  }

  [[nodiscard]] std::optional<Helix> Run() {
    if (!MeasureFlanks()) {
      return std::nullopt;
    }
    const std::vector<Vec3> points = ListPoints();
    SearchPitch(Thinned(points, kFewPoints), &helix_);
    const auto spread = CalcSpread(helix_, points) / static_cast<double>(points.size());
    if (spread > kNearly * kNearly * depth_ * depth_) {
      return std::nullopt;  // It is about another axis.
    }
    // First the middle of it, which is whole; then as far as the part is as there.
    const double lowest = helix_.low - helix_.pitch;
    const double highest = helix_.high + helix_.pitch;
    for (int i = 0; i < kRounds; ++i) {
      // Turns of a pitch that is slightly wrong blur a profile that is drawn from many.
      if (!DrawMiddle()) {
        return std::nullopt;
      }
      Grow(lowest, highest, kAsInMiddle * helix_.deviation);
      // Vertices alone are on the thread; what is between them is on chords.
      MoveTo(Thinned(ListVertices(), kMostPoints), kNoise * depth_, &helix_);
    }
    if (!DrawMiddle()) {
      return std::nullopt;
    }
    Grow(lowest, highest, kAsInMiddle * helix_.deviation);
    const bool is_long = helix_.high - helix_.low > helix_.pitch;
    const bool conforms = is_long && Draw() && helix_.deviation < kConforms * depth_;
    return conforms ? std::optional(helix_) : std::nullopt;
  }

 private:
  /** Span, radii and side of the triangles that have the pitch. False where they are no thread. */
  bool MeasureFlanks() {
    constexpr double kSame = 0.25;     // Of the pitch: what a facet may be wrong by.
    constexpr double kTrimmed = 0.01;  // Of the area at either end. Both are choices.
    std::vector<std::pair<double, double>> heights;
    std::vector<std::pair<double, double>> radii;
    double outward = 0;
    double area = 0;
    for (const Facet& facet : facets_) {
      if (std::abs(helix_.sense * facet.pitch - helix_.pitch) > kSame * helix_.pitch) {
        continue;
      }
      area += facet.area;
      const auto& v = mesh_.triangles[facet.triangle];
      for (const std::uint32_t i : v) {
        const HelixPoint at = Locate(helix_, mesh_.vertices[i]);
        heights.emplace_back(at.height, facet.area);
        radii.emplace_back(at.radius, facet.area);
        outward += facet.area * mesh_.NormalOf(facet.triangle).dot(at.radial);
      }
    }
    const auto span = [area](std::vector<std::pair<double, double>>* values) {
      std::sort(values->begin(), values->end());
      double sum = 0;
      std::pair<double, double> ends{0, 0};
      bool is_begun = false;
      for (const auto& [value, weight] : *values) {
        sum += weight / 3;
        if (!is_begun && sum >= kTrimmed * area) {
          ends.first = value;
          is_begun = true;
        }
        if (sum <= (1 - kTrimmed) * area) {
          ends.second = value;
        }
      }
      return ends;
    };
    std::tie(helix_.low, helix_.high) = span(&heights);
    // From the middle, so that a change of the pitch moves no turn by more than need be.
    const double middle = 0.5 * (helix_.low + helix_.high);
    helix_.origin += middle * helix_.axis;
    helix_.low -= middle;
    helix_.high -= middle;
    std::tie(least_, largest_) = span(&radii);
    helix_.outward = outward > 0 ? 1 : -1;
    // A thread has flanks all along: as much of them as its depth takes along the way around.
    constexpr double kShare = 0.5;  // A choice.
    const double turns = (helix_.high - helix_.low) / helix_.pitch;
    depth_ = largest_ - least_;
    const double flanks = units::kTurn * 0.5 * (least_ + largest_) * turns * depth_;
    constexpr double kShallow = 0.05;  // Of the pitch: less is a knurl. A choice.
    return turns > 1.5 && depth_ > kShallow * helix_.pitch && depth_ < largest_ &&
           area > kShare * flanks;
  }

  [[nodiscard]] bool IsBetweenRadii(double r) const {
    const double margin = 0.05 * depth_;
    return r > least_ - margin && r < largest_ + margin;
  }

  /** Points all over the thread, thinned out to a number that is searched quickly. Vertices alone
   are in few rows, which do not tell a pitch from another one. */
  [[nodiscard]] std::vector<Vec3> ListPoints() const {
    std::vector<Vec3> all;
    const double margin = std::min(0.2 * (helix_.high - helix_.low), helix_.pitch);
    for (const Facet& facet : facets_) {
      const auto& v = mesh_.triangles[facet.triangle];
      const Vec3 middle = (mesh_.vertices[v[0]] + mesh_.vertices[v[1]] + mesh_.vertices[v[2]]) / 3;
      const double height = Locate(helix_, middle).height;
      if (height < helix_.low + margin || height > helix_.high - margin ||
          !IsBetweenRadii(facet.radius)) {
        continue;
      }
      all.push_back(middle);
      for (const std::uint32_t i : v) {
        all.push_back(0.5 * (middle + mesh_.vertices[i]));
      }
    }
    return Thinned(all, kMostPoints);
  }

  /** Vertices in the span but for those half way between two others: they are on chords where a
   mesh was divided after it had been made. */
  [[nodiscard]] std::vector<Vec3> ListVertices() const {
    constexpr double kStraight = 2e-3;  // Of the way between the two: it bends less. A choice.
    std::vector<std::vector<std::uint32_t>> beside(mesh_.vertices.size());
    for (const Facet& facet : facets_) {
      const auto& v = mesh_.triangles[facet.triangle];
      for (std::size_t k = 0; k < 3; ++k) {
        beside[v[k]].push_back(v[(k + 1) % 3]);  // Each edge comes from both of its sides.
      }
    }
    std::vector<Vec3> vertices;
    for (std::size_t i = 0; i < beside.size(); ++i) {
      const Vec3& p = mesh_.vertices[i];
      const HelixPoint at = Locate(helix_, p);
      if (beside[i].empty() || at.height < helix_.low || at.height > helix_.high ||
          !IsBetweenRadii(at.radius)) {
        continue;
      }
      bool is_between = false;
      for (std::size_t j = 0; j < beside[i].size() && !is_between; ++j) {
        for (std::size_t k = 0; k < j && !is_between; ++k) {
          const Vec3& a = mesh_.vertices[beside[i][j]];
          const Vec3& b = mesh_.vertices[beside[i][k]];
          is_between = (0.5 * (a + b) - p).norm() < kStraight * (a - b).norm();
        }
      }
      if (!is_between) {
        vertices.push_back(p);
      }
    }
    return vertices;
  }

  static std::vector<Vec3> Thinned(const std::vector<Vec3>& all, double count) {
    std::vector<Vec3> points;
    const double step = std::max(1.0, static_cast<double>(all.size()) / count);
    for (double at = 0; at < static_cast<double>(all.size()); at += step) {
      points.push_back(all[static_cast<std::size_t>(at)]);
    }
    return points;
  }

  /** Visits the three places of each triangle in the present span. */
  template <typename Visit>
  void ForEachTriangle(double low, double high, const Visit& visit) const {
    for (const Facet& facet : facets_) {
      std::array<Place, 3> places;
      bool is_in = true;
      for (std::size_t k = 0; k < 3; ++k) {
        places[k] = PlaceOf(helix_, mesh_.vertices[mesh_.triangles[facet.triangle][k]]);
        is_in = is_in && places[k].height >= low && places[k].height <= high &&
                IsBetweenRadii(places[k].r);
      }
      if (!is_in) {
        continue;
      }
      // The azimuth jumps by a turn somewhere.
      for (std::size_t k = 1; k < 3; ++k) {
        const double off = (places[k].z - places[0].z) - (places[k].height - places[0].height);
        places[k].z -= helix_.pitch * std::round(off / helix_.pitch);
      }
      visit(places);
    }
  }

  /** Makes the corners of what is in the middle of the present span. */
  bool DrawMiddle() {
    const double low = helix_.low;
    const double high = helix_.high;
    constexpr double kReach = 0.7;  // Of a pitch: hardly more than once around. A choice.
    const double reach = std::min(0.3 * (high - low), kReach * helix_.pitch);
    helix_.low = 0.5 * (low + high) - reach;
    helix_.high = 0.5 * (low + high) + reach;
    const bool is_drawn = Draw();
    helix_.low = low;
    helix_.high = high;
    return is_drawn;
  }

  /** Makes the corners of what is in the present span. False where that is no thread. */
  bool Draw() {
    ProfileDrawing drawing(helix_.pitch);
    ForEachTriangle(helix_.low, helix_.high, [&](const std::array<Place, 3>& places) {
      for (std::size_t k = 0; k < 3; ++k) {
        drawing.AddEdge(places[k], places[(k + 1) % 3]);
      }
    });
    if (!drawing.is_whole()) {
      return false;
    }
    constexpr double kStraight = 4e-3;  // Of the depth: 4 um of an M8. A choice.
    helix_.corners = drawing.MakeCorners(kStraight * depth_);
    if (helix_.corners.size() < 2) {
      return false;
    }
    helix_.Complete();
    helix_.deviation = 0;
    ForEachTriangle(helix_.low, helix_.high, [&](const std::array<Place, 3>& places) {
      for (const Place& place : places) {
        helix_.deviation = std::max(helix_.deviation, CalcDeviation(place));
      }
    });
    return helix_.deviation < kBefore * depth_;
  }

  [[nodiscard]] double CalcDeviation(const Place& place) const {
    const double azimuth = (place.height - place.z) * helix_.sense / helix_.pitch * units::kTurn;
    const Vec3 radial =
        std::cos(azimuth) * helix_.u + std::sin(azimuth) * helix_.axis.cross(helix_.u);
    const Vec3 p = helix_.origin + place.height * helix_.axis + place.r * radial;
    return std::abs(CalcHelixDistance(helix_, p).distance);
  }

  /** Widens the span to either side as long as all of the part there is on the surface.
   @param tolerance  [m] */
  void Grow(double lowest, double highest, double tolerance) {
    constexpr double kSlices = 16;  // Of a pitch. A choice.
    const double step = helix_.pitch / kSlices;
    const auto count = static_cast<std::size_t>(std::ceil((highest - lowest) / step));
    std::vector<double> worst(count, -1.0);
    const auto add = [&](const Vec3& p) {
      const Place place = PlaceOf(helix_, p);
      const double slice = (place.height - lowest) / step;
      if (slice >= 0 && slice < static_cast<double>(count) && IsBetweenRadii(place.r)) {
        double& most = worst[static_cast<std::size_t>(slice)];
        most = std::max(most, CalcDeviation(place));
      }
    };
    for (const Facet& facet : facets_) {
      const auto& v = mesh_.triangles[facet.triangle];
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = mesh_.vertices[v[k]];
        add(p);
        add(0.5 * (p + mesh_.vertices[v[(k + 1) % 3]]));
      }
    }
    const auto is_on_it = [&](long i) {
      return i >= 0 && i < static_cast<long>(count) && worst[static_cast<std::size_t>(i)] >= 0 &&
             worst[static_cast<std::size_t>(i)] < tolerance;
    };
    const auto middle = static_cast<long>((0.5 * (helix_.low + helix_.high) - lowest) / step);
    long first = middle;
    long last = middle;
    while (is_on_it(first - 1)) {
      --first;
    }
    while (is_on_it(last + 1)) {
      ++last;
    }
    helix_.low = lowest + static_cast<double>(first) * step;
    helix_.high = lowest + static_cast<double>(last + 1) * step;
  }

  // Points that axis and pitch are found from, and those for a first look; spread of these from
  // which on axis and pitch are too far off to be mended, of the depth. All are choices.
  static constexpr double kMostPoints = 2000;
  static constexpr double kFewPoints = 1000;
  static constexpr double kNearly = 0.15;
  static constexpr int kRounds = 5;
  static constexpr double kAsInMiddle = 1.7;  ///< Largest distance over that in the middle.
  static constexpr double kNoise = 1e-3;  ///< Of the depth; what files round vertices by. A choice.
  // How far the part may be from the helix in the end, chords of its mesh included, and before axis
  // and pitch are mended, of the depth. Both are choices.
  static constexpr double kConforms = 0.02;
  static constexpr double kBefore = 0.08;

  const Mesh& mesh_;
  const std::vector<Facet>& facets_;
  Helix helix_;
  double least_{0}, largest_{0}, depth_{0};
};

}  // namespace

std::vector<Helix> FindHelices(const Mesh& mesh, const std::vector<spatial::Surface>& faces) {
  constexpr double kLeastShare = 2e-3;  // Of the part's area that a thread has. A choice.
  std::vector<Helix> helices;
  spatial::Box box;
  double area = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    area += CalcArea(mesh, t);
    box.Add(mesh.vertices[mesh.triangles[t][0]]);
  }
  for (const Axis& axis : ListAxes(mesh, faces, box.size().norm())) {
    if (helices.size() == kMaxHelices) {
      break;
    }
    const std::vector<Facet> facets = ListFacets(mesh, axis);
    const auto [pitch, flanks] = FindPitch(facets);
    if (flanks < kLeastShare * area) {
      continue;
    }
    auto helix = HelixFit(mesh, facets, axis, pitch).Run();
    if (helix) {
      helices.push_back(std::move(*helix));
    }
  }
  return helices;
}

}  // namespace hvas::contact
