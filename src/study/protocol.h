#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "fits/pair_choice.h"
#include "haptics/options.h"
#include "haptics/paper_guidance.h"
#include "mates/capture.h"
#include "product/mate.h"

/** Protocol of a study (N9): conditions, trials and their order, questions, consent. The file is
 YAML or JSON; docs/studies.md and data/schemas/study.schema.json define its format. */
namespace hvas::study {

inline constexpr std::string_view kProtocolFormat = "hvas-study-1";

/** A text in the languages of a study; where a translation is missing, English. */
struct LocalText {
  std::string en;
  std::string de;

  [[nodiscard]] const std::string& In(std::string_view language) const {
    return language == "de" && !de.empty() ? de : en;
  }

  [[nodiscard]] bool empty() const { return en.empty(); }
};

/** Assembly method of a condition. */
enum class Method : std::uint8_t {
  kPicking,     ///< Constraints between surfaces picked with the mouse; no physics (W8: A1).
  kCollision,   ///< Contact alone (X14, W8: A2).
  kConstraint,  ///< Mates alone; parts can interpenetrate (X14).
  kHybrid,      ///< Contact and mates (X14, W8: A3, B1 to B3).
};

inline constexpr std::array<std::string_view, 4> kMethods{
    "constraints_by_picking", "collision_only", "constraint_only", "hybrid"};

[[nodiscard]] constexpr std::string_view ToString(Method method) {
  return kMethods[static_cast<std::size_t>(method)];
}

/** How the mates come about that guide the part of a trial. */
enum class Constraints : std::uint8_t {
  kRecognised,  ///< They are recognised while the part moves, by distance and angle (X8).
  kPicked,      ///< The axis is picked first, by two surfaces (X14, paper X, condition 2).
};

inline constexpr std::array<std::string_view, 2> kConstraints{"recognised", "picked"};

struct Condition {
  std::string id;
  LocalText name;         ///< Shown to the experimenter and in the report.
  LocalText instruction;  ///< Instruction for the participant.
  Method method{Method::kHybrid};
  Constraints constraints{Constraints::kRecognised};  ///< Used with kConstraint and kHybrid.
  std::string part;  ///< Part that is assembled; empty: that of the protocol.
  std::string fit;   ///< Fit of the part, as an ISO 286 code; empty: the product's.
  /** How the pair of each trial is drawn. */
  fits::PairChoice pairs{fits::PairChoice::kOfKind};
  product::FitConditions sizes;  ///< Measured sizes, roughness and friction; empty: the product's.
  bool renders_fits{true};       ///< Whether the resistance of the fit is rendered (W5).
  std::string answer;            ///< Name of the response in identification; empty: `fit`.
  mates::CaptureThresholds capture;
  haptics::ForceMapKind force_map{haptics::ForceMapKind::kPublished};
  haptics::PaperFactors paper_factors;  ///< Used with the paper's force map.
  haptics::PaperGuidance guidance;
  double coupling{1000};                        ///< Upper limit of the coupling's stiffness [N/m].
  double time_limit{120};                       ///< Time limit of a trial [s].
  std::optional<double> published_mean;         ///< Mean time that the source reports [s].
  std::optional<double> published_right_share;  ///< Share of correct answers in the source.
};

/** Counterbalancing: how the order of conditions varies between participants. */
enum class Order : std::uint8_t {
  kGiven,        ///< The order of the protocol, for everybody.
  kLatinSquare,  ///< Latin square: each condition is in each position equally often.
  kBalanced,     ///< Each also follows each other equally often (Williams, Aust. J. Sci. Res. A 2,
                 ///< 1949).
  kRandom,       ///< Random permutations from the study's seed.
};

inline constexpr std::array<std::string_view, 4> kOrders{"given", "latin_square", "balanced",
                                                         "random"};

/** Trials that belong together. */
struct Block {
  std::string id;
  LocalText name;
  std::vector<std::size_t> conditions;  ///< Indices into Protocol::conditions.
  int repetitions{1};                   ///< Trials of each condition.
  Order order{Order::kBalanced};
  /** Whether all repetitions of a condition follow one another; otherwise rounds of all
   conditions. */
  bool keeps_repetitions_together{true};
  /** Blind identification (W12): the trials are shuffled, and after each the participant names the
   condition. */
  bool is_identification{false};
  /** Whether the participant is told the name of the condition, even where it is hidden. */
  bool tells_condition{false};
  LocalText question;  ///< Question of identification.
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
  std::string block;  ///< Block in which it is asked; empty: every block. Unused with kAtEnd.
  LocalText text;
  int low{1};                     ///< Lowest value of a scale.
  int high{10};                   ///< Highest value of a scale.
  LocalText low_text, high_text;  ///< Verbal anchors of a scale.
  std::vector<Choice> choices;
  int longest{2000};  ///< Largest length of a text [characters].
};

struct Training {
  double duration{0};  ///< Duration [s]; 0: no training.
  LocalText text;
  std::optional<std::size_t> condition;  ///< Condition of the training; none: the first.
};

/** What is hidden from the participant. Names of fits are never sent to a participant's client. */
struct Hidden {
  bool condition{true};  ///< Name of the condition.
  bool time{true};       ///< Elapsed time of a trial.
  bool progress{false};  ///< Number of trials.
};

/** How the picture for the participant is shown to both eyes. */
enum class Stereo : std::uint8_t { kNone, kSide, kAnaglyph };

inline constexpr std::array<std::string_view, 3> kStereos{"none", "side", "anaglyph"};

/** What the participant's page shows besides the scene. */
struct Display {
  bool has_end_sound{true};  ///< A sound when the part is in its place (W7).
  Stereo stereo{Stereo::kNone};
};

struct Protocol {
  std::string id;
  LocalText title;
  std::string about;
  std::string source;   ///< Citation for the published values of the conditions.
  std::string product;  ///< File relative to the protocol's folder, or the name of an example.
  /** Part to assemble where the condition has none of its own; parts that precede it are in their
   place already. */
  std::string part;
  int participants{1};  ///< Planned number of participants.
  std::vector<std::string> languages{"en"};
  LocalText consent;
  Training training;
  std::vector<Condition> conditions;
  std::vector<Block> blocks;
  std::vector<Question> questions;
  Hidden hidden;
  Display display;
  double mating_window{3};  ///< Time before a trial's end for which wrenches are kept [s] (X15).

  std::filesystem::path file;
  std::string text;    ///< Text of the file.
  std::string digest;  ///< Digest of `text`.

  [[nodiscard]] const Condition* FindCondition(std::string_view condition_id) const;

  /** The part that is assembled in a condition. In identification it is that of the protocol, as
   the place of another one would tell the answer. */
  [[nodiscard]] const std::string& PartOf(const Condition& condition,
                                          bool is_identification) const {
    return is_identification || condition.part.empty() ? part : condition.part;
  }

  /** Counts the trials of a participant. */
  [[nodiscard]] int CountTrials() const;
};

/** Reads a protocol. Errors: kNotFound for a missing file; kUnreadable and kInvalid, with
 "FILE:LINE:COLUMN", the entity and a remedy, for unknown or duplicate keys, values of another type
 or out of range, and names that are not defined. */
[[nodiscard]] Result<Protocol> ReadProtocol(const std::filesystem::path& file);

/** Parses a protocol's text; `file` is for messages, and for finding files relative to it. */
[[nodiscard]] Result<Protocol> ParseProtocol(const std::string& text,
                                             const std::filesystem::path& file);

}  // namespace hvas::study
