#include "shopfloor/instruction_words.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::shopfloor {
namespace {

using orders::MotionPurpose;

constexpr InstructionWords kEnglish{
    .title = "{}: work instructions",
    .parts = "parts",
    .steps = "steps",
    .work = "Work",
    .tools = "Tools",
    .time = "time of the hands, about",
    .turns = "turns of the product",
    .left_out = "parts without a way in",
    .bill = "Bill of parts",
    .position = "item",
    .name = "part",
    .count = "quantity",
    .mass = "mass of one [g]",
    .material = "material",
    .step = "Step {}",
    .first_part = "Put {} into the fixture",
    .lay_aside = "Lay the finished subassembly with {} aside",
    .insert = "Insert {}",
    .insert_many = "Insert {} pieces: {}",
    .with_others = "with its subassembly (+{})",
    .turn_product = "First turn the product, as the picture shows.",
    .way = "Way",
    .from_above = "from above, along the arrow",
    .from_below = "from below, along the arrow",
    .from_side = "from the side, along the arrow",
    .oblique = "obliquely, along the arrow",
    .turning_way = "tilt and turn it in; the picture shows where its way begins",
    .fit = "Fit",
    .fit_in = "{}, {}, with {}",
    .clearance = "clearance",
    .transition = "transition",
    .interference = "interference",
    .proposed = " (proposed)",
    .force = "Force",
    .press = "{}: use a press or a mallet",
    .by_hand = "{}, by hand",
    .tool = "Tool",
    .torque = "Tighten",
    .tighten = "{} to {:.3g} N m (preload {:.3g} kN)",
    .run_in = "{}: run in to the seat",
    .turns_of = ", about {:.0f} turns",
    .hold = "Hold",
    .until = "{}, until it is secured",
    .aside = "Move aside",
    .moved_aside = "{}, and back afterwards",
    .order = "Order matters",
    .before_meets = "before {}: afterwards it would meet {}",
    .before_own_meets = "before {}, which it would meet afterwards",
    .before_mate = "before {}: afterwards {} leaves it no way in",
    .before_own_mate = "before {}, which leaves it no way in afterwards",
    .before_other = "before {}: no way in was found afterwards",
    .step_time = "Time",
    .seconds = "{:.1f} s",
    .recorded = "{:.1f} s in the record",
    .recorded_time = "time in hands, in the record",
    .recorded_note =
        "Beside them stand the times that the parts were in hands in the record {}: those "
        "of whoever worked there, a simulated person or a participant.",
    .time_note =
        "Times by MODAPTS, 0.129 s a MOD, and by the general and the tool sequence of BasicMOST, "
        "0.036 s "
        "a TMU, for a trained hand without allowances: an estimate "
        "from distances, weights, sizes and fits, not measured.",
    .elements = "Motions",
    .left_out_note = "No way in was found for these parts. Insert them by your own judgement:",
    .picture = "What is there, and {} before its place, with its way as an arrow",
    .view3d = "In three dimensions",
    .previous = "Previous step",
    .next = "Next step"};

constexpr InstructionWords kGerman{
    .title = "{}: Montageanweisung",
    .parts = "Teile",
    .steps = "Schritte",
    .work = "Arbeit",
    .tools = "Werkzeuge",
    .time = "Handzeit, etwa",
    .turns = "Wendungen des Produkts",
    .left_out = "Teile ohne Weg",
    .bill = "Stückliste",
    .position = "Pos.",
    .name = "Teil",
    .count = "Menge",
    .mass = "Masse je Stück [g]",
    .material = "Werkstoff",
    .step = "Schritt {}",
    .first_part = "{} in die Aufnahme legen",
    .lay_aside = "Fertige Baugruppe mit {} ablegen",
    .insert = "{} einsetzen",
    .insert_many = "{} Stück einsetzen: {}",
    .with_others = "mit seiner Baugruppe (+{})",
    .turn_product = "Zuerst das Produkt wenden, wie im Bild.",
    .way = "Weg",
    .from_above = "von oben, entlang des Pfeils",
    .from_below = "von unten, entlang des Pfeils",
    .from_side = "von der Seite, entlang des Pfeils",
    .oblique = "schräg, entlang des Pfeils",
    .turning_way = "hineinkippen und drehen; das Bild zeigt, wo der Weg beginnt",
    .fit = "Passung",
    .fit_in = "{}, {}, mit {}",
    .clearance = "Spielpassung",
    .transition = "Übergangspassung",
    .interference = "Presspassung",
    .proposed = " (vorgeschlagen)",
    .force = "Kraft",
    .press = "{}: Presse oder Schonhammer benutzen",
    .by_hand = "{}, von Hand",
    .tool = "Werkzeug",
    .torque = "Anziehen",
    .tighten = "{} mit {:.3g} N m (Vorspannkraft {:.3g} kN)",
    .run_in = "{}: bis zum Anliegen eindrehen",
    .turns_of = ", etwa {:.0f} Umdrehungen",
    .hold = "Halten",
    .until = "{}, bis es gesichert ist",
    .aside = "Beiseite",
    .moved_aside = "{} beiseite bewegen, danach zurück",
    .order = "Reihenfolge",
    .before_meets = "vor {}: danach würde es an {} stoßen",
    .before_own_meets = "vor {}: danach würde es daran stoßen",
    .before_mate = "vor {}: danach lässt {} keinen Weg frei",
    .before_own_mate = "vor {}: danach bleibt kein Weg frei",
    .before_other = "vor {}: danach wurde kein Weg gefunden",
    .step_time = "Zeit",
    .seconds = "{:.1f} s",
    .recorded = "{:.1f} s in der Aufzeichnung",
    .recorded_time = "Zeit in Händen, aufgezeichnet",
    .recorded_note =
        "Daneben stehen die Zeiten, die die Teile in der Aufzeichnung {} in Händen waren: "
        "die der simulierten Person oder des Menschen, der dort gearbeitet hat.",
    .time_note =
        "Zeiten nach MODAPTS, 0,129 s je MOD, und nach BasicMOST, 0,036 s je TMU, für geübte Hände "
        "ohne Zuschläge: geschätzt aus "
        "Entfernungen, Gewichten, Größen und Passungen, nicht gemessen.",
    .elements = "Bewegungen",
    .left_out_note = "Für diese Teile wurde kein Weg gefunden. Nach eigenem Ermessen einsetzen:",
    .picture = "Was schon da ist, und {} vor seinem Platz, der Weg als Pfeil",
    .view3d = "Räumlich",
    .previous = "Schritt zurück",
    .next = "Nächster Schritt"};

/** A word of tools' names in another language. */
struct ToolWord {
  std::string_view english;
  std::string_view german;
};

constexpr std::array kToolWords{ToolWord{"hexagon key", "Innensechskantschlüssel"},
                                ToolWord{"spanner", "Maulschlüssel"},
                                ToolWord{"cross screwdriver", "Kreuzschlitz-Schraubendreher"},
                                ToolWord{"slot screwdriver", "Schlitz-Schraubendreher"},
                                ToolWord{"screwdriver", "Schraubendreher"}};

std::string DescribeInEnglish(const orders::HandMotion& motion) {
  switch (motion.purpose) {
    case MotionPurpose::kTurnProduct:
      return "turn the product over";
    case MotionPurpose::kOtherWay:
      return "go to another side";
    case MotionPurpose::kGetTool:
      return "get the tool";
    case MotionPurpose::kChangeTool:
      return "lay the tool aside, get another one";
    case MotionPurpose::kGoTo:
      return fmt::format("reach for the part, {:.2f} m", motion.amount);
    case MotionPurpose::kGet:
      return fmt::format("grasp it, {:.0f} mm large", units::ToMm(motion.amount));
    case MotionPurpose::kBring:
      return fmt::format("bring it, {:.2f} m", motion.amount);
    case MotionPurpose::kPut:
      return "put it into its place";
    case MotionPurpose::kLoad:
      return fmt::format("its weight, {:.2g} kg", motion.amount);
    case MotionPurpose::kReachIn:
      return fmt::format("reach in by {:.0f} mm, and out again", units::ToMm(motion.amount));
    case MotionPurpose::kToolOn:
      return "put the tool on";
    case MotionPurpose::kCrank:
      return fmt::format("turn it in, {:.0f} turns", motion.amount);
    case MotionPurpose::kPress:
      return "press it in, " + FormatForce(motion.amount);
    case MotionPurpose::kHold:
      return "hold against it with the other hand";
  }
  return {};
}

std::string DescribeInGerman(const orders::HandMotion& motion) {
  switch (motion.purpose) {
    case MotionPurpose::kTurnProduct:
      return "Produkt wenden";
    case MotionPurpose::kOtherWay:
      return "zu einer anderen Seite greifen";
    case MotionPurpose::kGetTool:
      return "Werkzeug holen";
    case MotionPurpose::kChangeTool:
      return "Werkzeug weglegen, anderes holen";
    case MotionPurpose::kGoTo:
      return fmt::format("zum Teil greifen, {:.2f} m", motion.amount);
    case MotionPurpose::kGet:
      return fmt::format("fassen, {:.0f} mm groß", units::ToMm(motion.amount));
    case MotionPurpose::kBring:
      return fmt::format("heranführen, {:.2f} m", motion.amount);
    case MotionPurpose::kPut:
      return "an seinen Platz setzen";
    case MotionPurpose::kLoad:
      return fmt::format("Gewicht, {:.2g} kg", motion.amount);
    case MotionPurpose::kReachIn:
      return fmt::format("{:.0f} mm hineinreichen und zurück", units::ToMm(motion.amount));
    case MotionPurpose::kToolOn:
      return "Werkzeug ansetzen";
    case MotionPurpose::kCrank:
      return fmt::format("eindrehen, {:.0f} Umdrehungen", motion.amount);
    case MotionPurpose::kPress:
      return "einpressen, " + FormatForce(motion.amount);
    case MotionPurpose::kHold:
      return "mit der anderen Hand gegenhalten";
  }
  return {};
}

}  // namespace

