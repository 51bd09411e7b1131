#include "app/recording/report.h"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/assembly/left_out.h"
#include "app/assembly/run_command.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/recording/page_file.h"
#include "app/recording/report_page.h"
#include "evidence/summary.h"
#include "session/recorded_model.h"

namespace hvas::app {
namespace {

/** Names of the parts that have no step in the order of a record. */
Result<std::vector<std::string>> ListLeftOutPaths(record::Reader* reader,
                                                  const evidence::Summary& summary) {
  std::vector<std::string> paths;
  if (!summary.product || !summary.damage.empty()) {
    return paths;
  }
  const auto parts = session::ListPartsWithoutStep(reader, *summary.product);
  if (!parts) {
    return Unexpected(parts.error());
  }
  for (const product::OccurrenceId part : *parts) {
    paths.push_back(summary.product->occurrences[part.index()].path);
  }
  return paths;
}

/** Why parts have no way in, as a section of the page: the model is prepared for it. */
Result<std::string> MakeReasons(record::Reader* reader, const ReportOptions& options) {
  const auto model = PrepareModel(reader, options.record);
  if (!model) {
    return Unexpected(model.error());
  }
  const auto reasons = ExplainLeftOut(**model, options.reasons_s, options.record.is_quiet, {});
  return MakeLeftOutSection({&**model, &reasons});
}

Result<evidence::Summary> ReadSummary(record::Reader* reader) {
  const Busy busy("reading the record");
  auto summary = evidence::Summarise(reader);
  if (!summary || !summary->product || !summary->damage.empty()) {
    return summary;
  }
  auto errors = session::ListDrawingErrors(reader, *summary->product);
  if (!errors) {
    return Unexpected(errors.error());
  }
  summary->product->drawing_errors = *std::move(errors);
  return summary;
}

/** @returns what is damaged in the record; empty: nothing. */
Result<std::string> WriteReport(const ReportOptions& options) {
  if (const auto checked = CheckPageFile(options.output, options.is_forced); !checked) {
    return Unexpected(checked.error());
  }
  auto reader = record::Reader::Open(options.record.file);
  if (!reader) {
    return Unexpected(reader.error());
  }
  const auto summary = ReadSummary(&*reader);
  if (!summary) {
    return Unexpected(summary.error());
  }
  const auto paths = ListLeftOutPaths(&*reader, *summary);
  if (!paths) {
    return Unexpected(paths.error());
  }
  ReportedLeftOut left_out{paths->size(), MakeLeftOutList(*paths)};
  if (!paths->empty() && options.reasons_s > 0) {
    auto reasons = MakeReasons(&*reader, options);
    if (!reasons) {
      return Unexpected(reasons.error());
    }
    left_out.section = *std::move(reasons);
  }
  const Busy busy("drawing the page");
  if (const auto written = WritePage(options.output, MakeReportPage(*summary, left_out));
      !written) {
    return Unexpected(written.error());
  }
  return summary->damage;
}

}  // namespace

int RunReport(const ReportOptions& options) {
  const Result<std::string> damage = WriteReport(options);
  if (!damage) {
    return ReportFailure(damage.error());
  }
  if (damage->empty()) {
    return 0;
  }
  fmt::print(stderr, "hvas: {}: {}; the page says so\n", options.record.file.string(), *damage);
  return kDamagedRecord;
}

void AddReport(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand(
      "report", "Write a report of a recorded session: pictures, forces, fits, events");
  const auto options = std::make_shared<ReportOptions>();
  AddRecordOptions(command, &options->record);
  command
      ->add_option("-o,--output", options->output,
                   "File to write: .html, or .pdf (printed by Chromium)")
      ->required();
  command->add_flag("--force", options->is_forced, "Replace an existing file");
  AddReasonsOption(command, &options->reasons_s);
  command->footer(
      "Exit status: 0; 2 when the record was changed after it was written, which the page also "
      "reports; 1 on an error.\n"
      "The page is self-contained: it needs no network and no other file.\n"
      "Where parts have no way in, the product is prepared again to find and to draw the reasons.\n"
      "Examples:\n"
      "  hvas report press.hvasrec -o press.html\n"
      "  hvas report press.hvasrec -o press.pdf --force");
  command->callback([options, status] { *status = RunReport(*options); });
}

}  // namespace hvas::app
