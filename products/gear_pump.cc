#include <numbers>

#include <fmt/format.h>

#include "drawing.h"
#include "gear_pump_parts.h"

/** A gear pump, after the pump that Xia et al. (2011) assembled: 38 occurrences of 18 parts. Parts
 that fit are drawn at their common nominal size; screws at their nominal diameter in tapped holes
 of the same. Everything goes in along straight lines, in the order given. */
namespace hvas::products {
namespace {

using std::numbers::pi;

constexpr std::array<int, 3> kDown{0, 0, -1};

std::string Numbered(const char* name, std::size_t index) {
  return fmt::format("{} {}", name, index + 1);
}

AssemblyDefinition& AddHousingAssembly(Drawing& drawing, const PartDefinition& bushing) {
  const PartDefinition& housing =
      drawing.AddPart("pump housing", pump::MakeHousing(), materials::kCastIron, colors::kCastIron);
  const PartDefinition& dowel = drawing.AddPart("dowel pin ISO 8734 6x24", pump::MakeDowel(),
                                                materials::kSteel, colors::kSteel);
  AssemblyDefinition& assembly = drawing.AddAssembly("housing assembly");
  assembly.Add("housing", housing);
  assembly.Add("bushing 1", bushing, Translation(0, pump::kAxis, 12));
  assembly.Add("bushing 2", bushing, Translation(0, -pump::kAxis, 12));
  for (std::size_t i = 0; i < pump::kDowels.size(); ++i) {
    const pump::Place& p = pump::kDowels[i];
    assembly.Add(Numbered("dowel pin", i), dowel, Translation(p.x, p.y, pump::kFront - 14));
  }
  return assembly;
}

/** On the drive shaft's axis. */
AssemblyDefinition& AddDriveShaftAssembly(Drawing& drawing) {
  const PartDefinition& shaft = drawing.AddPart("drive gear shaft", pump::MakeDriveShaft(),
                                                materials::kCaseSteel, colors::kGear);
  const PartDefinition& key =
      drawing.AddPart("parallel key A 5x5x20", pump::MakeKey(), materials::kSteel, colors::kBrass);
  const PartDefinition& hub =
      drawing.AddPart("coupling hub", pump::MakeCouplingHub(), materials::kSteel, colors::kRed);
  const PartDefinition& disc =
      drawing.AddPart("end disc", pump::MakeEndDisc(), materials::kSteel, colors::kSteel);
  const PartDefinition& screw =
      drawing.AddPart("socket screw M5x16", pump::MakeSocketScrew(5, 16, 8.5, 4, 2.5),
                      materials::kBoltSteel, colors::kDarkSteel);
  AssemblyDefinition& assembly = drawing.AddAssembly("drive shaft assembly");
  const double hub_end = pump::kShoulder + pump::kHubLength;
  assembly.Add("drive gear shaft", shaft);
  assembly.Add("key", key, Translation(0, 0, pump::kKeyMiddle));
  assembly.Add("coupling hub", hub, Translation(0, 0, pump::kShoulder));
  assembly.Add("end disc", disc, Translation(0, 0, hub_end));
  assembly.Add("end screw", screw, Translation(0, 0, hub_end + 4));
  return assembly;
}

/** On the cover's back face. */
AssemblyDefinition& AddCoverAssembly(Drawing& drawing, const PartDefinition& bushing) {
  const PartDefinition& cover =
      drawing.AddPart("front cover", pump::MakeCover(), materials::kCastIron, colors::kCover);
  const PartDefinition& seal =
      drawing.AddPart("oil seal 20x35x7", pump::MakeOilSeal(), materials::kRubber, colors::kRubber);
  AssemblyDefinition& assembly = drawing.AddAssembly("cover assembly");
  assembly.Add("cover", cover);
  assembly.Add("bushing 3", bushing, Translation(0, pump::kAxis, 0));
  assembly.Add("bushing 4", bushing, Translation(0, -pump::kAxis, 0));
  assembly.Add("oil seal", seal,
               Translation(0, pump::kAxis, pump::kCoverThickness + pump::kBoss - 8));
  return assembly;
}

/** Screws and lock washers on the cover's front face. */
AssemblyDefinition& AddFasteners(Drawing& drawing) {
  const PartDefinition& washer = drawing.AddPart("lock washer 6", pump::MakeLockWasher(),
                                                 materials::kSpringSteel, colors::kDarkSteel);
  const PartDefinition& screw =
      drawing.AddPart("socket screw M6x35", pump::MakeSocketScrew(6, 35, 10, 5, 3),
                      materials::kBoltSteel, colors::kDarkSteel);
  AssemblyDefinition& assembly = drawing.AddAssembly("cover fasteners");
  for (std::size_t i = 0; i < pump::kScrews.size(); ++i) {
    const pump::Place& p = pump::kScrews[i];
    assembly.Add(Numbered("lock washer", i), washer, Translation(p.x, p.y, 0));
    assembly.Add(Numbered("cover screw", i), screw, Translation(p.x, p.y, pump::kLockWasher));
  }
  return assembly;
}

AssemblyDefinition& AddConnections(Drawing& drawing) {
  const PartDefinition& port_ring =
      drawing.AddPart("sealing ring 16x22", Tube(22, 16.3, 0, pump::kPortRing), materials::kCopper,
                      colors::kCopper);
  const PartDefinition& nipple =
      drawing.AddPart("hose nipple M16", pump::MakeHoseNipple(), materials::kBrass, colors::kBrass);
  const PartDefinition& bleed_ring =
      drawing.AddPart("sealing ring 10x14", Tube(14, 10.3, 0, pump::kBleedRing), materials::kCopper,
                      colors::kCopper);
  const PartDefinition& plug =
      drawing.AddPart("bleed plug M10", pump::MakeBleedPlug(), materials::kSteel, colors::kSteel);
  AssemblyDefinition& assembly = drawing.AddAssembly("connections");
  const gp_Dir x(1, 0, 0), y(0, 1, 0);
  const auto port = [&](double side, double out) {
    return Frame(side * (pump::kSide + out), 0, pump::kPortHeight, side > 0 ? x : x.Reversed(), y);
  };
  const auto bleed = [&](double out) {
    return Frame(0, pump::kTop + out, pump::kPortHeight, y, x);
  };
  assembly.Add("port ring 1", port_ring, port(1, 0));
  assembly.Add("hose nipple 1", nipple, port(1, pump::kPortRing));
  assembly.Add("port ring 2", port_ring, port(-1, 0));
  assembly.Add("hose nipple 2", nipple, port(-1, pump::kPortRing));
  assembly.Add("bleed ring", bleed_ring, bleed(0));
  assembly.Add("bleed plug", plug, bleed(pump::kBleedRing));
  return assembly;
}

void AddFits(Drawing& drawing) {
  drawing.fits = {{"housing", "bushing 1", 26, "H7/p6"},
                  {"housing", "bushing 2", 26, "H7/p6"},
                  {"cover", "bushing 3", 26, "H7/p6"},
                  {"cover", "bushing 4", 26, "H7/p6"},
                  {"bushing 1", "drive gear shaft", 20, "H7/g6"},
                  {"bushing 2", "driven gear shaft", 20, "H7/g6"},
                  {"bushing 3", "drive gear shaft", 20, "H7/g6"},
                  {"bushing 4", "driven gear shaft", 20, "H7/g6"},
                  {"housing", "dowel pin 1", 6, "H7/k6"},
                  {"housing", "dowel pin 2", 6, "H7/k6"},
                  {"cover", "dowel pin 1", 6, "H7/g6"},
                  {"cover", "dowel pin 2", 6, "H7/g6"},
                  {"coupling hub", "drive gear shaft", 14, "H7/k6"},
                  {"cover", "oil seal", 35, "H7/p6"},
                  {"oil seal", "drive gear shaft", 20, "H7/f7"},
                  {"housing", "hose nipple 1", 16, "thread"},
                  {"housing", "hose nipple 2", 16, "thread"},
                  {"housing", "bleed plug", 10, "thread"},
                  {"drive gear shaft", "end screw", 5, "thread"}};
  for (std::size_t i = 0; i < pump::kScrews.size(); ++i) {
    drawing.fits.push_back({"housing", Numbered("cover screw", i), 6, "thread"});
  }
}

void AddOrder(Drawing& drawing) {
  for (const char* name :
       {"housing", "bushing 1", "bushing 2", "dowel pin 1", "dowel pin 2", "drive gear shaft",
        "driven gear shaft", "gasket", "bushing 3", "bushing 4", "cover"}) {
    drawing.order.push_back({name, kDown});
  }
  for (std::size_t i = 0; i < pump::kScrews.size(); ++i) {
    drawing.order.push_back({Numbered("lock washer", i), kDown});
    drawing.order.push_back({Numbered("cover screw", i), kDown});
  }
  drawing.order.push_back({"oil seal", kDown});
  drawing.order.push_back({"key", {0, -1, 0}});
  for (const char* name : {"coupling hub", "end disc", "end screw"}) {
    drawing.order.push_back({name, kDown});
  }
  drawing.order.push_back({"port ring 1", {-1, 0, 0}});
  drawing.order.push_back({"hose nipple 1", {-1, 0, 0}});
  drawing.order.push_back({"port ring 2", {1, 0, 0}});
  drawing.order.push_back({"hose nipple 2", {1, 0, 0}});
  drawing.order.push_back({"bleed ring", {0, -1, 0}});
  drawing.order.push_back({"bleed plug", {0, -1, 0}});
}

}  // namespace

Drawing DrawGearPump() {
  Drawing drawing;
  drawing.name = "gear_pump";
  AssemblyDefinition& root = drawing.AddAssembly("gear pump");
  const PartDefinition& bushing =
      drawing.AddPart("bushing 20x26x18", pump::MakeBushing(), materials::kBronze, colors::kBronze);
  root.Add("housing assembly", AddHousingAssembly(drawing, bushing));
  root.Add("drive shaft assembly", AddDriveShaftAssembly(drawing), Translation(0, pump::kAxis, 0));
  const PartDefinition& driven = drawing.AddPart("driven gear shaft", pump::MakeDrivenShaft(),
                                                 materials::kCaseSteel, colors::kGear);
  // A gap of the driven gear is where the drive gear's tooth is.
  root.Add("driven gear shaft", driven,
           Translation(0, -pump::kAxis, 0) * RotationAboutZ(pi / 2 + pi / 14));
  const PartDefinition& gasket =
      drawing.AddPart("gasket", pump::MakeGasket(), materials::kRubber, colors::kRubber);
  root.Add("gasket", gasket, Translation(0, 0, pump::kFront));
  root.Add("cover assembly", AddCoverAssembly(drawing, bushing),
           Translation(0, 0, pump::kCoverBack));
  root.Add("cover fasteners", AddFasteners(drawing),
           Translation(0, 0, pump::kCoverBack + pump::kCoverThickness));
  root.Add("connections", AddConnections(drawing));
  AddFits(drawing);
  AddOrder(drawing);
  return drawing;
}

}  // namespace hvas::products
