#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "product/ids.h"
#include "spatial/pose.h"

/** Parts that push back where others press on them: springs, spring washers, gaskets, slit pins,
 sleeves of rubber and lip seals, with the sizes on which their force depends
 (docs/algorithms/flexible.md). */
namespace hvas::product {

struct Part;
struct Product;

/** What a part is, by which its force is calculated. Records have the numbers: new kinds come last.
 */
enum class ElasticKind {
  kCoilSpring,  ///< A compression spring of round wire.
  kDiscSpring,  ///< A cone, as of DIN 2093.
  kLockWasher,  ///< An open ring that is flattened.
  kLeafSpring,  ///< A strip that bends.
  kGasket,      ///< A flat sheet between two faces.
  kSlitPin,     ///< A slit tube that is closed by its hole.
  kSleeve,      ///< A tube of rubber between a hole and a shaft.
  kLipSeal,     ///< A ring whose lip of rubber its shaft spreads.
};

[[nodiscard]] const char* ToString(ElasticKind kind);

/** Whether its force is along its axis, from a part that presses on its end. The others are pressed
 all around when they go into their hole. */
[[nodiscard]] constexpr bool IsPressedAlongAxis(ElasticKind kind) {
  return kind < ElasticKind::kSlitPin;
}

/** A part that pushes back. Sizes that a kind does not have, or that are not known, are 0. */
struct ElasticPart {
  OccurrenceId occurrence{};
  ElasticKind kind{ElasticKind::kCoilSpring};
  Vec3 axis_B{Vec3::UnitZ()};   ///< Unit, along which it is pressed.
  Vec3 centre_B{Vec3::Zero()};  ///< Point of its axis, in the middle of its drawn length [m].
  double length{0};             ///< Along its axis, as drawn [m].
  double outer{0};              ///< Outer diameter; leaf spring: length of the strip [m].
  double inner{0};              ///< Inner diameter; leaf spring: width of the strip [m].
  double thickness{0};          ///< Thickness of wire, disc, ring, strip, wall or lip [m].
  double coils{0};              ///< Active coils.
  double area{0};               ///< Gasket: of one face [m^2].
  double free_area{0};          ///< Gasket: of its edges [m^2].
  /** Lip seal: where its edge is, and the root of its lip, from the centre along the axis [m];
   equal where no lip was found. */
  double lip_at{0};
  double lip_root{0};
  double lip_radius{0};  ///< Lip seal: largest radius of its lip [m].
  /** Length along its axis with nothing on it; slit pin and sleeve: outer diameter; lip seal: inner
   diameter [m]. */
  double free_size{0};
  double modulus{0};  ///< Young's modulus [Pa].
  double poisson_ratio{0};
  double stiffness{0};  ///< Stated, in place of its closed form [N/m].
  std::string reason;   ///< What says what it is and how large, in a few words.

  [[nodiscard]] double lip_length() const { return std::abs(lip_at - lip_root); }
};

/** Recognises a part that pushes back by its name or its form, with its sizes; its occurrence is
 left open. None where it is something else, or its form is not that of its name.

 | kind | recognised by | sizes from |
 |---|---|---|
 | coil spring | form: turns of round wire | diameters; active coils by the gaps |
 | disc spring | name, or form: a cone | diameters; thickness from the volume |
 | lock washer | name | diameters; thickness from the volume |
 | leaf spring | name | its box; thickness from the volume |
 | gasket | name, and form: a flat sheet | its box and faces |
 | slit pin | name | diameters; at its nominal size those of ISO 8752 |
 | sleeve | rubber, and form: a tube | diameters |
 | lip seal | name, and form: a ring with a lip inside | lines across its axis |

 Active coils are the sum of the gaps over the widest one, and one more where the ends are neither
 closed nor ground. The free length is the drawn one, but that of DIN 2093, series A, for a disc
 spring that is drawn flat. A lip begins at the narrowest place of its ring and goes to where the
 ring is 2.5 times as thick; it is known where it is longer than it is thick. */
[[nodiscard]] std::optional<ElasticPart> FindElasticPart(const Part& part);

/** Measures a part as one of a kind, whatever its name and form are. */
[[nodiscard]] ElasticPart MeasureElasticPart(ElasticKind kind, const Part& part);

/** What an occurrence is; null where it does not push back. */
[[nodiscard]] const ElasticPart* FindElastic(const Product& product, OccurrenceId id);

}  // namespace hvas::product
