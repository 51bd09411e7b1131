#include "contact/shell_build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <unordered_map>

#include "base/random.h"
#include "contact/refine.h"
#include "contact/smooth_surface.h"
#include "spatial/box.h"
#include "spatial/decompose.h"

namespace hvas::contact {
namespace {

// Spacing of edge samples over that of face samples. Between two exact faces contacts slide along
// the edge to where they belong, else the samples are all there is.
constexpr double kEdgeRatio = 0.5;
constexpr double kExactEdgeRatio = 1.5;
constexpr int kTriesPerSample = 6;  // Random tries for each sample that would fill the area.
constexpr double kDensity = 0.75;   // Smallest distance of samples over the spacing.
constexpr std::uint64_t kSeed = 20260721;

using PointFaces = std::array<std::uint32_t, kMaxPointFaces>;

struct Sample {
  Vec3 p;
  PointFaces faces;
  bool is_edge;
  bool is_feature;
  std::uint32_t triangle{kNoFace};  // Of the first face, where one of the faces is freeform.
  std::array<Vec3, kMaxPointFaces> normals{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

PointFaces FacesOf(std::initializer_list<std::uint32_t> faces) {
  PointFaces out;
  out.fill(kNoFace);
  std::copy(faces.begin(), faces.end(), out.begin());
  return out;
}

// Samples no closer to each other than a radius, Poisson-disk fashion; only samples that share a
// face see each other, so that the sides of a thin wall do not.
class Sampler {
 public:
  explicit Sampler(double cell) : cell_(cell) {}

  bool TryAdd(const Sample& sample, double radius) {
    const auto cell = CellOf(sample.p);
    for (std::int64_t n = 0; n < 27; ++n) {
      const std::int64_t i = (n + 13) % 27;  // Its own cell, where most are refused, comes first.
      const auto found =
          cells_.find(Key({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1}));
      for (std::uint32_t s = found == cells_.end() ? kNoFace : found->second; s != kNoFace;
           s = next_[s]) {
        if ((samples_[s].p - sample.p).squaredNorm() < radius * radius &&
            Share(samples_[s], sample)) {
          return false;
        }
      }
    }
    Add(sample);
    return true;
  }

  void Add(const Sample& sample) {
    const auto index = static_cast<std::uint32_t>(samples_.size());
    samples_.push_back(sample);
    const auto [entry, is_new] = cells_.try_emplace(Key(CellOf(sample.p)), index);
    next_.push_back(is_new ? kNoFace : entry->second);
    entry->second = index;
  }

  [[nodiscard]] const std::vector<Sample>& samples() const { return samples_; }

 private:
  static bool Share(const Sample& a, const Sample& b) {
    // An edge sees its own edge and the faces beside it, but not another edge of the same face.
    int shared = 0;
    for (const std::uint32_t f : a.faces) {
      shared +=
          f != kNoFace && std::find(b.faces.begin(), b.faces.end(), f) != b.faces.end() ? 1 : 0;
    }
    return a.is_edge && b.is_edge && a.faces[1] != kNoFace ? shared >= 2 : shared >= 1;
  }

  std::array<std::int64_t, 3> CellOf(const Vec3& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x() / cell_)),
            static_cast<std::int64_t>(std::floor(p.y() / cell_)),
            static_cast<std::int64_t>(std::floor(p.z() / cell_))};
  }

  // Distinct within a million cells a side; 15,000 samples span far fewer.
  static std::uint64_t Key(const std::array<std::int64_t, 3>& c) {
    constexpr std::int64_t kHalf = 1 << 20;  // 2^21 cells each way, three of 21 bits.
    return (static_cast<std::uint64_t>(c[0] + kHalf) << 42U) ^
           (static_cast<std::uint64_t>(c[1] + kHalf) << 21U) ^
           static_cast<std::uint64_t>(c[2] + kHalf);
  }

