// What the program says of itself: overview, help, mistakes in the command line, manual and
// completion.

#include "app/command_line.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>
#include <sstream>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "app/command_tree.h"
#include "app/completion.h"
#include "app/manual.h"
#include "app/output/text_layout.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using testing::Ran;
using testing::ReadText;
using testing::RunHvas;
using testing::RunHvasAtTerminal;

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

CommandHelp DescribeProgram() {
  int status = 0;
  return Describe(*MakeCommandLine(&status));
}

TEST(Overview, IsWhatTheProgramAloneShows) {
  const Ran alone = RunHvas({});
  EXPECT_EQ(alone.status, 0);
  EXPECT_EQ(alone.err, "");
  EXPECT_EQ(alone.out, RunHvas({"--help"}).out);
  EXPECT_LE(std::count(alone.out.begin(), alone.out.end(), '\n'), 50) << alone.out;
  const CommandHelp root = DescribeProgram();
  for (const CommandHelp& command : root.commands) {
    EXPECT_TRUE(Has(alone.out, "\n  " + command.LastName() + " ")) << command.name;
    EXPECT_NE(command.group, "Subcommands") << command.name << " stands in no group";
  }
  EXPECT_TRUE(Has(alone.out, "hvas inspect pump.step"));
}

TEST(Overview, VersionIsThatOfTheProject) {
  const Ran ran = RunHvas({"--version"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.out, std::string("hvas ") + Version() + "\n");
}

TEST(Help, OfEveryCommandFitsTheColumnsThatThereAre) {
  const CommandHelp root = DescribeProgram();
  for (const int columns : {50, 80, 132}) {
    ::setenv("COLUMNS", std::to_string(columns).c_str(), 1);
    for (const CommandHelp* command : ListCommands(root)) {
      std::istringstream lines(ToHelp(*command));
      for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(CalcWidth(line), static_cast<std::size_t>(columns)) << command->name << line;
      }
    }
  }
  ::unsetenv("COLUMNS");
}

TEST(Help, OfEveryCommandSaysWhatItIsAndHasNoRawTypes) {
  const CommandHelp root = DescribeProgram();
  for (const CommandHelp* command : ListCommands(root)) {
    SCOPED_TRACE(command->name);
    EXPECT_FALSE(command->description.empty());
    std::set<std::string> names;
    for (const OptionHelp& option : command->options) {
      EXPECT_FALSE(option.description.empty()) << option.Left();
      for (const std::string& name : option.names) {
        EXPECT_TRUE(names.insert(name).second) << name << " occurs twice";
      }
    }
    const std::string text = ToHelp(*command);
    for (const char* raw : {"FLOAT", "UINT", "INT ", "REQUIRED", "{", "Needs:", "Excludes:"}) {
      // A pose file's braces in the help of export are no type.
      EXPECT_TRUE(!Has(text, raw) || command->name == "hvas export") << raw << "\n" << text;
    }
  }
}

TEST(Help, OfFlagsHasNoValue) {
  const std::string text = RunHvas({"fit", "--help"}).out;
  EXPECT_TRUE(Has(text, "  --json  ")) << text;
  EXPECT_TRUE(Has(text, "  --hub NUMBER ")) << text;
  EXPECT_TRUE(Has(text, "  --smoothing WORD "));
  EXPECT_TRUE(Has(text, "  --material TEXT "));
  EXPECT_TRUE(Has(text, "  FIT ... "));
}

TEST(Usage, UnknownWordsAreNamedWithTheNearest) {
  struct Case {
    std::vector<std::string> arguments;
    std::vector<std::string> texts;
  };

  for (const Case& c : std::vector<Case>{
           {{"inspekt"}, {"hvas: ", "command \"inspekt\"", "did you mean \"inspect\"?"}},
           {{"paint"}, {"command \"paint\""}},
           {{"study", "powr"}, {"hvas study: ", "\"powr\"", "did you mean \"power\"?"}},
           {{"fit", "desing"}, {"\"desing\"", "did you mean \"design\"?"}},
           {{"fit", "40 H7/p6", "--lenght", "50"}, {"hvas fit: ", "did you mean \"--length\"?"}},
           {{"fit", "40 H7/p6", "--lenght=50"}, {"\"--lenght\"", "did you mean \"--length\"?"}},
           {{"doctor", "now"}, {"the argument \"now\" is one too many"}},
           {{"assemble", "a.step", "b.step"}, {"the argument \"b.step\" is one too many"}},
           {{"mate", "ad", "a.step"}, {"hvas mate: ", "did you mean \"add\"?"}}}) {
    const Ran ran = RunHvas(c.arguments);
    SCOPED_TRACE(ran.err);
    EXPECT_EQ(ran.status, 64);
    EXPECT_EQ(ran.out, "");
    for (const std::string& text : c.texts) {
      EXPECT_TRUE(Has(ran.err, text)) << text;
    }
    EXPECT_TRUE(Has(ran.err, "--help"));
  }
}

