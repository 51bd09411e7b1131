#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "app/command_line.h"
#include "app/command_tree.h"
#include "app/test/run_hvas.h"
#include "base/test/odd_files.h"
#include "base/test/temporary_folder.h"
#include "cad/test/greedy_files.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using testing::ExpectRefusal;
using testing::ProductFile;
using testing::Ran;
using testing::RunHvas;

/** A command with the file that it is given, which stands where FILE does. */
using Arguments = std::vector<std::string>;

TEST(OddFileTest, EveryCommandNamesWhatIsNoFileAndWaitsForNothing) {
  const TemporaryFolder folder;
  const std::string out = (folder / "out.csv").string();
  const std::string page = (folder / "out.html").string();
  const std::string product = ProductFile("bushing");

  struct Case {
    std::string name;  // The file's.
    Arguments arguments;
  };

  const std::vector<Case> cases{
      {"x.step", {"inspect", "FILE"}},
      {"x.step", {"inspect", "FILE", "--json"}},
      {"x.step", {"mate", "list", "FILE"}},
      {"x.step", {"mate", "remove", "FILE", "m0"}},
      {"x.step", {"export", "FILE", "-o", (folder / "out.glb").string()}},
      {"x.step", {"assemble", "FILE"}},
      {"x.step", {"path", "FILE", "--part", "shaft", "--translate", "0,0,9", "-o", out}},
      {"x.stl", {"inspect", "FILE"}},
      {"x.gltf", {"inspect", "FILE"}},
      {"x.hvasrec", {"replay", "FILE"}},
      {"x.hvasrec", {"report", "FILE", "-o", page}},
      {"x.hvasrec", {"export", "FILE", "-o", out}},
      {"x.hvasrec", {"path", product, "--part", "shaft", "--record", "FILE", "-o", out}},
      {"x.json", {"export", product, "--poses", "FILE", "-o", (folder / "out.glb").string()}},
      {"x.csv", {"fit", "limits", "--batch", "FILE"}},
      {"x.csv", {"fit", "press", "--batch", "FILE"}},
      {"x.csv", {"study", "analyse", "--table", "FILE"}},
      {"x.csv", {"fit", "40 H7/k6", "--length", "50", "--sizes", "FILE", "--curve", out}},
      {"x.csv", {"fit", "40 H7/k6", "--length", "50", "--along", "FILE", "--curve", out}},
      {"x.csv", {"dfa", "--worksheet", "FILE", "-o", page}},
      {"x.csv", {"motions", "R30B G1A", "--card", "FILE"}},
      {"x.html", {"instructions", product, "-o", page, "--head", "FILE"}},
      {"x.json", {"assemble", product, "--plan", "FILE"}},
      {"x.step", {"assemble", product, "--fixture", "FILE"}},
      {"x.step", {"assemble", product, "--tool", "FILE"}},
      {"x.step", {"tool", product, "--screw", "shaft", "--tool", "FILE"}},
      {"x.yaml", {"campaign", "run", "FILE", "--folder", (folder / "campaign").string()}},
      {"x.so", {"devices", "--try", "plugin:FILE"}},
      {"x.yaml", {"studio", "--no-open", "--study", "FILE", "--participant", "P01"}},
      {"x.yaml", {"study", "check", "FILE"}},
      {"x.yaml", {"study", "run", "FILE", "-o", (folder / "study").string()}},
      {"x.pem",
       {"studio", "--no-open", "--listen", "127.0.0.1", "--certificate", "FILE", "--key", "FILE"}},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (const auto& odd : hvas::testing::MakeOddFiles(folder / std::to_string(i), cases[i].name)) {
      Arguments arguments = cases[i].arguments;
      for (std::string& argument : arguments) {
        if (const std::size_t at = argument.find("FILE"); at != std::string::npos) {
          argument.replace(at, 4, odd.path.string());
        }
      }
      ExpectRefusal(arguments, {odd.path.string(), "this is " + odd.kind + ", not a file", "("});
    }
  }
}

TEST(OddFileTest, SideFileThatIsNoFileIsNamedAndNotWaitedFor) {
  const TemporaryFolder folder;
  for (const auto& odd : hvas::testing::MakeOddFiles(folder.path(), "rig.hvas.json")) {
    const std::string product = (odd.path.parent_path() / "rig.step").string();
    std::filesystem::copy_file(ProductFile("bushing"), product);
    for (const Arguments& arguments :
         {Arguments{"inspect", product}, Arguments{"assemble", product},
          Arguments{"mate", "list", product},
          Arguments{"inspect", product, "--write-assignments", "--force"},
          Arguments{"export", product, "-o", (folder / "out.glb").string()}}) {
      ExpectRefusal(arguments, {odd.path.string(), "this is " + odd.kind + ", not a file"});
    }
  }
  // Nor is a link that leads nowhere taken for no side file.
  std::filesystem::copy_file(ProductFile("bushing"), folder / "rig.step");
  std::filesystem::create_symlink("nowhere", folder / "rig.hvas.json");
  ExpectRefusal({"inspect", (folder / "rig.step").string()}, {"rig.hvas.json", "no such file"});
}

