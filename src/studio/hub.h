#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "studio/access.h"
#include "studio/audit_log.h"
#include "studio/commands.h"
#include "studio/frame_codec.h"
#include "studio/hand_leases.h"
#include "studio/study_desk.h"
#include "studio/upload_shelf.h"
#include "studio/workbench.h"

namespace hvas::studio {

/** Connection of the hub to one client. */
class ClientLink {
 public:
  ClientLink() = default;
  ClientLink(const ClientLink&) = delete;
  ClientLink& operator=(const ClientLink&) = delete;
  virtual ~ClientLink() = default;
  virtual void SendText(std::string text) = 0;
  virtual void SendFrames(std::string bytes) = 0;
  virtual void Close(const std::string& reason) = 0;

  /** Whether the client's browser may still come in; a link may have been revoked. */
  [[nodiscard]] virtual bool is_admitted() const { return true; }

  /** IP address of the client; empty: none. */
  [[nodiscard]] virtual std::string address() const { return {}; }
};

/** A product that the start page offers. */
struct Example {
  std::string id, name, about;
  std::filesystem::path file;
  bool is_recent{false};  ///< It was opened before, and does not come with the program.
};

/** The clients of one workbench: their leases on hands, the commands and inputs that they send, and
 the events and frames that they get. All functions are for one thread. */
class Hub {
 public:
  // Pages that see one scene, which share the network and the time of one thread: choices.
  static constexpr std::size_t kMaxClients = 24;
  static constexpr std::size_t kKeptForOwner = 4;      ///< Places among these that nobody else has.
  static constexpr std::size_t kMaxClientsOfLink = 4;  ///< Users of one link.
  static constexpr std::size_t kMaxViewingClients = 12;  ///< All that came by the viewers' link.
  /** Frame messages that are not yet acknowledged: those of a round trip of 130 ms at 60 a second.
   */
  static constexpr std::size_t kMaxUnseen = 8;
  /** Sustained rate for one client (token bucket); a long command counts as several. */
  static constexpr double kCommandsPerSecond = 50;
  static constexpr double kCommandBurst = 100;     ///< Capacity of the token bucket.
  static constexpr double kBytesOfCommand = 1024;  ///< What a usual one has at most: a choice.

  /** @param audit  Outlives this; null: nothing is noted. */
  Hub(Workbench* workbench, std::vector<Example> examples, AuditLog* audit = nullptr);

  /** Runs a study: clients other than the experimenter then see no more than a participant may.
   @param desk  Outlives this. @pre no client has joined. */
  void SetStudyDesk(StudyDesk* desk) { desk_ = desk; }

  /** Whether a client of this role sees no more than a participant of a study may. */
  [[nodiscard]] bool IsShielded(Role role) const {
    return desk_ != nullptr && role != Role::kOperator;
  }

  /** Adds a client. @param now_ns  MonotonicNs(), here and in the other functions. @returns its id.
   Errors: kOutOfResource when those who came by its link, or all but the owner, have their number.
 */
  [[nodiscard]] Result<std::string> Join(const Visitor& visitor, ClientLink* link,
                                         std::int64_t now_ns);
  void Leave(const std::string& id, std::int64_t now_ns);

  /** Closes the connections of clients whose browsers may not come in any more. */
  void CloseRevoked();

  /** Removes all clients without notice, when the server ends. */
  void DropClients() { clients_.clear(); }

  /** Executes and replies to a command that switches the forces off while they are on, before
   anything else that waits: it sets what the haptic thread reads before it looks at who the client
   is, or at how many commands it has sent. Any client may do this. @returns false for any other
   message, which is left to OnText(). */
  bool TrySwitchForcesOff(const std::string& id, std::string_view text, std::int64_t now_ns);

  /** Refuses a command that would switch the forces on, which was sent before they were switched
   off and is executed only now. @returns false for any other message. */
  bool TryRefuseForcesOn(const std::string& id, std::string_view text);

  /** Executes a command and replies to it. */
  void OnText(const std::string& id, std::string_view text, std::int64_t now_ns);
  void OnBinary(const std::string& id, std::string_view bytes);

  /** Sends an event to all clients; the event "reply" (MakeDeferredReply) to the one that waits for
   it. */
  void Broadcast(Json event);

  /** Sends the newest frame to all clients that have acknowledged enough of the previous ones. */
  void PublishFrame();

  /** Sends the event "status"; to be called once a second. */
  void PublishStatus();

  /** Files that clients have sent, and can open by their ids. */
  [[nodiscard]] UploadShelf& uploads() { return uploads_; }

  [[nodiscard]] std::size_t client_count() const { return clients_.size(); }

 private:
  struct Client {
    Visitor visitor;
    std::string name;  ///< That its user has given; empty: none.
    ClientLink* link{nullptr};
    std::uint32_t sent_seq{0};
    std::uint32_t seen_seq{0};
    std::uint32_t epoch{0};
    std::uint64_t serial{0};  ///< LiveFrame::serial of the last frame sent.
    ShownState shown;         ///< Poses and deformations that the client has.
    double allowance{kCommandBurst};
    std::int64_t last_command_ns{0};
    std::int64_t named_ns{
        std::numeric_limits<std::int64_t>::min()};  ///< When it has given its name.
  };

  struct Caller {
    std::string id;
    Visitor visitor;
    bool has_lease;       ///< Whether it holds the lease of hand 0.
    const Json& command;  ///< The command as it was sent.
    std::int64_t now_ns;
  };

