#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "mates/assignments.h"
#include "mates/place_by_mates.h"
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

Unexpected FailToRemove(const RemovedMate& removed) {
  return Fail(ErrorCode::kNotFound, fmt::format("there is no mate \"{}\"", removed.mate),
              removed.where, "write the key of a mate, or remove the entry with hvas mate restore");
}

/** Removes the mates that are there. Those that are not may be mates of the assembled poses. */
Result<void> RemoveAll(const SideFile& file, Product* product, MateChanges* changes,
                       WorkWatch* watch) {
  // First all are found, so that numbers and keys mean what they meant before.
  for (const RemovedMate& removed : file.removed) {
    if (!MayGoOn(watch)) {
      return Unexpected(watch->Explain("removing mates", removed.where));
    }
    const auto mate = std::find_if(product->mates.begin(), product->mates.end(),
                                   [&](const Mate& m) { return m.key == removed.mate; });
    if (mate != product->mates.end()) {
      changes->removed.push_back(*mate);
    } else if (file.added.empty()) {
      return FailToRemove(removed);
    } else {
      product->removed_mates.push_back(removed.mate);
    }
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

/** Adds the mates of a file. @returns their keys. */
Result<std::vector<std::string>> AddAll(const SideFile& file, Product* product, WorkWatch* watch) {
  std::vector<std::string> keys;
  for (const AddedMate& added : file.added) {
    if (!MayGoOn(watch)) {
      return Unexpected(watch->Explain("adding mates", added.where));
    }
    Result<Mate> mate = MakeAdded(*product, added);
    if (!mate) {
      return Unexpected(mate.error());
    }
    keys.push_back(mate->key);
    if (mate->id.index() < product->mates.size()) {
      product->mates[mate->id.index()].origin = product::MateOrigin::kUser;
    } else {
      AddMate(product, *std::move(mate));
    }
  }
  return keys;
}

/** What placing has found of the mates that a file adds and removes. */
Result<void> NotePlacement(const SideFile& file, const std::vector<std::string>& added,
                           Placement placement, const Product& product, MateChanges* changes) {
  const auto is_among = [](const std::vector<Mate>& mates, const std::string& key) {
    return std::any_of(mates.begin(), mates.end(),
                       [&key](const Mate& mate) { return mate.key == key; });
  };
  for (Mate& mate : placement.removed) {
    if (!is_among(changes->removed, mate.key)) {
      changes->removed.push_back(std::move(mate));
    }
  }
  for (const RemovedMate& removed : file.removed) {
    if (!is_among(changes->removed, removed.mate)) {
      return FailToRemove(removed);
    }
  }
  for (const std::string& key : added) {
    const Result<MateId> id = FindMate(product, key);
    if (!id) {
      return Unexpected(id.error());
    }
    changes->added.push_back(*id);
  }
  changes->contradictions = std::move(placement.contradictions);
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
  const auto added = AddAll(file, &changed, watch);
  if (!added) {
    return Unexpected(added.error());
  }
  Result<Placement> placement = PlaceByMates(&changed, watch);
  if (!placement) {
    return Unexpected(placement.error());
  }
  if (const auto noted = NotePlacement(file, *added, *std::move(placement), changed, &changes);
      !noted) {
    return Unexpected(noted.error());
  }
  *product = std::move(changed);
  return changes;
}

}  // namespace hvas::mates