std::string FormatForce(double force) {
  constexpr double kKilo = 1000;  // From there on a force is told in kN [N].
  return force < kKilo ? fmt::format("{:.3g} N", force) : fmt::format("{:.3g} kN", force / kKilo);
}

std::string TranslateTool(const std::string& tool, Language language) {
  if (language == Language::kGerman) {
    for (const ToolWord& word : kToolWords) {
      if (tool.starts_with(word.english)) {
        return std::string(word.german) + tool.substr(word.english.size());
      }
    }
  }
  return tool;
}

const char* ToString(Language language) {
  return language == Language::kGerman ? "de" : "en";
}

const InstructionWords& WordsOf(Language language) {
  return language == Language::kGerman ? kGerman : kEnglish;
}

const std::string& ShortNameOf(const simulation::Model& model, product::OccurrenceId id) {
  const product::Occurrence& occurrence = model.product->occurrences[id.index()];
  return occurrence.name.empty() ? occurrence.path : occurrence.name;
}

std::string ShortNamesOf(const simulation::Model& model,
                         const std::vector<product::OccurrenceId>& parts) {
  constexpr std::size_t kNamed = 4;  // As many as fit into a line: a choice.
  std::string names;
  for (std::size_t i = 0; i < std::min(kNamed, parts.size()); ++i) {
    names += (i == 0 ? "" : ", ") + ShortNameOf(model, parts[i]);
  }
  return parts.size() > kNamed ? names + fmt::format(" (+{})", parts.size() - kNamed) : names;
}

