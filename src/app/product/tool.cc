#include "app/product/tool.h"

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/command_watch.h"
#include "app/output/json_flag.h"
#include "app/output/number_range.h"
#include "app/output/report_failure.h"
#include "app/output/round_json.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "app/product/load_product.h"
#include "app/shipped_files.h"
#include "assembly/prepare_model.h"
#include "base/atomic_file.h"
#include "base/crash_note.h"
#include "base/csv_row.h"
#include "base/units.h"
#include "mates/assignments.h"
#include "mates/fasteners.h"
#include "orders/tool_reach.h"
#include "orders/tool_turn.h"
#include "product/drive_forms.h"
#include "simulation/shapes.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using product::DriveForm;
using product::DriveKind;
using product::Occurrence;
using product::OccurrenceId;
using product::Product;

constexpr int kCannotTurn = 2;  // The exit status where the tool cannot go on turning.

struct ToolOptions {
  LoadOptions load;
  std::string screw;
  std::filesystem::path tool;
  std::optional<double> turn_deg;
  double torque_nm{orders::TurnOptions().torque};  ///< Default: that of TurnOptions, a choice.
  bool is_blind{false};
  std::filesystem::path output;
  bool is_forced{false};
  bool is_json{false};
};

const char* NameOf(DriveKind kind) {
  static constexpr const char* kNames[] = {"hexagon", "cross", "slot"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string DescribeDrive(const DriveForm& drive) {
  return fmt::format("{}{} {:g} mm", NameOf(drive.kind),
                     drive.kind == DriveKind::kHexagon && drive.is_recess ? " socket" : "",
                     std::round(1e3 * units::ToMm(drive.width)) / 1e3);
}

std::vector<DriveForm> ListDrives(const product::Part& part, Diagnostics* diagnostics) {
  constexpr double kTolerance = 2e-6;  // [m]: that of a part's features.
  product::RecognitionLimits limits;
  auto drives = product::FindDriveForms(part, kTolerance, &limits);
  for (const std::string_view limit : limits.items()) {
    diagnostics->Warn("limit-drives", part.name, std::string(limit),
                      "some forms for tools may not be found");
  }
  return drives;
}

Json MakeDriveJson(const DriveForm& drive) {
  return {{"form", NameOf(drive.kind)},         {"is_recess", drive.is_recess},
          {"is_through", drive.is_through},     {"width_mm", units::ToMm(drive.width)},
          {"span_mm", units::ToMm(drive.span)}, {"depth_mm", units::ToMm(drive.depth)}};
}

/** A fastener of the product with its drives. */
struct Fastener {
  OccurrenceId id;
  bool is_nut{false};
  std::vector<DriveForm> drives;
};

std::vector<Fastener> ListFasteners(const Product& product, Diagnostics* diagnostics) {
  const auto kinds = mates::ClassifyOccurrences(product);
  std::vector<std::optional<std::vector<DriveForm>>> of_part(product.parts.size());
  std::vector<Fastener> fasteners;
  for (const Occurrence& occurrence : product.occurrences) {
    const mates::FastenerKind kind = kinds[occurrence.id.index()];
    if (kind == mates::FastenerKind::kNone) {
      continue;
    }
    auto& drives = of_part[occurrence.part.index()];
    if (!drives) {
      drives = ListDrives(product.part_of(occurrence.id), diagnostics);
    }
    fasteners.push_back({occurrence.id, kind == mates::FastenerKind::kNut, *drives});
  }
  return fasteners;
}

Json MakeFastenerJson(const Product& product, const Fastener& fastener) {
  Json drives = Json::array();
  for (const DriveForm& drive : fastener.drives) {
    drives.push_back(MakeDriveJson(drive));
  }
  return {{"occurrence", product.occurrences[fastener.id.index()].path},
          {"kind", fastener.is_nut ? "nut" : "screw"},
          {"drives", std::move(drives)}};
}

void PrintFasteners(const Product& product, const std::vector<Fastener>& fasteners) {
  TextTable table({"fastener", "kind", "drive", "depth\n[mm]"}, 3);
  std::size_t count = 0;
  for (const Fastener& fastener : fasteners) {
    const std::string& path = product.occurrences[fastener.id.index()].path;
    const char* kind = fastener.is_nut ? "nut" : "screw";
    count += fastener.drives.empty() ? 0 : 1;
    if (fastener.drives.empty()) {
      table.Add({path, kind, "none found", ""});
    }
    for (const DriveForm& drive : fastener.drives) {
      table.Add(
          {path, kind, DescribeDrive(drive), fmt::format("{:.2f}", units::ToMm(drive.depth))});
    }
  }
  fmt::print("{}", table.ToText());
  fmt::print("{}", Fold(fmt::format("{} of {} fasteners have a drive for a tool\n", count,
                                    fasteners.size())));
}

/** The hexagon key that is shipped for a socket; none where there is none of this size. */
std::optional<std::filesystem::path> FindShippedKey(const std::vector<DriveForm>& drives) {
  for (const DriveForm& drive : drives) {
    if (drive.kind != DriveKind::kHexagon || !drive.is_recess) {
      continue;
    }
    const auto file = FindProductsFolder() / "tools" /
                      fmt::format("hex_key_{}.step", std::lround(units::ToMm(drive.width)));
    std::error_code error;
    if (std::filesystem::exists(file, error)) {
      return file;
    }
  }
  return std::nullopt;
}

/** A tool on a drive of the fastener, by one of its ends. */
struct EndReach {
  simulation::ToolMate mate;
  orders::ToolReach reach;
};

struct Reach {
  std::filesystem::path tool_file;
  std::string tool_name;
  std::vector<EndReach> ends;
  std::optional<orders::TurnResult> turn;  ///< With --turn.
};

Result<Product> LoadTool(const ToolOptions& options, const std::filesystem::path& file,
                         Diagnostics* diagnostics) {
  LoadOptions load = options.load;
  load.file = file;
  load.fits.clear();
  load.fixtures.clear();
  auto tool = LoadInferred(load, diagnostics);
  if (tool && tool->occurrences.size() != 1) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("the tool has {} parts", tool->occurrences.size()),
                file.filename().string(), "export the tool as one solid");
  }
  return tool;
}

