#include "studio/hub.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/error_name.h"
#include "studio/event_json.h"
#include "studio/frames.h"
#include "studio/json_fields.h"

namespace hvas::studio {
namespace {

constexpr std::size_t kLongestForcesOff = 1000;  // [bytes] of such a command: a choice.

bool IsForcesOff(const Json& command) {
  return TextAt(command, "command").value_or("") == "forces" &&
         FlagAt(command, "off").value_or(false);
}

/** Removes the true forces, from which fits could be told apart better than by hand. */
LiveFrame RemoveTrueForces(const LiveFrame& frame) {
  LiveFrame felt = frame;
  for (haptics::TickOutput& tick : felt.frame.ticks) {
    tick.F_true_W = {};
    tick.axial_true = 0;
    tick.f_C_W = Vec3::Zero();
  }
  return felt;
}

std::string Print(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Hub::Hub(Workbench* workbench, std::vector<Example> examples, AuditLog* audit)
    : workbench_(workbench),
      examples_(std::move(examples)),
      audit_(audit),
      status_({{"event", "status"}}) {}

Result<void> Hub::CheckRoom(const Visitor& visitor) const {
  std::size_t of_link = 0;
  std::size_t of_others = 0;  // Than the owner.
  for (const auto& [id, client] : clients_) {
    of_others += client.visitor.is_owner ? 0 : 1;
    of_link += !client.visitor.is_owner && client.visitor.link() == visitor.link() ? 1 : 0;
  }
  const std::size_t most_of_link =
      visitor.role == Role::kViewer ? kMaxViewingClients : kMaxClientsOfLink;
  const bool has_room = visitor.is_owner
                            ? clients_.size() < kMaxClients
                            : of_link < most_of_link && of_others < kMaxClients - kKeptForOwner;
  return has_room ? Result<void>()
                  : Fail(ErrorCode::kOutOfResource,
                         "as many pages are open as this link, or this studio, admits", "",
                         "close another page of the studio");
}

Result<std::string> Hub::Join(const Visitor& visitor, ClientLink* link, std::int64_t now_ns) {
  if (auto room = CheckRoom(visitor); !room) {
    return Unexpected(room.error());
  }
  const std::string id = fmt::format("c{}", ++last_id_);
  Client& client = clients_[id];
  client.visitor = visitor;
  client.link = link;
  if (visitor.role == Role::kOperator) {
    leases_.Return(id, visitor, /*takes_free=*/desk_ == nullptr, now_ns);
  } else if (visitor.role == Role::kParticipant) {
    leases_.Give({0}, id, visitor);
  }
  link->SendText(MakeHello(id, client).dump());
  for (const Json& event : workbench_->MakeCatchUpEvents()) {
    SendTo(client, event, event.dump());
  }
  if (desk_ != nullptr) {
    link->SendText(Print(desk_->MakeEvent(visitor.role, workbench_->live().clock().NowNs())));
  }
  BroadcastRoles();
  return id;
}

void Hub::Leave(const std::string& id, std::int64_t now_ns) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) {
    return;
  }
  // A hand without input stays where it is: PointerOperator times out.
  leases_.Lose(id, found->second.visitor, now_ns);
  clients_.erase(found);
  BroadcastRoles();
}

Json Hub::MakeHello(const std::string& id, const Client& client) const {
  Json examples = Json::array();
  for (const Example& example : desk_ == nullptr ? examples_ : std::vector<Example>()) {
    // Where the owner's own files lie is nobody else's business.
    if (client.visitor.is_owner || !example.is_recent) {
      examples.push_back({{"id", example.id},
                          {"name", example.name},
                          {"about", example.about},
                          {"is_recent", example.is_recent}});
    }
  }
  return {{"event", "hello"},
          {"version", protocol::kVersion},
          {"role", ToString(client.visitor.role)},
          {"is_owner", client.visitor.is_owner},
          {"client", id},
          {"has_lease", leases_.holder(0) == id},
          {"hands", MakeHands()},
          {"has_study", desk_ != nullptr},
          {"recording",
           IsShielded(client.visitor.role) ? Json(nullptr) : workbench_->recordings().Describe()},
          {"examples", std::move(examples)},
          {"forces_off", workbench_->live().forces_off()},
          {"has_scene", workbench_->live().scene() != nullptr},
          {"demo", workbench_->live().is_demo()}};
}

void Hub::Broadcast(Json event) {
  if (event.value("event", "") == "hands") {
    event["hands"] = MakeHands();  // the hub adds who holds the leases
  }
  if (event.value("event", "") == "reply") {
    if (const auto waiting = clients_.find(event["to"]); waiting != clients_.end()) {
      waiting->second.link->SendText(Print(event["reply"]));
    }
    return;
  }
  const std::int64_t now_ns = workbench_->live().clock().NowNs();
  const bool has_news = desk_ != nullptr && desk_->OnBenchEvent(event, now_ns);
  if (!event.value("event", "").starts_with("trial_")) {  // events for the study desk only
    const std::string text = Print(event);
    for (auto& [id, client] : clients_) {
      SendTo(client, event, text);
    }
  }
  if (has_news) {
    BroadcastStudyState();
  }
}

void Hub::SendTo(const Client& client, const Json& event, const std::string& text) {
  if (!IsShielded(client.visitor.role)) {
    client.link->SendText(text);
    return;
  }
  constexpr std::array kShown{"scene", "placement", "taken", "dropped",
                              "state", "forces",    "hands", "roles"};
  const std::string name = event.value("event", "");
  if (std::none_of(kShown.begin(), kShown.end(), [&](const char* one) { return name == one; })) {
    return;
  }
  if (name == "dropped") {
    Json shown = event;
    shown.erase("metrics");
    client.link->SendText(Print(shown));
    return;
  }
  client.link->SendText(text);
}

void Hub::BroadcastStudyState() {
  const std::int64_t now_ns = workbench_->live().clock().NowNs();
  for (auto& [id, client] : clients_) {
    client.link->SendText(Print(desk_->MakeEvent(client.visitor.role, now_ns)));
  }
}

Result<void> Hub::CheckStudy(const Caller& caller, const std::string& name) const {
  if (desk_ == nullptr) {
    return {};
  }
  // "lease" is missing from both: the participant holds it.
  constexpr std::array kShielded{"study", "take", "release", "forces", "status"};
  constexpr std::array kExperimenters{"study",   "release", "forces", "status",
                                      "devices", "use",     "measure"};
  const auto has = [&](const auto& names) {
    return std::any_of(names.begin(), names.end(), [&](const char* one) { return name == one; });
  };
  if (!(IsShielded(caller.visitor.role) ? has(kShielded) : has(kExperimenters))) {
    return Fail(ErrorCode::kInvalid, "the command is not available during a study", name,
                "end the study first");
  }
  return name == "take" ? desk_->CheckTake() : Result<void>();
}

Json Hub::MakeRoles() const {
  Json clients = Json::array();
  for (const auto& [id, client] : clients_) {
    clients.push_back({{"id", id},
                       {"name", client.name},
                       {"role", ToString(client.visitor.role)},
                       {"has_lease", leases_.holder(0) == id},
                       {"hands", leases_.HandsOf(id)}});
  }
  return {{"event", "roles"}, {"clients", std::move(clients)}};
}

void Hub::BroadcastRoles() {
  Json roles = MakeRoles();
  if (roles == roles_) {
    return;
  }
  roles_ = roles;
  Broadcast(std::move(roles));
  Broadcast({{"event", "hands"}});
}

Json Hub::MakeHands() const {
  Json hands = workbench_->hands().Describe();
  for (std::size_t i = 0; i < hands.size(); ++i) {
    hands[i]["lease"] = leases_.holder(i).empty() ? Json(nullptr) : Json(leases_.holder(i));
  }
  return hands;
}

void Hub::CloseRevoked() {
  for (auto& [id, client] : clients_) {
    if (!client.link->is_admitted()) {
      client.link->Close("the user who shared this studio has ended the sharing");
    }
  }
}

bool Hub::MaySend(Client* client, std::size_t bytes, std::int64_t now_ns) const {
  const double cost = std::max(1.0, static_cast<double>(bytes) / kBytesOfCommand);
  const double elapsed = 1e-9 * static_cast<double>(now_ns - client->last_command_ns);
  client->last_command_ns = now_ns;
  client->allowance =
      std::min(kCommandBurst, client->allowance + kCommandsPerSecond * std::max(0.0, elapsed));
  if (client->allowance < cost) {
    return false;
  }
  client->allowance -= cost;
  return true;
}

void Hub::OnText(const std::string& id, std::string_view text, std::int64_t now_ns) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) {
    return;
  }
  ClientLink* link = found->second.link;
  // Switching the forces off is exempt from the rate limit (N6); what is long is not even parsed.
  const bool may_send = MaySend(&found->second, text.size(), now_ns);
  const Result<Json> command = may_send || text.size() <= kLongestForcesOff
                                   ? ParseCommand(text)
                                   : Result<Json>(Json::object());
  Result<Json> result = command;
  const bool is_urgent = command && IsForcesOff(*command) && !workbench_->live().forces_off();
  if (!may_send && !is_urgent) {
    result = Fail(ErrorCode::kOutOfResource, "too many commands", "",
                  "send fewer commands for each second");
  } else if (command) {
    result = Execute(id, *command, now_ns);
  }
  NoteCommand(id, found->second, command.value_or(Json::object()), result, now_ns);
  SendReply(link, command, result);
}