  double cell_;
  std::vector<Sample> samples_;
  std::vector<std::uint32_t> next_;
  std::unordered_map<std::uint64_t, std::uint32_t> cells_;
};

// The normal of a triangle's face at p.
Vec3 NormalAt(const Shape::Data& data, std::uint32_t t, const Vec3& p) {
  const auto exact = spatial::CalcDistance(data.exact.faces[data.mesh.face[t]], p);
  return exact.is_valid ? exact.gradient : data.mesh.NormalOf(t);
}

void AddCorners(const Shape::Data& data, Sampler* sampler) {
  const Mesh& mesh = data.mesh;
  std::vector<Sample> corners(mesh.vertices.size(), {Vec3::Zero(), FacesOf({}), true, true});
  std::vector<std::uint8_t> is_convex(mesh.vertices.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      auto& list = corners[v].faces;
      if (std::find(list.begin(), list.end(), mesh.face[t]) == list.end()) {
        const auto free = std::find(list.begin(), list.end(), kNoFace);
        if (free != list.end()) {
          *free = mesh.face[t];
          corners[v].normals[static_cast<std::size_t>(free - list.begin())] =
              NormalAt(data, t, mesh.vertices[v]);
        }
      }
      if (mesh.edge_kind[t][k] == EdgeKind::kConvex || mesh.edge_kind[t][k] == EdgeKind::kOpen) {
        is_convex[v] = 1;
        is_convex[mesh.triangles[t][(k + 1) % 3]] = 1;
      }
    }
  }
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (mesh.vertex_kind[v] == VertexKind::kCorner && is_convex[v] != 0) {
      corners[v].p = mesh.vertices[v];
      sampler->Add(corners[v]);
    }
  }
}

// The faces on both sides of a triangle's edge.
struct Edge {
  const Shape::Data& data;
  std::uint32_t triangle;
  std::uint32_t other;

  [[nodiscard]] std::uint32_t face() const { return data.mesh.face[triangle]; }

  [[nodiscard]] std::uint32_t other_face() const { return data.mesh.face[other]; }

  // Moves a point of the mesh's edge to where both faces meet. False where they do not near it.
  bool Project(Vec3* p) const {
    const double tolerance =
        4 * (data.exact.deviation[face()] + data.exact.deviation[other_face()]) + 1e-9;
    Vec3 q = *p;
    if (face() == other_face() ||
        !ProjectOnEdge({data, nullptr, face(), triangle}, {data, nullptr, other_face(), other}, *p,
                       &q) ||
        (q - *p).norm() > tolerance) {
      return false;
    }
    *p = q;
    return true;
  }
};

// Where a flat face goes over into a fillet there is no edge, but flat contact ends there.
bool IsFlatBoundary(const Shape::Data& data, std::uint32_t f, std::uint32_t g) {
  const bool is_flat_f = data.exact.faces[f].kind == spatial::SurfaceKind::kPlane;
  const bool is_flat_g = data.exact.faces[g].kind == spatial::SurfaceKind::kPlane;
  return f != g && is_flat_f != is_flat_g;
}

// Adds the samples of the edge k of triangle t.
void AddEdge(const Shape::Data& data, std::uint32_t t, std::size_t k, Sampler* sampler) {
  const Mesh& mesh = data.mesh;
  const std::uint32_t n = mesh.neighbour[t][k];
  const Vec3& a = mesh.vertices[mesh.triangles[t][k]];
  const Vec3& b = mesh.vertices[mesh.triangles[t][(k + 1) % 3]];
  const std::uint32_t f = mesh.face[t];
  const std::uint32_t g = mesh.face[n];
  const Edge edge{data, t, n};
  const bool is_freeform = data.exact.IsFreeform(f) || data.exact.IsFreeform(g);
  Vec3 middle = 0.5 * (a + b);
  const bool slides = !is_freeform || edge.Project(&middle);
  const double spacing = (slides ? kExactEdgeRatio : kEdgeRatio) * data.spacing;
  const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
  // The middle of a short edge too, so that an edge between two near corners gets its point.
  for (int i = 0; i <= 2 * pieces; i += pieces == 1 ? 1 : 2) {
    Vec3 p = a + (0.5 * i / pieces) * (b - a);
    const bool is_on_curve = edge.Project(&p);
    Sample sample{p, f == g ? FacesOf({f}) : FacesOf({f, g}), true, true};
    sample.triangle = is_freeform && is_on_curve ? t : kNoFace;
    sample.normals[0] = NormalAt(data, t, p);
    if (f == g) {
      sample.normals[0] = (mesh.NormalOf(t) + mesh.NormalOf(n)).normalized();
    } else {
      sample.normals[1] = NormalAt(data, n, p);
    }
    sampler->TryAdd(sample, 0.9 * spacing);
  }
}

