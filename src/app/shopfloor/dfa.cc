#include "app/shopfloor/dfa.h"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/assembly/planned_model.h"
#include "app/assembly/run_report.h"
#include "app/output/json_flag.h"
#include "app/output/new_file.h"
#include "app/output/report_failure.h"
#include "app/recording/page_file.h"
#include "app/shopfloor/dfa_report.h"
#include "base/atomic_file.h"
#include "shopfloor/work_plan.h"

namespace hvas::app {
namespace {

struct DfaOptions : PlanCommandOptions {
  std::filesystem::path worksheet;  ///< Of the user's own; empty: the product is rated.
};

Result<void> CheckOutput(const DfaOptions& options) {
  if (options.output.empty()) {
    return {};
  }
  const std::filesystem::path ending = options.output.extension();
  if (ending != ".csv" && ending != ".html" && ending != ".pdf") {
    return Fail(ErrorCode::kInvalid,
                "the file name has no extension of a format that can be written",
                options.output.string(), "use the extension .csv, .html or .pdf");
  }
  return CheckNewFile(options.output, options.is_replaced);
}

int Finish(const DfaOptions& options, const DfaReport& report) {
  if (!options.output.empty()) {
    const auto written = options.output.extension() == ".csv"
                             ? WriteAtomically(options.output, MakeDfaTable(report))
                             : WritePage(options.output, MakeDfaPage(report));
    if (!written) {
      return ReportFailure(written.error());
    }
  }
  if (options.is_json) {
    PrintJson(MakeDfaJson(report));
  } else {
    PrintDfa(report);
  }
  return 0;
}

int RunDfa(const DfaOptions& options) {
  const EndWatch end;
  if (const auto checked = CheckOutput(options); !checked) {
    return ReportFailure(checked.error());
  }
  if (!options.worksheet.empty()) {
    const auto sheet = ReadDfaSheet(options.worksheet);
    return sheet ? Finish(options, {options.worksheet.filename().string(), &*sheet})
                 : ReportFailure(sheet.error());
  }
  const auto planned = PlanModel(options, end);
  if (!planned) {
    return planned.error();
  }
  const auto rating = shopfloor::RateAssembly(*planned->model, planned->plan);
  if (!rating) {
    return ReportFailure(rating.error());
  }
  const shopfloor::WorkPlan work = shopfloor::MakeWorkPlan(*planned->model, planned->plan);
  return Finish(options, {planned->model->product->name, &rating->sheet, planned->model.get(),
                          &*rating, work.mods});
}

}  // namespace

void AddDfa(CLI::App* app, int* status) {
  CLI::App* command =
      app->add_subcommand("dfa", "Rate a design for assembly (Boothroyd and Dewhurst)");
  const auto options = std::make_shared<DfaOptions>();
  CLI::Option* file = command->add_option("file", options->load.file,
                                          "STEP, IGES or mesh file, or a folder of meshes");
  CLI::Option* sheet =
      command
          ->add_option("--worksheet", options->worksheet,
                       "Calculate a worksheet of your own instead: a table with the columns part, "
                       "count, handling_code, insertion_code and min_parts")
          ->excludes(file);
  file->excludes(sheet);
  command->add_option("-o,--output", options->output,
                      "File to write: .csv, which --worksheet takes, .html or .pdf");
  command->add_flag("--force", options->is_replaced, "Replace an existing file");
  command->add_option("--plan", options->order.plan,
                      "A plan that hvas plan has written with -o: its order is followed");
  AddOrderChoice(command, &options->order);
  AddOrderOptions(command, options.get());
  AddJsonFlag(command, &options->is_json, "dfa or preparation");
  AddAccessoryOptions(command, &options->load);
  AddLoadOptions(command, &options->load);
  command->footer(
      "Examples:\n"
      "  hvas dfa products/gear_pump.step\n"
      "  hvas dfa products/gear_pump.step -o sheet.csv\n"
      "  hvas dfa --worksheet sheet.csv -o dfa.html\n"
      "  hvas dfa pump.step --json | jq '.advice[:3]'");
  command->callback([options, status] {
    if (options->load.file.empty() && options->worksheet.empty()) {
      throw CLI::RequiredError("file or --worksheet");
    }
    *status = RunDfa(*options);
  });
}

}  // namespace hvas::app
