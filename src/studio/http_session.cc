#include "studio/http_session.h"

#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <fmt/format.h>

#include "base/clock.h"
#include "base/error_name.h"
#include "base/parse_json.h"
#include "base/regular_file.h"
#include "studio/answer_lanes.h"
#include "studio/event_json.h"
#include "studio/header_value.h"
#include "studio/json_fields.h"
#include "studio/responses.h"
#include "studio/socket_session.h"
#include "studio/upload_file.h"

namespace hvas::studio {
namespace {

// [bytes] of a request's head, as usual servers take: a choice.
constexpr std::size_t kMaxHeader = 8 << 10;
constexpr std::size_t kMaxBody = 4 << 10;  // largest body but that of an upload [bytes]
constexpr double kSlowest = 128 << 10;     // slowest rate at which a response may be read [bytes/s]
constexpr std::chrono::seconds kUploadTime(300);
constexpr std::chrono::seconds kLinger(5);  // time for reading the rest of a refused request

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

/** Whether a request announces a body that its kind has not: unread, the body would be taken for
 the next request on the connection. A coding that is not chunked tells nobody where the body ends.
 */
bool HasBodyOutOfPlace(const http::request_parser<http::empty_body>& parser) {
  const auto& request = parser.get();
  const bool is_coded = request.count(http::field::transfer_encoding) > 0;
  const bool has_body = is_coded || parser.content_length().value_or(0) > 0;
  const bool is_upgrade = websocket::is_upgrade(request);
  return request.method() == http::verb::post && !is_upgrade ? is_coded && !parser.chunked()
                                                             : has_body;
}

/** Serves the requests of one connection, one after the other. */
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(tcp::socket socket, std::shared_ptr<ServerShared> shared)
      : connection_(std::move(socket), shared->connections), shared_(std::move(shared)) {}

  void Run() {
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
    connection_.SetIdle(true);
    header_.emplace();
    header_->header_limit(kMaxHeader);
    header_->body_limit(
        std::numeric_limits<std::uint64_t>::max());  // each route has a limit of its own
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
    connection_.SetIdle(false);
    visitor_.reset();
    if (HasBodyOutOfPlace(*header_)) {
      return Refuse(http::status::bad_request,
                    {ErrorCode::kInvalid, "a request of this kind has no body", "", "send none"});
    }
    const std::string_view origin = FieldOf(request, http::field::origin);
    const Access& access = *shared_->access;
    if (!access.AllowsHost(FieldOf(request, http::field::host))) {
      return Refuse(http::status::forbidden,
                    {ErrorCode::kInvalid, "this server does not accept this host name", "Host",
                     "open the address that the program printed"});
    }
    if (shared_->tls != nullptr && !connection_.is_tls()) {
      return SendToTls();
    }
    const bool is_change = request.method() != http::verb::get;
    const bool is_upgrade = websocket::is_upgrade(request);
    if ((is_change || is_upgrade || !origin.empty()) && !access.AllowsOrigin(origin)) {
      return Refuse(http::status::forbidden,
                    {ErrorCode::kInvalid, "a page of another origin may not access this server",
                     "Origin", "open the address that the program printed"});
    }
    visitor_ = access.FindVisitor(FieldOf(request, http::field::cookie));
    if (visitor_ && !connection_.Enter(*visitor_)) {
      return Refuse(http::status::too_many_requests,
                    {ErrorCode::kOutOfResource, "too many connections by this link are busy", "",
                     "wait until others are served, or close another page"});
    }
    const std::string_view target = ToView(request.target());
    const std::string_view path = target.substr(0, target.find('?'));
    if (request.method() == http::verb::post && path == "/api/session") {
      return ReadJson(&HttpSession::ExchangeToken);
    }
    if (request.method() == http::verb::get && !path.starts_with("/api/") && path != "/ws") {
      const auto accepted = FieldOf(request, http::field::accept_encoding);
      return Reply(MakeAssetResponse(path, accepted));
    }
    if (!visitor_) {
      return Refuse(http::status::unauthorized,
                    {ErrorCode::kInvalid, "this browser has no session", "",
                     "open the link that the program printed, including its token"});
    }
    RouteKnown(*visitor_, path, is_upgrade);
  }