TEST(Usage, MisuseHasAnExitStatusOfItsOwn) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"inspect"},
        {"study"},
        {"fit"},
        {"doctor", "--seconds", "x"},
        {"doctor", "--seconds", "1e99"},
        {"devices", "--rate", "1"},
        {"fit", "40 H7/p6", "--hub", "80"},
        {"fit", "40 H7/p6", "--length", "0"},
        {"fit", "40 H7/p6", "--length", "50", "--smoothing", "some"},
        {"fit", "--length", "50", "limits", "--batch", "x.csv"},
        {"fit", "40 H7/p6", "--length", "50", "--population", "1e99"},
        {"completion", "tcsh"},
        {"licences", "zlip"}}) {
    const Ran ran = RunHvas(arguments);
    SCOPED_TRACE(ran.err);
    EXPECT_EQ(ran.status, 64);
    EXPECT_EQ(ran.out, "");
    EXPECT_FALSE(ran.err.empty());
  }
  EXPECT_EQ(RunHvas({"inspect", "there is none.step"}).status, 1);
}

TEST(Usage, NumbersAndMissingWordsAreToldPlainly) {
  EXPECT_TRUE(Has(RunHvas({"fit", "identify", "--weber", "some"}).err,
                  "--weber needs a number, not \"some\""));
  EXPECT_TRUE(Has(RunHvas({"study"}).err, "a command is missing"));
  EXPECT_TRUE(Has(RunHvas({"assemble"}).err, "file is missing"));
}

/** An option, or an argument, that takes a number. */
struct NumericOption {
  std::vector<std::string> command;  ///< The words that lead to it.
  std::string name;
  std::string type;  ///< What CLI11 prints: type and range.
  bool is_argument{false};
  bool may_be_empty{false};
  int arguments_before{0};  ///< Required ones, which take the first words.
};

void ListNumericOptions(CLI::App* app, std::vector<std::string> command,
                        std::vector<NumericOption>* list) {
  const auto options = app->get_options();
  int arguments = 0;
  for (const CLI::Option* option : options) {
    arguments += option->nonpositional() || !option->get_required() ? 0 : 1;
  }
  int before = 0;
  for (const CLI::Option* option : options) {
    const bool is_argument = !option->nonpositional();
    const std::string type = option->get_type_name();
    const bool is_number =
        type.starts_with("FLOAT") || type.starts_with("INT") || type.starts_with("UINT");
    if (is_number && option->get_expected_max() > 0) {
      list->push_back({command, option->get_name(), type, is_argument,
                       option->get_expected_min() == 0, is_argument ? before : arguments});
    }
    before += is_argument ? 1 : 0;
  }
  for (CLI::App* below : app->get_subcommands([](const CLI::App*) { return true; })) {
    auto words = command;
    if (!below->get_name().empty()) {
      words.push_back(below->get_name());
    }
    ListNumericOptions(below, std::move(words), list);
  }
}

/** The text of the refusal of this value; empty where it is taken, whatever else is missing. */
std::string Refuse(CLI::App* app, const NumericOption& option, const std::string& value) {
  std::vector<std::string> words = option.command;
  words.insert(words.end(), static_cast<std::size_t>(option.arguments_before), "x");
  if (!option.is_argument && value.starts_with("-")) {
    words.push_back(option.name + "=" + value);  // By itself it could be an option.
  } else {
    words.push_back(option.is_argument ? "--" : option.name);
    words.push_back(value);
  }
  std::reverse(words.begin(), words.end());
  try {
    app->parse(std::move(words));
  } catch (const CLI::ConversionError& error) {
    return error.what();
  } catch (const CLI::ValidationError& error) {
    return error.what();
  } catch (const CLI::ParseError&) {
    return {};  // Another option is needed, too.
  }
  return {};
}

