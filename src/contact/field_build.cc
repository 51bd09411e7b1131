#include "contact/field_build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "contact/refine.h"
#include "spatial/box.h"

namespace hvas::contact {
namespace {

constexpr double kBandVoxels = 4.0;
constexpr double kExactVoxels = 2.0;  // Depth of the layer that is answered exactly.
constexpr double kMemoryAim = 8e6;    // [bytes] of blocks for one part.
constexpr double kBlocksPerPatch =
    2.2;  // Blocks for each patch of surface as large as a block's side.
constexpr double kSmallestVoxel = 20e-6;
constexpr double kLargestVoxel = 2e-3;
constexpr double kSlack = 1 + 1e-9;
constexpr double kRounding = 1e-13;  // [m]
constexpr double kAnywhere = std::numeric_limits<double>::infinity();
const double kHalfDiagonal = std::sqrt(3.0) / 2;

struct NearTriangle {
  std::uint32_t triangle;
  double distance;
};

using NearList = std::vector<NearTriangle>;

// A box around a triangle: tells most that are too far away at a tenth of the exact distance's
// cost.
struct TriangleBox {
  double centre[3];
  double half[3];
  double radius;  // Of a sphere around it.

  [[nodiscard]] double CalcSquaredDistance(const Vec3& p) const {
    const double x = std::max(std::abs(p.x() - centre[0]) - half[0], 0.0);
    const double y = std::max(std::abs(p.y() - centre[1]) - half[1], 0.0);
    const double z = std::max(std::abs(p.z() - centre[2]) - half[2], 0.0);
    return x * x + y * y + z * z;
  }
};

std::vector<TriangleBox> MakeBoxes(const Mesh& mesh) {
  std::vector<TriangleBox> boxes;
  boxes.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    spatial::Box box;
    for (const std::uint32_t v : t) {
      box.Add(mesh.vertices[v]);
    }
    const Vec3 c = box.centre();
    const Vec3 half = 0.5 * box.size();
    boxes.push_back({{c.x(), c.y(), c.z()}, {half.x(), half.y(), half.z()}, half.norm()});
  }
  return boxes;
}

// Keeps, of the triangles given, those that may be closest to some point within `radius` of c.
// First by their boxes; then by their distance where the box is large against `radius`, so says
// little. The distances written are lower bounds, and exact where `is_exact` asks for it.
void Filter(const Mesh& mesh, const std::vector<TriangleBox>& boxes, const NearList& list,
            const Vec3& c, double radius, bool is_exact, NearList* out) {
  const auto calc_exact = [&](std::uint32_t triangle) {
    return (mesh.ClosestOn(triangle, c).q - c).norm();
  };
  const auto limit_of = [&](double least) { return (least + 2 * radius) * kSlack + kRounding; };
  out->resize(list.size());
  NearTriangle lowest{kNoFace, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::uint32_t triangle = list[i].triangle;
    const NearTriangle entry{triangle, boxes[triangle].CalcSquaredDistance(c)};
    (*out)[i] = entry;
    if (entry.distance < lowest.distance) {
      lowest = entry;
    }
  }
  double least = calc_exact(lowest.triangle);
  double limit = limit_of(least);
  std::size_t kept = 0;
  for (const NearTriangle& entry : *out) {
    if (entry.distance > limit * limit) {
      continue;
    }
    double distance = std::sqrt(entry.distance);
    if (is_exact || boxes[entry.triangle].radius > 0.5 * radius) {
      distance = calc_exact(entry.triangle);
      if (distance < least) {
        least = distance;
        limit = limit_of(least);
      }
    }
    if (distance <= limit) {
      (*out)[kept++] = {entry.triangle, distance};
    }
  }
  out->resize(kept);
  out->erase(std::remove_if(out->begin(), out->end(),
                            [&](const NearTriangle& entry) { return entry.distance > limit; }),
             out->end());
}

void SortByDistance(NearList* list) {
  std::sort(list->begin(), list->end(), [](const NearTriangle& a, const NearTriangle& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  });
}

NearTriangle LeastOf(const NearList& list) {
  return *std::min_element(
      list.begin(), list.end(),
      [](const NearTriangle& a, const NearTriangle& b) { return a.distance < b.distance; });
}

struct Nearest {
  double distance{0};  // Signed.
  std::uint32_t triangle{kNoFace};
};

// Signed distance at p from a list with lower bounds of the distances to a point that p is `offset`
// away from. Begins with the triangle `hint`.
Nearest CalcNearest(const Mesh& mesh, const std::vector<TriangleBox>& boxes, const NearList& list,
                    const Vec3& p, double offset, std::uint32_t hint) {
  double squared = std::numeric_limits<double>::infinity();
  double best = squared;
  double limit = squared;
  Nearest nearest;
  TrianglePoint best_point;
  const auto look = [&](std::uint32_t triangle) {
    const TrianglePoint point = mesh.ClosestOn(triangle, p);
    const double found = (point.q - p).squaredNorm();
    if (found < squared) {
      squared = found;
      best = std::sqrt(found);
      limit = best * kSlack + kRounding;
      best_point = point;
      nearest.triangle = triangle;
    }
  };
  look(hint);
  for (const NearTriangle& entry : list) {
    if (entry.distance - offset <= limit &&
        boxes[entry.triangle].CalcSquaredDistance(p) <= limit * limit && entry.triangle != hint) {
      look(entry.triangle);
    }
  }
  bool is_inside =
      (p - best_point.q).dot(mesh.Pseudonormal(nearest.triangle, best_point.feature)) < 0;
  if (mesh.IsOpenAt(nearest.triangle, best_point.feature)) {
    is_inside = mesh.CalcWindingNumber(p) > 0.5;
  }
  nearest.distance = is_inside ? -best : best;
  return nearest;
}

using Index3 = std::array<int, 3>;

// Walks a grid of cells as an octree and hands each cell's list to `leaf`: of what is closest
// within the cell, or to its centre only. `skip` may settle a whole region at once.
enum class LeafNeeds { kCell, kCentre };

template <typename Leaf, typename Skip>
class Descent {
 public:
  Descent(const Mesh& mesh, const std::vector<TriangleBox>& boxes, const Vec3& origin, double side,
          const Index3& count, LeafNeeds needs, Leaf leaf, Skip skip)
      : mesh_(mesh),
        boxes_(boxes),
        origin_(origin),
        side_(side),
        count_(count),
        needs_(needs),
        leaf_(leaf),
        skip_(skip) {}

