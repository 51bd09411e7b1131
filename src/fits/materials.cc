#include "fits/materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace hvas::fits {
namespace {

constexpr std::array<Material, 40> kMaterials{{
    // clang-format off
    {"S235JR", "structural steel", 210e9, 0.3, 7850, 235e6, 360e6, 12e-6, ""},
    {"S355JR", "structural steel", 210e9, 0.3, 7850, 355e6, 470e6, 12e-6, "start of the range of EN 10025-2; tensile: 510 or 470 MPa"},
    {"C22E (1020) norm.", "carbon steel", 210e9, 0.3, 7850, 240e6, 430e6, 12e-6, "yield: 240 or 340 MPa; tensile: 430 or 500 MPa; expansion: 12 or 11.7e-6/K"},
    {"C45 (1045) norm.", "carbon steel", 210e9, 0.3, 7850, 340e6, 620e6, 12e-6, "one source"},
    {"C45 (1045) Q&T", "carbon steel", 210e9, 0.3, 7850, 490e6, 700e6, 12e-6, "expansion: 12 or 11.5e-6/K"},
    {"C60 Q&T", "carbon steel", 210e9, 0.3, 7850, 580e6, 850e6, 12e-6, "expansion: 12 or 11.1e-6/K"},
    {"42CrMo4 Q&T", "alloy steel", 210e9, 0.3, 7850, 750e6, 1000e6, 12e-6, "yield: 750 or 900 MPa; tensile: 1000 or 1100 MPa; expansion: 12 or 12.3e-6/K; depends on the size"},
    {"34CrNiMo6 Q&T", "alloy steel", 210e9, 0.3, 7850, 900e6, 1100e6, 12e-6, "yield: 900 or 1000 MPa; tensile: 1100 or 1200 MPa; expansion: 12 or 12.5e-6/K; depends on the size"},
    {"16MnCr5", "case-hardening steel", 210e9, 0.3, 7850, 590e6, 780e6, 12e-6, "yield: 635 or 590 MPa; tensile: 900 or 780 MPa; expansion: 12 or 11e-6/K; case-hardened and core"},
    {"20MnCr5", "case-hardening steel", 210e9, 0.3, 7850, 685e6, 1000e6, 12e-6, "yield: 700 or 685 MPa; expansion: 12 or 11e-6/K"},
    {"51CrV4 Q&T", "spring steel", 210e9, 0.3, 7850, 900e6, 1100e6, 12e-6, "yield: 900 or 1200 MPa; tensile: 1100 or 1350 MPa"},
    {"1.4301 (304)", "stainless steel", 200e9, 0.3, 7900, 210e6, 520e6, 17e-6, "E and density of EN 10088-1; E: 193 or 200 GPa; expansion: 17 or 16e-6/K"},
    {"1.4401 (316)", "stainless steel", 193e9, 0.29, 8000, 220e6, 530e6, 16e-6, "E: 193 or 200 GPa; expansion: 16 or 16.5e-6/K"},
    {"1.4462 (duplex 2205)", "stainless steel", 200e9, 0.3, 7800, 450e6, 640e6, 13e-6, "yield: 450 or 460 MPa"},
    {"1.4542 (17-4PH)", "stainless steel", 196e9, 0.29, 7800, 1000e6, 1070e6, 10.8e-6, "yield: 1170 or 1000 MPa; tensile: 1310 or 1070 MPa; tempers H900 and H1025"},
    {"GE240 cast steel", "cast steel", 210e9, 0.3, 7850, 240e6, 450e6, 12e-6, "one source"},
    {"EN-GJL-250", "grey iron", 110e9, 0.26, 7200, 165e6, 250e6, 10.5e-6, "brittle: yield is a proof stress at 0.1 %; E falls with stress; expansion: 10.5 or 11.7e-6/K"},
    {"EN-GJS-400-15", "ductile iron", 169e9, 0.275, 7100, 250e6, 400e6, 11e-6, "expansion: 11 or 12.5e-6/K"},
    {"EN-GJS-500-7", "ductile iron", 169e9, 0.275, 7100, 320e6, 500e6, 12.5e-6, "one source"},
    {"EN-GJS-600-3", "ductile iron", 174e9, 0.275, 7200, 370e6, 600e6, 11e-6, "expansion: 11 or 12.5e-6/K"},
    {"AW-6061 T6", "wrought aluminium", 68.9e9, 0.33, 2700, 276e6, 310e6, 23.6e-6, ""},
    {"AW-6082 T6", "wrought aluminium", 70e9, 0.33, 2700, 260e6, 310e6, 23.6e-6, "expansion: 23.6 or 23.1e-6/K"},
    {"AW-7075 T6", "wrought aluminium", 71.7e9, 0.33, 2810, 503e6, 572e6, 23.4e-6, ""},
    {"AW-2024", "wrought aluminium", 73.1e9, 0.33, 2780, 324e6, 469e6, 23.2e-6, "yield: 345 or 324 MPa; tensile: 483 or 469 MPa; temper T3 or T4"},
    {"AlSi9Cu3", "cast aluminium", 75e9, 0.33, 2750, 140e6, 240e6, 21e-6, "one source"},
    {"AlSi10Mg T6", "cast aluminium", 71e9, 0.33, 2650, 220e6, 290e6, 21e-6, "one source"},
    {"Cu-ETP", "copper", 117e9, 0.34, 8940, 70e6, 220e6, 16.5e-6, "yield: 70 or 250 MPa; tensile: 220 or 300 MPa; expansion: 16.5 or 17e-6/K; annealed and hard"},
    {"CuZn37", "brass", 110e9, 0.34, 8440, 200e6, 340e6, 20.3e-6, "E: 110 or 100 GPa; tensile: 380 or 340 MPa"},
    {"CuSn8", "bronze", 115e9, 0.34, 8800, 350e6, 470e6, 18.5e-6, "one source"},
    {"CuSn12 cast", "bronze", 100e9, 0.35, 8700, 150e6, 280e6, 18e-6, "one source"},
    {"CuAl10Ni", "aluminium bronze", 115e9, 0.32, 7600, 270e6, 620e6, 16e-6, "E: 115 or 122 GPa; yield: 270 or 300 MPa; tensile: 620 or 680 MPa"},
    {"Ti-6Al-4V", "titanium", 113.8e9, 0.342, 4430, 880e6, 950e6, 8.6e-6, ""},
    {"Ti Grade 2", "titanium", 105e9, 0.34, 4510, 275e6, 345e6, 8.6e-6, ""},
    {"AZ91D", "magnesium", 45e9, 0.35, 1810, 160e6, 230e6, 26e-6, "one source"},
    {"Inconel 718", "nickel", 200e9, 0.294, 8190, 1034e6, 1276e6, 13e-6, "one source"},
    {"ZAMAK 5", "zinc die cast", 96e9, 0.29, 6700, 270e6, 330e6, 27.4e-6, "one source"},
    {"POM-C", "polymer", 2.8e9, 0.35, 1410, 65e6, 65e6, 110e-6, "yield: 67 or 65 MPa; tensile: 67 or 65 MPa; at about 2 % strain"},
    {"PA66 dry", "polymer", 3.1e9, 0.39, 1140, 82e6, 82e6, 80e-6, "E: 3.1 or 3.3 GPa; yield: 82 or 85 MPa; tensile: 82 or 85 MPa"},
    {"PEEK", "polymer", 3.6e9, 0.38, 1320, 97e6, 97e6, 47e-6, "E: 3.6 or 3.7 GPa; yield: 97 or 100 MPa; tensile: 97 or 100 MPa"},
    {"PTFE", "polymer", 0.5e9, 0.46, 2200, 12e6, 12e6, 135e-6, "yield: 15 or 12 MPa; tensile: 25 or 12 MPa; expansion: 135 or 130e-6/K"},
    // clang-format on
}};

/** Names that mean a material, separated by bars; matched token by token. */
struct Aliases {
  std::string_view material;  // In kMaterials.
  std::string_view names;
  bool is_stand_in{false};
};

// Families stand with the grade that is most usual for them in machines.
constexpr std::array<Aliases, 44> kAliases{{
    {"S235JR",
     "steel|stahl|acier|acciaio|acero|aco|staal|stal|ocel|celik|сталь|Сталь|鋼|钢|鋼材|mild steel|"
     "plain carbon steel|low carbon steel|carbon steel|structural steel|baustahl|steel generic|"
     "S235|S235JR|S235J2|St37|St 37-2|RSt37|1.0037|1.0038|A36|ASTM A36|SS400|Q235|Fe360|iron|eisen|"
     "fer|ferro|steel galvanized|galvanized steel"},
    {"S355JR", "S355|S355JR|S355J0|S355J2|St52|St 52-3|1.0045|1.0570|1.0577|A572|Q345|Q355|Fe510"},
    {"C22E (1020) norm.",
     "C22|C22E|Ck22|1.1151|1.0402|AISI 1020|SAE 1020|1020 steel|steel 1020|AISI 1018|SAE 1018|"
     "1018 steel|steel 1018|C15|C20|S20C"},
    {"C45 (1045) norm.", "C45 normalised|C45 normalized|C45+N|1045 normalized|C45 norm"},
    {"C45 (1045) Q&T",
     "C45|C45E|Ck45|1.0503|1.1191|AISI 1045|SAE 1045|1045 steel|steel 1045|S45C|сталь 45|Сталь 45"},
    {"C60 Q&T", "C60|C60E|Ck60|1.0601|1.1221|AISI 1060|SAE 1060"},
    {"42CrMo4 Q&T",
     "42CrMo4|1.7225|AISI 4140|SAE 4140|4140 steel|steel 4140|4140|SCM440|alloy steel|"
     "legierter stahl|8.8|10.9|12.9|40Х"},
    {"34CrNiMo6 Q&T", "34CrNiMo6|1.6582|AISI 4340|SAE 4340|4340 steel|4340"},
    {"16MnCr5", "16MnCr5|1.7131|AISI 5115|SAE 5115|case hardening steel|einsatzstahl"},
    {"20MnCr5", "20MnCr5|1.7147|AISI 5120|SAE 5120"},
    {"51CrV4 Q&T",
     "51CrV4|50CrV4|1.8159|AISI 6150|SAE 6150|spring steel|federstahl|music wire|piano wire|100Cr6|"
     "1.3505|AISI 52100|SAE 52100|bearing steel|chrome steel|GCr15|SUJ2"},
    {"1.4301 (304)",
     "1.4301|1.4307|1.4305|1.4303|X5CrNi18-10|X2CrNi18-9|X8CrNiS18-9|AISI 304|AISI "
     "303|304L|304|303|"
     "SS304|SUS304|SUS303|A2|A2-70|A2-80|18-8|stainless|stainless steel|inox|edelstahl|nirosta|"
     "rostfreier stahl|acier inoxydable|acciaio inossidabile|acciaio inox|acero inoxidable|"
     "нержавеющая сталь|Нержавеющая сталь|ステンレス|不锈钢"},
    {"1.4401 (316)",
     "1.4401|1.4404|1.4571|X5CrNiMo17-12-2|X2CrNiMo17-12-2|AISI 316|316L|316|SS316|SUS316|A4|A4-70|"
     "A4-80|marine grade stainless"},
    {"1.4462 (duplex 2205)",
     "1.4462|duplex|duplex 2205|2205|X2CrNiMoN22-5-3|UNS S31803|UNS S32205"},
    {"1.4542 (17-4PH)", "1.4542|1.4548|17-4PH|17-4 PH|AISI 630|X5CrNiCuNb16-4|UNS S17400|SUS630"},
    {"GE240 cast steel", "GE240|GS-45|1.0446|cast steel|stahlguss|cast carbon steel|steel cast"},
    {"EN-GJL-250",
     "GJL-250|EN-GJL-250|GG25|GG-25|EN-JL1040|5.1301|grey cast iron|gray cast iron|grey iron|"
     "gray iron|cast iron|gusseisen|grauguss|fonte|ghisa|чугун|Чугун|iron cast|FC250|HT250"},
    {"EN-GJS-400-15",
     "GJS-400|GJS-400-15|GJS-400-18|GGG40|GGG-40|ductile iron|ductile cast iron|nodular iron|"
     "sphäroguss|kugelgraphitguss"},
    {"EN-GJS-500-7", "GJS-500|GJS-500-7|GGG50|GGG-50"},
    {"EN-GJS-600-3", "GJS-600|GJS-600-3|GGG60|GGG-60"},
    {"AW-6061 T6",
     "AW-6061|6061|6061-T6|Al6061|Al Mg1SiCu|AlMg1SiCu|3.3211|aluminium|aluminum|alu|alluminio|"
     "aluminio|алюминий|Алюминий|アルミ|铝|铝合金|aluminium alloy|aluminum alloy|aluminum generic|"
     "anodized aluminum|anodised aluminium"},
    {"AW-6082 T6",
     "AW-6082|6082|6082-T6|AlSi1MgMn|AlMgSi1|3.2315|AW-6060|6060|AW-6063|6063|6063-T5|6063-T6|"
     "AlMgSi0,5|AlMgSi|3.3206|AW-5083|5083|AW-5754|5754|AlMg3|3.3535|5052|5052-H32"},
    {"AW-7075 T6", "AW-7075|7075|7075-T6|7075-T651|AlZn5.5MgCu|AlZnMgCu1.5|3.4365|ergal|fortal"},
    {"AW-2024",
     "AW-2024|2024-T3|2024-T4|2024-T351|Al2024|aluminum 2024|aluminium 2024|2024 aluminum|AlCu4Mg1|"
     "3.1355|AW-2017|2017A|AlCu4MgSi|3.1325|duralumin|dural|duraluminium"},
    {"AlSi9Cu3",
     "AlSi9Cu3|EN AC-46000|AC-46000|A380|ADC12|die cast aluminum|die cast aluminium|"
     "aluminum die cast|aluminiumguss|cast aluminum|cast aluminium|aluminum cast|aluminium cast"},
    {"AlSi10Mg T6", "AlSi10Mg|AC-43000|A360|3.2381|A356|AlSi7Mg"},
    {"Cu-ETP",
     "copper|kupfer|cuivre|rame|cobre|медь|Медь|銅|铜|Cu-ETP|CW004A|C11000|C110|E-Cu|2.0060"},
    {"CuZn37",
     "brass|messing|laiton|ottone|laton|латунь|Латунь|真鍮|黄铜|CuZn37|CuZn39Pb3|CuZn40Pb2|"
     "CuZn38Pb2|Ms58|"
     "CW508L|CW614N|CW617N|C36000|C360|C260|2.0321|2.0401"},
    {"CuSn8",
     "bronze|phosphor bronze|bronzo|бронза|Бронза|CuSn8|CuSn6|CW453K|C52100|C51000|2.1030|bronce"},
    {"CuSn12 cast", "CuSn12|CC483K|G-CuSn12|CuSn7ZnPb|Rg7|rotguss|C93200|SAE 660|gunmetal"},
    {"CuAl10Ni", "CuAl10Ni|CuAl10Ni5Fe4|CW307G|aluminium bronze|aluminum bronze|C63000|2.0966"},
    {"Ti-6Al-4V",
     "Ti-6Al-4V|Ti6Al4V|TiAl6V4|3.7165|3.7164|grade 5 titanium|titanium grade 5|titanium|titan|"
     "titane|titanio|титан|Титан|チタン|钛"},
    {"Ti Grade 2",
     "titanium grade 2|grade 2 titanium|Ti Grade 2|Ti Gr 2|3.7035|pure titanium|cp titanium"},
    {"AZ91D", "AZ91|AZ91D|magnesium|magnesium alloy|магний|AZ31|AZ31B"},
    {"Inconel 718", "inconel|inconel 718|alloy 718|2.4668|NiCr19NbMo|UNS N07718|nickel alloy"},
    {"ZAMAK 5", "zamak|zamak 5|zamak 3|zinc|zink|zinc die cast|ZnAl4Cu1|ZL0410|ZP5|ZP3"},
    {"POM-C",
     "POM|POM-C|POM-H|delrin|acetal|acetal resin|polyoxymethylene|polyoxymethylen|polyacetal|"
     "hostaform"},
    {"PA66 dry",
     "PA66|PA 6.6|PA6|PA6.6|PA12|PA11|nylon|nylon 6/6|nylon 6|nylon 12|nylon "
     "101|polyamide|polyamid|"
     "ultramid|zytel|полиамид"},
    {"PEEK", "PEEK|polyetheretherketone|victrex"},
    {"PTFE", "PTFE|teflon|polytetrafluoroethylene|фторопласт"},
    {"PA66 dry",
     "ABS|ABS plastic|acrylonitrile butadiene styrene|PLA|polylactic acid|PETG|PET|ASA|HIPS|"
     "polycarbonate|PC ABS|makrolon|lexan|acrylic|PMMA|plexiglas|plexiglass|plastic|plastics|"
     "kunststoff|polypropylene|polypropylen|HDPE|LDPE|polyethylene|polyethylen|plastique|plastica|"
     "пластик|Пластик|пластмасса|polymer|polystyrene|PVC|"
     "polyvinyl chloride|epoxy|resin|photopolymer|PBT|PPS|PSU|PEI|ultem|nylon carbon "
     "fiber|PA66GF30|PA66 GF30|PA6GF30|PA6 GF30|PA12GF30",
     true},
    {"POM-C", "FR4|FR-4|PCB laminate", true},
    {"PTFE", "FEP|PFA|PVDF", true},
    {"S235JR", "spring wire|tool steel|werkzeugstahl|HSS|high speed steel|maraging", true},
}};

char ToLower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

enum class CharKind { kBreak, kLetter, kDigit };

CharKind KindOf(char c) {
  if (c >= '0' && c <= '9') {
    return CharKind::kDigit;
  }
  const bool is_ascii = static_cast<unsigned char>(c) < 0x80;
  const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  return is_letter || !is_ascii ? CharKind::kLetter : CharKind::kBreak;
}

/** A word or a number of a name, in lower case. */
struct Token {
  std::string text;
  bool is_glued{false};  // To the next one: 304 in "304b5".