void AddEdges(const Shape::Data& data, Sampler* sampler) {
  const Mesh& mesh = data.mesh;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t n = mesh.neighbour[t][k];
      const EdgeKind kind = mesh.edge_kind[t][k];
      const bool is_wanted =
          kind == EdgeKind::kConvex || (kind == EdgeKind::kSmooth && n != kNoFace &&
                                        IsFlatBoundary(data, mesh.face[t], mesh.face[n]));
      if (is_wanted && n >= t) {
        AddEdge(data, t, k, sampler);
      }
    }
  }
}

// How a face is sampled: `stretch` takes its points to a space in which samples are equally far
// apart in all directions.
struct FacePlan {
  Mat3 stretch{Mat3::Identity()};
  double area_scale{1};
  bool is_feature{true};
};

// The direction in which a face was drawn out of a curve; none where it was not.
std::optional<Vec3> FindExtrusion(const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  // [rad] by which normals may turn along it, as a mean: those of triangles do. A choice.
  constexpr double kMostTurn = 0.02;
  Mat3 sum = Mat3::Zero();
  double area = 0;
  for (const std::uint32_t t : triangles) {
    const Vec3 n = mesh.NormalOf(t);
    sum += mesh.CalcArea(t) * n * n.transpose();
    area += mesh.CalcArea(t);
  }
  const spatial::Eigensystem normals = spatial::CalcEigensystem(sum);
  const bool is_extruded = normals.values[0] < kMostTurn * kMostTurn * area;
  return is_extruded ? std::optional<Vec3>(normals.vectors.col(0)) : std::nullopt;
}

FacePlan PlanOf(const Shape::Data& data, std::uint32_t f,
                const std::vector<std::uint32_t>& triangles) {
  // Contacts slide, so that planes have one sample every 3 spacings along each way, round faces one
  // every 2 across, and freeform ones that were extruded one every 3 along
  // (docs/algorithms/contact.md, "Samples").
  constexpr double kSparse = 1.0 / 3;
  constexpr double kCurved = 1.0 / 2;
  const spatial::Surface& face = data.exact.faces[f];
  FacePlan plan;
  if (face.kind == spatial::SurfaceKind::kTorus) {
    return plan;
  }
  if (face.kind == spatial::SurfaceKind::kFreeform) {
    if (const std::optional<Vec3> along = FindExtrusion(data.mesh, triangles)) {
      plan.stretch -= (1 - kSparse) * *along * along->transpose();
      plan.area_scale = kSparse;
    }
    return plan;
  }
  if (face.kind == spatial::SurfaceKind::kPlane || face.outward < 0) {
    plan.stretch *= kSparse;
    plan.area_scale = kSparse * kSparse;
    plan.is_feature = false;
  } else if (face.kind != spatial::SurfaceKind::kSphere) {
    plan.stretch -= (1 - kSparse) * face.axis * face.axis.transpose();
    plan.stretch *= kCurved;
    plan.area_scale = kSparse * kCurved * kCurved;
  }
  return plan;
}

void AddFace(const Shape::Data& data, std::uint32_t f, const std::vector<std::uint32_t>& triangles,
             Random* random, std::vector<Sample>* out) {
  const Mesh& mesh = data.mesh;
  const double spacing = data.spacing;
  std::vector<double> sum;
  double area = 0;
  for (const std::uint32_t t : triangles) {
    const auto& v = mesh.triangles[t];
    area += 0.5 * (mesh.vertices[v[1]] - mesh.vertices[v[0]])
                      .cross(mesh.vertices[v[2]] - mesh.vertices[v[0]])
                      .norm();
    sum.push_back(area);
  }
  if (!(area > 0)) {
    return;
  }
  const FacePlan plan = PlanOf(data, f, triangles);
  const bool is_freeform = data.exact.IsFreeform(f);
  Sampler stretched(spacing);
  const int tries =
      8 + static_cast<int>(kTriesPerSample * plan.area_scale * area / (spacing * spacing));
  for (int i = 0; i < tries; ++i) {
    const auto pick = std::lower_bound(sum.begin(), sum.end(), random->Uniform() * area);
    const std::uint32_t t = triangles[static_cast<std::size_t>(
        std::min<std::ptrdiff_t>(pick - sum.begin(), std::ssize(sum) - 1))];
    const auto& v = mesh.triangles[t];
    const double root = std::sqrt(random->Uniform());
    const double share = random->Uniform();
    Vec3 p = (1 - root) * mesh.vertices[v[0]] + root * (1 - share) * mesh.vertices[v[1]] +
             root * share * mesh.vertices[v[2]];
    Vec3 n = mesh.NormalOf(t);
    if (is_freeform) {
      const CurvedPoint point = PointOfPatch(mesh, t, root * (1 - share), root * share);
      p = point.q;
      n = point.normal.allFinite() ? point.normal : n;
    }
    const auto exact = spatial::CalcDistance(data.exact.faces[f], p);
    if (exact.is_valid) {
      p -= exact.distance * exact.gradient;
      n = exact.gradient;
    }
    Sample sample{plan.stretch * p, FacesOf({f}), false, plan.is_feature};
    sample.triangle = is_freeform ? t : kNoFace;
    sample.normals[0] = n;
    if (stretched.TryAdd(sample, kDensity * spacing)) {
      out->push_back(sample);
      out->back().p = p;
    }
  }
}

