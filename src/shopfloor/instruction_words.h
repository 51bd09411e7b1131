#pragma once

#include <cstdint>
#include <string>

#include "shopfloor/work_plan.h"

namespace hvas::shopfloor {

enum class Language : std::uint8_t { kEnglish, kGerman };

[[nodiscard]] const char* ToString(Language language);  ///< "en", "de", as HTML has them.

/** The words of work instructions in one language. In braces stands what is put in. */
struct InstructionWords {
  const char* title;  ///< {product}
  const char* parts;
  const char* steps;
  const char* work;  ///< Heading of the steps.
  const char* tools;
  const char* time;
  const char* turns;
  const char* left_out;
  const char* bill;
  const char* position;
  const char* name;
  const char* count;
  const char* mass;
  const char* material;
  const char* step;         ///< {number}
  const char* first_part;   ///< {part}
  const char* lay_aside;    ///< {part}
  const char* insert;       ///< {part}
  const char* insert_many;  ///< {count} {part}
  const char* with_others;  ///< {count}
  const char* turn_product;
  const char* way;
  const char* from_above;
  const char* from_below;
  const char* from_side;
  const char* oblique;
  const char* turning_way;
  const char* fit;
  const char* fit_in;  ///< {code} {kind} {part}
  const char* clearance;
  const char* transition;
  const char* interference;
  const char* proposed;
  const char* force;
  const char* press;    ///< {force} N, for a press or a mallet
  const char* by_hand;  ///< {force} N, by hand
  const char* tool;
  const char* torque;
  const char* tighten;   ///< {size} {torque} N m {preload} kN
  const char* run_in;    ///< {size}
  const char* turns_of;  ///< {turns}
  const char* hold;
  const char* until;  ///< {parts}
  const char* aside;
  const char* moved_aside;  ///< {part}
  const char* order;
  const char* before_meets;      ///< {part} {other}
  const char* before_own_meets;  ///< {part}
  const char* before_mate;       ///< {part} {other}
  const char* before_own_mate;   ///< {part}
  const char* before_other;      ///< {part}
  const char* step_time;
  const char* seconds;   ///< {seconds}
  const char* recorded;  ///< {seconds}
  const char* recorded_time;
  const char* recorded_note;  ///< {file}
  const char* time_note;
  const char* elements;
  const char* left_out_note;
  const char* picture;  ///< {part}
  const char* view3d;
  const char* previous;
  const char* next;
};

/** "295 N", "1.16 kN". @param force  [N] */
[[nodiscard]] std::string FormatForce(double force);

/** The name of a tool (orders::FreeMove::tool) in a language. */
[[nodiscard]] std::string TranslateTool(const std::string& tool, Language language);

[[nodiscard]] const InstructionWords& WordsOf(Language language);

/** The name of a part for people; its path where it has none. */
[[nodiscard]] const std::string& ShortNameOf(const simulation::Model& model,
                                             product::OccurrenceId id);

/** The names of a few parts, and how many more there are. */
[[nodiscard]] std::string ShortNamesOf(const simulation::Model& model,
                                       const std::vector<product::OccurrenceId>& parts);

/** What is done at a step: "Insert port ring 2". */
[[nodiscard]] std::string DescribeStep(const simulation::Model& model, const WorkStep& step,
                                       Language language);

/** What a motion of the hand is for, with its amount: "bring the part 0.42 m". */
[[nodiscard]] std::string DescribeMotion(const orders::HandMotion& motion, Language language);

/** What a sequence of BasicMOST is for: "bring the part". */
[[nodiscard]] std::string DescribeSequence(orders::MotionPurpose purpose, Language language);

}  // namespace hvas::shopfloor
