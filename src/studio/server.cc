// The only source that sees Boost.Beast: it takes long to compile.
#include "studio/server.h"

#include <deque>
#include <limits>
#include <optional>
#include <thread>
#include <utility>

#include <boost/asio/dispatch.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>

#include "base/clock.h"
#include "studio/answers.h"
#include "studio/connection.h"
#include "studio/event_json.h"
#include "studio/json_fields.h"
#include "studio/tls.h"

namespace hvas::studio {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using beast::error_code;

constexpr std::size_t kMostHeader = 8 << 10;
constexpr std::size_t kMostBody = 4 << 10;      // of what is no upload
constexpr std::size_t kMostMessage = 64 << 10;  // to the server
constexpr std::size_t kMostQueued = 16 << 20;   // of text to a client that does not read
constexpr double kSlowest = 128 << 10;          // that an answer may be read with [bytes/s]
constexpr std::chrono::seconds kUploadTime(300);
constexpr std::chrono::seconds kLinger(5);                    // for what was sent in vain
constexpr std::chrono::milliseconds kWaitForDescriptor(100);  // when the system has no more

constexpr std::string_view kContentSecurity =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' "
    "data: blob:; connect-src 'self'; worker-src 'self'; font-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'";

std::string_view ToView(beast::string_view text) {
  return {text.data(), text.size()};
}

beast::string_view ToBeast(std::string_view text) {
  return {text.data(), text.size()};
}

template <typename Fields>
std::string_view FieldOf(const Fields& fields, http::field name) {
  return ToView(fields[name]);
}

/** All that the sessions share; one thread's. */
struct Shared {
  Shared(Workbench* bench, std::vector<Example> examples, const ServerOptions& given)
      : workbench(bench), hub(bench, std::move(examples)), options(given) {
    hub.RunStudy(given.desk);
  }

  Workbench* workbench;
  Hub hub;
  ServerOptions options;
  std::unique_ptr<Access> access;
  std::unique_ptr<asio::ssl::context> tls;  ///< Null: nothing is encrypted.
  std::shared_ptr<Guests> guests{std::make_shared<Guests>()};

  /** After a change of who may come in. What cannot be written is told of once. */
  void KeepAccess() {
    if (options.access_file.empty()) {
      return;
    }
    const auto saved = SaveAccess(options.access_file, access->Keep());
    if (!saved && std::exchange(can_keep_access, false)) {
      fmt::print(stderr, "warning: the next start makes new links: {}\n", saved.error().ToString());
    }
  }

  /** A link that nobody has used yet, for the experimenter to pass on. */
  void TellOfParticipantLink() {
    if (options.desk != nullptr) {
      options.desk->SetParticipantLink("/#t=" + access->FindFresh(Role::kParticipant));
    }
  }

  bool can_keep_access{true};
};

/** A client's WebSocket. Text is kept until it is sent; frames are few, by the hub's credit. */
class SocketSession final : public ClientLink, public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(Connection connection, std::shared_ptr<Shared> shared, Role role)
      : socket_(std::move(connection)), shared_(std::move(shared)), role_(role) {}

  ~SocketSession() override { Leave(); }

