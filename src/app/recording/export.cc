#include "app/recording/export.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/assembly/poses.h"
#include "app/command_watch.h"
#include "app/output/new_file.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/product/load_product.h"
#include "app/product/product_json.h"
#include "app/product/selection.h"
#include "app/recording/export_record.h"
#include "assembly/open_product.h"
#include "assembly/prepare_model.h"
#include "base/atomic_file.h"
#include "base/crash_note.h"
#include "cad/export_step.h"
#include "cad/glb.h"
#include "cad/input_file.h"
#include "evidence/demonstrations.h"
#include "exchange/mjcf.h"
#include "exchange/urdf.h"
#include "exchange/usda.h"

namespace hvas::app {
namespace {

using product::Product;

struct ExportOptions {
  LoadOptions load;
  std::filesystem::path output;
  std::filesystem::path poses;  ///< Empty: as drawn.
  bool is_fine{false};
  bool has_meshes{false};
  bool is_forced{false};
  RecordSelection record;
};

/** In small letters, with the dot. */
std::string FormatOf(const std::filesystem::path& file) {
  std::string format = file.extension().string();
  std::transform(format.begin(), format.end(), format.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return format;
}

/** A format of a simulator of rigid bodies. */
bool IsOfSimulator(const std::string& format) {
  return format == ".mjcf" || format == ".xml" || format == ".urdf" || format == ".usda";
}

/** What can be known to fail before the work. */
Result<void> Check(const ExportOptions& options, const std::string& format) {
  const std::string name = options.output.string();
  if (const auto input = cad::CheckInput(options.load.file); !input) {
    return Unexpected(input.error());
  }
  if (options.record.is_demonstrations && !IsHdf5(format) && format != ".mcap") {
    return Fail(ErrorCode::kInvalid, "demonstrations are written as HDF5 or MCAP only", name,
                "end the file name with .h5 or .mcap");
  }
  if (IsRecord(options.load.file)) {
    if (!IsRecordFormat(format)) {
      return Fail(ErrorCode::kInvalid,
                  "the file name has no extension of a format that a record can be exported to",
                  name, std::string("end it with ") + kRecordFormats);
    }
  } else if (format != ".glb" && format != ".json" && format != ".step" && format != ".stp" &&
             !IsOfSimulator(format) && !options.record.is_demonstrations) {
    return Fail(ErrorCode::kInvalid,
                "the file name has no extension of a format that can be written", name,
                "use the extension .glb, .json, .step, .mjcf, .xml, .urdf or .usda");
  }
  std::error_code error;
  if (std::filesystem::equivalent(options.load.file, options.output, error)) {
    return Fail(ErrorCode::kInvalid, "the output is the input file", name, "choose another name");
  }
  return CheckNewFile(options.output, options.is_forced);
}

Result<void> WriteStep(const ExportOptions& options, const Product& product,
                       const cad::PartMotions& motions) {
  const auto without = std::count_if(product.parts.begin(), product.parts.end(),
                                     [](const product::Part& part) { return !part.has_brep; });
  if (without > 0) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("{} of {} parts have triangles only, which STEP AP214 cannot represent",
                            without, product.parts.size()),
                product.source, "export it as .glb, or start from the CAD system's own STEP file");
  }
  cad::ImportControl control;
  const WorkLimits limits = CommandWatch::Get().LimitsOr(options.load.limits);
  control.limits.time = limits.time;
  control.limits.begin_ns = limits.begin_ns;
  control.limits.memory = limits.memory;
  control.stop = CommandWatch::Get().stop();
  control.progress = MakeProgress(options.load.is_quiet);
  const Result<cad::MappedFile> step = cad::ExportStep(
      options.load.file, assembly::MakeImportOptions(options.load), control, motions);
  if (!step) {
    return Unexpected(step.error());
  }
  const auto bytes = step->bytes();
  return WriteAtomically(
      options.output, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Result<void> WriteJson(const ExportOptions& options, const Product& product,
                       const Diagnostics& diagnostics) {
  const Selection everything(product);
  WorkWatch watch = MakeWorkWatch(options.load);
  nlohmann::ordered_json json = ToJson(product, diagnostics, everything, &watch);
  if (!watch.MayGoOn()) {
    return Unexpected(watch.Explain("comparing the parts as drawn", product.source));
  }
  if (options.has_meshes) {
    AddMeshes(product, everything, options.is_fine, &json);
  }
  return WriteAtomically(options.output,
                         json.dump(options.has_meshes ? -1 : 2, ' ', false,
                                   nlohmann::ordered_json::error_handler_t::replace) +
                             "\n");
}

/** Writes what a simulator reads, and tells which parts are met as their hulls alone. */
Result<void> WriteForSimulator(const ExportOptions& options, const Product& product,
                               const std::string& format) {
  if (product.occurrences.empty()) {
    return Fail(ErrorCode::kUnsupported, "there is no part in it", product.source,
                "export a file with solids");
  }
  const exchange::ExportedProduct exported = exchange::MakeExported(product);
  for (const exchange::ExportedBody& body : exported.bodies) {
    if (body.form.is_hull_only) {
      fmt::print(stderr,
                 "hvas: {}: its surface has too many triangles; it is met as its hull, with holes "
                 "closed\n",
                 product.occurrences[body.occurrence.index()].path);
    }
  }
  exchange::ExportedFiles files;
  const std::string name = options.output.stem().string();
  if (format == ".urdf") {
    files = exchange::MakeUrdf(exported, name);
  } else {
    files[options.output.filename().string()] =
        format == ".usda" ? exchange::MakeUsda(exported) : exchange::MakeMjcf(exported);
  }
  for (const auto& [path, bytes] : files) {
    // A URDF is called after the output, whatever the case of its extension.
    const std::filesystem::path file =
        path == name + ".urdf" ? options.output : options.output.parent_path() / path;
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    if (const auto written = WriteAtomically(file, bytes); !written) {
      return Unexpected(written.error());
    }
  }
  return {};
}

/** Writes the planned way of each part as a demonstration. */
Result<void> WritePlannedWays(const ExportOptions& options, const Product& product) {
  constexpr double kTicks = 1000;  // [Hz], as those of a record.
  assembly::PrepareOptions prepare;
  prepare.shape_cache = assembly::MakeShapeCache(CacheDirectory(options.load));
  prepare.progress = MakeProgress(options.load.is_quiet);
  prepare.stop = CommandWatch::Get().stop();
  Diagnostics diagnostics;
  const auto model = assembly::PrepareModel(product, prepare, &diagnostics);
  if (!model) {
    return Unexpected(model.error());
  }
  return evidence::WriteDemonstrations(
      evidence::ListPlannedWays(**model, kTicks / static_cast<double>(options.record.every)),
      product.source, options.output);
}

Result<void> ExportProduct(const ExportOptions& options, const std::string& format) {
  Diagnostics diagnostics;
  Result<Product> product = LoadProduct(options.load, &diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  CommandWatch::Get().AllowLongWork();
  NoteStage("export");
  cad::PartMotions motions;
  if (!options.poses.empty()) {
    auto moved = ApplyPoses(options.poses, &*product);
    if (!moved) {
      return Unexpected(moved.error());
    }
    motions = std::move(*moved);
  }
  if (!product->placement.drawn_poses.empty()) {
    motions = ListPlacedMotions(*product);
  }
  if (format == ".glb") {
    const Result<std::string> glb = cad::MakeGlb(*product, options.is_fine);
    return glb ? WriteAtomically(options.output, *glb) : Unexpected(glb.error());
  }
  if (options.record.is_demonstrations) {
    return WritePlannedWays(options, *product);
  }
  if (IsOfSimulator(format)) {
    return WriteForSimulator(options, *product, format);
  }
  return format == ".json" ? WriteJson(options, *product, diagnostics)
                           : WriteStep(options, *product, motions);
}

/** @returns The exit status. */
int RunExport(const ExportOptions& options) {
  const std::string format = FormatOf(options.output);
  Result<void> done = Check(options, format);
  if (done && IsRecord(options.load.file)) {
    CommandWatch::Get().End();  // Its limits are for CAD files.
    const auto damage = [&] {
      std::optional<Busy> busy;
      if (!options.load.is_quiet) {
        busy.emplace("exporting the record");
      }
      return ExportRecord(options.load.file, options.output, format, options.record);
    }();
    if (damage && !damage->empty()) {
      fmt::print(stderr, "hvas: {}: {}\n", options.load.file.string(), *damage);
      return kDamagedRecord;
    }
    return damage ? 0 : ReportFailure(damage.error());
  }
  if (done) {
    done = ExportProduct(options, format);
  }
  return done ? 0 : ReportFailure(done.error());
}

}  // namespace

void AddExport(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand(
      "export", "Export a CAD file for viewers and simulators, or a record as a table");
  const auto options = std::make_shared<ExportOptions>();
  command->add_option("file", options->load.file, "CAD file or record")->required();
  command->add_option("-o,--output", options->output, "File to write")->required();
  command->add_option("--poses", options->poses,
                      "Poses instead of those in the file: a pose file or a record");
  command->add_flag("--fine", options->is_fine,
                    "Write the fine meshes of contact instead of those for display");
  command->add_flag("--meshes", options->has_meshes, "Include meshes in the .json");
  command->add_flag("--force", options->is_forced, "Replace an existing file");
  AddRecordSelection(command, &options->record);
  AddLoadOptions(command, &options->load);
  command->footer(
      "Exit status: 0; 2 when the exported record was changed after it was written; 1 on an "
      "error.\n"
      "  .glb   glTF 2.0 in metres, Y up: the tree as nodes, a mesh for each part, colours of\n"
      "         faces, and with each vertex the index of its face (_FACE_ID)\n"
      "  .json  what hvas inspect --json prints\n"
      "  .step  AP214: structure, poses, names and colours, all in one file\n"
      "  .mjcf, .xml  MuJoCo: masses, convex pieces that are met, frames, fits and true sizes of\n"
      "         mates; shafts and holes have the middle of what their fits allow\n"
      "  .urdf  the same as a robot, with meshes beside it in NAME_meshes/\n"
      "  .usda  the same as a USD stage in text, with its physics\n"
      "Formats for a record of hvas assemble or the studio (docs/record.md), every number with its "
      "unit:\n"
      "  .csv   a row for each tick          .json  ticks, events and session\n"
      "  .h5    HDF5: a column for each number, compressed, with units and events\n"
      "  .mcap  for Foxglove and Rerun       .glb   the paths of the parts as lines\n"
      "A pose file is {\"format\": \"hvas-poses-1\", \"poses\": [{\"occurrence\": \"pump/shaft\",\n"
      "\"position_mm\": [0, 0, 50], \"rotation_wxyz\": [1, 0, 0, 0]}]}; with a record, each part "
      "is\n"
      "where it was released last. All other parts stay as drawn.\n"
      "Examples:\n"
      "  hvas export pump.step -o pump.glb\n"
      "  hvas export pump.step -o pump.json --meshes --fine\n"
      "  hvas export pump.stp -o whole.step --force\n"
      "  hvas export pump.step -o pump.mjcf\n"
      "  hvas export pump.step -o exploded.step --poses exploded.json\n"
      "  hvas assemble pump.step --record run.hvasrec && hvas export pump.step -o run.glb --poses "
      "run.hvasrec\n"
      "  hvas export run.hvasrec -o run.csv --every 10 --from 20 --to 30\n"
      "  hvas export run.hvasrec -o run.mcap --every 20\n"
      "  hvas export run.hvasrec -o demonstrations.h5 --demonstrations --every 20");
  command->callback([options, status] { *status = RunExport(*options); });
}

}  // namespace hvas::app
