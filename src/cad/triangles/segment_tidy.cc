#include "cad/triangles/segment_tidy.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "base/units.h"
#include "cad/triangles/recognise.h"
#include "cad/triangles/surface_fit.h"

namespace hvas::cad {
namespace {

using spatial::Surface;
using spatial::SurfaceKind;

// A triangle whose normal leans by more than 30 degrees against a surface is none of its, and
// corners beyond so many are left out of a fit, evenly: choices, not measured one by one.
const double kNormalCosine = std::cos(units::FromDeg(30));
constexpr std::size_t kMaxRefitPoints = 4000;

bool IsFreeform(const Segment& segment) {
  return segment.surface.kind == SurfaceKind::kFreeform;
}

bool IsCurved(const Segment& segment) {
  return segment.surface.kind != SurfaceKind::kPlane;
}

void MakeUnique(std::vector<std::uint32_t>* items) {
  std::sort(items->begin(), items->end());
  items->erase(std::unique(items->begin(), items->end()), items->end());
}

class Tidier {
 public:
  Tidier(const WeldedMesh& mesh, const std::vector<std::uint32_t>& given,
         std::vector<std::uint32_t> label, std::vector<Segment> segments)
      : mesh_(mesh), given_(given), label_(std::move(label)), segments_(std::move(segments)) {
    for (Segment& segment : segments_) {
      MakeUnique(&segment.corners);
    }
    CollectMembers();
  }

  std::vector<Segment> Run() {
    Absorb();
    Merge();
    Dissolve();
    Absorb();
    return Finish();
  }

 private:
  void CollectMembers();
  void Absorb();
  void Merge();
  void Dissolve();
  [[nodiscard]] std::vector<bool> FindScraps() const;
  [[nodiscard]] std::vector<double> CalcSmoothShare(
      const std::function<bool(std::size_t)>& counts) const;
  [[nodiscard]] bool BendsLessThan(const Segment& segment, double angle) const;
  std::vector<Segment> Finish();
  void Refit(Segment* segment) const;
  [[nodiscard]] bool LiesOn(std::uint32_t t, const Surface& surface, double tolerance) const;
  [[nodiscard]] bool IsFacing(std::uint32_t t, const Surface& surface, double tolerance) const;
  [[nodiscard]] bool IsJoined(const Segment& a, const Segment& b) const;
  [[nodiscard]] std::vector<Vec3> PointsOf(const Segment& segment) const;

  const WeldedMesh& mesh_;
  const std::vector<std::uint32_t>& given_;
  std::vector<std::uint32_t> label_;
  std::vector<Segment> segments_;
};

void Tidier::CollectMembers() {
  for (Segment& segment : segments_) {
    segment.triangles.clear();
  }
  for (std::uint32_t t = 0; t < label_.size(); ++t) {
    segments_[label_[t]].triangles.push_back(t);
  }
}

bool Tidier::LiesOn(std::uint32_t t, const Surface& surface, double tolerance) const {
  const Triangle& corners = mesh_.triangles[t];
  return std::all_of(corners.begin(), corners.end(),
                     [&](std::uint32_t v) {
                       return std::abs(CalcDistance(surface, mesh_.vertices[v]).distance) <=
                              tolerance;
                     }) &&
         IsFacing(t, surface, tolerance);
}

/** Whether a triangle looks the way the surface does there; slivers do in any case. */
bool Tidier::IsFacing(std::uint32_t t, const Surface& surface, double tolerance) const {
  const Triangle& v = mesh_.triangles[t];
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, (mesh_.vertices[v[(k + 1) % 3]] - mesh_.vertices[v[k]]).norm());
  }
  if (2 * mesh_.area[t] <= 4 * tolerance * longest) {
    return true;
  }
  const auto at = CalcDistance(
      surface, (mesh_.vertices[v[0]] + mesh_.vertices[v[1]] + mesh_.vertices[v[2]]) / 3);
  return !at.is_valid || at.gradient.dot(mesh_.normal[t]) > kNormalCosine;
}

/** Gives triangles of freeform segments to a neighbour whose surface they lie on. */
void Tidier::Absorb() {
  std::vector<std::uint32_t> queue;
  for (std::uint32_t t = 0; t < label_.size(); ++t) {
    if (IsFreeform(segments_[label_[t]])) {
      queue.push_back(t);
    }
  }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const std::uint32_t t = queue[i];
    if (!IsFreeform(segments_[label_[t]])) {
      continue;
    }
    for (const std::uint32_t n : mesh_.neighbour[t]) {
      if (n == kNoTriangle || given_[n] != given_[t] || IsFreeform(segments_[label_[n]])) {
        continue;
      }
      const Segment& other = segments_[label_[n]];
      if (LiesOn(t, other.surface, other.tolerance)) {
        label_[t] = label_[n];
        for (const std::uint32_t next : mesh_.neighbour[t]) {
          if (next != kNoTriangle && IsFreeform(segments_[label_[next]])) {
            queue.push_back(next);
          }
        }
        break;
      }
    }
  }
  CollectMembers();
}

