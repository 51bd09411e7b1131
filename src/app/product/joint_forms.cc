#include "app/product/joint_forms.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/terminal.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "base/units.h"
#include "mates/fastened_joints.h"
#include "mates/polygon_fits.h"
#include "mates/prismatic_fits.h"
#include "mates/thread_joints.h"
#include "product/names.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using mates::FastenedJoint;
using mates::PolygonFit;
using mates::ThreadJoint;
using mates::ThreadJointKind;
using product::Mate;
using product::Product;
using units::ToMm;

constexpr double kOnAxis = 20e-6;  // [m]: the limit of axis-hole mates (docs/algorithms/mates.md).

const char* NameOf(fits::ThreadHole hole) {
  switch (hole) {
    case fits::ThreadHole::kUndersized:
      return "undersized";
    case fits::ThreadHole::kCore:
      return "core";
    case fits::ThreadHole::kNominal:
      return "nominal";
    case fits::ThreadHole::kClearance:
      return "clearance";
    case fits::ThreadHole::kWide:
      break;
  }
  return "other";
}

std::vector<ThreadJoint> ListThreads(const Product& product, const Selection& selection) {
  std::vector<ThreadJoint> joints = mates::FindThreadJoints(product);
  std::erase_if(joints, [&](const ThreadJoint& joint) { return !selection.Has(joint.mate); });
  return joints;
}

std::vector<const Mate*> ListPrismatic(const Product& product, const Selection& selection) {
  std::vector<const Mate*> fits;
  for (const Mate& mate : product.mates) {
    if (mate.kind == product::MateKind::kPrismatic && selection.Has(mate.id)) {
      fits.push_back(&mate);
    }
  }
  return fits;
}

/** Those of which a mate of a fastener with one of the two parts is selected. */
std::vector<FastenedJoint> ListFastened(const Product& product, const Selection& selection) {
  std::vector<FastenedJoint> joints = mates::FindFastenedJoints(product);
  std::erase_if(joints, [&](const FastenedJoint& joint) {
    return std::none_of(product.mates.begin(), product.mates.end(), [&](const product::Mate& mate) {
      const bool is_in = mate.a.occurrence == joint.a || mate.a.occurrence == joint.b;
      return is_in && selection.Has(mate.id) &&
             std::find(joint.fasteners.begin(), joint.fasteners.end(), mate.b.occurrence) !=
                 joint.fasteners.end();
    });
  });
  return joints;
}

Json ToJson(const FastenedJoint& joint) {
  Json fasteners = Json::array();
  for (const product::OccurrenceId id : joint.fasteners) {
    fasteners.push_back(id.value());
  }
  return {{"a", joint.a.value()},
          {"b", joint.b.value()},
          {"fasteners", std::move(fasteners)},
          {"diameter_mm", ToMm(joint.diameter)},
          {"circle_diameter_mm",
           joint.circle_diameter > 0 ? Json(ToMm(joint.circle_diameter)) : Json()},
          {"pilot", joint.pilot ? Json(joint.pilot->value()) : Json()},
          {"offset_mm", ToMm(joint.offset)},
          {"free_translations", joint.free_translations},
          {"free_rotations", joint.free_rotations}};
}

Vec3 WayOutOf(const Product& product, const Mate& mate) {
  const product::Occurrence& outer = product.occurrences[mate.a.occurrence.index()];
  return (outer.X_WB * mate.a.X_BM).q() * Vec3::UnitX();
}

Json ToJson(const ThreadJoint& joint) {
  const bool is_tightened = joint.tightening.torque > 0;
  return {{"mate", joint.mate.value()},
          {"kind", ToString(joint.kind)},
          {"thread", joint.thread != nullptr ? Json(joint.thread->designation) : Json()},
          {"diameter_mm", ToMm(joint.diameter)},
          {"pitch_mm", joint.pitch > 0 ? Json(ToMm(joint.pitch)) : Json()},
          {"hand", joint.is_left_handed ? "left" : "right"},
          {"is_modelled", joint.is_modelled},
          {"hole", NameOf(joint.hole)},
          {"engaged_mm", ToMm(joint.engaged)},
          {"turns", joint.pitch > 0 ? Json(joint.turns) : Json()},
          {"torque_nm", is_tightened ? Json(joint.tightening.torque) : Json()},
          {"preload_n", is_tightened ? Json(joint.tightening.preload) : Json()}};
}

/** The pockets and bores that fits are in: those that no part is in, and the others. */
std::vector<PolygonFit> ListPolygons(const Product& product, const Selection& selection) {
  std::vector<PolygonFit> fits = mates::FindPolygonFits(product);
  std::erase_if(fits, [&](const PolygonFit& fit) {
    return !selection.Has(fit.outer) && !(fit.inner && selection.Has(*fit.inner));
  });
  return fits;
}

