#include "app/study/study_run.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/choice.h"
#include "app/output/json_flag.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "app/product/load_product.h"
#include "app/recording/page_file.h"
#include "app/study/study_protocol.h"
#include "base/atomic_file.h"
#include "base/clock.h"
#include "study/study_folder.h"
#include "study/study_page.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using study::Participant;
using study::Protocol;
using study::StudyFolder;

constexpr const char* kSimulated =
    "simulated participants with random skills, not people; results do not generalise to people";

struct RunOptions {
  std::string protocol;
  int participants{0};    ///< 0: as many as the protocol plans.
  std::uint64_t seed{1};  ///< Any number: orders and simulated people follow from it.
  std::filesystem::path folder;
  study::KeptRecords records{study::KeptRecords::kLast};
  unsigned threads{0};
  bool is_json{false};
  LoadOptions load;
};

/** What a study has come to, in numbers. */
Json MakeSummaryJson(const StudyFolder& folder, const std::vector<Participant>& participants) {
  Json conditions = Json::array();
  const Protocol& protocol = folder.protocol();
  for (const study::ConditionTimes& times : study::SummariseTimes(protocol, participants)) {
    Json one{
        {"condition", protocol.conditions[times.condition].id},
        {"trials", times.trials},
        {"done", times.done},
        {"mean_time_s", times.done > 0 ? Json(times.mean) : Json(nullptr)},
        {"restricted_mean_time_s", times.trials > 0 ? Json(times.restricted_mean) : Json(nullptr)}};
    const auto published = protocol.conditions[times.condition].published_mean;
    one["published_mean_s"] = published ? Json(*published) : Json(nullptr);
    conditions.push_back(std::move(one));
  }
  Json people = Json::array();
  for (const Participant& participant : participants) {
    people.push_back({{"participant", participant.id},
                      {"simulated", participant.is_simulated},
                      {"phase", study::ToString(participant.session->phase())},
                      {"trials_done", participant.session->done().size()},
                      {"trials", participant.session->schedule().size()},
                      {"interruptions", participant.session->interruptions().size()}});
  }
  return {{"schema", "hvas-study-summary-1"},   {"study", protocol.id},
          {"protocol_digest", protocol.digest}, {"seed", folder.seed()},
          {"folder", folder.path().string()},   {"participants", std::move(people)},
          {"conditions", std::move(conditions)}};
}

void PrintSummary(const StudyFolder& folder, const std::vector<Participant>& participants) {
  const Protocol& protocol = folder.protocol();
  fmt::print("{}, seed {}, protocol {}\n", protocol.id, folder.seed(), protocol.digest);
  const bool is_simulated = std::any_of(participants.begin(), participants.end(),
                                        [](const auto& p) { return p.is_simulated; });
  if (is_simulated) {
    fmt::print("{}", Fold(kSimulated));
  }
  TextTable table({"condition\n", "trials\n", "done\n", "mean of\ndone, s", "mean of\nall*, s",
                   "published\ns"});
  for (const study::ConditionTimes& times : study::SummariseTimes(protocol, participants)) {
    const study::Condition& condition = protocol.conditions[times.condition];
    table.Add({condition.id, fmt::format("{}", times.trials), fmt::format("{}", times.done),
               times.done > 0 ? fmt::format("{:.2f}", times.mean) : "-",
               times.trials > 0 ? fmt::format("{:.2f}", times.restricted_mean) : "-",
               condition.published_mean ? fmt::format("{:.2f}", *condition.published_mean) : "-"});
  }
  fmt::print(
      "\n"
      "{}* trials without success count with their time limit\n",
      table.ToText());
}

Result<void> WriteStudyPage(const StudyFolder& folder, const std::vector<Participant>& participants,
                            const std::filesystem::path& output) {
  auto page = study::MakeStudyPage(folder, participants);
  if (!page) {
    return Unexpected(page.error());
  }
  return WritePage(output, *page);
}