  void Run() {
    int width = 1;
    while (width < std::max({count_[0], count_[1], count_[2]})) {
      width *= 2;
    }
    NearList all(mesh_.triangles.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) {
      all[t] = {t, 0.0};
    }
    Visit({0, 0, 0}, width, all);
  }

 private:
  void Visit(const Index3& low, int width, const NearList& parent) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (low[k] >= count_[k]) {
        return;
      }
    }
    const Vec3 centre =
        origin_ + side_ * (Vec3(low[0], low[1], low[2]) + Vec3::Constant(0.5 * width));
    const bool is_point = width == 1 && needs_ == LeafNeeds::kCentre;
    const double radius = is_point ? 0 : kHalfDiagonal * side_ * width;
    NearList list;
    Filter(mesh_, boxes_, parent, centre, radius, false, &list);
    if (skip_(low, width, centre, radius, list)) {
      return;
    }
    if (width == 1) {
      leaf_(low, centre, list);
      return;
    }
    const int half = width / 2;
    for (int i = 0; i < 8; ++i) {
      Visit({low[0] + half * (i & 1), low[1] + half * ((i >> 1) & 1), low[2] + half * (i >> 2)},
            half, list);
    }
  }

  const Mesh& mesh_;
  const std::vector<TriangleBox>& boxes_;
  Vec3 origin_;
  double side_;
  Index3 count_;
  LeafNeeds needs_;
  Leaf leaf_;
  Skip skip_;
};

