#include "contact/field_build.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <unordered_map>

#include "base/digest.h"
#include "base/parallel.h"
#include "contact/block_build.h"
#include "contact/near_list.h"
#include "contact/refine.h"
#include "spatial/box.h"

namespace hvas::contact {
namespace {

constexpr double kMemoryAim = 8e6;  // [bytes] of blocks for one part.
constexpr double kBlocksPerPatch =
    2.2;  // Blocks for each patch of surface as large as a block's side.
// Voxels are no finer and no coarser than this [m]: docs/algorithms/contact.md, "Voxel".
constexpr double kSmallestVoxel = 20e-6;
constexpr double kLargestVoxel = 2e-3;

using Index3 = std::array<int, 3>;

// Walks a grid of cells as an octree and hands each cell's list to `leaf`: of what is closest
// within the cell, or to its centre only. `skip` may settle a whole region at once.
enum class LeafNeeds { kCell, kCentre };

template <typename Leaf, typename Skip>
class Descent {
 public:
  Descent(const NearSearch& search, const Vec3& origin, double side, const Index3& count,
          LeafNeeds needs, Leaf leaf, Skip skip)
      : search_(search),
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
    Visit({0, 0, 0}, width, search_.MakeFullList());
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
    search_.Filter(parent, centre, radius, false, &list);
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

  const NearSearch& search_;
  Vec3 origin_;
  double side_;
  Index3 count_;
  LeafNeeds needs_;
  Leaf leaf_;
  Skip skip_;
};

template <typename Leaf, typename Skip>
void Descend(const NearSearch& search, const Vec3& origin, double side, const Index3& count,
             LeafNeeds needs, Leaf leaf, Skip skip) {
  Descent<Leaf, Skip>(search, origin, side, count, needs, leaf, skip).Run();
}

// Calls work(i) for i < count in runs of equal length; MakeWorker gives each run its own.
template <typename MakeWorker>
void ForEachInRuns(std::size_t count, const ShapeOptions& options, MakeWorker make) {
  constexpr std::size_t kRun = 32;  // Blocks that a thread takes at once: a choice.
  ForEachIndex((count + kRun - 1) / kRun, options.threads, [&](std::size_t run) {
    if (options.stop.stop_requested()) {
      return;
    }
    auto work = make();
    for (std::size_t i = run * kRun; i < std::min(count, (run + 1) * kRun); ++i) {
      work(i);
    }
  });
}

// Finds values that were added before, by their bytes.
class Pool {
 public:
  // The number of the first value with these bytes; `number` when there was none.
  std::uint32_t FindOrAdd(std::vector<std::byte> bytes, std::uint32_t number) {
    auto& bucket = numbers_[Checksum64(bytes)];
    for (const std::uint32_t candidate : bucket) {
      if (values_[candidate] == bytes) {
        return candidate;
      }
    }
    bucket.push_back(number);
    values_.resize(std::max<std::size_t>(values_.size(), number + 1U));
    values_[number] = std::move(bytes);
    return number;
  }

 private:
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> numbers_;
  std::vector<std::vector<std::byte>> values_;
};

template <typename T>
void Append(std::span<const T> values, std::vector<std::byte>* bytes) {
  const auto raw = std::as_bytes(values);
  bytes->insert(bytes->end(), raw.begin(), raw.end());
}

// Lays blocks down in the field, equal ones once.
class Layer {
 public:
  explicit Layer(Shape::Data* data) : data_(*data) {
    ExactTable& exact = data_.exact;
    const auto bits = static_cast<std::uint32_t>(std::bit_width(data_.mesh.triangles.size() - 1));
    exact.distance_bits = std::min(12U, 32U - bits);
    exact.distance_unit = kListReach * data_.voxel / static_cast<double>(1U << exact.distance_bits);
    exact.list_begin.push_back(0);
  }