  template <typename Request>
  void Run(const Request& request) {
    // Whoever has gone without a word, or sleeps, is asked after half the time, and let go of.
    const auto patience = shared_->options.patience;
    socket_.set_option(websocket::stream_base::timeout{patience, patience, true});
    socket_.read_message_max(kMostMessage);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (!error) {
        self->Enter();
      }
    });
  }

  void SendText(std::string text) override {
    if (queued_ + text.size() > kMostQueued) {
      CutOff();
      return;
    }
    Push({std::move(text), true});
  }

  void SendFrames(std::string bytes) override { Push({std::move(bytes), false}); }

  void Close(const std::string& reason) override {
    if (std::exchange(is_closing_, true)) {
      return;
    }
    constexpr std::size_t kLongestReason = 120;
    const websocket::close_reason why(websocket::close_code::policy_error,
                                      ToBeast(reason.substr(0, kLongestReason)));
    socket_.async_close(why, [self = shared_from_this()](error_code) {});
    LeaveSoon();
  }

 private:
  struct Message {
    std::string bytes;
    bool is_text;
  };

  void Enter() {
    auto joined = shared_->hub.Join(role_, this);
    if (!joined) {
      Close(joined.error().message);
      return;
    }
    id_ = std::move(*joined);
    Read();
  }

  /** Of a client that reads nothing, not even why it has to go. */
  void CutOff() {
    if (!std::exchange(is_closing_, true)) {
      beast::get_lowest_layer(socket_).close();
      LeaveSoon();
    }
  }

  /** Not at once: the hub may be just telling everybody something. Whoever has to go does not keep
   its lease until it has answered. */
  void LeaveSoon() {
    asio::post(socket_.get_executor(), [self = shared_from_this()] { self->Leave(); });
  }

  void Leave() {
    if (!id_.empty()) {
      shared_->hub.Leave(std::exchange(id_, ""));
    }
  }

  void Read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) {
        self->Leave();
        return;
      }
      const std::string message = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      if (self->socket_.got_text()) {
        self->shared_->hub.OnText(self->id_, message, MonotonicNs());
      } else {
        self->shared_->hub.OnBinary(self->id_, message);
      }
      if (!self->is_closing_) {
        self->Read();
      }
    });
  }

  void Push(Message message) {
    if (is_closing_) {
      return;
    }
    queued_ += message.bytes.size();
    queue_.push_back(std::move(message));
    if (queue_.size() == 1) {
      Write();
    }
  }

  void Write() {
    const Message& message = queue_.front();
    socket_.text(message.is_text);
    socket_.async_write(asio::buffer(message.bytes),
                        [self = shared_from_this()](error_code error, std::size_t) {
                          if (error) {
                            self->Leave();
                            self->queue_.clear();
                            return;
                          }
                          self->queued_ -= self->queue_.front().bytes.size();
                          self->queue_.pop_front();
                          if (!self->queue_.empty()) {
                            self->Write();
                          }
                        });
  }

  websocket::stream<Connection> socket_;
  std::shared_ptr<Shared> shared_;
  Role role_;
  std::string id_;
  beast::flat_buffer buffer_;
  std::deque<Message> queue_;
  std::size_t queued_{0};
  bool is_closing_{false};
};