/** Cells of a table by RFC 4180, without their quotes. */
std::vector<std::vector<std::string>> ParseCsv(const std::string& text) {
  std::vector<std::vector<std::string>> rows{{""}};
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string& cell = rows.back().back();
    const bool is_quote = text[i] == '"';
    if (is_quoted && is_quote && i + 1 < text.size() && text[i + 1] == '"') {
      cell += text[i++];
    } else if (is_quote && (is_quoted || cell.empty())) {
      is_quoted = !is_quoted;
    } else if (!is_quoted && text[i] == ',') {
      rows.back().emplace_back();
    } else if (!is_quoted && text[i] == '\n') {
      rows.push_back({""});
    } else if (is_quoted || text[i] != '\r') {
      cell += text[i];
    }
  }
  EXPECT_FALSE(is_quoted) << text;
  rows.pop_back();
  return rows;
}

/** Expects that a spreadsheet takes no cell for a formula. @returns how many texts would be one. */
int CountDisarmed(const std::string& table) {
  int disarmed = 0;
  for (const auto& row : ParseCsv(table)) {
    for (const std::string& cell : row) {
      const std::string begins = cell.substr(0, cell.find_first_not_of(" \t") + 1);
      double number = 0;
      const char* const end = cell.data() + cell.size();
      const bool is_number = std::from_chars(cell.data(), end, number).ptr == end;
      EXPECT_TRUE(cell.empty() || is_number ||
                  std::string("=+-@\t\r").find(begins.back()) == std::string::npos)
          << cell;
      disarmed += cell.starts_with("'") ? 1 : 0;
    }
  }
  return disarmed;
}

/** The pump, whose parts have names that are formulas. */
std::string WriteHostilePump(const TemporaryFolder& folder) {
  const std::string text = testing::ReadText(ProductFile("gear_pump"));
  const std::regex use("(NEXT_ASSEMBLY_USAGE_OCCURRENCE\\('[^']*',')([^']*)");
  std::string hostile;
  std::size_t count = 0;
  auto rest = text.begin();
  for (std::sregex_iterator found(text.begin(), text.end(), use), end; found != end; ++found) {
    constexpr std::array kBegins{"=", "+", "-", "@", "=cmd|'' /C calc''!A0;\"", " ="};
    hostile.append(rest, (*found)[1].second);
    hostile += kBegins.at(count++ % kBegins.size());
    rest = (*found)[2].first;
  }
  hostile.append(rest, text.end());
  const std::string name = "PRODUCT('gear pump','";  // Its id, and then its name.
  hostile.insert(hostile.find(name) + name.size(), "=");
  return folder.Write("hostile.step", hostile).string();
}

/** Commands that write a table for spreadsheets, as the tree of options has them. */
std::set<std::string> ListTableCommands(const CommandHelp& root) {
  std::set<std::string> names;
  for (const CommandHelp* command : ListCommands(root)) {
    for (const OptionHelp& option : command->options) {
      const bool is_output = std::count(option.names.begin(), option.names.end(), "--output") > 0 ||
                             std::count(option.names.begin(), option.names.end(), "--curve") > 0;
      // A page of results names the table that it is made of.
      const bool is_page = option.description.find(".html or .pdf") != std::string::npos ||
                           option.description.find(".html, or .pdf") != std::string::npos;
      if (is_output && !is_page && ToHelp(*command).find(".csv") != std::string::npos) {
        names.insert(command->name + " " + option.names.back());
      }
    }
  }
  return names;
}

