#include "app/product/joint_forms.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/terminal.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "base/units.h"
#include "mates/prismatic_fits.h"
#include "mates/thread_joints.h"
#include "product/names.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using mates::PrismaticFit;
using mates::ThreadJoint;
using mates::ThreadJointKind;
using product::Product;
using units::ToMm;

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

std::vector<PrismaticFit> ListPrismatic(const Product& product, const Selection& selection) {
  std::vector<PrismaticFit> fits = mates::FindPrismaticFits(product);
  std::erase_if(fits, [&](const PrismaticFit& fit) {
    return !selection.Has(fit.low) && !selection.Has(fit.high);
  });
  return fits;
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

Json ToJson(const PrismaticFit& fit) {
  return {{"outer", fit.outer.value()},
          {"inner", fit.inner.value()},
          {"mates", {fit.low.value(), fit.high.value()}},
          {"across", {fit.across_W.x(), fit.across_W.y(), fit.across_W.z()}},
          {"outer_width_mm", ToMm(fit.outer_width)},
          {"inner_width_mm", ToMm(fit.inner_width)},
          {"clearance_mm", ToMm(fit.clearance())},
          {"engaged_mm2", 1e6 * fit.engaged},
          {"kind", ToString(fit.fit.kind)},
          {"code", fit.fit.code},
          {"reason", fit.fit.reason}};
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

void PrintPrismatic(const Product& product, const std::vector<PrismaticFit>& fits, bool is_all) {
  fmt::print("\nPrismatic fits (slot and tongue, pocket and block, sandwich)\n");
  TextTable table({"mates", "outer part, inner part", "width\nmm", "clearance\nmm", "fit"}, 2);
  ListLimit limit(is_all);
  for (const PrismaticFit& fit : fits) {
    if (limit.Next()) {
      table.Add({fmt::format("m{} m{}", fit.low.value(), fit.high.value()),
                 fmt::format("{}, {}", Shorten(product.occurrences[fit.outer.index()].name, 14),
                             Shorten(product.occurrences[fit.inner.index()].name, 14)),
                 fmt::format("{:.3f}", ToMm(fit.outer_width)),
                 fmt::format("{:.3f}", ToMm(fit.clearance())),
                 fmt::format("{}{}{}", ToString(fit.fit.kind), fit.fit.code.empty() ? "" : " ",
                             fit.fit.code)});
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
  for (const PrismaticFit& fit : ListPrismatic(product, selection)) {
    prismatic.push_back(ToJson(fit));
  }
}

void PrintJointForms(const Product& product, const Selection& selection, bool is_all) {
  const std::vector<ThreadJoint> joints = ListThreads(product, selection);
  if (!joints.empty()) {
    PrintThreads(joints, is_all);
  }
  const std::vector<PrismaticFit> fits = ListPrismatic(product, selection);
  if (!fits.empty()) {
    PrintPrismatic(product, fits, is_all);
  }
}

}  // namespace hvas::app