std::vector<Sample> SampleAll(const Shape::Data& data) {
  Sampler edges(kExactEdgeRatio * data.spacing);
  AddCorners(data, &edges);
  AddEdges(data, &edges);
  std::vector<Sample> samples = edges.samples();
  std::vector<std::vector<std::uint32_t>> triangles(data.exact.faces.size());
  for (std::uint32_t t = 0; t < data.mesh.triangles.size(); ++t) {
    triangles[data.mesh.face[t]].push_back(t);
  }
  Random random(kSeed);
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    AddFace(data, f, triangles[f], &random, &samples);
  }
  return samples;
}

// Two parts touch where their normals are opposed: a sample's normal may differ from that by as
// much as the surface turns on the way to the next sample, and some for the way that is still to
// go.
double FacingLimit(const Shape::Data& data, const Sample& sample) {
  constexpr double kAllowed = 0.5;      // [rad]: a choice, not measured.
  constexpr double kUnknownTurn = 1.0;  // [rad], of freeform faces.
  constexpr double kEdge = -0.3;        // Edges: each of their faces may look away this much.
  if (sample.is_edge) {
    return kEdge;
  }
  const spatial::Surface& face = data.exact.faces[sample.faces[0]];
  const double way = 2 * data.spacing;
  double radius = std::numeric_limits<double>::infinity();
  switch (face.kind) {
    case spatial::SurfaceKind::kPlane:
      break;
    case spatial::SurfaceKind::kTorus:
      radius = face.second;
      break;
    case spatial::SurfaceKind::kCone:
      radius = (sample.p - face.origin).norm() * std::tan(face.second);
      break;
    case spatial::SurfaceKind::kFreeform:
      radius = way / kUnknownTurn;
      break;
    default:
      radius = face.radius;
  }
  return std::cos(std::min(kAllowed + way / radius, 0.75 * std::numbers::pi));
}

class TreeBuilder {
 public:
  TreeBuilder(const Shape::Data& data, const std::vector<Sample>& samples, Shell* shell)
      : data_(data),
        samples_(samples),
        shell_(shell),
        has_freeform_(std::any_of(samples.begin(), samples.end(), [](const Sample& sample) {
          return sample.triangle != kNoFace;
        })) {}

  void Build(std::vector<std::uint32_t> order) {
    order_ = std::move(order);
    shell_->point_count = order_.size();
    if (!order_.empty()) {
      shell_->nodes.emplace_back();
      Fill(0, {0, order_.size()});
    }
    shell_->Bind();
  }

 private:
  struct Range {
    std::size_t begin, end;

    [[nodiscard]] std::size_t count() const { return end - begin; }
  };