  bool operator==(const std::string& other) const { return text == other; }
};

/** "EN AW-6061T6" has en, aw, 6061, t and 6. */
std::vector<Token> Tokenise(std::string_view name) {
  std::vector<Token> tokens;
  CharKind last = CharKind::kBreak;
  for (const char c : name) {
    const CharKind kind = KindOf(c);
    if (kind != CharKind::kBreak) {
      if (kind != last) {
        if (last != CharKind::kBreak) {
          tokens.back().is_glued = true;
        }
        tokens.emplace_back();
      }
      tokens.back().text.push_back(ToLower(c));
    }
    last = kind;
  }
  return tokens;
}

struct Alias {
  std::vector<std::string> tokens;
  std::size_t length{0};  // Of all its tokens.
  MaterialMatch match;
};

const Material* FindByName(std::string_view name) {
  const auto found = std::find_if(kMaterials.begin(), kMaterials.end(),
                                  [name](const Material& m) { return m.name == name; });
  return found != kMaterials.end() ? found : nullptr;
}

void AddAlias(std::string_view name, const MaterialMatch& match, std::vector<Alias>* aliases) {
  Alias alias;
  alias.match = match;
  for (Token& token : Tokenise(name)) {
    alias.length += token.text.size();
    alias.tokens.push_back(std::move(token.text));
  }
  aliases->push_back(std::move(alias));
}

std::vector<Alias> MakeAliases() {
  std::vector<Alias> aliases;
  for (const Material& material : kMaterials) {
    AddAlias(material.name, {&material, false}, &aliases);
  }
  for (const Aliases& entry : kAliases) {
    const MaterialMatch match{FindByName(entry.material), entry.is_stand_in};
    for (std::string_view rest = entry.names; !rest.empty();) {
      const std::size_t bar = rest.find('|');
      AddAlias(rest.substr(0, bar), match, &aliases);
      rest = bar == std::string_view::npos ? std::string_view() : rest.substr(bar + 1);
    }
  }
  return aliases;
}

bool HasDigits(const Alias& alias) {
  return std::any_of(alias.tokens.begin(), alias.tokens.end(), [](const std::string& token) {
    return KindOf(token.front()) == CharKind::kDigit;
  });
}

/** A designation says more than a family ("stainless steel 316L"), and of two of a kind the longer
 one does. */
bool IsMoreSpecific(const Alias& a, const Alias& b) {
  if (HasDigits(a) != HasDigits(b)) {
    return HasDigits(a);
  }
  return a.length > b.length;
}

}  // namespace

