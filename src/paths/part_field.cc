#include "paths/part_field.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/check.h"
#include "base/parallel.h"

namespace hvas::paths {
namespace {

using contact::NearList;

constexpr double kMostNodes = 4e6;  // 16 MB of distances: a choice.
constexpr int kListNodes = 5;       // Along an axis: fewer are not worth a list of their own.

/** Pieces that are worth a thread each. */
std::vector<NodeRange> SplitTwice(const Grid& grid) {
  std::vector<NodeRange> pieces;
  for (const NodeRange& half : NodeRange{{0, 0, 0}, grid.count}.Split()) {
    const auto parts = half.Split();
    pieces.insert(pieces.end(), parts.begin(), parts.end());
  }
  return pieces;
}

}  // namespace

/** Fills a piece of a field's grid, from the triangles that can be closest there. */
class FieldFiller {
 public:
  explicit FieldFiller(PartField* field) : field_(*field), grid_(field->grid_) {}

  void Fill(const NodeRange& range, const NearList& list) {
    const Vec3 centre = range.CalcCentre(grid_);
    const double radius = range.CalcRadius(grid_);
    const double distance = field_.search_
                                .FindSigned(list, centre, contact::NearSearch::kAnywhere,
                                            contact::LeastOf(list).triangle)
                                .distance;
    if (std::abs(distance) > radius + field_.band_) {
      const auto least = static_cast<float>(std::copysign(std::abs(distance) - radius, distance));
      ForEachNode(grid_, range, [&](std::size_t node, const Vec3&) { grid_.values[node] = least; });
      return;
    }
    NearList near;
    field_.search_.Filter(list, centre, radius + grid_.spacing, &near);
    if (range.longest() <= kListNodes) {
      FillLeaf(range, {centre, contact::LeastOf(near).triangle, std::move(near)});
      return;
    }
    for (const NodeRange& part : range.Split()) {
      Fill(part, near);
    }
  }

  /** Its leaves go behind those of the field. */
  void Join(const NodeRange& piece) {
    const auto first = static_cast<std::uint32_t>(field_.leaves_.size());
    ForEachNode(grid_, piece, [&](std::size_t node, const Vec3&) {
      std::uint32_t& leaf = field_.leaf_of_node_[node];
      leaf += leaf == PartField::kNoLeaf ? 0 : first;
    });
    std::move(leaves_.begin(), leaves_.end(), std::back_inserter(field_.leaves_));
  }

 private:
  void FillLeaf(const NodeRange& range, PartField::Leaf leaf) {
    ForEachNode(grid_, range, [&](std::size_t node, const Vec3& p) {
      const double offset = (p - leaf.centre).norm();
      grid_.values[node] =
          static_cast<float>(field_.search_.FindSigned(leaf.near, p, offset, leaf.hint).distance);
      field_.leaf_of_node_[node] = static_cast<std::uint32_t>(leaves_.size());
    });
    leaves_.push_back(std::move(leaf));
  }

  PartField& field_;
  Grid& grid_;
  std::vector<PartField::Leaf> leaves_;
};

PartField::PartField(const contact::ShapeSource& part, double spacing, double band,
                     unsigned threads)
    : mesh_(contact::MakeMesh(part, Vec3::Zero())), search_(mesh_), band_(band) {
  HVAS_DEMAND(!part.triangles.empty());
  for (const Vec3& vertex : part.vertices) {
    box_.Add(vertex);
  }
  const spatial::Box around = box_.Expanded(band_ + spacing);
  const double possible = std::cbrt(around.size().prod() / kMostNodes);
  grid_ = MakeGrid(around.low, around.high, std::max(spacing, possible));
  grid_.values.resize(grid_.IndexOf(0, 0, grid_.count[2]));
  leaf_of_node_.assign(grid_.values.size(), kNoLeaf);
  const NearList everything = search_.MakeFullList();
  const std::vector<NodeRange> pieces = SplitTwice(grid_);
  std::vector<FieldFiller> fillers(pieces.size(), FieldFiller(this));
  ForEachIndex(pieces.size(), threads,
               [&](std::size_t i) { fillers[i].Fill(pieces[i], everything); });
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    fillers[i].Join(pieces[i]);
  }
}

PartField::Nearest PartField::ExactAt(const Vec3& p_B) const {
  const Vec3 at = (p_B - grid_.origin) / grid_.spacing;
  std::array<int, 3> node{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = std::round(at[static_cast<Eigen::Index>(axis)]);
    if (!(x >= 0 && x < grid_.count[axis])) {
      return {At(p_B), p_B};
    }
    node[axis] = static_cast<int>(x);
  }
  const std::uint32_t leaf = leaf_of_node_[grid_.IndexOf(node[0], node[1], node[2])];
  if (leaf == kNoLeaf) {
    return {At(p_B), p_B};
  }
  const Leaf& found = leaves_[leaf];
  const contact::Nearest nearest =
      search_.FindSigned(found.near, p_B, (p_B - found.centre).norm(), found.hint);
  return {nearest.distance, nearest.point.q};
}

double PartField::At(const Vec3& p_B) const {
  const Vec3 at = (p_B - grid_.origin) / grid_.spacing;
  std::array<int, 3> cell{};
  std::array<double, 3> fraction{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = at[static_cast<Eigen::Index>(axis)];
    if (!(x >= 0 && x < grid_.count[axis] - 1)) {
      return (p_B - p_B.cwiseMax(box_.low).cwiseMin(box_.high)).norm();
    }
    cell[axis] = static_cast<int>(x);
    fraction[axis] = x - cell[axis];
  }
  const float* corner = &grid_.values[grid_.IndexOf(cell[0], cell[1], cell[2])];
  const std::size_t row = static_cast<std::size_t>(grid_.count[0]);
  const std::size_t layer = row * static_cast<std::size_t>(grid_.count[1]);
  const auto along_x = [&](std::size_t offset) {
    const auto a = static_cast<double>(corner[offset]);
    return a + fraction[0] * (static_cast<double>(corner[offset + 1]) - a);
  };
  const auto along_xy = [&](std::size_t offset) {
    const double a = along_x(offset);
    return a + fraction[1] * (along_x(offset + row) - a);
  };
  const double a = along_xy(0);
  return a + fraction[2] * (along_xy(layer) - a);
}

double PartField::error() const {
  // A distance changes by no more than the way: at worst, in a cell's middle, half its diagonal.
  return 0.5 * std::sqrt(3.0) * grid_.spacing;
}

}  // namespace hvas::paths
