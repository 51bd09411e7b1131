#include "paths/swept_volume.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "base/units.h"
#include "paths/part_field.h"

namespace hvas::paths {
namespace {

using spatial::Box;
using spatial::Pose;

constexpr double kMostCells = 20e6;   // 80 MB of distances: a choice.
constexpr double kCellsAcross = 100;  // of the largest extent, when no resolution is given
constexpr double kChosenCells = 4e6;  // at most, for a thin wall: some seconds; a choice
constexpr int kBrickNodes = 8;        // along an axis
constexpr double kBandCells = 3;      // on both sides of the surface, where values are right
constexpr double kStep = 0.5;         // of a cell, that points move between samples

/** X_BW of a sample, quick to apply. */
struct Sample {
  Mat3 R_BW;
  Vec3 p_BW;

  [[nodiscard]] Vec3 operator*(const Vec3& p_W) const { return R_BW * p_W + p_BW; }
};

/** Nodes that are near the surface, and the samples that have the part near them. */
struct Leaf {
  NodeRange range;
  std::vector<std::uint32_t> samples;
};

class Sweeping {
 public:
  Sweeping(const PartField& part, const Path& fine, double step, Grid* grid)
      : part_(part), step_(step), band_(kBandCells * grid->spacing), grid_(*grid) {
    for (const Pose& X_WB : fine) {
      const Pose X_BW = X_WB.Inverse();
      samples_.push_back({X_BW.R(), X_BW.p()});
    }
  }

  /** Says of all nodes far from the surface on which side they are, and lists the others. */
  std::vector<Leaf> FindLeaves() {
    std::vector<std::uint32_t> all(samples_.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = static_cast<std::uint32_t>(i);
    }
    Divide({{{0, 0, 0}, grid_.count}, std::move(all)});
    return std::move(leaves_);
  }

  void Fill(const Leaf& leaf) const {
    ForEachNode(grid_, leaf.range, [&](std::size_t node, const Vec3& p_W) {
      const std::uint32_t sample = FindLeast(p_W, leaf.samples);
      double least = part_.At(samples_[sample] * p_W);
      // The sign of nodes further away than a cell's diagonal is certain, and all that is needed.
      if (std::abs(least) < 2 * grid_.spacing + part_.error()) {
        least = Refine(p_W, sample, &grid_.normals[node]);
      }
      grid_.values[node] = static_cast<float>(std::clamp(least, -band_, band_));
    });
  }

 private:
  void Divide(Leaf cell) {
    const Vec3 centre = cell.range.CalcCentre(grid_);
    const double reach = cell.range.CalcRadius(grid_) + band_ + part_.error();
    std::vector<std::uint32_t> near;
    for (const std::uint32_t i : cell.samples) {
      const double distance = part_.At(samples_[i] * centre);
      if (distance < -reach) {
        return Set(cell.range, -band_);
      }
      if (distance <= reach) {
        near.push_back(i);
      }
    }
    if (near.empty()) {
      return Set(cell.range, band_);
    }
    cell.samples = std::move(near);
    if (cell.range.longest() <= kBrickNodes) {
      leaves_.push_back(std::move(cell));
      return;
    }
    for (const NodeRange& part : cell.range.Split()) {
      Divide({part, cell.samples});
    }
  }

  /** The sample that has the part nearest, or deep enough. */
  [[nodiscard]] std::uint32_t FindLeast(const Vec3& p_W,
                                        const std::vector<std::uint32_t>& listed) const {
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t best = listed.front();
    std::uint32_t next = 0;
    for (const std::uint32_t i : listed) {
      if (i < next) {
        continue;
      }
      const double distance = part_.At(samples_[i] * p_W);
      if (distance < least) {
        least = distance;
        best = i;
      }
      if (least < -band_) {
        break;
      }
      // Nothing moves further than a step from one sample to the next.
      next = i + std::max(1U, static_cast<std::uint32_t>((distance - least) / step_));
    }
    return best;
  }

  /** The exact distance, least on the ways to a sample and from it; outside, with its direction. */
  double Refine(const Vec3& p_W, std::uint32_t sample, std::array<std::int16_t, 3>* normal) const {
    Vec3 best_B = samples_[sample] * p_W;
    PartField::Nearest nearest = part_.ExactAt(best_B);
    for (const std::uint32_t from : {std::max(sample, 1U) - 1, sample}) {
      if (from + 1 < samples_.size()) {
        const Vec3 p_B = FindLeastBetween(p_W, from);
        const PartField::Nearest found = part_.ExactAt(p_B);
        if (found.distance < nearest.distance) {
          nearest = found;
          best_B = p_B;
        }
      }
    }
    if (nearest.distance > 0) {
      const Vec3 away_W = samples_[sample].R_BW.transpose() * (best_B - nearest.q_B);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        (*normal)[axis] = static_cast<std::int16_t>(std::lround(
            away_W[static_cast<Eigen::Index>(axis)] / (nearest.distance * Grid::kNormalUnit)));
      }
    }
    return nearest.distance;
  }

