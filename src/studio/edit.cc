#include "studio/edit.h"

#include <utility>

#include <fmt/format.h>

#include "mates/assignments.h"
#include "mates/user_mate.h"
#include "studio/json_fields.h"

namespace hvas::studio {
namespace {

Result<Edit> MakeAssignFit(const Json& command) {
  const auto mate = IndexAt(command, "mate");
  const auto fit = TextAt(command, "fit");
  if (!mate || !fit) {
    return Unexpected(!mate ? mate.error() : fit.error());
  }
  const std::string assignment = fmt::format("m{}={}", *mate, *fit);
  return Edit{
      fmt::format("fit {}", assignment),
      {{"command", "assign_fit"}, {"mate", *mate}, {"fit", *fit}},
      [assignment](product::Product* product) { return mates::AssignFit(product, assignment); }};
}

Result<Edit> MakeAddMate(const Json& command) {
  const auto a = FaceAt(command, "a");
  const auto b = FaceAt(command, "b");
  if (!a || !b) {
    return Unexpected(!a ? a.error() : b.error());
  }
  const std::string fit = TextAt(command, "fit").value_or("");
  const auto add = [a = *a, b = *b, fit](product::Product* product) -> Result<void> {
    auto mate = mates::MakeMate(*product, {a.occurrence, a.face, {}}, {b.occurrence, b.face, {}});
    if (!mate) {
      return Unexpected(mate.error());
    }
    const product::MateId id = mate->id.index() < product->mates.size()
                                   ? mate->id
                                   : mates::AddMate(product, std::move(*mate));
    return fit.empty() ? Result<void>()
                       : mates::AssignFit(product, fmt::format("m{}={}", id.value(), fit));
  };
  return Edit{"add mate",
              {{"command", "add_mate"}, {"a", command["a"]}, {"b", command["b"]}, {"fit", fit}},
              add};
}

Result<Edit> MakeRemoveMate(const Json& command) {
  const auto mate = IndexAt(command, "mate");
  if (!mate) {
    return Unexpected(mate.error());
  }
  const std::string name = fmt::format("m{}", *mate);
  return Edit{"remove mate",
              {{"command", "remove_mate"}, {"mate", *mate}},
              [name](product::Product* product) -> Result<void> {
                const auto removed = mates::RemoveMate(product, name);
                return removed ? Result<void>() : Result<void>(Unexpected(removed.error()));
              }};
}

}  // namespace

Result<Edit> MakeEdit(const Json& command) {
  const auto name = TextAt(command, "command");
  if (!name) {
    return Unexpected(name.error());
  }
  if (*name == "assign_fit") {
    return MakeAssignFit(command);
  }
  if (*name == "add_mate") {
    return MakeAddMate(command);
  }
  if (*name == "remove_mate") {
    return MakeRemoveMate(command);
  }
  return Fail(ErrorCode::kInvalid, "the command is not a change of the product", *name, "");
}

Result<ChangeFn> CombineEdits(const std::vector<Json>& commands) {
  std::vector<ChangeFn> changes;
  for (const Json& command : commands) {
    auto edit = MakeEdit(command);
    if (!edit) {
      return Unexpected(edit.error());
    }
    changes.push_back(std::move(edit->change));
  }
  return ChangeFn([changes](product::Product* product) -> Result<void> {
    for (const ChangeFn& change : changes) {
      if (auto changed = change(product); !changed) {
        return changed;
      }
    }
    return {};
  });
}

}  // namespace hvas::studio
