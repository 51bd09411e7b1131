#include "mates/propose_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "fits/iso286.h"
#include "fits/threads.h"

namespace hvas::mates {
namespace {

using product::Fit;
using product::FitKind;
using product::ThreadKind;

constexpr double kEqual = 1e-6;                // Radii closer than this are drawn equal [m].
constexpr double kThreadInterference = 0.015;  // Part of d.
// [m]: larger interferences than mates.md, section 3, has are no threads.
constexpr double kLargestDrawnThread = 12e-3;

std::string Describe(double diameter) {
  // Micrometres are enough to say what a drawing has.
  std::string text = std::to_string(std::round(diameter * 1e6) / 1e3);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') {
    text.pop_back();
  }
  return text + " mm";
}

Fit MakeThread(double shaft_radius, std::string reason) {
  return {FitKind::kThread, "", 2 * shaft_radius, true, std::move(reason)};
}

std::optional<fits::FitLimits> FindLimits(std::string_view code, double nominal) {
  const Result<fits::FitClass> fit = fits::ParseFit(code);
  const Result<fits::FitLimits> limits =
      fit ? fits::CalcFitLimits(*fit, nominal) : Unexpected(fit.error());
  return limits ? std::optional(*limits) : std::nullopt;
}

/** A running fit that is proposed. */
struct ClearanceChoice {
  std::string code;    // Empty where ISO 286 has none for the size.
  bool is_wide{true};  // False where the drawn clearance is larger than that of any code.
};

/** The closest running fit that may have the drawn clearance, or the widest that the size has. */
ClearanceChoice ChooseClearance(double nominal, double clearance) {
  constexpr double kRounding = 1e-9;  // [m]: far below a step of ISO 286.
  ClearanceChoice choice;
  for (const std::string_view code : {"H7/g6", "H8/f7", "H9/d9", "H11/c11"}) {
    if (const auto limits = FindLimits(code, nominal)) {
      choice.code = code;
      choice.is_wide = limits->max_clearance + kRounding >= clearance;
      if (choice.is_wide) {
        break;
      }
    }
  }
  return choice;
}

/** The lightest press fit that is one at this size: H7/p6 may have clearance below 3 mm. */
std::string ChoosePressCode(double nominal) {
  for (const std::string_view code : {"H7/p6", "H7/r6", "H7/s6"}) {
    const auto limits = FindLimits(code, nominal);
    if (limits && limits->kind == fits::FitKind::kInterference) {
      return std::string(code);
    }
  }
  return {};
}

/** Why names, shapes or threads say that this is a thread; nothing where they do not. */
std::optional<std::string> FindThreadReason(const FitEvidence& evidence, double clearance) {
  const bool is_larger = clearance > 2 * kEqual;
  const bool is_smaller = clearance < -2 * kEqual;
  const bool is_nut = evidence.hole_part == FastenerKind::kNut;
  const bool is_screw = evidence.shaft_part == FastenerKind::kScrew;
  const bool is_threaded_hole = evidence.hole_thread != ThreadKind::kNone;
  const bool is_threaded_shaft = evidence.shaft_thread != ThreadKind::kNone;
  if (is_nut && is_screw) {
    return "names or shapes indicate nut and screw";
  }
  if (is_threaded_hole && (is_screw || is_threaded_shaft)) {
    return "a screw in a threaded hole";
  }
  if (!is_larger && is_nut) {
    return "name or shape indicates a nut";
  }
  if (!is_larger && is_threaded_hole) {
    return "the hole is threaded";
  }
  if (!is_larger && is_screw && !evidence.nut_on_shaft) {
    return "name or shape indicates a screw";
  }
  if (!is_larger && is_threaded_shaft && !evidence.nut_on_shaft) {
    return "the shaft is threaded";
  }
  if (is_smaller && is_screw) {
    return "a screw is never a press fit";
  }
  return std::nullopt;
}

/** The thread that the two diameters are, where enough of it is engaged. */
const fits::Thread* FindDrawnThread(const FitEvidence& evidence) {
  constexpr double kLeastTurns = 2;  // Fewer hold nothing, and are there by chance: a choice.
  const fits::Thread* thread =
      fits::FindThreadOfPair(2 * evidence.hole_radius, 2 * evidence.shaft_radius);
  const bool is_long = thread != nullptr &&
                       (evidence.engaged == 0 || evidence.engaged >= kLeastTurns * thread->pitch);
  return is_long ? thread : nullptr;
}

/** Whether a shaft without a name is drawn into its hole as a thread is: at the outer diameter in a
 hole for its core, and not by the little that a pin is pressed. */
bool IsThreadInterference(double diameter, double interference) {
  constexpr double kLeastShare = 0.325;  // Of the pitch: halfway to the pitch diameter (ISO 724).
  constexpr double kForming = 0.1;       // Of d: what tapping screws cut is more.
  if (interference <= kThreadInterference * diameter || diameter > kLargestDrawnThread) {
    return false;
  }
  const fits::Thread* thread = fits::FindThread(diameter, 0);
  return interference > (thread != nullptr ? kLeastShare * thread->pitch : kForming * diameter);
}

}  // namespace