TEST(Numbers, EachOptionStatesItsRangeAndRefusesByItsNameWhatIsNoNumberOfIt) {
  int status = 0;
  const auto app = MakeCommandLine(&status);
  std::string never;  // It is missing, which is found after all values are read: nothing is run.
  app->add_option("--never", never, "Not given")->required();
  std::vector<NumericOption> options;
  ListNumericOptions(app.get(), {}, &options);
  EXPECT_GT(options.size(), 150);
  for (const NumericOption& option : options) {
    SCOPED_TRACE(::testing::PrintToString(option.command) + " " + option.name + " " + option.type);
    const std::size_t colon = option.type.find(':');
    ASSERT_NE(colon, std::string::npos) << "no range";
    const std::string range = option.type.substr(colon + 1);
    for (const char* value : {"nan", "-nan", "inf", "-inf", "1e400", "-1e400", "0x10", "", " ",
                              " 5", "5 ", "5abc", "--", "+-5", "1,5e", "five"}) {
      const bool is_taken = option.may_be_empty && std::string(value).empty();
      EXPECT_TRUE(is_taken || Has(Refuse(app.get(), option, value), option.name))
          << "\"" << value << "\"";
    }
    const bool is_any = range == "ANY NUMBER" || range == "-196 TO 1000";
    EXPECT_EQ(Refuse(app.get(), option, "-1").empty(), is_any);
    const bool has_no_end = option.type.starts_with("FLOAT") && !Has(range, "BELOW") &&
                            !Has(range, "in [") && range != "-196 TO 1000";
    for (const char* huge : {"99999999999999999999", "18446744073709551616"}) {
      EXPECT_EQ(Refuse(app.get(), option, huge).empty(), has_no_end) << huge;
    }
  }
}

TEST(Numbers, AreDecimalAndWhatIsRefusedIsNotRun) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"fit", "paper", "--seed", "-1"},
        {"fit", "paper", "--seed", "99999999999999999999"},
        {"fit", "paper", "--seed=0x10"},
        {"assemble", "none.step", "--seed", "-1"},
        {"assemble", "none.step", "--memory-limit", "-1"},
        {"assemble", "none.step", "--memory-limit", "99999999999GB"},
        {"campaign", "play", "none.yaml", "--", "-1"}}) {
    const Ran ran = RunHvas(words);
    SCOPED_TRACE(ran.err);
    EXPECT_EQ(ran.status, 64);
    EXPECT_EQ(ran.out, "");
  }
  EXPECT_TRUE(Has(RunHvas({"fit", "paper", "--seed", "-1"}).err, "--seed: -1 is negative"));
  EXPECT_TRUE(Has(RunHvas({"fit", "paper", "--seed", "5abc"}).err,
                  "--seed needs a whole number of 0 or more, not \"5abc\""));
  const auto paper = [](const char* seed) {
    const Ran ran = RunHvas({"fit", "paper", "--seed", seed});
    EXPECT_EQ(ran.status, 0) << ran.err;
    return ran.out;
  };
  EXPECT_EQ(paper("010"), paper("10"));
  EXPECT_NE(paper("010"), paper("8"));
  EXPECT_EQ(paper("18446744073709551615"), paper("+18446744073709551615"));
}

TEST(Fit, NeedsNoQuotes) {
  const auto out = [](std::vector<std::string> words) {
    words.insert(words.begin(), "fit");
    const Ran ran = RunHvas(words);
    EXPECT_EQ(ran.status, 0) << ran.err;
    return ran.out;
  };
  EXPECT_EQ(out({"40", "H7/p6"}), out({"40 H7/p6"}));
  EXPECT_EQ(out({"40", "H7", "p6"}), out({"40 H7/p6"}));
  EXPECT_EQ(out({"40", "H7"}), out({"40 H7"}));
  EXPECT_EQ(out({"40", "--length", "50", "H7/p6"}), out({"40 H7/p6", "--length", "50"}));
  EXPECT_EQ(out({"40", "H7/p6", "35", "H7/k6"}), out({"40 H7/p6", "35 H7/k6"}));
  EXPECT_EQ(out({"40H7/p6", "35", "H7/k6"}), out({"40 H7/p6", "35 H7/k6"}));
  EXPECT_EQ(out({"1", "1/2", "in", "H7/g6"}), out({"1 1/2 in H7/g6"}));
}

TEST(Colour, IsOnATerminalOnlyAndNobodyWhoRefusesItGetsIt) {
  EXPECT_TRUE(Has(RunHvasAtTerminal(80, {"--help"}).out, "\033["));
  EXPECT_FALSE(Has(RunHvasAtTerminal(80, {"--help"}, true).out, "\033["));
  EXPECT_FALSE(Has(RunHvas({"--help"}).out, "\033["));
  EXPECT_TRUE(Has(RunHvasAtTerminal(80, {"paint"}).out, "\033["));
  EXPECT_FALSE(Has(RunHvas({"paint"}).err, "\033["));
}

