#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/result.h"
#include "product/product.h"

namespace hvas::studio {

/** A change of a product. */
using ChangeFn = std::function<Result<void>(product::Product*)>;

/** A change of the product that somebody has asked for. */
struct Edit {
  std::string what;                ///< For the list of what can be undone.
  nlohmann::ordered_json command;  ///< That it can be made from again; null: it cannot.
  ChangeFn change;
};

namespace protocol {
struct AssignFitCommand;
struct AddMateCommand;
struct RemoveMateCommand;
}  // namespace protocol

/** The edit that a command asks for. */
[[nodiscard]] Edit MakeEdit(const protocol::AssignFitCommand& command);
[[nodiscard]] Edit MakeEdit(const protocol::AddMateCommand& command);
[[nodiscard]] Edit MakeEdit(const protocol::RemoveMateCommand& command);

/** The edit of one of these commands as JSON. Errors (kInvalid): it is none of them, or lacks a
 field. */
[[nodiscard]] Result<Edit> MakeEdit(const nlohmann::ordered_json& command);

/** Many of them, one after the other. Errors: of the first that is no edit. */
[[nodiscard]] Result<ChangeFn> MakeChangeOf(const std::vector<nlohmann::ordered_json>& commands);

}  // namespace hvas::studio
