#include "mates/drawn_oddities.h"

#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::mates {
namespace {

using product::Mate;
using product::Occurrence;
using product::OccurrenceId;
using product::PartId;
using product::Product;
using units::ToMm;

const std::string& PathOf(const Product& product, OccurrenceId id) {
  return product.occurrences[id.index()].path;
}

void ReportInterference(const Product& product, Diagnostics* diagnostics) {
  for (const Mate& mate : product.mates) {
    if (mate.fit && mate.fit->kind == product::FitKind::kInterference) {
      diagnostics->Note("drawn-interference", PathOf(product, mate.b.occurrence),
                        "is drawn larger than its hole in " + PathOf(product, mate.a.occurrence) +
                            " (" + mate.fit->reason + ")",
                        "assign the intended fit, if it is not a press fit");
    }
  }
}

void ReportOverlaps(const Product& product, const std::vector<DrawnOddity>& oddities,
                    Diagnostics* diagnostics) {
  struct Entry {
    const DrawnOddity* deepest{nullptr};
    int count{0};
  };

  std::map<std::pair<PartId, PartId>, Entry> entries;
  for (const DrawnOddity& oddity : oddities) {
    if (oddity.gap < 0) {
      Entry& entry = entries[std::minmax(product.occurrences[oddity.a.index()].part,
                                         product.occurrences[oddity.b.index()].part)];
      ++entry.count;
      if (entry.deepest == nullptr || oddity.gap < entry.deepest->gap) {
        entry.deepest = &oddity;
      }
    }
  }
  for (const auto& [parts, entry] : entries) {
    const DrawnOddity& oddity = *entry.deepest;
    diagnostics->Note(
        "drawn-overlap", PathOf(product, oddity.a),
        fmt::format("is drawn {:.3f} mm into {} over {:.2f} mm2{}", -ToMm(oddity.gap),
                    PathOf(product, oddity.b), 1e6 * oddity.area,
                    entry.count > 1
                        ? fmt::format(", and {} more pairs of these parts", entry.count - 1)
                        : std::string()),
        "the part is not moved; correct its position in the CAD system if the parts should only "
        "touch");
  }
}

void ReportDuplicates(const Product& product, const std::vector<OccurrenceId>& original_of,
                      Diagnostics* diagnostics) {
  std::map<OccurrenceId, int> counts;
  for (const OccurrenceId original : original_of) {
    if (original.is_valid()) {
      ++counts[original];
    }
  }
  for (const auto& [original, count] : counts) {
    diagnostics->Warn(
        "duplicate-part", PathOf(product, original),
        count == 1
            ? "a copy of this part has the same pose; the copy gets no mates"
            : fmt::format("{} copies of this part have the same pose; they get no mates", count),
        "delete the copies in the CAD system");
  }
}

void ReportLoose(const Product& product, const std::vector<DrawnOddity>& oddities,
                 const std::vector<OccurrenceId>& original_of, Diagnostics* diagnostics) {
  std::vector<bool> has_mate(product.occurrences.size(), false);
  for (const Mate& mate : product.mates) {
    has_mate[mate.a.occurrence.index()] = true;
    has_mate[mate.b.occurrence.index()] = true;
  }
  std::vector<const DrawnOddity*> nearest(product.occurrences.size(), nullptr);
  for (const DrawnOddity& oddity : oddities) {
    for (const OccurrenceId id : {oddity.a, oddity.b}) {
      const DrawnOddity*& best = nearest[id.index()];
      if (oddity.gap > 0 && (best == nullptr || oddity.gap < best->gap)) {
        best = &oddity;
      }
    }
  }
  for (const Occurrence& occurrence : product.occurrences) {
    if (has_mate[occurrence.id.index()] || original_of[occurrence.id.index()].is_valid() ||
        product.occurrences.size() < 2) {
      continue;
    }
    std::string message =
        "the part has no contact with another part along a plane, in a hole or in a seat";
    if (const DrawnOddity* near = nearest[occurrence.id.index()]) {
      const OccurrenceId other = near->a == occurrence.id ? near->b : near->a;
      message +=
          fmt::format("; a face of {} is {:.3f} mm away", PathOf(product, other), ToMm(near->gap));
    }
    diagnostics->Warn("no-mate", occurrence.path, std::move(message),
                      "define a mate with hvas mate add, or check the drawn position");
  }
}

}  // namespace

void ReportOddities(const Product& product, const std::vector<DrawnOddity>& oddities,
                    const std::vector<OccurrenceId>& original_of, Diagnostics* diagnostics) {
  ReportInterference(product, diagnostics);
  ReportOverlaps(product, oddities, diagnostics);
  ReportDuplicates(product, original_of, diagnostics);
  ReportLoose(product, oddities, original_of, diagnostics);
}

}  // namespace hvas::mates
