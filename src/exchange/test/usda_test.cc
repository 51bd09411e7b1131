#include "exchange/usda.h"

#include <algorithm>
#include <regex>

#include "exchange/test/exported.h"

namespace hvas::exchange {
namespace {

TEST(UsdaTest, BracketsCloseAndEveryPathLeadsSomewhere) {
  const product::Product product = testing::Open(testing::kProducts / "gear_pump.step");
  const ExportedProduct exported = MakeExported(product);
  const std::string usda = MakeUsda(exported);
  EXPECT_EQ(usda.rfind("#usda 1.0\n", 0), 0U);
  for (const auto& [open, close] : {std::pair{'{', '}'}, {'(', ')'}, {'[', ']'}}) {
    EXPECT_EQ(std::count(usda.begin(), usda.end(), open),
              std::count(usda.begin(), usda.end(), close));
  }
  for (const ExportedBody& body : exported.bodies) {
    EXPECT_NE(usda.find("def Xform \"" + body.name + "\""), std::string::npos);
  }
  const std::regex path("</(parts|product)/([A-Za-z0-9_]+)>");
  int count = 0;
  for (std::sregex_iterator at(usda.begin(), usda.end(), path), end; at != end; ++at, ++count) {
    const std::string name = (*at)[2];
    EXPECT_NE(usda.find("Xform \"" + name + "\""), std::string::npos) << name;
  }
  EXPECT_EQ(count, static_cast<int>(exported.bodies.size() + 2 * exported.mates.size()));
  EXPECT_EQ(usda.find("nan"), std::string::npos);
  EXPECT_EQ(usda.find("inf"), std::string::npos);
}

TEST(UsdaTest, HasMassesAndSizesToTheLastDigit) {
  const product::Product product = testing::OpenPeg(0.1);
  const ExportedProduct exported = MakeExported(product);
  const std::string usda = MakeUsda(exported);
  for (const product::Part& part : product.parts) {
    EXPECT_NE(usda.find("physics:mass = " + WriteNumber(part.mass.mass)), std::string::npos);
  }
  const auto sized = std::find_if(exported.mates.begin(), exported.mates.end(),
                                  [](const ExportedMate& mate) { return mate.sizes.has_value(); });
  ASSERT_NE(sized, exported.mates.end());
  EXPECT_NE(usda.find("hvas:minClearance = " + WriteNumber(sized->sizes->min_clearance)),
            std::string::npos);
}

}  // namespace
}  // namespace hvas::exchange
