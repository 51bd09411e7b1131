#include "contact/field_build.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "base/digest.h"
#include "base/parallel.h"
#include "contact/block_build.h"
#include "contact/near_list.h"
#include "contact/refine.h"
#include "spatial/box.h"

namespace hvas::contact {
namespace {

// [bytes] of blocks for one part: docs/algorithms/contact.md, "Voxel", has it against 5e6.
constexpr double kMemoryAim = 8e6;
constexpr double kBlocksPerPatch =
    2.2;  // Blocks for each patch of surface as large as a block's side.
// Voxels are no finer and no coarser than this [m]: docs/algorithms/contact.md, "Voxel".
constexpr double kSmallestVoxel = 20e-6;
constexpr double kLargestVoxel = 2e-3;

using Index3 = std::array<int, 3>;

// A grid of cubic cells.
struct Grid {
  Vec3 origin;
  double side;
  Index3 count;

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) *
           static_cast<std::size_t>(count[2]);
  }

  [[nodiscard]] std::size_t IndexOf(const Index3& cell) const {
    return static_cast<std::size_t>((cell[2] * count[1] + cell[1]) * count[0] + cell[0]);
  }

  [[nodiscard]] Vec3 CentreOf(const Index3& low, int width) const {
    return origin + side * (Vec3(low[0], low[1], low[2]) + Vec3::Constant(0.5 * width));
  }

  [[nodiscard]] bool Has(const Index3& cell) const {
    return cell[0] < count[0] && cell[1] < count[1] && cell[2] < count[2];
  }
};

// A cube of a grid's cells, with what may be closest to some point of it.
struct Region {
  Index3 low{0, 0, 0};
  int width{1};  // A power of two.
  Vec3 centre{Vec3::Zero()};
  double radius{0};  // Of the ball around it.
  NearSet near;
};

// Calls work(cell) for those of the region's cells that the grid has.
template <typename Work>
void ForEachCell(const Grid& grid, const Region& region, const Work& work) {
  for (int z = region.low[2]; z < std::min(region.low[2] + region.width, grid.count[2]); ++z) {
    for (int y = region.low[1]; y < std::min(region.low[1] + region.width, grid.count[1]); ++y) {
      for (int x = region.low[0]; x < std::min(region.low[0] + region.width, grid.count[0]); ++x) {
        work(Index3{x, y, z});
      }
    }
  }
}

// A grid as an octree. `settle` says of a region whether nothing below it is to be visited.
class Octree {
 public:
  Octree(const NearSearch& search, const Grid& grid) : search_(search), grid_(grid) {}

  // Divides the grid into regions that threads may descend into on their own: descending into one
  // after the other visits what descending into the whole grid would, in the same order.
  template <typename Settle>
  [[nodiscard]] std::vector<Region> Divide(const Settle& settle) const {
    constexpr int kAcross = 8;  // Regions along the longest side of the grid: a choice.
    Region whole;
    while (whole.width < std::max({grid_.count[0], grid_.count[1], grid_.count[2]})) {
      whole.width *= 2;
    }
    whole.centre = grid_.CentreOf(whole.low, whole.width);
    whole.radius = kHalfDiagonal * grid_.side * whole.width;
    search_.Filter(search_.MakeFullList(), whole.centre, whole.radius, &whole.near.list);
    whole.near.least = LeastOf(whole.near.list);
    std::vector<Region> regions;
    if (!settle(whole)) {
      Descend(whole, std::max(1, whole.width / kAcross), settle,
              [&](const Region& region) { regions.push_back(region); });
    }
    return regions;
  }

  // Calls leaf(region) for the regions of `width` cells in another one, depth first.
  template <typename Settle, typename Leaf>
  void Descend(const Region& region, int width, const Settle& settle, const Leaf& leaf) const {
    std::array<BegunFilter, 8> begun;
    Descend(region, width, settle, leaf, &begun);
  }

