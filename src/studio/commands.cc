// Handlers of the commands in docs/protocol.md, in its order.

#include "studio/commands.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "studio/edit.h"
#include "studio/event_json.h"
#include "studio/hub.h"
#include "studio/json_fields.h"

namespace hvas::studio {
namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;  // A definition.

/** Empty result of a command that has succeeded. */
Result<Json> Done(const Result<void>& result) {
  return result ? Result<Json>(Json::object()) : Result<Json>(Unexpected(result.error()));
}

}  // namespace

template <typename Fields, typename Do>
std::pair<const std::string, Hub::Command> Hub::Entry(Do handler) {
  return {
      Fields::kName,
      {Fields::kRight, [handler](Hub* hub, const Caller& caller, const Json& json) -> Result<Json> {
         auto fields = protocol::ReadFields<Fields>(json);
         if (!fields) {
           return Unexpected(fields.error());
         }
         if constexpr (std::is_invocable_v<Do, Hub*, const Caller&, const Fields&>) {
           return std::invoke(handler, hub, caller, *fields);
         } else if constexpr (std::is_invocable_v<Do, Hub*, const Fields&>) {
           return std::invoke(handler, hub, *fields);
         } else {
           return std::invoke(handler, hub);
         }
       }}};
}

const std::map<std::string, Hub::Command, std::less<>>& Hub::Commands() {
  static const std::map<std::string, Command, std::less<>> commands{
      Entry<protocol::OpenCommand>(&Hub::DoOpen),
      Entry<protocol::CancelCommand>(&Hub::DoCancel),
      Entry<protocol::TakeCommand>(&Hub::DoTake),
      Entry<protocol::ReleaseCommand>(&Hub::DoRelease),
      Entry<protocol::HelpCommand>(&Hub::DoHelp),
      Entry<protocol::HandOverCommand>(&Hub::DoHandOver),
      Entry<protocol::AskPartCommand>(&Hub::DoAskPart),
      Entry<protocol::HandsCommand>(&Hub::DoHands),
      Entry<protocol::DevicesCommand>(&Hub::DoDevices),
      Entry<protocol::UseCommand>(&Hub::DoUse),
      Entry<protocol::ForcesCommand>(&Hub::DoForces),
      Entry<protocol::DemoCommand>(&Hub::DoDemo),
      Entry<protocol::NextCommand>(&Hub::DoNext),
      Entry<protocol::PlanRemovalCommand>(&Hub::DoPlanRemoval),
      Entry<protocol::TakeOutCommand>(&Hub::DoTakeOut),
      Entry<protocol::FindOrdersCommand>(&Hub::DoFindOrders),
      Entry<protocol::CheckOrderCommand>(&Hub::DoCheckOrder),
      Entry<protocol::SetOrderCommand>(&Hub::DoSetOrder),
      Entry<protocol::ExplainGapCommand>(&Hub::DoExplainGap),
      Entry<protocol::UndoCommand>(&Hub::DoUndo),
      Entry<protocol::RedoCommand>(&Hub::DoRedo),
      Entry<protocol::ResetCommand>(&Hub::DoReset),
      Entry<protocol::RecordCommand>(&Hub::DoRecord),
      Entry<protocol::RenameRecordingCommand>(&Hub::DoRenameRecording),
      Entry<protocol::ShareRecordingCommand>(&Hub::DoShareRecording),
      Entry<protocol::DeleteRecordingCommand>(&Hub::DoDeleteRecording),
      Entry<protocol::AssignFitCommand>(&Hub::DoEdit<protocol::AssignFitCommand>),
      Entry<protocol::AddMateCommand>(&Hub::DoEdit<protocol::AddMateCommand>),
      Entry<protocol::RemoveMateCommand>(&Hub::DoEdit<protocol::RemoveMateCommand>),
      Entry<protocol::MeasureCommand>(&Hub::DoMeasure),
      Entry<protocol::PathCommand>(&Hub::DoPath),
      Entry<protocol::LeaseCommand>(&Hub::DoLease),
      Entry<protocol::IntroduceCommand>(&Hub::DoIntroduce),
      Entry<protocol::LookCommand>(&Hub::DoLook),
      Entry<protocol::AddNoteCommand>(&Hub::DoAddNote),
      Entry<protocol::RemoveNoteCommand>(&Hub::DoRemoveNote),
      Entry<protocol::StatusCommand>(&Hub::DoStatus),
      Entry<protocol::StudyCommand>(&Hub::DoStudy),
  };
  return commands;
}

Result<Json> Hub::DoOpen(const Caller& caller, const protocol::OpenCommand& command) {
  if (command.example) {
    const auto found = std::find_if(examples_.begin(), examples_.end(), [&](const Example& one) {
      return one.id == *command.example && (caller.visitor.is_owner || !one.is_recent);
    });
    if (found == examples_.end()) {
      return Fail(ErrorCode::kNotFound, "there is no such example", "example", "");
    }
    workbench_->opener().Open(found->file, found->name);
    return Json::object();
  }
  if (!command.upload) {
    return Fail(ErrorCode::kInvalid, R"("example" or "upload" must be a text)", "command",
                "load the page again");
  }
  const auto found = uploads_.Find(*command.upload);
  if (!found) {
    return Fail(ErrorCode::kNotFound, "there is no such upload", "", "send the file again");
  }
  workbench_->opener().Open(found->file, found->name);
  return Json::object();
}

