#include "app/assembly/path_clearance.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/command_watch.h"
#include "app/output/progress.h"
#include "app/output/text_table.h"
#include "assembly/prepare_model.h"
#include "base/crash_note.h"
#include "base/units.h"
#include "paths/clearance.h"
#include "simulation/shapes.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using product::OccurrenceId;
using product::Product;

// No point of the part moves further from one pose to the next, so that a clearance is found to
// half of it: below what people see in a drawing, above the error of contact by far. A choice.
constexpr double kStep = 0.1 * units::kMetresPerMillimetre;

Json PointMm(const Vec3& p) {
  return {units::ToMm(p.x()), units::ToMm(p.y()), units::ToMm(p.z())};
}

bool HasMate(const Product& product, OccurrenceId a, OccurrenceId b) {
  return std::any_of(product.mates.begin(), product.mates.end(),
                     [&](const product::Mate& mate) { return mate.Joins(a, b); });
}

}  // namespace

Result<Json> DescribeClearances(const LoadOptions& load, const Product& product, OccurrenceId id,
                                const paths::Path& path,
                                const std::map<OccurrenceId, spatial::Pose>& others) {
  const bool is_watched = !load.is_quiet && IsWatched();
  const auto cache = assembly::MakeShapeCache(CacheDirectory(load));
  simulation::ShapesControl control;
  control.cache = cache.get();
  control.shape.stop = CommandWatch::Get().stop();
  if (is_watched) {
    control.progress = [](double fraction) { ShowProgress("contact shapes", fraction); };
  }
  NoteStage("contact shapes");
  const auto shapes = simulation::BuildShapes(product, control);
  if (!shapes) {
    return Unexpected(shapes.error());
  }
  const auto shape_of = [&](OccurrenceId of) {
    return (*shapes)[product.occurrences[of.index()].part.index()].get();
  };
  std::vector<OccurrenceId> ids;
  std::vector<paths::Neighbour> neighbours;
  for (const auto& [other, X_WN] : others) {
    if (other != id) {
      ids.push_back(other);
      neighbours.push_back({shape_of(other), X_WN});
    }
  }
  const contact::Shape& shape = *shape_of(id);
  const paths::Path fine = paths::Resample(path, shape.box_B(), kStep);
  paths::ClearanceOptions options;
  NoteStage("clearances");
  options.stop = CommandWatch::Get().stop();
  if (is_watched) {
    options.progress = [](double fraction) { ShowProgress("clearances", fraction); };
  }
  const auto found = paths::CalcClearances(shape, fine, neighbours, options);
  if (!found) {
    return Unexpected(found.error());
  }
  Json list = Json::array();
  for (const paths::Clearance& clearance : *found) {
    const OccurrenceId other = ids[clearance.neighbour];
    const paths::Path until(fine.begin(),
                            fine.begin() + static_cast<std::ptrdiff_t>(clearance.pose) + 1);
    const Vec3& p_BoBcm_B = product.part_of(id).mass.p_BoBcm_B;
    list.push_back({{"occurrence", product.occurrences[other.index()].path},
                    {"clearance_mm", units::ToMm(clearance.distance)},
                    {"way_mm", units::ToMm(paths::CalcLength(until, p_BoBcm_B))},
                    {"place_mm", PointMm(clearance.p_WC)},
                    {"has_mate", HasMate(product, id, other)}});
  }
  return Json{{"clearances", std::move(list)}, {"clearance_error_mm", units::ToMm(0.5 * kStep)}};
}

void PrintClearances(const Json& described) {
  if (described["clearances"].empty()) {
    fmt::print("no other part stands beside the path\n");
    return;
  }
  TextTable table({"nearest parts", "clearance\n[mm]", "after\n[mm]", "at x, y, z\n[mm]"});
  for (const Json& entry : described["clearances"]) {
    const double clearance = entry["clearance_mm"].get<double>();
    const Json& place = entry["place_mm"];
    const bool has_mate = entry["has_mate"].get<bool>();
    table.Add({entry["occurrence"].get<std::string>(), fmt::format("{:.3f}", clearance),
               fmt::format("{:.1f}", entry["way_mm"].get<double>()),
               fmt::format("{:.1f}, {:.1f}, {:.1f}", place[0].get<double>(), place[1].get<double>(),
                           place[2].get<double>())},
              clearance < 0 ? "overlaps on the way, as drawn"
              : has_mate    ? "has a mate"
                            : "");
  }
  fmt::print(
      "{}clearances are those of the drawn faces; between two poses they can be {:.2f} mm "
      "less\n",
      table.ToText(), described["clearance_error_mm"].get<double>());
}

}  // namespace hvas::app
