#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/result.h"
#include "product/product.h"
#include "product/welded_units.h"

/** The file NAME.hvas.json beside a CAD file: what people say about its mates (docs/side-file.md).
 Here is its language; `mates/assignments.h` gives it its effect. */
namespace hvas::mates {

inline constexpr std::string_view kSideFileFormat = "hvas-assignments-2";

/** The kinds of objects in the file. */
enum class SideFileObject {
  kDocument,
  kFit,
  kMate,
  kSide,
  kRemoved,
  kRelation,
  kContact,
  kApart,
  kCompliant,
  kFlexible,
  kElastic
};

enum class SideFileType {
  kText,
  kNumber,
  kIndex,
  kDiameters,  ///< A number, or a list of [depth_mm, diameter_mm] by ascending depth.
  kObject,
  kList
};

/** A key that an object may have, as in data/schemas/assignments.schema.json. */
struct SideFileKey {
  std::string_view name;
  SideFileType type{SideFileType::kText};
  bool is_required{false};
  double low{0};  ///< Lowest of numbers.
  double high{0};
  bool is_low_excluded{false};
  bool may_be_empty{false};                   ///< Whether a text may be empty.
  std::span<const std::string_view> choices;  ///< What a text may be; any when empty.
};

[[nodiscard]] std::span<const SideFileKey> KeysOf(SideFileObject object);

/** "fits": what is known of the fit of some axis-hole or prismatic mates. As in ISO 286-1, a slot
 is a hole and a tongue a shaft. */
struct FitEntry {
  std::string mate;                ///< A key or "m12"; empty: by hole and shaft.
  std::string hole;                ///< An occurrence's name, path or end of path.
  std::string shaft;               ///< Occurrence and feature of the shaft.
  std::optional<double> diameter;  ///< Diameter of hole or shaft [m].
  std::optional<double> width;     ///< Width of slot or tongue, of a prismatic mate [m].
  bool has_diameters{false};       ///< A diameter was measured.
  bool has_widths{false};          ///< A width was measured.
  std::string fit;                 ///< "H7/g6", "H7", "g6", "thread", or empty.
  product::FitConditions conditions;
  std::string where;  ///< "FILE:LINE, fit 3".
};

/** A face or a feature of an occurrence. */
struct SideEntry {
  std::string occurrence;
  std::optional<std::uint32_t> face, feature;  ///< One of the two.
};

/** "mates": one that the user adds. */
struct AddedMate {
  std::optional<product::MateKind> kind;  ///< Found from the surfaces where it is not said.
  SideEntry a, b;
  std::string fit;  ///< What FitEntry::fit is.
  std::string where;
};

/** "removed": one that inference finds and the user does not want. */
struct RemovedMate {
  std::string mate;  ///< Its key.
  std::string where;
};

/** "relations": one beside the mates (mates/relations.h). */
struct StatedRelation {
  product::RelationKind kind{product::RelationKind::kParallel};
  SideEntry a, b;
  std::optional<double> angle;     ///< [rad]
  std::optional<double> distance;  ///< [m]
  std::string where;
};

/** "contacts": how the surfaces of two parts answer where they touch. */
struct StatedContact {
  std::string a, b;                  ///< Occurrences.
  std::optional<double> compliance;  ///< Compliance of one contact point [m/N].
  bool is_by_moduli{false};          ///< The compliance follows from the materials.
  std::optional<double> friction;    ///< Coulomb coefficient.
  std::string where;
};

/** "compliant", "flexible": how far a part may give where it meets another one on its way. */
struct StatedFlexible {
  std::string part;     ///< Occurrences of this name or path.
  double allowance{0};  ///< [m]; 0: it is rigid.
  std::string where;
};

/** "compliant", "elastic": what pushes back where another part presses on it, and how large it is.
 What is not stated is measured from the part. */
struct StatedElastic {
  std::string part;                          ///< Occurrences of this name or path.
  std::optional<product::ElasticKind> kind;  ///< Found from name and form where it is not stated.
  std::optional<double> free_size;           ///< Length, or diameter, with nothing on it [m].
  std::optional<double> thickness;   ///< Thickness of wire, disc, ring, strip, wall or lip [m].
  std::optional<double> outer;       ///< Outer diameter [m].
  std::optional<double> inner;       ///< Inner diameter [m].
  std::optional<double> lip_length;  ///< Length of a lip, from its root to its edge [m].
  std::optional<double> coils;       ///< Active coils.
  std::optional<double> modulus;     ///< Young's modulus [Pa].
  std::optional<double> stiffness;   ///< Force for each metre, in place of a formula [N/m].
  std::string where;
};

struct SideFile {
  std::filesystem::path path;
  std::vector<FitEntry> fits;
  std::vector<AddedMate> added;
  std::vector<RemovedMate> removed;
  std::vector<StatedRelation> relations;
  std::vector<StatedContact> contacts;
  std::vector<product::KeptApart> apart;  ///< What is not to be welded.
  std::vector<StatedFlexible> flexible;
  std::vector<StatedElastic> elastic;
};

/** Where a CAD file's side file stands: "pump.step" has "pump.hvas.json" beside it. */
[[nodiscard]] std::filesystem::path FindAssignmentFile(const std::filesystem::path& product_file);

/** The text of a side file. Errors: those of ReadRegularFile(). */
[[nodiscard]] Result<std::string> ReadSideText(const std::filesystem::path& file);

/** Reads a side file, of this format or of "hvas-assignments-1". Errors name the file, the line,
 the entry and a remedy: a key that is not known, is there twice, has a value of another type or out
 of its range, or is missing. */
[[nodiscard]] Result<SideFile> ReadSideFile(const std::filesystem::path& file);

/** Parses a text; `file` is for the messages. */
[[nodiscard]] Result<SideFile> ParseSideFile(std::string_view text,
                                             const std::filesystem::path& file);

/** The text of a side file: an entry a line. What is in `document` keeps its order. */
[[nodiscard]] std::string FormatSideFile(const nlohmann::ordered_json& document);

/** The candidate that somebody may have meant by a word; empty where none is near. */
[[nodiscard]] std::string FindNearest(std::string_view word,
                                      const std::vector<std::string>& candidates);

}  // namespace hvas::mates