  spatial::Box BoxOf(const Range& range) const {
    spatial::Box box;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      box.Add(samples_[order_[i]].p);
    }
    return box;
  }

  // Halves each range three times along its longest side, in multiples of a leaf.
  std::vector<Range> Split(const Range& whole) {
    std::vector<Range> ranges{whole};
    for (int level = 0; level < 3; ++level) {
      std::vector<Range> next;
      for (const Range& r : ranges) {
        if (r.count() <= 8) {
          next.push_back(r);
          continue;
        }
        Eigen::Index axis = 0;
        BoxOf(r).size().maxCoeff(&axis);
        const std::size_t middle = r.begin + std::max<std::size_t>(8, (r.count() / 2 + 4) / 8 * 8);
        const auto at = [&](std::size_t i) {
          return order_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(at(r.begin), at(middle), at(r.end), [&](std::uint32_t a, std::uint32_t b) {
          const double pa = samples_[a].p[axis];
          const double pb = samples_[b].p[axis];
          return pa != pb ? pa < pb : a < b;
        });
        next.push_back({r.begin, middle});
        next.push_back({middle, r.end});
      }
      ranges = std::move(next);
    }
    return ranges;
  }

  void Fill(std::size_t node, const Range& whole) {
    const std::vector<Range> ranges = Split(whole);
    for (std::size_t k = 0; k < 8; ++k) {
      SphereNode& n = shell_->nodes[node];
      if (k >= ranges.size()) {
        n.x[k] = n.y[k] = n.z[k] = 0;
        n.radius[k] = -std::numeric_limits<float>::infinity();
        n.child[k] = -1;
        continue;
      }
      const Vec3 centre = BoxOf(ranges[k]).centre();
      double radius = 0;
      for (std::size_t i = ranges[k].begin; i < ranges[k].end; ++i) {
        radius = std::max(radius, (samples_[order_[i]].p - centre).norm());
      }
      n.x[k] = static_cast<float>(centre.x());
      n.y[k] = static_cast<float>(centre.y());
      n.z[k] = static_cast<float>(centre.z());
      // Room for single precision, of the tree and of the coarse grid's distance.
      n.radius[k] = static_cast<float>(radius * 1.0001 + 2e-6 * centre.norm() + 1e-7);
      if (ranges[k].count() <= 8) {
        n.child[k] = -2 - AddLeaf(ranges[k]);
      } else {
        const std::size_t child = shell_->nodes.size();
        n.child[k] = static_cast<std::int32_t>(child);
        shell_->nodes.emplace_back();
        Fill(child, ranges[k]);
      }
    }
  }

  std::int32_t AddLeaf(const Range& range) {
    for (std::size_t i = 0; i < 8; ++i) {
      const Sample& s = samples_[order_[std::min(range.begin + i, range.end - 1)]];
      shell_->x.push_back(static_cast<float>(s.p.x()));
      shell_->y.push_back(static_cast<float>(s.p.y()));
      shell_->z.push_back(static_cast<float>(s.p.z()));
      SampleFaces faces{s.faces, {}};
      for (std::size_t f = 0; f < kMaxPointFaces; ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
          faces.normals[f][k] = static_cast<std::int16_t>(
              std::lrint(s.normals[f][static_cast<Eigen::Index>(k)] / SampleFaces::kNormalUnit));
        }
      }
      shell_->faces.push_back(faces);
      shell_->facing.push_back(static_cast<float>(FacingLimit(data_, s)));
      if (has_freeform_) {
        shell_->triangle.push_back(s.triangle);
      }
    }
    shell_->leaf_count.push_back(static_cast<std::uint8_t>(range.count()));
    return static_cast<std::int32_t>(shell_->leaf_count.size()) - 1;
  }

  const Shape::Data& data_;
  const std::vector<Sample>& samples_;
  Shell* shell_;
  bool has_freeform_;
  std::vector<std::uint32_t> order_;
};

}  // namespace

double ChooseSpacing(const Mesh& mesh) {
  spatial::Box box;
  double area = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    box.Add(mesh.vertices[mesh.triangles[t][0]]);
    area += mesh.CalcArea(t);
  }
  return std::max({box.size().norm() / kSpacingsAcross, std::sqrt(area / kMaxFaceSamples), 20e-6});
}

void BuildShells(Shape::Data* data) {
  const std::vector<Sample> samples = SampleAll(*data);
  std::vector<std::uint32_t> all;
  std::vector<std::uint32_t> features;
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    all.push_back(i);
    if (samples[i].is_feature) {
      features.push_back(i);
    }
  }
  TreeBuilder(*data, samples, &data->shell).Build(std::move(all));
  TreeBuilder(*data, samples, &data->features).Build(std::move(features));
}

}  // namespace hvas::contact