/** Runs a script by a shell. @returns the lines that it printed, without their order and those that
 are empty. */
std::set<std::string> RunShell(const std::string& shell, const std::string& script) {
  const TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  const std::string command =
      shell + " '" + folder.Write("script", script).string() + "' > '" + out + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << ReadText(out);
  std::istringstream text(ReadText(out));
  std::set<std::string> lines;
  for (std::string line; std::getline(text, line);) {
    lines.insert(line);
  }
  lines.erase("");
  return lines;
}

using Words = std::vector<std::string>;

/** What a shell offers for the last of these words, which is not finished. */
using Complete = std::set<std::string> (*)(const Words& words);

std::string Quote(const Words& words) {
  std::string text;
  for (const std::string& word : words) {
    text += " '" + word + "'";
  }
  return text;
}

std::set<std::string> CompleteByBash(const Words& words) {
  return RunShell("bash", MakeBashCompletion(DescribeProgram()) + "COMP_WORDS=(" + Quote(words) +
                              ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_hvas\n"
                              "printf '%s\\n' \"${COMPREPLY[@]}\"\n");
}

/** The functions of zsh's own that offer something print it instead, where it fits the word. */
std::set<std::string> CompleteByZsh(const Words& words) {
  return RunShell("zsh -f",
                  "print_offers() { print -l -- ${(M)@:#$words[CURRENT]*} }\n"
                  "compadd() { shift; print_offers \"$@\" }\n"
                  "_describe() { local offers=(\"${(@P)2}\"); print_offers \"${(@)offers%%:*}\" }\n"
                  "_files() { }\n_message() { }\n"
                  "words=(" +
                      Quote(words) + ")\nCURRENT=$#words\n" + MakeZshCompletion(DescribeProgram()));
}

std::set<std::string> CompleteByFish(const Words& words) {
  std::string line;
  for (const std::string& word : words) {
    line += (line.empty() ? "" : " ") + word;
  }
  // An offer is followed by its description, after a tab.
  return RunShell("HOME=/nonexistent fish --no-config",
                  MakeFishCompletion(DescribeProgram()) + "complete -C '" + line +
                      "' | string replace -r '\\t.*' ''; true\n");
}

class CompletionTest : public ::testing::TestWithParam<Complete> {};

TEST_P(CompletionTest, OffersCommandsOptionsAndTheirWords) {
  using Offers = std::set<std::string>;
  const Complete complete = GetParam();
  EXPECT_EQ(complete({"hvas", "insp"}), Offers{"inspect"});
  EXPECT_EQ(complete({"hvas", "fit", "des"}), Offers{"design"});
  EXPECT_EQ(complete({"hvas", "fit", "40", "--hub-m"}), Offers{"--hub-material"});
  EXPECT_EQ(complete({"hvas", "fit", "design", "--hub-m"}), Offers{"--hub-material"});
  EXPECT_EQ(complete({"hvas", "fit", "--smoothing", "din2"}), (Offers{"din2001", "din2017"}));
  EXPECT_EQ(complete({"hvas", "fit", "design", "--basis", ""}), (Offers{"hole", "shaft"}));
  const Offers shells = complete({"hvas", "completion", ""});
  for (const char* shell : {"bash", "zsh", "fish"}) {
    EXPECT_TRUE(shells.contains(shell)) << shell;
  }
  EXPECT_EQ(complete({"hvas", "fit", "--length", ""}), Offers{}) << "a number";
  EXPECT_EQ(complete({"hvas", "study", "analyse", "--pow"}), Offers{}) << "of another command";
}

std::string NameOfShell(const ::testing::TestParamInfo<Complete>& parameter) {
  constexpr std::array<const char*, 3> kNames{"Bash", "Zsh", "Fish"};
  return kNames.at(parameter.index);
}

INSTANTIATE_TEST_SUITE_P(Shells, CompletionTest,
                         ::testing::Values(&CompleteByBash, &CompleteByZsh, &CompleteByFish),
                         &NameOfShell);

