#include "studio/server.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "studio/test/raw_client.h"
#include "studio/test/small_bench.h"

namespace hvas::studio {
namespace {

using testing::Message;
using testing::RawClient;
using testing::Reply;
using testing::Request;
using Headers = std::vector<std::pair<std::string, std::string>>;

constexpr std::uint64_t kMostUpload = 10'000;  // [bytes]

/** While it lives, this program may have 200 descriptors. */
class FewDescriptors {
 public:
  FewDescriptors() {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit few{200, before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &few);
  }

  ~FewDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }

  FewDescriptors(const FewDescriptors&) = delete;
  FewDescriptors& operator=(const FewDescriptors&) = delete;

 private:
  rlimit before_{};
};

/** Of a server that speaks TLS, by a certificate that was made for this machine's loopback. */
ServerOptions MakeTlsOptions() {
  static const hvas::testing::TemporaryFolder folder;  // one for all
  ServerOptions options;
  options.tls = KeepCertificate(folder.path() / "tls", {"127.0.0.1"}, std::time(nullptr))->files;
  return options;
}

/** A server on a free port, with nothing open. */
class ServerTest : public ::testing::Test {
 protected:
  ServerTest() : ServerTest(ServerOptions()) {}

  explicit ServerTest(ServerOptions options) : is_tls_(options.tls.has_value()) {
    options.upload_folder = folder_;
    options.most_upload = kMostUpload;
    bench_ = std::make_unique<Workbench>(testing::SmallBench());
    server_ = std::make_unique<Server>(
        bench_.get(), std::vector<Example>{{"peg", "Peg", "a peg", "peg.step"}}, options);
    started_ = server_->Start().has_value();
    if (is_tls_) {
      trusted_ = options.tls->certificate;
    }
  }

  ~ServerTest() override { End(); }

  void SetUp() override { ASSERT_TRUE(started_); }

  void End() {
    if (server_ != nullptr) {
      bench_->Stop();
      server_->Stop();
      server_.reset();
    }
  }

  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(server_->port()); }

  [[nodiscard]] std::string origin() const { return (is_tls_ ? "https://" : "http://") + host(); }

  /** Connected as a browser would be. */
  [[nodiscard]] std::unique_ptr<RawClient> Connect(int receive_buffer = 0) const {
    auto client = std::make_unique<RawClient>(server_->port(), receive_buffer);
    if (is_tls_) {
      EXPECT_EQ(client->ShakeHands(trusted_, "127.0.0.1"), "ok");
    }
    return client;
  }

  [[nodiscard]] std::string TokenOf(Role role) const {
    const std::string link = server_->LinkFor(role);
    return link.substr(link.find("#t=") + 3);
  }

  Reply Ask(const Request& request) { return Connect()->Ask(request); }

  Reply Get(const std::string& target, Headers more = {}) {
    more.insert(more.begin(), {"Host", host()});
    return Ask({"GET", target, std::move(more), ""});
  }

  Reply Post(const std::string& target, const std::string& body, Headers more = {}) {
    more.insert(more.begin(), {{"Host", host()}, {"Origin", origin()}});
    return Ask({"POST", target, std::move(more), body});
  }

  Reply GiveToken(const std::string& token) {
    return Post("/api/session", Json{{"token", token}}.dump());
  }

  /** As the Cookie header of a client of a role. */
  std::string CookieOf(Role role) {
    const std::string given = GiveToken(TokenOf(role)).headers["set-cookie"];
    return given.substr(0, given.find(';'));
  }

  [[nodiscard]] std::string CookieName() const {
    return "hvas_session_" + std::to_string(server_->port());
  }

  std::unique_ptr<RawClient> Join(Role role, int receive_buffer = 0) {
    auto client = Connect(receive_buffer);
    client->SendUpgrade({{"Host", host()}, {"Origin", origin()}, {"Cookie", CookieOf(role)}});
    EXPECT_EQ(client->ReadReply().status, 101);
    return client;
  }

  /** The next text message that fits; null when none came. */
  static Json Await(RawClient* client, const std::function<bool(const Json&)>& fits) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::chrono::steady_clock::now() < until) {  // statuses come for ever
      const auto message = client->ReadMessage();
      if (!message) {
        break;
      }
      if (message->opcode == Message::kText) {
        Json json = Json::parse(message->bytes);
        if (fits(json)) {
          return json;
        }
      }
    }
    return nullptr;
  }

  static Json AwaitEvent(RawClient* client, const std::string& name) {
    return Await(client, [&name](const Json& json) { return json.value("event", "") == name; });
  }

  static Json Command(RawClient* client, const Json& command) {
    client->SendMessage(Message::kText, command.dump());
    return Await(client, [&](const Json& json) { return json.value("id", -1) == command["id"]; });
  }

  /** With the small product open. */
  std::unique_ptr<RawClient> JoinAndOpen() {
    auto client = Join(Role::kOperator);
    EXPECT_TRUE(Command(client.get(), {{"id", 1}, {"command", "open"}, {"example", "peg"}})["ok"]);
    EXPECT_FALSE(AwaitEvent(client.get(), "scene").is_null());
    return client;
  }

  [[nodiscard]] std::size_t CountFiles() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::recursive_directory_iterator(folder_),
                      std::filesystem::recursive_directory_iterator()));
  }

  /** What was kept is thrown away after the answer: waits for it. */
  [[nodiscard]] bool BecomesEmpty() const {
    constexpr int kTries = 500;
    for (int i = 0; i < kTries && CountFiles() > 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return CountFiles() == 0;
  }

  hvas::testing::TemporaryFolder temporary_;
  const std::filesystem::path folder_{temporary_.path()};
  const bool is_tls_;
  std::filesystem::path trusted_;
  std::unique_ptr<Workbench> bench_;
  std::unique_ptr<Server> server_;
  bool started_{false};
};