/** The tables and the report, in the folder. */
Result<void> WriteResults(const StudyFolder& folder, const std::vector<Participant>& participants) {
  const std::map<std::string, std::string> tables{
      {"trials.csv", study::MakeTrialsCsv(participants)},
      {"answers.csv", study::MakeAnswersCsv(participants)}};
  for (const auto& [name, text] : tables) {
    const auto written = WriteAtomically(folder.path() / name, text, FileReaders::kOwner);
    if (!written) {
      return written;
    }
  }
  return WriteStudyPage(folder, participants, folder.path() / "report.html");
}

Result<void> RunSimulated(const RunOptions& options) {
  const auto protocol = FindProtocol(options.protocol);
  if (!protocol) {
    return Unexpected(protocol.error());
  }
  const auto product = FindProductOf(*protocol);
  if (!product) {
    return Unexpected(product.error());
  }
  const std::filesystem::path path =
      options.folder.empty() ? std::filesystem::path(protocol->id) : options.folder;
  const auto folder = StudyFolder::Create(path, *protocol, options.seed);
  if (!folder) {
    return Unexpected(folder.error());
  }
  study::SimulatedStudyOptions simulated;
  simulated.participants = options.participants > 0 ? options.participants : protocol->participants;
  simulated.records = options.records;
  simulated.threads = options.threads;
  const std::int64_t start_ns = MonotonicNs();
  if (!options.load.is_quiet && IsWatched()) {
    simulated.progress = [](std::size_t done, std::size_t total) {
      ShowProgress(fmt::format("trial {} of {}", done, total),
                   static_cast<double>(done) / static_cast<double>(total));
    };
  }
  const study::ModelSource models = MakeModelSource(*product, options.load, options.seed);
  if (const auto done = study::RunSimulatedStudy(*folder, models, simulated); !done) {
    return done;
  }
  const auto participants = folder->ReadParticipants();
  if (!participants) {
    return Unexpected(participants.error());
  }
  const Result<void> written = [&] {
    const Busy busy("writing the report");
    return WriteResults(*folder, *participants);
  }();
  if (!written) {
    return written;
  }
  const double wall_s = 1e-9 * static_cast<double>(MonotonicNs() - start_ns);
  if (options.is_json) {
    Json json = MakeSummaryJson(*folder, *participants);
    json["what"] = kSimulated;
    json["wall_s"] = wall_s;
    fmt::print("{}\n", json.dump(2));
  } else {
    PrintSummary(*folder, *participants);
    fmt::print("\nIn {:.1f} s. Report: {}\n", wall_s, (folder->path() / "report.html").string());
  }
  return {};
}

void AddRun(CLI::App* group, int* status) {
  CLI::App* command = group->add_subcommand(
      "run", "Run a complete study with simulated participants, including its report");
  const auto options = std::make_shared<RunOptions>();
  command->add_option("protocol", options->protocol, "Protocol: a file, or xia-2011 or fit-2016")
      ->required();
  command
      ->add_option("--simulated", options->participants,
                   "Number of simulated participants; default: as planned in the protocol")
      ->expected(0, 1)
      ->check(CLI::Range(1, 999));
  command->add_option("--seed", options->seed, "Seed of orders, skills, sizes and trials")
      ->capture_default_str();
  command->add_option("-o,--output", options->folder,
                      "Folder of the study; default: the protocol's id");
  const Choices<study::KeptRecords> records{{"none", study::KeptRecords::kNone},
                                            {"last", study::KeptRecords::kLast},
                                            {"all", study::KeptRecords::kAll}};
  AddChoice(command, "--records", &options->records, records,
            "Sessions to record: none, last (repetition of each condition) or all; about 12 MB for "
            "each minute")
      ->default_str("last");
  command
      ->add_option("--threads", options->threads,
                   "Participants to simulate at a time; 0: one for each core")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  AddJsonFlag(command, &options->is_json, "study_summary");
  AddLoadOptions(command, &options->load, Limited::kOpening);
  command->footer(
      "To run a study with people, use the studio: `hvas studio --study PROTOCOL --participant "
      "P01`.\n"
      "A study that was interrupted is resumed by running it again. Equal seeds give equal "
      "results.\n"
      "Examples:\n"
      "  hvas study run xia-2011 --simulated 10\n"
      "  hvas study run fit-2016 --simulated 15 --seed 1 -o fits\n"
      "  hvas study run mine.yaml --simulated 4 --json | jq '.conditions[]'");
  command->callback([options, status] {
    const Result<void> done = RunSimulated(*options);
    *status = done ? 0 : ReportFailure(done.error());
  });
}

