#include "app/assembly/path.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/assembly/path_clearance.h"
#include "app/assembly/poses.h"
#include "app/command_watch.h"
#include "app/output/json_flag.h"
#include "app/output/new_file.h"
#include "app/output/number_range.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/product/load_product.h"
#include "app/recording/recorded_path.h"
#include "base/atomic_file.h"
#include "base/crash_note.h"
#include "base/csv_row.h"
#include "base/units.h"
#include "mates/assignments.h"
#include "paths/stl.h"
#include "paths/swept_volume.h"
#include "product/wall.h"
#include "simulation/shapes.h"
#include "studio/paths.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using product::Occurrence;
using product::Product;

struct PathOptions {
  LoadOptions load;
  std::string part;
  std::filesystem::path record;
  std::size_t hold{0};
  std::vector<double> translate_mm;
  std::vector<double> rotate_deg;  ///< An axis, and an angle [deg].
  std::vector<double> about_mm;
  bool is_swept{false};
  bool has_clearances{false};
  double resolution_mm{0};
  std::filesystem::path output;
  bool is_forced{false};
  bool is_json{false};
};

Vec3 VectorOf(const std::vector<double>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

/** What can be known to fail before the work. */
Result<void> Check(const PathOptions& options) {
  if (!options.rotate_deg.empty() && !(VectorOf(options.rotate_deg).norm() > 0)) {
    return Fail(ErrorCode::kInvalid, "the direction of the axis has length zero", "--rotate",
                "give a direction and an angle, for example --rotate 0,0,1,90");
  }
  if (options.output.empty()) {
    return options.has_clearances && !options.is_swept
               ? Result<void>()
               : Fail(ErrorCode::kInvalid, "there is no file to write", "--output",
                      "add -o with a file name, or ask for --clearance");
  }
  const std::string format = options.output.extension().string();
  const bool is_mesh = format == ".stl" || format == ".glb";
  const bool is_table = format == ".csv" || format == ".json";
  if (options.is_swept ? !is_mesh : !is_table) {
    return Fail(ErrorCode::kInvalid,
                options.is_swept ? "a swept volume can be written as .stl or .glb only"
                                 : "a path can be written as .csv or .json only",
                options.output.string(),
                options.is_swept
                    ? "choose a file name with one of these extensions"
                    : "choose a file name with one of these extensions, or add --swept");
  }
  return CheckNewFile(options.output, options.is_forced);
}

Result<TimedPath> FindPath(const PathOptions& options, const Product& product,
                           const Occurrence& occurrence) {
  if (!options.record.empty()) {
    return ReadRecordedPath(options.record, product, occurrence.id, options.hold);
  }
  const spatial::Pose& X_WB = occurrence.X_WB;
  if (!options.translate_mm.empty()) {
    return TimedPath{
        paths::MakeTranslation(X_WB, units::FromMm(1) * VectorOf(options.translate_mm)), {}};
  }
  const Vec3 p_WQ = options.about_mm.empty() ? X_WB * product.part_of(occurrence.id).mass.p_BoBcm_B
                                             : Vec3(units::FromMm(1) * VectorOf(options.about_mm));
  return TimedPath{paths::MakeRotation(X_WB, p_WQ, VectorOf(options.rotate_deg).normalized(),
                                       units::FromDeg(options.rotate_deg[3])),
                   {}};
}

/** A path that was not recorded has few poses: it is shown in steps. */
void FillIn(const product::Part& part, TimedPath* path) {
  // A path looks smooth with so many steps: a choice, not measured.
  constexpr double kSteps = 100;
  if (path->t_ns.empty()) {
    const double length = paths::CalcLength(path->X_WB, part.mass.p_BoBcm_B);
    const double step = std::max(length, part.box_B.size().norm()) / kSteps;
    path->X_WB = paths::Resample(path->X_WB, part.box_B, step);
  }
}

std::string MakeCsv(const TimedPath& path, const Vec3& p_BoBcm_B) {
  std::string csv = "t_s,centre_x_m,centre_y_m,centre_z_m,x_m,y_m,z_m,q_w,q_x,q_y,q_z\n";
  for (std::size_t i = 0; i < path.X_WB.size(); ++i) {
    const spatial::Pose& X_WB = path.X_WB[i];
    const Vec3 centre = X_WB * p_BoBcm_B;
    CsvRow row;
    if (path.t_ns.empty()) {
      row.Empty();
    } else {
      row.Fixed(1e-9 * static_cast<double>(path.t_ns[i]), 3);
    }
    for (const double number :
         {centre.x(), centre.y(), centre.z(), X_WB.p().x(), X_WB.p().y(), X_WB.p().z(),
          X_WB.q().w(), X_WB.q().x(), X_WB.q().y(), X_WB.q().z()}) {
      row.Number(number);
    }
    csv += row.End();
  }
  return csv;
}

Json MakeJson(const TimedPath& path, const Occurrence& occurrence, const Vec3& p_BoBcm_B) {
  Json json{{"occurrence", occurrence.path},
            {"times_s", Json::array()},
            {"points_m", Json::array()},
            {"poses", Json::array()}};
  for (const std::int64_t t_ns : path.t_ns) {
    json["times_s"].push_back(1e-9 * static_cast<double>(t_ns));
  }
  for (const spatial::Pose& X_WB : path.X_WB) {
    const Vec3 centre = X_WB * p_BoBcm_B;
    const Vec3& p = X_WB.p();
    const Quat& q = X_WB.q();
    json["points_m"].push_back({centre.x(), centre.y(), centre.z()});
    json["poses"].push_back({{"p", {p.x(), p.y(), p.z()}}, {"q", {q.w(), q.x(), q.y(), q.z()}}});
  }
  return json;
}

Result<paths::SweptVolume> SweepPart(const PathOptions& options, const Product& product,
                                     const Occurrence& occurrence, const paths::Path& path,
                                     std::optional<double> thinnest_wall) {
  paths::SweepOptions sweeping;
  sweeping.resolution = units::FromMm(options.resolution_mm);
  sweeping.thinnest_wall = thinnest_wall.value_or(0);
  sweeping.stop = CommandWatch::Get().stop();
  NoteStage("sweep");
  if (!options.load.is_quiet && IsWatched()) {
    sweeping.progress = [](double fraction) { ShowProgress("sweep", fraction); };
  }
  auto swept =
      paths::Sweep(simulation::MakeShapeSource(product.part_of(occurrence.id)), path, sweeping);
  if (swept) {
    return swept;
  }
  Error error = swept.error();
  error.where = occurrence.path;
  return Unexpected(std::move(error));
}

Result<void> WriteSwept(const PathOptions& options, const Occurrence& occurrence,
                        const paths::SweptVolume& swept) {
  if (options.output.extension() == ".stl") {
    return WriteAtomically(options.output, paths::MakeStl(swept.mesh));
  }
  const auto glb = studio::MakeGlb(swept.mesh, occurrence.name);
  return glb ? WriteAtomically(options.output, *glb) : Unexpected(glb.error());
}

Json DescribeSwept(const paths::SweptVolume& swept) {
  spatial::Box box_W;
  for (const Vec3& vertex : swept.mesh.vertices) {
    box_W.Add(vertex);
  }
  const auto corner_mm = [](const Vec3& p) {
    return Json{units::ToMm(p.x()), units::ToMm(p.y()), units::ToMm(p.z())};
  };
  return {
      {"volume_mm3", units::ToMm3(swept.volume)}, {"resolution_mm", units::ToMm(swept.resolution)},
      {"error_mm", units::ToMm(swept.error)},     {"triangles", swept.mesh.triangles.size()},
      {"low_mm", corner_mm(box_W.low)},           {"high_mm", corner_mm(box_W.high)}};
}

/** Where the other parts stand while the part goes along its path. */
Result<std::map<product::OccurrenceId, spatial::Pose>> FindOthers(const PathOptions& options,
                                                                  const Product& product,
                                                                  const TimedPath& path) {
  if (!options.record.empty()) {
    return ReadPosesBeside(options.record, product, path.t_ns.front());
  }
  std::map<product::OccurrenceId, spatial::Pose> others;
  for (const Occurrence& other : product.occurrences) {
    others[other.id] = other.X_WB;
  }
  return others;
}

void Print(const Json& summary) {
  fmt::print("{}: {} poses, {:.1f} mm\n", summary["occurrence"].get<std::string>(),
             summary["poses"].get<std::size_t>(), summary["length_mm"].get<double>());
  if (summary.contains("volume_mm3")) {
    fmt::print("swept volume {:.1f} mm^3, surface within {:.3f} mm, {} triangles\n",
               summary["volume_mm3"].get<double>(), summary["error_mm"].get<double>(),
               summary["triangles"].get<std::size_t>());
    const double unresolved_mm = 2 * summary["error_mm"].get<double>();
    if (summary.value("thinnest_wall_mm", unresolved_mm) < unresolved_mm) {
      fmt::print(
          "the part's thinnest wall is {:.3f} mm: walls thinner than {:.3f} mm may have holes "
          "(choose a smaller --resolution-mm)\n",
          summary["thinnest_wall_mm"].get<double>(), unresolved_mm);
    }
  }
  if (summary.contains("clearances")) {
    PrintClearances(summary);
  }
}

/** Writes the path, or the swept volume, where a file is named. */
Result<void> WriteOutput(const PathOptions& options, const Product& product,
                         const Occurrence& occurrence, const TimedPath& path, Json* summary) {
  const product::Part& part = product.part_of(occurrence.id);
  if (options.output.empty()) {
    summary->erase("output");
    return {};
  }
  if (!options.is_swept) {
    return WriteAtomically(options.output,
                           options.output.extension() == ".csv"
                               ? MakeCsv(path, part.mass.p_BoBcm_B)
                               : MakeJson(path, occurrence, part.mass.p_BoBcm_B).dump() + "\n");
  }
  const std::optional<double> thinnest_wall = product::CalcThinnestWall(part);
  const auto swept = SweepPart(options, product, occurrence, path.X_WB, thinnest_wall);
  if (!swept) {
    return Unexpected(swept.error());
  }
  summary->update(DescribeSwept(*swept));
  if (thinnest_wall) {
    (*summary)["thinnest_wall_mm"] = units::ToMm(*thinnest_wall);
  }
  return WriteSwept(options, occurrence, *swept);
}

Result<void> WritePath(const PathOptions& options) {
  if (auto checked = Check(options); !checked) {
    return checked;
  }
  Diagnostics diagnostics;
  const Result<Product> product = LoadProduct(options.load, &diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  CommandWatch::Get().AllowLongWork();
  const auto id = mates::FindOccurrence(*product, options.part);
  if (!id) {
    return Unexpected(id.error());
  }
  const Occurrence& occurrence = product->occurrences[id->index()];
  const product::Part& part = product->part_of(*id);
  auto path = FindPath(options, *product, occurrence);
  if (!path) {
    return Unexpected(path.error());
  }
  FillIn(part, &*path);
  Json summary{{"occurrence", occurrence.path},
               {"poses", path->X_WB.size()},
               {"length_mm", units::ToMm(paths::CalcLength(path->X_WB, part.mass.p_BoBcm_B))},
               {"output", options.output.string()}};
  if (options.has_clearances) {
    const auto others = FindOthers(options, *product, *path);
    if (!others) {
      return Unexpected(others.error());
    }
    const auto clearances = DescribeClearances(options.load, *product, *id, path->X_WB, *others);
    if (!clearances) {
      return Unexpected(clearances.error());
    }
    summary.update(*clearances);
  }
  Result<void> written = WriteOutput(options, *product, occurrence, *path, &summary);
  if (written && options.is_json) {
    fmt::print("{}\n", summary.dump(2));
  } else if (written) {
    Print(summary);
  }
  return written;
}

constexpr const char* kPathFooter =
    "  .csv   one pose per line: time, centre of mass, origin, rotation [s, m]\n"
    "  .json  the same: times_s, points_m, poses\n"
    "  .stl   with --swept: millimetres    .glb   with --swept: metres, Y up\n"
    "Poses are those of the part in the product's frame. No point of the mesh is further from\n"
    "the surface than is printed; docs/algorithms/sweep.md says how.\n"
    "Examples:\n"
    "  hvas assemble pump.step --record run.hvasrec\n"
    "  hvas path pump.step --part 'bushing 1' --record run.hvasrec -o way.csv\n"
    "  hvas path pump.step --part 'bushing 1' --record run.hvasrec --swept -o way.stl\n"
    "  hvas path pump.step --part 'bushing 1' --record run.hvasrec --clearance\n"
    "  hvas path pump.step --part cover --translate 0,0,80 --swept --resolution-mm 0.5 -o "
    "up.glb\n"
    "  hvas path pump.step --part lever --rotate 0,0,1,90 --about 10,0,0 --swept -o turn.stl";

void AddWays(CLI::App* command, PathOptions* options) {
  auto* way = command->add_option_group("way", "Source of the path");
  CLI::Option* record =
      way->add_option("--record", options->record,
                      "Path in a recorded session: a record of hvas assemble or the studio");
  constexpr int kVector = 3;  // Coordinates.
  way->add_option("--translate", options->translate_mm, "Translation from its place: X,Y,Z [mm]")
      ->delimiter(',')
      ->check(AnyNumber())
      ->expected(kVector);
  CLI::Option* rotate =
      way->add_option("--rotate", options->rotate_deg,
                      "Rotation about an axis: X,Y,Z of the direction, angle [deg]")
          ->delimiter(',')
          ->check(AnyNumber())
          ->expected(kVector + 1);
  way->require_option(1);
  command
      ->add_option("--hold", options->hold,
                   "Number of the hold of this part, from 1; default: the last one")
      ->check(Positive())
      ->needs(record);
  command
      ->add_option("--about", options->about_mm,
                   "Point on the axis: X,Y,Z [mm]; default: the part's centre of mass")
      ->delimiter(',')
      ->check(AnyNumber())
      ->expected(kVector)
      ->needs(rotate);
}

void AddSwept(CLI::App* command, PathOptions* options) {
  CLI::Option* swept =
      command->add_flag("--swept", options->is_swept, "Write the swept volume as a closed mesh");
  command
      ->add_option(
          "--resolution-mm", options->resolution_mm,
          "Cell size of the swept volume [mm]; default: a hundredth of its extent, or less where "
          "the part has thin walls")
      ->check(Positive())
      ->needs(swept);
}

}  // namespace

void AddPath(CLI::App* app, int* status) {
  CLI::App* command =
      app->add_subcommand("path", "Write a part's path or swept volume; find clearances");
  const auto options = std::make_shared<PathOptions>();
  command->add_option("file", options->load.file, "CAD file")->required();
  command->add_option("--part", options->part, "Name, path or end of the path of an occurrence")
      ->required();
  AddWays(command, options.get());
  AddSwept(command, options.get());
  command->add_flag("--clearance", options->has_clearances,
                    "Find the parts that it comes nearest to on the path, how near and where");
  command->add_option("-o,--output", options->output, "File to write");
  command->add_flag("--force", options->is_forced, "Replace an existing file");
  AddJsonFlag(command, &options->is_json, "path");
  AddLoadOptions(command, &options->load);
  command->footer(kPathFooter);
  command->callback([options, status] {
    const Result<void> done = WritePath(*options);
    *status = done ? 0 : ReportFailure(done.error());
  });
}

}  // namespace hvas::app
