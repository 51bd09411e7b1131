#include "mates/stated_fits.h"

#include <algorithm>
#include <optional>
#include <string>

#include "mates/make_fit.h"
#include "mates/mate_kind.h"

namespace hvas::mates {
namespace {

using product::Dimension;
using product::Feature;
using product::Fit;
using product::Mate;
using product::Part;
using product::Product;

enum class Coverage { kHole, kShaft, kBoth };

Coverage CoverageOf(const std::string& code) {
  if (code.find('/') != std::string::npos) {
    return Coverage::kBoth;
  }
  const bool is_hole = !code.empty() && code.front() >= 'A' && code.front() <= 'Z';
  return is_hole ? Coverage::kHole : Coverage::kShaft;
}

/** The first dimension on a connector's faces that states a fit of that coverage. */
const Dimension* FindStated(const Product& product, const product::Connector& connector,
                            Coverage coverage, WorkWatch* watch) {
  const Part& part = product.part_of(connector.occurrence);
  const Feature& feature = part.features[connector.feature.index()];
  for (const Dimension& dimension : part.dimensions) {
    if (!MayGoOn(watch)) {
      break;
    }
    const bool is_on_feature = std::any_of(
        dimension.faces.begin(), dimension.faces.end(), [&feature](product::FaceId face) {
          return std::find(feature.faces.begin(), feature.faces.end(), face) != feature.faces.end();
        });
    if (is_on_feature && dimension.fit && CoverageOf(*dimension.fit) == coverage) {
      return &dimension;
    }
  }
  return nullptr;
}

std::optional<Fit> MakeFit(const std::string& code, const Dimension& dimension,
                           const std::string& entities) {
  const double times = dimension.kind == product::DimensionKind::kRadius ? 2 : 1;
  const double nominal = times * dimension.nominal;
  const auto parsed = fits::ParseFit(code);
  const auto fit = parsed ? MakeWholeFit(*parsed, nominal, "stated in the file (" + entities + ")")
                          : Unexpected(parsed.error());
  return fit ? std::optional(*fit) : std::nullopt;
}

std::optional<Fit> FindFit(const Product& product, const Mate& mate, WorkWatch* watch) {
  for (const product::Connector& connector : {mate.a, mate.b}) {
    if (const Dimension* both = FindStated(product, connector, Coverage::kBoth, watch)) {
      return MakeFit(*both->fit, *both, both->entity);
    }
  }
  const Dimension* hole = FindStated(product, mate.a, Coverage::kHole, watch);
  const Dimension* shaft = FindStated(product, mate.b, Coverage::kShaft, watch);
  if (hole == nullptr || shaft == nullptr) {
    return std::nullopt;
  }
  return MakeFit(*hole->fit + "/" + *shaft->fit, *hole, hole->entity + ", " + shaft->entity);
}

}  // namespace

int AssignStatedFits(Product* product, WorkWatch* watch) {
  int count = 0;
  for (Mate& mate : product->mates) {
    if (!HasFit(mate.kind) || !CheckDrawnPress(mate)) {
      continue;
    }
    if (std::optional<Fit> fit = FindFit(*product, mate, watch)) {
      mate.fit = std::move(fit);
      ++count;
    }
  }
  return count;
}

}  // namespace hvas::mates
