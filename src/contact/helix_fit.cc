#include "contact/helix_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "base/units.h"
#include "contact/helix_axes.h"
#include "contact/helix_profile.h"

namespace hvas::contact {
namespace {

/** How far vertices of the same height on the profile are from having the same radius [m^2]. */
double CalcSpread(const Helix& helix, const std::vector<Vec3>& points) {
  constexpr std::size_t kSpreadBins = 48;  // A choice.

  struct Bin {
    double count{0}, z{0}, r{0}, zz{0}, zr{0}, rr{0};
  };

  std::array<Bin, kSpreadBins> bins;
  for (const Vec3& p : points) {
    const HelixPlace place = PlaceOf(helix, p);
    const double z = ReducedToPitch(place.z, helix.pitch) / helix.pitch * kSpreadBins;
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
    const std::array<Vec3, 3> ways = {helix->u, helix->v, helix->axis};
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
    helix->SetAxis((helix->axis + lean.cross(helix->axis)).normalized(), helix->u);
    helix->origin += x[2] * ways[0] + x[3] * ways[1] + x[4] * ways[2];
    constexpr double kMost = 0.02;  // A step beyond is none that a thread asks for. A choice.
    const double growth = 1 + std::clamp(x[5], -kMost, kMost);
    helix->pitch *= growth;
    for (HelixCorner& corner : helix->corners) {
      corner.z *= growth;
    }
    helix->Complete();
  }
}

/** Finds the pitch within some per cent of what the normals say: the one with the least spread. */
void SearchPitch(const std::vector<Vec3>& points, Helix* helix) {
  constexpr double kWidest = 0.05;  // Of the pitch: what normals may be wrong by.
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

/** The thread of one pitch about one axis. */
class HelixFit {
 public:
  HelixFit(const Mesh& mesh, const std::vector<SurfacePoint>& points, const ThreadAxis& axis,
           double pitch)
      : mesh_(mesh), points_(points), axis_(axis) {
    helix_.origin = axis.origin;
    helix_.SetAxis(axis.direction, spatial::FrameFromZ(axis.direction) * Vec3::UnitX());
    helix_.pitch = std::abs(pitch);
    helix_.sense = pitch > 0 ? 1 : -1;
  }

  [[nodiscard]] std::optional<Helix> Run() {
    if (!MeasureFlanks()) {
      return std::nullopt;
    }
    const std::vector<Vec3> points = ListPointsOfThread();
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
      if (!DrawMiddle() || !Grow(lowest, highest, CalcTolerance())) {
        return std::nullopt;
      }
      // Vertices alone are on the thread; what is between them is on chords.
      MoveTo(Thinned(ListVertices(), kMostPoints), kNoise * depth_, &helix_);
    }
    if (!DrawMiddle() || !Grow(lowest, highest, CalcTolerance())) {
      return std::nullopt;
    }
    const bool is_long = helix_.high - helix_.low > helix_.pitch;
    const bool conforms = is_long && Draw() && off_ < kConforms * depth_;
    return conforms ? std::optional(helix_) : std::nullopt;
  }

 private:
  /** Span, radii and side of the triangles that have the pitch. False where they are no thread. */
  bool MeasureFlanks() {
    constexpr double kSame = 0.25;     // Of the pitch: what normals may be wrong by.
    constexpr double kTrimmed = 5e-3;  // Of the area at either end. Both are choices.
    std::vector<std::pair<double, double>> heights;
    std::vector<std::pair<double, double>> radii;
    double outward = 0;
    double area = 0;
    for (const SurfacePoint& point : points_) {
      const double pitch = helix_.sense * CalcThreadPitch(point, axis_);
      if (std::abs(pitch - helix_.pitch) > kSame * helix_.pitch) {
        continue;
      }
      area += point.area;
      const HelixPoint at = Locate(helix_, point.p);
      heights.emplace_back(at.height, point.area);
      radii.emplace_back(at.radius, point.area);
      outward += point.n.dot(FromCylinder(helix_, at, 1, 0, 0));
    }
    const auto span = [area](std::vector<std::pair<double, double>>* values) {
      std::sort(values->begin(), values->end());
      double sum = 0;
      std::pair<double, double> ends{0, 0};
      bool is_begun = false;
      for (const auto& [value, weight] : *values) {
        sum += weight;
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
    constexpr double kShallow = 0.05;   // Of the pitch: less is a knurl. A choice.
    constexpr double kMostTurns = 500;  // More are a knurl or noise. A choice.
    return turns > 1.5 && turns < kMostTurns && depth_ > kShallow * helix_.pitch &&
           depth_ < largest_ && area > kShare * flanks;
  }

  /** How far the part may be from the helix to either side of the middle [m]. */
  [[nodiscard]] double CalcTolerance() const {
    return std::max(kAsInMiddle * helix_.deviation, kLeastTolerance * depth_);
  }

  [[nodiscard]] bool IsBetweenRadii(double r) const {
    constexpr double kBeside =
        0.1;  // Of the depth: what the ends of flanks may be missed by. A choice.
    const double margin = kBeside * depth_;
    return r > least_ - margin && r < largest_ + margin;
  }

  /** Points all over the thread, thinned out to a number that is searched quickly. Vertices alone
   are in few rows, which do not tell a pitch from another one. */
  [[nodiscard]] std::vector<Vec3> ListPointsOfThread() const {
    std::vector<Vec3> all;
    const double margin = std::min(0.2 * (helix_.high - helix_.low), helix_.pitch);
    for (const auto& v : mesh_.triangles) {
      const Vec3 middle = (mesh_.vertices[v[0]] + mesh_.vertices[v[1]] + mesh_.vertices[v[2]]) / 3;
      const HelixPoint at = Locate(helix_, middle);
      if (at.height < helix_.low + margin || at.height > helix_.high - margin ||
          !IsBetweenRadii(at.radius)) {
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
    for (const auto& v : mesh_.triangles) {
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
      constexpr std::size_t kMany = 64;  // Neighbours: it is the middle of a fan. A choice.
      const std::size_t count = beside[i].size() < kMany ? beside[i].size() : 0;
      for (std::size_t j = 0; j < count && !is_between; ++j) {
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

  /** Visits the three places of each triangle in the present span. */
  template <typename Visit>
  void ForEachTriangle(double low, double high, const Visit& visit) const {
    for (const auto& v : mesh_.triangles) {
      std::array<HelixPlace, 3> places;
      bool is_in = true;
      for (std::size_t k = 0; k < 3; ++k) {
        places[k] = PlaceOf(helix_, mesh_.vertices[v[k]]);
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
      visit(places, v);
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
    HelixProfile profile(helix_.pitch);
    ForEachTriangle(helix_.low, helix_.high,
                    [&](const std::array<HelixPlace, 3>& places, const Corners&) {
                      for (std::size_t k = 0; k < 3; ++k) {
                        profile.AddEdge(places[k], places[(k + 1) % 3]);
                      }
                    });
    if (!profile.is_whole()) {
      return false;
    }
    constexpr double kStraight = 4e-3;  // Of the depth: 4 um of an M8. A choice.
    helix_.corners = profile.MakeCorners(kStraight * depth_);
    if (helix_.corners.size() < 2) {
      return false;
    }
    helix_.Complete();
    off_ = 0;
    helix_.deviation = 0;
    ForEachTriangle(
        helix_.low, helix_.high, [&](const std::array<HelixPlace, 3>& places, const Corners& v) {
          for (std::size_t k = 0; k < 3; ++k) {
            off_ = std::max(off_, CalcDeviation(places[k]));
            const Vec3 middle = 0.5 * (mesh_.vertices[v[k]] + mesh_.vertices[v[(k + 1) % 3]]);
            helix_.deviation = std::max(helix_.deviation, CalcDeviation(PlaceOf(helix_, middle)));
          }
        });
    helix_.deviation = std::max(helix_.deviation, off_);
    if (off_ >= kBefore * depth_) {
      return false;
    }
    least_ = helix_.least_radius;
    largest_ = helix_.largest_radius;
    depth_ = largest_ - least_;
    return true;
  }

  [[nodiscard]] double CalcDeviation(const HelixPlace& place) const {
    const double azimuth = (place.height - place.z) * helix_.sense / helix_.pitch * units::kTurn;
    const HelixPoint at{place.height, place.r, std::cos(azimuth), std::sin(azimuth)};
    return std::abs(CalcHelixDistance(helix_, at).distance);
  }

  /** Widens the span to either side as long as all of the part there is on the surface.
   False where not even the middle is. @param tolerance  [m] */
  bool Grow(double lowest, double highest, double tolerance) {
    constexpr double kSlices = 16;  // Of a pitch. A choice.
    const double step = helix_.pitch / kSlices;
    const auto count = static_cast<std::size_t>(std::ceil((highest - lowest) / step));

    struct Slice {
      double worst{-1};  // Negative: nothing of the part is there.
      double low{std::numeric_limits<double>::infinity()};
      double high{-std::numeric_limits<double>::infinity()};
    };

    std::vector<Slice> slices(count);
    const auto add = [&](const Vec3& p) {
      const HelixPlace place = PlaceOf(helix_, p);
      const double slice = (place.height - lowest) / step;
      if (slice >= 0 && slice < static_cast<double>(count) && IsBetweenRadii(place.r)) {
        Slice& at = slices[static_cast<std::size_t>(slice)];
        at.worst = std::max(at.worst, CalcDeviation(place));
        at.low = std::min(at.low, place.height);
        at.high = std::max(at.high, place.height);
      }
    };
    for (const auto& v : mesh_.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = mesh_.vertices[v[k]];
        add(p);
        add(0.5 * (p + mesh_.vertices[v[(k + 1) % 3]]));
      }
    }
    const auto is_on_it = [&](long i) {
      return i >= 0 && i < static_cast<long>(count) &&
             slices[static_cast<std::size_t>(i)].worst >= 0 &&
             slices[static_cast<std::size_t>(i)].worst < tolerance;
    };
    const auto middle = static_cast<long>((0.5 * (helix_.low + helix_.high) - lowest) / step);
    if (!is_on_it(middle)) {
      return false;
    }
    long first = middle;
    long last = middle;
    while (is_on_it(first - 1)) {
      --first;
    }
    while (is_on_it(last + 1)) {
      ++last;
    }
    helix_.low = slices[static_cast<std::size_t>(first)].low;
    helix_.high = slices[static_cast<std::size_t>(last)].high;
    return true;
  }

  // Points that axis and pitch are found from, and those for a first look; spread of these from
  // which on axis and pitch are too far off to be mended, of the depth. All are choices.
  static constexpr std::size_t kMostPoints = 2000;
  static constexpr std::size_t kFewPoints = 1000;
  static constexpr double kNearly = 0.15;
  static constexpr int kRounds = 5;
  static constexpr double kAsInMiddle = 1.7;       ///< Largest distance over that in the middle.
  static constexpr double kLeastTolerance = 8e-3;  ///< Of the depth.
  static constexpr double kNoise = 1e-3;  ///< Of the depth; what files round vertices by. A choice.
  // How far the part's vertices may be from the helix in the end, and before axis and pitch are
  // mended, of the depth. Both are choices.
  static constexpr double kConforms = 0.02;
  static constexpr double kBefore = 0.08;

  using Corners = std::array<std::uint32_t, 3>;

  const Mesh& mesh_;
  const std::vector<SurfacePoint>& points_;
  const ThreadAxis& axis_;
  Helix helix_;
  double least_{0}, largest_{0}, depth_{0};
  double off_{0};  ///< Largest distance of a vertex from the helix where it was drawn [m].
};

}  // namespace

std::vector<Helix> FindHelices(const Mesh& mesh, const std::vector<spatial::Surface>& faces) {
  constexpr double kLeastShare = 2e-3;  // Of the part's area that a thread has. A choice.
  std::vector<Helix> helices;
  double area = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    area += mesh.CalcArea(t);
  }
  const std::vector<SurfacePoint> points = ListSurfacePoints(mesh, faces);
  for (const ThreadAxis& axis : ListThreadAxes(mesh, faces, points)) {
    if (helices.size() == kMaxHelices) {
      break;
    }
    const auto [pitch, flanks] = FindThreadPitch(points, axis);
    if (flanks < kLeastShare * area) {
      continue;
    }
    auto helix = HelixFit(mesh, points, axis, pitch).Run();
    const auto is_known = [&helix](const Helix& other) {
      const Vec3 middle = helix->origin + 0.5 * (helix->low + helix->high) * helix->axis;
      return IsInThread(other, Locate(other, middle), other.largest_radius);
    };
    if (helix && std::none_of(helices.begin(), helices.end(), is_known)) {
      helices.push_back(std::move(*helix));
    }
  }
  return helices;
}

}  // namespace hvas::contact