/** One connection's requests, one after the other. */
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(tcp::socket socket, std::shared_ptr<Shared> shared)
      : connection_(std::move(socket), shared->guests), shared_(std::move(shared)) {}

  void Run() {
    if (!connection_.is_in()) {
      return;
    }
    error_code ignored;
    wire().socket().set_option(tcp::no_delay(true), ignored);
    if (shared_->tls == nullptr) {
      ReadHeader();
    } else {
      BeginTls();
    }
  }

 private:
  using Header = http::request_parser<http::empty_body>;

  beast::tcp_stream& wire() { return connection_.next_layer(); }

  /** A browser that was given http:// is told where to go; all others begin with a handshake. */
  void BeginTls() {
    wire().expires_after(shared_->options.patience);
    beast::async_detect_ssl(wire(), buffer_,
                            [self = shared_from_this()](error_code error, bool is_tls) {
                              if (error) {
                                return;
                              }
                              if (is_tls) {
                                self->ShakeHands();
                              } else {
                                self->ReadHeader();
                              }
                            });
  }

  void ShakeHands() {
    connection_.BeginTls(shared_->tls.get())
        .async_handshake(asio::ssl::stream_base::server, buffer_.data(),
                         [self = shared_from_this()](error_code error, std::size_t used) {
                           if (!error) {
                             self->buffer_.consume(used);
                             self->ReadHeader();
                           }
                         });
  }

  void ReadHeader() {
    header_.emplace();
    header_->header_limit(kMostHeader);
    header_->body_limit(std::numeric_limits<std::uint64_t>::max());  // each route has its own
    wire().expires_after(shared_->options.patience);
    http::async_read_header(
        connection_, buffer_, *header_, [self = shared_from_this()](error_code error, std::size_t) {
          if (!error) {
            self->Route();
          } else if (error == http::error::header_limit) {
            self->Refuse(http::status::request_header_fields_too_large,
                         {ErrorCode::kInvalid, "the header is too long", "", ""});
          }
        });
  }

  /** Who may not come in at all; then what is asked for. */
  void Route() {
    const auto& request = header_->get();
    is_last_ = !request.keep_alive();
    const std::string_view origin = FieldOf(request, http::field::origin);
    const Access& access = *shared_->access;
    if (!access.AllowsHost(FieldOf(request, http::field::host))) {
      return Refuse(http::status::forbidden,
                    {ErrorCode::kInvalid, "this server does not answer to that host name", "Host",
                     "open the address that it printed"});
    }
    if (shared_->tls != nullptr && !connection_.is_tls()) {
      return SendToTls();
    }
    const bool is_change = request.method() != http::verb::get;
    const bool is_upgrade = websocket::is_upgrade(request);
    if ((is_change || is_upgrade || !origin.empty()) && !access.AllowsOrigin(origin)) {
      return Refuse(http::status::forbidden,
                    {ErrorCode::kInvalid, "a page from elsewhere may not speak with this server",
                     "Origin", "open the address that it printed"});
    }
    const std::string_view target = ToView(request.target());
    const std::string_view path = target.substr(0, target.find('?'));
    if (request.method() == http::verb::post && path == "/api/session") {
      return ReadJson(&HttpSession::ExchangeToken);
    }
    if (request.method() == http::verb::get && !path.starts_with("/api/") && path != "/ws") {
      const auto accepted = FieldOf(request, http::field::accept_encoding);
      return Reply(AnswerAsset(path, accepted));
    }
    const auto role = access.RoleOfCookie(FieldOf(request, http::field::cookie));
    if (!role) {
      return Refuse(http::status::unauthorized,
                    {ErrorCode::kInvalid, "nobody knows you here", "",
                     "open the link that the program printed, with its token"});
    }
    connection_.SetKnown();
    RouteKnown(*role, path, is_upgrade);
  }

  /** The same page by https. The secret stays behind its #, in the browser. @pre Host is allowed.
   */
  void SendToTls() {
    const std::string page = fmt::format("https://{}/", FieldOf(header_->get(), http::field::host));
    http::response<http::string_body> response(http::status::temporary_redirect, 11);
    response.set(http::field::location, page);
    response.set(http::field::content_type, "text/plain; charset=utf-8");
    response.body() = fmt::format("This studio speaks https only: open {}\n", page);
    is_refused_ = true;
    Send(std::move(response));
  }

  void RouteKnown(Role role, std::string_view path, bool is_upgrade) {
    const http::verb method = header_->get().method();
    if (path == "/ws" && is_upgrade) {
      wire().expires_never();
      std::make_shared<SocketSession>(std::move(connection_), shared_, role)->Run(header_->get());
    } else if (method == http::verb::get) {
      try {
        Reply(AnswerApi(shared_->workbench, DecodePercent(path), shared_->hub.IsShielded(role)));
      } catch (const std::exception& failed) {
        Refuse(http::status::internal_server_error,
               {ErrorCode::kInternal, failed.what(), std::string(path), "load the page again"});
      }
    } else if (path == "/api/upload" && method == http::verb::post) {
      ReadUpload(role);
    } else if (path == "/api/link" && method == http::verb::post) {
      if (role != Role::kOperator) {
        Refuse(http::status::forbidden, {ErrorCode::kInvalid, "this link is for looking on", "",
                                         "ask whoever steers for a link"});
      } else {
        ReadJson(&HttpSession::MakeLink);
      }
    } else {
      Refuse(http::status::not_found,
             {ErrorCode::kNotFound, "there is nothing here", std::string(path), ""});
    }
  }

  /** Whether a body is as long as is said beforehand, and that no longer than this; if not, says
   so. One that comes in chunks is counted by its parser. */
  bool IsShort(std::uint64_t most) {
    const auto length = header_->content_length();
    if (length && *length > most) {
      RefuseBody(http::error::body_limit);
      return false;
    }
    return true;
  }

  using JsonHandler = void (HttpSession::*)(const Json& body);

  void ReadJson(JsonHandler handler) {
    if (!IsShort(kMostBody)) {
      return;
    }
    auto parser = std::make_shared<http::request_parser<http::string_body>>(std::move(*header_));
    parser->body_limit(kMostBody);
    http::async_read(connection_, buffer_, *parser,
                     [self = shared_from_this(), parser, handler](error_code error, std::size_t) {
                       if (error) {
                         self->RefuseBody(error);
                       } else {
                         self->cookie_ = FieldOf(parser->get(), http::field::cookie);
                         (*self.*handler)(Json::parse(parser->get().body(), nullptr,
                                                      /*allow_exceptions=*/false));
                       }
                     });
  }

  void ExchangeToken(const Json& body) {
    const auto admission = shared_->access->Admit(TextOr(body, "token", ""), cookie_);
    if (!admission) {
      return Refuse(http::status::unauthorized, admission.error());
    }
    shared_->KeepAccess();
    if (admission->role == Role::kParticipant) {
      shared_->TellOfParticipantLink();
    }
    http::response<http::string_body> response(http::status::ok, 11);
    response.set(http::field::set_cookie, admission->set_cookie);
    response.set(http::field::content_type, "application/json");
    response.body() = Json{{"role", ToString(admission->role)}}.dump();
    Send(std::move(response));
  }

  /** For somebody else: its token, and where it can be opened. */
  void MakeLink(const Json& body) {
    const auto role = ParseRole(TextOr(body, "role", ""));
    if (!role || (*role == Role::kParticipant && shared_->options.desk == nullptr)) {
      return Refuse(http::status::bad_request,
                    {ErrorCode::kInvalid, "there is no such role", "role",
                     "ask for a link of an operator or a viewer"});
    }
    const Access& access = *shared_->access;
    const ServerOptions& options = shared_->options;
    Json origins = Json::array();
    for (const std::string& name :
         options.tls ? options.names : std::vector<std::string>{"127.0.0.1"}) {
      origins.push_back(access.OriginOf(name));
    }
    const std::string token = shared_->access->Invite(*role);
    shared_->KeepAccess();
    SendJson(http::status::ok, {{"token", token},
                                {"role", ToString(*role)},
                                {"is_for_one", IsForOne(*role)},
                                {"origins", std::move(origins)},
                                {"is_local", asio::ip::make_address(options.address).is_loopback()},
                                {"reachable", options.reachable}});
  }

  void ReadUpload(Role role) {
    if (role != Role::kOperator) {
      return Refuse(http::status::forbidden, {ErrorCode::kInvalid, "this link is for looking on",
                                              "", "ask for a link to steer"});
    }
    if (!IsShort(shared_->options.most_upload)) {
      return;
    }
    const std::string name = NameOfUpload(ToView(header_->get().target()));
    const std::filesystem::path folder = shared_->options.upload_folder / MakeToken();
    std::error_code failed;
    std::filesystem::create_directory(folder, failed);
    const std::filesystem::path file = folder / name;
    auto parser = std::make_shared<http::request_parser<http::file_body>>(std::move(*header_));
    parser->body_limit(shared_->options.most_upload);
    error_code error;
    parser->get().body().open(file.c_str(), beast::file_mode::write_new, error);
    if (failed || error) {
      return Refuse(
          http::status::insufficient_storage,
          {ErrorCode::kOutOfResource, "the file cannot be kept", name, "make room on the disk"});
    }
    wire().expires_after(kUploadTime);
    http::async_read(
        connection_, buffer_, *parser,
        [self = shared_from_this(), parser, folder, file, name](error_code read, std::size_t) {
          parser->get().body().close();
          if (read) {
            std::error_code ignored;
            std::filesystem::remove_all(folder, ignored);
            return self->RefuseBody(read);
          }
          self->SendJson(http::status::ok, {{"upload", self->shared_->hub.AddUpload(file, name)}});
        });
  }

  void RefuseBody(error_code error) {
    if (error == http::error::body_limit) {
      Refuse(http::status::payload_too_large,
             {ErrorCode::kOutOfResource, "this is larger than may be sent", "",
              "open the file with `hvas studio FILE`"});
    } else {
      Refuse(http::status::bad_request,
             {ErrorCode::kInvalid, "the request broke off", "", "try again"});
    }
  }

  void Reply(Result<Answer> answer) {
    if (!answer) {
      const bool is_missing = answer.error().code == ErrorCode::kNotFound;
      return Refuse(is_missing ? http::status::not_found : http::status::internal_server_error,
                    answer.error());
    }
    if (answer->file) {
      return SendFile(*answer->file, answer->type);
    }
    http::response<http::span_body<const char>> response(http::status::ok, 11);
    response.set(http::field::content_type, answer->type);
    const std::string etag = fmt::format("\"{}\"", answer->etag);
    if (answer->etag.empty()) {
      response.set(http::field::cache_control, "no-store");
    } else {
      response.set(http::field::etag, etag);
      response.set(http::field::vary, "Accept-Encoding");
      response.set(http::field::cache_control,
                   answer->is_immutable ? "private, max-age=31536000, immutable" : "no-cache");
    }
    if (!answer->encoding.empty()) {
      response.set(http::field::content_encoding, answer->encoding);
    }
    if (!answer->etag.empty() && FieldOf(header_->get(), http::field::if_none_match) == etag) {
      response.result(http::status::not_modified);
    } else {
      response.body() = {answer->bytes.data(), answer->bytes.size()};
    }
    owner_ = std::move(answer->owner);
    Send(std::move(response));
  }

  /** For saving: it may be large. */
  void SendFile(const std::filesystem::path& file, const std::string& type) {
    http::response<http::file_body> response(http::status::ok, 11);
    error_code failed;
    response.body().open(file.c_str(), boost::beast::file_mode::scan, failed);
    if (failed) {
      return Refuse(http::status::not_found,
                    {ErrorCode::kNotFound, failed.message(), file.filename().string(), ""});
    }
    response.set(http::field::content_type, type);
    response.set(http::field::content_disposition,
                 fmt::format("attachment; filename=\"{}\"", file.filename().string()));
    Send(std::move(response));
  }

  void SendJson(http::status status, const Json& json) {
    http::response<http::string_body> response(status, 11);
    response.set(http::field::content_type, "application/json");
    response.set(http::field::cache_control, "no-store");
    response.body() = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    Send(std::move(response));
  }

  /** Says why not, and ends the connection: what may follow in it is not read. */
  void Refuse(http::status status, const Error& error) {
    is_refused_ = true;
    SendJson(status, {{"error", ToJson(error)}});
  }

  template <typename Body>
  void Send(http::response<Body> response) {
    response.set("Content-Security-Policy", ToBeast(kContentSecurity));
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response.set("Cross-Origin-Embedder-Policy", "require-corp");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.keep_alive(!is_refused_ && !is_last_);
    response.prepare_payload();
    const std::chrono::duration<double> long_enough(
        static_cast<double>(response.payload_size().value_or(0)) / kSlowest);
    wire().expires_after(shared_->options.patience +
                         std::chrono::duration_cast<std::chrono::milliseconds>(long_enough));
    auto kept = std::make_shared<http::response<Body>>(std::move(response));
    http::async_write(connection_, *kept,
                      [self = shared_from_this(), kept](error_code error, std::size_t) {
                        self->owner_.reset();
                        if (error) {
                          return;
                        }
                        if (kept->keep_alive()) {
                          self->ReadHeader();
                        } else {
                          self->End();
                        }
                      });
  }

  /** What still comes is read and thrown away for a while: were it not, the system would end the
   connection at once, and with it the answer that is on its way. */
  void End() {
    wire().expires_after(kLinger);
    if (!connection_.is_tls()) {
      error_code ignored;
      wire().socket().shutdown(tcp::socket::shutdown_send, ignored);
    }
    buffer_.clear();
    ThrowAway();
  }

  void ThrowAway() {
    connection_.async_read_some(buffer_.prepare(kMostHeader),
                                [self = shared_from_this()](error_code error, std::size_t) {
                                  if (!error) {
                                    self->ThrowAway();
                                  }
                                });
  }

  Connection connection_;
  std::shared_ptr<Shared> shared_;
  beast::flat_buffer buffer_{kMostHeader + (64 << 10)};
  std::optional<Header> header_;
  std::shared_ptr<const void> owner_;
  std::string cookie_;  ///< Of the request whose body was read.
  bool is_refused_{false};
  bool is_last_{false};  ///< The client asked for the end of the connection after this answer.
};

}  // namespace

