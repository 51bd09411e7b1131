#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "person/simulated_person.h"

/** Campaigns: a plan names products, fits, spreads of sizes, materials, persons and seeds, and each
 combination is one run, that is one product as made (docs/campaigns.md). */
namespace hvas::campaign {

/** First line of a plan: `format: hvas-campaign-1`. */
inline constexpr const char* kPlanFormat = "hvas-campaign-1";

/** How a run is calculated. */
enum class Method {
  kFits,      ///< The formulas of the fits alone are evaluated: some microseconds.
  kAssemble,  ///< A simulated person assembles in virtual time, with the whole tick: seconds.
};

inline constexpr std::array<std::string_view, 2> kMethods{"fits", "assemble"};

/** How sizes are spread over a tolerance zone (fits::SizeDistribution). */
enum class Spread {
  kZone,        ///< Normal over the whole micrometres of the zone (W2).
  kCapability,  ///< Normal, of a process with Cp and Cpk.
  kUniform,     ///< Uniform between the limits.
  kMeasured,    ///< Deviations that were measured, each as likely.
};

inline constexpr std::array<std::string_view, 4> kSpreads{"zone", "capability", "uniform",
                                                          "measured"};

/** Fits of one variant of the products. */
struct FitVariant {
  std::string id;
  std::vector<std::string>
      assignments;  ///< "AXIS=H7/p6" (mates::AssignFit); none: as in the files.
};

/** A range of values that are equally likely. */
struct UniformRange {
  double low{0};
  double high{0};
};

/** How the sizes and surfaces of one variant are made. */
struct SizeVariant {
  std::string id;
  Spread spread{Spread::kZone};
  double cp{1.33};
  double cpk{1.0};
  /** Measured deviations from the nominal size of holes and of shafts [m]. */
  std::vector<double> hole_deviations, shaft_deviations;
  std::optional<UniformRange> friction;   ///< Coulomb coefficient; none: that of the materials.
  std::optional<UniformRange> roughness;  ///< Rz, mean of both sides [m]; none: as stated.
};

/** A material for the parts with one name. */
struct PartMaterial {
  std::string part;  ///< Name of the part; "all" for all.
  std::string material;
};

/** Materials of one variant; parts that are not named keep that of the file. */
struct MaterialVariant {
  std::string id;
  std::vector<PartMaterial> parts;
};

/** Seeds first, first + 1, ... */
struct Seeds {
  std::uint64_t first{1};
  std::int64_t count{1000};
};

/** What of Sobol's indices is calculated. */
struct SensitivityOptions {
  int samples{4096};   ///< Rows of A and B, 64 to 1,000,000.
  int resamples{500};  ///< Bootstrap samples, 100 to 10,000.
};

struct Plan {
  std::string id;
  Method method{Method::kFits};
  std::vector<std::filesystem::path>
      products;  ///< Relative ones are resolved from the plan's file.
  std::vector<FitVariant> fits;
  std::vector<SizeVariant> sizes;
  std::vector<MaterialVariant> materials;
  /** How the simulated person works; none: a guided hand moves the parts. */
  std::vector<std::optional<person::PersonKind>> persons;

  /** The word of a person in a plan. */
  [[nodiscard]] static const char* NamePerson(const std::optional<person::PersonKind>& person) {
    return person ? person::ToString(*person) : "guided";
  }

  Seeds seeds;
  double press_force{0};  ///< Largest force of the press [N]; 0: without limit.
  bool may_yield{true};   ///< Whether a product with a part beyond its elastic limit is complete.
  std::int64_t shard_runs{10'000};
  std::optional<SensitivityOptions> sensitivity;
  std::filesystem::path file;  ///< Where it was read.
  std::string text;            ///< Its bytes.

  [[nodiscard]] std::int64_t CountCells() const;

  [[nodiscard]] std::int64_t CountRuns() const { return CountCells() * seeds.count; }

  [[nodiscard]] std::int64_t CountShards() const;
};

/** One combination of the plan but for the seed, as indices into its lists. */
struct Cell {
  std::int64_t index{0};
  std::size_t product{0}, fit{0}, sizes{0}, material{0}, person{0};
};

/** Runs of a plan by number: cells in the order of the plan, the last list first, and in each cell
 the seeds. @pre 0 <= index < CountCells(). */
[[nodiscard]] Cell FindCell(const Plan& plan, std::int64_t index);

/** Name of a cell: the ids of what has more than one variant. */
[[nodiscard]] std::string DescribeCell(const Plan& plan, const Cell& cell);

/** Runs [first, end). */
struct RunRange {
  std::int64_t first{0};
  std::int64_t end{0};
};

/** The runs of a shard. @pre 0 <= shard < CountShards(). */
[[nodiscard]] RunRange FindRuns(const Plan& plan, std::int64_t shard);

/** Parses a plan. `file` is for messages and for finding files relative to it. Errors:
 kUnreadable for malformed YAML, kInvalid for a field that is unknown, missing or out of range, each
 with line, column and remedy. */
[[nodiscard]] Result<Plan> ParsePlan(const std::string& text, const std::filesystem::path& file);

/** Reads a plan. Errors: those of ReadRegularFile and ParsePlan. */
[[nodiscard]] Result<Plan> ReadPlan(const std::filesystem::path& file);

}  // namespace hvas::campaign