std::string DescribeAll(const std::vector<DriveForm>& drives) {
  std::string text;
  for (const DriveForm& drive : drives) {
    text += (text.empty() ? "" : ", ") + DescribeDrive(drive);
  }
  return text.empty() ? "no drive" : text;
}

const EndReach* FindBestEnd(const std::vector<EndReach>& ends);

/** Turns the fastener with the best end of the tool. */
Result<orders::TurnResult> Turn(const ToolOptions& options, const Product& product,
                                const Fastener& fastener, const std::vector<EndReach>& ends,
                                const orders::ReachQuery& query, contact::Scene* scene) {
  const Occurrence& occurrence = product.occurrences[fastener.id.index()];
  const EndReach* best = FindBestEnd(ends);
  if (best == nullptr && !options.is_blind) {
    return Fail(ErrorCode::kInvalid, "the tool cannot be put on", occurrence.path,
                "hvas tool without --turn says what is in its way");
  }
  const product::MassProperties& mass = query.tool_part->mass;
  orders::TurnOptions turn;
  turn.angle = units::FromDeg(*options.turn_deg);
  turn.torque = options.torque_nm;
  turn.lead = simulation::FindLead(product.part_of(fastener.id));
  turn.is_blind = options.is_blind;
  if (mass.mass > 0) {
    turn.mass = mass.mass;
    turn.p_BoBcm_B = mass.p_BoBcm_B;
    turn.I_BBcm_B = mass.I_BBcm_B;
  }
  const EndReach& end = best != nullptr ? *best : ends.front();
  return orders::TurnByContact(scene, query, end.mate, occurrence.X_WB, end.reach.FindBest(), turn);
}