class Server::Impl {
 public:
  Impl(Workbench* workbench, std::vector<Example> examples, const ServerOptions& options)
      : shared_(std::make_shared<Shared>(workbench, std::move(examples), options)),
        acceptor_(context_),
        timer_(context_),
        pause_(context_) {
    workbench->on_event = [this](Json event) {
      asio::post(context_, [this, event = std::move(event)] { shared_->hub.Broadcast(event); });
    };
    workbench->on_frame = [this] {
      if (!has_frame_.exchange(true)) {
        asio::post(context_, [this] {
          has_frame_ = false;
          shared_->hub.PublishFrame();
        });
      }
    };
  }

  ~Impl() { Stop(); }

  Result<void> Start() {
    const ServerOptions& options = shared_->options;
    error_code error;
    const auto address = asio::ip::make_address(options.address, error);
    if (error) {
      return Fail(ErrorCode::kInvalid, "this is no address", options.address,
                  "give one of this machine, or 0.0.0.0 for all that it has");
    }
    if (!address.is_loopback() && !options.tls) {
      return Fail(ErrorCode::kInvalid, "other machines are not spoken with unencrypted",
                  options.address, "give a certificate, or listen on 127.0.0.1");
    }
    if (options.tls) {
      auto tls = MakeTls(*options.tls);
      if (!tls) {
        return Unexpected(tls.error());
      }
      shared_->tls = std::move(*tls);
    }
    KeptAccess kept = FindKeptAccess();
    const bool wants_kept_port = options.port == 0 && kept.port != 0;
    if (!wants_kept_port || !Listen({address, kept.port})) {  // another program may have it now
      if (const auto listening = Listen({address, options.port}); !listening) {
        return listening;
      }
    }
    has_kept_links_ = kept.port == port();
    shared_->access =
        std::make_unique<Access>(options.names, port(), options.tls.has_value(), std::move(kept));
    shared_->KeepAccess();
    shared_->TellOfParticipantLink();
    Accept();
    Tick();
    thread_ = std::thread([this] { Run(); });
    return {};
  }

