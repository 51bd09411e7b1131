#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "studio/access.h"
#include "studio/commands.h"
#include "studio/frame_codec.h"
#include "studio/study_desk.h"
#include "studio/workbench.h"

namespace hvas::studio {

/** The way to one client. */
class ClientLink {
 public:
  ClientLink() = default;
  ClientLink(const ClientLink&) = delete;
  ClientLink& operator=(const ClientLink&) = delete;
  virtual ~ClientLink() = default;
  virtual void SendText(std::string text) = 0;
  virtual void SendFrames(std::string bytes) = 0;
  virtual void Close(const std::string& reason) = 0;
};

/** A product that can be opened without a file of one's own. */
struct Example {
  std::string id, name, about;
  std::filesystem::path file;
};

/** Everybody who looks at one workbench: who may steer, what each is told, what each has seen. All
 functions belong to one thread. */
class Hub {
 public:
  static constexpr std::size_t kMostClients = 8;
  static constexpr std::size_t kMostUnseen = 2;     ///< Frame messages that wait for their Credit.
  static constexpr double kCommandsPerSecond = 50;  ///< Of one client, for long.
  static constexpr double kCommandBurst = 100;

  Hub(Workbench* workbench, std::vector<Example> examples);

  /** Before anybody joins: a study is run, and who is no experimenter sees nothing of it but what
   the participant may see. It outlives this. */
  void RunStudy(StudyDesk* desk) { desk_ = desk; }

  /** Whoever has this role sees no more than the participant of a study may see. */
  [[nodiscard]] bool IsShielded(Role role) const {
    return desk_ != nullptr && role != Role::kOperator;
  }

  /** Nothing when the house is full. @returns the client's id. */
  [[nodiscard]] Result<std::string> Join(Role role, ClientLink* link);
  void Leave(const std::string& id);

  /** The server ends: nobody is told of anything any more. */
  void Forget() { clients_.clear(); }

  /** @param now_ns  By MonotonicNs(). */
  void OnText(const std::string& id, std::string_view text, std::int64_t now_ns);
  void OnBinary(const std::string& id, std::string_view bytes);

  /** Tells everybody; the event "reply" (MakeLateReply) only whoever waits for it. */
  void Broadcast(Json event);

  /** There is a new frame: sends it to those who have seen the one before. */
  void PublishFrame();

  /** Once a second. */
  void PublishStatus();

  /** A file that was sent is here; it is opened by the id. */
  [[nodiscard]] std::string AddUpload(const std::filesystem::path& file, const std::string& name);

  [[nodiscard]] std::size_t client_count() const { return clients_.size(); }

 private:
  struct Client {
    Role role{Role::kViewer};
    ClientLink* link{nullptr};
    std::uint32_t sent_seq{0};
    std::uint32_t seen_seq{0};
    std::uint32_t epoch{0};
    std::uint64_t serial{0};          ///< Of the frame that it was sent last.
    std::vector<spatial::Pose> X_WB;  ///< As it was told last.
    double allowance{kCommandBurst};
    std::int64_t last_command_ns{0};
  };

  struct Upload {
    std::filesystem::path file;
    std::string name;
  };

  struct Caller {
    std::string id;
    Role role;
    bool has_lease;       ///< Of hand 0.
    const Json& command;  ///< As it was sent.
  };

  /** Calls what a command is for, with its fields. */
  using Handler = std::function<Result<Json>(Hub* hub, const Caller& caller, const Json& command)>;

  struct Command {
    protocol::Right right;
    Handler handler;
  };

  static const std::map<std::string, Command, std::less<>>& Commands();
  /** Of the table of commands. `Do` is a member function, of the caller, the fields, both or
   neither. */
  template <typename Fields, typename Do>
  static std::pair<const std::string, Command> Entry(Do handler);
  [[nodiscard]] Result<Json> Execute(const std::string& id, const Json& command);
  [[nodiscard]] bool MayDo(protocol::Right right, const Caller& caller) const;
  Result<Json> DoOpen(const protocol::OpenCommand& command);
  Result<Json> DoCancel();
  Result<Json> DoTake(const protocol::TakeCommand& command);
  Result<Json> DoRelease(const protocol::ReleaseCommand& command);
  Result<Json> DoForces(const Caller& caller, const protocol::ForcesCommand& command);
  Result<Json> DoDemo(const protocol::DemoCommand& command);
  Result<Json> DoNext();
  Result<Json> DoUndo();
  Result<Json> DoRedo();
  Result<Json> DoReset();
  Result<Json> DoHands(const protocol::HandsCommand& command);
  Result<Json> DoDevices();
  Result<Json> DoUse(const protocol::UseCommand& command);
  Result<Json> DoRecord(const protocol::RecordCommand& command);
  Result<Json> DoRenameRecording(const protocol::RenameRecordingCommand& command);
  Result<Json> DoDeleteRecording(const protocol::DeleteRecordingCommand& command);
  template <typename Fields>
  Result<Json> DoEdit(const Fields& command);
  Result<Json> DoMeasure(const protocol::MeasureCommand& command);
  Result<Json> DoPath(const Caller& caller, const protocol::PathCommand& command);
  Result<Json> DoLease(const Caller& caller, const protocol::LeaseCommand& command);
  Result<Json> DoStatus();
  Result<Json> DoStudy(const Caller& caller, const protocol::StudyCommand& command);

  /** Errors: not while a study runs, or not for this role. */
  [[nodiscard]] Result<void> CheckStudy(const Caller& caller, const std::string& name) const;
  void TellOfStudy();
  void SendTo(const Client& client, const Json& event, const std::string& text);

  [[nodiscard]] bool MaySend(Client* client, std::int64_t now_ns) const;
  [[nodiscard]] Json MakeHello(const std::string& id, const Client& client) const;
  /** Whose are these hands: nobody's, when `id` is empty. */
  void GiveLease(const std::vector<std::size_t>& hands, const std::string& id);
  [[nodiscard]] std::vector<std::size_t> HandsOf(const std::string& id) const;
  Result<Json> RequestLease(const Caller& caller, const std::vector<std::size_t>& hands);
  void TellOfRoles();
  [[nodiscard]] Json MakeHands() const;
  [[nodiscard]] Json MakeRoles() const;
  void SendFrame(const LiveFrame& frame, Client* client);

  Workbench* workbench_;
  StudyDesk* desk_{nullptr};  ///< Null: no study is run.
  std::vector<Example> examples_;
  std::map<std::string, Client> clients_;
  std::map<std::string, Upload> uploads_;
  /** By hand: the client that steers it; empty: nobody. */
  std::array<std::string, HandRack::kMostHands> leases_;
  std::uint32_t last_id_{0};
  Json status_;
};

}  // namespace hvas::studio