TEST_F(ServerTest, GivesThePageToWhoeverAsksByAKnownName) {
  const Reply page = Get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.headers.at("content-type"), "text/html; charset=utf-8");
  EXPECT_NE(page.body.find("<script"), std::string::npos);
}

// Protection: Host allow list.

TEST_F(ServerTest, OtherHostNamesAreRefusedBeforeAnythingElse) {
  for (const char* name : {"evil.example", "127.0.0.1.evil.example", "localhost.evil",
                           "127.0.0.1@evil", "", "0.0.0.0"}) {
    const std::string rebound = std::string(name) + ":" + std::to_string(server_->port());
    EXPECT_EQ(Ask({"GET", "/", {{"Host", rebound}}, ""}).status, 403) << name;
    EXPECT_EQ(Ask({"POST",
                   "/api/session",
                   {{"Host", rebound}, {"Origin", "http://" + rebound}},
                   Json{{"token", TokenOf(Role::kOperator)}}.dump()})
                  .status,
              403)
        << name;
  }
  EXPECT_EQ(Ask({"GET", "/", {}, ""}).status, 403);
}

TEST_F(ServerTest, SocketIsRefusedByAnotherHostNameThoughOriginAgrees) {  // DNS rebinding
  const std::string cookie = CookieOf(Role::kOperator);
  for (const std::string name : {"evil.example", "127.0.0.1.evil.example", "localhost.evil"}) {
    RawClient client(server_->port());
    client.SendUpgrade({{"Host", name}, {"Origin", "http://" + name}, {"Cookie", cookie}});
    EXPECT_EQ(client.ReadReply().status, 403) << name;
  }
}

// Protection: exact Origin.

TEST_F(ServerTest, ChangesFromOtherOriginsAreRefused) {
  const std::string body = Json{{"token", TokenOf(Role::kOperator)}}.dump();
  const std::string cookie = CookieOf(Role::kOperator);
  for (const std::string& other :
       {std::string("http://evil.example"), std::string("null"), origin() + ".evil.example",
        origin() + "0", "https://" + host(), std::string("http://127.0.0.1")}) {
    EXPECT_EQ(Ask({"POST", "/api/session", {{"Host", host()}, {"Origin", other}}, body}).status,
              403)
        << other;
    EXPECT_EQ(Ask({"POST",
                   "/api/upload?name=a.stp",
                   {{"Host", host()}, {"Origin", other}, {"Cookie", cookie}},
                   "x"})
                  .status,
              403)
        << other;
    RawClient client(server_->port());
    client.SendUpgrade({{"Host", host()}, {"Origin", other}, {"Cookie", cookie}});
    EXPECT_EQ(client.ReadReply().status, 403) << other;
    EXPECT_EQ(Get("/api/scene", {{"Origin", other}, {"Cookie", cookie}}).status, 403) << other;
  }
}

TEST_F(ServerTest, ChangesWithoutAnOriginAreRefused) {
  const std::string cookie = CookieOf(Role::kOperator);
  EXPECT_EQ(Ask({"POST", "/api/session", {{"Host", host()}}, "{}"}).status, 403);
  EXPECT_EQ(
      Ask({"POST", "/api/upload?name=a.stp", {{"Host", host()}, {"Cookie", cookie}}, "x"}).status,
      403);
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "PATCH"}) {
    EXPECT_EQ(Ask({method, "/", {{"Host", host()}}, ""}).status, 403) << method;
  }
  RawClient client(server_->port());
  client.SendUpgrade({{"Host", host()}, {"Cookie", cookie}});
  EXPECT_EQ(client.ReadReply().status, 403);
}

TEST_F(ServerTest, NoAnswerLetsOtherOriginsReadIt) {  // no CORS
  const Reply reply = Get("/", {{"Origin", origin()}});
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.headers.count("access-control-allow-origin"), 0u);
}

// Protection: token on every route.

TEST_F(ServerTest, TokenIsExchangedForACookieOfItsRole) {
  for (const Role role : {Role::kOperator, Role::kViewer}) {
    const Reply reply = GiveToken(TokenOf(role));
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(Json::parse(reply.body)["role"], ToString(role));
    const std::string& cookie = reply.headers.at("set-cookie");
    EXPECT_NE(cookie.find("HttpOnly"), std::string::npos);
    EXPECT_NE(cookie.find("SameSite=Strict"), std::string::npos);
    EXPECT_EQ(cookie.find(TokenOf(role)), std::string::npos);
  }
}