 private:
  template <typename Settle, typename Leaf>
  void Descend(const Region& region, int width, const Settle& settle, const Leaf& leaf,
               std::array<BegunFilter, 8>* begun) const {
    if (region.width <= width) {
      leaf(region);
      return;
    }
    const int half = region.width / 2;
    const auto low_of = [&](int i) {
      return Index3{region.low[0] + half * (i & 1), region.low[1] + half * ((i >> 1) & 1),
                    region.low[2] + half * (i >> 2)};
    };
    unsigned wanted = 0;
    for (int i = 0; i < 8; ++i) {
      wanted |= grid_.Has(low_of(i)) ? 1U << static_cast<unsigned>(i) : 0U;
    }
    const double radius = kHalfDiagonal * grid_.side * half;
    std::array<NearSet, 8> near;
    search_.FilterOctants(region.near, grid_.CentreOf(low_of(0), half),
                          grid_.CentreOf(low_of(7), half), radius, wanted, begun, &near);
    for (int i = 0; i < 8; ++i) {
      if ((wanted >> static_cast<unsigned>(i) & 1U) == 0) {
        continue;
      }
      const Index3 low = low_of(i);
      const Region octant{low, half, grid_.CentreOf(low, half), radius,
                          std::move(near[static_cast<std::size_t>(i)])};
      if (!settle(octant)) {
        Descend(octant, width, settle, leaf, begun);
      }
    }
  }

  const NearSearch& search_;
  const Grid& grid_;
};

// Hands values on in the order of their numbers, in whatever order threads put them in.
template <typename T>
class InOrder {
 public:
  InOrder(std::size_t count, std::function<void(const T&)> take)
      : waiting_(count), take_(std::move(take)) {}

  void Put(std::size_t number, T value) {
    const std::lock_guard lock(mutex_);
    waiting_[number] = std::move(value);
    for (; next_ < waiting_.size() && waiting_[next_]; ++next_) {
      take_(*waiting_[next_]);
      waiting_[next_].reset();
    }
  }

 private:
  std::mutex mutex_;
  std::vector<std::optional<T>> waiting_;
  std::size_t next_{0};
  std::function<void(const T&)> take_;
};

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

// Finds the numbers of values that were added before.
class Numbers {
 public:
  // The number of the value with this checksum that is_same(number) knows again; `number`, from now
  // on, where there is none.
  template <typename IsSame>
  std::uint32_t FindOrAdd(std::uint64_t checksum, std::uint32_t number, const IsSame& is_same) {
    const auto [begin, end] = numbers_.equal_range(checksum);
    for (auto entry = begin; entry != end; ++entry) {
      if (is_same(entry->second)) {
        return entry->second;
      }
    }
    numbers_.emplace(checksum, number);
    return number;
  }

 private:
  std::unordered_multimap<std::uint64_t, std::uint32_t> numbers_;
};