template <typename Leaf, typename Skip>
void Descend(const Mesh& mesh, const std::vector<TriangleBox>& boxes, const Vec3& origin,
             double side, const Index3& count, LeafNeeds needs, Leaf leaf, Skip skip) {
  Descent<Leaf, Skip>(mesh, boxes, origin, side, count, needs, leaf, skip).Run();
}

// Runs work(i) for i < count on two threads; the results do not depend on who does what.
template <typename Work>
void ForEach(std::size_t count, Work work) {
  std::thread other([&] {
    for (std::size_t i = 1; i < count; i += 2) {
      work(i);
    }
  });
  for (std::size_t i = 0; i < count; i += 2) {
    work(i);
  }
  other.join();
}

struct Zone {
  std::uint32_t code{zone::kFar};
  std::vector<ListedTriangle> list;
};

struct Block {
  std::int32_t top{0};
  Vec3 origin{Vec3::Zero()};
  NearList list;
  std::array<std::int16_t, kBlockNodes> nodes{};
  std::array<Zone, kZonesPerBlock> zones;
  bool is_near{false};
  bool is_inside{false};
};

class BlockBuilder {
 public:
  BlockBuilder(const Shape::Data& data, const std::vector<TriangleBox>& boxes)
      : data_(data), boxes_(boxes), h_(data.voxel) {}

  void Build(Block* block) {
    // By way of the eight octants, so that each zone's list is cut from a short one.
    NearList octant;
    for (int o = 0; o < 8; ++o) {
      const Index3 low{2 * (o & 1), 2 * ((o >> 1) & 1), 2 * (o >> 2)};
      const Vec3 centre = block->origin + 2 * h_ * (Vec3(low[0], low[1], low[2]) + Vec3::Ones());
      Filter(data_.mesh, boxes_, block->list, centre, 4 * kHalfDiagonal * h_, false, &octant);
      for (int z = 0; z < 8; ++z) {
        BuildZone({low[0] + (z & 1), low[1] + ((z >> 1) & 1), low[2] + (z >> 2)}, octant, block);
      }
    }
    block->list = {};
  }

 private:
  void BuildZone(const Index3& zone, const NearList& octant, Block* block) {
    const Vec3 centre = block->origin + h_ * (2.0 * Vec3(zone[0], zone[1], zone[2]) + Vec3::Ones());
    const double radius = 2 * kHalfDiagonal * h_;
    // Zones follow each other: what was closest to one is near the next.
    hint_ = hint_ == kNoFace ? octant.front().triangle : hint_;
    const Nearest nearest = CalcNearest(data_.mesh, boxes_, octant, centre, kAnywhere, hint_);
    hint_ = nearest.triangle;
    face_ = data_.mesh.face[hint_];
    if (std::abs(nearest.distance) > kBandVoxels * h_ * kSlack + radius) {
      FillFarZone(zone, nearest.distance, block);
      return;
    }
    Filter(data_.mesh, boxes_, octant, centre, radius, false, &list_);
    is_one_face_ = std::all_of(list_.begin(), list_.end(), [&](const NearTriangle& n) {
      return data_.mesh.face[n.triangle] == face_;
    });
    is_exact_ = is_one_face_ && AgreesWithFace(centre);
    DecideZone(centre, radius,
               &block->zones[static_cast<std::size_t>(zone[2] * 16 + zone[1] * 4 + zone[0])]);
    FillNodes(zone, centre, block);
  }

  static Index3 EndOf(const Index3& zone) {
    Index3 end{};
    for (std::size_t k = 0; k < 3; ++k) {
      end[k] = 2 * zone[k] + (zone[k] == 3 ? 3 : 2);
    }
    return end;
  }

