#include "simulation/fastener_tool.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "base/units.h"
#include "mates/fasteners.h"
#include "product/drive_forms.h"

namespace hvas::simulation {
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

std::string NameTool(const product::Part& part, bool is_nut) {
  product::RecognitionLimits limits;
  const std::vector<DriveForm> drives = product::FindDriveForms(part, kFlatTolerance, &limits);
  // A screw is turned at a recess in its head, if it has one; a nut at its outside.
  const auto wanted = std::find_if(drives.begin(), drives.end(), [is_nut](const DriveForm& drive) {
    return drive.is_recess != is_nut;
  });
  if (wanted != drives.end()) {
    return NameTool(*wanted);
  }
  if (!drives.empty()) {
    return NameTool(drives.front());
  }
  return is_nut ? "spanner" : "screwdriver";
}

}  // namespace

std::vector<std::string> NameTools(const product::Product& product) {
  const std::vector<FastenerKind> kinds = mates::ClassifyOccurrences(product);
  std::map<product::PartId, std::string> known;
  std::vector<std::string> tools(product.occurrences.size());
  for (const product::Occurrence& occurrence : product.occurrences) {
    const FastenerKind kind = kinds[occurrence.id.index()];
    if (kind != FastenerKind::kScrew && kind != FastenerKind::kNut) {
      continue;
    }
    const auto [entry, is_new] = known.try_emplace(occurrence.part);
    if (is_new) {
      entry->second = NameTool(product.parts[occurrence.part.index()], kind == FastenerKind::kNut);
    }
    tools[occurrence.id.index()] = entry->second;
  }
  return tools;
}

}  // namespace hvas::simulation