std::string DescribeStep(const simulation::Model& model, const WorkStep& step, Language language) {
  const InstructionWords& words = WordsOf(language);
  const std::string& name = ShortNameOf(model, step.leading.front());
  switch (step.kind) {
    case WorkStep::Kind::kBase:
      return fmt::format(fmt::runtime(words.first_part), name);
    case WorkStep::Kind::kLayAside:
      return fmt::format(fmt::runtime(words.lay_aside), name);
    case WorkStep::Kind::kInsert:
      break;
  }
  if (step.leading.size() > 1) {
    return fmt::format(fmt::runtime(words.insert_many), step.leading.size(),
                       ShortNamesOf(model, step.leading));
  }
  std::string title = fmt::format(fmt::runtime(words.insert), name);
  if (step.coming.size() > 1) {
    title += ", " + fmt::format(fmt::runtime(words.with_others), step.coming.size() - 1);
  }
  return title;
}

std::string DescribeMotion(const orders::HandMotion& motion, Language language) {
  return language == Language::kGerman ? DescribeInGerman(motion) : DescribeInEnglish(motion);
}

std::string DescribeSequence(MotionPurpose purpose, Language language) {
  const bool is_german = language == Language::kGerman;
  switch (purpose) {
    case MotionPurpose::kTurnProduct:
      return is_german ? "Produkt wenden" : "turn the product over";
    case MotionPurpose::kHold:
      return is_german ? "gegenhalten" : "hold against it";
    case MotionPurpose::kCrank:
      return is_german ? "Werkzeug benutzen" : "use the tool";
    default:
      return is_german ? "Teil holen und einsetzen" : "get the part and put it into its place";
  }
}

}  // namespace hvas::shopfloor
