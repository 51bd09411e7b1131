#include "simulation/table_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "dynamics/world.h"
#include "product/product.h"
#include "simulation/person_task.h"

namespace hvas::simulation {
namespace {

using product::OccurrenceId;
using product::Product;

constexpr double kTableGap = 10e-3;     // [m] between parts on the table
constexpr double kTransferGap = 30e-3;  // [m] between a carried part and the product
constexpr double kSettleTime = 3.0;     // [s]; parts that fall 30 mm lie still sooner: a choice.
constexpr double kFixtureShare = 0.3;   // Height of the fixture by the product's radius: a choice.
constexpr double kRowShare = 2.0;       // Width of the table by the root of its area: a choice.

spatial::Box DrawnBox(const Product& product, OccurrenceId id) {
  return spatial::Transform(product.occurrences[id.index()].X_WB, product.part_of(id).box_B);
}

/** The box around all that a step moves, as drawn. */
spatial::Box BoxOfStep(const Product& product, const sequence::SequenceStep& step) {
  spatial::Box box = DrawnBox(product, step.occurrence);
  for (const OccurrenceId member : step.members) {
    box.Add(DrawnBox(product, member));
  }
  return box;
}

/** Gives every subassembly that is put together first its place on the shelf: beside the product,
 on the other side than the table's parts. Returns the largest radius of what is carried. */
double PlaceOnShelf(Model* model) {
  const Product& product = *model->product;
  double reach = 0;
  for (const product::Part& part : product.parts) {
    reach = std::max(reach, 0.5 * part.box_B.size().norm());
  }
  std::map<OccurrenceId, spatial::Box> boxes;  // by the part that leads
  double widest = 0;
  for (const sequence::SequenceStep& step : model->sequence.steps) {
    if (step.kind == sequence::SequenceStep::Kind::kPark) {
      boxes[step.occurrence] = BoxOfStep(product, step);
      widest = std::max(widest, boxes[step.occurrence].size().norm());
    }
  }
  reach = std::max(reach, 0.5 * widest);
  const double radius = 0.5 * product.box_W.size().norm() + reach + kTransferGap;
  double place = -0.5 * (widest + kTableGap) * static_cast<double>(boxes.size() - 1);
  for (sequence::SequenceStep& step : model->sequence.steps) {
    if (step.kind == sequence::SequenceStep::Kind::kPark) {
      const Vec3 shelf = product.box_W.centre() + Vec3(place, -(radius + widest + kTableGap), 0);
      step.offset_W = shelf - boxes[step.occurrence].centre();
      place += widest + kTableGap;
    }
  }
  return reach;
}

/** The lowest point that a part reaches on its way in, and while it is carried to the beginning of
 its way around the product (SimulatedPerson). */
double CalcLowest(const Model& model, const sequence::SequenceStep& step) {
  const Product& product = *model.product;
  const spatial::Box box = BoxOfStep(product, step);
  const spatial::Pose& X_WB_goal = product.occurrences[step.occurrence.index()].X_WB;
  const Vec3 grip = X_WB_goal * model.bodies[step.occurrence.index()].mass.p_BoBcm_B;
  const double radius = (box.centre() - grip).norm() + 0.5 * box.size().norm();
  Vec3 out_W = step.extraction_W;
  double lowest = std::min(box.low.z(), box.low.z() + step.offset_W.z());
  for (std::size_t k = 0; k < step.way.size(); ++k) {
    lowest = std::min(lowest, (step.way[k] * X_WB_goal.Inverse() * grip).z() - radius);
    if (k > 0 && (step.way[k].p() - step.way[k - 1].p()).norm() > 0) {
      out_W = (step.way[k].p() - step.way[k - 1].p()).normalized();
    }
  }
  const double rise = std::min(out_W.z(), std::sin(std::atan(kLeastRiseAside)));
  return std::min(lowest, model.centre_W.z() + model.transfer_radius * rise - radius);
}

/** The table is as near below the product as a fixture is high, or lower, where parts come from the
 side or from below: none meets it on its way. */
double CalcTableHeight(const Model& model) {
  const spatial::Box& box = model.product->box_W;
  double height = box.low.z() - 0.5 * kFixtureShare * box.size().norm();
  for (const sequence::SequenceStep& step : model.sequence.steps) {
    if (step.kind != sequence::SequenceStep::Kind::kBase) {
      height = std::min(height, CalcLowest(model, step) - kTransferGap);
    }
  }
  return height;
}

/** The parts in the order in which they lie in their rows: small ones in front, larger ones behind;
 among those of a size, in the order in which they come, and equal parts together. What stands in
 the fixture from the beginning comes last: its place on the table stays empty. */
std::vector<std::size_t> ListAsTheyLie(const Model& model, std::vector<std::size_t> bodies) {
  const Product& product = *model.product;
  std::map<product::PartId, std::size_t> first_steps;
  for (std::size_t k = 0; k < model.sequence.steps.size(); ++k) {
    const OccurrenceId id = model.sequence.steps[k].occurrence;
    first_steps.emplace(product.occurrences[id.index()].part, k);
  }
  const auto rank = [&](std::size_t i) {
    const product::PartId part = product.occurrences[i].part;
    const auto step = first_steps.find(part);
    const double size = model.bodies[i].shape->box_B().size().norm();
    const bool is_base = OccurrenceId(i) == sequence::FindBase(model.sequence);
    return std::tuple(is_base, std::ilogb(size),
                      step == first_steps.end() ? model.sequence.steps.size() : step->second, part);
  };
  std::stable_sort(bodies.begin(), bodies.end(),
                   [&](std::size_t x, std::size_t y) { return rank(x) < rank(y); });
  return bodies;
}

/** Side of the square of the table that a part gets [m]. */
double CalcCell(const Body& body) {
  return body.shape->box_B().size().norm() + kTableGap;
}

/** The parts that lie on the table: all but the fixtures that stand under the product. */
std::vector<std::size_t> ListOnTable(const Model& model, std::size_t standing) {
  const auto& fixtures = model.accessories.fixtures;
  const auto end = fixtures.begin() + static_cast<std::ptrdiff_t>(standing);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (std::find(fixtures.begin(), end, OccurrenceId(i)) == end) {
      order.push_back(i);
    }
  }
  return order;
}

double CalcRowWidth(const Model& model, const std::vector<std::size_t>& parts) {
  double area = 0;
  double widest = 0;
  for (const std::size_t i : parts) {
    const double cell = CalcCell(model.bodies[i]);
    area += cell * cell;
    widest = std::max(widest, cell);
  }
  return std::max(kRowShare * std::sqrt(area), widest);
}

/** Places parts in rows on the table, each a little above it. */
void PlaceInRows(const std::vector<std::size_t>& order, double width, Model* model) {
  const double left = model->centre_W.x() - 0.5 * width;
  double x = left;
  double y = model->centre_W.y() + model->transfer_radius;
  double row_depth = 0;
  for (const std::size_t i : order) {
    Body& body = model->bodies[i];
    const double size = CalcCell(body);
    if (x + size > left + width) {
      x = left;
      y += row_depth;
      row_depth = 0;
    }
    row_depth = std::max(row_depth, size);
    const spatial::Box box =
        spatial::Transform(spatial::Pose(body.X_WB_goal.q(), Vec3::Zero()), body.shape->box_B());
    const Vec3 place(x + 0.5 * size, y + 0.5 * size, model->table_z + 1e-3);
    const Vec3 bottom(box.centre().x(), box.centre().y(), box.low.z());
    body.X_WB_start = spatial::Pose(body.X_WB_goal.q(), place - bottom);
    x += size;
  }
}

/** Lets parts fall onto the table until they lie still. */
Result<void> SettleOnTable(const std::vector<std::size_t>& order, Model* model) {
  dynamics::World world(TableOptions(*model));
  std::vector<dynamics::BodyId> ids;
  for (const std::size_t i : order) {
    const Body& body = model->bodies[i];
    const auto id = world.AddBody(model->product->part_of(body.occurrence).mesh.vertices, body.mass,
                                  body.X_WB_start);
    if (!id) {
      return Unexpected(id.error());
    }
    ids.push_back(*id);
  }
  (void)world.Settle(kSettleTime);
  for (std::size_t k = 0; k < ids.size(); ++k) {
    model->bodies[order[k]].X_WB_start = world.pose(ids[k]);
  }
  return {};
}

}  // namespace

dynamics::WorldOptions TableOptions(const Model& model) {
  dynamics::WorldOptions options;
  options.table_z = model.table_z;
  return options;
}

Result<void> LayOutParts(Model* model) {
  const Product& product = *model->product;
  const double reach = PlaceOnShelf(model);
  model->centre_W = product.box_W.centre();
  model->transfer_radius = 0.5 * product.box_W.size().norm() + reach + kTransferGap;
  model->table_z = CalcTableHeight(*model);
  const auto& fixtures = model->accessories.fixtures;
  const std::size_t standing = fixtures.size() - model->accessories.bench_count;
  std::vector<std::size_t> parts = ListOnTable(*model, standing);
  const double width = CalcRowWidth(*model, parts);
  const std::vector<std::size_t> order = ListAsTheyLie(*model, std::move(parts));
  PlaceInRows(order, width, model);
  if (auto settled = SettleOnTable(order, model); !settled) {
    return settled;
  }
  for (std::size_t k = standing; k < fixtures.size(); ++k) {
    Body& body = model->bodies[fixtures[k].index()];
    body.X_WB_goal = body.X_WB_start;
  }
  return {};
}

}  // namespace hvas::simulation