/** The room of each end of a tool that fits a fastener. */
std::vector<EndReach> CalcReaches(const orders::ReachQuery& query,
                                  const std::vector<simulation::ToolMate>& mates,
                                  const Occurrence& fastener, Diagnostics* diagnostics) {
  NoteStage("reach of the tool");
  std::vector<EndReach> ends;
  for (const simulation::ToolMate& mate : mates) {
    ends.push_back({mate, orders::CalcToolReach(query, mate, fastener.X_WB)});
    if (ends.back().reach.is_truncated) {
      diagnostics->Warn("limit-contact", fastener.path,
                        "a contact query reached its limit of points",
                        "a thin obstacle may be missed");
    }
  }
  return ends;
}

Result<Reach> FindReach(const ToolOptions& options, const Product& product,
                        const Fastener& fastener, Diagnostics* diagnostics) {
  const std::string& path = product.occurrences[fastener.id.index()].path;
  const auto shipped = FindShippedKey(fastener.drives);
  if (options.tool.empty() && !shipped) {
    return Fail(ErrorCode::kNotFound,
                fmt::format("no tool is shipped that fits it ({})", DescribeAll(fastener.drives)),
                path, "name a CAD file of a tool with --tool");
  }
  Reach result;
  result.tool_file = options.tool.empty() ? *shipped : options.tool;
  const auto tool = LoadTool(options, result.tool_file, diagnostics);
  if (!tool) {
    return Unexpected(tool.error());
  }
  const product::Part& part = tool->parts.front();
  result.tool_name = part.name;
  const auto drives = ListDrives(part, diagnostics);
  const auto mates = simulation::ListToolMates(fastener.drives, drives);
  if (mates.empty()) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("the tool {} ({}) does not fit it ({})", part.name, DescribeAll(drives),
                            DescribeAll(fastener.drives)),
                path, "choose a tool of its form and size");
  }
  const auto cache = assembly::MakeShapeCache(CacheDirectory(options.load));
  simulation::ShapesControl control;
  control.cache = cache.get();
  control.shape.stop = CommandWatch::Get().stop();
  CommandWatch::Get().AllowLongWork();
  NoteStage("contact shapes");
  const auto shapes = simulation::BuildShapes(product, control);
  const auto tool_shapes = simulation::BuildShapes(*tool, control);
  if (!shapes || !tool_shapes) {
    return Unexpected(shapes ? tool_shapes.error() : shapes.error());
  }
  contact::Scene scene;
  for (const Occurrence& occurrence : product.occurrences) {
    (void)scene.Add((*shapes)[occurrence.part.index()], occurrence.X_WB);
  }
  orders::ReachQuery query;
  query.scene = &scene;
  query.fastener = contact::BodyId(fastener.id.index());
  query.tool = tool_shapes->front().get();
  query.tool_part = &part;
  result.ends = CalcReaches(query, mates, product.occurrences[fastener.id.index()], diagnostics);
  if (options.turn_deg) {
    auto turn = Turn(options, product, fastener, result.ends, query, &scene);
    if (!turn) {
      return Unexpected(turn.error());
    }
    result.turn = std::move(*turn);
  }
  return result;
}

/** The end of the tool to work with: the one that can go on, else the one with the widest arc. */
const EndReach* FindBestEnd(const std::vector<EndReach>& ends) {
  const EndReach* best = nullptr;
  for (const EndReach& end : ends) {
    const orders::FreeArc* arc = end.reach.FindBest();
    const orders::FreeArc* best_arc = best == nullptr ? nullptr : best->reach.FindBest();
    if (arc != nullptr &&
        (best_arc == nullptr || (arc->can_go_on && !best_arc->can_go_on) ||
         (arc->can_go_on == best_arc->can_go_on && arc->angle() > best_arc->angle()))) {
      best = &end;
    }
  }
  return best;
}

bool CanGoOn(const Reach& reach) {
  const EndReach* best = FindBestEnd(reach.ends);
  return best != nullptr && best->reach.FindBest()->can_go_on;
}

class Names {
 public:
  explicit Names(const Product& product) : product_(product) {}

  [[nodiscard]] std::string Of(contact::BodyId body) const {
    return body.is_valid() ? product_.occurrences[body.index()].path : std::string();
  }

  [[nodiscard]] Json ToJson(contact::BodyId body) const {
    return body.is_valid() ? Json(Of(body)) : Json();
  }

