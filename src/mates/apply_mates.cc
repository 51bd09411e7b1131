#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "mates/assignments.h"
#include "mates/user_mate.h"
#include "product/names.h"

namespace hvas::mates {
namespace {

using product::Mate;
using product::MateId;
using product::Occurrence;
using product::OccurrenceId;
using product::Product;

/** The error of an entry: what another function says, where the entry stands. */
Unexpected At(const std::string& where, Error error) {
  if (!error.where.empty()) {
    error.message = error.where + ": " + error.message;
  }
  error.where = where;
  return Unexpected(std::move(error));
}

Result<Mate> MakeAdded(const Product& product, const AddedMate& added) {
  std::vector<Pick> picks;
  for (const SideEntry* side : {&added.a, &added.b}) {
    const Result<OccurrenceId> occurrence = FindOccurrence(product, side->occurrence);
    if (!occurrence) {
      return At(added.where, occurrence.error());
    }
    Pick pick;
    pick.occurrence = *occurrence;
    if (side->face) {
      pick.face = product::FaceId(*side->face);
    } else {
      pick.feature = product::FeatureId(*side->feature);
    }
    picks.push_back(pick);
  }
  Result<Mate> mate = MakeMate(product, picks[0], picks[1]);
  if (!mate) {
    return At(added.where, mate.error());
  }
  if (added.kind && mate->kind != *added.kind) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("the two surfaces form a mate of kind {}, not {}", ToString(mate->kind),
                            ToString(*added.kind)),
                added.where, "correct or omit the kind, or give other faces");
  }
  return mate;
}

Result<void> RemoveAll(const SideFile& file, Product* product, MateChanges* changes,
                       WorkWatch* watch) {
  // First all are found, so that numbers and keys mean what they meant before.
  for (const RemovedMate& removed : file.removed) {
    if (!MayGoOn(watch)) {
      return Unexpected(watch->Explain("removing mates", removed.where));
    }
    const auto mate = std::find_if(product->mates.begin(), product->mates.end(),
                                   [&](const Mate& m) { return m.key == removed.mate; });
    if (mate == product->mates.end()) {
      return Fail(ErrorCode::kNotFound, fmt::format("there is no mate \"{}\"", removed.mate),
                  removed.where,
                  "write the key of a mate, or remove the entry with hvas mate restore");
    }
    changes->removed.push_back(*mate);
  }
  for (const Mate& mate : changes->removed) {
    if (!MayGoOn(watch)) {
      return Unexpected(watch->Explain("removing mates", file.path.string()));
    }
    if (const Result<Mate> removed = RemoveMate(product, mate.key); !removed) {
      return Fail(ErrorCode::kInvalid, fmt::format("mate \"{}\" is removed twice", mate.key),
                  file.path.string(), "keep one of the entries");
    }
  }
  return {};
}

}  // namespace

Result<OccurrenceId> FindOccurrence(const Product& product, std::string_view name) {
  std::vector<const Occurrence*> found;
  for (const Occurrence& occurrence : product.occurrences) {
    if (occurrence.path == name) {
      return occurrence.id;
    }
    if (IsCalled(product, occurrence.id, name)) {
      found.push_back(&occurrence);
    }
  }
  if (found.empty()) {
    std::vector<std::string> names;
    for (const Occurrence& occurrence : product.occurrences) {
      names.push_back(occurrence.name);
      names.push_back(occurrence.path);
    }
    const std::string nearest = FindNearest(name, names);
    return Fail(
        ErrorCode::kNotFound, fmt::format("there is no occurrence \"{}\"", name), product.source,
        nearest.empty() ? "hvas inspect lists the occurrences"
                        : fmt::format("did you mean \"{}\"? hvas inspect lists them", nearest));
  }
  if (found.size() > 1) {
    return Fail(
        ErrorCode::kInvalid, fmt::format("{} occurrences have the name \"{}\"", found.size(), name),
        product.source, fmt::format("write the path of one, such as \"{}\"", found.front()->path));
  }
  return found.front()->id;
}

Result<MateChanges> ApplyMates(const SideFile& file, Product* product, WorkWatch* watch) {
  MateChanges changes;
  if (file.removed.empty() && file.added.empty()) {
    return changes;
  }
  Product changed = *product;
  if (const auto removed = RemoveAll(file, &changed, &changes, watch); !removed) {
    return Unexpected(removed.error());
  }
  for (const AddedMate& added : file.added) {
    if (!MayGoOn(watch)) {
      return Unexpected(watch->Explain("adding mates", added.where));
    }
    Result<Mate> mate = MakeAdded(changed, added);
    if (!mate) {
      return Unexpected(mate.error());
    }
    MateId id = mate->id;
    if (id.index() < changed.mates.size()) {
      changed.mates[id.index()].origin = product::MateOrigin::kUser;
    } else {
      id = AddMate(&changed, *std::move(mate));
    }
    changes.added.push_back(id);
  }
  *product = std::move(changed);
  return changes;
}

}  // namespace hvas::mates