  /** Redirects to the page by https; the browser keeps the token in the fragment. @pre the host is
   allowed. */
  void SendToTls() {
    const std::string page = fmt::format("https://{}/", FieldOf(header_->get(), http::field::host));
    http::response<http::string_body> response(http::status::temporary_redirect, 11);
    response.set(http::field::location, page);
    response.set(http::field::content_type, "text/plain; charset=utf-8");
    response.body() = fmt::format("This studio is available by https only: open {}\n", page);
    is_refused_ = true;
    Send(std::move(response));
  }

  void RouteKnown(const Visitor& visitor, std::string_view path, bool is_upgrade) {
    const http::verb method = header_->get().method();
    if (path == "/ws" && is_upgrade) {
      wire().expires_never();
      StartSocketSession(std::move(connection_), shared_, visitor, header_->get());
    } else if (method == http::verb::get) {
      ReplyLater(visitor, DecodePercent(path));
    } else if (path == "/api/upload" && method == http::verb::post) {
      ReadUpload(visitor);
    } else if (path == "/api/end_sharing" && method == http::verb::post) {
      ReadJson(&HttpSession::EndSharing);
    } else if (path == "/api/link" && method == http::verb::post) {
      if (visitor.role != Role::kOperator) {
        Refuse(http::status::forbidden, {ErrorCode::kInvalid, "this link is for viewers", "",
                                         "ask the user who started this studio for a link"});
      } else {
        ReadJson(&HttpSession::MakeLink);
      }
    } else {
      Refuse(http::status::not_found,
             {ErrorCode::kNotFound, "there is no such resource", std::string(path), ""});
    }
  }

  /** Makes the response on another thread, and sends it when it is there. */
  void ReplyLater(const Visitor& visitor, std::string path) {
    const bool is_of_records = path.starts_with("/api/recording");
    const std::string accepted(FieldOf(header_->get(), http::field::accept_encoding));
    // The session is used and freed by the network thread alone: the job only carries it.
    auto job = [self = shared_from_this(), path, accepted, visitor, bench = shared_->workbench,
                is_shielded =
                    shared_->hub.IsShielded(visitor.role)](const std::stop_token& stop) mutable {
      auto made = TryMakeResponse(bench, path, visitor, is_shielded, accepted, stop);
      const auto executor = self->connection_.get_executor();
      asio::post(executor, [self = std::move(self), made = std::move(made)]() mutable {
        self->Reply(std::move(made));
      });
    };
    if (!shared_->lanes->TryPost(AnswerLanes::Find(visitor, is_of_records), std::move(job))) {
      Refuse(http::status::service_unavailable,
             {ErrorCode::kOutOfResource, "too many requests wait for an answer", std::move(path),
              "try again in a few seconds"});
    }
  }

  static Result<Response> TryMakeResponse(Workbench* bench, const std::string& path,
                                          const Visitor& visitor, bool is_shielded,
                                          const std::string& accepted,
                                          const std::stop_token& stop) {
    try {
      auto made = MakeApiResponse(bench, path, visitor, is_shielded, accepted, stop);
      if (made && made->file) {
        auto opened = RegularFile::Open(*made->file);
        if (!opened) {
          return Unexpected(opened.error());
        }
        made->owner = std::make_shared<const RegularFile>(std::move(*opened));
      }
      return made;
    } catch (const std::exception& failed) {
      return Fail(ErrorCode::kInternal, failed.what(), path, "reload the page");
    }
  }

  /** Checks Content-Length against a limit, and refuses the request beyond it. The parser counts
   the bytes of a chunked body. */
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
    if (!IsShort(kMaxBody)) {
      return;
    }
    auto parser = std::make_shared<http::request_parser<http::string_body>>(std::move(*header_));
    parser->body_limit(kMaxBody);
    http::async_read(connection_, buffer_, *parser,
                     [self = shared_from_this(), parser, handler](error_code error, std::size_t) {
                       if (error) {
                         self->RefuseBody(error);
                       } else {
                         self->cookie_ = FieldOf(parser->get(), http::field::cookie);
                         (*self.*handler)(ParseJson<Json>(parser->get().body()));
                       }
                     });
  }

  void ExchangeToken(const Json& body) {
    const auto admission = shared_->access->Admit(TextOr(body, "token", ""), cookie_);
    if (!admission) {
      return Refuse(http::status::unauthorized, admission.error());
    }
    if (admission->has_changed) {
      shared_->SaveAccessState();
      visitor_ = admission->visitor;
      Note({{"request", "come_in"}});
    }
    if (admission->visitor.role == Role::kParticipant) {
      shared_->UpdateParticipantLink();
    }
    http::response<http::string_body> response(http::status::ok, 11);
    response.set(http::field::set_cookie, admission->set_cookie);
    response.set(http::field::content_type, "application/json");
    response.body() = Json{{"role", ToString(admission->visitor.role)}}.dump();
    Send(std::move(response));
  }