TEST_F(ServerTest, WrongTokensAreRefused) {
  EXPECT_EQ(GiveToken("").status, 401);
  EXPECT_EQ(GiveToken(MakeToken()).status, 401);
  EXPECT_EQ(GiveToken(TokenOf(Role::kOperator) + "x").status, 401);
  for (const char* body :
       {"x", "{", "[]", "null", "{\"token\": 5}", "{\"token\": [\"a\"]}", "\xFF"}) {
    const Reply reply = Post("/api/session", body);
    EXPECT_EQ(reply.status, 401) << body;
    EXPECT_EQ(reply.headers.count("set-cookie"), 0u);
    EXPECT_FALSE(Json::parse(reply.body)["error"]["remedy"].empty());
  }
}

TEST_F(ServerTest, NothingIsGivenWithoutACookie) {
  for (const Headers& headers :
       {Headers{}, Headers{{"Cookie", CookieName() + "=" + MakeToken()}},
        Headers{{"Cookie", CookieName() + "=" + TokenOf(Role::kOperator)}},
        Headers{{"Authorization", "Bearer " + TokenOf(Role::kOperator)}}}) {
    for (const char* target : {"/api/scene", "/api/model/0.glb", "/ws", "/api/anything", "/api/"}) {
      EXPECT_EQ(Get(target, headers).status, 401) << target;
    }
    EXPECT_EQ(Post("/api/upload?name=a.stp", "x", headers).status, 401);
    RawClient client(server_->port());
    Headers upgrade{{"Host", host()}, {"Origin", origin()}};
    upgrade.insert(upgrade.end(), headers.begin(), headers.end());
    client.SendUpgrade(upgrade);
    EXPECT_EQ(client.ReadReply().status, 401);
  }
  EXPECT_EQ(CountFiles(), 0u);
}

TEST_F(ServerTest, SocketIsGrantedToWhoeverHasACookie) {
  for (const Role role : {Role::kOperator, Role::kViewer}) {
    const auto client = Join(role);
    const Json hello = AwaitEvent(client.get(), "hello");
    EXPECT_EQ(hello["role"], ToString(role));
  }
}

// Protection: no file paths from clients.

TEST_F(ServerTest, PathsLeadToNoFiles) {
  const std::string cookie = CookieOf(Role::kOperator);
  for (const char* path : {"/../../../../etc/passwd",
                           "/..",
                           "/../",
                           "/%2e%2e/%2e%2e/%2e%2e/etc/passwd",
                           "/%2E%2E%2Fetc%2Fpasswd",
                           "//etc/passwd",
                           "///etc/passwd",
                           "/..\\..\\etc\\passwd",
                           "/assets/../index.html",
                           "/assets/..%2findex.html",
                           "/assets",
                           "/assets/",
                           "/index.html/",
                           "/etc/passwd",
                           "/assets/../../../../etc/passwd",
                           "etc/passwd",
                           "file:///etc/passwd",
                           "/index.html%00.js",
                           "/api/model/../../../etc/passwd",
                           "/api/model/%2e%2e%2fetc%2fpasswd",
                           "/api/model/.glb",
                           "/api/model/",
                           "/api/upload/../../etc/passwd",
                           "*"}) {
    const int status = Get(path, {{"Cookie", cookie}}).status;
    EXPECT_TRUE(status == 404 || status == 400 || status == 0) << path << ": " << status;
  }
}

TEST_F(ServerTest, NameOfAnUploadStaysInItsFolder) {
  const std::string cookie = CookieOf(Role::kOperator);
  const std::filesystem::path outside = folder_.parent_path() / "hvas_studio_evil.stp";
  std::filesystem::remove(outside);
  for (const char* name :
       {"../../hvas_studio_evil.stp", "..%2f..%2fhvas_studio_evil.stp", "/tmp/hvas_studio_evil.stp",
        "..\\hvas_studio_evil.stp", ".", "..", "...", "", "%", "%2", "a%00b.stp", ".hidden",
        "a/b/c.stp", "~root", "$(id).stp", "a b.stp"}) {
    const Reply reply = Post(std::string("/api/upload?name=") + name, "x", {{"Cookie", cookie}});
    EXPECT_TRUE(reply.status == 200 || reply.status == 400 || reply.status == 0)
        << name << ": " << reply.status;
  }
  EXPECT_FALSE(std::filesystem::exists(outside));
  EXPECT_FALSE(std::filesystem::exists("/tmp/hvas_studio_evil.stp"));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
    if (entry.is_regular_file()) {
      EXPECT_EQ(entry.path().parent_path().parent_path(), folder_) << entry.path();
      EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
    }
  }
}

TEST_F(ServerTest, LongNamesOfUploadsKeepTheirEnd) {
  const Reply reply = Post("/api/upload?name=" + std::string(1000, 'a') + ".step", "x",
                           {{"Cookie", CookieOf(Role::kOperator)}});
  ASSERT_EQ(reply.status, 200);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
    if (entry.is_regular_file()) {
      EXPECT_EQ(entry.path().extension(), ".step");
      EXPECT_LE(entry.path().filename().string().size(), 80u);
    }
  }
}

// Protection: limits.

TEST_F(ServerTest, LongHeaderIsRefused) {
  const std::string start = "GET / HTTP/1.1\r\nHost: " + host() + "\r\nX: ";
  {
    RawClient client(server_->port());
    client.Send(start + std::string(9 << 10, 'a'));
    EXPECT_EQ(client.ReadReply().status, 431);
    EXPECT_TRUE(client.IsClosed());
  }
  {
    RawClient client(server_->port());
    client.Send(start + std::string(64 << 10, 'a') + "\r\n\r\n");
    const int status = client.ReadReply().status;
    EXPECT_TRUE(status == 431 || status == 0) << status;  // 0: closed with bytes unread
    EXPECT_TRUE(client.IsClosed());
  }
  EXPECT_EQ(Get("/").status, 200);
}