  // All nodes are beyond the band, on one side of the surface.
  void FillFarZone(const Index3& zone, double distance, Block* block) const {
    block->zones[static_cast<std::size_t>(zone[2] * 16 + zone[1] * 4 + zone[0])].code =
        zone::kFar | face_;
    block->is_inside = distance < 0;
    const Index3 end = EndOf(zone);
    for (int k = 2 * zone[2]; k < end[2]; ++k) {
      for (int j = 2 * zone[1]; j < end[1]; ++j) {
        for (int i = 2 * zone[0]; i < end[0]; ++i) {
          block->nodes[static_cast<std::size_t>(k * 81 + j * 9 + i)] =
              distance < 0 ? -32767 : 32767;
        }
      }
    }
  }

  void FillNodes(const Index3& zone, const Vec3& centre, Block* block) {
    const double quantum = kBandVoxels * h_ / 32767;
    const Index3 end = EndOf(zone);
    for (int k = 2 * zone[2]; k < end[2]; ++k) {
      for (int j = 2 * zone[1]; j < end[1]; ++j) {
        for (int i = 2 * zone[0]; i < end[0]; ++i) {
          const double phi = DistanceAt(block->origin + h_ * Vec3(i, j, k), centre);
          block->is_near = block->is_near || std::abs(phi) < kBandVoxels * h_;
          block->is_inside = phi < 0;
          const double units = std::clamp(phi / quantum, -32767.0, 32767.0);
          block->nodes[static_cast<std::size_t>(k * 81 + j * 9 + i)] =
              static_cast<std::int16_t>(std::lrint(units));
        }
      }
    }
  }

  double DistanceAt(const Vec3& p, const Vec3& centre) {
    if (is_exact_) {
      const auto exact = spatial::CalcDistance(data_.exact.faces[face_], p);
      if (exact.is_valid) {
        return exact.distance;
      }
    }
    const Nearest nearest = CalcNearest(data_.mesh, boxes_, list_, p, (p - centre).norm(), hint_);
    hint_ = nearest.triangle;
    return nearest.distance;
  }

  void DecideZone(const Vec3& centre, double radius, Zone* out) {
    if (LeastOf(list_).distance > kExactVoxels * h_ + radius) {
      out->code = zone::kFar | face_;
    } else if (is_exact_) {
      out->code = zone::kExact | face_;
    } else if (is_one_face_ && !HasSharpEdge() &&
               data_.exact.faces[face_].kind == spatial::SurfaceKind::kFreeform) {
      out->code = zone::kSmooth | face_;
    } else {
      out->code = zone::kList;
      NearList listed;
      Filter(data_.mesh, boxes_, list_, centre, radius, true, &listed);
      SortByDistance(&listed);
      for (const NearTriangle& entry : listed) {
        out->list.push_back({entry.triangle, static_cast<float>(entry.distance * (1 - 1e-6))});
      }
    }
  }

  bool HasSharpEdge() const {
    for (const NearTriangle& entry : list_) {
      for (const EdgeKind kind : data_.mesh.edge_kind[entry.triangle]) {
        if (kind == EdgeKind::kConvex || kind == EdgeKind::kConcave) {
          return true;
        }
      }
    }
    return false;
  }

  // The unbounded surface may come closer than the face does, on the far side of an axis.
  bool AgreesWithFace(const Vec3& centre) {
    if (data_.exact.faces[face_].kind == spatial::SurfaceKind::kFreeform) {
      return false;
    }
    const double tolerance = 2 * data_.exact.deviation[face_] + 1e-9;
    for (int i = 0; i < 9; ++i) {
      Vec3 p = centre;
      if (i < 8) {
        p += h_ * Vec3((i & 1) * 2.0 - 1, ((i >> 1) & 1) * 2.0 - 1, (i >> 2) * 2.0 - 1);
      }
      const auto exact = spatial::CalcDistance(data_.exact.faces[face_], p);
      const Nearest nearest = CalcNearest(data_.mesh, boxes_, list_, p, (p - centre).norm(), hint_);
      hint_ = nearest.triangle;
      if (!exact.is_valid || std::abs(exact.distance - nearest.distance) > tolerance) {
        return false;
      }
    }
    return true;
  }

