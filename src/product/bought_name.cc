#include "product/bought_name.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "product/ascii.h"
#include "product/words.h"

namespace hvas::product {
namespace {

template <std::size_t kCount>
bool IsOneOf(const std::array<std::string_view, kCount>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end() ||
         (word.size() > 1 && word.back() == 's' &&
          std::find(words.begin(), words.end(), word.substr(0, word.size() - 1)) != words.end());
}

// Words for what is bought as one piece.
constexpr std::array<std::string_view, 38> kBoughtWords{"servo",
                                                        "servomotor",
                                                        "stepper",
                                                        "stepmotor",
                                                        "schrittmotor",
                                                        "nema",
                                                        "potentiometer",
                                                        "poti",
                                                        "microswitch",
                                                        "mikroschalter",
                                                        "endstop",
                                                        "endschalter",
                                                        "usb",
                                                        "jst",
                                                        "molex",
                                                        "encoder",
                                                        "drehgeber",
                                                        "relay",
                                                        "relais",
                                                        "kugellager",
                                                        "rillenkugellager",
                                                        "waelzlager",
                                                        "ballbearing",
                                                        "rodamiento",
                                                        "cuscinetto",
                                                        "kabelverschraubung",
                                                        "dynamixel",
                                                        "gearmotor",
                                                        "getriebemotor",
                                                        "linearbearing",
                                                        "linearlager",
                                                        "brushless",
                                                        "bldc",
                                                        "solenoid",
                                                        "oled",
                                                        "lcd",
                                                        "hdmi",
                                                        "rj"};

// Words for what may as well be made of parts by whoever draws it.
constexpr std::array<std::string_view, 21> kWords{
    "motor",    "moteur",      "motore",    "bearing", "lager",  "roulement", "switch",
    "schalter", "interruptor", "connector", "stecker", "buchse", "conector",  "connecteur",
    "gland",    "led",         "module",    "modul",   "fan",    "luefter",   "sensor"};

// What is drawn around a bought unit, or a collection of loose parts.
constexpr std::array<std::string_view, 60> kOtherWords{
    "guard",   "grill",     "grille",   "shroud",  "duct",     "stand",     "lid",     "tray",
    "carrier", "carriage",  "rail",     "base",    "mount",    "mounting",  "bracket", "holder",
    "halter",  "halterung", "support",  "adapter", "adaptor",  "plate",     "platte",  "cover",
    "deckel",  "housing",   "gehaeuse", "case",    "box",      "enclosure", "clamp",   "block",
    "bock",    "frame",     "rahmen",   "arm",     "horn",     "hub",       "cap",     "spacer",
    "screw",   "bolt",      "nut",      "washer",  "schraube", "mutter",    "kit",     "set",
    "seat",    "shaft",     "welle",    "hole",    "tool",     "cage",      "puller",  "press",
    "brk",     "hinge",     "bezel",    "panel"};

// What is put on the shaft of a bought unit afterwards.
constexpr std::array<std::string_view, 14> kMountedWords{
    "horn",     "ruderhorn", "servohorn", "palonnier", "arm",      "pulley",  "riemenscheibe",
    "sprocket", "propeller", "prop",      "coupling",  "kupplung", "coupler", "wheel"};

constexpr std::array<std::string_view, 7> kAssemblyWords{
    "assembly", "assy", "asm", "assem", "baugruppe", "ensamblaje", "assemblage"};

// Suffixes of seals and shields of rolling bearings.
constexpr std::array<std::string_view, 12> kSealWords{"zz", "z",   "rs",  "rz",  "dd", "llu",
                                                      "vv", "ddu", "rsr", "rsh", "uu", "lb"};

bool IsAlone(const std::string& text, const Word& token) {
  return (token.begin == 0 || !IsLetter(text[token.begin - 1])) &&
         (token.end >= text.size() || !IsLetter(text[token.end]));
}

/** Numbers of deep groove ball bearings (ISO 15): 604 to 609, 623 to 629, 634 to 639, 683 to 689,
 693 to 699, and 6000 to 6320, 6700 to 6912 with two digits for the bore. */
bool IsBearingNumber(const std::string& digits) {
  if (digits.size() == 3) {
    const std::string series = digits.substr(0, 2);
    return (series == "60" || series == "62" || series == "63" || series == "68" ||
            series == "69") &&
           digits[2] >= '3';
  }
  if (digits.size() != 4 || digits[0] != '6') {
    return false;
  }
  const std::string series = digits.substr(0, 2);
  const bool is_series = series == "60" || series == "62" || series == "63" || series == "67" ||
                         series == "68" || series == "69";
  return is_series && digits.substr(2) <= "20";
}

/** "608zz", "6204-2rs", "f688zz", "mr105", "lm8uu", "lmk12luu". */
bool IsBearing(const std::string& text, const std::vector<Word>& tokens) {
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const Word& token = tokens[i];
    const Word* next = i + 1 < tokens.size() ? &tokens[i + 1] : nullptr;
    const bool is_number_next =
        next != nullptr && IsDigit(next->text.front()) && next->begin == token.end;
    if ((token.text == "mr" || token.text == "smr") && is_number_next && next->text.size() >= 2 &&
        next->text.size() <= 3 && IsAlone(text, token)) {
      return true;
    }
    if ((token.text == "lm" || token.text == "lmk" || token.text == "lmf" || token.text == "lmh") &&
        is_number_next && i + 2 < tokens.size() &&
        (tokens[i + 2].text == "uu" || tokens[i + 2].text == "luu")) {
      return true;
    }
    if (!IsBearingNumber(token.text)) {
      continue;
    }
    // A number alone may be anything: the seals have to follow, or the f of a flange to precede.
    const bool has_flange = i > 0 && tokens[i - 1].text == "f" && tokens[i - 1].end == token.begin;
    const Word* seal = next;
    if (seal != nullptr && (seal->text == "2" || seal->text == "1") && i + 2 < tokens.size()) {
      seal = &tokens[i + 2];
    }
    const bool has_seal =
        seal != nullptr && seal->begin <= token.end + 3 && IsOneOf(kSealWords, seal->text);
    if (has_flange || has_seal) {
      return true;
    }
  }
  return false;
}

/** Hobby and robot servos: "sg90", "mg996r", "ds3218", "xl-330", "ax12". */
bool IsServo(const std::string& text, const std::vector<Word>& tokens) {
  constexpr std::array<std::string_view, 12> kSeries{"sg", "mg", "ds", "xl", "xc", "xm",
                                                     "xh", "xw", "ax", "mx", "hs", "sts"};
  for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
    const Word& number = tokens[i + 1];
    const bool is_near = number.begin <= tokens[i].end + 1;
    const bool is_size = number.text.size() >= 2 && number.text.size() <= 4;
    const bool starts = tokens[i].begin == 0 || !IsLetter(text[tokens[i].begin - 1]);
    if (!is_near || !is_size || !starts || !IsDigit(number.text.front()) ||
        std::find(kSeries.begin(), kSeries.end(), tokens[i].text) == kSeries.end()) {
      continue;
    }
    const std::string_view series = tokens[i].text;
    const std::string_view n = number.text;
    const bool is_robotic =
        series.front() == 'x' && (n == "320" || n == "330" || n == "430" || n == "540");
    const bool is_hobby = (series == "sg" && (n == "90" || n == "92" || n == "5010")) ||
                          (series == "mg" && (n == "90" || n == "92" || n.substr(0, 2) == "99")) ||
                          (series == "ds" && n.size() == 4 && n.front() == '3') ||
                          (series == "ax" && (n == "12" || n == "18")) ||
                          (series == "mx" && (n == "28" || n == "64" || n == "106")) ||
                          (series == "sts" && n.size() == 4) || (series == "hs" && n.size() == 3);
    if (is_robotic || is_hobby) {
      return true;
    }
  }
  return false;
}

}  // namespace

