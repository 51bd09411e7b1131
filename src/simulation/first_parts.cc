#include "simulation/first_parts.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

#include "product/accessories.h"
#include "sequence/base_choice.h"
#include "sequence/neighbours.h"

namespace hvas::simulation {
namespace {

using product::OccurrenceId;
using product::PartId;

bool HasAccessories(const product::Product& product) {
  using product::AccessoryKind;
  return !ListAccessories(product, AccessoryKind::kTool).empty() ||
         !ListAccessories(product, AccessoryKind::kFixture).empty() ||
         !ListAccessories(product, AccessoryKind::kBench).empty();
}

}  // namespace

FirstParts ChooseFirstParts(const product::Product& product) {
  constexpr double kMostOfOthers = 0.25;  // A choice: enough to begin with.
  const auto count_triangles = [&product](PartId id) {
    return product.parts[id.index()].mesh.triangles.size();
  };
  std::size_t all = 0;
  for (std::size_t i = 0; i < product.parts.size(); ++i) {
    all += count_triangles(PartId(i));
  }
  if (HasAccessories(product)) {
    return {};  // Tools and fixtures are there from the beginning.
  }
  if (product.occurrences.empty()) {
    return {};
  }
  const auto smaller = [&product](OccurrenceId a, OccurrenceId b) {
    return sequence::SizeOf(product.part_of(a)) < sequence::SizeOf(product.part_of(b));
  };
  std::vector<OccurrenceId> by_size;
  for (const product::Occurrence& occurrence : product.occurrences) {
    by_size.push_back(occurrence.id);
  }
  std::stable_sort(by_size.begin(), by_size.end(), smaller);
  const sequence::Neighbours mated = sequence::FindMated(product, {});
  FirstParts first;
  first.base = sequence::ChooseBase(product, by_size, mated);
  const PartId base_part = product.occurrences[first.base.index()].part;
  std::set<PartId> joined;
  for (const OccurrenceId id : mated[first.base.index()]) {
    joined.insert(product.occurrences[id.index()].part);
  }
  joined.erase(base_part);
  std::vector<PartId> smallest_first(joined.begin(), joined.end());
  std::stable_sort(smallest_first.begin(), smallest_first.end(),
                   [&](PartId a, PartId b) { return count_triangles(a) < count_triangles(b); });
  std::size_t taken = 0;
  const double most = kMostOfOthers * static_cast<double>(all - count_triangles(base_part));
  for (const PartId id : smallest_first) {
    if (static_cast<double>(taken + count_triangles(id)) > most) {
      break;
    }
    taken += count_triangles(id);
    first.parts.push_back(id);
  }
  if (!first.parts.empty()) {
    first.parts.push_back(base_part);
    first.share =
        static_cast<double>(taken + count_triangles(base_part)) / static_cast<double>(all);
  }
  return first;
}

Result<std::shared_ptr<const contact::Shape>> MakeBoxShape(const product::Part& part) {
  constexpr double kVoxelsAcross = 16;  // A choice: nothing asks how far away it is.
  // Two triangles a side, outward; corner i is high along x, y and z where bits 0, 1 and 2 are set.
  constexpr std::array<std::array<std::uint32_t, 3>, 12> kTriangles{{{0, 2, 1},
                                                                     {1, 2, 3},
                                                                     {4, 5, 6},
                                                                     {5, 7, 6},
                                                                     {0, 1, 4},
                                                                     {1, 5, 4},
                                                                     {2, 6, 3},
                                                                     {3, 6, 7},
                                                                     {0, 4, 2},
                                                                     {2, 4, 6},
                                                                     {1, 3, 5},
                                                                     {3, 7, 5}}};
  const double size = part.box_B.size().norm();
  const spatial::Box box = part.box_B.Expanded(1e-6 * size);  // So that a sheet has a thickness.
  contact::ShapeSource source;
  for (std::uint32_t i = 0; i < 8; ++i) {
    source.vertices.emplace_back((i & 1U) != 0 ? box.high.x() : box.low.x(),
                                 (i & 2U) != 0 ? box.high.y() : box.low.y(),
                                 (i & 4U) != 0 ? box.high.z() : box.low.z());
  }
  source.triangles.assign(kTriangles.begin(), kTriangles.end());
  source.triangle_face.assign(kTriangles.size(), 0);
  source.faces.emplace_back();
  contact::ShapeOptions options;
  options.voxel = size / kVoxelsAcross;
  options.point_spacing = size / kVoxelsAcross;
  options.threads = 1;
  return contact::Shape::Build(source, options);
}

}  // namespace hvas::simulation
