#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "haptics/options.h"
#include "mates/capture.h"

/** What a study is (N9): conditions, trials and their order, questions, consent. Read from YAML or
 JSON; the language is in docs/studies.md and data/schemas/study.schema.json. */
namespace hvas::study {

inline constexpr std::string_view kProtocolFormat = "hvas-study-1";

/** In the languages of a study; English where one is not given. */
struct LocalText {
  std::string en;
  std::string de;

  [[nodiscard]] const std::string& In(std::string_view language) const {
    return language == "de" && !de.empty() ? de : en;
  }

  [[nodiscard]] bool empty() const { return en.empty(); }
};

/** How a part comes to its place. */
enum class Method : std::uint8_t {
  kPicking,     ///< Constraints are set between surfaces with the mouse; no physics (W8: A1).
  kCollision,   ///< Contact alone (X14, W8: A2).
  kConstraint,  ///< Mates alone: parts can interpenetrate (X14).
  kHybrid,      ///< Both (X14, W8: A3, B1 to B3).
};

inline constexpr std::array<std::string_view, 4> kMethods{
    "constraints_by_picking", "collision_only", "constraint_only", "hybrid"};

[[nodiscard]] constexpr std::string_view ToString(Method method) {
  return kMethods[static_cast<std::size_t>(method)];
}

struct Condition {
  std::string id;
  LocalText name;         ///< For the experimenter and the report.
  LocalText instruction;  ///< All that the participant is told of it.
  Method method{Method::kHybrid};
  std::string fit;          ///< Of the part, ISO 286; empty: as the product has it.
  bool renders_fits{true};  ///< The fit resists (W5).
  std::string answer;       ///< Its name in identification; empty: the fit.
  mates::CaptureThresholds capture;
  haptics::ForceMapKind force_map{haptics::ForceMapKind::kPublished};
  double coupling{1000};   ///< Stiffness that contact and constraint are felt with at most [N/m].
  double time_limit{120};  ///< Of a trial [s].
  std::optional<double> published_mean;         ///< Of the paper's people [s].
  std::optional<double> published_right_share;  ///< In identification, of theirs.
};

/** How the order of conditions is varied between participants. */
enum class Order : std::uint8_t {
  kGiven,        ///< As written.
  kLatinSquare,  ///< Each condition in each place equally often.
  kBalanced,     ///< Besides, each follows each equally often (Williams, Aust. J. Sci. Res. A 2,
                 ///< 1949).
  kRandom,       ///< Drawn, from the study's seed.
};

inline constexpr std::array<std::string_view, 4> kOrders{"given", "latin_square", "balanced",
                                                         "random"};

/** Trials that belong together. */
struct Block {
  std::string id;
  LocalText name;
  std::vector<std::size_t> conditions;  ///< Indices into Protocol::conditions.
  int repetitions{1};                   ///< Of each condition.
  Order order{Order::kBalanced};
  /** All repetitions of a condition one after the other; else one of each condition at a time. */
  bool keeps_repetitions_together{true};
  /** Blind identification (W12): all trials shuffled, and after each the participant says which
   condition it was. */
  bool is_identification{false};
  LocalText question;  ///< Of identification.
};

enum class QuestionKind : std::uint8_t { kScale, kChoice, kText };

inline constexpr std::array<std::string_view, 3> kQuestionKinds{"scale", "choice", "text"};

enum class Asked : std::uint8_t { kAfterTrial, kAfterCondition, kAfterBlock, kAtEnd };

inline constexpr std::array<std::string_view, 4> kAsked{"after_trial", "after_condition",
                                                        "after_block", "at_end"};

struct Choice {
  std::string id;
  LocalText text;
};

struct Question {
  std::string id;
  QuestionKind kind{QuestionKind::kScale};
  Asked asked{Asked::kAtEnd};
  std::string block;  ///< Where it is asked after trials, conditions or a block; empty: any.
  LocalText text;
  int low{1};  ///< Of a scale, in whole numbers.
  int high{10};
  LocalText low_text, high_text;  ///< Anchors of a scale.
  std::vector<Choice> choices;
  int longest{2000};  ///< Of a text, in characters.
};

struct Training {
  double duration{0};  ///< [s]; 0: none.
  LocalText text;
  std::optional<std::size_t> condition;  ///< That is trained with; the first where none is said.
};

/** What the participant is not shown. Names of fits never reach a participant's client. */
struct Hidden {
  bool condition{true};  ///< Its name.
  bool time{true};       ///< While it runs.
  bool progress{false};  ///< How many trials there are.
};

struct Protocol {
  std::string id;
  LocalText title;
  std::string about;
  std::string source;   ///< Of what is published with the conditions: a paper.
  std::string product;  ///< A file beside the protocol, or the name of an example.
  std::string part;     ///< That is put in its place; what comes before it is there already.
  int participants{1};  ///< As planned.
  std::vector<std::string> languages{"en"};
  LocalText consent;
  Training training;
  std::vector<Condition> conditions;
  std::vector<Block> blocks;
  std::vector<Question> questions;
  Hidden hidden;
  double mating_window{3};  ///< At the end of a trial, of which forces are kept [s] (X15).

  std::filesystem::path file;
  std::string text;    ///< As it was read.
  std::string digest;  ///< Of the text.

  [[nodiscard]] const Condition* FindCondition(std::string_view condition_id) const;
  /** How many trials a participant has. */
  [[nodiscard]] int CountTrials() const;
};

/** Reads a protocol. Errors: kNotFound for no file; kUnreadable and kInvalid with
 "FILE:LINE:COLUMN", what it is about, and a remedy: keys that are not known or there twice, values
 of another type or out of their range, names that nothing has. */
[[nodiscard]] Result<Protocol> ReadProtocol(const std::filesystem::path& file);

/** The same of a text; `file` is for messages, and for what stands beside it. */
[[nodiscard]] Result<Protocol> ParseProtocol(const std::string& text,
                                             const std::filesystem::path& file);

}  // namespace hvas::study
