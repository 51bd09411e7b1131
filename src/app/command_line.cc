#include "app/command_line.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/assembly/assemble.h"
#include "app/assembly/disassemble.h"
#include "app/assembly/path.h"
#include "app/assembly/plan.h"
#include "app/campaign/campaign.h"
#include "app/command_tree.h"
#include "app/completion.h"
#include "app/devices/devices.h"
#include "app/devices/doctor.h"
#include "app/fit/fit.h"
#include "app/licences.h"
#include "app/manual.h"
#include "app/output/number_range.h"
#include "app/output/report_failure.h"
#include "app/output/terminal.h"
#include "app/output/text_layout.h"
#include "app/product/inspect.h"
#include "app/product/mate.h"
#include "app/product/tool.h"
#include "app/recording/export.h"
#include "app/recording/replay.h"
#include "app/recording/report.h"
#include "app/shopfloor/dfa.h"
#include "app/shopfloor/instructions.h"
#include "app/shopfloor/motions.h"
#include "app/studio.h"
#include "app/study/study.h"
#include "mates/side_file.h"

namespace hvas::app {
namespace {

constexpr std::array<ExitStatus, 4> kStatuses{{
    {"0",
     "Success; for hvas assemble: every part is in its place; for hvas disassemble: "
     "every part has come out."},
    {"1",
     "An error: for example a file that is missing, damaged or not writable, or a fit that does "
     "not exist. The message names the cause and a remedy."},
    {"2",
     "A negative result: a part is not in its place (hvas assemble) or has not come out "
     "(hvas disassemble), a tool cannot go on turning (hvas tool), a record was changed after it "
     "was written (hvas report, export and replay), the replay differs from the record (hvas "
     "replay --verify), shards are missing or damaged (hvas campaign), or the machine misses "
     "deadlines (hvas doctor)."},
    {"64",
     "A wrong command line: an unknown command or option, a value out of range, or options that "
     "exclude each other. Nothing was done."},
}};

/** The name of a command with those of its parents, and a blank behind. */
std::string CommandPath(const CLI::App* app) {
  return app == nullptr ? "" : CommandPath(app->get_parent()) + app->get_name() + " ";
}

class HelpFormatter : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string /*name*/,
                        CLI::AppFormatMode /*mode*/) const override {
    return ToHelp(Describe(*app, CommandPath(app->get_parent())));
  }
};

/** The command that was reached before something was wrong. */
const CLI::App& FindReached(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : FindReached(*parsed.back());
}

/** The first word that nothing takes; empty where there is none. */
std::string FindUnknown(const CLI::App& command) {
  const auto words = command.remaining();
  const auto word =
      std::find_if(words.begin(), words.end(), [](const std::string& w) { return w != "--"; });
  return word == words.end() ? "" : word->substr(0, word->find('='));
}

std::string DescribeUnknown(const CommandHelp& command, const std::string& word) {
  const bool is_option = word.starts_with('-');
  std::vector<std::string> candidates;
  for (const CommandHelp& below : command.commands) {
    if (!is_option) {
      candidates.push_back(below.LastName());
    }
  }
  for (const OptionHelp& option : command.options) {
    if (is_option && !option.is_argument) {
      candidates.insert(candidates.end(), option.names.begin(), option.names.end());
    }
  }
  if (!is_option && candidates.empty()) {
    return fmt::format("the argument \"{}\" is one too many", word);
  }
  const std::string nearest = mates::FindNearest(word, candidates);
  return fmt::format("there is no {} \"{}\"{}", is_option ? "option" : "command", word,
                     nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest));
}

/** Says it in other words than CLI11, where those say little. */
std::string Rephrase(const std::string& what) {
  constexpr std::string_view kConversion = "Could not convert: ";
  if (const std::size_t at = what.find(kConversion); at != std::string::npos) {
    const std::string rest = what.substr(at + kConversion.size());
    const std::size_t equals = rest.find(" = ");
    if (equals != std::string::npos) {
      return fmt::format("{} needs a number, not \"{}\"", rest.substr(0, equals),
                         rest.substr(equals + 3));
    }
  }
  constexpr std::string_view kNeeds = ": needs ";
  if (const std::size_t at = what.find(kNeeds); at != std::string::npos) {
    return what.substr(0, at) + what.substr(at + 1);
  }
  constexpr std::string_view kRequired = " is required";
  if (what.ends_with(kRequired)) {
    const std::string name = what.substr(0, what.size() - kRequired.size());
    return (name == "A subcommand" ? "a command" : name) + " is missing";
  }
  return what;
}