 private:
  const Product& product_;
};

Json MakeArcJson(const orders::FreeArc& arc, const Names& names) {
  return {{"from_deg", units::ToDeg(arc.from)},
          {"to_deg", units::ToDeg(arc.to)},
          {"angle_deg", units::ToDeg(arc.angle())},
          {"at_from", names.ToJson(arc.at_from)},
          {"at_to", names.ToJson(arc.at_to)},
          {"can_put_on", arc.can_put_on},
          {"can_go_on", arc.can_go_on}};
}

Json MakeReachJson(const Product& product, const Reach& reach) {
  const Names names(product);
  Json ends = Json::array();
  for (const EndReach& end : reach.ends) {
    Json arcs = Json::array();
    for (const orders::FreeArc& arc : end.reach.arcs) {
      arcs.push_back(MakeArcJson(arc, names));
    }
    ends.push_back({{"drive", MakeDriveJson(end.mate.fastener)},
                    {"tool_drive", MakeDriveJson(end.mate.tool)},
                    {"engaged_mm", units::ToMm(end.mate.engaged)},
                    {"play_deg", units::ToDeg(end.mate.play)},
                    {"pitch_deg", units::ToDeg(end.mate.pitch)},
                    {"lever_mm", units::ToMm(end.reach.lever)},
                    {"arcs", std::move(arcs)},
                    {"obstacle", names.ToJson(end.reach.obstacle)},
                    {"obstacle_along_axis", names.ToJson(end.reach.obstacle_along_axis)}});
  }
  const EndReach* best = FindBestEnd(reach.ends);
  const orders::FreeArc* arc = best == nullptr ? nullptr : best->reach.FindBest();
  Json json{{"tool", reach.tool_name},
            {"tool_file", reach.tool_file.string()},
            {"angle_deg", arc == nullptr ? 0.0 : units::ToDeg(arc->angle())},
            {"can_go_on", CanGoOn(reach)},
            {"ends", std::move(ends)}};
  if (reach.turn) {
    const orders::TurnResult& turn = *reach.turn;
    json["turn"] = {{"is_complete", turn.is_complete},
                    {"angle_deg", units::ToDeg(turn.angle)},
                    {"travel_mm", units::ToMm(turn.travel)},
                    {"strokes", turn.strokes},
                    {"peak_torque_nm", turn.peak_torque},
                    {"deepest_mm", units::ToMm(turn.deepest)},
                    {"obstacle", names.ToJson(turn.obstacle)},
                    {"obstacle_angle_deg", units::ToDeg(turn.obstacle_angle)},
                    {"has_slipped", turn.has_slipped},
                    {"is_truncated", turn.is_truncated}};
  }
  return json;
}

/** The samples of a turn as a table. */
std::string MakeTurnCsv(const Product& product, const orders::TurnResult& turn) {
  const Names names(product);
  std::string csv =
      "time_s,lift_mm,hand_deg,tool_deg,fastener_deg,travel_mm,torque_nm,hand_torque_nm,contacts,"
      "obstacle,obstacle_force_n\n";
  for (const orders::TurnSample& sample : turn.samples) {
    csv += CsvRow()
               .Fixed(sample.time, 3)
               .Fixed(units::ToMm(sample.lift), 4)
               .Fixed(units::ToDeg(sample.hand_angle), 4)
               .Fixed(units::ToDeg(sample.tool_angle), 4)
               .Fixed(units::ToDeg(sample.fastener_angle), 4)
               .Fixed(units::ToMm(sample.fastener_travel), 6)
               .Fixed(sample.torque, 5)
               .Fixed(sample.hand_torque, 5)
               .Whole(sample.contact_count)
               .Text(names.Of(sample.obstacle))
               .Fixed(sample.obstacle_force, 3)
               .End();
  }
  return csv;
}

std::string DescribeStops(const orders::FreeArc& arc, const Names& names) {
  return arc.is_full ? "nothing is in its way"
                     : fmt::format("between {} and {}", names.Of(arc.at_from), names.Of(arc.at_to));
}