  /** Runs a command with its fields. */
  using Handler = std::function<Result<Json>(Hub* hub, const Caller& caller, const Json& command)>;

  struct Command {
    protocol::Right right;
    Handler handler;
  };

  static const std::map<std::string, Command, std::less<>>& Commands();

  /** Makes an entry of the table of commands. `Do` is a member function, of the caller, the fields,
   both or neither. */
  template <typename Fields, typename Do>
  static std::pair<const std::string, Command> Entry(Do handler);
  [[nodiscard]] Result<void> CheckRoom(const Visitor& visitor) const;
  [[nodiscard]] Result<Json> Execute(const std::string& id, const Json& command,
                                     std::int64_t now_ns);
  void NoteCommand(const std::string& id, const Client& client, const Json& command,
                   const Result<Json>& result, std::int64_t now_ns);
  [[nodiscard]] bool MayDo(protocol::Right right, const Caller& caller) const;
  /** @returns what a caller can do who may not do this. */
  [[nodiscard]] static std::string ExplainRight(protocol::Right right, const Caller& caller);
  Result<Json> DoOpen(const Caller& caller, const protocol::OpenCommand& command);
  Result<Json> DoCancel();
  Result<Json> DoTake(const protocol::TakeCommand& command);
  Result<Json> DoRelease(const protocol::ReleaseCommand& command);
  Result<Json> DoHelp(const protocol::HelpCommand& command);
  Result<Json> DoHandOver(const protocol::HandOverCommand& command);
  Result<Json> DoAskPart(const Caller& caller, const protocol::AskPartCommand& command);
  Result<Json> DoForces(const Caller& caller, const protocol::ForcesCommand& command);
  Result<Json> DoDemo(const protocol::DemoCommand& command);
  Result<Json> DoNext();
  Result<Json> DoPlanRemoval(const Caller& caller, const protocol::PlanRemovalCommand& command);
  Result<Json> DoTakeOut(const Caller& caller, const protocol::TakeOutCommand& command);
  Result<Json> DoFindOrders(const Caller& caller, const protocol::FindOrdersCommand& command);
  Result<Json> DoCheckOrder(const Caller& caller, const protocol::CheckOrderCommand& command);
  Result<Json> DoExplainGap(const Caller& caller, const protocol::ExplainGapCommand& command);
  Result<Json> DoSetOrder(const protocol::SetOrderCommand& command);
  Result<Json> DoUndo();
  Result<Json> DoRedo();
  Result<Json> DoReset();
  Result<Json> DoHands(const protocol::HandsCommand& command);
  Result<Json> DoDevices();
  Result<Json> DoUse(const protocol::UseCommand& command);
  /** Leaves what accesses the disk to another thread, and the reply until then. */
  Result<Json> DoLater(const Caller& caller, std::function<Result<void>()> work);
  Result<Json> DoRecord(const Caller& caller, const protocol::RecordCommand& command);
  Result<Json> DoRenameRecording(const Caller& caller,
                                 const protocol::RenameRecordingCommand& command);
  Result<Json> DoShareRecording(const Caller& caller,
                                const protocol::ShareRecordingCommand& command);
  Result<Json> DoDeleteRecording(const Caller& caller,
                                 const protocol::DeleteRecordingCommand& command);
  template <typename Fields>
  Result<Json> DoEdit(const Fields& command);
  Result<Json> DoMeasure(const protocol::MeasureCommand& command);
  Result<Json> DoPath(const Caller& caller, const protocol::PathCommand& command);
  Result<Json> DoLease(const Caller& caller, const protocol::LeaseCommand& command);
  Result<Json> DoIntroduce(const Caller& caller, const protocol::IntroduceCommand& command);
  Result<Json> DoLook(const Caller& caller, const protocol::LookCommand& command);
  Result<Json> DoAddNote(const Caller& caller, const protocol::AddNoteCommand& command);
  Result<Json> DoRemoveNote(const protocol::RemoveNoteCommand& command);
  Result<Json> DoStatus();
  Result<Json> DoStudy(const Caller& caller, const protocol::StudyCommand& command);

  /** Checks a command against a running study. Errors: kInvalid when it is not allowed then. */
  [[nodiscard]] Result<void> CheckStudy(const Caller& caller, const std::string& name) const;
  void BroadcastStudyState();
  void SendTo(const Client& client, const Json& event, const std::string& text);

  void SendReply(ClientLink* link, const Result<Json>& command, const Result<Json>& result);
  [[nodiscard]] bool MaySend(Client* client, std::size_t bytes, std::int64_t now_ns) const;
  [[nodiscard]] Json MakeHello(const std::string& id, const Client& client) const;
  Result<Json> RequestLease(const Caller& caller, const std::vector<std::size_t>& hands);
  void BroadcastRoles();
  [[nodiscard]] Json MakeHands() const;
  [[nodiscard]] Json MakeRoles() const;
  void SendFrame(const LiveFrame& frame, Client* client);

  Workbench* workbench_;
  StudyDesk* desk_{nullptr};  ///< Null: no study is run.
  std::vector<Example> examples_;
  AuditLog* audit_;
  std::map<std::string, Client> clients_;
  UploadShelf uploads_;
  HandLeases leases_;
  Json roles_;  ///< Event "roles" as it was sent last.
  std::uint32_t last_id_{0};
  Json status_;
};

}  // namespace hvas::studio
