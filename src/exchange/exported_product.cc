#include "exchange/exported_product.h"

#include <algorithm>

#include <fmt/format.h>

namespace hvas::exchange {
namespace {

using product::Product;

std::string MakeName(const product::Occurrence& occurrence) {
  std::string name = fmt::format("o{}_", occurrence.id.index());
  for (const char c : occurrence.name) {
    const bool is_plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    name += is_plain ? c : '_';
  }
  return name;
}

/** Radii of the features of each part, by part: those of the first mate that sizes a feature. */
std::vector<FeatureRadii> ListRadii(const Product& product,
                                    const std::vector<ExportedMate>& mates) {
  std::vector<FeatureRadii> radii(product.parts.size());
  for (const ExportedMate& exported : mates) {
    const product::Mate& mate = product.mates[exported.mate.index()];
    if (!exported.sizes || mate.kind != product::MateKind::kAxisHole) {
      continue;
    }
    const auto add = [&](const product::Connector& side, double diameter) {
      const product::PartId part = product.occurrences[side.occurrence.index()].part;
      radii[part.index()].emplace(side.feature.index(), 0.5 * diameter);
    };
    add(mate.a, exported.sizes->hole);
    add(mate.b, exported.sizes->shaft);
  }
  return radii;
}

}  // namespace

ExportedProduct MakeExported(const Product& product) {
  ExportedProduct exported;
  exported.product = &product;
  for (const product::Mate& mate : product.mates) {
    exported.mates.push_back({mate.id, "mate_" + mate.key, CalcMateSizes(mate)});
  }
  const std::vector<FeatureRadii> radii = ListRadii(product, exported.mates);
  std::vector<CollisionForm> forms;
  for (const product::Part& part : product.parts) {
    forms.push_back(MakeCollisionForm(part, radii[part.id.index()]));
  }
  for (const product::Occurrence& occurrence : product.occurrences) {
    exported.bodies.push_back(
        {occurrence.id, MakeName(occurrence), forms[occurrence.part.index()]});
  }
  const auto volume_of = [&product](const product::Occurrence& occurrence) {
    return product.parts[occurrence.part.index()].mass.volume;
  };
  exported.base =
      std::max_element(product.occurrences.begin(), product.occurrences.end(),
                       [&](const auto& a, const auto& b) { return volume_of(a) < volume_of(b); })
          ->id;
  return exported;
}

std::string WriteNumber(double x) {
  return fmt::format("{}", x + 0.0);  // No negative zero.
}

std::string WriteNumbers(const Vec3& v) {
  return fmt::format("{} {} {}", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
}

std::string WriteNumbers(const Quat& q) {
  return fmt::format("{} {} {} {}", q.w() + 0.0, q.x() + 0.0, q.y() + 0.0, q.z() + 0.0);
}

std::string EscapeXml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        // Controls are no characters of XML 1.0.
        escaped += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return escaped;
}

}  // namespace hvas::exchange