/** What the walls of a mate are of: of a slot where they are of no pocket or bore around an axis.
 */
std::string DescribeForm(const std::vector<PolygonFit>& polygons, const Mate& mate) {
  const auto found = std::find_if(polygons.begin(), polygons.end(), [&](const PolygonFit& fit) {
    return std::find(fit.mates.begin(), fit.mates.end(), mate.id) != fit.mates.end();
  });
  return found != polygons.end() ? mates::DescribePolygon(found->form) : "slot";
}

/** A pocket or bore that no mate of two walls stands for: its part alone is in it, or flats that
 have none opposite, as those of a D. */
Json ToJson(const Product& product, const PolygonFit& fit) {
  const Vec3 way_W = -(product.occurrences[fit.outer.index()].X_WB.q() * fit.form.axis_B);
  const auto of_inner = [&fit](double value) { return fit.inner ? Json(value) : Json(); };
  return {
      {"mate", Json()},
      {"form", mates::DescribePolygon(fit.form)},
      {"outer", fit.outer.value()},
      {"inner", fit.inner ? Json(fit.inner->value()) : Json()},
      {"way_out", {way_W.x(), way_W.y(), way_W.z()}},
      {"outer_width_mm", ToMm(fit.form.width)},
      {"inner_width_mm", of_inner(ToMm(fit.inner_width))},
      {"clearance_mm", of_inner(ToMm(fit.form.width - fit.inner_width))},
      {"engaged_mm", ToMm(fit.engaged)},
      {"breadth_mm", Json()},
      {"lead_in_deg", Json()},
      {"lead_in_mm", Json()},
      {"kind", Json()},
      {"code", ""},
      {"reason", fit.inner ? "the flats turn with each other" : "no part of the product is in it"}};
}

Json ToJson(const Product& product, const std::vector<PolygonFit>& polygons, const Mate& mate) {
  const mates::LeadIn lead_in = mates::FindLeadIn(product, mate);
  const product::Fit fit = mate.fit.value_or(product::Fit{});
  const Vec3 way_W = WayOutOf(product, mate);
  return {{"mate", mate.id.value()},
          {"form", DescribeForm(polygons, mate)},
          {"outer", mate.a.occurrence.value()},
          {"inner", mate.b.occurrence.value()},
          {"way_out", {way_W.x(), way_W.y(), way_W.z()}},
          {"outer_width_mm", ToMm(2 * mate.hole_radius)},
          {"inner_width_mm", ToMm(2 * mate.shaft_radius)},
          {"clearance_mm", ToMm(2 * (mate.hole_radius - mate.shaft_radius))},
          {"engaged_mm", ToMm(mate.overlap)},
          {"breadth_mm", ToMm(mate.breadth)},
          {"lead_in_deg", units::ToDeg(lead_in.angle)},
          {"lead_in_mm", ToMm(lead_in.width)},
          {"kind", ToString(fit.kind)},
          {"code", fit.code},
          {"reason", fit.reason}};
}

/** Hand and kind of a joint where they are unusual; else empty. */
std::string DescribeOdd(const ThreadJoint& joint) {
  std::string text = joint.is_left_handed ? "left-handed" : "";
  if (joint.kind == ThreadJointKind::kSelfTapping) {
    text += text.empty() ? "self-tapping" : ", self-tapping";
  }
  return text;
}

void PrintThreads(const std::vector<ThreadJoint>& joints, bool is_all) {
  fmt::print("\nThreads (torque for steel of class 8.8, friction 0.12)\n");
  TextTable table(
      {"mate", "thread", "pitch\nmm", "engaged\nmm", "turns", "torque\nN m", "hole\ndrawn as"}, 2);
  ListLimit limit(is_all);
  for (const ThreadJoint& joint : joints) {
    if (!limit.Next()) {
      continue;
    }
    const auto number = [](double value, int digits) {
      return value > 0 ? fmt::format("{:.{}f}", value, digits) : std::string("-");
    };
    table.Add(
        {fmt::format("m{}", joint.mate.value()),
         joint.thread != nullptr ? joint.thread->designation
                                 : fmt::format("{:.3g} mm", ToMm(joint.diameter)),
         number(ToMm(joint.pitch), 2), number(ToMm(joint.engaged), 2), number(joint.turns, 1),
         number(joint.tightening.torque, 2), joint.is_modelled ? "helix" : NameOf(joint.hole)},
        DescribeOdd(joint));
  }
  fmt::print("{}", table.ToText(2));
  limit.PrintRest();
}

