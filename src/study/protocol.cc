#include "study/protocol.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/digest.h"
#include "base/regular_file.h"
#include "base/units.h"
#include "fits/iso286.h"
#include "yaml/yaml_fields.h"

namespace hvas::study {
namespace {

using yaml::Bounds;
using yaml::ListOf;
using yaml::NumbersOf;
using yaml::YamlDocument;
using yaml::YamlFields;

constexpr std::size_t kMaxConditions = 26;           // Letters of the alphabet, which name them.
constexpr std::size_t kLargestProtocol = 1'000'000;  // [bytes]: a thousand pages. A choice.
constexpr int kMaxTrials = 5000;                     // for one participant
constexpr double kMaxSeconds = 86400;                // A day.
constexpr std::array<std::string_view, 2> kForceMaps{"published", "paper"};
constexpr std::array<std::string_view, 3> kPairs{"one_pair", "of_kind", "any"};  // fits::PairChoice
constexpr double kMaxDiameter_mm = 100'000;                                      // as in side files
constexpr Bounds kDiameters_mm{0.001, kMaxDiameter_mm};                          // [mm]
constexpr std::array<std::string_view, 3> kHidden{"condition", "time", "progress"};

/** Whether a text is a valid id: ids become names of files and columns. */
bool IsId(std::string_view text) {
  return !text.empty() && text.size() <= 40 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '_' || c == '-';
         });
}

/** Reads a document into a protocol. */
class ProtocolReader {
 public:
  ProtocolReader(YamlDocument* document, Protocol* protocol)
      : document_(document), protocol_(protocol) {}

  void Read() {
    YamlFields fields(document_, document_->root(), "the protocol");
    if (fields.Text("format") != kProtocolFormat) {
      document_->Refuse(fields.Get("format"), "the format of the protocol is not known",
                        fmt::format("write `format: {}`", kProtocolFormat));
    }
    protocol_->id = ReadId(&fields);
    protocol_->languages = ReadLanguages(&fields);
    protocol_->title = ReadText(&fields, "title", true);
    protocol_->about = fields.TextOr("about", "");
    protocol_->source = fields.TextOr("source", "");
    protocol_->product = fields.Text("product");
    protocol_->part = fields.Text("part");
    protocol_->participants = fields.IntegerOr("participants", {1, 999}, 1);
    protocol_->mating_window =
        fields.NumberOr("mating_window_s", {0, 30}, protocol_->mating_window);
    protocol_->consent = ReadText(&fields, "consent", true);
    ReadConditions(&fields);
    ReadTraining(&fields);
    ReadBlocks(&fields);
    ReadQuestions(&fields);
    ReadHidden(&fields);
    ReadDisplay(&fields);
    fields.Finish();
    CheckTrials(fields);
  }

 private:
  std::string ReadId(YamlFields* fields) {
    std::string id = fields->Text("id");
    if (!id.empty() && !IsId(id)) {
      document_->Refuse(fields->Get("id"),
                        fmt::format("the id \"{}\" of {} is not valid", id, fields->entity()),
                        "use at most 40 letters, digits, - and _");
    }
    return id;
  }

  void RefuseIfTaken(const YamlFields& fields, const std::string& id, std::set<std::string>* ids) {
    if (!id.empty() && !ids->insert(id).second) {
      document_->Refuse(fields.node(), fmt::format("the id \"{}\" occurs twice", id),
                        "give each an id of its own");
    }
  }

  std::vector<std::string> ReadLanguages(YamlFields* fields) {
    std::vector<std::string> languages = fields->TextsOr("languages", {"en"});
    for (const std::string& language : languages) {
      if (language != "en" && language != "de") {
        document_->Refuse(fields->Get("languages"),
                          fmt::format("the language \"{}\" is not known", language),
                          "write [en] or [en, de]");
      }
    }
    return languages;
  }

  LocalText ReadText(YamlFields* fields, const std::string& key, bool is_required) {
    const YAML::Node value = is_required ? fields->Require(key) : fields->Get(key);
    LocalText text;
    if (!value.IsDefined()) {
      return text;
    }
    if (value.IsScalar()) {
      text.en = fields->Text(key);
      return text;
    }
    YamlFields languages(document_, value, fmt::format("\"{}\" of {}", key, fields->entity()));
    text.en = languages.Text("en");
    text.de = languages.TextOr("de", "");
    languages.Finish();
    return text;
  }

