#include "app/shopfloor/motions.h"

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/assembly/run_report.h"
#include "app/output/choice.h"
#include "app/output/json_flag.h"
#include "app/output/report_failure.h"
#include "app/output/text_table.h"
#include "app/shopfloor/time_card_file.h"
#include "shopfloor/motion_code.h"

namespace hvas::app {
namespace {

enum class MotionSystem { kModapts, kMost };

struct MotionsOptions {
  std::string sequence;
  MotionSystem system{MotionSystem::kModapts};
  std::filesystem::path card;  ///< Empty: the codes of MODAPTS.
  bool is_json{false};
};

int ShowMost(const MotionsOptions& options) {
  const auto seconds = shopfloor::CalcMostSeconds(options.sequence);
  if (!seconds) {
    return ReportFailure(seconds.error());
  }
  const double tmu = *seconds / shopfloor::kTmuSeconds;
  if (options.is_json) {
    PrintJson({{"system", "BasicMOST"},
               {"sequence", options.sequence},
               {"tmu", tmu},
               {"total_s", *seconds}});
  } else {
    fmt::print("{}: {:.0f} TMU, {:.3f} s by BasicMOST\n", options.sequence, tmu, *seconds);
  }
  return 0;
}

int ShowMotions(const MotionsOptions& options) {
  shopfloor::TimeCard card = shopfloor::ModaptsCard();
  if (!options.card.empty()) {
    auto read = ReadTimeCard(options.card);
    if (!read) {
      return ReportFailure(read.error());
    }
    card = std::move(*read);
  }
  const auto motions = shopfloor::ParseMotions(options.sequence, card);
  if (!motions) {
    return ReportFailure(motions.error());
  }
  const double total = shopfloor::SumSeconds(*motions);
  if (options.is_json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const shopfloor::CodedMotion& motion : *motions) {
      list.push_back({{"code", motion.code}, {"count", motion.count}, {"time_s", motion.seconds}});
    }
    PrintJson({{"system", card.name},
               {"sequence", options.sequence},
               {"motions", std::move(list)},
               {"total_s", total}});
    return 0;
  }
  TextTable table({"code", "times", "s"});
  for (const shopfloor::CodedMotion& motion : *motions) {
    table.Add({motion.code, std::to_string(motion.count), fmt::format("{:.3f}", motion.seconds)});
  }
  table.Add({"all", "", fmt::format("{:.3f}", total)});
  fmt::print("{}Times of {}.\n", table.ToText(), card.name);
  return 0;
}

}  // namespace

void AddMotions(CLI::App* app, int* status) {
  CLI::App* command =
      app->add_subcommand("motions", "Calculate the time of a sequence of coded motions");
  const auto options = std::make_shared<MotionsOptions>();
  command
      ->add_option("sequence", options->sequence,
                   "Codes, each with a number of times before it where it is done several times")
      ->required();
  CLI::Option* card = command->add_option(
      "--card", options->card,
      "Table with a card of times of your own: columns code, and seconds, tmu or mod");
  AddChoice(
      command, "--system", &options->system,
      Choices<MotionSystem>{{"modapts", MotionSystem::kModapts}, {"most", MotionSystem::kMost}},
      "System of the codes: modapts (default) or most (BasicMOST, by its indices)")
      ->excludes(card);
  AddJsonFlag(command, &options->is_json, "motions");
  command->footer(
      "Examples:\n"
      "  hvas motions \"M3 E2 G3 M3 E2 P5\"                  pick a screw and insert it: 2.322 s\n"
      "  hvas motions \"M4 G1 5 C3\"                         five turns of a crank\n"
      "  hvas motions \"A1 B0 G3 A1 B0 P6 A0\" --system most\n"
      "  hvas motions \"R30B G1A\" --card my_card.csv");
  command->callback([options, status] {
    *status = options->system == MotionSystem::kMost ? ShowMost(*options) : ShowMotions(*options);
  });
}

}  // namespace hvas::app
