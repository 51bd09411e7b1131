// What clients may ask for: the commands of docs/protocol.md, in its order.

#include <algorithm>

#include <fmt/format.h>

#include "mates/assignments.h"
#include "mates/user_mate.h"
#include "studio/event_json.h"
#include "studio/hub.h"
#include "studio/json_fields.h"

namespace hvas::studio {
namespace {

/** The empty result of a command that was obeyed. */
Result<Json> Done(const Result<void>& result) {
  return result ? Result<Json>(Json::object()) : Result<Json>(Unexpected(result.error()));
}

}  // namespace

const std::map<std::string, Hub::Command, std::less<>>& Hub::Commands() {
  static const std::map<std::string, Command, std::less<>> commands{
      {"open", {Right::kLease, &Hub::DoOpen}},
      {"cancel", {Right::kLease, &Hub::DoCancel}},
      {"take", {Right::kLease, &Hub::DoTake}},
      {"release", {Right::kLease, &Hub::DoRelease}},
      {"forces", {Right::kAnybody, &Hub::DoForces}},
      {"demo", {Right::kLease, &Hub::DoDemo}},
      {"next", {Right::kLease, &Hub::DoNext}},
      {"undo", {Right::kLease, &Hub::DoUndo}},
      {"redo", {Right::kLease, &Hub::DoRedo}},
      {"reset", {Right::kLease, &Hub::DoReset}},
      {"assign_fit", {Right::kLease, &Hub::DoAssignFit}},
      {"add_mate", {Right::kLease, &Hub::DoAddMate}},
      {"remove_mate", {Right::kLease, &Hub::DoRemoveMate}},
      {"measure", {Right::kAnybody, &Hub::DoMeasure}},
      {"lease", {Right::kAnybody, &Hub::DoLease}},
      {"status", {Right::kAnybody, &Hub::DoStatus}},
  };
  return commands;
}

Result<Json> Hub::DoOpen(const Caller& caller, const Json& command) {
  (void)caller;
  if (const auto id = TextAt(command, "example")) {
    const auto found = std::find_if(examples_.begin(), examples_.end(),
                                    [&](const Example& example) { return example.id == *id; });
    if (found == examples_.end()) {
      return Fail(ErrorCode::kNotFound, "there is no such example", *id, "");
    }
    workbench_->Open(found->file, found->name);
    return Json::object();
  }
  const auto id = TextAt(command, "upload");
  if (!id) {
    return Unexpected(id.error());
  }
  const auto found = uploads_.find(*id);
  if (found == uploads_.end()) {
    return Fail(ErrorCode::kNotFound, "there is no such upload", "", "send the file again");
  }
  workbench_->Open(found->second.file, found->second.name);
  return Json::object();
}

Result<Json> Hub::DoCancel(const Caller& caller, const Json& command) {
  (void)caller;
  (void)command;
  workbench_->Cancel();
  return Json::object();
}

Result<Json> Hub::DoTake(const Caller& caller, const Json& command) {
  (void)caller;
  const auto id = IndexAt(command, "occurrence");
  if (!id) {
    return Unexpected(id.error());
  }
  const auto X_WH = workbench_->Take(product::OccurrenceId(*id));
  if (!X_WH) {
    return Unexpected(X_WH.error());
  }
  return Json{{"hand", ToJson(*X_WH)}};
}

Result<Json> Hub::DoRelease(const Caller& caller, const Json& command) {
  (void)caller;
  (void)command;
  return Done(workbench_->Release());
}

Result<Json> Hub::DoForces(const Caller& caller, const Json& command) {
  const auto is_off = FlagAt(command, "off");
  if (!is_off) {
    return Unexpected(is_off.error());
  }
  if (!*is_off && !caller.has_lease) {
    return Fail(ErrorCode::kInvalid, "only whoever steers can switch the forces on", "forces",
                "ask for the lease first");
  }
  workbench_->SetForcesOff(*is_off);
  Broadcast({{"event", "forces"}, {"off", *is_off}, {"by", caller.id}});
  return Json::object();
}

Result<Json> Hub::DoDemo(const Caller& caller, const Json& command) {
  (void)caller;
  const auto is_on = FlagAt(command, "on");
  if (!is_on) {
    return Unexpected(is_on.error());
  }
  return Done(workbench_->SetDemo(*is_on));
}

Result<Json> Hub::DoNext(const Caller& caller, const Json& command) {
  (void)caller;
  (void)command;
  return Done(workbench_->DoNext());
}

Result<Json> Hub::DoUndo(const Caller& caller, const Json& command) {
  (void)caller;
  (void)command;
  return Done(workbench_->Undo());
}

Result<Json> Hub::DoRedo(const Caller& caller, const Json& command) {
  (void)caller;
  (void)command;
  return Done(workbench_->Redo());
}

Result<Json> Hub::DoReset(const Caller& caller, const Json& command) {
  (void)caller;
  (void)command;
  return Done(workbench_->Reset());
}

Result<Json> Hub::DoAssignFit(const Caller& caller, const Json& command) {
  (void)caller;
  const auto mate = IndexAt(command, "mate");
  const auto fit = TextAt(command, "fit");
  if (!mate || !fit) {
    return Unexpected(!mate ? mate.error() : fit.error());
  }
  const std::string assignment = fmt::format("m{}={}", *mate, *fit);
  return Done(workbench_->Change(
      fmt::format("fit {}", assignment),
      [assignment](product::Product* product) { return mates::AssignFit(product, assignment); }));
}

Result<Json> Hub::DoAddMate(const Caller& caller, const Json& command) {
  (void)caller;
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
  return Done(workbench_->Change("add mate", add));
}

Result<Json> Hub::DoRemoveMate(const Caller& caller, const Json& command) {
  (void)caller;
  const auto mate = IndexAt(command, "mate");
  if (!mate) {
    return Unexpected(mate.error());
  }
  const std::string name = fmt::format("m{}", *mate);
  return Done(workbench_->Change("remove mate", [name](product::Product* product) -> Result<void> {
    const auto removed = mates::RemoveMate(product, name);
    return removed ? Result<void>() : Result<void>(Unexpected(removed.error()));
  }));
}

Result<Json> Hub::DoMeasure(const Caller& caller, const Json& command) {
  (void)caller;
  const auto scene = workbench_->scene();
  if (scene == nullptr) {
    return Fail(ErrorCode::kNotFound, "no product is open", "", "open a file or an example first");
  }
  const auto a = FaceAt(command, "a");
  if (!a) {
    return Unexpected(a.error());
  }
  std::optional<PickedFace> second;
  if (command.contains("b") && !command["b"].is_null()) {
    const auto b = FaceAt(command, "b");
    if (!b) {
      return Unexpected(b.error());
    }
    second = *b;
  }
  return Measure(*scene->model, workbench_->state(), *a, second);
}

Result<Json> Hub::DoLease(const Caller& caller, const Json& command) {
  const auto action = TextAt(command, "action");
  if (!action) {
    return Unexpected(action.error());
  }
  if (*action == "request" && caller.role == Role::kOperator && lease_.empty()) {
    GiveLease(caller.id);
    return Json::object();
  }
  if (*action == "request" && caller.role == Role::kOperator) {
    const Json asks{{"event", "lease_asked"}, {"by", caller.id}};
    clients_[lease_].link->SendText(asks.dump());
    return Json{{"waits_for", lease_}};
  }
  if (*action == "release" && caller.has_lease) {
    GiveLease("");
    return Json::object();
  }
  if (*action == "give" && caller.has_lease) {
    const std::string to = TextAt(command, "to").value_or("");
    const auto found = clients_.find(to);
    if (found == clients_.end() || found->second.role != Role::kOperator) {
      return Fail(ErrorCode::kNotFound, "there is no such operator", to, "");
    }
    GiveLease(to);
    return Json::object();
  }
  return Fail(ErrorCode::kInvalid, "this cannot be done with the lease now", *action,
              caller.role == Role::kViewer ? "this link is for looking on" : "");
}

Result<Json> Hub::DoStatus(const Caller& caller, const Json& command) {
  (void)caller;
  (void)command;
  return status_;
}

}  // namespace hvas::studio
