#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evidence/given_parts.h"
#include "evidence/holds.h"
#include "product/product.h"
#include "record/reader.h"

namespace hvas::evidence {

/** The largest forces within a short time. */
struct ForceBin {
  double t{0};           ///< Session time of its middle [s].
  double true_force{0};  ///< [N]
  double felt_force{0};  ///< [N]
  double insertion{0};   ///< [m]
};

/** What happened in one hand. */
struct HandSummary {
  std::int64_t ticks{0};
  double period{0};                 ///< Time between its ticks [s].
  std::vector<ForceBin> bins;       ///< They span the whole session.
  double energy_in{0};              ///< That the hand put into the device, by forces [J].
  double energy_out{0};             ///< That it was given [J].
  bool has_energy{false};           ///< Passivity was controlled, and so it was accounted for.
  double longest_model_age{0};      ///< Since physics had answered last [s].
  std::int64_t shed_ticks{0};       ///< That left something out to be in time.
  std::int64_t truncated_ticks{0};  ///< Ticks in which contact had more than there is room for.
  std::int64_t crowded_ticks{0};    ///< Ticks in which a loose part stood still for that reason.
};

/** A fit of the product, and the sizes that were drawn for this session. */
struct FitSummary {
  std::string name;             ///< Name of the shaft and the hole.
  std::string code;             ///< ISO 286.
  double nominal{0};            ///< Diameter [m].
  double hole{0};               ///< Actual diameter [m].
  double shaft{0};              ///< [m]
  double least_clearance{0};    ///< Along the length, with the surface; diametral [m].
  double largest_clearance{0};  ///< Most of it [m].
  double max_force{0};          ///< Presses it in to its end [N].
};

/** A recorded session, for people. */
struct Summary {
  record::Meta meta;
  bool is_complete{false};
  std::string damage;              ///< What is not as it was written, first of all; empty: nothing.
  double duration{0};              ///< [s]
  std::vector<std::string> paths;  ///< One for each occurrence.
  std::vector<Hold> holds;
  std::vector<HandSummary> hands;
  std::vector<record::Event> incidents;  ///< Events of safety, device, effort and flight.
  std::vector<FitSummary> fits;
  std::vector<GivenPart> given;             ///< Parts that gave, and how far.
  std::optional<product::Product> product;  ///< None in records of before schema 3.
};

/** Reads all of a record; of a damaged one, what is sound before the damage.
 Errors: the reader's, when nothing can be told: the product or the events cannot be read. */
[[nodiscard]] Result<Summary> Summarise(record::Reader* reader);

}  // namespace hvas::evidence