BoughtName ClassifyBoughtName(std::string_view name) {
  const std::string text = FoldName(name);
  const std::vector<Word> tokens = SplitWords(text);
  bool is_assembly = false;
  bool has_bought_word = false;
  bool has_word = false;
  for (const Word& token : tokens) {
    if (IsOneOf(kOtherWords, token.text)) {
      return BoughtName::kNone;
    }
    is_assembly = is_assembly || IsOneOf(kAssemblyWords, token.text);
    has_bought_word = has_bought_word || IsOneOf(kBoughtWords, token.text);
    has_word = has_word || IsOneOf(kWords, token.text);
  }
  if (has_bought_word || IsBearing(text, tokens) || IsServo(text, tokens)) {
    return BoughtName::kDesignation;
  }
  return has_word && !is_assembly ? BoughtName::kWord : BoughtName::kNone;
}

bool IsMountedOnUnit(std::string_view name) {
  return HasOneOf(FoldName(name), kMountedWords);
}

bool IsServoName(std::string_view name) {
  constexpr std::array<std::string_view, 3> kServos{"servo", "servomotor", "dynamixel"};
  const std::string text = FoldName(name);
  return HasOneOf(text, kServos) || IsServo(text, SplitWords(text));
}

bool IsReferenceDesignator(std::string_view name) {
  constexpr std::array<std::string_view, 28> kLetters{
      "r",  "c",   "l",  "u",  "q",  "d",  "x",  "y",  "j",  "p",  "k",  "f",   "t",    "ic",
      "cn", "con", "sw", "tp", "rn", "fb", "bt", "ds", "jp", "rv", "vr", "led", "xtal", "ant"};
  const std::string text = FoldName(name);
  const std::vector<Word> tokens = SplitWords(text);
  return tokens.size() > 1 && tokens[0].begin == 0 && tokens[1].begin == tokens[0].end &&
         IsDigit(tokens[1].text.front()) && tokens[1].text.size() <= 4 &&
         std::find(kLetters.begin(), kLetters.end(), tokens[0].text) != kLetters.end();
}

bool IsCircuitBoard(std::string_view name) {
  const std::string text = FoldName(name);
  if (text.starts_with("board") || text.starts_with("pcb")) {
    return true;
  }
  constexpr std::array<std::string_view, 5> kBoards{"board", "pcb", "platine", "leiterplatte",
                                                    "pcba"};
  const std::vector<Word> tokens = SplitWords(text);
  return std::any_of(tokens.begin(), tokens.end(), [&kBoards](const Word& token) {
    return std::find(kBoards.begin(), kBoards.end(), token.text) != kBoards.end();
  });
}

}  // namespace hvas::product