TEST_F(ServerTest, LongBodyOfATokenIsRefused) {
  EXPECT_EQ(Post("/api/session", std::string(5000, ' ')).status, 413);
  RawClient chunked(server_->port());
  chunked.Send("POST /api/session HTTP/1.1\r\nHost: " + host() + "\r\nOrigin: " + origin() +
               "\r\nTransfer-Encoding: chunked\r\n\r\n1388\r\n" + std::string(5000, ' ') + "\r\n");
  EXPECT_EQ(chunked.ReadReply().status, 413);
  RawClient huge(server_->port());
  huge.Send("POST /api/session HTTP/1.1\r\nHost: " + host() + "\r\nOrigin: " + origin() +
            "\r\nContent-Length: 18446744073709551615\r\n\r\n");
  const int status = huge.ReadReply().status;
  EXPECT_TRUE(status == 413 || status == 400 || status == 0) << status;
  EXPECT_EQ(Get("/").status, 200);
}

TEST_F(ServerTest, UploadAboveTheLimitLeavesNothing) {
  const std::string cookie = CookieOf(Role::kOperator);
  EXPECT_EQ(Post("/api/upload?name=a.stp", std::string(kMostUpload + 1, 'x'), {{"Cookie", cookie}})
                .status,
            413);
  const std::string start = "POST /api/upload?name=a.stp HTTP/1.1\r\nHost: " + host() +
                            "\r\nOrigin: " + origin() + "\r\nCookie: " + cookie + "\r\n";
  {
    RawClient declared(server_->port());
    declared.Send(start + "Content-Length: 1000000000\r\n\r\n");  // refused before it comes
    EXPECT_EQ(declared.ReadReply().status, 413);
  }
  {
    RawClient chunked(server_->port());
    const std::string chunk = "FA0\r\n" + std::string(4000, 'x') + "\r\n";
    chunked.Send(start + "Transfer-Encoding: chunked\r\n\r\n" + chunk + chunk + chunk);
    EXPECT_EQ(chunked.ReadReply().status, 413);
  }
  EXPECT_TRUE(BecomesEmpty()) << CountFiles();
}

TEST_F(ServerTest, UploadThatBreaksOffLeavesNothing) {
  {
    RawClient client(server_->port());
    client.Send("POST /api/upload?name=a.stp HTTP/1.1\r\nHost: " + host() +
                "\r\nOrigin: " + origin() + "\r\nCookie: " + CookieOf(Role::kOperator) +
                "\r\nContent-Length: 9000\r\n\r\n" + std::string(4000, 'x'));
    for (int i = 0; i < 500 && CountFiles() == 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_GT(CountFiles(), 0u);
  }
  EXPECT_TRUE(BecomesEmpty()) << CountFiles();
}

TEST_F(ServerTest, ViewersUploadIsRefused) {
  const Reply reply = Post("/api/upload?name=a.stp", "x", {{"Cookie", CookieOf(Role::kViewer)}});
  EXPECT_EQ(reply.status, 403);
  EXPECT_EQ(CountFiles(), 0u);
}

TEST_F(ServerTest, UploadIsOpenedByItsId) {
  const std::string bytes(kMostUpload, 'x');
  const Reply reply =
      Post("/api/upload?name=part.stp", bytes, {{"Cookie", CookieOf(Role::kOperator)}});
  ASSERT_EQ(reply.status, 200);
  const auto client = Join(Role::kOperator);
  EXPECT_FALSE(Command(client.get(), {{"id", 1}, {"command", "open"}, {"upload", "1"}})["ok"]);
  EXPECT_TRUE(Command(
      client.get(),
      {{"id", 2}, {"command", "open"}, {"upload", Json::parse(reply.body)["upload"]}})["ok"]);
  EXPECT_FALSE(AwaitEvent(client.get(), "scene").is_null());
  std::ifstream kept(folder_ / "1" / "part.stp");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(kept), {}), bytes);
}

TEST_F(ServerTest, LongMessageEndsTheSocket) {
  const auto client = Join(Role::kOperator);
  EXPECT_FALSE(AwaitEvent(client.get(), "hello").is_null());
  // Nearly as long as may be is answered.
  client->SendMessage(Message::kText, "{\"id\": 7, \"x\": \"" + std::string(60 << 10, 'a') + "\"}");
  const Json reply = Await(client.get(), [](const Json& json) { return json.value("id", 0) == 7; });
  EXPECT_FALSE(reply.is_null());
  client->SendMessage(Message::kText, std::string((64 << 10) + 1, 'a'));
  int last = 0;
  while (const auto message = client->ReadMessage()) {
    last = message->opcode;
    if (last == Message::kClose) {
      EXPECT_EQ(message->bytes.substr(0, 2), "\x03\xF1");  // 1009, too big
      break;
    }
  }
  EXPECT_EQ(last, Message::kClose);
  EXPECT_TRUE(client->IsClosed());
}