template <typename T>
std::uint64_t ChecksumOf(const T& values) {
  return Checksum64(std::as_bytes(std::span(values)));
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
    std::array<std::uint32_t, kZonesPerBlock> codes{};
    for (std::size_t z = 0; z < kZonesPerBlock; ++z) {
      const Zone& zone = block.zones[z];
      codes[z] = zone.code == zone::kList ? zone::kList | AddList(block, zone) : zone.code;
    }
    auto& nodes = data_.field.nodes;
    auto& zones = data_.exact.zones;
    std::array<std::uint32_t, kZonesPerBlock> faces{};
    std::transform(codes.begin(), codes.end(), faces.begin(),
                   [this](std::uint32_t code) { return WithoutTriangle(code); });
    const std::array checksums{ChecksumOf(block.nodes), ChecksumOf(faces)};
    const auto count = static_cast<std::uint32_t>(zones.size() / kZonesPerBlock);
    const std::uint32_t number =
        blocks_.FindOrAdd(ChecksumOf(checksums), count, [&](std::uint32_t other) {
          const auto first = static_cast<std::ptrdiff_t>(other);
          return std::equal(faces.begin(), faces.end(), zones.begin() + kZonesPerBlock * first,
                            [this](std::uint32_t face, std::uint32_t code) {
                              return face == WithoutTriangle(code);
                            }) &&
                 std::equal(block.nodes.begin(), block.nodes.end(),
                            nodes.begin() + kBlockNodes * first);
        });
    data_.field.top[static_cast<std::size_t>(block.top)] = static_cast<std::int32_t>(number);
    if (number == count) {
      nodes.insert(nodes.end(), block.nodes.begin(), block.nodes.end());
      zones.insert(zones.end(), codes.begin(), codes.end());
    }
  }

  void Finish() {
    for (std::size_t list = 0; list + 1 < data_.exact.list_begin.size(); ++list) {
      Pack(list);
    }
    data_.field.nodes.resize(data_.field.nodes.size() + 2);  // Pairs are read as one word.
    data_.field.nodes.shrink_to_fit();
  }

 private:
  // The code by which blocks are equal: any triangle of a freeform face will do.
  [[nodiscard]] std::uint32_t WithoutTriangle(std::uint32_t code) const {
    const bool is_smooth = (code & ~zone::kPayload) == zone::kSmooth;
    return is_smooth ? zone::kSmooth | data_.mesh.face[code & zone::kPayload] : code;
  }

  static constexpr double kListReach = 8;  // Largest distance that is told apart, in voxels.

  // Zones with the same triangles share a list: its distances are the least in any of them. Until
  // Finish(), the table has a list's triangles by number, and their distances are beside it.
  std::uint32_t AddList(const Block& block, const Zone& zone) {
    ExactTable& exact = data_.exact;
    list_.assign(block.listed.begin() + zone.begin, block.listed.begin() + zone.end);
    std::sort(list_.begin(), list_.end(),
              [](const NearTriangle& a, const NearTriangle& b) { return a.triangle < b.triangle; });
    triangles_.clear();
    for (const NearTriangle& entry : list_) {
      triangles_.push_back(entry.triangle);
    }
    const auto count = static_cast<std::uint32_t>(exact.list_begin.size() - 1);
    const std::uint32_t number =
        lists_.FindOrAdd(ChecksumOf(triangles_), count, [&](std::uint32_t other) {
          return std::equal(triangles_.begin(), triangles_.end(),
                            exact.listed.begin() + exact.list_begin[other],
                            exact.listed.begin() + exact.list_begin[other + 1]);
        });
    if (number == count) {
      exact.listed.insert(exact.listed.end(), triangles_.begin(), triangles_.end());
      exact.list_begin.push_back(static_cast<std::uint32_t>(exact.listed.size()));
      distances_.resize(exact.listed.size(), std::numeric_limits<double>::infinity());
    }
    for (std::size_t i = 0; i < list_.size(); ++i) {
      double& least = distances_[exact.list_begin[number] + i];
      least = std::min(least, list_[i].distance);
    }
    return number;
  }

  // Gives a list's entries their form in the table.
  void Pack(std::size_t list) {
    ExactTable& exact = data_.exact;
    const std::size_t begin = exact.list_begin[list];
    list_.clear();
    for (std::size_t i = begin; i < exact.list_begin[list + 1]; ++i) {
      list_.push_back({exact.listed[i], distances_[i]});
    }
    std::sort(list_.begin(), list_.end(), IsNearer());
    const double most = static_cast<double>((1U << exact.distance_bits) - 1U);
    for (std::size_t i = 0; i < list_.size(); ++i) {
      const double units = std::floor(list_[i].distance * (1 - 1e-9) / exact.distance_unit);
      exact.listed[begin + i] = list_[i].triangle << exact.distance_bits |
                                static_cast<std::uint32_t>(std::min(units, most));
    }
  }

  Shape::Data& data_;
  Numbers blocks_;
  Numbers lists_;
  std::vector<double> distances_;
  NearList list_;  // That is added or packed.
  std::vector<std::uint32_t> triangles_;
};