  void ReadConditions(YamlFields* fields) {
    const YAML::Node list = fields->Require("conditions");
    if (!list.IsDefined()) {
      return;
    }
    std::set<std::string> ids;
    Condition common;
    if (const YAML::Node defaults = fields->Get("defaults"); defaults.IsDefined()) {
      YamlFields these(document_, defaults, "the defaults");
      ReadRendering(&these, &common);
      these.Finish();
    }
    for (const YAML::Node& node : ListOf(document_, list, "\"conditions\"")) {
      YamlFields one(document_, node,
                     fmt::format("condition {}", protocol_->conditions.size() + 1));
      Condition condition = common;
      condition.id = ReadId(&one);
      RefuseIfTaken(one, condition.id, &ids);
      condition.name = ReadText(&one, "name", true);
      condition.instruction = ReadText(&one, "instruction", false);
      static_cast<void>(one.Require("method"));
      condition.method = one.WordOr("method", kMethods, condition.method);
      ReadConstraints(&one, &condition);
      ReadRendering(&one, &condition);
      condition.part = one.TextOr("part", "");
      condition.answer = one.TextOr("answer", "");
      if (one.Has("published_mean_s")) {
        condition.published_mean = one.NumberOr("published_mean_s", {0.01, kMaxSeconds}, 1);
      }
      if (one.Has("published_right_share")) {
        condition.published_right_share = one.NumberOr("published_right_share", {0, 1}, 1);
      }
      one.Finish();
      protocol_->conditions.push_back(std::move(condition));
    }
    if (protocol_->conditions.empty() || protocol_->conditions.size() > kMaxConditions) {
      document_->Refuse(list, "\"conditions\" is empty, or has more than 26",
                        "write 1 to 26 conditions");
    }
  }

  void ReadConstraints(YamlFields* fields, Condition* condition) {
    condition->constraints = fields->WordOr("constraints", kConstraints, condition->constraints);
    const bool has_hand_and_mates =
        condition->method == Method::kConstraint || condition->method == Method::kHybrid;
    if (condition->constraints == Constraints::kPicked && !has_hand_and_mates) {
      document_->Refuse(
          fields->Get("constraints"),
          fmt::format("\"constraints: picked\" of {} needs a hand and mates", fields->entity()),
          "use it with the method constraint_only or hybrid");
    }
  }

  /** k_r and k_s of paper W. */
  void ReadPaperFactors(YamlFields* fields, haptics::PaperFactors* factors) {
    const YAML::Node node = fields->Get("paper_factors");
    if (!node.IsDefined()) {
      return;
    }
    YamlFields these(document_, node, fmt::format("the paper's factors of {}", fields->entity()));
    factors->interference = these.NumberOr("k_r", {0, 1}, factors->interference);
    factors->transition = these.NumberOr("k_s", {0, 1}, factors->transition);
    these.Finish();
  }

  /** K1 to K3 of paper X. */
  void ReadGuidance(YamlFields* fields, haptics::PaperGuidance* guidance) {
    const YAML::Node node = fields->Get("guidance");
    if (!node.IsDefined()) {
      return;
    }
    YamlFields these(document_, node, fmt::format("the guidance of {}", fields->entity()));
    const auto read = [&these](const char* key, Bounds bounds, std::optional<double>* value) {
      if (these.Has(key)) {
        *value = these.NumberOr(key, bounds, bounds.low);
      }
    };
    read("k1", {0, haptics::kLargestK1}, &guidance->k1);
    read("k2_n_per_m", {haptics::kSmallestK2, haptics::kLargestK2}, &guidance->k2);
    read("k3", {0, haptics::kLargestK3}, &guidance->k3);
    guidance->attracts_in_fits = these.FlagOr("in_fits", guidance->attracts_in_fits);
    guidance->contact_in_holes = these.FlagOr("contact_in_holes", guidance->contact_in_holes);
    guidance->threads_turn = these.FlagOr("threads_turn", guidance->threads_turn);
    these.Finish();
  }

  /** What is measured or known of the parts. */
  void ReadSizes(YamlFields* fields, product::FitConditions* sizes) {
    if (fields->Has("friction")) {
      sizes->friction = fields->NumberOr("friction", {0, 2}, 0);
    }
    const YAML::Node node = fields->Get("sizes");
    if (!node.IsDefined()) {
      return;
    }
    YamlFields these(document_, node, fmt::format("the sizes of {}", fields->entity()));
    ReadDiameters(&these, "hole_diameter_mm", &sizes->hole_diameters);
    ReadDiameters(&these, "shaft_diameter_mm", &sizes->shaft_diameters);
    if (these.Has("hole_rz_um")) {
      sizes->hole_roughness = units::FromUm(these.NumberOr("hole_rz_um", {0, 1000}, 0));
    }
    if (these.Has("shaft_rz_um")) {
      sizes->shaft_roughness = units::FromUm(these.NumberOr("shaft_rz_um", {0, 1000}, 0));
    }
    these.Finish();
  }