void PrintReach(const Product& product, const Fastener& fastener, const Reach& reach) {
  const Names names(product);
  const std::string& path = product.occurrences[fastener.id.index()].path;
  for (const EndReach& end : reach.ends) {
    fmt::print("{}", Fold(fmt::format(
                         "{} on {}: {}, {:.1f} mm engaged, play {:.2f} deg, lever {:.1f} mm\n",
                         reach.tool_name, path, DescribeDrive(end.mate.fastener),
                         units::ToMm(end.mate.engaged), units::ToDeg(end.mate.play),
                         units::ToMm(end.reach.lever))));
    if (end.reach.arcs.empty()) {
      fmt::print(
          "{}", Fold(fmt::format("  it has no room: it meets {}\n", names.Of(end.reach.obstacle))));
    }
    for (const orders::FreeArc& arc : end.reach.arcs) {
      const std::string put_on = arc.can_put_on
                                     ? ""
                                     : fmt::format("; it cannot be put on, as it meets {}",
                                                   names.Of(end.reach.obstacle_along_axis));
      fmt::print("{}", Fold(fmt::format("  {:.1f} deg free, {}{}\n", units::ToDeg(arc.angle()),
                                        DescribeStops(arc, names), put_on)));
    }
  }
  const EndReach* best = FindBestEnd(reach.ends);
  if (best == nullptr) {
    fmt::print("{}", Fold(fmt::format("{} cannot be put on {}\n", reach.tool_name, path)));
    return;
  }
  const orders::FreeArc& arc = *best->reach.FindBest();
  const double pitch_deg = units::ToDeg(best->mate.pitch);
  if (arc.can_go_on) {
    fmt::print("{}", Fold(fmt::format("{} can turn {} without end\n", reach.tool_name, path)));
  } else {
    fmt::print("{}",
               Fold(fmt::format("{} can turn {} once by {:.1f} deg at most, and no further: to be "
                                "put on again it needs {:g} deg\n",
                                reach.tool_name, path, units::ToDeg(arc.angle()), pitch_deg)));
  }
}

void PrintTurn(const Product& product, const Fastener& fastener, const orders::TurnResult& turn) {
  const std::string& path = product.occurrences[fastener.id.index()].path;
  fmt::print("{}", Fold(fmt::format("{} turned by {:.1f} deg in {} stroke{}, {:.3f} mm along its "
                                    "axis, peak torque {:.2f} N m\n",
                                    path, units::ToDeg(turn.angle), turn.strokes,
                                    turn.strokes == 1 ? "" : "s", units::ToMm(turn.travel),
                                    turn.peak_torque)));
  if (turn.has_slipped) {
    fmt::print("{}", Fold("the tool slipped: the contacts of its flats bear no more than that\n"));
  }
  if (turn.obstacle.is_valid()) {
    fmt::print("{}",
               Fold(fmt::format("the tool met {} at {:.1f} deg\n", Names(product).Of(turn.obstacle),
                                units::ToDeg(turn.obstacle_angle))));
  }
}

Result<void> CheckOptions(const ToolOptions& options) {
  if (!options.tool.empty() && options.screw.empty()) {
    return Fail(ErrorCode::kInvalid, "the fastener that the tool is put on is missing", "--tool",
                "name it with --screw");
  }
  std::error_code error;
  if (!options.output.empty() && !options.is_forced &&
      std::filesystem::exists(std::filesystem::symlink_status(options.output, error))) {
    return Fail(ErrorCode::kInvalid, "the file exists already", options.output.string(),
                "choose another name, or replace it with --force");
  }
  return {};
}