Vec3 ToVec3(const float* p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

// Descends to the blocks near the surface. Each is laid down in its turn and goes: only what the
// directory says is there of all at once.
void BuildBlocks(const NearSearch& search, const ShapeOptions& options, Shape::Data* data) {
  const FieldView& view = data->field.view;
  const Grid grid{ToVec3(view.origin),
                  kBlockCells * data->voxel,
                  {view.blocks[0], view.blocks[1], view.blocks[2]}};
  auto& top = data->field.top;
  top.assign(grid.size(), kTopOutside);
  const auto settle = [&](const Region& region) {
    const NearTriangle& least = region.near.least;
    if (least.distance <= CalcBlockReach(data->voxel) + region.radius) {
      return false;
    }
    if (search.FindSigned(region.near.list, region.centre, 0, least.triangle).distance < 0) {
      ForEachCell(grid, region, [&](const Index3& cell) { top[grid.IndexOf(cell)] = kTopInside; });
    }
    return true;
  };
  const Octree octree(search, grid);
  std::vector<Region> regions = octree.Divide(settle);
  Layer layer(data);
  InOrder<std::deque<Block>> finished(regions.size(), [&](const std::deque<Block>& blocks) {
    for (const Block& block : blocks) {
      layer.Add(block);
    }
  });
  ForEachIndex(regions.size(), options.threads, [&](std::size_t i) {
    const Region region = std::exchange(regions[i], {});
    BlockBuilder builder(*data, search);
    std::deque<Block> blocks;
    octree.Descend(region, 1, settle, [&](const Region& cell) {
      if (options.stop.stop_requested()) {
        return;
      }
      Block& block = blocks.emplace_back();
      const std::size_t index = grid.IndexOf(cell.low);
      block.top = static_cast<std::int32_t>(index);
      block.origin = cell.centre - Vec3::Constant(0.5 * grid.side);
      builder.Build(cell.near, &block);
      if (!block.is_near) {
        top[index] = block.is_inside ? kTopInside : kTopOutside;
        blocks.pop_back();
      } else if (block.face != kNoFace) {
        top[index] = kTopFace - static_cast<std::int32_t>(block.face);
        blocks.pop_back();
      }
    });
    finished.Put(i, std::move(blocks));
  });
  layer.Finish();
}

// Fills a piece of the coarse grid. One for each thread.
class CoarseFiller {
 public:
  CoarseFiller(const NearSearch& search, const Grid& grid, std::vector<float>* coarse)
      : search_(search), grid_(grid), coarse_(*coarse) {}

  // Fills the nodes in a region of four cells a side at most: those of each octant together.
  void Fill(const Region& region) {
    const int side = std::max(1, region.width / 2);
    const int last = region.width / side - 1;
    hint_ = region.near.least.triangle;
    for (int i = 0; i < 8; ++i) {
      const Index3 octant{i & 1, (i >> 1) & 1, i >> 2};
      const Index3 low{region.low[0] + side * octant[0], region.low[1] + side * octant[1],
                       region.low[2] + side * octant[2]};
      if (*std::max_element(octant.begin(), octant.end()) <= last && grid_.Has(low)) {
        FillOctant(low, side, region.near.list);
      }
    }
  }

 private:
  void FillOctant(const Index3& low, int side, const NearList& list) {
    NodeGrid nodes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      nodes.count[axis] = static_cast<std::size_t>(std::min(side, grid_.count[axis] - low[axis]));
      for (int i = 0; i < 3; ++i) {
        Index3 at = low;
        at[axis] += i;
        nodes.at[axis][static_cast<std::size_t>(i)] = grid_.CentreOf(at, 1)[static_cast<int>(axis)];
      }
    }
    search_.FindSignedAtNodes(list, hint_, nodes, &room_, &nearest_);
    hint_ = nearest_[0].triangle;  // Octants follow each other.
    std::size_t node = 0;
    for (std::size_t k = 0; k < nodes.count[2]; ++k) {
      for (std::size_t j = 0; j < nodes.count[1]; ++j) {
        for (std::size_t i = 0; i < nodes.count[0]; ++i, ++node) {
          const Index3 at{low[0] + static_cast<int>(i), low[1] + static_cast<int>(j),
                          low[2] + static_cast<int>(k)};
          coarse_[grid_.IndexOf(at)] = static_cast<float>(nearest_[node].distance);
        }
      }
    }
  }

  const NearSearch& search_;
  const Grid& grid_;
  std::vector<float>& coarse_;
  NodeRoom room_;
  std::array<Nearest, NodeGrid::kMost> nearest_;
  std::uint32_t hint_{kNoFace};
};

void BuildCoarse(const NearSearch& search, const ShapeOptions& options, Shape::Data* data) {
  FieldView& view = data->field.view;
  const Vec3 size = data->box_B.size();
  const double cell = std::max(4 * data->voxel, size.norm() / 56);
  view.coarse_cell = static_cast<float>(cell);
  Grid grid;
  grid.side = static_cast<double>(view.coarse_cell);
  for (int k = 0; k < 3; ++k) {
    const int count = static_cast<int>(std::ceil(size[k] / cell)) + 5;
    grid.count[static_cast<std::size_t>(k)] = count;
    view.coarse_count[k] = count;
    view.coarse_origin[k] = static_cast<float>(-0.5 * (count - 1) * cell);
  }
  // Its nodes are the centres of the cells.
  grid.origin = ToVec3(view.coarse_origin) - Vec3::Constant(0.5 * grid.side);
  auto& coarse = data->field.coarse;
  coarse.assign(grid.size(), 0.0F);
  const auto settle = [](const Region&) { return false; };
  const Octree octree(search, grid);
  const std::vector<Region> regions = octree.Divide(settle);
  ForEachIndex(regions.size(), options.threads, [&](std::size_t i) {
    CoarseFiller filler(search, grid, &coarse);
    octree.Descend(regions[i], 4, settle, [&](const Region& region) { filler.Fill(region); });
  });
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
      if (std::abs(phi) > static_cast<double>(kSlackVoxels) * h) {
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
  BuildCoarse(search, options, data);
  data->field.Bind();
  MeasureSlack(options, data);
  data->field.Bind();
}

}  // namespace hvas::contact