  /** One diameter, or places [depth_mm, diameter_mm] by ascending depth (paper W, 2.1). */
  void ReadDiameters(YamlFields* fields, const std::string& key,
                     std::vector<product::MeasuredDiameter>* diameters) {
    if (!fields->Has(key)) {
      return;
    }
    const YAML::Node node = fields->Get(key);
    diameters->clear();
    if (node.IsScalar()) {
      diameters->push_back(
          {0, units::FromMm(fields->NumberOr(key, kDiameters_mm, kMaxDiameter_mm))});
      return;
    }
    const std::string entity = fmt::format("\"{}\" of {}", key, fields->entity());
    for (const YAML::Node& place : ListOf(document_, node, entity)) {
      const auto numbers = NumbersOf(place);
      const double last = diameters->empty() ? -1 : units::ToMm(diameters->back().depth);
      if (numbers.size() != 2 || !(numbers[0] >= 0 && numbers[0] > last) ||
          !(numbers[1] >= kDiameters_mm.low && numbers[1] <= kDiameters_mm.high)) {
        document_->Refuse(place, entity + " has a place that is not valid",
                          "write a diameter in mm, or places [depth_mm, diameter_mm] by ascending "
                          "depth: [[0, 40.004], [50, 40.007]]");
        return;
      }
      diameters->push_back({units::FromMm(numbers[0]), units::FromMm(numbers[1])});
    }
    if (diameters->empty()) {
      document_->Refuse(node, entity + " has no place", "write at least one place");
    }
  }

  /** What the defaults may have, too. */
  void ReadRendering(YamlFields* fields, Condition* condition) {
    condition->fit = fields->TextOr("fit", condition->fit);
    if (!condition->fit.empty() && !fits::ParseFit(condition->fit)) {
      document_->Refuse(fields->Get("fit"),
                        fmt::format("\"{}\" of {} is not a fit", condition->fit, fields->entity()),
                        "write a fit of ISO 286, for example H7/g6");
    }
    condition->pairs = fields->WordOr("pairs", kPairs, condition->pairs);
    ReadSizes(fields, &condition->sizes);
    condition->renders_fits = fields->FlagOr("fit_force", condition->renders_fits);
    condition->force_map = fields->WordOr("force_map", kForceMaps, condition->force_map);
    ReadPaperFactors(fields, &condition->paper_factors);
    ReadGuidance(fields, &condition->guidance);
    condition->coupling = fields->NumberOr("coupling_n_per_m", {50, 5000}, condition->coupling);
    condition->time_limit = fields->NumberOr("time_limit_s", {1, 3600}, condition->time_limit);
    if (const YAML::Node node = fields->Get("capture"); node.IsDefined()) {
      YamlFields capture(document_, node, fmt::format("the capture of {}", fields->entity()));
      mates::CaptureThresholds& limits = condition->capture;
      limits.angle =
          units::FromDeg(capture.NumberOr("angle_deg", {0.1, 90}, units::ToDeg(limits.angle)));
      limits.axis_distance = units::FromMm(
          capture.NumberOr("axis_distance_mm", {0.01, 100}, units::ToMm(limits.axis_distance)));
      limits.face_distance = units::FromMm(
          capture.NumberOr("face_distance_mm", {0.01, 100}, units::ToMm(limits.face_distance)));
      capture.Finish();
    }
  }