  const Shape::Data& data_;
  const std::vector<TriangleBox>& boxes_;
  double h_;
  // Of the zone at hand.
  NearList list_;
  std::uint32_t hint_{kNoFace};
  std::uint32_t face_{0};
  bool is_one_face_{false};
  bool is_exact_{false};
};

void BuildBlocks(const std::vector<TriangleBox>& boxes, Shape::Data* data) {
  FieldView& view = data->field.view;
  const double side = kBlockCells * data->voxel;
  const Vec3 origin(static_cast<double>(view.origin[0]), static_cast<double>(view.origin[1]),
                    static_cast<double>(view.origin[2]));
  const Index3 count{view.blocks[0], view.blocks[1], view.blocks[2]};
  auto& top = data->field.top;
  top.assign(static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) *
                 static_cast<std::size_t>(count[2]),
             kTopOutside);
  const auto index_of = [&](int x, int y, int z) {
    return static_cast<std::size_t>((z * count[1] + y) * count[0] + x);
  };
  std::vector<Block> blocks;
  const auto leaf = [&](const Index3& low, const Vec3& centre, const NearList& list) {
    Block block;
    block.top = static_cast<std::int32_t>(index_of(low[0], low[1], low[2]));
    block.origin = centre - Vec3::Constant(0.5 * side);
    block.list = list;
    blocks.push_back(std::move(block));
  };
  const auto skip = [&](const Index3& low, int width, const Vec3& centre, double radius,
                        NearList& list) {
    const NearTriangle least = LeastOf(list);
    if (least.distance <= kBandVoxels * data->voxel + radius) {
      return false;
    }
    if (CalcNearest(data->mesh, boxes, list, centre, 0, least.triangle).distance < 0) {
      for (int z = low[2]; z < std::min(low[2] + width, count[2]); ++z) {
        for (int y = low[1]; y < std::min(low[1] + width, count[1]); ++y) {
          for (int x = low[0]; x < std::min(low[0] + width, count[0]); ++x) {
            top[index_of(x, y, z)] = kTopInside;
          }
        }
      }
    }
    return true;
  };
  Descend(data->mesh, boxes, origin, side, count, LeafNeeds::kCell, leaf, skip);
  ForEach(blocks.size(), [&](std::size_t i) { BlockBuilder(*data, boxes).Build(&blocks[i]); });

  ExactTable& exact = data->exact;
  exact.list_begin.push_back(0);
  for (const Block& block : blocks) {
    std::int32_t& entry = top[static_cast<std::size_t>(block.top)];
    if (!block.is_near) {
      entry = block.is_inside ? kTopInside : kTopOutside;
      continue;
    }
    entry = static_cast<std::int32_t>(data->field.nodes.size() / kBlockNodes);
    data->field.nodes.insert(data->field.nodes.end(), block.nodes.begin(), block.nodes.end());
    for (const Zone& z : block.zones) {
      if (z.code == zone::kList) {
        exact.zones.push_back(zone::kList |
                              static_cast<std::uint32_t>(exact.list_begin.size() - 1));
        exact.listed.insert(exact.listed.end(), z.list.begin(), z.list.end());
        exact.list_begin.push_back(static_cast<std::uint32_t>(exact.listed.size()));
      } else {
        exact.zones.push_back(z.code);
      }
    }
  }
  data->field.nodes.resize(data->field.nodes.size() + 2);  // Pairs are read as one word.
  data->field.nodes.shrink_to_fit();
}