/** After how many participants the orders of a block are balanced; 1 where they are not varied. */
std::size_t CountRows(const study::Block& block) {
  const bool is_square =
      block.order == study::Order::kLatinSquare || block.order == study::Order::kBalanced;
  return is_square
             ? study::MakeSquare(block.conditions.size(), block.order == study::Order::kBalanced)
                   .size()
             : 1;
}

void PrintCheck(const Protocol& protocol) {
  std::string text = fmt::format("{}: {}\n{} conditions, {} trials each of {} participants\n",
                                 protocol.id, protocol.title.en, protocol.conditions.size(),
                                 protocol.CountTrials(), protocol.participants);
  for (const study::Block& block : protocol.blocks) {
    const std::size_t rows = CountRows(block);
    text +=
        fmt::format("  block {}: {} conditions x {}, order {}", block.id, block.conditions.size(),
                    block.repetitions, study::kOrders[static_cast<std::size_t>(block.order)]);
    if (rows > 1) {
      const bool is_whole = static_cast<std::size_t>(protocol.participants) % rows == 0;
      text += fmt::format(", balanced with every {} participants{}", rows,
                          is_whole ? "" : fmt::format(": {} are not", protocol.participants));
    }
    text += "\n";
  }
  fmt::print("{}", Fold(text));
}

void AddCheck(CLI::App* group, int* status) {
  CLI::App* command =
      group->add_subcommand("check", "Check a protocol; errors have line and column");
  const auto file = std::make_shared<std::string>();
  command->add_option("protocol", *file, "Protocol: a file, or the id of one that comes with HVAS")
      ->required();
  command->footer("Example:\n  hvas study check mine.yaml");
  command->callback([file, status] {
    const auto protocol = FindProtocol(*file);
    if (!protocol) {
      *status = ReportFailure(protocol.error());
      return;
    }
    if (const auto product = FindProductOf(*protocol); !product) {
      *status = ReportFailure(product.error());
      return;
    }
    PrintCheck(*protocol);
  });
}

/** A study's folder with all that is in it. */
struct Opened {
  StudyFolder folder;
  std::vector<Participant> participants;
};

Result<Opened> OpenAll(const std::filesystem::path& path) {
  auto folder = StudyFolder::Open(path);
  if (!folder) {
    return Unexpected(folder.error());
  }
  auto participants = folder->ReadParticipants();
  if (!participants) {
    return Unexpected(participants.error());
  }
  return Opened{std::move(*folder), std::move(*participants)};
}

void PrintList(const Opened& study) {
  TextTable table({"participant", "", "phase", "trials", "interruptions"}, 3);
  for (const Participant& p : study.participants) {
    table.Add({p.id, p.is_simulated ? "simulated" : "",
               std::string(study::ToString(p.session->phase())),
               fmt::format("{}/{}", p.session->done().size(), p.session->schedule().size()),
               fmt::format("{}", p.session->interruptions().size())});
  }
  fmt::print("{}", table.ToText());
}

void AddList(CLI::App* group, int* status) {
  CLI::App* command =
      group->add_subcommand("list", "List the participants of a study and their progress");
  const auto folder = std::make_shared<std::filesystem::path>();
  const auto is_json = std::make_shared<bool>(false);
  command->add_option("folder", *folder, "Folder of the study")->required();
  AddJsonFlag(command, is_json.get(), "study_summary");
  command->footer("Example:\n  hvas study list xia-2011");
  command->callback([folder, is_json, status] {
    const auto study = OpenAll(*folder);
    if (!study) {
      *status = ReportFailure(study.error());
    } else if (*is_json) {
      fmt::print("{}\n", MakeSummaryJson(study->folder, study->participants).dump(2));
    } else {
      PrintList(*study);
    }
  });
}

