#pragma once

#include <array>

#include "solid.h"

/** Parts of the gear pump. The pump's frame: z along the shafts, towards the coupling; the gears'
 axes at y = +-kAxis; the housing from z = 0 to kFront. */
namespace hvas::products::pump {

struct Place {
  double x{0}, y{0};
};

inline constexpr double kAxis = 21;   ///< Half the centre distance.
inline constexpr double kFloor = 30;  ///< Bottom of the gear chamber.
inline constexpr double kFront = 60;  ///< The housing's front face.
inline constexpr double kGasket = 1;  ///< Thickness.
inline constexpr double kCoverBack = kFront + kGasket;
inline constexpr double kCoverThickness = 20;
inline constexpr double kBoss = 12;      ///< Height of the boss for the seal above the cover.
inline constexpr double kShoulder = 96;  ///< Where the drive shaft steps down for the coupling.
inline constexpr double kShaftEnd = 124;
inline constexpr double kKeyMiddle = 109;
inline constexpr double kHubLength = 29;
inline constexpr double kLockWasher = 1.6;  ///< Thickness.
inline constexpr double kPortRing = 1.5;    ///< Thickness.
inline constexpr double kBleedRing = 1;     ///< Thickness.
inline constexpr double kPortHeight = 45;   ///< z of the ports and of the bleed plug.
inline constexpr double kSide = 45;         ///< Half the housing's width.
inline constexpr double kTop = 65;          ///< Half the housing's height.

inline constexpr std::array<Place, 8> kScrews{
    {{36, 50}, {36, 18}, {36, -18}, {36, -50}, {-36, -50}, {-36, -18}, {-36, 18}, {-36, 50}}};
inline constexpr std::array<Place, 2> kDowels{{{20, 55}, {-20, -55}}};

[[nodiscard]] Solid MakeHousing();      ///< Lies in the pump's frame.
[[nodiscard]] Solid MakeCover();        ///< Back face at z = 0.
[[nodiscard]] Solid MakeGasket();       ///< Reaches from z = 0 to kGasket.
[[nodiscard]] Solid MakeDriveShaft();   ///< Lies on its own axis, z as in the pump.
[[nodiscard]] Solid MakeDrivenShaft();  ///< Lies on its own axis; the middle of a tooth at x.
[[nodiscard]] Solid MakeBushing();      ///< Reaches from z = 0 to 18.
[[nodiscard]] Solid MakeOilSeal();      ///< Reaches from z = 0 to 7.
[[nodiscard]] Solid MakeDowel();        ///< Reaches from z = 0 to 24.
[[nodiscard]] Solid
MakeKey();  ///< Lies on the drive shaft's axis, middle of the key at z = 0, key at +y.
[[nodiscard]] Solid MakeCouplingHub();  ///< Reaches from z = 0 to kHubLength, keyway at +y.
[[nodiscard]] Solid MakeEndDisc();      ///< Reaches from z = 0 to 4.
[[nodiscard]] Solid MakeLockWasher();   ///< Reaches from z = 0 to kLockWasher.
[[nodiscard]] Solid MakeHoseNipple();   ///< Thread below z = 0, hexagon above.
[[nodiscard]] Solid MakeBleedPlug();    ///< Thread below z = 0, hexagon above.

/** Hexagon socket screw (ISO 4762), head from z = 0 up, shank as drawn at its nominal diameter. */
[[nodiscard]] Solid MakeSocketScrew(double diameter, double length, double head_diameter,
                                    double across_flats, double socket_depth);

}  // namespace hvas::products::pump