void PrintPrismatic(const Product& product, const std::vector<const Mate*>& fits,
                    const std::vector<PolygonFit>& polygons, bool is_all) {
  fmt::print("\nPrismatic fits (slot and tongue, pocket and block, sandwich, polygon)\n");
  TextTable table({"mate", "outer part, inner part", "width\nmm", "clearance\nmm", "engaged\nmm",
                   "lead-in\nmm", "fit"},
                  2);
  ListLimit limit(is_all);
  for (const Mate* mate : fits) {
    if (!limit.Next()) {
      continue;
    }
    const double lead_in = mates::FindLeadIn(product, *mate).width;
    const product::Fit fit = mate->fit.value_or(product::Fit{});
    table.Add(
        {fmt::format("m{}", mate->id.value()),
         fmt::format("{}, {}", Shorten(product.occurrences[mate->a.occurrence.index()].name, 10),
                     Shorten(product.occurrences[mate->b.occurrence.index()].name, 10)),
         fmt::format("{:.3f}", ToMm(2 * mate->hole_radius)),
         fmt::format("{:.3f}", ToMm(2 * (mate->hole_radius - mate->shaft_radius))),
         fmt::format("{:.2f}", ToMm(mate->overlap)),
         lead_in > 0 ? fmt::format("{:.2f}", ToMm(lead_in)) : std::string("-"),
         fmt::format("{}{}{}", ToString(fit.kind), fit.code.empty() ? "" : " ", fit.code)},
        DescribeForm(polygons, *mate));
  }
  for (const PolygonFit& fit : polygons) {
    if (!fit.mates.empty() || !limit.Next()) {
      continue;
    }
    const auto name = [&product](product::OccurrenceId id) {
      return Shorten(product.occurrences[id.index()].name, 10);
    };
    table.Add({"-", fmt::format("{}, {}", name(fit.outer), fit.inner ? name(*fit.inner) : "-"),
               fmt::format("{:.3f}", ToMm(fit.form.width)),
               fit.inner ? fmt::format("{:.3f}", ToMm(fit.form.width - fit.inner_width)) : "-",
               fit.inner ? fmt::format("{:.2f}", ToMm(fit.engaged)) : "-", "-", "-"},
              mates::DescribePolygon(fit.form));
  }
  fmt::print("{}", table.ToText(2));
  limit.PrintRest();
}

void PrintFastened(const Product& product, const std::vector<FastenedJoint>& joints, bool is_all) {
  fmt::print("\nFastened joints (parts held together by screws or pins)\n");
  TextTable table({"parts", "fasteners", "of\nmm", "circle\nmm", "pilot", "off axis\nmm"}, 2);
  ListLimit limit(is_all);
  for (const FastenedJoint& joint : joints) {
    if (limit.Next()) {
      table.Add(
          {fmt::format("{}, {}", Shorten(product.occurrences[joint.a.index()].name, 14),
                       Shorten(product.occurrences[joint.b.index()].name, 14)),
           std::to_string(joint.fasteners.size()), fmt::format("{:.2f}", ToMm(joint.diameter)),
           joint.circle_diameter > 0 ? fmt::format("{:.2f}", ToMm(joint.circle_diameter)) : "-",
           joint.pilot ? fmt::format("m{}", joint.pilot->value()) : "-",
           joint.offset > kOnAxis ? fmt::format("{:.3f}", ToMm(joint.offset)) : "-"});
    }
  }
  fmt::print("{}", table.ToText(2));
  limit.PrintRest();
}

}  // namespace

void AddJointForms(const Product& product, const Selection& selection, Json* json) {
  Json& threads = (*json)["threads"] = Json::array();
  for (const ThreadJoint& joint : ListThreads(product, selection)) {
    threads.push_back(ToJson(joint));
  }
  Json& prismatic = (*json)["prismatic_fits"] = Json::array();
  const std::vector<PolygonFit> polygons = ListPolygons(product, selection);
  for (const Mate* mate : ListPrismatic(product, selection)) {
    prismatic.push_back(ToJson(product, polygons, *mate));
  }
  for (const PolygonFit& fit : polygons) {
    if (fit.mates.empty()) {
      prismatic.push_back(ToJson(product, fit));
    }
  }
  Json& fastened = (*json)["fastened_joints"] = Json::array();
  for (const FastenedJoint& joint : ListFastened(product, selection)) {
    fastened.push_back(ToJson(joint));
  }
}

void PrintJointForms(const Product& product, const Selection& selection, bool is_all) {
  const std::vector<ThreadJoint> joints = ListThreads(product, selection);
  if (!joints.empty()) {
    PrintThreads(joints, is_all);
  }
  const std::vector<const Mate*> fits = ListPrismatic(product, selection);
  const std::vector<PolygonFit> polygons = ListPolygons(product, selection);
  if (!fits.empty() || !polygons.empty()) {
    PrintPrismatic(product, fits, polygons, is_all);
  }
  const std::vector<FastenedJoint> fastened = ListFastened(product, selection);
  if (!fastened.empty()) {
    PrintFastened(product, fastened, is_all);
  }
}

}  // namespace hvas::app