  void Add(const Block& block) {
    std::int32_t& entry = data_.field.top[static_cast<std::size_t>(block.top)];
    if (!block.is_near) {
      entry = block.is_inside ? kTopInside : kTopOutside;
      return;
    }
    if (block.face != kNoFace) {
      entry = kTopFace - static_cast<std::int32_t>(block.face);
      return;
    }
    std::array<std::uint32_t, kZonesPerBlock> codes{};
    for (std::size_t z = 0; z < kZonesPerBlock; ++z) {
      const Zone& zone = block.zones[z];
      codes[z] = zone.code == zone::kList ? zone::kList | AddList(zone.list) : zone.code;
    }
    std::vector<std::byte> bytes;
    bytes.reserve(sizeof(block.nodes) + sizeof(codes));
    Append(std::span<const std::int16_t>(block.nodes), &bytes);
    Append(std::span<const std::uint32_t>(codes), &bytes);
    const std::uint32_t number = blocks_.FindOrAdd(std::move(bytes), count_);
    entry = static_cast<std::int32_t>(number);
    if (number == count_) {
      ++count_;
      data_.field.nodes.insert(data_.field.nodes.end(), block.nodes.begin(), block.nodes.end());
      data_.exact.zones.insert(data_.exact.zones.end(), codes.begin(), codes.end());
    }
  }

  void Finish() {
    for (NearList& list : lists_) {
      PackList(std::move(list));
    }
    data_.field.nodes.resize(data_.field.nodes.size() + 2);  // Pairs are read as one word.
    data_.field.nodes.shrink_to_fit();
  }

 private:
  static constexpr double kListReach = 8;  // Largest distance that is told apart, in voxels.

  // Zones with the same triangles share a list: its distances are the least in any of them.
  std::uint32_t AddList(NearList list) {
    std::sort(list.begin(), list.end(),
              [](const NearTriangle& a, const NearTriangle& b) { return a.triangle < b.triangle; });
    std::vector<std::uint32_t> triangles;
    for (const NearTriangle& entry : list) {
      triangles.push_back(entry.triangle);
    }
    std::vector<std::byte> bytes;
    Append(std::span<const std::uint32_t>(triangles), &bytes);
    const std::uint32_t number =
        pool_.FindOrAdd(std::move(bytes), static_cast<std::uint32_t>(lists_.size()));
    if (number == lists_.size()) {
      lists_.push_back(std::move(list));
    } else {
      for (std::size_t i = 0; i < list.size(); ++i) {
        double& least = lists_[number][i].distance;
        least = std::min(least, list[i].distance);
      }
    }
    return number;
  }

  void PackList(NearList list) {
    ExactTable& exact = data_.exact;
    std::sort(list.begin(), list.end(), [](const NearTriangle& a, const NearTriangle& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
    });
    const double most = static_cast<double>((1U << exact.distance_bits) - 1U);
    for (const NearTriangle& entry : list) {
      const double units = std::floor(entry.distance * (1 - 1e-9) / exact.distance_unit);
      exact.listed.push_back(entry.triangle << exact.distance_bits |
                             static_cast<std::uint32_t>(std::min(units, most)));
    }
    exact.list_begin.push_back(static_cast<std::uint32_t>(exact.listed.size()));
  }