  /** For somebody else: its token, and where it can be opened. */
  void MakeLink(const Json& body) {
    const auto role = ParseRole(TextOr(body, "role", ""));
    if (!role || (*role == Role::kParticipant && shared_->options.desk == nullptr)) {
      return Refuse(http::status::bad_request,
                    {ErrorCode::kInvalid, "there is no such role", "role",
                     "request a link for an operator or a viewer"});
    }
    if (IsSingleUse(*role) && !visitor_->is_owner) {
      return Refuse(http::status::forbidden,
                    {ErrorCode::kInvalid,
                     "only the user who started this studio can invite others to work here", "role",
                     "ask that user for a link, or pass on a link for viewers"});
    }
    const Access& access = *shared_->access;
    const ServerOptions& options = shared_->options;
    Json origins = Json::array();
    for (const std::string& name :
         options.tls ? options.names : std::vector<std::string>{"127.0.0.1"}) {
      origins.push_back(access.OriginOf(name));
    }
    const std::string token = shared_->access->MakeInvitation(*role);
    shared_->SaveAccessState();
    Note({{"request", "make_link"}, {"for", ToString(*role)}});
    SendJson(http::status::ok, {{"token", token},
                                {"role", ToString(*role)},
                                {"is_for_one", IsSingleUse(*role)},
                                {"origins", std::move(origins)},
                                {"is_local", asio::ip::make_address(options.address).is_loopback()},
                                {"reachable", options.reachable}});
  }

  /** All others have to leave, and their links are void. */
  void EndSharing(const Json& /*body*/) {
    if (!shared_->access->EndSharing(cookie_)) {
      return Refuse(
          http::status::forbidden,
          {ErrorCode::kInvalid, "only the user who started this studio can end the sharing", "",
           "ask that user, or close this page to leave"});
    }
    shared_->SaveAccessState();
    Note({{"request", "end_sharing"}});
    shared_->UpdateParticipantLink();
    shared_->hub.CloseRevoked();
    SendJson(http::status::ok, Json::object());
  }

  void ReadUpload(const Visitor& visitor) {
    if (visitor.role != Role::kOperator) {
      return Refuse(http::status::forbidden, {ErrorCode::kInvalid, "this link is for viewers", "",
                                              "ask for an operator's link"});
    }
    if (!IsShort(shared_->options.max_upload)) {
      return;
    }
    const std::uint32_t link = visitor.link();
    const std::string name = NameOfUpload(ToView(header_->get().target()));
    const auto folder = shared_->hub.uploads().Begin(shared_->options.upload_folder, link);
    if (!folder) {
      return Refuse(http::status::too_many_requests, folder.error());
    }
    auto upload = std::make_shared<Upload>(std::move(*header_), link, *folder / name);
    upload->parser.body_limit(shared_->options.max_upload);
    wire().expires_after(kUploadTime);
    SaveUpload(std::move(upload), true);
  }

  /** A body on its way into a file. */
  struct Upload {
    Upload(Header&& header, std::uint32_t of, std::filesystem::path path)
        : link(of), file(std::move(path)), parser(std::move(header)) {}

    std::uint32_t link;
    UploadFile file;
    http::request_parser<http::buffer_body> parser;
    std::vector<std::byte> piece = std::vector<std::byte>(64 << 10);  // [bytes]: a choice.
    std::size_t received{0};                                          ///< Bytes in the piece.
  };

  /** The disk lane makes the file, or adds the piece that was received; then the network thread
   reads the next one. */
  void SaveUpload(std::shared_ptr<Upload> upload, bool is_first) {
    shared_->lanes->Post(
        AnswerLanes::Lane::kDisk, [self = shared_from_this(), upload = std::move(upload),
                                   is_first](const std::stop_token& /*stop*/) mutable {
          auto saved = is_first
                           ? upload->file.Create()
                           : upload->file.Add(std::span(upload->piece).first(upload->received));
          const auto executor = self->connection_.get_executor();
          asio::post(executor, [self = std::move(self), upload = std::move(upload),
                                saved = std::move(saved)]() mutable {
            if (saved) {
              self->ReadUploadPiece(std::move(upload));
            } else {
              self->shared_->hub.uploads().GiveUp(upload->link);
              self->Refuse(http::status::insufficient_storage, saved.error());
            }
          });
        });
  }