Result<Json> Hub::DoCancel() {
  workbench_->opener().Cancel();
  return Json::object();
}

Result<Json> Hub::DoTake(const protocol::TakeCommand& command) {
  const auto taken = workbench_->hands().Take(
      command.hand, product::OccurrenceId(command.occurrence),
      command.alone ? simulation::TakeExtent::kAlone : simulation::TakeExtent::kWhole);
  if (!taken) {
    return Unexpected(taken.error());
  }
  return ToJson(*taken);
}

Result<Json> Hub::DoRelease(const protocol::ReleaseCommand& command) {
  return Done(workbench_->hands().Release(command.hand));
}

Result<Json> Hub::DoHelp(const protocol::HelpCommand& command) {
  const auto taken = workbench_->hands().Help(command.hand, command.other);
  return taken ? Result<Json>(ToJson(*taken)) : Result<Json>(Unexpected(taken.error()));
}

Result<Json> Hub::DoHandOver(const protocol::HandOverCommand& command) {
  return Done(workbench_->hands().HandOver(command.hand, command.to));
}

Result<Json> Hub::DoAskPart(const Caller& caller, const protocol::AskPartCommand& command) {
  const std::vector<std::size_t> own = leases_.HandsOf(caller.id);
  const auto free =
      std::find_if(own.begin(), own.end(), [&](std::size_t hand) { return hand != command.hand; });
  if (free == own.end()) {
    return Fail(ErrorCode::kInvalid, "no hand of this page could take the part", "",
                "ask for control of a hand first");
  }
  const auto holder = clients_.find(leases_.holder(command.hand));
  if (holder == clients_.end() || holder->first == caller.id) {
    return Done(workbench_->hands().HandOver(command.hand, *free));  // Nobody has to agree.
  }
  const Json asks{
      {"event", "part_asked"}, {"by", caller.id}, {"hand", command.hand}, {"to", *free}};
  holder->second.link->SendText(asks.dump());
  return Json::object();
}

Result<Json> Hub::DoForces(const Caller& caller, const protocol::ForcesCommand& command) {
  if (!command.off && !caller.has_lease && !caller.visitor.is_owner) {
    return Fail(ErrorCode::kInvalid, "only the user in control can switch the forces on", "forces",
                "ask for control first");
  }
  workbench_->live().SetForcesOff(command.off);
  Broadcast({{"event", "forces"}, {"off", command.off}, {"by", caller.id}});
  return Json::object();
}

Result<Json> Hub::DoDemo(const protocol::DemoCommand& command) {
  if (command.on) {
    return Done(workbench_->demo().Start());
  }
  workbench_->demo().Stop();
  return Json::object();
}

Result<Json> Hub::DoNext() {
  return Done(workbench_->demo().DoNext());
}

Result<Json> Hub::DoSetOrder(const protocol::SetOrderCommand& command) {
  return Done(workbench_->orders().Set(command.occurrences));
}

Result<Json> Hub::DoUndo() {
  return Done(workbench_->edits().Undo());
}

Result<Json> Hub::DoRedo() {
  return Done(workbench_->edits().Redo());
}

Result<Json> Hub::DoReset() {
  return Done(workbench_->edits().Reset());
}

Result<Json> Hub::DoHands(const protocol::HandsCommand& command) {
  return Done(workbench_->hands().SetCount(command.count));
}

Result<Json> Hub::DoDevices() {
  workbench_->hands().SearchDevices();
  return workbench_->hands().DescribeDevices();
}

Result<Json> Hub::DoUse(const protocol::UseCommand& command) {
  return Done(workbench_->hands().UseDevice(command.hand, command.device, command.scale));
}

Result<Json> Hub::DoLater(const Caller& caller, std::function<Result<void>()> work) {
  workbench_->recordings().PostDiskWork(
      [bench = workbench_, to = caller.id, id = IdOf(caller.command), work = std::move(work)] {
        bench->events().Publish(MakeDeferredReply(to, id, Done(work())));
      });
  return MakeDeferredResult();
}

Result<Json> Hub::DoRecord(const Caller& caller, const protocol::RecordCommand& command) {
  return DoLater(caller, [recordings = &workbench_->recordings(), command] {
    return command.on ? recordings->Start(MakeOneLine(command.name)) : recordings->Stop();
  });
}

Result<Json> Hub::DoRenameRecording(const Caller& caller,
                                    const protocol::RenameRecordingCommand& command) {
  return DoLater(caller, [recordings = &workbench_->recordings(), command] {
    return recordings->Rename(command.recording, MakeOneLine(command.name));
  });
}

Result<Json> Hub::DoShareRecording(const Caller& caller,
                                   const protocol::ShareRecordingCommand& command) {
  return DoLater(caller, [recordings = &workbench_->recordings(), command] {
    return recordings->Share(command.recording, command.shared);
  });
}