TEST(Completion, HasEveryCommandAndOptionInEveryShell) {
  const CommandHelp root = DescribeProgram();
  const std::string bash = MakeBashCompletion(root);
  const std::string zsh = MakeZshCompletion(root);
  const std::string fish = MakeFishCompletion(root);
  for (const CommandHelp* command : ListCommands(root)) {
    for (const OptionHelp& option : command->options) {
      for (const std::string& name : option.names) {
        if (!name.starts_with("--")) {
          continue;
        }
        EXPECT_TRUE(Has(bash, name)) << name;
        EXPECT_TRUE(Has(zsh, "'" + name + ":")) << name;
        EXPECT_TRUE(Has(fish, " -l " + name.substr(2) + " ")) << name;
      }
    }
    EXPECT_TRUE(Has(fish, "'__hvas_is_at " + command->name + "'")) << command->name;
  }
}

TEST(Completion, IsPrintedForEachShell) {
  const CommandHelp root = DescribeProgram();
  EXPECT_EQ(RunHvas({"completion", "bash"}).out, MakeBashCompletion(root));
  EXPECT_EQ(RunHvas({"completion", "zsh"}).out, MakeZshCompletion(root));
  EXPECT_EQ(RunHvas({"completion", "fish"}).out, MakeFishCompletion(root));
}

TEST(Manual, HasEveryCommandOptionAndExitStatus) {
  const CommandHelp root = DescribeProgram();
  const Ran ran = RunHvas({"man"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.out, MakeManual(root, Version()));
  std::string plain = ran.out;
  plain.erase(std::remove(plain.begin(), plain.end(), '\\'), plain.end());
  for (const CommandHelp* command : ListCommands(root)) {
    EXPECT_TRUE(Has(plain, command->Usage())) << command->name;
    for (const OptionHelp& option : command->options) {
      EXPECT_TRUE(Has(plain, ".B " + option.Left() + "\n")) << option.Left();
    }
  }
  for (const ExitStatus& row : ExitStatuses()) {
    EXPECT_TRUE(Has(plain, std::string(".B ") + row.status + "\n"));
  }
}

TEST(Manual, IsSetWithoutWarnings) {
  const TemporaryFolder folder;
  const auto page = folder.Write("hvas.1", RunHvas({"man"}).out);
  const std::string warnings = (folder / "warnings").string();
  const std::string set = "groff -man -Tutf8 -ww -rLL=78n '" + page.string() + "' > '" +
                          (folder / "out").string() + "' 2> '" + warnings + "'";
  EXPECT_EQ(std::system(set.c_str()), 0);
  EXPECT_EQ(ReadText(warnings), "");
}

TEST(Installed, DocumentsAreWhereShellsAndManLookForThem) {
  const TemporaryFolder folder;
  const std::string install = std::string("cmake --install '") + HVAS_BUILD_DIR + "' --prefix '" +
                              folder.path().string() + "' --component documents > /dev/null";
  ASSERT_EQ(std::system(install.c_str()), 0);
  const CommandHelp root = DescribeProgram();
  const auto share = folder / "share";
  EXPECT_EQ(ReadText(share / "man/man1/hvas.1"), MakeManual(root, Version()));
  EXPECT_EQ(ReadText(share / "bash-completion/completions/hvas"), MakeBashCompletion(root));
  EXPECT_EQ(ReadText(share / "zsh/site-functions/_hvas"), MakeZshCompletion(root));
  EXPECT_EQ(ReadText(share / "fish/vendor_completions.d/hvas.fish"), MakeFishCompletion(root));
  EXPECT_FALSE(ReadText(share / "doc/hvas/THIRD-PARTY.md").empty());
  EXPECT_FALSE(ReadText(share / "hvas/schemas/fit.schema.json").empty());
}

TEST(Licences, AreInTheProgramWithTheirTexts) {
  const std::string all = RunHvas({"licences"}).out;
  for (const char* text :
       {"Permission is hereby granted, free of charge", "GNU LESSER GENERAL PUBLIC LICENSE",
        "Mozilla Public License", "Boost Software License", "three", "OpenCASCADE"}) {
    EXPECT_TRUE(Has(all, text)) << text;
  }
  const std::string list = RunHvas({"licences", "--list"}).out;
  EXPECT_TRUE(Has(list, "preact"));
  EXPECT_TRUE(Has(list, "Eigen"));
  const Ran one = RunHvas({"licences", "ZLIB"});
  EXPECT_EQ(one.status, 0);
  EXPECT_TRUE(Has(one.out, "Jean-loup Gailly"));
  EXPECT_FALSE(Has(one.out, "Mozilla"));
  EXPECT_TRUE(Has(RunHvas({"licences", "zlip"}).err, "did you mean \"zlib\"?"));
}

}  // namespace
}  // namespace hvas::app
