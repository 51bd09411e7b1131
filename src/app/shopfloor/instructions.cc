#include "app/shopfloor/instructions.h"

#include <map>
#include <memory>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/assembly/planned_model.h"
#include "app/assembly/run_report.h"
#include "app/output/choice.h"
#include "app/output/json_flag.h"
#include "app/output/new_file.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/recording/page_file.h"
#include "base/atomic_file.h"
#include "base/crash_note.h"
#include "base/regular_file.h"
#include "evidence/summary.h"
#include "shopfloor/instruction_page.h"
#include "shopfloor/most_sequence.h"
#include "shopfloor/viewer_element.h"
#include "shopfloor/work_animation.h"
#include "studio/assets.h"

namespace hvas::app {
namespace {

constexpr int kNotAllPlanned = 2;                 // The exit status where a part is left out.
constexpr std::size_t kLargestHead = 10'000'000;  // Bytes of a head with pictures in it: a choice.

struct InstructionsCommand : PlanCommandOptions {
  shopfloor::Language language{shopfloor::Language::kEnglish};
  std::filesystem::path head;    ///< HTML of the company's head; empty: none.
  std::filesystem::path record;  ///< Its times stand beside those of the plan; empty: none.
};

bool IsAnimation(const InstructionsCommand& options) {
  return options.output.extension() == ".glb";
}

Result<void> CheckOutput(const InstructionsCommand& options) {
  const std::filesystem::path ending = options.output.extension();
  if (ending == ".stp" || ending == ".step") {
    return Fail(ErrorCode::kUnsupported,
                "the order of assembly cannot be written as STEP: the reader and writer that HVAS "
                "uses has no process plans of AP242",
                options.output.string(), "use the extension .html, .pdf or .glb");
  }
  if (ending != ".html" && ending != ".pdf" && ending != ".glb") {
    return Fail(ErrorCode::kInvalid,
                "the file name has no extension of a format that can be written",
                options.output.string(), "use the extension .html, .pdf or .glb");
  }
  return CheckNewFile(options.output, options.is_replaced);
}

/** Reads how long each part was in a hand in a record of the product.
 Errors: the reader's; kInvalid for a record of another product. */
Result<std::map<product::OccurrenceId, double>> ReadTimes(const std::filesystem::path& file,
                                                          const product::Product& product) {
  auto reader = record::Reader::Open(file);
  if (!reader) {
    return Unexpected(reader.error());
  }
  const auto summary = evidence::Summarise(&*reader);
  if (!summary) {
    return Unexpected(summary.error());
  }
  bool is_same = summary->paths.size() >= product.occurrences.size();
  for (std::size_t k = 0; is_same && k < product.occurrences.size(); ++k) {
    is_same = summary->paths[k] == product.occurrences[k].path;
  }
  if (!is_same) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("the record is of a product with other parts than {}", product.source),
                file.string(), "record it with hvas assemble FILE --record run.hvasrec");
  }
  std::map<product::OccurrenceId, double> times;
  for (const evidence::Hold& hold : summary->holds) {
    if (hold.occurrence < product.occurrences.size()) {
      times[product::OccurrenceId(hold.occurrence)] +=
          1e-9 * static_cast<double>(hold.end_ns - hold.start_ns);
    }
  }
  return times;
}

Result<std::string> MakePage(const InstructionsCommand& options, const simulation::Model& model,
                             const shopfloor::WorkPlan& plan, const std::stop_token& stop) {
  shopfloor::InstructionOptions page;
  page.language = options.language;
  page.stop = stop;
  if (!options.head.empty()) {
    auto head = ReadRegularFile(options.head, kLargestHead);
    if (!head) {
      return Unexpected(head.error());
    }
    page.head = std::move(*head);
  }
  if (!options.record.empty()) {
    auto times = ReadTimes(options.record, *model.product);
    if (!times) {
      return Unexpected(times.error());
    }
    page.record = options.record.filename().string();
    page.recorded_s = std::move(*times);
  }
  const studio::Asset* viewer = studio::FindAsset("/instructions/viewer.js");
  if (viewer != nullptr && options.output.extension() == ".html") {
    const auto animation = shopfloor::MakeWorkAnimation(model, plan);
    if (!animation) {
      return Unexpected(animation.error());
    }
    page.viewer =
        shopfloor::MakeViewerElement(model, plan, *animation, viewer->plain, options.language);
  }
  NoteStage("pictures");
  if (IsShown(options)) {
    page.progress = [](double fraction) { ShowProgress("pictures", fraction); };
  }
  return shopfloor::MakeInstructionPage(model, plan, page);
}

