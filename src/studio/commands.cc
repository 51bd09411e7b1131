// Handlers of the commands in docs/protocol.md, in its order.

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "base/clock.h"
#include "studio/edit.h"
#include "studio/event_json.h"
#include "studio/hub.h"
#include "studio/json_fields.h"

namespace hvas::studio {
namespace {

/** Empty result of a command that has succeeded. */
Result<Json> Done(const Result<void>& result) {
  return result ? Result<Json>(Json::object()) : Result<Json>(Unexpected(result.error()));
}

}  // namespace

const std::map<std::string, Hub::Command, std::less<>>& Hub::Commands() {
  static const std::map<std::string, Command, std::less<>> commands{
      {"open", {Right::kLease, &Hub::DoOpen}},
      {"cancel", {Right::kLease, &Hub::DoCancel}},
      {"take", {Right::kHand, &Hub::DoTake}},
      {"release", {Right::kHand, &Hub::DoRelease}},
      {"forces", {Right::kAnybody, &Hub::DoForces}},
      {"demo", {Right::kLease, &Hub::DoDemo}},
      {"next", {Right::kLease, &Hub::DoNext}},
      {"undo", {Right::kLease, &Hub::DoUndo}},
      {"redo", {Right::kLease, &Hub::DoRedo}},
      {"reset", {Right::kLease, &Hub::DoReset}},
      {"hands", {Right::kLease, &Hub::DoHands}},
      {"devices", {Right::kAnybody, &Hub::DoDevices}},
      {"use", {Right::kLease, &Hub::DoUse}},
      {"record", {Right::kLease, &Hub::DoRecord}},
      {"rename_recording", {Right::kLease, &Hub::DoRenameRecording}},
      {"delete_recording", {Right::kLease, &Hub::DoDeleteRecording}},
      {"assign_fit", {Right::kLease, &Hub::DoEdit}},
      {"add_mate", {Right::kLease, &Hub::DoEdit}},
      {"remove_mate", {Right::kLease, &Hub::DoEdit}},
      {"measure", {Right::kAnybody, &Hub::DoMeasure}},
      {"path", {Right::kAnybody, &Hub::DoPath}},
      {"lease", {Right::kAnybody, &Hub::DoLease}},
      {"status", {Right::kAnybody, &Hub::DoStatus}},
      {"study", {Right::kAnybody, &Hub::DoStudy}},
  };
  return commands;
}

Result<Json> Hub::DoOpen(const Json& command) {
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

Result<Json> Hub::DoCancel() {
  workbench_->Cancel();
  return Json::object();
}

Result<Json> Hub::DoTake(const Json& command) {
  const auto hand = HandAt(command);
  const auto id = IndexAt(command, "occurrence");
  if (!hand || !id) {
    return Unexpected(!hand ? hand.error() : id.error());
  }
  const auto X_WH = workbench_->Take(*hand, product::OccurrenceId(*id));
  if (!X_WH) {
    return Unexpected(X_WH.error());
  }
  return Json{{"hand", ToJson(*X_WH)}};
}

Result<Json> Hub::DoRelease(const Json& command) {
  const auto hand = HandAt(command);
  return hand ? Done(workbench_->Release(*hand)) : Result<Json>(Unexpected(hand.error()));
}

Result<Json> Hub::DoForces(const Caller& caller, const Json& command) {
  const auto is_off = FlagAt(command, "off");
  if (!is_off) {
    return Unexpected(is_off.error());
  }
  if (!*is_off && !caller.has_lease) {
    return Fail(ErrorCode::kInvalid, "only the user in control can switch the forces on", "forces",
                "ask for control first");
  }
  workbench_->SetForcesOff(*is_off);
  Broadcast({{"event", "forces"}, {"off", *is_off}, {"by", caller.id}});
  return Json::object();
}

Result<Json> Hub::DoDemo(const Json& command) {
  const auto is_on = FlagAt(command, "on");
  if (!is_on) {
    return Unexpected(is_on.error());
  }
  return Done(workbench_->SetDemo(*is_on));
}

Result<Json> Hub::DoNext() {
  return Done(workbench_->DoNext());
}

Result<Json> Hub::DoUndo() {
  return Done(workbench_->Undo());
}

Result<Json> Hub::DoRedo() {
  return Done(workbench_->Redo());
}

Result<Json> Hub::DoReset() {
  return Done(workbench_->Reset());
}

Result<Json> Hub::DoHands(const Json& command) {
  const auto count = IndexAt(command, "count");
  return count ? Done(workbench_->SetHandCount(*count)) : Result<Json>(Unexpected(count.error()));
}

Result<Json> Hub::DoDevices() {
  workbench_->SearchDevices();
  return workbench_->devices();
}

Result<Json> Hub::DoUse(const Json& command) {
  const auto hand = HandAt(command);
  const auto device = TextAt(command, "device");
  const auto scale = NumberAt(command, "scale", {0, 1000}, 0);
  if (!hand || !device || !scale) {
    return Unexpected(!hand ? hand.error() : !device ? device.error() : scale.error());
  }
  return Done(workbench_->UseDevice(*hand, *device, *scale));
}

Result<Json> Hub::DoRecord(const Json& command) {
  const auto is_on = FlagAt(command, "on");
  if (!is_on) {
    return Unexpected(is_on.error());
  }
  return Done(*is_on ? workbench_->StartRecording(TextAt(command, "name").value_or(""))
                     : workbench_->StopRecording());
}

Result<Json> Hub::DoRenameRecording(const Json& command) {
  const auto id = TextAt(command, "recording");
  const auto name = TextAt(command, "name");
  if (!id || !name) {
    return Unexpected(!id ? id.error() : name.error());
  }
  return Done(workbench_->RenameRecording(*id, *name));
}

Result<Json> Hub::DoDeleteRecording(const Json& command) {
  const auto id = TextAt(command, "recording");
  return id ? Done(workbench_->DeleteRecording(*id)) : Result<Json>(Unexpected(id.error()));
}

Result<Json> Hub::DoEdit(const Json& command) {
  const auto edit = MakeEdit(command);
  return edit ? Done(workbench_->Change(*edit)) : Result<Json>(Unexpected(edit.error()));
}

Result<Json> Hub::DoMeasure(const Json& command) {
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

Result<std::vector<std::size_t>> Hub::LeasesAt(const Json& command) const {
  if (!command.contains("hand")) {
    return std::vector<std::size_t>{0, 1};
  }
  const auto hand = HandAt(command);
  if (!hand) {
    return Unexpected(hand.error());
  }
  return std::vector<std::size_t>{*hand};
}

Result<Json> Hub::RequestLease(const Caller& caller, const std::vector<std::size_t>& hands) {
  std::string holder;
  for (const std::size_t hand : hands) {
    if (leases_[hand].empty()) {
      leases_[hand] = caller.id;
    } else if (leases_[hand] != caller.id) {
      holder = leases_[hand];
    }
  }
  BroadcastRoles();
  if (holder.empty()) {
    return Json::object();
  }
  const Json asks{{"event", "lease_asked"}, {"by", caller.id}, {"hands", hands}};
  clients_[holder].link->SendText(asks.dump());
  return Json{{"waits_for", holder}};
}

Result<Json> Hub::DoLease(const Caller& caller, const Json& command) {
  const auto action = TextAt(command, "action");
  const auto hands = LeasesAt(command);
  if (!action || !hands) {
    return Unexpected(!action ? action.error() : hands.error());
  }
  if (*action == "request" && caller.role == Role::kOperator) {
    return RequestLease(caller, *hands);
  }
  const std::vector<std::size_t> own = HandsOf(caller.id);
  std::vector<std::size_t> given;
  std::set_intersection(own.begin(), own.end(), hands->begin(), hands->end(),
                        std::back_inserter(given));
  if (*action == "release" && !given.empty()) {
    GiveLease(given, "");
    return Json::object();
  }
  if (*action == "give" && !given.empty()) {
    const std::string to = TextAt(command, "to").value_or("");
    const auto found = clients_.find(to);
    if (found == clients_.end() || found->second.role != Role::kOperator) {
      return Fail(ErrorCode::kNotFound, "there is no such operator", to, "");
    }
    GiveLease(given, to);
    return Json::object();
  }
  return Fail(ErrorCode::kInvalid, "control cannot be given or asked for in this way now", *action,
              caller.role == Role::kOperator ? "" : "this link is for viewers");
}

Result<Json> Hub::DoStatus() {
  return status_;
}

Result<Json> Hub::DoStudy(const Caller& caller, const Json& command) {
  if (desk_ == nullptr) {
    return Fail(ErrorCode::kInvalid, "this studio does not run a study", "study",
                "start the studio with --study and --participant");
  }
  auto result = desk_->Do(caller.role, command, MonotonicNs());
  if (result && TextAt(command, "action").value_or("") != "state") {
    BroadcastStudyState();
  }
  return result;
}

}  // namespace hvas::studio