/** Whether b lies on the surface of a. */
bool Tidier::IsJoined(const Segment& a, const Segment& b) const {
  if (a.surface.kind != b.surface.kind || IsFreeform(a) || a.is_given_surface ||
      b.is_given_surface || a.surface.outward != b.surface.outward) {
    return false;
  }
  const double tolerance = 2 * std::max(a.tolerance, b.tolerance);
  return std::all_of(b.corners.begin(), b.corners.end(),
                     [&](std::uint32_t v) {
                       return std::abs(CalcDistance(a.surface, mesh_.vertices[v]).distance) <=
                              tolerance;
                     }) &&
         std::all_of(b.triangles.begin(), b.triangles.end(),
                     [&](std::uint32_t t) { return IsFacing(t, a.surface, tolerance); });
}

void Tidier::Merge() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t t = 0; t < label_.size(); ++t) {
    for (const std::uint32_t n : mesh_.neighbour[t]) {
      if (n != kNoTriangle && n > t && label_[n] != label_[t] && given_[n] == given_[t]) {
        pairs.emplace_back(std::min(label_[t], label_[n]), std::max(label_[t], label_[n]));
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<std::uint32_t> root(segments_.size());
  std::iota(root.begin(), root.end(), 0U);
  for (auto [a, b] : pairs) {
    while (root[a] != a) {
      a = root[a];
    }
    while (root[b] != b) {
      b = root[b];
    }
    if (a == b) {
      continue;
    }
    if (segments_[a].triangles.size() < segments_[b].triangles.size()) {
      std::swap(a, b);
    }
    if (IsJoined(segments_[a], segments_[b])) {
      root[b] = a;
      auto& into = segments_[a].triangles;
      into.insert(into.end(), segments_[b].triangles.begin(), segments_[b].triangles.end());
      auto& corners = segments_[a].corners;
      corners.insert(corners.end(), segments_[b].corners.begin(), segments_[b].corners.end());
      segments_[a].tolerance = std::max(segments_[a].tolerance, segments_[b].tolerance);
    }
  }
  for (std::uint32_t& label : label_) {
    while (root[label] != label) {
      label = root[label];
    }
  }
  CollectMembers();
}

/** How much of the rim of each segment goes on smoothly into segments of some kind. */
std::vector<double> Tidier::CalcSmoothShare(const std::function<bool(std::size_t)>& counts) const {
  std::vector<double> rim(segments_.size(), 0.0);
  std::vector<double> smooth(segments_.size(), 0.0);
  for (std::uint32_t t = 0; t < label_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t n = mesh_.neighbour[t][k];
      if (n == kNoTriangle || label_[n] == label_[t]) {
        continue;
      }
      const Triangle& v = mesh_.triangles[t];
      const double length = (mesh_.vertices[v[(k + 1) % 3]] - mesh_.vertices[v[k]]).norm();
      rim[label_[t]] += length;
      if (counts(label_[n]) && mesh_.normal[t].dot(mesh_.normal[n]) > kSmoothCosine) {
        smooth[label_[t]] += length;
      }
    }
  }
  for (std::size_t s = 0; s < segments_.size(); ++s) {
    smooth[s] = rim[s] > 0 ? smooth[s] / rim[s] : 0;
  }
  return smooth;
}

bool Tidier::BendsLessThan(const Segment& segment, double angle) const {
  Vec3 mean = Vec3::Zero();
  for (const std::uint32_t t : segment.triangles) {
    mean += mesh_.area[t] * mesh_.normal[t];
  }
  mean.normalize();
  return std::all_of(segment.triangles.begin(), segment.triangles.end(),
                     [&](std::uint32_t t) { return mesh_.normal[t].dot(mean) > std::cos(angle); });
}

/** A piece of a freeform face may pass for a torus by chance: pieces that bend little, or flat ones
 of a triangle or two, are no faces of their own when they go on smoothly nearly all around into
 others of this sort. */
std::vector<bool> Tidier::FindScraps() const {
  constexpr double kMostBend = 0.5;       // [rad]: a choice, not measured.
  constexpr double kMostLooseBend = 1.0;  // The same, where the fit is loose [rad].
  constexpr double kLeastShare = 0.7;     // Share of a rim that goes on smoothly (segmentation.md).
  constexpr std::size_t kFewCorners = 4;  // Corners of a quadrilateral: a scrap's.
  std::vector<bool> is_scrap(segments_.size(), false);
  for (std::size_t s = 0; s < segments_.size(); ++s) {
    const Segment& segment = segments_[s];
    if (segment.triangles.empty() || segment.is_given_surface) {
      continue;
    }
    const bool is_loose = segment.tolerance > 2 * mesh_.resolution;
    is_scrap[s] = IsFreeform(segment) ||
                  (IsCurved(segment) ? BendsLessThan(segment, is_loose ? kMostLooseBend : kMostBend)
                                     : segment.corners.size() <= kFewCorners);
  }
  constexpr int kMaxRounds = 20;  // Each joins neighbours: a bound, a choice.
  bool is_changed = true;
  for (int round = 0; round < kMaxRounds && is_changed; ++round) {
    is_changed = false;
    const std::vector<double> share = CalcSmoothShare([&](std::size_t s) { return is_scrap[s]; });
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      if (is_scrap[s] && !IsFreeform(segments_[s]) && share[s] <= kLeastShare) {
        is_scrap[s] = false;
        is_changed = true;
      }
    }
  }
  return is_scrap;
}

