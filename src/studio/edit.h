#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/result.h"
#include "product/product.h"
#include "studio/json.h"

namespace hvas::studio {

/** A change of a product. */
using ChangeFn = std::function<Result<void>(product::Product*)>;

/** A change of the product that a client has requested. */
struct Edit {
  std::string what;  ///< Description in the undo list.
  Json command;      ///< Command to repeat it from; null: it cannot be repeated.
  ChangeFn change;
};

namespace protocol {
struct AssignFitCommand;
struct AddMateCommand;
struct RemoveMateCommand;
}  // namespace protocol

/** Makes the edit that a command asks for. */
[[nodiscard]] Edit MakeEdit(const protocol::AssignFitCommand& command);
[[nodiscard]] Edit MakeEdit(const protocol::AddMateCommand& command);
[[nodiscard]] Edit MakeEdit(const protocol::RemoveMateCommand& command);

/** Makes the edit of a command assign_fit, add_mate or remove_mate as JSON. Errors: kInvalid for
 another command, or one that lacks a field. */
[[nodiscard]] Result<Edit> MakeEdit(const Json& command);

/** Combines commands into one change that applies them in order. Errors: the first of MakeEdit. */
[[nodiscard]] Result<ChangeFn> CombineEdits(const std::vector<Json>& commands);

}  // namespace hvas::studio