void BuildCoarse(const std::vector<TriangleBox>& boxes, Shape::Data* data) {
  FieldView& view = data->field.view;
  const Vec3 size = data->box_B.size();
  const double cell = std::max(4 * data->voxel, size.norm() / 56);
  view.coarse_cell = static_cast<float>(cell);
  Index3 count{};
  Vec3 origin;
  for (int k = 0; k < 3; ++k) {
    count[static_cast<std::size_t>(k)] = static_cast<int>(std::ceil(size[k] / cell)) + 5;
    view.coarse_count[k] = count[static_cast<std::size_t>(k)];
    view.coarse_origin[k] = static_cast<float>(-0.5 * (view.coarse_count[k] - 1) * cell);
    origin[k] = static_cast<double>(view.coarse_origin[k]);
  }
  const double side = static_cast<double>(view.coarse_cell);
  data->field.coarse.assign(static_cast<std::size_t>(count[0]) *
                                static_cast<std::size_t>(count[1]) *
                                static_cast<std::size_t>(count[2]),
                            0.0F);
  Descend(
      data->mesh, boxes, origin - Vec3::Constant(0.5 * side), side, count, LeafNeeds::kCentre,
      [&](const Index3& low, const Vec3& centre, NearList& list) {
        const double phi =
            CalcNearest(data->mesh, boxes, list, centre, 0, LeastOf(list).triangle).distance;
        data->field
            .coarse[static_cast<std::size_t>((low[2] * count[1] + low[1]) * count[0] + low[0])] =
            static_cast<float>(phi);
      },
      [](const Index3&, int, const Vec3&, double, NearList&) { return false; });
}

double CalcTrilinear(const FieldView& view, int block, const Index3& cell) {
  const std::int16_t* d = view.nodes + block * kBlockNodes + cell[2] * 81 + cell[1] * 9 + cell[0];
  double sum = 0;
  for (const int offset : {0, 1, 9, 10, 81, 82, 90, 91}) {
    sum += d[offset];
  }
  return sum / 8 * static_cast<double>(view.quantum);
}

// How far the interpolated distance is from the exact one, at most, in each block's exact layer:
// looked at in the middle of the cells, where interpolation is worst.
void MeasureSlack(Shape::Data* data) {
  constexpr double kSafety = 1.5;
  FieldView& view = data->field.view;
  const double h = data->voxel;
  data->field.slack.assign(data->exact.zones.size() / kZonesPerBlock, 0.0F);
  const auto measure = [&](std::size_t top_index) {
    const std::int32_t block = data->field.top[top_index];
    if (block < 0) {
      return;
    }
    const int index = static_cast<int>(top_index);
    const Index3 at{index % view.blocks[0], index / view.blocks[0] % view.blocks[1],
                    index / view.blocks[0] / view.blocks[1]};
    double worst = 0;
    for (int c = 0; c < 512; ++c) {
      const Index3 cell{c & 7, (c >> 3) & 7, c >> 6};
      const double phi = CalcTrilinear(view, block, cell);
      if (std::abs(phi) > 1.2 * h) {
        continue;
      }
      Vec3 p;
      for (int k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(k);
        p[k] = static_cast<double>(view.origin[k]) + h * (8 * at[i] + cell[i] + 0.5);
      }
      const Hit field{0, static_cast<float>(phi), {0.0F, 0.0F, 1.0F}};
      worst = std::max(worst, phi - Refine(*data, p, field, {}).distance);
    }
    data->field.slack[static_cast<std::size_t>(block)] =
        static_cast<float>(kSafety * worst + 2 * static_cast<double>(view.quantum));
  };
  ForEach(data->field.top.size(), measure);
}

}  // namespace

