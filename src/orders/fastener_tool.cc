#include "orders/fastener_tool.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "mates/fasteners.h"
#include "product/drive_forms.h"

namespace hvas::orders {
namespace {

using product::DriveForm;
using product::DriveKind;
using product::FastenerKind;

constexpr double kFlatTolerance = 2e-6;  // [m]: that of the features of a part.

std::string NameTool(const DriveForm& drive) {
  const double width_mm = units::ToMm(drive.width);
  switch (drive.kind) {
    case DriveKind::kHexagon:
      return fmt::format("{} {:.3g} mm", drive.is_recess ? "hexagon key" : "spanner", width_mm);
    case DriveKind::kCross:
      return "cross screwdriver";
    case DriveKind::kSlot:
      return fmt::format("slot screwdriver {:.2g} mm", width_mm);
  }
  return {};
}

FastenerTool FindTool(const product::Part& part, bool is_nut) {
  product::RecognitionLimits limits;
  std::vector<DriveForm> drives = product::FindDriveForms(part, kFlatTolerance, &limits);
  if (drives.empty()) {
    return {is_nut ? "spanner" : "screwdriver", std::nullopt};
  }
  // A screw is turned at a recess in its head, if it has one; a nut at its outside.
  const auto wanted = std::find_if(drives.begin(), drives.end(), [is_nut](const DriveForm& drive) {
    return drive.is_recess != is_nut;
  });
  DriveForm& drive = wanted != drives.end() ? *wanted : drives.front();
  return {NameTool(drive), std::move(drive)};
}

}  // namespace

std::vector<FastenerTool> FindTools(const product::Product& product) {
  const std::vector<FastenerKind> kinds = mates::ClassifyOccurrences(product);
  std::map<product::PartId, FastenerTool> known;
  std::vector<FastenerTool> tools(product.occurrences.size());
  for (const product::Occurrence& occurrence : product.occurrences) {
    const FastenerKind kind = kinds[occurrence.id.index()];
    if (kind != FastenerKind::kScrew && kind != FastenerKind::kNut) {
      continue;
    }
    const auto [entry, is_new] = known.try_emplace(occurrence.part);
    if (is_new) {
      entry->second = FindTool(product.parts[occurrence.part.index()], kind == FastenerKind::kNut);
    }
    tools[occurrence.id.index()] = entry->second;
  }
  return tools;
}

std::vector<std::string> NameTools(const product::Product& product) {
  std::vector<std::string> names;
  for (FastenerTool& tool : FindTools(product)) {
    names.push_back(std::move(tool.name));
  }
  return names;
}

}  // namespace hvas::orders
