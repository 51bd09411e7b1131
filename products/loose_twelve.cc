#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <gp_Quaternion.hxx>

#include "drawing.h"

namespace hvas::products {
namespace {

constexpr double kPlate = 20;  // Thickness of the base plate [mm].
constexpr double kSpigot = 8;  // Length of the ends of posts in plate and cover.
constexpr double kPost = 50;   // Height of a post between plate and cover.
constexpr double kFlange = 4;  // Of the bushing, on the plate.
constexpr double kCover = 10;
constexpr double kPinDepth = 10;
constexpr double kPinLength = 24;
constexpr double kScrew = 20;  // Length under the head.

/** Where the posts stand: two that guide the cover, two that hold its screws. */
struct Spot {
  double x, y;
};

constexpr std::array<Spot, 2> kGuides{{{-45, -28}, {45, 28}}};
constexpr std::array<Spot, 2> kTapped{{{45, -28}, {-45, 28}}};
constexpr std::array<Spot, 2> kPins{{{-62, 0}, {62, 0}}};

Solid MakePlate() {
  std::vector<Solid> holes;
  for (const auto& spots : {kGuides, kTapped}) {
    for (const Spot& p : spots) {
      holes.push_back(
          Move(Cylinder(10, kPlate - kSpigot - 2, kPlate, 0, -0.5), Translation(p.x, p.y, 0)));
    }
  }
  for (const Spot& p : kPins) {
    holes.push_back(
        Move(Cylinder(6, kPlate - kPinDepth, kPlate, 0, -0.5), Translation(p.x, p.y, 0)));
  }
  holes.push_back(Cylinder(24, 0, kPlate, 0, -0.5));
  return CutAll(Box(-75, -45, 0, 75, 45, kPlate), holes);
}

/** Round, its foot in the plate; the shoulder is at z = 0. */
Solid MakeGuide() {
  return Turn({{0, -kSpigot},
               {4.5, -kSpigot},
               {5, -kSpigot + 0.5},
               {5, 0},
               {9, 0},
               {9, kPost},
               {5, kPost},
               {5, kPost + kSpigot - 1},
               {4, kPost + kSpigot},
               {0, kPost + kSpigot}});
}

Solid MakeTapped() {
  const Solid post = Turn({{0, -kSpigot},
                           {4.5, -kSpigot},
                           {5, -kSpigot + 0.5},
                           {5, 0},
                           {9, 0},
                           {9, kPost},
                           {0, kPost}});
  return Cut(post, Cylinder(6, kPost - 16, kPost, 0, -0.5));
}

/** Its flange lies on the plate; z = 0 is under the flange. */
Solid MakeBushing() {
  return Turn({{8, -18},
               {11.5, -18},
               {12, -17.5},
               {12, 0},
               {17, 0},
               {17, kFlange},
               {8.5, kFlange},
               {8, kFlange - 0.5}});
}

/** Shoulder at z = 0 on the bushing, upper end through the cover. */
Solid MakeShaft() {
  const double top = kPost - kFlange + kCover + 8;
  return Turn({{0, -16},
               {7, -16},
               {8, -15},
               {8, 0},
               {11, 0},
               {11, 20},
               {7, 20},
               {7, top - 1},
               {6, top},
               {0, top}});
}

Solid MakeCover() {
  std::vector<Solid> holes;
  for (const Spot& p : kGuides) {
    holes.push_back(Move(Cylinder(10, 0, kCover, -0.5, 0), Translation(p.x, p.y, 0)));
  }
  for (const Spot& p : kTapped) {
    holes.push_back(Move(Cylinder(6.6, 0, kCover), Translation(p.x, p.y, 0)));
  }
  holes.push_back(Cylinder(16, 0, kCover));
  return CutAll(Box(-60, -40, 0, 60, 40, kCover), holes);
}

/** Socket screw; z = 0 is under its head. */
Solid MakeCapScrew() {
  const Solid body =
      Turn({{0, -kScrew}, {2.2, -kScrew}, {3, -kScrew + 0.8}, {3, 0}, {5, 0}, {5, 6}, {0, 6}});
  return Cut(body, Hexagon(5, 3, 6));
}

/** A pose that nobody has thought about: a part as it comes from a catalogue. */
gp_Trsf Scatter(std::size_t number) {
  // Steps of a walk around the sphere that never meets itself: multiples of the golden angle.
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const double n = static_cast<double>(number);
  gp_Quaternion turn;
  turn.SetEulerAngles(gp_Intrinsic_ZYX, golden * n, 0.9 * golden * n, 1.7 * golden * n);
  gp_Trsf rotation;
  rotation.SetRotation(turn);
  const double radius = 180 + 12 * n;
  return Translation(radius * std::cos(golden * n), radius * std::sin(golden * n), 90 + 15 * n) *
         rotation;
}

/** A part of the product with its place. */
struct Placed {
  std::string name;
  const PartDefinition* part;
  gp_Trsf X_PB;  // In the base plate.
};

/** Adds a mate of two surfaces, given in their parts. */
void Mate(Drawing* drawing, const DrawnSurface& a, const DrawnSurface& b,
          const std::string& fit = "") {
  drawing->mates.push_back({a, b, fit});
}

DrawnSurface Plane(const std::string& occurrence, double x, double y, double z, bool is_up) {
  return {occurrence, {x, y, z}, {0, 0, is_up ? 1.0 : -1.0}, 0};
}

/** A cylinder along z; the point is on its axis, at a height that it has. */
DrawnSurface Round(const std::string& occurrence, double x, double y, double z, double diameter) {
  return {occurrence, {x, y, z}, {0, 0, 1}, diameter};
}

void AddMates(Drawing* drawing) {
  const auto add_post = [&](const std::string& post, const Spot& p) {
    Mate(drawing, Round("plate", p.x, p.y, kPlate - 5, 10), Round(post, 0, 0, -4, 10), "H7/g6");
    Mate(drawing, Plane("plate", p.x + 7, p.y, kPlate, true), Plane(post, 7, 0, 0, false));
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string number = std::to_string(i + 1);
    add_post("guide " + number, kGuides[i]);
    add_post("post " + number, kTapped[i]);
    const std::string pin = "pin " + number;
    const Spot& p = kPins[i];
    Mate(drawing, Round("plate", p.x, p.y, kPlate - 5, 6), Round(pin, 0, 0, 5, 6), "H7/g6");
    Mate(drawing, Plane("plate", p.x, p.y, kPlate - kPinDepth, true), Plane(pin, 0, 0, 0, false));
  }
  Mate(drawing, Round("plate", 0, 0, 10, 24), Round("bushing", 0, 0, -9, 24), "H7/g6");
  Mate(drawing, Plane("plate", 14, 0, kPlate, true), Plane("bushing", 14, 0, 0, false));
  Mate(drawing, Round("bushing", 0, 0, -9, 16), Round("shaft", 0, 0, -9, 16), "H7/g6");
  Mate(drawing, Plane("bushing", 10, 0, kFlange, true), Plane("shaft", 10, 0, 0, false));
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string number = std::to_string(i + 1);
    Mate(drawing, Round("cover", kGuides[i].x, kGuides[i].y, 5, 10),
         Round("guide " + number, 0, 0, kPost + 4, 10), "H7/g6");
  }
  Mate(drawing, Plane("guide 1", 7, 0, kPost, true),
       Plane("cover", kGuides[0].x + 7, kGuides[0].y, 0, false));
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string number = std::to_string(i + 1);
    Mate(drawing, Round("post " + number, 0, 0, kPost - 8, 6),
         Round("cap screw " + number, 0, 0, -8, 6), "thread");
    Mate(drawing, Plane("cover", kTapped[i].x + 4, kTapped[i].y, kCover, true),
         Plane("cap screw " + number, 4, 0, 0, false));
  }
}

}  // namespace