  void Stop() {
    context_.stop();
    if (thread_.joinable()) {
      thread_.join();
    }
    shared_->hub.Forget();
  }

  [[nodiscard]] bool has_kept_links() const { return has_kept_links_; }

  [[nodiscard]] std::uint16_t port() const {
    error_code ignored;
    return acceptor_.local_endpoint(ignored).port();
  }

  [[nodiscard]] std::string LinkFor(Role role, std::string_view host) const {
    return fmt::format("{}/#t={}", shared_->access->OriginOf(host), shared_->access->token(role));
  }

 private:
  /** Of the start before; nothing where there was none, or it cannot be used. */
  [[nodiscard]] KeptAccess FindKeptAccess() const {
    const auto& file = shared_->options.access_file;
    auto kept = file.empty() ? KeptAccess() : LoadAccess(file);
    if (!kept && kept.error().code != ErrorCode::kNotFound) {
      fmt::print(stderr, "warning: new links are made: {}\n", kept.error().ToString());
    }
    return kept ? std::move(*kept) : KeptAccess();
  }

  Result<void> Listen(const tcp::endpoint& wanted) {
    error_code error;
    acceptor_.close(error);
    acceptor_.open(wanted.protocol(), error);
    if (!error) {
      acceptor_.set_option(asio::socket_base::reuse_address(true), error);
      acceptor_.bind(wanted, error);
    }
    if (!error) {
      acceptor_.listen(asio::socket_base::max_listen_connections, error);
    }
    if (error) {
      const bool is_elsewhere = error == std::errc::address_not_available;
      return Fail(ErrorCode::kOutOfResource, error.message(),
                  fmt::format("{}:{}", wanted.address().to_string(), wanted.port()),
                  is_elsewhere ? "listen on an address of this machine, or on 0.0.0.0"
                               : "choose another port with --port, or leave it out");
    }
    return {};
  }

