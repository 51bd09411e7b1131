#include "fits/materials.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace hvas::fits {
namespace {

std::string NameFor(std::string_view text) {
  const auto match = FindMaterial(text);
  return match ? std::string(match->material->name) : "";
}

TEST(Materials, AreFortyWithValuesOfSolids) {
  EXPECT_EQ(Materials().size(), 40u);
  std::set<std::string_view> names;
  for (const Material& m : Materials()) {
    SCOPED_TRACE(m.name);
    EXPECT_TRUE(names.insert(m.name).second);
    EXPECT_GT(m.poisson_ratio, 0.2);
    EXPECT_LT(m.poisson_ratio, 0.5);
    EXPECT_GE(m.tensile_strength, m.yield_strength);
    // The yield strain of what machines are made of is between 0.05 % and 4 %.
    EXPECT_GT(m.yield_strength / m.youngs_modulus, 5e-4);
    EXPECT_LT(m.yield_strength / m.youngs_modulus, 4e-2);
    // Stiff materials expand little: E times expansion is within a factor of 30 for metals and
    // plastics alike (Ashby, Materials Selection in Mechanical Design, chart of E and alpha).
    EXPECT_GT(m.youngs_modulus * m.thermal_expansion, 5e4);
    EXPECT_LT(m.youngs_modulus * m.thermal_expansion, 4e6);
  }
}

// Alloying and heat treatment change the strength of a metal by much, its stiffness, density and
// expansion by little (Ashby, Materials Selection in Mechanical Design, appendix A: classes).
TEST(Materials, AreAsStiffAndDenseAndExpandAsTheirClass) {
  struct Class {
    const char* word;  // Of the group or, for a plastic, the name.
    double modulus_gpa;
    double spread;  // Of the modulus, as a share.
    double density;
    double expansion_um;  // For each metre and kelvin.
  };

  constexpr std::array kClasses{
      Class{"steel", 205, 0.1, 7850, 13.5},      Class{"grey iron", 110, 0.25, 7150, 11},
      Class{"ductile iron", 170, 0.1, 7150, 12}, Class{"aluminium bronze", 118, 0.1, 7600, 16.5},
      Class{"aluminium", 72, 0.1, 2730, 22.5},   Class{"copper", 120, 0.1, 8930, 17},
      Class{"brass", 105, 0.1, 8450, 20},        Class{"bronze", 108, 0.12, 8750, 18},
      Class{"titanium", 108, 0.1, 4450, 9},      Class{"magnesium", 45, 0.1, 1800, 26},
      Class{"nickel", 207, 0.1, 8300, 13},       Class{"zinc", 90, 0.15, 6600, 27},
      Class{"POM", 2.8, 0.2, 1410, 110},         Class{"PA66", 3, 0.2, 1140, 80},
      Class{"PEEK", 3.7, 0.2, 1310, 50},         Class{"PTFE", 0.5, 0.2, 2170, 130}};
  for (const Material& m : Materials()) {
    SCOPED_TRACE(m.name);
    const std::string_view text = m.group == "polymer" ? m.name : m.group;
    const auto* of = std::find_if(kClasses.begin(), kClasses.end(), [&](const Class& c) {
      return text.find(c.word) != std::string_view::npos;
    });
    ASSERT_NE(of, kClasses.end());
    EXPECT_NEAR(1e-9 * m.youngs_modulus, of->modulus_gpa, of->spread * of->modulus_gpa);
    EXPECT_NEAR(m.density, of->density, 0.03 * of->density);
    EXPECT_NEAR(1e6 * m.thermal_expansion, of->expansion_um, 0.3 * of->expansion_um);
  }
}

TEST(Materials, HaveThePublishedValuesOfTheirStandards) {
  // EN 10025-2 for 16 mm; EN 755-2 and ASTM B209 (6061-T6: 40 ksi, 45 ksi); AMS 4928 for Ti-6Al-4V.
  const Material& steel = DefaultMaterial();
  EXPECT_EQ(steel.name, "S235JR");
  EXPECT_EQ(steel.yield_strength, 235e6);
  EXPECT_EQ(steel.tensile_strength, 360e6);
  const Material& aluminium = *FindMaterial("6061-T6")->material;
  EXPECT_NEAR(aluminium.yield_strength, 40 * 6.894757e6, 0.01 * 276e6);
  EXPECT_NEAR(aluminium.tensile_strength, 45 * 6.894757e6, 0.01 * 310e6);
  EXPECT_NEAR(FindMaterial("Ti-6Al-4V")->material->density, 4430, 1);
}

TEST(FindMaterial, KnowsEveryNameOfItsOwnTable) {
  for (const Material& m : Materials()) {
    EXPECT_EQ(NameFor(m.name), m.name);
  }
}

TEST(FindMaterial, KnowsDesignationsInAnySpelling) {
  for (const char* text :
       {"AISI 304", "aisi304", "1.4301", "X5CrNi18-10", "Stainless Steel", "SS304", "Edelstahl",
        "Stainless Steel AISI 304", "Inox", "steel, stainless"}) {
    EXPECT_EQ(NameFor(text), "1.4301 (304)") << text;
  }
  for (const char* text : {"Aluminum 6061-T6", "Aluminum", "ALUMINIUM", "EN AW-6061 T6", "Al6061",
                           "6061 Alloy", "Alu", "Алюминий"}) {
    EXPECT_EQ(NameFor(text), "AW-6061 T6") << text;
  }
  for (const char* text : {"Steel", "STEEL", "Stahl", "S235JR", "St 37-2", "1.0038", "ASTM A36",
                           "Steel - Satin", "Plain Carbon Steel", "Сталь", "鋼"}) {
    EXPECT_EQ(NameFor(text), "S235JR") << text;
  }
  EXPECT_EQ(NameFor("Aluminum 7075-T6"), "AW-7075 T6");
  EXPECT_EQ(NameFor("stainless steel 316L"), "1.4401 (316)");
  EXPECT_EQ(NameFor("Steel AISI 4140"), "42CrMo4 Q&T");
  EXPECT_EQ(NameFor("C45"), "C45 (1045) Q&T");
  EXPECT_EQ(NameFor("Brass, polished"), "CuZn37");
  EXPECT_EQ(NameFor("Cast Iron"), "EN-GJL-250");
  EXPECT_EQ(NameFor("Titanium"), "Ti-6Al-4V");
  EXPECT_EQ(NameFor("Titanium Grade 2"), "Ti Grade 2");
  EXPECT_EQ(NameFor("Delrin"), "POM-C");
  EXPECT_EQ(NameFor("Nylon 6/6"), "PA66 dry");
  EXPECT_EQ(NameFor("Aluminium Bronze"), "CuAl10Ni");
}

TEST(FindMaterial, TakesAPlasticForAPlasticAndSaysSo) {
  for (const char* text : {"ABS", "ABS Plastic", "PLA", "PETG", "Plastic - Matte (Black)"}) {
    const auto match = FindMaterial(text);
    ASSERT_TRUE(match.has_value()) << text;
    EXPECT_EQ(match->material->group, "polymer");
    EXPECT_TRUE(match->is_stand_in);
  }
  EXPECT_FALSE(FindMaterial("PEEK")->is_stand_in);
}

TEST(FindMaterial, FindsNothingInRubbish) {
  for (const char* text : {"",          "Document",        "Default",     "Unknown", "Generic",
                           "Material",  "<not specified>", "none",        "Part1",   "Body 304b5",
                           "Steelcase", "Placement",       "absolute",    "Popular", "Ferrari",
                           "Aluminati", "material<1>",     "Untitled v3", "M3x16",   "42",
                           "\xff\xfe"}) {
    EXPECT_EQ(NameFor(text), "") << text;
  }
}

TEST(FindMaterialByDensity, KnowsFamilies) {
  const auto name_for = [](double density) {
    const auto match = FindMaterialByDensity(density);
    return match ? std::string(match->material->name) : "";
  };
  EXPECT_EQ(name_for(7850), "S235JR");
  EXPECT_EQ(name_for(7870), "S235JR");
  EXPECT_EQ(name_for(7930), "1.4301 (304)");
  EXPECT_EQ(name_for(2710), "AW-6061 T6");
  EXPECT_EQ(name_for(8500), "CuZn37");
  EXPECT_EQ(name_for(1420), "POM-C");
  EXPECT_EQ(name_for(1050), "PA66 dry");
  EXPECT_TRUE(FindMaterialByDensity(1050)->is_stand_in);
  EXPECT_FALSE(FindMaterialByDensity(1140)->is_stand_in);
  EXPECT_EQ(name_for(19300), "");
  EXPECT_EQ(name_for(3500), "");
}

}  // namespace
}  // namespace hvas::fits
