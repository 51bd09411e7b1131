#include "product/fastener_name.h"

#include <gtest/gtest.h>

namespace hvas::product {
namespace {

TEST(ClassifyName, TellsFastenersFromWhatOnlyGoesWithThem) {
  for (const char* name : {"HexNut", "Sechskantmutter M8", "tuerca", "\u00e9crou", "Insert",
                           "M3 insert", "knurled insert 4.2", "DIN934-M6", "din_985"}) {
    EXPECT_EQ(ClassifyName(name), FastenerKind::kNut) << name;
  }
  for (const char* name : {"SocketHeadScrew", "capscrew", "Zylinderschraube", "tornillo 3", "M3x12",
                           "M3\u00d712", "screws:2", "iso4762", "M4", "M3 screw motor mount"}) {
    EXPECT_EQ(ClassifyName(name), FastenerKind::kScrew) << name;
  }
  for (const char* name :
       {"nut holder", "screw_hole", "bolt plate", "foam insert", "lens insert", "M4 spacer",
        "M8 bearing block", "Kabelverschraubung", "chestnut", "DIN 9345", "standoff M3x20"}) {
    EXPECT_EQ(ClassifyName(name), FastenerKind::kNone) << name;
  }
}

TEST(ClassifyName, KnowsTheStandardsOfManyBodies) {
  for (const char* name : {"DIN 315 M6", "din315", "DIN_6923-M8", "ANSI B18.2.4.1M", "B18.2.2",
                           "ASME B18_2_4_2M - M10", "DIN EN 1661 M8", "GB/T 6170-2000", "GB6170",
                           "JIS B 1181 M6", "ISO 4161", "DIN EN ISO 4032 - M8", "iso-7040"}) {
    EXPECT_EQ(ClassifyName(name), FastenerKind::kNut) << name;
  }
  for (const char* name :
       {"DIN 316", "DIN 975 - M8", "DIN 603 - M6 x 20", "ISO 14583", "ANSI B18.3.1M", "B18.2.1",
        "ASME B18.6.3", "EN 1662", "GB/T 70.1", "JIS B 1176", "DIN EN ISO 4762", "ISO 7380-1"}) {
    EXPECT_EQ(ClassifyName(name), FastenerKind::kScrew) << name;
  }
  // Washers, pins, keys, rings, and numbers that are longer.
  for (const char* name : {"DIN 125", "ISO 7089", "DIN 471", "ISO 2936", "ANSI B18.22.1M",
                           "B18.21.1", "DIN 31599", "ISO 2338", "B18"}) {
    EXPECT_EQ(ClassifyName(name), FastenerKind::kNone) << name;
  }
}

TEST(ClassifyName, ReadsScrewsAndNutsInOtherLanguages) {
  for (const char* name : {"vis CHC", "Boulon M8", "schroef", "Zeskantmoer", "Gewindestange",
                           "tige filetée M6", "Болт М6", "螺栓 6"}) {
    EXPECT_NE(ClassifyName(name), FastenerKind::kNone) << name;
  }
  for (const char* name : {"vision", "visor", "television", "levite"}) {
    EXPECT_EQ(ClassifyName(name), FastenerKind::kNone) << name;
  }
}

TEST(ParseThreadSize, ReadsMetricSizesWithTheirPitch) {
  struct Case {
    const char* name;
    double diameter_mm;
    double pitch_mm;
  };

  for (const Case& c :
       {Case{"M3x16", 3, 0.5}, Case{"ISO 4762 M8 x 40", 8, 1.25}, Case{"M8x1", 8, 1},
        Case{"m10X1.25 nut", 10, 1.25}, Case{"SHCS_M2.5X6", 2.5, 0.45}, Case{"M3x0.5", 3, 0.5},
        Case{"BHCS M1.6", 1.6, 0.35}, Case{"M64", 64, 6}, Case{"Threaded rod M6", 6, 1},
        Case{"M30 x 1.5", 30, 1.5}, Case{"M30x1,5", 30, 1.5}, Case{"M2,5x10", 2.5, 0.45},
        Case{"M30*1.5", 30, 1.5}}) {
    SCOPED_TRACE(c.name);
    const auto size = ParseThreadSize(c.name);
    ASSERT_TRUE(size.has_value());
    EXPECT_NEAR(size->diameter, 1e-3 * c.diameter_mm, 1e-12);
    EXPECT_NEAR(size->pitch, 1e-3 * c.pitch_mm, 1e-12);
  }
}

TEST(ParseThreadSize, ReadsInchSizesWithTheirThreadsPerInch) {
  const auto quarter = ParseThreadSize("hex bolt 1/4-20 UNC x 1");
  ASSERT_TRUE(quarter.has_value());
  EXPECT_NEAR(quarter->diameter, 0.00635, 1e-9);
  EXPECT_NEAR(quarter->pitch, 0.00127, 1e-9);
  const auto ten = ParseThreadSize("screw #10-32");
  ASSERT_TRUE(ten.has_value());
  EXPECT_NEAR(ten->diameter, 0.19 * 0.0254, 1e-9);
  EXPECT_NEAR(ten->pitch, 0.0254 / 32, 1e-9);
  for (const char* name :
       {"1/4\"-20", "1/4 - 20 nut", "1/4 in - 20", "1/4 20 UNC", "1/4-20UNC-2A"}) {
    const auto size = ParseThreadSize(name);
    ASSERT_TRUE(size.has_value()) << name;
    EXPECT_NEAR(size->pitch, 0.00127, 1e-9) << name;
    EXPECT_TRUE(size->is_pitch_stated) << name;
  }
  EXPECT_NEAR(ParseThreadSize("1 1/4-7 UNC")->diameter, 1.25 * 0.0254, 1e-9);
}

TEST(ParseThreadSize, FindsNoneInOtherNames) {
  for (const char* name : {"plate", "arm3", "M5stack", "DIN 912", "1/4 drive", "part 110-320", "M",
                           "x5", "M300", "14-20", "2023-11-10-24-40 export"}) {
    // Dates and part numbers have dashes too.
    EXPECT_FALSE(ParseThreadSize(name).has_value()) << name;
  }
}

TEST(FindCoarsePitch, IsThatOfIso261) {
  EXPECT_NEAR(FindCoarsePitch(3e-3), 0.5e-3, 1e-12);
  EXPECT_NEAR(FindCoarsePitch(24e-3), 3e-3, 1e-12);
  EXPECT_EQ(FindCoarsePitch(3.2e-3), 0);
  EXPECT_NEAR(FindCoarsePitch(3.05e-3, 0.1e-3), 0.5e-3, 1e-12);
}

}  // namespace
}  // namespace hvas::product