TEST_F(ServerTest, FramesThatAreNoneEndTheSocketAndFreeTheLease) {
  const auto client = Join(Role::kOperator);
  EXPECT_TRUE(AwaitEvent(client.get(), "hello")["has_lease"]);
  client->SendMessage(Message::kBinary, "no frame");
  const auto is_close = [&] {
    while (const auto message = client->ReadMessage()) {
      if (message->opcode == Message::kClose) {
        return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(is_close());
  // It does not answer the close, and steers no more all the same.
  const auto next = Join(Role::kOperator);
  EXPECT_TRUE(AwaitEvent(next.get(), "hello")["has_lease"]);
}

TEST_F(ServerTest, NinthClientIsTurnedAway) {
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 8; ++i) {
    clients.push_back(Join(Role::kViewer));
    EXPECT_FALSE(AwaitEvent(clients.back().get(), "hello").is_null());
  }
  const auto ninth = Join(Role::kOperator);
  const auto message = ninth->ReadMessage();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->opcode, Message::kClose);
  EXPECT_NE(message->bytes.find("8 clients"), std::string::npos);
  clients.pop_back();
  EXPECT_FALSE(Await(clients.front().get(), [](const Json& json) {
                 return json.value("event", "") == "roles" && json["clients"].size() == 7;
               }).is_null());
  EXPECT_FALSE(AwaitEvent(Join(Role::kOperator).get(), "hello").is_null());
}

TEST_F(ServerTest, ClientThatNeverReadsIsLetGoAndHoldsUpNobody) {
  const auto deaf = Join(Role::kOperator, 4096);
  const auto other = Join(Role::kViewer);
  EXPECT_FALSE(AwaitEvent(other.get(), "hello").is_null());
  const Json big{{"event", "test"}, {"text", std::string(1 << 20, 'a')}};
  bool is_alone = false;
  for (int i = 0; i < 40; ++i) {  // more than is kept for a client, and than the system keeps
    bench_->on_event(big);
    EXPECT_FALSE(Await(other.get(), [&](const Json& json) {
                   const std::string name = json.value("event", "");
                   is_alone = is_alone || (name == "roles" && json["clients"].size() == 1);
                   return name == "test";
                 }).is_null());
  }
  EXPECT_TRUE(is_alone);
}

TEST_F(ServerTest, HeadersThatNeverEndHoldUpNobody) {  // slow loris
  std::vector<std::unique_ptr<RawClient>> slow;
  for (int i = 0; i < 100; ++i) {
    slow.push_back(std::make_unique<RawClient>(server_->port()));
    slow.back()->Send("GET / HTTP/1.1\r\nHost: 127.0.");
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(Get("/").status, 200);
  EXPECT_FALSE(AwaitEvent(Join(Role::kOperator).get(), "hello").is_null());
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST_F(ServerTest, RubbishInsteadOfARequestEndsTheConnection) {
  for (const std::string& bytes :
       {std::string("\x16\x03\x01\x02\x00\x01\x00", 7), std::string("GET\r\n\r\n"),
        std::string("GET / HTTP/9.9\r\n\r\n"), std::string("\r\n\r\n\r\n"), std::string(100, '\0'),
        std::string("GET / HTTP/1.1\r\nContent-Length: -1\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n")}) {
    RawClient client(server_->port());
    client.Send(bytes);
    const int status = client.ReadReply().status;
    EXPECT_TRUE(status == 0 || status >= 400) << status;
  }
  EXPECT_EQ(Get("/").status, 200);
}

TEST_F(ServerTest, WhoeverHoldsConnectionsOpenKeepsNobodyOut) {
  const std::string cookie = CookieOf(Role::kOperator);
  const auto known = Join(Role::kOperator);
  EXPECT_FALSE(AwaitEvent(known.get(), "hello").is_null());
  std::vector<std::unique_ptr<RawClient>> strangers;
  for (int i = 0; i < 150; ++i) {  // more than twice what may be open
    strangers.push_back(std::make_unique<RawClient>(server_->port()));
  }
  EXPECT_EQ(Get("/").status, 200);
  EXPECT_TRUE(strangers.front()->IsClosed());  // the first to come is the first to go
  EXPECT_EQ(Command(known.get(), {{"id", 1}, {"command", "status"}})["ok"], true);
  EXPECT_EQ(Get("/api/scene", {{"Cookie", cookie}}).status, 404);
}

TEST_F(ServerTest, UploadFarAboveTheLimitIsAnsweredBeforeTheConnectionEnds) {
  RawClient client(server_->port());
  client.Send("POST /api/upload?name=a.stp HTTP/1.1\r\nHost: " + host() +
              "\r\nOrigin: " + origin() + "\r\nCookie: " + CookieOf(Role::kOperator) +
              "\r\nContent-Length: 50000000\r\n\r\n");
  // As browsers do, all is sent before the answer is read.
  EXPECT_TRUE(client.Send(std::string(50'000'000, 'x')));
  EXPECT_EQ(client.ReadReply().status, 413);
}

TEST_F(ServerTest, OutOfDescriptorsItRestsAndGoesOn) {
  const FewDescriptors few;
  std::vector<int> taken;
  for (int copy = ::dup(0); copy >= 0; copy = ::dup(0)) {
    taken.push_back(copy);
  }
  ASSERT_EQ(errno, EMFILE);
  ::close(taken.back());
  taken.pop_back();
  RawClient waiting(server_->port());  // has the last one
  waiting.Send({"GET", "/", {{"Host", host()}}, ""});
  const std::clock_t start = std::clock();  // of the processor, not of the wall
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const double busy_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  for (const int copy : taken) {
    ::close(copy);
  }
  EXPECT_LT(busy_s, 0.25);
  EXPECT_EQ(waiting.ReadReply().status, 200);
}

/** A server that does not wait long. */
class ImpatientServerTest : public ServerTest {
 protected:
  ImpatientServerTest() : ServerTest(MakeOptions()) {}

  static ServerOptions MakeOptions() {
    ServerOptions options;
    options.patience = std::chrono::milliseconds(300);
    return options;
  }
};

TEST_F(ImpatientServerTest, WhoeverIsSilentIsLetGo) {
  RawClient silent(server_->port());
  RawClient slow(server_->port());
  slow.Send("GET / HTTP/1.1\r\nHost: 127.0.");
  RawClient idle(server_->port());
  EXPECT_EQ(idle.Ask({"GET", "/", {{"Host", host()}}, ""}).status, 200);
  EXPECT_TRUE(silent.IsClosed());
  EXPECT_TRUE(slow.IsClosed());
  EXPECT_TRUE(idle.IsClosed());
}

TEST_F(ImpatientServerTest, SocketThatDoesNotAnswerIsLetGoAndItsLeaseIsFree) {  // a headset asleep
  const auto asleep = Join(Role::kOperator);
  EXPECT_TRUE(AwaitEvent(asleep.get(), "hello")["has_lease"]);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  for (int i = 0; i < 100; ++i) {
    const auto next = Join(Role::kOperator);
    if (AwaitEvent(next.get(), "hello")["has_lease"]) {
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  ADD_FAILURE() << "it still has the lease";
}

class TlsServerTest : public ServerTest {
 protected:
  TlsServerTest() : TlsServerTest(std::chrono::milliseconds(30'000)) {}

  explicit TlsServerTest(std::chrono::milliseconds patience) : ServerTest(MakeOptions(patience)) {}

  static ServerOptions MakeOptions(std::chrono::milliseconds patience) {
    ServerOptions options = MakeTlsOptions();
    options.patience = patience;
    return options;
  }
};

TEST_F(TlsServerTest, PageCookieSceneAndSocketComeEncrypted) {  // N11: headsets need https
  EXPECT_EQ(server_->LinkFor(Role::kOperator).substr(0, 18), "https://127.0.0.1:");
  EXPECT_EQ(Get("/").status, 200);
  const Reply given = GiveToken(TokenOf(Role::kOperator));
  EXPECT_EQ(given.status, 200);
  EXPECT_NE(given.headers.at("set-cookie").find("; Secure"), std::string::npos);
  const auto client = JoinAndOpen();
  const std::string cookie = CookieOf(Role::kOperator);
  const Reply scene = Get("/api/scene", {{"Cookie", cookie}});
  ASSERT_EQ(scene.status, 200);
  const Reply model = Get(Json::parse(scene.body)["glb"], {{"Cookie", cookie}});
  EXPECT_EQ(model.body.substr(0, 4), "glTF");
  EXPECT_EQ(
      Post("/api/upload?name=a.stp", std::string(kMostUpload, 'x'), {{"Cookie", cookie}}).status,
      200);
  EXPECT_EQ(Command(client.get(), {{"id", 5}, {"command", "status"}})["ok"], true);
}

TEST_F(TlsServerTest, CertificateIsTheOneWhoseFingerprintWasPrinted) {
  const auto client = Connect();
  EXPECT_EQ(client->PeerFingerprint(), CalcFingerprint(trusted_).value_or("none"));
  RawClient elsewhere(server_->port());
  EXPECT_EQ(elsewhere.ShakeHands(trusted_, "127.0.0.2"), "IP address mismatch");
}

TEST_F(TlsServerTest, OtherHostsAndOriginsAreRefusedAsWithout) {
  EXPECT_EQ(Ask({"GET", "/", {{"Host", "evil.example"}}, ""}).status, 403);
  const std::string cookie = CookieOf(Role::kOperator);
  for (const std::string& other :
       {"http://" + host(), std::string("https://evil.example"), origin() + "0"}) {
    const auto client = Connect();
    client->SendUpgrade({{"Host", host()}, {"Origin", other}, {"Cookie", cookie}});
    EXPECT_EQ(client->ReadReply().status, 403) << other;
  }
}

TEST_F(TlsServerTest, UnencryptedRequestIsSentToThePageByHttps) {
  RawClient plain(server_->port());
  const Reply reply = plain.Ask({"GET", "/api/scene", {{"Host", host()}}, ""});
  EXPECT_EQ(reply.status, 307);
  EXPECT_EQ(reply.headers.at("location"), origin() + "/");
  EXPECT_NE(reply.body.find("https only"), std::string::npos);
  EXPECT_TRUE(plain.IsClosed());
  RawClient rebound(server_->port());
  EXPECT_EQ(rebound.Ask({"GET", "/", {{"Host", "evil.example"}}, ""}).status, 403);
  RawClient token(server_->port());  // not even with the right token
  const Reply given = token.Ask({"POST",
                                 "/api/session",
                                 {{"Host", host()}, {"Origin", origin()}},
                                 Json{{"token", TokenOf(Role::kOperator)}}.dump()});
  EXPECT_EQ(given.status, 307);
  EXPECT_EQ(given.headers.count("set-cookie"), 0u);
}

TEST_F(TlsServerTest, RubbishInsteadOfAHandshakeEndsTheConnection) {
  for (const std::string& bytes :
       {std::string("\x16\x03\x01\x02\x00\x01\x00\xFF\xFF\xFF\xFF\xFF", 12),
        std::string(600, '\x16'), std::string("\0\0\0\0", 4), std::string("\r\n\r\n")}) {
    RawClient client(server_->port());
    client.Send(bytes + std::string(600, '\x01'));
    EXPECT_TRUE(client.IsClosed());
  }
  EXPECT_EQ(Get("/").status, 200);
}

TEST_F(TlsServerTest, StopsInTheMiddleOfHandshakes) {
  RawClient begun(server_->port());
  begun.Send(std::string("\x16\x03\x01\x02\x00", 5));
  const auto client = JoinAndOpen();
  End();
  EXPECT_TRUE(begun.IsClosed());
  EXPECT_TRUE(client->IsClosed());
}

class ImpatientTlsServerTest : public TlsServerTest {
 protected:
  ImpatientTlsServerTest() : TlsServerTest(std::chrono::milliseconds(300)) {}
};

TEST_F(ImpatientTlsServerTest, HandshakesThatNeverEndAreLetGo) {
  RawClient silent(server_->port());
  RawClient begun(server_->port());
  begun.Send(std::string("\x16\x03\x01\x02\x00", 5));
  EXPECT_TRUE(silent.IsClosed());
  EXPECT_TRUE(begun.IsClosed());
}

/** Why a server cannot start; kInternal when it can. */
Error FindObstacle(const ServerOptions& options) {
  Workbench bench(testing::SmallBench());
  Server server(&bench, {}, options);
  const auto started = server.Start();
  bench.Stop();
  return started ? Error() : started.error();
}

TEST(ServerStartTest, OtherMachinesAreNotServedUnencrypted) {
  ServerOptions options;
  for (const char* address : {"0.0.0.0", "::", "192.0.2.1"}) {
    options.address = address;
    const Error error = FindObstacle(options);
    EXPECT_EQ(error.code, ErrorCode::kInvalid) << address;
    EXPECT_NE(error.message.find("unencrypted"), std::string::npos) << error.message;
  }
  options.address = "localhost";
  EXPECT_EQ(FindObstacle(options).code, ErrorCode::kInvalid);
}

TEST(ServerStartTest, AddressesOfOtherMachinesAndFilesThatAreNoneAreErrors) {
  ServerOptions options = MakeTlsOptions();
  options.address = "192.0.2.1";  // of no machine; RFC 5737
  EXPECT_NE(FindObstacle(options).remedy.find("address of this machine"), std::string::npos);
  options.address = "127.0.0.1";
  const std::filesystem::path certificate = options.tls->certificate;
  const hvas::testing::TemporaryFolder folder;
  const std::filesystem::path broken = folder / "broken.pem";
  std::ofstream(broken) << "-----BEGIN PRIVATE KEY-----\nAAAA\n-----END PRIVATE KEY-----\n";
  options.tls = TlsFiles{certificate, broken};
  const Error no_key = FindObstacle(options);
  EXPECT_EQ(no_key.where, broken.string());
  EXPECT_NE(no_key.remedy.find("--key"), std::string::npos);
  options.tls = TlsFiles{folder / "missing.pem", certificate};
  EXPECT_NE(FindObstacle(options).remedy.find("--certificate"), std::string::npos);
}

// Protection: headers, caching.

TEST_F(ServerTest, EveryAnswerHasTheHeadersThatProtect) {
  const std::string cookie = CookieOf(Role::kOperator);
  const std::string etag = Get("/").headers.at("etag");
  const std::vector<std::pair<int, Reply>> replies{
      {200, Get("/")},
      {200, GiveToken(TokenOf(Role::kViewer))},
      {304, Get("/", {{"If-None-Match", etag}})},
      {401, Get("/api/scene")},
      {403, Ask({"GET", "/", {{"Host", "evil"}}, ""})},
      {404, Get("/nothing")},
      {404, Get("/api/scene", {{"Cookie", cookie}})},
      {413, Post("/api/session", std::string(5000, ' '))}};
  for (const auto& [status, reply] : replies) {
    EXPECT_EQ(reply.status, status);
    const auto is = [&reply = reply](const char* name, const char* value) {
      const auto found = reply.headers.find(name);
      return found != reply.headers.end() && found->second == value;
    };
    EXPECT_TRUE(is("content-security-policy",
                   "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; "
                   "img-src 'self' data: blob:; connect-src 'self'; worker-src 'self'; font-src "
                   "'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"))
        << status;
    EXPECT_TRUE(is("cross-origin-opener-policy", "same-origin")) << status;
    EXPECT_TRUE(is("cross-origin-embedder-policy", "require-corp")) << status;
    EXPECT_TRUE(is("cross-origin-resource-policy", "same-origin")) << status;
    EXPECT_TRUE(is("x-content-type-options", "nosniff")) << status;
    EXPECT_TRUE(is("referrer-policy", "no-referrer")) << status;
  }
}

TEST_F(ServerTest, WhatHasNotChangedIsNotSentAgain) {
  const Reply first = Get("/");
  const Reply again = Get("/", {{"If-None-Match", first.headers.at("etag")}});
  EXPECT_EQ(again.status, 304);
  EXPECT_TRUE(again.body.empty());
  EXPECT_EQ(Get("/", {{"If-None-Match", "\"other\""}}).body, first.body);
}

TEST_F(ServerTest, PackedAssetsAreGivenToWhoeverTakesThem) {
  EXPECT_EQ(Get("/").headers.count("content-encoding"), 0u);
  const Reply gzip = Get("/", {{"Accept-Encoding", "gzip"}});
  if (gzip.headers.count("content-encoding") != 0) {
    EXPECT_EQ(gzip.headers.at("content-encoding"), "gzip");
    EXPECT_EQ(gzip.body.substr(0, 2), "\x1F\x8B");
  }
  EXPECT_EQ(gzip.headers.at("vary"), "Accept-Encoding");
}

TEST_F(ServerTest, OneConnectionAnswersOneRequestAfterTheOther) {
  RawClient client(server_->port());
  const Request request{"GET", "/", {{"Host", host()}}, ""};
  EXPECT_EQ(client.Ask(request).status, 200);
  client.Send(request);
  client.Send(request);
  EXPECT_EQ(client.ReadReply().status, 200);
  EXPECT_EQ(client.ReadReply().status, 200);
}

// What is open.

TEST_F(ServerTest, SceneAndItsModelAreGiven) {
  const auto client = JoinAndOpen();
  const std::string cookie = CookieOf(Role::kViewer);
  const Reply reply = Get("/api/scene", {{"Cookie", cookie}});
  ASSERT_EQ(reply.status, 200);
  const Json scene = Json::parse(reply.body);
  EXPECT_EQ(scene["occurrences"].size(), 2u);
  EXPECT_GE(scene["mates"].size(), 1u);
  const std::string glb = scene["glb"];
  const Reply model = Get(glb, {{"Cookie", cookie}});
  ASSERT_EQ(model.status, 200);
  EXPECT_EQ(model.body.substr(0, 4), "glTF");
  EXPECT_EQ(model.headers.at("content-type"), "model/gltf-binary");
  EXPECT_EQ(Get(glb, {{"Cookie", cookie}, {"If-None-Match", model.headers.at("etag")}}).status,
            304);
  EXPECT_EQ(Get(glb).status, 401);
  EXPECT_EQ(Get(glb + "x", {{"Cookie", cookie}}).status, 404);
}

TEST_F(ServerTest, FramesComeWithCreditOnly) {
  const auto opened = JoinAndOpen();
  const auto client = Join(Role::kViewer);  // it is sent frames from its first one on
  const auto next_frame = [&]() -> std::optional<Message> {
    while (auto message = client->ReadMessage()) {
      if (message->opcode == Message::kBinary) {
        return message;
      }
    }
    return std::nullopt;
  };
  std::uint32_t seq = 0;
  for (int i = 0; i < 2; ++i) {
    const auto message = next_frame();
    ASSERT_TRUE(message);
    std::memcpy(&seq, message->bytes.data() + offsetof(protocol::Header, seq), sizeof(seq));
  }
  // No third one, until the second has been seen: a status comes every second, and no frame before.
  for (int statuses = 0; statuses < 2;) {
    const auto message = client->ReadMessage();
    ASSERT_TRUE(message);
    ASSERT_EQ(message->opcode, Message::kText);
    statuses += Json::parse(message->bytes).value("event", "") == "status" ? 1 : 0;
  }
  const protocol::Acknowledgement credit{seq};
  std::string bytes;
  AppendFrame<protocol::Acknowledgement>(std::span(&credit, 1), 1, 1, 0, &bytes);
  client->SendMessage(Message::kBinary, bytes);
  EXPECT_TRUE(next_frame());
}

// The end.

TEST_F(ServerTest, StopsWithClientsConnected) {
  const auto steering = JoinAndOpen();
  const auto looking = Join(Role::kViewer);
  RawClient idle(server_->port());
  RawClient uploading(server_->port());
  uploading.Send("POST /api/upload?name=a.stp HTTP/1.1\r\nHost: " + host() +
                 "\r\nOrigin: " + origin() + "\r\nCookie: " + CookieOf(Role::kOperator) +
                 "\r\nContent-Length: 9000\r\n\r\nxxx");
  const auto start = std::chrono::steady_clock::now();
  End();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  EXPECT_TRUE(looking->IsClosed());
  EXPECT_TRUE(idle.IsClosed());
  EXPECT_TRUE(uploading.IsClosed());
}

TEST_F(ServerTest, PortThatIsTakenIsAnError) {
  Workbench bench(testing::SmallBench());
  ServerOptions options;
  options.port = server_->port();
  options.upload_folder = folder_;
  Server other(&bench, {}, options);
  const auto started = other.Start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, ErrorCode::kOutOfResource);
  EXPECT_NE(started.error().remedy.find("--port"), std::string::npos);
  bench.Stop();
}

}  // namespace
}  // namespace hvas::studio
