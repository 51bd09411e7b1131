#include "mates/mate_key.h"

#include <cmath>
#include <cstdint>
#include <set>

#include "base/digest.h"

namespace hvas::mates {
namespace {

using product::Feature;
using product::Mate;
using product::Product;

constexpr double kGrid = 1e-6;  // [m], [rad]; section 3 of mates.md: finer than files differ.
// Hex digits, 40 bits: two of 10,000 mates are alike once in 20,000 products.
constexpr std::size_t kDigits = 10;

std::int64_t Round(double value) {
  const double steps = value / kGrid;
  return std::abs(steps) < 9e15 ? std::llround(steps) : 0;
}

void AddVector(const Vec3& v, Digest* digest) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    digest->AddInt(Round(v[i]));
  }
}

void AddFeature(const Feature& feature, Digest* digest) {
  digest->AddInt(static_cast<std::int64_t>(feature.kind));
  AddVector(feature.origin_B, digest);
  AddVector(feature.axis_B, digest);
  for (const double value :
       {feature.radius, feature.half_angle, feature.span_low, feature.span_high}) {
    digest->AddInt(Round(value));
  }
}

void AddSide(const Product& product, const product::Connector& side, Digest* digest) {
  digest->AddText(product.occurrences[side.occurrence.index()].path);
  const auto& features = product.part_of(side.occurrence).features;
  AddFeature(features[side.feature.index()], digest);
  if (side.opposite.is_valid()) {
    AddFeature(features[side.opposite.index()], digest);
  }
}

std::string CalcKey(const Product& product, const Mate& mate, std::int64_t attempt) {
  Digest digest;
  digest.AddInt(static_cast<std::int64_t>(mate.kind));
  AddSide(product, mate.a, &digest);
  AddSide(product, mate.b, &digest);
  if (attempt > 0) {
    digest.AddInt(attempt);
  }
  return digest.Hex().substr(0, kDigits);
}

}  // namespace

std::string CalcKey(const Product& product, const Mate& mate) {
  return CalcKey(product, mate, 0);
}

void AssignKeys(Product* product) {
  std::set<std::string> taken;
  for (Mate& mate : product->mates) {
    std::int64_t attempt = 0;
    do {
      mate.key = CalcKey(*product, mate, attempt++);
    } while (!taken.insert(mate.key).second);
  }
}

}  // namespace hvas::mates