/** Makes one freeform face of scraps that go on smoothly into each other. */
void Tidier::Dissolve() {
  std::vector<bool> is_scrap = FindScraps();
  std::vector<bool> is_done(label_.size(), false);
  for (std::uint32_t seed = 0; seed < label_.size(); ++seed) {
    if (is_done[seed] || !is_scrap[label_[seed]]) {
      continue;
    }
    const auto segment = static_cast<std::uint32_t>(segments_.size());
    segments_.emplace_back();
    is_scrap.push_back(false);
    std::vector<std::uint32_t> members(1, seed);
    is_done[seed] = true;
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (const std::uint32_t n : mesh_.neighbour[members[i]]) {
        const bool is_next = n != kNoTriangle && !is_done[n] && is_scrap[label_[n]] &&
                             given_[n] == given_[seed] &&
                             (label_[n] == label_[members[i]] ||
                              mesh_.normal[n].dot(mesh_.normal[members[i]]) > kSmoothCosine);
        if (is_next) {
          is_done[n] = true;
          members.push_back(n);
        }
      }
    }
    for (const std::uint32_t t : members) {
      label_[t] = segment;
    }
  }
  CollectMembers();
}

std::vector<Vec3> Tidier::PointsOf(const Segment& segment) const {
  std::vector<Vec3> points;
  points.reserve(segment.corners.size());
  for (const std::uint32_t v : segment.corners) {
    points.push_back(mesh_.vertices[v]);
  }
  return points;
}

void Tidier::Refit(Segment* segment) const {
  const std::vector<Vec3> points = PointsOf(*segment);
  spatial::Box box;
  for (const Vec3& p : points) {
    box.Add(p);
  }
  if (!segment->is_given_surface && points.size() > 3) {
    std::vector<Vec3> sample;
    const std::size_t stride = 1 + points.size() / kMaxRefitPoints;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      sample.push_back(points[i]);
    }
    Surface refined = segment->surface;
    if (RefineSurface(sample, std::max(box.size().norm(), mesh_.resolution), &refined) <=
        2 * CalcResidual(points, segment->surface)) {
      segment->surface = refined;
    }
  }
  segment->residual = CalcResidual(points, segment->surface);
  std::vector<Triangle> triangles;
  for (const std::uint32_t t : segment->triangles) {
    triangles.push_back(mesh_.triangles[t]);
  }
  OrientSurface(mesh_.vertices, triangles, &segment->surface);
}

std::vector<Segment> Tidier::Finish() {
  std::vector<Segment> result;
  for (Segment& segment : segments_) {
    if (segment.triangles.empty()) {
      continue;
    }
    segment.given = given_[segment.triangles.front()];
    MakeUnique(&segment.corners);
    if (!IsFreeform(segment)) {
      Refit(&segment);
    }
    result.push_back(std::move(segment));
  }
  std::sort(result.begin(), result.end(), [](const Segment& a, const Segment& b) {
    return a.triangles.front() < b.triangles.front();
  });
  return result;
}

}  // namespace

std::vector<Segment> TidySegments(const WeldedMesh& mesh, const std::vector<std::uint32_t>& given,
                                  std::vector<std::uint32_t> label, std::vector<Segment> segments) {
  return Tidier(mesh, given, std::move(label), std::move(segments)).Run();
}

}  // namespace hvas::cad