TEST(HostileNamesTest, NoCellOfAnyTableIsAFormula) {
  const TemporaryFolder folder;
  const std::string pump = WriteHostilePump(folder);
  const std::string out = (folder / "out.csv").string();
  const std::string record = (folder / "run.hvasrec").string();
  const std::string classes =
      folder.Write("classes.csv", "note,nominal_mm,class\n=1+1,40,H7\n'@x,40,p6\n-1.5,40,h6\n")
          .string();
  const std::string study = (folder / "study").string();
  ASSERT_EQ(RunHvas({"assemble", ProductFile("bushing"), "--record", record, "-q"}).status, 0);
  const std::string protocol = testing::WriteShortStudy("xia-2011", folder.path());
  ASSERT_EQ(
      RunHvas({"study", "run", protocol, "--simulated", "1", "--records", "none", "-o", study})
          .status,
      0);

  struct Case {
    std::string name;
    Arguments arguments;
    int least_disarmed;  // Of texts that would be formulas.
  };

  const std::vector<Case> cases{
      {"hvas dfa --output", {"dfa", pump}, 5},
      {"hvas tool --output", {"tool", pump, "--screw", "@cover screw 1", "--turn", "90", "-q"}, 0},
      {"hvas path --output", {"path", pump, "--part", "@cover", "--translate", "0,0,80", "-q"}, 0},
      {"hvas export --output", {"export", record, "--every", "100"}, 0},
      {"hvas fit --curve", {"fit", "40 H7/p6", "--length", "50", "--curve"}, 0},
      {"hvas fit paper --curve", {"fit", "paper", "--curve"}, 0},
      {"hvas fit limits --output", {"fit", "limits", "--batch", classes}, 2},
      {"hvas study export --output", {"study", "export", study}, 0}};
  std::set<std::string> tested;
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    tested.insert(c.name);
    Arguments arguments = c.arguments;
    if (arguments.back() != "--curve") {
      arguments.emplace_back("-o");
    }
    arguments.push_back(out);
    std::filesystem::remove(out);
    const Ran ran = RunHvas(arguments);
    ASSERT_TRUE(std::filesystem::exists(out)) << ran.err;
    const std::string table = testing::ReadText(out);
    EXPECT_GT(ParseCsv(table).size(), 1U);
    EXPECT_GE(CountDisarmed(table), c.least_disarmed) << table;
  }
  int status = 0;
  for (const std::string& name : ListTableCommands(Describe(*MakeCommandLine(&status)))) {
    // The commands that fill in a table share one writer.
    const bool is_batch = name == "hvas fit press --output" || name == "hvas fit peg --output";
    EXPECT_TRUE(is_batch || tested.contains(name)) << name << " is not tested";
  }
}

TEST(HostileNamesTest, ATableOfItsOwnIsReadBackAsItWas) {
  const TemporaryFolder folder;
  const std::string pump = WriteHostilePump(folder);
  const std::string sheet = (folder / "sheet.csv").string();
  const std::string again = (folder / "again.csv").string();
  ASSERT_EQ(RunHvas({"dfa", pump, "-o", sheet}).status, 0);
  ASSERT_EQ(RunHvas({"dfa", "--worksheet", sheet, "-o", again}).status, 0);
  const auto first = ParseCsv(testing::ReadText(sheet));
  const auto second = ParseCsv(testing::ReadText(again));
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i][0], second[i][0]);
  }
  const std::string table =
      folder.Write("times.csv", "participant,'=a,'+b\n'=P1,2,-3\n'@P2,3,5\n'-P3,1,4\n").string();
  const auto analysis = testing::RunHvasJson({"study", "analyse", "--table", table, "--json"});
  EXPECT_EQ(analysis["conditions"][0]["name"], "=a");
  EXPECT_EQ(analysis["conditions"][1]["name"], "+b");
}

TEST(GreedyFileTest, ThousandsOfPartsAtOnePlaceAreOpenedWhenTheyAreAllowed) {
  const TemporaryFolder folder;
  const std::string file =
      folder.Write("many.gltf", cad::testing::MakeManyNodesGltf(20'000)).string();
  const Ran refused = RunHvas({"inspect", file});
  EXPECT_EQ(refused.status, 1);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "many.gltf: the file places more than 16384 parts",
                      refused.err);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "--max-parts", refused.err);
  const auto report =
      testing::RunHvasJson({"inspect", file, "--max-parts", "20000", "--only", "diagnostics"});
  const auto& diagnostics = report["diagnostics"];
  const auto duplicate = std::find_if(diagnostics.begin(), diagnostics.end(), [](const auto& item) {
    return item["code"] == "duplicate-part";
  });
  ASSERT_NE(duplicate, diagnostics.end());
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "19999 copies",
                      (*duplicate)["message"].template get<std::string>());
}

TEST(GreedyFileReleaseTest, PartsThatAreMatedForTooLongOrTakeTooMuchAreNamedWithTheRemedy) {
  // Each a little beside the other, so that each pair has to be looked at.
  const TemporaryFolder folder;
  const std::string file =
      folder.Write("many.gltf", cad::testing::MakeManyNodesGltf(16'000, 1e-7)).string();
  for (const auto& [option, value] :
       {std::pair("--time-limit", "20"), {"--memory-limit", "600MB"}}) {
    const Ran ran = RunHvas({"inspect", file, option, value});
    EXPECT_EQ(ran.status, 1);
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "many.gltf: finding the mates", ran.err);
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, option, ran.err);
  }
}

}  // namespace
}  // namespace hvas::app
