#pragma once

#include <string_view>

namespace hvas::product {

/** What a name says of how something is got. */
enum class BoughtName {
  kNone,
  kWord,         ///< A word for something that is bought or made: "motor", "Getriebe".
  kDesignation,  ///< A designation or a word for what is only bought: "608ZZ", "NEMA17", "servo".
};

/** Reads names of subassemblies in English, German, French, Spanish and Italian. Names of what
 holds or covers such a unit ("motor mount", "switch cover"), of collections ("servo screws") and of
 fasteners are kNone; with a word for an assembly ("motor assembly") only designations count. ASCII
 case does not matter. */
[[nodiscard]] BoughtName ClassifyBoughtName(std::string_view name);

/** Whether a name is that of a part which is put on the shaft of a motor or servo afterwards:
 "horn", "servo arm", "pulley", "propeller", "coupling", "wheel". */
[[nodiscard]] bool IsMountedOnUnit(std::string_view name);

/** Whether a name is that of a servo: "servo", "SG90", "mg996r", "XL-330". */
[[nodiscard]] bool IsServoName(std::string_view name);

/** Whether a name is a reference designator of a component on a circuit board ("R57", "C15 main",
 "SW1"): letters that are in use for components, and a
 number. */
[[nodiscard]] bool IsReferenceDesignator(std::string_view name);

/** Whether a name is that of a bare circuit board: "Board", "PCB_main", "Platine". */
[[nodiscard]] bool IsCircuitBoard(std::string_view name);

}  // namespace hvas::product