  Shape::Data& data_;
  std::uint32_t count_{0};
  Pool blocks_;
  Pool pool_;  // Of lists, by their triangles.
  std::vector<NearList> lists_;
};

// The blocks that may come near the surface, with what is near them; the directory says already
// where the others are.
std::vector<Block> FindBlocks(const NearSearch& search, Shape::Data* data) {
  const FieldView& view = data->field.view;
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
                        const NearList& list) {
    const NearTriangle least = LeastOf(list);
    if (least.distance <= CalcBlockReach(data->voxel) + radius) {
      return false;
    }
    if (search.FindSigned(list, centre, 0, least.triangle).distance < 0) {
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
  Descend(search, origin, side, count, LeafNeeds::kCell, leaf, skip);
  return blocks;
}

void BuildBlocks(const NearSearch& search, const ShapeOptions& options, Shape::Data* data) {
  std::vector<Block> blocks = FindBlocks(search, data);
  ForEachInRuns(blocks.size(), options, [&] {
    return [&, builder = BlockBuilder(*data, search)](std::size_t i) mutable {
      builder.Build(&blocks[i]);
    };
  });
  Layer layer(data);
  for (Block& block : blocks) {
    layer.Add(block);
    block = {};
  }
  layer.Finish();
}

void BuildCoarse(const NearSearch& search, Shape::Data* data) {
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
      search, origin - Vec3::Constant(0.5 * side), side, count, LeafNeeds::kCentre,
      [&](const Index3& low, const Vec3& centre, const NearList& list) {
        const double phi = search.FindSigned(list, centre, 0, LeastOf(list).triangle).distance;
        data->field
            .coarse[static_cast<std::size_t>((low[2] * count[1] + low[1]) * count[0] + low[0])] =
            static_cast<float>(phi);
      },
      [](const Index3&, int, const Vec3&, double, const NearList&) { return false; });
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
void MeasureSlack(const ShapeOptions& options, Shape::Data* data) {
  constexpr double kSafety = 1.5;  // Half as much again: docs/algorithms/contact.md, "Voxel".
  const FieldView& view = data->field.view;
  const double h = data->voxel;
  data->field.slack.assign(data->exact.zones.size() / kZonesPerBlock, 0.0F);
  std::vector<int> place(data->field.slack.size());  // One of those where a block stands.
  for (std::size_t i = 0; i < data->field.top.size(); ++i) {
    if (data->field.top[i] >= 0) {
      place[static_cast<std::size_t>(data->field.top[i])] = static_cast<int>(i);
    }
  }
  const auto measure = [&](std::size_t block) {
    const Index3 at{place[block] % view.blocks[0], place[block] / view.blocks[0] % view.blocks[1],
                    place[block] / view.blocks[0] / view.blocks[1]};
    double worst = 0;
    for (int c = 0; c < 512; ++c) {
      const Index3 cell{c & 7, (c >> 3) & 7, c >> 6};
      const double phi = CalcTrilinear(view, static_cast<int>(block), cell);
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
    data->field.slack[block] =
        static_cast<float>(kSafety * worst + 2 * static_cast<double>(view.quantum));
  };
  ForEachInRuns(place.size(), options, [&] { return measure; });
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
        agreement[f] += exact_point.gradient.dot(mesh.NormalOf(t)) * (b - a).cross(c - a).norm();
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

void BuildField(const ShapeOptions& options, Shape::Data* data) {
  FieldView& view = data->field.view;
  view.voxel = static_cast<float>(data->voxel);
  data->voxel = static_cast<double>(view.voxel);
  view.band = static_cast<float>(kBandVoxels * data->voxel);
  // All nodes of a block that is left out are further away than this, and every point in it is no
  // more than half a diagonal of a cell from one of them.
  const double block_reach = CalcBlockReach(data->voxel);
  view.beyond = static_cast<float>(block_reach - kHalfDiagonal * data->voxel);
  view.quantum = static_cast<float>(kBandVoxels * data->voxel / 32767);
  const Vec3 half = 0.5 * data->box_B.size();
  for (int k = 0; k < 3; ++k) {
    view.low[k] = static_cast<float>(-half[k]);
    view.high[k] = static_cast<float>(half[k]);
    const double reach = half[k] + block_reach + 0.5 * data->voxel;
    view.blocks[k] = static_cast<int>(std::ceil(2 * reach / (kBlockCells * data->voxel)));
    view.origin[k] = static_cast<float>(-0.5 * view.blocks[k] * kBlockCells * data->voxel);
  }
  const NearSearch search(data->mesh);
  BuildBlocks(search, options, data);
  if (options.stop.stop_requested()) {
    return;
  }
  BuildCoarse(search, data);
  data->field.Bind();
  MeasureSlack(options, data);
  data->field.Bind();
}

}  // namespace hvas::contact