Result<int> RunTool(const ToolOptions& options) {
  if (const auto checked = CheckOptions(options); !checked) {
    return Unexpected(checked.error());
  }
  Diagnostics diagnostics;
  const Result<Product> product = LoadProduct(options.load, &diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  std::vector<Fastener> fasteners;
  std::optional<Reach> reach;
  if (options.screw.empty()) {
    fasteners = ListFasteners(*product, &diagnostics);
  } else {
    const auto id = mates::FindOccurrence(*product, options.screw);
    if (!id) {
      return Unexpected(id.error());
    }
    const auto kind = mates::ClassifyOccurrences(*product)[id->index()];
    fasteners.push_back(
        {*id, kind == mates::FastenerKind::kNut, ListDrives(product->part_of(*id), &diagnostics)});
    auto found = FindReach(options, *product, fasteners.front(), &diagnostics);
    if (!found) {
      return Unexpected(found.error());
    }
    reach = std::move(*found);
  }
  if (const auto strict = CheckStrict(options.load, diagnostics); !strict) {
    return Unexpected(strict.error());
  }
  if (reach && reach->turn && !options.output.empty()) {
    const auto written = WriteAtomically(options.output, MakeTurnCsv(*product, *reach->turn));
    if (!written) {
      return Unexpected(written.error());
    }
  }
  if (options.is_json) {
    Json json{{"source", product->source}, {"fasteners", Json::array()}};
    for (const Fastener& fastener : fasteners) {
      json["fasteners"].push_back(MakeFastenerJson(*product, fastener));
    }
    if (reach) {
      json["reach"] = MakeReachJson(*product, *reach);
    }
    RoundNumbers(&json);
    fmt::print("{}\n", json.dump(2));
  } else if (reach) {
    PrintReach(*product, fasteners.front(), *reach);
    if (reach->turn) {
      PrintTurn(*product, fasteners.front(), *reach->turn);
    }
  } else {
    PrintFasteners(*product, fasteners);
  }
  const bool has_turned = !reach || (reach->turn ? reach->turn->is_complete : CanGoOn(*reach));
  return has_turned ? 0 : kCannotTurn;
}

}  // namespace

void AddTool(CLI::App* app, int* status) {
  CLI::App* command =
      app->add_subcommand("tool", "Find forms for tools, and the angle that a tool has");
  const auto options = std::make_shared<ToolOptions>();
  command->add_option("file", options->load.file, "CAD file")->required();
  command->add_option("--screw", options->screw,
                      "Fastener that is turned: name, path or end of the path of an occurrence");
  command->add_option("--tool", options->tool,
                      "CAD file of the tool; default: the hexagon key of the socket's size");
  AddFixtureOption(command, &options->load);
  auto* turn = command
                   ->add_option("--turn", options->turn_deg,
                                "Turn the fastener by contact with the tool: angle, "
                                "counter-clockwise as seen by the user, "
                                "which loosens a right-hand thread [deg]")
                   ->check(AnyNumber());
  command
      ->add_option("--torque", options->torque_nm,
                   "Dry friction of the fastener in its thread and under its head [N m]")
      ->check(Positive())
      ->needs(turn)
      ->capture_default_str();
  command
      ->add_flag("--blind", options->is_blind,
                 "Turn until something is in the way, whatever angle is free")
      ->needs(turn);
  CLI::Option* output =
      command->add_option("-o,--output", options->output, "Table of the turn to write: .csv")
          ->needs(turn);
  command->add_flag("--force", options->is_forced, "Replace an existing file")->needs(output);
  AddJsonFlag(command, &options->is_json, "tool");
  AddLoadOptions(command, &options->load);
  command->footer(
      "All parts are in their place. The tool is put on along the axis of the fastener, and swung\n"
      "until it meets a part. docs/algorithms/tools.md says how.\n"
      "With --turn a hand turns it in virtual time; only contact with the tool turns the\n"
      "fastener, and it is put on again where the whole angle is not free.\n"
      "Exit status: 0; 2 when the tool cannot be put on, or cannot be put on again after its\n"
      "swing (60 deg for a hexagon), or did not turn as far as was asked; 1 on an error.\n"
      "Examples:\n"
      "  hvas tool products/gear_pump.step\n"
      "  hvas tool products/gear_pump.step --screw 'cover screw 1'\n"
      "  hvas tool products/gear_pump.step --screw 'cover screw 1' --turn 90 -o turn.csv\n"
      "  hvas tool pump.step --screw 'bolt 3' --tool spanner.step --json");
  command->callback([options, status] {
    const Result<int> done = RunTool(*options);
    *status = done ? *done : ReportFailure(done.error());
  });
}

}  // namespace hvas::app
