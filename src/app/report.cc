#include "app/report.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <spawn.h>

#include "app/report_failure.h"
#include "app/report_page.h"
#include "base/atomic_file.h"
#include "base/scratch_folder.h"
#include "evidence/summary.h"

extern char** environ;

namespace hvas::app {
namespace {

/** Runs a program of the PATH without output; false where it is not there. */
bool TryRun(const std::vector<std::string>& words, int* status) {
  std::vector<char*> argv;
  for (const std::string& word : words) {
    argv.push_back(const_cast<char*>(word.c_str()));
  }
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  for (const int output : {STDOUT_FILENO, STDERR_FILENO}) {
    ::posix_spawn_file_actions_addopen(&actions, output, "/dev/null", O_WRONLY, 0);
  }
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  return error == 0 && ::waitpid(child, status, 0) == child;
}

Result<void> Print(const std::filesystem::path& page, const std::filesystem::path& pdf,
                   const std::filesystem::path& scratch) {
  constexpr std::array kBrowsers{"chromium", "chromium-browser", "google-chrome"};
  const std::filesystem::path printed = scratch / "printed.pdf";
  for (const char* browser : kBrowsers) {
    std::vector<std::string> words{browser,
                                   "--headless",
                                   "--disable-gpu",
                                   "--no-pdf-header-footer",
                                   "--user-data-dir=" + (scratch / "profile").string(),
                                   "--print-to-pdf=" + printed.string(),
                                   "file://" + page.string()};
    if (::geteuid() == 0) {
      words.insert(words.begin() + 1, "--no-sandbox");  // which root cannot have; the page is ours
    }
    int status = 0;
    if (!TryRun(words, &status)) {
      continue;
    }
    std::error_code failed;
    std::filesystem::copy_file(printed, pdf, std::filesystem::copy_options::overwrite_existing,
                               failed);
    if (status != 0 || failed) {
      return Fail(ErrorCode::kUnsupported, std::string(browser) + " could not print the report",
                  pdf.string(), "write it as .html, and print that");
    }
    return {};
  }
  return Fail(ErrorCode::kUnsupported, "there is no Chromium to print the report with",
              pdf.string(), "install chromium, or write the report as .html and print that");
}

/** What can be known to fail before the work. */
Result<void> Check(const ReportOptions& options) {
  const std::filesystem::path ending = options.output.extension();
  if (ending != ".html" && ending != ".pdf") {
    return Fail(ErrorCode::kInvalid, "the name has no ending of a format that can be written",
                options.output.string(), "end it with .html or .pdf");
  }
  std::error_code ignored;
  if (!options.is_forced &&
      std::filesystem::exists(std::filesystem::symlink_status(options.output, ignored))) {
    return Fail(ErrorCode::kInvalid, "the file is there already", options.output.string(),
                "choose another name, or replace it with --force");
  }
  return {};
}

Result<void> WriteReport(const ReportOptions& options) {
  if (const auto checked = Check(options); !checked) {
    return checked;
  }
  auto reader = record::Reader::Open(options.record);
  if (!reader) {
    return Unexpected(reader.error());
  }
  const auto summary = evidence::Summarise(&*reader);
  if (!summary) {
    return Unexpected(summary.error());
  }
  const std::string page = MakeReportPage(*summary);
  if (options.output.extension() == ".html") {
    return WriteAtomically(options.output, page);
  }
  const auto scratch = ScratchFolder::Make();
  if (!scratch) {
    return Unexpected(scratch.error());
  }
  const std::filesystem::path html = scratch->path() / "report.html";
  const auto written = WriteAtomically(html, page);
  return written ? Print(html, options.output, scratch->path()) : written;
}

}  // namespace

int RunReport(const ReportOptions& options) {
  const Result<void> done = WriteReport(options);
  return done ? 0 : ReportFailure(done.error());
}

void AddReport(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand(
      "report", "Tell of a recorded session on one page: pictures, forces, fits, events");
  const auto options = std::make_shared<ReportOptions>();
  command->add_option("file", options->record, "A record of `hvas assemble --record` or the studio")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "The page to write, .html; or .pdf, which Chromium prints")
      ->required();
  command->add_flag("--force", options->is_forced, "Replace a file that is there");
  command->footer(
      "The page needs no network and no other file.\n"
      "Examples:\n"
      "  hvas report press.hvasrec -o press.html\n"
      "  hvas report press.hvasrec -o press.pdf --force");
  command->callback([options, status] { *status = RunReport(*options); });
}

}  // namespace hvas::app