  void ReadUploadPiece(std::shared_ptr<Upload> upload) {
    if (upload->parser.is_done()) {
      upload->file.Close();
      return FinishUpload(upload->link, upload->file.path(),
                          upload->file.path().filename().string());
    }
    auto& body = upload->parser.get().body();
    body.data = upload->piece.data();
    body.size = upload->piece.size();
    auto& parser = upload->parser;
    http::async_read(connection_, buffer_, parser,
                     [self = shared_from_this(), upload = std::move(upload)](error_code error,
                                                                             std::size_t) mutable {
                       if (error && error != http::error::need_buffer) {
                         self->shared_->hub.uploads().GiveUp(upload->link);
                         return self->RefuseBody(error);
                       }
                       upload->received = upload->piece.size() - upload->parser.get().body().size;
                       self->SaveUpload(std::move(upload), false);
                     });
  }

  void FinishUpload(std::uint32_t link, const std::filesystem::path& file,
                    const std::string& name) {
    const SceneOpener& opener = shared_->workbench->opener();
    const std::string id = shared_->hub.uploads().Finish(
        link, {file, name},
        [&opener](const std::filesystem::path& other) { return opener.IsInUse(other); });
    Note({{"request", "upload"}, {"name", name}});
    SendJson(http::status::ok, {{"upload", id}});
  }

  [[nodiscard]] AuditLog::Entry MakeEntry(Json did) const {
    return {visitor_ ? ToString(*visitor_) : "stranger", connection_.address(), "", std::move(did)};
  }

  void Note(Json did) {
    shared_->audit->Note(LinkOf(visitor_), MakeEntry(std::move(did)), MonotonicNs());
  }

  [[nodiscard]] static std::uint32_t LinkOf(const std::optional<Visitor>& visitor) {
    return visitor ? visitor->link() : AuditLog::kStranger;
  }

  void RefuseBody(error_code error) {
    if (error == http::error::body_limit) {
      Refuse(http::status::payload_too_large,
             {ErrorCode::kOutOfResource, "the file exceeds the limit for uploads", "",
              "open the file with `hvas studio FILE`"});
    } else {
      Refuse(http::status::bad_request,
             {ErrorCode::kInvalid, "the request was interrupted", "", "try again"});
    }
  }

