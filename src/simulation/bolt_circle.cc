#include "simulation/bolt_circle.h"

#include <set>

#include "fits/pressed_parts.h"
#include "mates/elastic_parts.h"

namespace hvas::simulation {
namespace {

using product::Mate;
using product::OccurrenceId;
using product::Product;

bool HasThread(const Product& product, OccurrenceId screw) {
  for (const Mate& mate : product.mates) {
    if (mate.b.occurrence == screw && mate.fit && mate.fit->kind == product::FitKind::kThread) {
      return true;
    }
  }
  return false;
}

/** Screws through the holes of a gasket. */
std::set<OccurrenceId> ListScrews(const Product& product, OccurrenceId gasket) {
  std::set<OccurrenceId> screws;
  for (const Mate& mate : product.mates) {
    if (mate.kind == product::MateKind::kAxisHole && mate.a.occurrence == gasket &&
        HasThread(product, mate.b.occurrence)) {
      screws.insert(mate.b.occurrence);
    }
  }
  return screws;
}

/** Compression of a gasket under a force, by bisection [m]. Its force rises without a limit. */
double FindSqueeze(const fits::PressedPart& gasket, double force, double thickness) {
  constexpr int kHalvings = 60;  // A double resolves no more.
  double low = 0;
  double high = thickness;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (fits::CalcPressForce(gasket, middle) < force ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double SoftenByGaskets(const Product& product, OccurrenceId screw, double stiffness,
                       double preload) {
  if (!(stiffness > 0) || !(preload > 0)) {
    return stiffness;
  }
  double compliance = 1 / stiffness;
  for (const product::ElasticPart& part : product.elastic) {
    const auto law = mates::MakePressedPart(part);
    if (part.kind != product::ElasticKind::kGasket || !law) {
      continue;
    }
    const std::set<OccurrenceId> screws = ListScrews(product, part.occurrence);
    if (screws.count(screw) > 0) {
      const double force = static_cast<double>(screws.size()) * preload;
      compliance += FindSqueeze(*law, force, part.free_size) / preload;
    }
  }
  return 1 / compliance;
}

}  // namespace hvas::simulation
