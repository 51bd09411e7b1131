#include "product/flexible.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "product/bearable_strain.h"
#include "product/product.h"
#include "product/ring_shape.h"
#include "product/words.h"

namespace hvas::product {
namespace {

struct FlexibleWord {
  std::string_view word;
  FlexibleKind kind;
};

// Names in English, German, French, Spanish and Italian. The first one that is found counts.
constexpr std::array<FlexibleWord, 81> kFlexibleWords{{
    {"o ring", FlexibleKind::kORing},
    {"or ring", FlexibleKind::kORing},
    {"din 3771", FlexibleKind::kORing},
    {"iso 3601", FlexibleKind::kORing},
    {"joint torique", FlexibleKind::kORing},
    {"circlip", FlexibleKind::kRetainingRing},
    {"e ring", FlexibleKind::kRetainingRing},
    {"retaining ring", FlexibleKind::kRetainingRing},
    {"snap ring", FlexibleKind::kRetainingRing},
    {"seeger", FlexibleKind::kRetainingRing},
    {"seegerring", FlexibleKind::kRetainingRing},
    {"sicherungsring", FlexibleKind::kRetainingRing},
    {"sprengring", FlexibleKind::kRetainingRing},
    {"sicherungsscheibe", FlexibleKind::kRetainingRing},
    {"e clip", FlexibleKind::kRetainingRing},
    {"din 471", FlexibleKind::kRetainingRing},
    {"din 472", FlexibleKind::kRetainingRing},
    {"din 6799", FlexibleKind::kRetainingRing},
    {"din 7993", FlexibleKind::kRetainingRing},
    {"snap hook", FlexibleKind::kSnapHook},
    {"snap fit", FlexibleKind::kSnapHook},
    {"snap in", FlexibleKind::kSnapHook},
    {"schnapphaken", FlexibleKind::kSnapHook},
    {"latch", FlexibleKind::kSnapHook},
    {"clip", FlexibleKind::kSnapHook},
    {"snap", FlexibleKind::kSnapHook},
    {"grommet", FlexibleKind::kRubber},
    {"tyre", FlexibleKind::kRubber},
    {"tire", FlexibleKind::kRubber},
    {"reifen", FlexibleKind::kRubber},
    {"pneu", FlexibleKind::kRubber},
    {"bellows", FlexibleKind::kRubber},
    {"faltenbalg", FlexibleKind::kRubber},
    {"dust boot", FlexibleKind::kRubber},
    {"durchfuhrungstulle", FlexibleKind::kRubber},
    {"rivet", FlexibleKind::kRivet},
    {"niet", FlexibleKind::kRivet},
    {"blindniet", FlexibleKind::kRivet},
    {"rivetto", FlexibleKind::kRivet},
    {"remache", FlexibleKind::kRivet},
    {"din 7337", FlexibleKind::kRivet},
    {"oil seal", FlexibleKind::kLipSeal},
    {"lip seal", FlexibleKind::kLipSeal},
    {"shaft seal", FlexibleKind::kLipSeal},
    {"rotary seal", FlexibleKind::kLipSeal},
    {"radial seal", FlexibleKind::kLipSeal},
    {"rod seal", FlexibleKind::kLipSeal},
    {"wellendichtring", FlexibleKind::kLipSeal},
    {"radialwellendichtring", FlexibleKind::kLipSeal},
    {"simmerring", FlexibleKind::kLipSeal},
    {"din 3760", FlexibleKind::kLipSeal},
    {"iso 6194", FlexibleKind::kLipSeal},
    {"joint a levre", FlexibleKind::kLipSeal},
    {"joint spi", FlexibleKind::kLipSeal},
    {"paraolio", FlexibleKind::kLipSeal},
    {"reten", FlexibleKind::kLipSeal},
    {"gasket", FlexibleKind::kGasket},
    {"dichtung", FlexibleKind::kGasket},
    {"flachdichtung", FlexibleKind::kGasket},
    {"dichtring", FlexibleKind::kGasket},
    {"guarnizione", FlexibleKind::kGasket},
    {"seal", FlexibleKind::kGasket},
    {"spring", FlexibleKind::kSpring},
    {"druckfeder", FlexibleKind::kSpring},
    {"zugfeder", FlexibleKind::kSpring},
    {"ressort", FlexibleKind::kSpring},
    {"cable", FlexibleKind::kCable},
    {"kabel", FlexibleKind::kCable},
    {"wire", FlexibleKind::kCable},
    {"leitung", FlexibleKind::kCable},
    {"hose", FlexibleKind::kCable},
    {"schlauch", FlexibleKind::kCable},
    {"belt", FlexibleKind::kBelt},
    {"zahnriemen", FlexibleKind::kBelt},
    {"riemen", FlexibleKind::kBelt},
    {"zip tie", FlexibleKind::kCable},
    {"cable tie", FlexibleKind::kCable},
    {"kabelbinder", FlexibleKind::kCable},
    {"strap", FlexibleKind::kCable},
    {"rope", FlexibleKind::kCable},
    {"rubber band", FlexibleKind::kCable},
}};

// What such a word stands before, where it is something stiff: "cable holder", "spring pin".
constexpr std::array<std::string_view, 46> kStiffThings{
    "nut",       "holder", "mount",    "bracket", "plate",     "cover",  "housing",  "groove",
    "tensioner", "pulley", "guide",    "chain",   "duct",      "gland",  "seat",     "pin",
    "washer",    "sleeve", "frame",    "case",    "box",       "screw",  "bolt",     "halter",
    "block",     "body",   "clamp",    "channel", "tray",      "runner", "post",     "collar",
    "plug",      "drum",   "nipple",   "fitting", "connector", "wheel",  "terminal", "lug",
    "socket",    "flange", "coupling", "adapter", "barb",      "end"};

constexpr std::array<std::string_view, 13> kElasticMaterials{
    "rubber", "gummi", "nbr", "fkm",  "viton",   "silicon rubber", "silicone",
    "epdm",   "tpu",   "tpe", "foam", "neopren", "elastomer"};

double LeastExtent(const Part& part) {
  return part.box_B.size().minCoeff();
}

double LargestExtent(const Part& part) {
  return part.box_B.size().maxCoeff();
}

/** What is between the outside of a ring, which lies flat in its box, and its narrowest bore [m].
 */
double CalcRadialHeight(const Part& part) {
  const double outer = LargestExtent(part);
  double bore = outer;
  for (const Feature& feature : part.features) {
    bore = feature.kind == FeatureKind::kHole ? std::min(bore, 2 * feature.radius) : bore;
  }
  return 0.5 * (bore < outer ? outer - bore : outer);
}

/** A ring of round section: its faces are tori about one axis. */
bool IsORing(const Part& part) {
  return !part.faces.empty() &&
         std::all_of(part.faces.begin(), part.faces.end(), [](const Face& face) {
           return face.surface.kind == SurfaceKind::kTorus && face.surface.outward > 0;
         });
}

// What is open by more than 144 degrees holds no shaft: a choice.
constexpr double kWidestSplit = 0.8 * std::numbers::pi;

/** A flat ring that is open: a hole and a rim about one axis that cover most of the turn. */
bool IsOpenRing(const Part& part) {
  constexpr double kLeast = 2 * std::numbers::pi - kWidestSplit;  // What a gap leaves.
  constexpr double kMost = 1.97 * std::numbers::pi;  // 355 degrees: less is open. A choice.
  constexpr double kFlat = 0.15;  // Thickness over diameter; DIN 471 has at most 0.13.
  if (LeastExtent(part) > kFlat * LargestExtent(part)) {
    return false;
  }
  constexpr double kWidestBand = 0.3;  // The least bore over the diameter: DIN 6799 has 0.36 on.
  const auto has_open = [&part](FeatureKind kind) {
    return std::any_of(part.features.begin(), part.features.end(), [&](const Feature& feature) {
      return feature.kind == kind && feature.coverage > kLeast && feature.coverage < kMost &&
             2 * feature.radius > kWidestBand * LargestExtent(part);
    });
  };
  return has_open(FeatureKind::kHole) && has_open(FeatureKind::kShaft);
}

/** How far a split ring gives until its strain is what it bears [m]. */
double CalcMostOpening(const RingShape& ring, const Material& material) {
  const double r = ring.mean_radius();
  const double curvature = 1 / r - 2 * FindBearableRingStrain(material) / ring.width();
  return curvature > 0 ? 1 / curvature - r : ring.outer;
}

std::optional<FlexiblePart> MakeFlexible(FlexibleKind kind, const Part& part, std::string reason) {
  const double allowance = CalcAllowance(kind, part);
  if (!(allowance > 0) || !std::isfinite(allowance)) {
    return std::nullopt;
  }
  return FlexiblePart{{}, kind, allowance, std::move(reason)};
}

}  // namespace

double CalcAllowance(FlexibleKind kind, const Part& part) {
  constexpr double kMostStretch = 0.25;      // Of an O-ring's inner diameter, to each side.
  constexpr double kRingOpening = 0.1;       // Of the ring's diameter, to each side.
  constexpr double kLeastOpening = 0.3e-3;   // [m]: rings below 6 mm open by more.
  constexpr double kSqueeze = 0.5;           // Of the thickness of a gasket.
  constexpr double kSpread = 0.25;           // Of the radial height of a lip seal: its lip.
  constexpr double kLargestSpread = 1.5e-3;  // [m]: lips are 1 to 2 mm narrower in diameter.
  constexpr double kElongation = 0.15;       // Of the longest side of a part of rubber.
  constexpr double kHead = 0.3;              // Of the longest side of a rivet.
  constexpr double kMostBend = 5e-3;         // [m]: a choice.
  constexpr double kCoil = 0.25;             // Of the diameter of a spring.
  switch (kind) {
    case FlexibleKind::kORing:
      return std::min(LeastExtent(part),
                      kMostStretch * (LargestExtent(part) - 2 * LeastExtent(part)));
    case FlexibleKind::kRetainingRing:
      return std::max(kLeastOpening, kRingOpening * LargestExtent(part));
    case FlexibleKind::kGasket:
      return kSqueeze * LeastExtent(part);
    case FlexibleKind::kLipSeal:
      return std::min(kLargestSpread, kSpread * CalcRadialHeight(part));
    case FlexibleKind::kRubber:
      return std::min(LeastExtent(part), kElongation * LargestExtent(part));
    case FlexibleKind::kSpring:
      return kCoil * LeastExtent(part);
    case FlexibleKind::kCable:
    case FlexibleKind::kBelt:
      return std::min(LeastExtent(part), kMostBend);
    case FlexibleKind::kRivet:
      return kHead * LargestExtent(part);
    case FlexibleKind::kSnapHook:
    case FlexibleKind::kGrooveRing:
    case FlexibleKind::kForm:
    case FlexibleKind::kStated:
      break;
  }
  return 0;
}

const char* ToString(FlexibleKind kind) {
  switch (kind) {
    case FlexibleKind::kORing:
      return "O-ring";
    case FlexibleKind::kRetainingRing:
      return "retaining ring";
    case FlexibleKind::kSnapHook:
      return "snap hook";
    case FlexibleKind::kGasket:
      return "gasket";
    case FlexibleKind::kRubber:
      return "rubber";
    case FlexibleKind::kSpring:
      return "spring";
    case FlexibleKind::kCable:
      return "cable";
    case FlexibleKind::kRivet:
      return "rivet";
    case FlexibleKind::kForm:
      return "a wall that bends";
    case FlexibleKind::kLipSeal:
      return "lip seal";
    case FlexibleKind::kGrooveRing:
      return "closed ring in a groove";
    case FlexibleKind::kBelt:
      return "belt";
    case FlexibleKind::kStated:
      break;
  }
  return "stated";
}

std::optional<FlexibleKind> FindFlexibleKind(std::string_view name) {
  const std::string folded = FoldName(name);
  const std::vector<Word> words = SplitWords(folded);
  const auto* const found =
      std::find_if(kFlexibleWords.begin(), kFlexibleWords.end(), [&](const FlexibleWord& entry) {
        // "Snap cover", "snap frame": they hold by hooks of their own.
        const bool is_snap =
            entry.kind == FlexibleKind::kSnapHook && entry.word.starts_with("snap");
        return NamesThing(folded, words, entry.word,
                          is_snap ? std::span<const std::string_view>() : kStiffThings);
      });
  return found == kFlexibleWords.end() ? std::nullopt : std::optional(found->kind);
}

bool IsRubber(const Material& material) {
  return HasOneOf(FoldName(material.name), kElasticMaterials);
}

std::optional<FlexiblePart> ClassifyFlexibleByWords(const Part& part) {
  if (const auto kind = FindFlexibleKind(part.name)) {
    return MakeFlexible(*kind, part, "its name");
  }
  if (IsRubber(part.material)) {
    return MakeFlexible(FlexibleKind::kRubber, part, "its material " + part.material.name);
  }
  if (HasOneOf(FoldName(part.name), kElasticMaterials)) {
    return MakeFlexible(FlexibleKind::kRubber, part, "the material in its name");
  }
  return std::nullopt;
}

std::optional<FlexiblePart> ClassifyFlexibleByForm(const Part& part) {
  if (IsORing(part)) {
    return MakeFlexible(FlexibleKind::kORing, part, "its form, a ring of round section");
  }
  const std::optional<RingShape> ring = FindRingShape(part);
  if (ring && ring->gap > 0 && ring->gap < kWidestSplit) {
    auto split = MakeFlexible(FlexibleKind::kRetainingRing, part, "its form, a split ring");
    if (split) {
      split->allowance = std::min(split->allowance, CalcMostOpening(*ring, part.material));
    }
    return split;
  }
  if (IsOpenRing(part)) {
    return MakeFlexible(FlexibleKind::kRetainingRing, part, "its form, an open flat ring");
  }
  return std::nullopt;
}

std::optional<FlexiblePart> ClassifyFlexible(const Part& part) {
  auto by_form = ClassifyFlexibleByForm(part);
  return by_form ? by_form : ClassifyFlexibleByWords(part);
}

bool IsStatedRigid(const Product& product, OccurrenceId id) {
  const FlexiblePart* stated = FindFlexible(product, id);
  return stated != nullptr && stated->allowance == 0;
}

const FlexiblePart* FindFlexible(const Product& product, OccurrenceId id) {
  const auto found = std::find_if(product.flexible.begin(), product.flexible.end(),
                                  [id](const FlexiblePart& part) { return part.occurrence == id; });
  return found == product.flexible.end() ? nullptr : &*found;
}

}  // namespace hvas::product