void Hub::SendReply(ClientLink* link, const Result<Json>& command, const Result<Json>& result) {
  if (!result || !result->is_discarded()) {
    link->SendText(Print(MakeReply(command ? IdOf(*command) : Json(nullptr), result)));
  }
}

bool Hub::TrySwitchForcesOff(const std::string& id, std::string_view text, std::int64_t now_ns) {
  if (text.size() > kLongestForcesOff || text.find("forces") == std::string_view::npos) {
    return false;
  }
  const Result<Json> command = ParseCommand(text);
  if (!command || !IsForcesOff(*command) || workbench_->live().forces_off()) {
    return false;
  }
  workbench_->live().SetForcesOff(true);
  if (const auto found = clients_.find(id); found != clients_.end()) {
    ClientLink* const link = found->second.link;
    const Result<Json> result = Execute(id, *command, now_ns);
    NoteCommand(id, found->second, *command, result, now_ns);
    SendReply(link, command, result);
  }
  return true;
}

bool Hub::TryRefuseForcesOn(const std::string& id, std::string_view text) {
  const auto found = clients_.find(id);
  const Result<Json> command = ParseCommand(text);
  if (found == clients_.end() || !command || TextAt(*command, "command").value_or("") != "forces" ||
      IsForcesOff(*command)) {
    return false;
  }
  SendReply(found->second.link, command,
            Fail(ErrorCode::kInvalid, "the forces were switched off meanwhile", "forces",
                 "switch them on again"));
  return true;
}