Result<void> Write(const InstructionsCommand& options, const simulation::Model& model,
                   const shopfloor::WorkPlan& plan, const std::stop_token& stop) {
  const auto content = IsAnimation(options) ? shopfloor::MakeWorkAnimation(model, plan)
                                            : MakePage(options, model, plan, stop);
  if (!content) {
    return Unexpected(content.error());
  }
  return IsAnimation(options) ? WriteAtomically(options.output, *content)
                              : WritePage(options.output, *content);
}

nlohmann::ordered_json MakeJson(const InstructionsCommand& options, const simulation::Model& model,
                                const shopfloor::WorkPlan& plan) {
  nlohmann::ordered_json json{{"product", model.product->name},
                              {"source", model.product->source},
                              {"output", options.output.string()},
                              {"steps", nlohmann::ordered_json::array()},
                              {"hand_time_s", orders::kModSeconds * plan.mods},
                              {"left_out", plan.left_out.size()}};
  for (const shopfloor::WorkStep& step : plan.steps) {
    nlohmann::ordered_json one{
        {"parts", nlohmann::ordered_json::array()},
        {"hand_time_s", orders::kModSeconds * step.mods},
        {"most_s", shopfloor::SumSeconds(shopfloor::ListMostSequences(step.motions))}};
    for (const product::OccurrenceId id : step.leading) {
      one["parts"].push_back(PathOf(model, id));
    }
    if (!step.tool.empty()) {
      one["tool"] = step.tool;
    }
    one["motions"] = nlohmann::ordered_json::array();
    for (const orders::HandMotion& motion : step.motions) {
      one["motions"].push_back(
          {{"code", motion.code},
           {"mod", motion.mods},
           {"for", shopfloor::DescribeMotion(motion, shopfloor::Language::kEnglish)}});
    }
    one["most"] = nlohmann::ordered_json::array();
    for (const shopfloor::MostSequence& sequence : shopfloor::ListMostSequences(step.motions)) {
      one["most"].push_back({{"code", sequence.code}, {"time_s", sequence.seconds}});
    }
    json["steps"].push_back(std::move(one));
  }
  return json;
}

int RunInstructions(const InstructionsCommand& options) {
  const EndWatch end;
  if (const auto checked = CheckOutput(options); !checked) {
    return ReportFailure(checked.error());
  }
  const auto planned = PlanModel(options, end);
  if (!planned) {
    return planned.error();
  }
  const shopfloor::WorkPlan plan = shopfloor::MakeWorkPlan(*planned->model, planned->plan);
  if (const auto written = Write(options, *planned->model, plan, end.stop()); !written) {
    return ReportFailure(written.error());
  }
  if (options.is_json) {
    PrintJson(MakeJson(options, *planned->model, plan));
  } else {
    fmt::print("{}: {} steps, about {:.0f} s of the hands by MODAPTS{}\n", options.output.string(),
               plan.steps.size(), orders::kModSeconds * plan.mods,
               plan.left_out.empty()
                   ? ""
                   : fmt::format(", {} parts without a way in", plan.left_out.size()));
  }
  return plan.left_out.empty() ? 0 : kNotAllPlanned;
}

}  // namespace

void AddInstructions(CLI::App* app, int* status) {
  CLI::App* command =
      app->add_subcommand("instructions", "Write work instructions with a picture of each step");
  const auto options = std::make_shared<InstructionsCommand>();
  command->add_option("file", options->load.file, "STEP, IGES or mesh file, or a folder of meshes")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "File to write: .html, .pdf, or .glb for an animation")
      ->required();
  command->add_flag("--force", options->is_replaced, "Replace an existing file");
  AddChoice(command, "--language", &options->language,
            Choices<shopfloor::Language>{{"en", shopfloor::Language::kEnglish},
                                         {"de", shopfloor::Language::kGerman}},
            "Language of the instructions: en (default) or de");
  command->add_option("--head", options->head,
                      "File with HTML that is put above the title: the company's head");
  command->add_option("--record", options->record,
                      "A record of the product: the times of its parts stand beside the plan's");
  command->add_option("--plan", options->order.plan,
                      "A plan that hvas plan has written with -o: its order is followed");
  AddOrderChoice(command, &options->order);
  AddOrderOptions(command, options.get());
  AddJsonFlag(command, &options->is_json, "instructions or preparation");
  AddAccessoryOptions(command, &options->load);
  AddLoadOptions(command, &options->load);
  command->footer(
      "Exit status: 0 when the instructions have every part, 2 when one is left out, 1 on an "
      "error.\n"
      "Examples:\n"
      "  hvas instructions products/gear_pump.step -o pump.html\n"
      "  hvas instructions products/gear_pump.step -o pumpe.pdf --language de --head head.html\n"
      "  hvas instructions products/gear_pump.step -o pump.glb\n"
      "  hvas instructions pump.step --plan plan.json -o pump.html --record run.hvasrec");
  command->callback([options, status] { *status = RunInstructions(*options); });
}

}  // namespace hvas::app
