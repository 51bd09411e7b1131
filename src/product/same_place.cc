#include "product/same_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

namespace hvas::product {
namespace {

constexpr double kSamePose = 1e-9;   // [m], and as a part of the rotation.
constexpr double kPlaceGrid = 1e-6;  // [m]: the grid of a mate's key.

/** For each part the first one that has its shape. */
std::vector<std::int64_t> FindShapes(const Product& product) {
  std::map<std::string, std::int64_t> first;
  std::vector<std::int64_t> shapes;
  for (std::size_t i = 0; i < product.parts.size(); ++i) {
    const auto own = static_cast<std::int64_t>(i);
    const std::string& hash = product.parts[i].shape_hash;
    shapes.push_back(hash.empty() ? own : first.try_emplace(hash, own).first->second);
  }
  return shapes;
}

}  // namespace

bool IsSamePose(const Pose& X, const Pose& Y) {
  const double turn =
      std::min((X.q().coeffs() - Y.q().coeffs()).norm(), (X.q().coeffs() + Y.q().coeffs()).norm());
  return turn < kSamePose && (X.p() - Y.p()).norm() < kSamePose;
}

std::int64_t PlaceCell(double value) {
  const double steps = value / kPlaceGrid;
  return std::abs(steps) < 9e15 ? std::llround(steps) : 0;
}

std::vector<OccurrenceId> FindOriginals(const Product& product) {
  const std::vector<std::int64_t> shapes = FindShapes(product);
  std::map<std::array<std::int64_t, 4>, std::vector<OccurrenceId>> places;
  std::vector<OccurrenceId> original_of(product.occurrences.size());
  for (const Occurrence& occurrence : product.occurrences) {
    const Vec3& p = occurrence.X_WB.p();
    std::vector<OccurrenceId>& there = places[{shapes[occurrence.part.index()], PlaceCell(p.x()),
                                               PlaceCell(p.y()), PlaceCell(p.z())}];
    const auto original = std::find_if(there.begin(), there.end(), [&](OccurrenceId other) {
      return IsSamePose(product.occurrences[other.index()].X_WB, occurrence.X_WB);
    });
    if (original != there.end()) {
      original_of[occurrence.id.index()] = *original;
    } else {
      there.push_back(occurrence.id);
    }
  }
  return original_of;
}

}  // namespace hvas::product