Fit ProposeFit(const FitEvidence& evidence) {
  const double d = 2 * evidence.shaft_radius;
  const double clearance = 2 * (evidence.hole_radius - evidence.shaft_radius);
  if (std::optional<std::string> reason = FindThreadReason(evidence, clearance)) {
    return MakeThread(evidence.shaft_radius, std::move(*reason));
  }
  const double nominal = 2 * evidence.hole_radius;
  const ClearanceChoice choice = ChooseClearance(nominal, std::max(0.0, clearance));
  const bool is_larger = clearance > 2 * kEqual;
  if (evidence.is_toothed) {
    return {FitKind::kInsert, "", d, true, "a hub that is pushed on the teeth of a shaft"};
  }
  if (evidence.is_flexible) {
    return {is_larger ? FitKind::kPassage : FitKind::kInsert, "", nominal, true,
            "a cable, hose, clip, slit pin or rubber gives"};
  }
  if (evidence.shaft_part == FastenerKind::kNut && choice.is_wide) {
    return {FitKind::kInsert, "", d, true,
            "a nut or insert in its bore, melted, pressed or drawn in"};
  }
  if (!choice.is_wide && evidence.may_pass) {
    return {FitKind::kPassage, "", nominal, true,
            "drawn clearance of " + Describe(clearance) + " is more than that of " + choice.code};
  }
  if (clearance >= -2 * kEqual && evidence.may_pass && evidence.is_rivet) {
    return {FitKind::kPassage, "", nominal, true, "a rivet, which fills its hole when it is set"};
  }
  if (clearance >= -2 * kEqual && evidence.may_pass &&
      evidence.shaft_part == FastenerKind::kScrew) {
    return {FitKind::kPassage, "", nominal, true, "a screw in a through hole"};
  }
  const fits::Thread* const pair = evidence.is_pressed ? nullptr : FindDrawnThread(evidence);
  if (pair != nullptr) {
    return MakeThread(evidence.shaft_radius, "hole of " + Describe(nominal) + " and shaft of " +
                                                 Describe(d) + " are core and outer diameter of " +
                                                 pair->designation);
  }
  if (!evidence.is_pressed && IsThreadInterference(d, -clearance)) {
    if (evidence.is_hollow) {
      return {FitKind::kInsert, "", d, true,
              "drawn interference of " + Describe(-clearance) + " of a hollow part is an insert's"};
    }
    return MakeThread(evidence.shaft_radius, "drawn interference of " + Describe(-clearance) +
                                                 " is a thread's, not a press fit's");
  }
  if (clearance < -2 * kEqual) {
    return {FitKind::kInterference, ChoosePressCode(nominal), nominal, true,
            "drawn interference of " + Describe(-clearance)};
  }
  if (clearance <= 2 * kEqual) {
    return {FitKind::kClearance, choice.code, nominal, true, "drawn equal"};
  }
  return {FitKind::kClearance, choice.code, nominal, true,
          "drawn clearance of " + Describe(clearance)};
}

}  // namespace hvas::mates