void AddExport(CLI::App* group, int* status) {
  CLI::App* command = group->add_subcommand(
      "export", "Export the results of a study as CSV, one row for each trial");
  const auto folder = std::make_shared<std::filesystem::path>();
  const auto output = std::make_shared<std::filesystem::path>();
  const auto has_answers = std::make_shared<bool>(false);
  command->add_option("folder", *folder, "Folder of the study")->required();
  command->add_option("-o,--output", *output, "File to write; default: standard output");
  command->add_flag("--answers", *has_answers,
                    "Export the answers to the questions instead of trials");
  command->footer(
      "Examples:\n"
      "  hvas study export xia-2011 -o trials.csv\n"
      "  hvas study export fit-2016 --answers");
  command->callback([folder, output, has_answers, status] {
    const auto study = OpenAll(*folder);
    if (!study) {
      *status = ReportFailure(study.error());
      return;
    }
    const std::string csv = *has_answers ? study::MakeAnswersCsv(study->participants)
                                         : study::MakeTrialsCsv(study->participants);
    if (output->empty()) {
      fmt::print("{}", csv);
    } else if (const auto written = WriteAtomically(*output, csv); !written) {
      *status = ReportFailure(written.error());
    }
  });
}

void AddDelete(CLI::App* group, int* status) {
  CLI::App* command =
      group->add_subcommand("delete", "Delete all data of a participant irrevocably");
  const auto folder = std::make_shared<std::filesystem::path>();
  const auto id = std::make_shared<std::string>();
  command->add_option("folder", *folder, "Folder of the study")->required();
  command->add_option("--participant", *id, "Id of the participant: P01, P02, ...")->required();
  command->footer(
      "Deletes the journal, the records, and the tables and reports in the folder, which contain "
      "data\n"
      "of the participant: write those again. Files that were written elsewhere are not found.\n"
      "Example:\n"
      "  hvas study delete fits --participant P03");
  command->callback([folder, id, status] {
    const auto study = StudyFolder::Open(*folder);
    if (!study) {
      *status = ReportFailure(study.error());
      return;
    }
    const auto removed = study->Delete(*id);
    if (!removed) {
      *status = ReportFailure(removed.error());
      return;
    }
    for (const std::filesystem::path& file : *removed) {
      fmt::print("removed {}\n", file.string());
    }
    fmt::print("All data of {} in {} were deleted.\n", *id, folder->string());
  });
}

void AddStudyReport(CLI::App* group, int* status) {
  CLI::App* command = group->add_subcommand(
      "report", "Write a report of a study: times, forces, answers, statistics");
  const auto folder = std::make_shared<std::filesystem::path>();
  const auto output = std::make_shared<std::filesystem::path>();
  const auto is_forced = std::make_shared<bool>(false);
  command->add_option("folder", *folder, "Folder of the study")->required();
  command->add_option("-o,--output", *output, "File to write: .html, or .pdf (printed by Chromium)")
      ->required();
  command->add_flag("--force", *is_forced, "Replace an existing file");
  command->footer(
      "The page is self-contained: it needs no network and no other file.\n"
      "Examples:\n"
      "  hvas study report fits -o fits.html\n"
      "  hvas study report fits -o fits.pdf --force");
  command->callback([folder, output, is_forced, status] {
    Result<void> done = CheckPageFile(*output, *is_forced);
    if (done) {
      const auto study = OpenAll(*folder);
      const Busy busy("writing the report");
      done = study ? WriteStudyPage(study->folder, study->participants, *output)
                   : Result<void>(Unexpected(study.error()));
    }
    *status = done ? 0 : ReportFailure(done.error());
  });
}

}  // namespace

void AddStudyRun(CLI::App* group, int* status) {
  AddCheck(group, status);
  AddRun(group, status);
  AddList(group, status);
  AddExport(group, status);
  AddStudyReport(group, status);
  AddDelete(group, status);
}

}  // namespace hvas::app
