#include "evidence/given_parts.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/units.h"
#include "session/deformable_json.h"

namespace hvas::evidence {

using simulation::Deformable;
using simulation::DeformationKind;
using simulation::DeformationSource;

Result<std::vector<GivenPart>> FindGivenParts(record::Reader* reader,
                                              const record::Reader::Span& span,
                                              const product::Product& product) {
  const auto deformables = session::ReadDeformables(product, reader);
  if (!deformables) {
    return Unexpected(deformables.error());
  }
  std::vector<GivenPart> parts;
  std::vector<const DeformationSource*> sources;  // One for each of them.
  for (const Deformable& part : *deformables) {
    for (const DeformationSource& source : part.sources) {
      if (source.curve != nullptr) {
        const double grows = part.sign * (part.form.shares[0] + part.form.shares[1]);
        parts.push_back(
            {part.occurrence.value(), source.moved.value(), part.form.kind, grows < 0, 0});
        sources.push_back(&source);
      }
    }
  }
  if (parts.empty()) {
    return parts;
  }
  std::vector<spatial::Pose> X_WB;
  for (const product::Occurrence& occurrence : product.occurrences) {
    X_WB.push_back(occurrence.X_WB);
  }
  const Result<void> done = reader->ForEachTick(span, [&](const record::TickRecord& tick) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (parts[i].moved == tick.held) {
        X_WB[tick.held] = tick.X_WD;
        parts[i].largest =
            std::max(parts[i].largest, simulation::CalcGiven(product, *sources[i], X_WB));
        X_WB[tick.held] = product.occurrences[tick.held].X_WB;
      }
    }
    return true;
  });
  if (!done) {
    return Unexpected(done.error());
  }
  // Arms of one part that bend together are one.
  std::vector<GivenPart> given;
  for (const GivenPart& part : parts) {
    const auto known = std::find_if(given.begin(), given.end(), [&](const GivenPart& other) {
      return other.occurrence == part.occurrence && other.moved == part.moved &&
             other.kind == part.kind;
    });
    if (known != given.end()) {
      known->largest = std::max(known->largest, part.largest);
    } else if (part.largest >= simulation::kLeastDrawn) {
      given.push_back(part);
    }
  }
  return given;
}

std::string Describe(const GivenPart& part) {
  const char* what = "is pressed together";
  switch (part.kind) {
    case DeformationKind::kBend:
      what = "bends";
      break;
    case DeformationKind::kFlare:
      what = "bends all around";
      break;
    case DeformationKind::kRadial:
      what = part.gets_smaller ? "is squeezed" : "is stretched in radius";
      break;
    case DeformationKind::kOpen:
      what = part.gets_smaller ? "closes in radius" : "opens in radius";
      break;
    default:
      break;
  }
  return fmt::format("{} by {:.2f} mm", what, units::ToMm(part.largest));
}

}  // namespace hvas::evidence
