#include "studio/edit.h"

#include <utility>

#include <fmt/format.h>

#include "mates/assignments.h"
#include "mates/place_by_mates.h"
#include "mates/user_mate.h"
#include "studio/commands.h"

namespace hvas::studio {
namespace {

Json DescribeFace(const PickedFace& face) {
  return {{"occurrence", face.occurrence.value()}, {"face", face.face.value()}};
}

/** The edit that a command of these fields asks for. */
template <typename Fields>
Result<Edit> ReadEdit(const Json& command) {
  const auto fields = protocol::ReadFields<Fields>(command);
  return fields ? Result<Edit>(MakeEdit(*fields)) : Result<Edit>(Unexpected(fields.error()));
}

}  // namespace

Edit MakeEdit(const protocol::AssignFitCommand& command) {
  const std::string assignment = fmt::format("m{}={}", command.mate, command.fit);
  return Edit{
      fmt::format("fit {}", assignment),
      {{"command", command.kName}, {"mate", command.mate}, {"fit", command.fit}},
      [assignment](product::Product* product) { return mates::AssignFit(product, assignment); }};
}

Edit MakeEdit(const protocol::AddMateCommand& command) {
  const auto add = [a = command.a, b = command.b,
                    fit = command.fit](product::Product* product) -> Result<void> {
    auto mate = mates::MakeMate(*product, {a.occurrence, a.face, {}}, {b.occurrence, b.face, {}});
    if (!mate) {
      return Unexpected(mate.error());
    }
    const auto id = mates::AddMateAndPlace(product, std::move(*mate));
    if (!id) {
      return Unexpected(id.error());
    }
    return fit.empty() ? Result<void>()
                       : mates::AssignFit(product, fmt::format("m{}={}", id->value(), fit));
  };
  return Edit{"add mate",
              {{"command", command.kName},
               {"a", DescribeFace(command.a)},
               {"b", DescribeFace(command.b)},
               {"fit", command.fit}},
              add};
}

Edit MakeEdit(const protocol::RemoveMateCommand& command) {
  const std::string name = fmt::format("m{}", command.mate);
  return Edit{"remove mate",
              {{"command", command.kName}, {"mate", command.mate}},
              [name](product::Product* product) -> Result<void> {
                const auto removed = mates::RemoveMateAndPlace(product, name);
                return removed ? Result<void>() : Result<void>(Unexpected(removed.error()));
              }};
}

Result<Edit> MakeEdit(const Json& command) {
  const auto name = TextAt(command, "command");
  if (!name) {
    return Unexpected(name.error());
  }
  if (*name == protocol::AssignFitCommand::kName) {
    return ReadEdit<protocol::AssignFitCommand>(command);
  }
  if (*name == protocol::AddMateCommand::kName) {
    return ReadEdit<protocol::AddMateCommand>(command);
  }
  if (*name == protocol::RemoveMateCommand::kName) {
    return ReadEdit<protocol::RemoveMateCommand>(command);
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
