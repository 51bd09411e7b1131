#include "app/recording/report.h"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/recording/page_file.h"
#include "app/recording/report_page.h"
#include "evidence/summary.h"

namespace hvas::app {
namespace {

/** @returns what is damaged in the record; empty: nothing. */
Result<std::string> WriteReport(const ReportOptions& options) {
  if (const auto checked = CheckPageFile(options.output, options.is_forced); !checked) {
    return Unexpected(checked.error());
  }
  auto reader = record::Reader::Open(options.record);
  if (!reader) {
    return Unexpected(reader.error());
  }
  const Busy busy("reading the record and drawing its page");
  const auto summary = evidence::Summarise(&*reader);
  if (!summary) {
    return Unexpected(summary.error());
  }
  if (const auto written = WritePage(options.output, MakeReportPage(*summary)); !written) {
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
  fmt::print(stderr, "hvas: {}: {}; the page says so\n", options.record.string(), *damage);
  return kDamagedRecord;
}

void AddReport(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand(
      "report", "Write a report of a recorded session: pictures, forces, fits, events");
  const auto options = std::make_shared<ReportOptions>();
  command->add_option("file", options->record, "A record of `hvas assemble --record` or the studio")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "File to write: .html, or .pdf (printed by Chromium)")
      ->required();
  command->add_flag("--force", options->is_forced, "Replace an existing file");
  command->footer(
      "Exit status: 0; 2 when the record was changed after it was written, which the page also "
      "reports; 1 on an error.\n"
      "The page is self-contained: it needs no network and no other file.\n"
      "Examples:\n"
      "  hvas report press.hvasrec -o press.html\n"
      "  hvas report press.hvasrec -o press.pdf --force");
  command->callback([options, status] { *status = RunReport(*options); });
}

}  // namespace hvas::app