int ReportParseError(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& reached = FindReached(app);
  const std::string name = CommandPath(&reached);
  const std::string unknown = FindUnknown(reached);
  const std::string what =
      unknown.empty()
          ? Rephrase(error.what())
          : DescribeUnknown(Describe(reached, CommandPath(reached.get_parent())), unknown);
  fmt::print(stderr,
             "{} {}\n"
             "Run {}--help for the commands and options.\n",
             Painted(name.substr(0, name.size() - 1) + ":", Style::kBad, stderr), what, name);
  return kMisused;
}

void SetGroups(CLI::App* app) {
  static const std::vector<std::pair<const char*, std::vector<const char*>>> kGroups{
      {"Inspect and convert CAD files", {"inspect", "mate", "export", "path", "tool"}},
      {"Assemble", {"studio", "plan", "assemble", "disassemble", "replay", "report"}},
      {"Work, design, tolerances and studies",
       {"instructions", "dfa", "motions", "fit", "campaign", "study"}},
      {"This machine and this program", {"devices", "doctor", "completion", "man", "licences"}}};
  for (const auto& [group, commands] : kGroups) {
    for (const char* command : commands) {
      app->get_subcommand(command)->group(group);
    }
  }
}

}  // namespace

const char* Version() {
  return HVAS_VERSION;
}

std::span<const ExitStatus> ExitStatuses() {
  return kStatuses;
}

std::unique_ptr<CLI::App> MakeCommandLine(int* status) {
  auto app = std::make_unique<CLI::App>("Haptic virtual assembly of CAD products", "hvas");
  app->formatter(std::make_shared<HelpFormatter>());
  app->set_help_flag("-h,--help", "Print this help and exit");
  app->set_version_flag("--version", fmt::format("hvas {}", Version()),
                        "Print the version and exit");
  app->require_subcommand(1);
  AddInspect(app.get(), status);
  AddMate(app.get(), status);
  AddExport(app.get(), status);
  AddPath(app.get(), status);
  AddTool(app.get(), status);
  AddStudio(app.get(), status);
  AddPlan(app.get(), status);
  AddAssemble(app.get(), status);
  AddDisassemble(app.get(), status);
  AddReplay(app.get(), status);
  AddReport(app.get(), status);
  AddInstructions(app.get(), status);
  AddDfa(app.get(), status);
  AddMotions(app.get(), status);
  AddFit(app.get(), status);
  AddCampaign(app.get(), status);
  AddStudy(app.get(), status);
  AddDevices(app.get(), status);
  AddDoctor(app.get(), status);
  AddCompletion(app.get(), status);
  AddManual(app.get(), status);
  AddLicences(app.get(), status);
  SetGroups(app.get());
  CheckNumbers(app.get());
  app->footer(
      "Examples:\n"
      "  hvas inspect pump.step              show parts, features, mates and fits\n"
      "  hvas studio pump.step               assemble by hand, in a browser\n"
      "  hvas assemble pump.step             let the simulated person assemble\n"
      "  hvas fit 40 H7/p6 --length 50       limits, pressure, force, stresses\n"
      "hvas COMMAND --help shows the options and examples of a command.");
  return app;
}

int RunCommandLine(int argc, char** argv) {
  int status = 0;
  const auto app = MakeCommandLine(&status);
  if (argc <= 1) {
    fmt::print("{}", app->help());
    return 0;
  }
  try {
    app->parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app->help());
  } catch (const CLI::CallForVersion& version) {
    fmt::print("{}\n", version.what());
  } catch (const CLI::ParseError& error) {
    return ReportParseError(*app, error);
  }
  return status;
}

}  // namespace hvas::app
