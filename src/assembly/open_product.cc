#include "assembly/open_product.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/crash_note.h"
#include "base/units.h"
#include "cad/encoding.h"
#include "cad/length_unit.h"
#include "mates/assignments.h"
#include "mates/drawing_errors.h"
#include "mates/elastic_parts.h"
#include "mates/flexible_parts.h"
#include "mates/infer.h"
#include "mates/side_file.h"
#include "mates/stated_fits.h"
#include "product/accessories.h"
#include "product/welded_units.h"

namespace hvas::assembly {
namespace {

using product::Product;

Result<void> Check(const OpenOptions& options) {
  if (const double unit = options.length_unit.value_or(1); !cad::IsUsableLengthUnit(unit)) {
    return Fail(ErrorCode::kInvalid, fmt::format("{} m is no length unit", unit),
                options.file.filename().string(),
                fmt::format("give a length from {:g} to {:g} m, as 0.001", cad::kSmallestLengthUnit,
                            cad::kLargestLengthUnit));
  }
  if (!options.encoding.empty() && !cad::IsEncoding(options.encoding)) {
    return Fail(ErrorCode::kInvalid, fmt::format("{} is no encoding", options.encoding),
                options.file.filename().string(), "give a name that iconv -l lists, as CP1251");
  }
  if (options.max_parts < 1 ||
      static_cast<std::size_t>(options.max_parts) > cad::kLargestMaxParts) {
    return Fail(ErrorCode::kInvalid, fmt::format("{} parts cannot be a limit", options.max_parts),
                options.file.filename().string(),
                fmt::format("allow 1 to {} parts", cad::kLargestMaxParts));
  }
  return {};
}

/** Whether a CAD file has a side file. A link that leads nowhere is a mistake to be told, not a
 side file that is not there. */
bool HasSideFile(const OpenOptions& options) {
  std::error_code error;
  return std::filesystem::exists(
      std::filesystem::symlink_status(mates::FindAssignmentFile(options.file), error));
}

/** What the options and the side file say about parts, beside mates. */
struct PartStatements {
  std::vector<product::KeptApart> apart;  // Not to be welded.
  std::vector<mates::StatedFlexible> flexible;
  std::vector<mates::StatedElastic> elastic;
};

Result<PartStatements> ReadPartStatements(const OpenOptions& options) {
  PartStatements statements;
  for (const std::string& name : options.apart) {
    statements.apart.push_back({name, {}});
  }
  if (HasSideFile(options)) {
    auto side_file = mates::ReadSideFile(mates::FindAssignmentFile(options.file));
    if (!side_file) {
      return Unexpected(side_file.error());
    }
    statements.apart.insert(statements.apart.end(), side_file->apart.begin(),
                            side_file->apart.end());
    statements.flexible = std::move(side_file->flexible);
    statements.elastic = std::move(side_file->elastic);
  }
  return statements;
}

/** Welds an imported product and infers its mates.
 @param inferred  What inference finds in the drawn poses. */
Result<void> Relate(const OpenOptions& options, WorkWatch* watch, Product* product,
                    Diagnostics* diagnostics, Diagnostics* inferred) {
  const auto stated = ReadPartStatements(options);
  if (!stated) {
    return Unexpected(stated.error());
  }
  NoteStage("bought units");
  if (auto welded = product::WeldUnits(stated->apart, product, diagnostics, watch); !welded) {
    return welded;
  }
  if (auto set =
          mates::SetFlexibleParts(stated->flexible, options.rigid, product, diagnostics, watch);
      !set) {
    return set;
  }
  if (auto set = mates::SetElasticParts(stated->elastic, product); !set) {
    return set;
  }
  NoteStage("mates");
  return mates::Infer(product, inferred, watch);
}

/** Imports a file, and relates its parts. */
Result<Product> OpenWithin(const OpenOptions& options, WorkWatch* watch, Diagnostics* diagnostics,
                           Diagnostics* inferred) {
  if (const auto checked = Check(options); !checked) {
    return Unexpected(checked.error());
  }
  cad::ImportControl control;
  control.limits.time = options.limits.time;
  control.limits.begin_ns = watch->begin_ns();
  control.limits.memory = options.limits.memory;
  control.cache_directory = options.cache_directory;
  control.stop = options.stop;
  control.progress = options.progress;
  auto product = cad::Import(options.file, MakeImportOptions(options), diagnostics, control);
  if (!product) {
    return product;
  }
  if (const auto related = Relate(options, watch, &*product, diagnostics, inferred); !related) {
    return Unexpected(related.error());
  }
  return product;
}

/** What the files themselves state about mates. */
Result<void> ApplyStated(const OpenOptions& options, Product* product, WorkWatch* watch) {
  if (HasSideFile(options)) {
    const auto applied =
        mates::ApplyAssignments(mates::FindAssignmentFile(options.file), product, watch);
    return applied ? Result<void>() : Unexpected(applied.error());
  }
  mates::AssignStatedFits(product, watch);
  if (!watch->MayGoOn()) {
    return Unexpected(
        watch->Explain("assigning the stated fits", options.file.filename().string()));
  }
  return {};
}

/** Where a fixture is put. */
struct FixturePlace {
  std::string file;
  product::Pose X_WA;
};

Result<FixturePlace> ParseFixture(const std::string& text) {
  FixturePlace place{text, {}};
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos) {
    return place;
  }
  place.file = text.substr(0, at);
  std::vector<double> numbers;
  for (std::size_t begin = at + 1; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    char* rest = nullptr;
    const double number = std::strtod(word.c_str(), &rest);
    if (word.empty() || *rest != '\0' || !std::isfinite(number)) {
      numbers.clear();
      break;
    }
    numbers.push_back(number);
    begin = end + 1;
  }
  if (numbers.size() != 3 && numbers.size() != 4) {
    return Fail(ErrorCode::kInvalid, "the place of the fixture is not X,Y,Z or X,Y,Z,ANGLE", text,
                "give millimetres and degrees, as in vise.step@0,0,-30,90");
  }
  const double angle = numbers.size() == 4 ? units::FromDeg(numbers[3]) : 0.0;
  place.X_WA = {
      Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ())),
      Vec3(units::FromMm(numbers[0]), units::FromMm(numbers[1]), units::FromMm(numbers[2]))};
  return place;
}