  /** @returns no index where there is no such condition. */
  std::optional<std::size_t> FindIndex(const YAML::Node& at, const std::string& id,
                                       const std::string& entity) {
    const auto& all = protocol_->conditions;
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Condition& c) { return c.id == id; });
    if (found == all.end()) {
      document_->Refuse(at, fmt::format("{} refers to an unknown condition: \"{}\"", entity, id),
                        "use the id of one of \"conditions\"");
      return std::nullopt;
    }
    return static_cast<std::size_t>(found - all.begin());
  }

  void ReadDisplay(YamlFields* fields) {
    const YAML::Node node = fields->Get("display");
    if (!node.IsDefined()) {
      return;
    }
    YamlFields display(document_, node, "\"display\"");
    protocol_->display.has_end_sound = display.FlagOr("end_sound", true);
    protocol_->display.stereo = display.WordOr("stereo", kStereos, Stereo::kNone);
    display.Finish();
  }

  void ReadTraining(YamlFields* fields) {
    const YAML::Node node = fields->Get("training");
    if (!node.IsDefined()) {
      return;
    }
    YamlFields training(document_, node, "the training");
    protocol_->training.duration =
        60 * training.NumberOr("minutes", {0, 600}, protocol_->training.duration);
    protocol_->training.text = ReadText(&training, "text", false);
    if (training.Has("condition")) {
      protocol_->training.condition =
          FindIndex(training.Get("condition"), training.Text("condition"), "the training");
    }
    training.Finish();
  }

  void ReadBlocks(YamlFields* fields) {
    const YAML::Node list = fields->Require("blocks");
    if (!list.IsDefined()) {
      return;
    }
    std::set<std::string> ids;
    for (const YAML::Node& node : ListOf(document_, list, "\"blocks\"")) {
      YamlFields one(document_, node, fmt::format("block {}", protocol_->blocks.size() + 1));
      Block block;
      block.id = ReadId(&one);
      RefuseIfTaken(one, block.id, &ids);
      block.name = ReadText(&one, "name", false);
      block.is_identification = one.FlagOr("identification", false);
      block.repetitions = one.IntegerOr("repetitions", {1, 1000}, 1);
      block.order =
          one.WordOr("order", kOrders, block.is_identification ? Order::kRandom : block.order);
      block.keeps_repetitions_together = one.FlagOr("together", !block.is_identification);
      block.tells_condition = one.FlagOr("tells_condition", false);
      block.question = ReadText(&one, "question", block.is_identification);
      ReadConditionsOf(&one, &block);
      one.Finish();
      if (block.is_identification) {
        CheckIdentification(one, block);
      }
      protocol_->blocks.push_back(std::move(block));
    }
    if (protocol_->blocks.empty()) {
      document_->Refuse(list, "\"blocks\" is empty", "write at least one");
    }
  }

  void ReadConditionsOf(YamlFields* fields, Block* block) {
    std::vector<std::string> all;
    for (const Condition& condition : protocol_->conditions) {
      all.push_back(condition.id);
    }
    const std::vector<std::string> names = fields->TextsOr("conditions", all);
    const YAML::Node at = fields->Has("conditions") ? fields->Get("conditions") : fields->node();
    for (const std::string& name : names) {
      const auto index = FindIndex(at, name, fields->entity());
      if (index && std::count(block->conditions.begin(), block->conditions.end(), *index) > 0) {
        document_->Refuse(at, fmt::format("{} has \"{}\" twice", fields->entity(), name),
                          "list each condition once, and set \"repetitions\"");
      }
      if (index) {
        block->conditions.push_back(*index);
      }
    }
    if (block->conditions.empty()) {
      document_->Refuse(at, fmt::format("{} has no condition", fields->entity()),
                        "list at least one");
    }
  }

  void CheckIdentification(const YamlFields& fields, const Block& block) {
    if (block.tells_condition) {
      document_->Refuse(fields.node(),
                        fmt::format("{} is blind and tells the condition", fields.entity()),
                        "omit \"tells_condition\"");
    }
    std::set<std::string> answers;
    for (const std::size_t index : block.conditions) {
      const Condition& condition = protocol_->conditions[index];
      const std::string answer = condition.answer.empty() ? condition.fit : condition.answer;
      if (answer.empty() || !answers.insert(answer).second) {
        document_->Refuse(
            fields.node(),
            fmt::format(
                "in {} the answer of condition \"{}\" is missing, or another condition has it, too",
                fields.entity(), condition.id),
            "give the conditions different fits, or each an \"answer\" of its own");
      }
    }
    if (block.order != Order::kRandom || block.keeps_repetitions_together) {
      document_->Refuse(
          fields.node(),
          fmt::format("{} is identification, so its trials are shuffled", fields.entity()),
          "omit \"order\" and \"together\"");
    }
  }

  void ReadQuestions(YamlFields* fields) {
    const YAML::Node list = fields->Get("questions");
    if (!list.IsDefined()) {
      return;
    }
    std::set<std::string> ids;
    for (const YAML::Node& node : ListOf(document_, list, "\"questions\"")) {
      YamlFields one(document_, node, fmt::format("question {}", protocol_->questions.size() + 1));
      Question question;
      question.id = ReadId(&one);
      RefuseIfTaken(one, question.id, &ids);
      static_cast<void>(one.Require("kind"));
      question.kind = one.WordOr("kind", kQuestionKinds, question.kind);
      question.asked = one.WordOr("asked", kAsked, question.asked);
      question.block = one.TextOr("block", "");
      question.text = ReadText(&one, "text", true);
      ReadKind(&one, &question);
      one.Finish();
      const auto is_block = [&](const Block& block) { return block.id == question.block; };
      if (!question.block.empty() &&
          std::none_of(protocol_->blocks.begin(), protocol_->blocks.end(), is_block)) {
        document_->Refuse(
            one.node()["block"],
            fmt::format("{} refers to an unknown block: \"{}\"", one.entity(), question.block),
            "use the id of one of \"blocks\"");
      }
      protocol_->questions.push_back(std::move(question));
    }
  }

  void ReadKind(YamlFields* fields, Question* question) {
    switch (question->kind) {
      case QuestionKind::kScale:
        question->low = fields->IntegerOr("low", {0, 100}, question->low);
        question->high = fields->IntegerOr("high", {1, 100}, question->high);
        question->low_text = ReadText(fields, "low_text", false);
        question->high_text = ReadText(fields, "high_text", false);
        if (question->low >= question->high) {
          document_->Refuse(fields->node(),
                            fmt::format("the scale of {} goes from {} to {}", fields->entity(),
                                        question->low, question->high),
                            "let \"low\" be less than \"high\"");
        }
        return;
      case QuestionKind::kText:
        question->longest = fields->IntegerOr("longest", {1, 20000}, question->longest);
        return;
      case QuestionKind::kChoice:
        break;
    }
    const YAML::Node list = fields->Require("choices");
    if (!list.IsDefined()) {
      return;
    }
    std::set<std::string> ids;
    for (const YAML::Node& node : ListOf(document_, list, "\"choices\"")) {
      YamlFields one(document_, node, fmt::format("a choice of {}", fields->entity()));
      Choice choice;
      choice.id = ReadId(&one);
      RefuseIfTaken(one, choice.id, &ids);
      choice.text = ReadText(&one, "text", true);
      one.Finish();
      question->choices.push_back(std::move(choice));
    }
    if (question->choices.size() < 2) {
      document_->Refuse(list, fmt::format("{} has fewer than two choices", fields->entity()),
                        "write two or more");
    }
  }

  void ReadHidden(YamlFields* fields) {
    if (!fields->Has("hidden")) {
      return;
    }
    protocol_->hidden = {false, false, false};
    for (const std::string& name : fields->TextsOr("hidden", {})) {
      if (std::find(kHidden.begin(), kHidden.end(), name) == kHidden.end()) {
        document_->Refuse(
            fields->Get("hidden"), fmt::format("\"{}\" cannot be hidden or shown", name),
            fmt::format("write some of [{}]; fits are always hidden", fmt::join(kHidden, ", ")));
      }
      protocol_->hidden.condition |= name == "condition";
      protocol_->hidden.time |= name == "time";
      protocol_->hidden.progress |= name == "progress";
    }
    const bool is_blind = std::any_of(protocol_->blocks.begin(), protocol_->blocks.end(),
                                      [](const Block& block) { return block.is_identification; });
    if (is_blind && !protocol_->hidden.condition) {
      document_->Refuse(fields->Get("hidden"),
                        "identification would not be blind: names of conditions are shown",
                        "add condition to \"hidden\"");
    }
  }

  void CheckTrials(const YamlFields& fields) {
    if (protocol_->CountTrials() > kMaxTrials) {
      document_->Refuse(fields.node(),
                        fmt::format("a participant would have {} trials", protocol_->CountTrials()),
                        fmt::format("lower \"repetitions\": at most {} are possible", kMaxTrials));
    }
  }

  YamlDocument* document_;
  Protocol* protocol_;
};

}  // namespace

const Condition* Protocol::FindCondition(std::string_view condition_id) const {
  const auto found = std::find_if(conditions.begin(), conditions.end(),
                                  [&](const Condition& c) { return c.id == condition_id; });
  return found == conditions.end() ? nullptr : &*found;
}

int Protocol::CountTrials() const {
  int count = 0;
  for (const Block& block : blocks) {
    count += static_cast<int>(block.conditions.size()) * block.repetitions;
  }
  return count;
}

Result<Protocol> ParseProtocol(const std::string& text, const std::filesystem::path& file) {
  auto document = YamlDocument::Parse(text, file.string());
  if (!document) {
    return Unexpected(document.error());
  }
  Protocol protocol;
  ProtocolReader(&*document, &protocol).Read();
  if (document->error()) {
    return Unexpected(*document->error());
  }
  protocol.file = file;
  protocol.text = text;
  Digest digest;
  digest.AddText(text);
  protocol.digest = digest.Hex();
  return protocol;
}

Result<Protocol> ReadProtocol(const std::filesystem::path& file) {
  const Result<std::string> text = ReadRegularFile(file, kLargestProtocol);
  return text ? ParseProtocol(*text, file) : Unexpected(text.error());
}

}  // namespace hvas::study