  void Reply(Result<Response> answer) {
    if (!answer) {
      const bool is_missing = answer.error().code == ErrorCode::kNotFound;
      return Refuse(is_missing ? http::status::not_found : http::status::internal_server_error,
                    answer.error());
    }
    if (answer->file) {
      return SendFile(*answer->file,
                      std::static_pointer_cast<const RegularFile>(std::move(answer->owner)),
                      answer->type);
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
  void SendFile(const std::filesystem::path& file, const std::shared_ptr<const RegularFile>& opened,
                const std::string& type) {
    http::response<http::empty_body> response(http::status::ok, 11);
    response.set(http::field::content_type, type);
    response.set(http::field::content_disposition, MakeAttachmentValue(file.filename().string()));
    AddCommonFields(&response);
    response.content_length(opened->size());
    wire().expires_after(shared_->options.patience);
    auto kept = std::make_shared<http::response<http::empty_body>>(std::move(response));
    auto header = std::make_shared<http::response_serializer<http::empty_body>>(*kept);
    http::async_write_header(
        connection_, *header,
        [self = shared_from_this(), kept, header, opened](error_code error, std::size_t) {
          if (!error) {
            self->SendPiece(opened, 0, kept->keep_alive());
          }
        });
  }

  /** Sends a file from some byte on: the disk lane reads a piece, the network thread writes it. */
  void SendPiece(std::shared_ptr<const RegularFile> file, std::uintmax_t from, bool keeps_alive) {
    constexpr std::size_t kPiece = 256 << 10;  // [bytes]: a few milliseconds of a slow disk.
    if (from >= file->size()) {
      return EndReply(keeps_alive);
    }
    const std::size_t size = std::min<std::uintmax_t>(kPiece, file->size() - from);
    shared_->lanes->Post(
        AnswerLanes::Lane::kDisk, [self = shared_from_this(), file = std::move(file), from, size,
                                   keeps_alive](const std::stop_token& /*stop*/) mutable {
          auto piece = std::make_shared<std::string>(size, '\0');
          const auto read =
              ::pread(file->descriptor(), piece->data(), size, static_cast<off_t>(from));
          piece->resize(static_cast<std::size_t>(std::max<ssize_t>(read, 0)));
          const auto executor = self->connection_.get_executor();
          asio::post(executor, [self = std::move(self), file = std::move(file), piece, from,
                                keeps_alive]() mutable {
            self->WritePiece(std::move(file), piece, from, keeps_alive);
          });
        });
  }

  void WritePiece(std::shared_ptr<const RegularFile> file,
                  const std::shared_ptr<std::string>& piece, std::uintmax_t from,
                  bool keeps_alive) {
    if (piece->empty()) {  // The file became shorter: the client sees that the rest is missing.
      return wire().close();
    }
    ExpireAfterSending(piece->size());
    asio::async_write(connection_, asio::buffer(*piece),
                      [self = shared_from_this(), file = std::move(file), piece, from, keeps_alive](
                          error_code error, std::size_t sent) mutable {
                        if (!error) {
                          self->SendPiece(std::move(file), from + sent, keeps_alive);
                        }
                      });
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
    shared_->audit->NoteRefusal(
        LinkOf(visitor_), MakeEntry({{"request", "http"}, {"status", static_cast<int>(status)}}),
        NameOf(error.code), MonotonicNs());
    SendJson(status, {{"error", ToJson(error)}});
  }

  template <typename Body>
  void AddCommonFields(http::response<Body>* response) const {
    response->set("Content-Security-Policy", ToBeast(kContentSecurity));
    response->set("Cross-Origin-Opener-Policy", "same-origin");
    response->set("Cross-Origin-Embedder-Policy", "require-corp");
    response->set("Cross-Origin-Resource-Policy", "same-origin");
    response->set("X-Content-Type-Options", "nosniff");
    response->set("Referrer-Policy", "no-referrer");
    for (auto field = response->begin(); field != response->end();) {
      field = IsHeaderValue(ToView(field->value())) ? std::next(field) : response->erase(field);
    }
    response->keep_alive(!is_refused_ && !is_last_);
  }

  void ExpireAfterSending(std::uint64_t bytes) {
    const std::chrono::duration<double> long_enough(static_cast<double>(bytes) / kSlowest);
    wire().expires_after(shared_->options.patience +
                         std::chrono::duration_cast<std::chrono::milliseconds>(long_enough));
  }

  template <typename Body>
  void Send(http::response<Body> response) {
    AddCommonFields(&response);
    response.prepare_payload();
    ExpireAfterSending(response.payload_size().value_or(0));
    auto kept = std::make_shared<http::response<Body>>(std::move(response));
    http::async_write(connection_, *kept,
                      [self = shared_from_this(), kept](error_code error, std::size_t) {
                        self->owner_.reset();
                        if (!error) {
                          self->EndReply(kept->keep_alive());
                        }
                      });
  }

  void EndReply(bool keeps_alive) {
    if (keeps_alive) {
      ReadHeader();
    } else {
      End();
    }
  }

  /** Reads and discards the rest of the request for a while: closing with unread data would reset
   the connection, and the client could lose the response. */
  void End() {
    connection_.SetIdle(true);  // Nothing is lost where its place is needed.
    wire().expires_after(kLinger);
    if (!connection_.is_tls()) {
      error_code ignored;
      wire().socket().shutdown(tcp::socket::shutdown_send, ignored);
    }
    buffer_.clear();
    DiscardInput();
  }

  void DiscardInput() {
    connection_.async_read_some(buffer_.prepare(kMaxHeader),
                                [self = shared_from_this()](error_code error, std::size_t) {
                                  if (!error) {
                                    self->DiscardInput();
                                  }
                                });
  }

  Connection connection_;
  std::shared_ptr<ServerShared> shared_;
  beast::flat_buffer buffer_{kMaxHeader + (64 << 10)};
  std::optional<Header> header_;
  std::shared_ptr<const void> owner_;
  std::string cookie_;              ///< Of the request whose body was read.
  std::optional<Visitor> visitor_;  ///< Who has sent the request; none: a stranger.
  bool is_refused_{false};
  bool is_last_{false};  ///< The client asked for the end of the connection after this answer.
};

}  // namespace

void StartHttpSession(tcp::socket socket, std::shared_ptr<ServerShared> shared) {
  std::make_shared<HttpSession>(std::move(socket), std::move(shared))->Run();
}

}  // namespace hvas::studio