/** Adds tools and fixtures to a product. Tools are drawn beside it, where they meet nothing. */
Result<void> AddAccessories(const OpenOptions& options, Product* product, WorkWatch* watch,
                            Diagnostics* diagnostics) {
  constexpr double kBeside = 1.0;  // [m] from the product: a choice; it is laid on the table.
  constexpr double kApart = 0.1;   // [m] from one another, so that they do not overlap: a choice.
  double edge = product->box_W.high.x() + kBeside;
  const auto add = [&](const std::string& file, product::AccessoryKind kind,
                       const product::Pose* X_WA) -> Result<void> {
    OpenOptions open = options;
    open.file = file;
    open.apart.clear();
    open.length_unit.reset();  // It is that of the product's file.
    open.rigid.clear();
    const auto accessory = OpenWithin(open, watch, diagnostics, diagnostics);
    if (!accessory) {
      return Unexpected(accessory.error());
    }
    const product::Pose beside(Vec3(edge - accessory->box_W.low.x(), product->box_W.centre().y(),
                                    product->box_W.centre().z()));
    edge += accessory->box_W.size().x() + kApart;
    product::AddAccessory(*accessory, kind, X_WA != nullptr ? *X_WA : beside, product);
    return {};
  };
  for (const auto& [files, kind] : {std::pair(&options.tools, product::AccessoryKind::kTool),
                                    std::pair(&options.bench, product::AccessoryKind::kBench)}) {
    for (const std::string& file : *files) {
      if (auto added = add(file, kind, nullptr); !added) {
        return added;
      }
    }
  }
  for (const std::string& text : options.fixtures) {
    const auto place = ParseFixture(text);
    if (!place) {
      return Unexpected(place.error());
    }
    auto added = add(place->file, product::AccessoryKind::kFixture, &place->X_WA);
    if (!added) {
      return added;
    }
  }
  return {};
}

/** What is stated of a product whose parts are related, and what stands around it. */
Result<Product> Complete(const OpenOptions& options, Product product, const Diagnostics& inferred,
                         WorkWatch* watch, Diagnostics* diagnostics) {
  NoteStage("stated mates and fits");
  if (const auto applied = ApplyStated(options, &product, watch); !applied) {
    return Unexpected(applied.error());
  }
  // What holds of the drawn poses does not where mates of the user have put the parts elsewhere.
  const bool is_placed = !product.placement.drawn_poses.empty();
  for (const Diagnostic& item : (is_placed ? product.placement.diagnostics : inferred).items()) {
    diagnostics->Add(item);
  }
  for (const std::string& fit : options.fits) {
    if (const auto assigned = mates::AssignFit(&product, fit); !assigned) {
      return Unexpected(assigned.error());
    }
  }
  NoteStage("errors of the drawing");
  product.drawing_errors = mates::ListDrawingErrors(product, watch);
  if (!watch->MayGoOn()) {
    return Unexpected(
        watch->Explain("finding the errors of the drawing", options.file.filename().string()));
  }
  mates::ReportDrawingErrors(product, diagnostics);
  if (const auto added = AddAccessories(options, &product, watch, diagnostics); !added) {
    return Unexpected(added.error());
  }
  NoteStage("");
  return product;
}

WorkWatch MakeWatch(const OpenOptions& options) {
  return WorkWatch(options.limits, options.stop);
}

}  // namespace

cad::ImportOptions MakeImportOptions(const OpenOptions& options) {
  cad::ImportOptions import;
  import.length_unit = options.length_unit;
  import.encoding = options.encoding;
  import.max_parts = static_cast<std::size_t>(options.max_parts);
  return import;
}

Result<Product> OpenInferred(const OpenOptions& options, Diagnostics* diagnostics) {
  WorkWatch watch = MakeWatch(options);
  return OpenWithin(options, &watch, diagnostics, diagnostics);
}

Result<Product> OpenProduct(const OpenOptions& options, Diagnostics* diagnostics) {
  WorkWatch watch = MakeWatch(options);
  Diagnostics inferred;
  auto product = OpenWithin(options, &watch, diagnostics, &inferred);
  if (!product) {
    return product;
  }
  return Complete(options, *std::move(product), inferred, &watch, diagnostics);
}

Result<Product> OpenImported(Product imported, const OpenOptions& options,
                             Diagnostics* diagnostics) {
  if (const auto checked = Check(options); !checked) {
    return Unexpected(checked.error());
  }
  WorkWatch watch = MakeWatch(options);
  Diagnostics inferred;
  if (const auto related = Relate(options, &watch, &imported, diagnostics, &inferred); !related) {
    return Unexpected(related.error());
  }
  return Complete(options, std::move(imported), inferred, &watch, diagnostics);
}

}  // namespace hvas::assembly