Result<Json> Hub::Execute(const std::string& id, const Json& command, std::int64_t now_ns) {
  const auto name = TextAt(command, "command");
  if (!name) {
    return Unexpected(name.error());
  }
  const auto found = Commands().find(*name);
  if (found == Commands().end()) {
    return Fail(ErrorCode::kNotFound, "there is no such command", *name, "reload the page");
  }
  const Caller caller{id, clients_[id].visitor, leases_.holder(0) == id, command, now_ns};
  if (const auto checked = CheckStudy(caller, *name); !checked) {
    return Unexpected(checked.error());
  }
  if (!MayDo(found->second.right, caller)) {
    return Fail(ErrorCode::kInvalid, "only the user in control can do this", *name,
                ExplainRight(found->second.right, caller));
  }
  return found->second.handler(this, caller, command);
}

std::string Hub::ExplainRight(protocol::Right right, const Caller& caller) {
  if (caller.visitor.role != Role::kOperator) {
    return "this link is for viewers";
  }
  return right == protocol::Right::kOwner ? "ask the user who started this studio"
                                          : "ask for control first";
}

bool Hub::MayDo(protocol::Right right, const Caller& caller) const {
  using protocol::Right;
  switch (right) {
    case Right::kAnybody:
      return true;
    case Right::kOperator:
      return caller.visitor.role == Role::kOperator;
    case Right::kOwner:
      return caller.visitor.is_owner;
    case Right::kLease:
      return caller.has_lease;
    case Right::kHand:
      return leases_.holder(HandAt(caller.command, "hand").value_or(0)) == caller.id;
  }
  return false;
}

