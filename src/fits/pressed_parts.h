#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

/** Parts that are pressed together along their axis when another part goes to its place: springs,
 spring washers and gaskets. Each has one degree of freedom, its compression, and a force that is
 the slope of an energy, so it gives back no more than it took. docs/algorithms/flexible.md compares
 them with published examples. */
namespace hvas::fits {

/** A compression spring of round wire. */
struct CoilSpring {
  double wire{0};           ///< d [m]
  double diameter{0};       ///< D, of the middle of the wire [m].
  double active_coils{0};   ///< n
  double shear_modulus{0};  ///< G [Pa]
};

/** Force for each metre of its compression [N/m]: G d^4 / (8 D^3 n).
 Source: Wahl, Mechanical Springs; the rate of EN 13906-1. */
[[nodiscard]] double CalcCoilStiffness(const CoilSpring& spring);

/** A disc spring without a bearing flat. */
struct DiscSpring {
  double outer{0};        ///< D_e [m]
  double inner{0};        ///< D_i [m]
  double thickness{0};    ///< t [m]
  double cone_height{0};  ///< h_0, free height less the thickness [m].
  double modulus{0};      ///< E [Pa]
  double poisson{0.3};
};

/** K_1 of a disc spring: ((k - 1) / k)^2 / (pi ((k + 1) / (k - 1) - 2 / ln k)), k = D_e / D_i.
 Source: Almen and Laszlo, The uniform-section disk spring, Trans. ASME 58 (1936), in the form of
 DIN 2092. */
[[nodiscard]] double CalcDiscShape(const DiscSpring& disc);

/** An open ring that is flattened: a split lock washer, as one turn of a spring of flat wire. */
struct LockWasher {
  double outer{0};          ///< Diameter [m].
  double inner{0};          ///< [m]
  double thickness{0};      ///< [m]
  double shear_modulus{0};  ///< [Pa]
};

/** Force for each metre by which its ends come together [N/m]: G J / (2 pi r^3), r the middle
 radius, for a turn of torsion J of the rectangular section, a b^3 (16/3 - 3.36 b/a (1 - b^4 / (12
 a^4))) with its half sides a >= b. Source: Wahl, Mechanical Springs, for springs of rectangular
 wire; J of Roark, Formulas for Stress and Strain, torsion of a rectangle. */
[[nodiscard]] double CalcLockWasherStiffness(const LockWasher& washer);

/** A strip that is held at one end and bent at the other. */
struct LeafSpring {
  double length{0};     ///< l [m]
  double width{0};      ///< b [m]
  double thickness{0};  ///< h [m]
  double modulus{0};    ///< E [Pa]
};

/** Force at its end for each metre of its deflection [N/m]: E b h^3 / (4 l^3), a cantilever. */
[[nodiscard]] double CalcLeafStiffness(const LeafSpring& leaf);

/** A flat gasket between two faces on which it does not slide. */
struct FlatGasket {
  double area{0};       ///< A, of one face [m^2].
  double free_area{0};  ///< Area of its edges, outside and inside, where it may bulge [m^2].
  double thickness{0};  ///< t, with nothing on it [m].
  double modulus{0};    ///< E [Pa]
};

/** Apparent modulus of a block whose own one would be `block`, where its bulk modulus B limits it:
 1 / (1 / block + 1 / B), B = 2 GPa of rubber.
 Source: Gent and Lindley (1959), as in CalcPadModulus(). */
[[nodiscard]] double LimitByBulk(double block) noexcept;

/** Apparent modulus of a gasket at small compression [Pa]: E (1 + 2 S^2), S = A / free area, for
 rubber, up to 0.1 GPa; stiffer materials are compressible, and have E.
 Source: Gent and Lindley, The compression of bonded rubber blocks, Proc. IMechE 173 (1959). */
[[nodiscard]] double CalcPadModulus(const FlatGasket& gasket) noexcept;

/** A spring whose rate is stated. */
struct StatedSpring {
  double stiffness{0};  ///< [N/m]
};

using PressedPart =
    std::variant<CoilSpring, DiscSpring, LockWasher, LeafSpring, FlatGasket, StatedSpring>;

/** Force along the axis at a compression, 0 where that is not positive [N].

 | part | force at s | known up to |
 |---|---|---|
 | disc spring | 4 E t^4 / ((1 - nu^2) K_1 D_e^2) (s/t) ((h_0/t - s/t)(h_0/t - s/(2t)) + 1) | h_0 |
 | gasket | A E_c / 3 (l^-2 - l), l = 1 - s/t | half of t |
 | others | their stiffness times s | |

 Beyond what is known, the force rises by the slope there, or by that at the beginning where that
 is more. Sources: those of the stiffnesses; disc springs as CalcDiscShape(); gaskets: Gent,
 Engineering with Rubber, for large compression of blocks. */
[[nodiscard]] double CalcPressForce(const PressedPart& part, double compression);

/** Its rate: force over compression, of the first micrometre [N/m]. */
[[nodiscard]] double CalcPressRate(const PressedPart& part);

/** The compression up to which the force of a part is known [m]; infinite where it is linear. */
[[nodiscard]] double FindMostPressed(const PressedPart& part) noexcept;

/** Closed form and source of its force, in a few words. */
[[nodiscard]] std::string DescribeForce(const PressedPart& part);

/** Forces of parts that are pressed one behind the other, at `steps` + 1 equal steps from nothing
 up to the compression of all together [N]. Each has the same force. Empty where there are none, or
 where one of several has no force that rises all along, as disc springs with h_0 > 1.4 t have: such
 a stack snaps, and has no one force. */
[[nodiscard]] std::vector<double> MakePressTable(std::span<const PressedPart> parts,
                                                 double compression, int steps);

}  // namespace hvas::fits
