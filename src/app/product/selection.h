#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "product/product.h"

namespace hvas::app {

enum class Section {
  kTree,
  kParts,
  kFeatures,
  kFaces,
  kMates,
  kJoints,
  kFits,
  kOverlaps,
  kTolerances,
  kDiagnostics,
  kIdentity,  ///< The first of the sections that are shown only where they are asked for.
  kRelations,
  kSurfaces,
};

inline constexpr std::array<std::string_view, 13> kSectionNames{
    "tree",     "parts",      "features",    "faces",    "mates",     "joints",  "fits",
    "overlaps", "tolerances", "diagnostics", "identity", "relations", "surfaces"};

/** What a person asks to see; empty lists ask for everything. */
struct SelectionOptions {
  std::vector<std::string> only;         ///< Names of sections.
  std::vector<std::string> parts;        ///< Names, or numbers as in "p3".
  std::vector<std::string> occurrences;  ///< Names, paths or ends of them, also of subassemblies.
  std::vector<std::string> mates;        ///< "m12", or keys.
  std::vector<std::string> kinds;        ///< Kinds of mates: "axis-hole", ...
};

/** "axis-hole, face-face, cone-seat, sphere-seat": all kinds of mates as people write them. */
[[nodiscard]] std::string ListMateKinds(std::string_view before_last = ", ");

/** What of a product is to be shown. */
class Selection {
 public:
  /** Everything of a product but the sections that have to be asked for. */
  explicit Selection(const product::Product& product);

  /** Occurrences that fit all that is asked for, their parts, and the mates at them. A mate that is
   asked for brings its two occurrences. Fails where a name names nothing, with the nearest one. */
  [[nodiscard]] static Result<Selection> Make(const product::Product& product,
                                              const SelectionOptions& options);

  [[nodiscard]] bool Has(Section section) const {
    return sections_[static_cast<std::size_t>(section)];
  }

  [[nodiscard]] bool Has(product::PartId id) const { return parts_[id.index()]; }

  [[nodiscard]] bool Has(product::OccurrenceId id) const { return occurrences_[id.index()]; }

  [[nodiscard]] bool Has(product::MateId id) const { return mates_[id.index()]; }

  /** True where names or kinds narrow it down. */
  [[nodiscard]] bool is_filtered() const { return is_filtered_; }

  /** True where sections were asked for by name. */
  [[nodiscard]] bool is_chosen() const { return is_chosen_; }

 private:
  std::array<bool, kSectionNames.size()> sections_{};
  std::vector<bool> parts_, occurrences_, mates_;
  bool is_filtered_{false};
  bool is_chosen_{false};
};

}  // namespace hvas::app