std::span<const Material> Materials() {
  return kMaterials;
}

const Material& DefaultMaterial() {
  return kMaterials.front();
}

std::optional<MaterialMatch> FindMaterial(std::string_view name) {
  static const std::vector<Alias> known = MakeAliases();
  const std::vector<Token> tokens = Tokenise(name);
  const Alias* best = nullptr;
  for (const Alias& alias : known) {
    const auto found =
        std::search(tokens.begin(), tokens.end(), alias.tokens.begin(), alias.tokens.end());
    if (found == tokens.end() || (best != nullptr && !IsMoreSpecific(alias, *best))) {
      continue;
    }
    if (!(found + static_cast<std::ptrdiff_t>(alias.tokens.size()) - 1)->is_glued) {
      best = &alias;
    }
  }
  return best != nullptr ? std::optional(best->match) : std::nullopt;
}

std::optional<MaterialMatch> FindMaterialByDensity(double density) {
  constexpr double kNear = 0.04;  // Relative: alloys of a family differ by less. A choice.
  // [kg/m^3]; magnesium, the lightest metal of the table, has more: a choice.
  constexpr double kHeaviestPlastic = 1700;
  // The usual one of each family; light alloys, irons and plastics are told apart by density.
  constexpr std::array<std::string_view, 14> kUsual{
      "S235JR", "AW-6061 T6", "1.4301 (304)", "CuZn37", "Cu-ETP", "Ti-6Al-4V", "EN-GJL-250",
      "POM-C",  "PA66 dry",   "PEEK",         "PTFE",   "AZ91D",  "ZAMAK 5",   "Inconel 718"};
  const Material* nearest = nullptr;
  for (const std::string_view name : kUsual) {
    const Material* material = FindByName(name);
    if (nearest == nullptr ||
        std::abs(material->density - density) < std::abs(nearest->density - density)) {
      nearest = material;
    }
  }
  if (std::abs(nearest->density - density) <= kNear * density) {
    return MaterialMatch{nearest, false};
  }
  if (density > 0 && density < kHeaviestPlastic) {
    return MaterialMatch{FindByName("PA66 dry"), true};
  }
  return std::nullopt;
}

}  // namespace hvas::fits