double ChooseVoxel(const Mesh& mesh, const std::vector<spatial::Surface>& faces) {
  spatial::Box box;
  for (const Vec3& v : mesh.vertices) {
    box.Add(v);
  }
  const double size = box.size().norm();
  double area = 0;
  for (const auto& t : mesh.triangles) {
    area += 0.5 * (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                      .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                      .norm();
  }
  double radius = std::numeric_limits<double>::infinity();
  for (const spatial::Surface& face : faces) {
    const bool is_torus = face.kind == spatial::SurfaceKind::kTorus;
    const double r = is_torus ? face.second : face.radius;
    const bool is_round = is_torus || face.kind == spatial::SurfaceKind::kCylinder ||
                          face.kind == spatial::SurfaceKind::kSphere;
    if (is_round && r > size / 200) {
      radius = std::min(radius, r);
    }
  }
  const double bytes = 2.0 * kBlockNodes + 4.0 * kZonesPerBlock;
  const double by_memory = std::sqrt(area * kBlocksPerPatch * bytes / kMemoryAim) / kBlockCells;
  const double least = std::max({by_memory, size / 400, kSmallestVoxel});
  const double most = std::max(least, std::min(size / 150, kLargestVoxel));
  return std::clamp(radius / 6, least, most);
}

void CheckFaces(const Mesh& mesh, ExactTable* exact) {
  exact->deviation.assign(exact->faces.size(), 0.0);
  std::vector<double> agreement(exact->faces.size(), 0.0);
  std::vector<double> extent(exact->faces.size(), 0.0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t f = mesh.face[t];
    const Vec3& a = mesh.vertices[mesh.triangles[t][0]];
    const Vec3& b = mesh.vertices[mesh.triangles[t][1]];
    const Vec3& c = mesh.vertices[mesh.triangles[t][2]];
    extent[f] = std::max({extent[f], (b - a).norm(), (c - a).norm()});
    for (const Vec3& p : {a, b, c, Vec3((a + b) / 2), Vec3((b + c) / 2), Vec3((c + a) / 2),
                          Vec3((a + b + c) / 3)}) {
      const auto exact_point = spatial::CalcDistance(exact->faces[f], p);
      if (exact_point.is_valid) {
        exact->deviation[f] = std::max(exact->deviation[f], std::abs(exact_point.distance));
        agreement[f] += exact_point.gradient.dot(mesh.normal[t]) * (b - a).cross(c - a).norm();
      }
    }
  }
  for (std::size_t f = 0; f < exact->faces.size(); ++f) {
    if (agreement[f] < 0) {
      exact->faces[f].outward = -exact->faces[f].outward;
    }
    constexpr double kLargestDeviation = 0.1;  // Of the face's extent: another surface altogether.
    if (exact->deviation[f] > kLargestDeviation * extent[f]) {
      exact->faces[f].kind = spatial::SurfaceKind::kFreeform;
      exact->deviation[f] = 0;
    }
  }
}

void BuildField(Shape::Data* data) {
  FieldView& view = data->field.view;
  view.voxel = static_cast<float>(data->voxel);
  data->voxel = static_cast<double>(view.voxel);
  view.band = static_cast<float>(kBandVoxels * data->voxel);
  view.quantum = static_cast<float>(kBandVoxels * data->voxel / 32767);
  const Vec3 half = 0.5 * data->box_B.size();
  for (int k = 0; k < 3; ++k) {
    view.low[k] = static_cast<float>(-half[k]);
    view.high[k] = static_cast<float>(half[k]);
    const double reach = half[k] + (kBandVoxels + 0.5) * data->voxel;
    view.blocks[k] = static_cast<int>(std::ceil(2 * reach / (kBlockCells * data->voxel)));
    view.origin[k] = static_cast<float>(-0.5 * view.blocks[k] * kBlockCells * data->voxel);
  }
  const std::vector<TriangleBox> boxes = MakeBoxes(data->mesh);
  BuildBlocks(boxes, data);
  BuildCoarse(boxes, data);
  data->field.Bind();
  MeasureSlack(data);
  data->field.Bind();
}

}  // namespace hvas::contact