Drawing DrawLooseTwelve() {
  Drawing drawing;
  drawing.name = "loose_twelve";
  AssemblyDefinition& root = drawing.AddAssembly("loose twelve");
  const auto part = [&drawing](const char* name, const Solid& solid, const Material& material,
                               const Rgb& color) {
    return &drawing.AddPart(name, solid, material, color);
  };
  const PartDefinition* plate =
      part("base plate", MakePlate(), materials::kCastIron, colors::kCastIron);
  const PartDefinition* guide = part("guide post", MakeGuide(), materials::kSteel, colors::kSteel);
  const PartDefinition* post = part("tapped post", MakeTapped(), materials::kSteel, colors::kGear);
  const PartDefinition* pin = part("dowel pin 6x24", Cylinder(6, 0, kPinLength, 1, 1),
                                   materials::kSteel, colors::kDarkSteel);
  const PartDefinition* bushing =
      part("flanged bushing", MakeBushing(), materials::kBronze, colors::kBronze);
  const PartDefinition* shaft = part("shaft", MakeShaft(), materials::kSteel, colors::kSteel);
  const PartDefinition* cover =
      part("cover", MakeCover(), materials::kAluminium, colors::kAluminium);
  const PartDefinition* screw =
      part("cap screw M6x20", MakeCapScrew(), materials::kBoltSteel, colors::kDarkSteel);

  std::vector<Placed> placed{{"plate", plate, {}}};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string number = std::to_string(i + 1);
    placed.push_back({"guide " + number, guide, Translation(kGuides[i].x, kGuides[i].y, kPlate)});
    placed.push_back({"post " + number, post, Translation(kTapped[i].x, kTapped[i].y, kPlate)});
    placed.push_back(
        {"pin " + number, pin, Translation(kPins[i].x, kPins[i].y, kPlate - kPinDepth)});
    placed.push_back({"cap screw " + number, screw,
                      Translation(kTapped[i].x, kTapped[i].y, kPlate + kPost + kCover)});
  }
  placed.push_back({"bushing", bushing, Translation(0, 0, kPlate)});
  placed.push_back({"shaft", shaft, Translation(0, 0, kPlate + kFlange)});
  placed.push_back({"cover", cover, Translation(0, 0, kPlate + kPost)});

  // The plate lies flat somewhere; all others float as they came.
  const gp_Trsf X_WP = Translation(40, -25, 10) * RotationAboutZ(0.4);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    root.Add(placed[i].name, *placed[i].part, i == 0 ? X_WP : Scatter(i));
    drawing.assembled.push_back(X_WP * placed[i].X_PB);
  }
  AddMates(&drawing);
  return drawing;
}

}  // namespace hvas::products