void Hub::NoteCommand(const std::string& id, const Client& client, const Json& command,
                      const Result<Json>& result, std::int64_t now_ns) {
  const auto found = Commands().find(TextOr(command, "command", ""));
  const bool is_known = found != Commands().end();
  // What everybody may do changes nothing, but for the forces.
  const bool is_of_interest =
      !is_known || found->second.right != protocol::Right::kAnybody || found->first == "forces";
  if (audit_ == nullptr || (result && !is_of_interest)) {
    return;
  }
  const AuditLog::Entry entry{ToString(client.visitor), client.link->address(), id,
                              DescribeForAudit(command)};
  if (result) {
    audit_->Note(client.visitor.link(), entry, now_ns);
  } else {
    audit_->NoteRefusal(client.visitor.link(), entry, NameOf(result.error().code), now_ns);
  }
}

void Hub::OnBinary(const std::string& id, std::string_view bytes) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) {
    return;
  }
  const auto frames = ReadClientFrames(bytes);
  if (!frames) {
    found->second.link->Close(frames.error().message);
    return;
  }
  Client& client = found->second;
  for (const protocol::Acknowledgement& credit : frames->credits) {
    client.seen_seq = std::max(client.seen_seq, std::min(credit.seq, client.sent_seq));
  }
  constexpr std::uint32_t kGrip = 1;  // Bit 0 (docs/protocol.md).
  const bool may_grip = desk_ == nullptr || desk_->CheckTake().has_value();
  for (const protocol::HandInput& input : frames->inputs) {
    if (input.hand < HandLeases::size() && leases_.holder(input.hand) == id) {
      workbench_->hands().Move(input.hand, PoseOf(input), may_grip && (input.buttons & kGrip) != 0);
    }
  }
  PublishFrame();
}

void Hub::PublishFrame() {
  if (workbench_->live().scene() == nullptr) {
    return;
  }
  const LiveFrame frame = workbench_->live().frame();
  for (auto& [id, client] : clients_) {
    if (client.serial != frame.serial && client.sent_seq - client.seen_seq < kMaxUnseen) {
      client.serial = frame.serial;
      SendFrame(frame, &client);
    }
  }
}

void Hub::SendFrame(const LiveFrame& frame, Client* client) {
  if (client->epoch != frame.epoch) {
    client->epoch = frame.epoch;
    client->shown = {};
  }
  std::string bytes = MakeFrames(IsShielded(client->visitor.role) ? RemoveTrueForces(frame) : frame,
                                 frame.clock_ns, client->sent_seq + 1, &client->shown);
  if (bytes.empty()) {
    return;
  }
  ++client->sent_seq;
  client->link->SendFrames(std::move(bytes));
}

void Hub::PublishStatus() {
  if (desk_ != nullptr && desk_->Poll(workbench_->live().clock().NowNs())) {
    BroadcastStudyState();
  }
  if (const auto status = workbench_->live().TakeStatus()) {
    status_ = MakeStatus(*status);
  }
  status_["clients"] = clients_.size();
  status_["hands"] = Json::array();
  const LiveFrame frame = workbench_->live().frame();
  const Json hands = workbench_->hands().Describe();
  for (std::size_t i = 0; i < std::min(hands.size(), frame.frame.ticks.size()); ++i) {
    Json now = MakeHandStatus(frame, i);
    now["limit_n"] = hands[i]["device"]["max_force_n"];
    now["condition"] = hands[i]["condition"];
    status_["hands"].push_back(std::move(now));
  }
  if (status_.contains("tick_hz")) {  // there is no loop before a file is open
    Broadcast(status_);
  }
}

}  // namespace hvas::studio