  /** What goes wrong with one client is the end of its connection, of nothing else. */
  void Run() {
    while (!context_.stopped()) {
      try {
        context_.run();
      } catch (const std::exception& failed) {
        fmt::print(stderr, "warning: a client's request failed: {}\n", failed.what());
      }
    }
  }

  void Accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) {
        return;
      }
      if (error) {
        return AcceptLater();
      }
      std::make_shared<HttpSession>(std::move(socket), shared_)->Run();
      Accept();
    });
  }

  /** The system has no descriptor left, and would say so again at once. */
  void AcceptLater() {
    pause_.expires_after(kWaitForDescriptor);
    pause_.async_wait([this](error_code error) {
      if (!error) {
        Accept();
      }
    });
  }

  void Tick() {
    timer_.expires_after(std::chrono::seconds(1));
    timer_.async_wait([this](error_code error) {
      if (!error) {
        shared_->hub.PublishStatus();
        Tick();
      }
    });
  }

  asio::io_context context_{1};
  std::shared_ptr<Shared> shared_;
  tcp::acceptor acceptor_;
  asio::steady_timer timer_;
  asio::steady_timer pause_;
  std::atomic<bool> has_frame_{false};
  bool has_kept_links_{false};
  std::thread thread_;
};

Server::Server(Workbench* workbench, std::vector<Example> examples, ServerOptions options)
    : impl_(std::make_unique<Impl>(workbench, std::move(examples), std::move(options))) {}

Server::~Server() = default;

Result<void> Server::Start() {
  return impl_->Start();
}

void Server::Stop() {
  impl_->Stop();
}

std::uint16_t Server::port() const {
  return impl_->port();
}

bool Server::has_kept_links() const {
  return impl_->has_kept_links();
}

std::string Server::LinkFor(Role role, std::string_view host) const {
  return impl_->LinkFor(role, host);
}

}  // namespace hvas::studio
