/** Draws the example products and writes NAME.step, NAME.truth.json and NAME.hvas.json for each;
 and tools/NAME.step for each tool. */
#include <exception>
#include <filesystem>

#include <Standard_Failure.hxx>
#include <fmt/core.h>

#include "tools.h"
#include "truth.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: make_products FOLDER\n");
    return 2;
  }
  try {
    std::filesystem::create_directories(argv[1]);
    // Numbers of occurrences in the files go on from product to product; products_test has this
    // order.
    hvas::products::WriteProduct(hvas::products::DrawBushing(), argv[1]);
    hvas::products::WriteProduct(hvas::products::DrawGearPump(), argv[1]);
    hvas::products::WriteProduct(hvas::products::DrawFrame500(), argv[1]);
    hvas::products::WriteProduct(hvas::products::DrawLooseTwelve(), argv[1]);
    hvas::products::WriteProduct(hvas::products::DrawFitRig(), argv[1]);
    hvas::products::WriteProduct(hvas::products::DrawSnapJoint(), argv[1]);
    const std::filesystem::path tools = std::filesystem::path(argv[1]) / "tools";
    std::filesystem::create_directories(tools);
    for (const hvas::products::Drawing& tool : hvas::products::DrawTools()) {
      hvas::products::WriteStep(tool, (tools / (tool.name + ".step")).string());
    }
    hvas::products::WriteProduct(hvas::products::DrawPegHole(), argv[1]);
    hvas::products::WriteProduct(hvas::products::DrawNutBolt(), argv[1]);
  } catch (const Standard_Failure& failure) {
    fmt::print(stderr, "make_products: {}\n", failure.GetMessageString());
    return 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "make_products: {}\n", error.what());
    return 1;
  }
  return 0;
}