Result<Json> Hub::DoDeleteRecording(const Caller& caller,
                                    const protocol::DeleteRecordingCommand& command) {
  return DoLater(caller, [recordings = &workbench_->recordings(), command] {
    return recordings->Delete(command.recording);
  });
}

template <typename Fields>
Result<Json> Hub::DoEdit(const Fields& command) {
  return Done(workbench_->edits().Change(MakeEdit(command)));
}

Result<Json> Hub::DoMeasure(const protocol::MeasureCommand& command) {
  const auto scene = workbench_->live().FindScene();
  if (!scene) {
    return Unexpected(scene.error());
  }
  return Measure(*(*scene)->model, workbench_->live().state(), command.a, command.b);
}

Result<Json> Hub::RequestLease(const Caller& caller, const std::vector<std::size_t>& hands) {
  const auto obstacle = leases_.Request(hands, caller.id, caller.visitor, caller.now_ns);
  BroadcastRoles();
  if (!obstacle.holder.empty()) {
    const Json asks{{"event", "lease_asked"}, {"by", caller.id}, {"hands", hands}};
    clients_[obstacle.holder].link->SendText(asks.dump());
    return Json{{"waits_for", obstacle.holder}};
  }
  if (obstacle.wait_ns > 0) {
    return Fail(ErrorCode::kInvalid, "the page of who has this hand is gone for a moment", "hand",
                fmt::format("ask again in {} s", (obstacle.wait_ns + kNsPerS - 1) / kNsPerS));
  }
  return Json::object();
}

Result<Json> Hub::DoLease(const Caller& caller, const protocol::LeaseCommand& command) {
  using protocol::LeaseAction;
  if (command.action == LeaseAction::kRequest) {
    return RequestLease(caller, command.hand ? std::vector<std::size_t>{*command.hand}
                                             : leases_.ListHandsInControl());
  }
  std::vector<std::size_t> given = leases_.HandsOf(caller.id);
  if (command.hand) {
    std::erase_if(given, [&](std::size_t hand) { return hand != *command.hand; });
  }
  if (given.empty()) {
    return Fail(ErrorCode::kInvalid, "only the client that has the lease can give it or release it",
                protocol::kLeaseActions[static_cast<std::size_t>(command.action)],
                "ask for the lease first");
  }
  if (command.action == LeaseAction::kRelease) {
    leases_.Release(given);
    BroadcastRoles();
    return Json::object();
  }
  const std::string to = command.to.value_or("");
  const auto found = clients_.find(to);
  if (found == clients_.end() || found->second.visitor.role != Role::kOperator) {
    return Fail(ErrorCode::kNotFound, "there is no such operator", to, "");
  }
  leases_.Give(given, to, found->second.visitor);
  BroadcastRoles();
  return Json::object();
}

Result<Json> Hub::DoIntroduce(const Caller& caller, const protocol::IntroduceCommand& command) {
  Client& client = clients_[caller.id];
  const std::string name = MakeOneLine(command.name);
  constexpr std::int64_t kPauseNs = kNsPerS / 2;  // All clients are told of it: a choice.
  if (name != client.name && client.named_ns > caller.now_ns - kPauseNs) {
    return Fail(ErrorCode::kOutOfResource, "the name was changed a moment ago", "name",
                "try again in a second");
  }
  if (name != client.name) {
    client.named_ns = caller.now_ns;
    client.name = name;
    BroadcastRoles();
  }
  return Json::object();
}

Result<Json> Hub::DoLook(const Caller& caller, const protocol::LookCommand& command) {
  const Json looking{{"event", "looking"},
                     {"client", caller.id},
                     {"eye_m", ToJson(command.eye)},
                     {"target_m", ToJson(command.target)},
                     {"p_m", command.p ? ToJson(*command.p) : Json(nullptr)}};
  const std::string text = looking.dump();
  for (const auto& [id, client] : clients_) {
    if (id != caller.id) {
      SendTo(client, looking, text);
    }
  }
  return Json::object();
}

Result<Json> Hub::DoAddNote(const Caller& caller, const protocol::AddNoteCommand& command) {
  const std::string& name = clients_[caller.id].name;
  const auto id = workbench_->notes().Add({name.empty() ? caller.id : name, command.text,
                                           product::OccurrenceId(command.occurrence), command.p_B});
  return id ? Result<Json>(Json{{"note", *id}}) : Result<Json>(Unexpected(id.error()));
}

Result<Json> Hub::DoRemoveNote(const protocol::RemoveNoteCommand& command) {
  return Done(workbench_->notes().Remove(command.note));
}

Result<Json> Hub::DoStatus() {
  return status_;
}

Result<Json> Hub::DoStudy(const Caller& caller, const protocol::StudyCommand& /*command*/) {
  if (desk_ == nullptr) {
    return Fail(ErrorCode::kInvalid, "this studio does not run a study", "study",
                "start the studio with --study and --participant");
  }
  auto result = desk_->Do(caller.visitor.role, caller.command, workbench_->live().clock().NowNs());
  if (result && TextOr(caller.command, "action", "") != "state") {
    BroadcastStudyState();
  }
  return result;
}

}  // namespace hvas::studio
