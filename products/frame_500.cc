#include <array>

#include <fmt/format.h>

#include "drawing.h"

/** An equipment tower for trials of scale: five equal tiers of eight posts, a shelf and six equal
 modules. 582 occurrences of 13 parts; everything goes in from above. */
namespace hvas::products {
namespace {

struct Place {
  double x{0}, y{0};
};

constexpr int kTiers = 5;
constexpr double kBaseThickness = 25;
constexpr double kShelfThickness = 12;
constexpr double kPostHeight = 110;
constexpr double kPinReach = 20;  // Of a pin in a post.
constexpr std::array<Place, 8> kPosts{{{-180, -130},
                                       {-60, -130},
                                       {60, -130},
                                       {180, -130},
                                       {-180, 130},
                                       {-60, 130},
                                       {60, 130},
                                       {180, 130}}};
constexpr std::array<Place, 6> kModules{
    {{-120, -50}, {0, -50}, {120, -50}, {-120, 50}, {0, 50}, {120, 50}}};
constexpr std::array<Place, 4> kBlockScrews{{{-32, -18}, {32, -18}, {-32, 18}, {32, 18}}};
constexpr std::array<Place, 2> kBlockDowels{{{-32, 0}, {32, 0}}};
constexpr std::array<Place, 2> kLidScrews{{{-12, 0}, {12, 0}}};
constexpr double kBlockHeight = 20;
constexpr double kLidThickness = 4;

std::string Numbered(const char* name, std::size_t index) {
  return fmt::format("{} {}", name, index + 1);
}

/** Block that two dowels place and four screws hold on a shelf; its lid has two screws. */
Solid MakeBlock() {
  std::vector<Solid> holes;
  for (const Place& p : kBlockScrews) {
    holes.push_back(Move(Cylinder(5.5, 0, kBlockHeight), Translation(p.x, p.y, 0)));
  }
  for (const Place& p : kBlockDowels) {
    holes.push_back(Move(Cylinder(6, 0, 10, -0.5, 0), Translation(p.x, p.y, 0)));
  }
  for (const Place& p : kLidScrews) {
    holes.push_back(
        Move(Cylinder(4, kBlockHeight - 12, kBlockHeight, 0, -0.5), Translation(p.x, p.y, 0)));
  }
  return CutAll(Box(-40, -25, 0, 40, 25, kBlockHeight), holes);
}

Solid MakeLid() {
  std::vector<Solid> holes;
  for (const Place& p : kLidScrews) {
    holes.push_back(Move(Cylinder(4.5, 0, kLidThickness), Translation(p.x, p.y, 0)));
  }
  return CutAll(Box(-24, -20, 0, 24, 20, kLidThickness), holes);
}

Solid MakeShelf() {
  std::vector<Solid> holes;
  for (const Place& p : kPosts) {
    holes.push_back(Move(Cylinder(10, 0, kShelfThickness, -0.5, -0.5), Translation(p.x, p.y, 0)));
  }
  for (const Place& m : kModules) {
    for (const Place& p : kBlockScrews) {
      holes.push_back(
          Move(Cylinder(5, 0, kShelfThickness, 0, -0.5), Translation(m.x + p.x, m.y + p.y, 0)));
    }
    for (const Place& p : kBlockDowels) {
      holes.push_back(Move(Cylinder(6, kShelfThickness - 8, kShelfThickness, 0, -0.5),
                           Translation(m.x + p.x, m.y + p.y, 0)));
    }
  }
  return CutAll(Box(-200, -150, 0, 200, 150, kShelfThickness), holes);
}

Solid MakeBasePlate() {
  std::vector<Solid> holes;
  for (const Place& p : kPosts) {
    holes.push_back(
        Move(Cylinder(10, kBaseThickness - 15, kBaseThickness, 0, -0.5), Translation(p.x, p.y, 0)));
  }
  return CutAll(Box(-220, -170, 0, 220, 170, kBaseThickness), holes);
}

/** A pin's hole at each end, a little deeper than the pin below it reaches. */
Solid MakePost() {
  const Solid bottom = Cylinder(10, 0, kPinReach + 2, -0.5, 0);
  const Solid top = Cylinder(10, kPostHeight - kPinReach, kPostHeight, 0, -0.5);
  return Cut(Cut(Cylinder(30, 0, kPostHeight, 1, 1), bottom), top);
}

Solid MakeScrew(double diameter, double length, double head_diameter, double across_flats) {
  const double r = diameter / 2, head = head_diameter / 2;
  const Solid body = Turn({{0, -length},
                           {r - 0.8, -length},
                           {r, -length + 0.8},
                           {r, 0},
                           {head, 0},
                           {head, diameter},
                           {0, diameter}});
  return Cut(body, Hexagon(across_flats, diameter / 2, diameter));
}

/** On the shelf it stands on. */
AssemblyDefinition& AddModule(Drawing& drawing) {
  const PartDefinition& block =
      drawing.AddPart("mounting block", MakeBlock(), materials::kAluminium, colors::kCover);
  const PartDefinition& dowel = drawing.AddPart("dowel pin 6x16", Cylinder(6, 0, 16, 0.8, 0.8),
                                                materials::kSteel, colors::kSteel);
  const PartDefinition& washer =
      drawing.AddPart("washer 5", Tube(10, 5.4, 0, 1), materials::kSteel, colors::kSteel);
  const PartDefinition& screw = drawing.AddPart("socket screw M5x30", MakeScrew(5, 30, 8.5, 4),
                                                materials::kBoltSteel, colors::kDarkSteel);
  const PartDefinition& lid =
      drawing.AddPart("lid", MakeLid(), materials::kAluminium, colors::kRed);
  const PartDefinition& lid_washer =
      drawing.AddPart("washer 4", Tube(9, 4.4, 0, 0.8), materials::kSteel, colors::kSteel);
  const PartDefinition& lid_screw = drawing.AddPart("socket screw M4x12", MakeScrew(4, 12, 7, 3),
                                                    materials::kBoltSteel, colors::kDarkSteel);
  AssemblyDefinition& module = drawing.AddAssembly("module");
  module.Add("block", block);
  for (std::size_t i = 0; i < kBlockDowels.size(); ++i) {
    const Place& p = kBlockDowels[i];
    module.Add(Numbered("dowel", i), dowel, Translation(p.x, p.y, -8));
  }
  for (std::size_t i = 0; i < kBlockScrews.size(); ++i) {
    const Place& p = kBlockScrews[i];
    module.Add(Numbered("washer", i), washer, Translation(p.x, p.y, kBlockHeight));
    module.Add(Numbered("screw", i), screw, Translation(p.x, p.y, kBlockHeight + 1));
  }
  module.Add("lid", lid, Translation(0, 0, kBlockHeight));
  for (std::size_t i = 0; i < kLidScrews.size(); ++i) {
    const Place& p = kLidScrews[i];
    const double top = kBlockHeight + kLidThickness;
    module.Add(Numbered("lid washer", i), lid_washer, Translation(p.x, p.y, top));
    module.Add(Numbered("lid screw", i), lid_screw, Translation(p.x, p.y, top + 0.8));
  }
  return module;
}

/** On the plate it stands on: posts, pins in their tops, the shelf over the pins, modules. */
AssemblyDefinition& AddTier(Drawing& drawing) {
  const PartDefinition& post =
      drawing.AddPart("post 30x110", MakePost(), materials::kAluminium, colors::kAluminium);
  const double pin_length = 2 * kPinReach + kShelfThickness;
  const PartDefinition& pin = drawing.AddPart("pin 10x52", Cylinder(10, 0, pin_length, 1, 1),
                                              materials::kSteel, colors::kSteel);
  const PartDefinition& shelf =
      drawing.AddPart("shelf", MakeShelf(), materials::kAluminium, colors::kAluminium);
  const AssemblyDefinition& module = AddModule(drawing);
  AssemblyDefinition& tier = drawing.AddAssembly("tier");
  for (std::size_t i = 0; i < kPosts.size(); ++i) {
    const Place& p = kPosts[i];
    tier.Add(Numbered("post", i), post, Translation(p.x, p.y, 0));
    tier.Add(Numbered("pin", i), pin, Translation(p.x, p.y, kPostHeight - kPinReach));
  }
  tier.Add("shelf", shelf, Translation(0, 0, kPostHeight));
  for (std::size_t i = 0; i < kModules.size(); ++i) {
    const Place& m = kModules[i];
    tier.Add(Numbered("module", i), module, Translation(m.x, m.y, kPostHeight + kShelfThickness));
  }
  return tier;
}

void AddFits(Drawing& drawing) {
  for (std::size_t i = 0; i < kPosts.size(); ++i) {
    const std::string post = Numbered("post", i), pin = Numbered("pin", i);
    drawing.fits.push_back({"base plate", Numbered("base pin", i), 10, "H7/p6"});
    drawing.fits.push_back({post, Numbered("base pin", i), 10, "H7/g6"});
    drawing.fits.push_back({post, pin, 10, "H7/k6"});
    drawing.fits.push_back({"shelf", pin, 10, "H7/g6"});
    drawing.fits.push_back({Numbered("cap", i), pin, 10, "H7/k6"});
  }
  for (const char* dowel : {"dowel 1", "dowel 2"}) {
    drawing.fits.push_back({"shelf", dowel, 6, "H7/p6"});
    drawing.fits.push_back({"block", dowel, 6, "H7/g6"});
  }
  for (std::size_t i = 0; i < kBlockScrews.size(); ++i) {
    drawing.fits.push_back({"shelf", Numbered("screw", i), 5, "thread"});
  }
  for (std::size_t i = 0; i < kLidScrews.size(); ++i) {
    drawing.fits.push_back({"block", Numbered("lid screw", i), 4, "thread"});
  }
}

/** From the base up; in a tier first what carries its shelf, then the modules, all from above. */
void AddOrder(Drawing& drawing) {
  const auto add = [&drawing](const std::string& name) {
    drawing.order.push_back({name, {0, 0, -1}});
  };
  add("base plate");
  for (std::size_t i = 0; i < kPosts.size(); ++i)
    add(Numbered("base pin", i));
  for (std::size_t t = 0; t < kTiers; ++t) {
    const std::string tier = Numbered("tier", t) + "/";
    for (std::size_t i = 0; i < kPosts.size(); ++i)
      add(tier + Numbered("post", i));
    for (std::size_t i = 0; i < kPosts.size(); ++i)
      add(tier + Numbered("pin", i));
    add(tier + "shelf");
    for (std::size_t m = 0; m < kModules.size(); ++m) {
      const std::string module = tier + Numbered("module", m) + "/";
      for (const char* name : {"dowel 1", "dowel 2", "block"})
        add(module + name);
      for (std::size_t i = 0; i < kBlockScrews.size(); ++i) {
        add(module + Numbered("washer", i));
        add(module + Numbered("screw", i));
      }
      add(module + "lid");
      for (std::size_t i = 0; i < kLidScrews.size(); ++i) {
        add(module + Numbered("lid washer", i));
        add(module + Numbered("lid screw", i));
      }
    }
  }
  for (std::size_t i = 0; i < kPosts.size(); ++i)
    add(Numbered("cap", i));
}

}  // namespace

Drawing DrawFrame500() {
  Drawing drawing;
  drawing.name = "frame_500";
  AssemblyDefinition& root = drawing.AddAssembly("equipment tower");
  const PartDefinition& base =
      drawing.AddPart("base plate", MakeBasePlate(), materials::kSteel, colors::kDarkSteel);
  const PartDefinition& base_pin =
      drawing.AddPart("pin 10x35", Cylinder(10, 0, 35, 1, 1), materials::kSteel, colors::kSteel);
  const AssemblyDefinition& tier = AddTier(drawing);
  const PartDefinition& cap =
      drawing.AddPart("cap", Cut(Cylinder(30, 0, 30, 0, 1), Cylinder(10, 0, 22, -0.5, 0)),
                      materials::kAluminium, colors::kRed);
  root.Add("base plate", base);
  for (std::size_t i = 0; i < kPosts.size(); ++i) {
    const Place& p = kPosts[i];
    root.Add(Numbered("base pin", i), base_pin, Translation(p.x, p.y, kBaseThickness - 15));
  }
  const double tier_height = kPostHeight + kShelfThickness;
  for (std::size_t t = 0; t < kTiers; ++t) {
    root.Add(Numbered("tier", t), tier,
             Translation(0, 0, kBaseThickness + static_cast<double>(t) * tier_height));
  }
  for (std::size_t i = 0; i < kPosts.size(); ++i) {
    const Place& p = kPosts[i];
    root.Add(Numbered("cap", i), cap, Translation(p.x, p.y, kBaseThickness + kTiers * tier_height));
  }
  AddFits(drawing);
  AddOrder(drawing);
  return drawing;
}

}  // namespace hvas::products
