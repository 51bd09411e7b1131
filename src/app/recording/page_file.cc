#include "app/recording/page_file.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <string>
#include <vector>

#include <fcntl.h>
#include <spawn.h>

#include "app/output/new_file.h"
#include "base/atomic_file.h"
#include "base/scratch_folder.h"

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
      return Fail(ErrorCode::kUnsupported, std::string(browser) + " could not print the page",
                  pdf.string(), "write the page as .html, and print that");
    }
    return {};
  }
  return Fail(ErrorCode::kUnsupported, "Chromium, which prints the page, was not found",
              pdf.string(), "install chromium, or write the page as .html and print that");
}

}  // namespace

Result<void> CheckPageFile(const std::filesystem::path& file, bool is_forced) {
  const std::filesystem::path ending = file.extension();
  if (ending != ".html" && ending != ".pdf") {
    return Fail(ErrorCode::kInvalid,
                "the file name has no extension of a format that can be written", file.string(),
                "use the extension .html or .pdf");
  }
  return CheckNewFile(file, is_forced);
}

Result<void> WritePage(const std::filesystem::path& file, std::string_view page) {
  if (file.extension() == ".html") {
    return WriteAtomically(file, page);
  }
  const auto scratch = ScratchFolder::Make();
  if (!scratch) {
    return Unexpected(scratch.error());
  }
  const std::filesystem::path html = scratch->path() / "report.html";
  const auto written = WriteAtomically(html, page);
  return written ? Print(html, file, scratch->path()) : written;
}

}  // namespace hvas::app