  /** Where a point is, as seen from B, when it is nearest between a sample and the next: by golden
   section; in so short a time it goes straight. */
  [[nodiscard]] Vec3 FindLeastBetween(const Vec3& p_W, std::size_t sample) const {
    constexpr double kGolden = 0.6180339887498949;  // (sqrt(5) - 1) / 2.
    constexpr int kSections = 6;  // Sections of the way, to 0.618^6 = 1/18 of it: a choice.
    const Vec3 from = samples_[sample] * p_W;
    const Vec3 way = samples_[sample + 1] * p_W - from;
    const auto at = [&](double t) { return part_.ExactAt(from + t * way).distance; };
    double low = 0;
    double high = 1;
    double left = at(1 - kGolden);
    double right = at(kGolden);
    for (int i = 0; i < kSections; ++i) {
      if (left < right) {
        high = low + kGolden * (high - low);
        right = left;
        left = at(high - kGolden * (high - low));
      } else {
        low = high - kGolden * (high - low);
        left = right;
        right = at(low + kGolden * (high - low));
      }
    }
    return from + 0.5 * (low + high) * way;
  }

  void Set(const NodeRange& range, double value) {
    ForEachNode(grid_, range, [&](std::size_t node, const Vec3&) {
      grid_.values[node] = static_cast<float>(value);
    });
  }

  const PartField& part_;
  double step_;
  double band_;
  Grid& grid_;
  std::vector<Sample> samples_;
  std::vector<Leaf> leaves_;
};

Box BoxOf(const contact::ShapeSource& part) {
  Box box;
  for (const Vec3& vertex : part.vertices) {
    box.Add(vertex);
  }
  return box;
}

/** Around the part at all poses. */
Box BoxAlong(const Path& path, const Box& box_B) {
  Box box_W;
  for (const Pose& X_WB : path) {
    box_W.Add(spatial::Transform(X_WB, box_B));
  }
  return box_W;
}

Result<void> Check(const contact::ShapeSource& part, const Path& path,
                   const SweepOptions& options) {
  if (part.triangles.empty()) {
    return Fail(ErrorCode::kInvalid, "the part has no triangles", "", "choose a part with a shape");
  }
  if (path.empty() || !std::all_of(path.begin(), path.end(), spatial::IsFinite)) {
    return Fail(ErrorCode::kInvalid, "the path has no poses, or a pose that is not finite", "", "");
  }
  if (!(options.resolution >= 0) || !std::isfinite(options.resolution)) {
    return Fail(ErrorCode::kInvalid, "the resolution must be a positive length", "", "");
  }
  return {};
}

/** Bound of the error for one of the resolution: a distance changes by no more than the way, linear
 between nodes, by half a cell's diagonal, and by half a step between samples. */
constexpr double kErrorPerCell = 0.5 * std::numbers::sqrt3 + 0.5 * kStep;

/** A hundredth of the extent; finer where a wall needs that and there is room for the cells. */
double ChooseResolution(const Box& box_W, double thinnest_wall) {
  const double usual = box_W.size().maxCoeff() / kCellsAcross;
  if (!(thinnest_wall > 0)) {
    return usual;
  }
  const double possible = std::cbrt(box_W.size().prod() / kChosenCells);
  return std::min(usual, std::max(thinnest_wall / (2 * kErrorPerCell), possible));
}

/** Errors (kOutOfResource): too many cells. */
Result<Grid> MakeGridAround(const Box& box_W, double resolution) {
  const Box around = box_W.Expanded((kBandCells + 1) * resolution);
  const double cells = (around.size() / resolution).prod();
  if (cells > kMostCells) {
    const double possible = resolution * std::cbrt(cells / kMostCells);
    return Fail(ErrorCode::kOutOfResource,
                fmt::format("a resolution of {:.3g} mm needs {:.0f} million cells here",
                            units::ToMm(resolution), 1e-6 * cells),
                "", fmt::format("choose {:.2g} mm or more", 1.1 * units::ToMm(possible)));
  }
  Grid grid = MakeGrid(around.low, around.high, resolution);
  grid.values.resize(grid.IndexOf(0, 0, grid.count[2]));
  grid.normals.resize(grid.values.size());
  return grid;
}

}  // namespace

Result<SweptVolume> Sweep(const contact::ShapeSource& part, const Path& path,
                          const SweepOptions& options) {
  if (const auto checked = Check(part, path, options); !checked) {
    return Unexpected(checked.error());
  }
  const Box box_B = BoxOf(part);
  SweptVolume swept;
  swept.resolution = options.resolution > 0
                         ? options.resolution
                         : ChooseResolution(BoxAlong(path, box_B), options.thinnest_wall);
  const double step = kStep * swept.resolution;
  const Path fine = Resample(path, box_B, step);
  auto grid = MakeGridAround(BoxAlong(fine, box_B), swept.resolution);
  if (!grid) {
    return Unexpected(grid.error());
  }
  const PartField field(part, step, (kBandCells + 1) * swept.resolution, options.threads);
  Sweeping sweeping(field, fine, step, &*grid);
  const std::vector<Leaf> leaves = sweeping.FindLeaves();
  ForEachIndex(
      leaves.size(), options.threads,
      [&](std::size_t i) {
        if (!options.stop.stop_requested()) {
          sweeping.Fill(leaves[i]);
        }
      },
      [&](std::size_t done) {
        if (options.progress) {
          options.progress(static_cast<double>(done) / static_cast<double>(leaves.size()));
        }
      });
  if (options.stop.stop_requested()) {
    return Fail(ErrorCode::kCancelled, "the computation of the swept volume was cancelled", "", "");
  }
  swept.mesh = ExtractSurface(*grid);
  if (swept.mesh.triangles.empty()) {
    return Fail(ErrorCode::kInvalid, "the part is thinner than a cell of the grid", "",
                "choose a finer resolution");
  }
  swept.volume = CalcVolume(swept.mesh);
  swept.error = kErrorPerCell * swept.resolution;
  return swept;
}

}  // namespace hvas::paths
