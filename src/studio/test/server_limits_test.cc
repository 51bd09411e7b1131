// What is too long, too slow or too much.
#include <sys/resource.h>
#include <unistd.h>

#include "base/test/await_true.h"
#include "studio/connection_table.h"
#include "studio/test/server_fixture.h"

namespace hvas::studio {
namespace {

using testing::kMaxUpload;
using testing::Message;
using testing::RawClient;
using testing::Reply;
using testing::ServerTest;

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
  EXPECT_EQ(
      Post("/api/upload?name=a.stp", std::string(kMaxUpload + 1, 'x'), {{"Cookie", cookie}}).status,
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
    EXPECT_TRUE(hvas::testing::AwaitTrue([this] { return CountFiles() > 0; }));
  }
  EXPECT_TRUE(BecomesEmpty()) << CountFiles();
}

TEST_F(ServerTest, ViewersUploadIsRefused) {
  const Reply reply = Post("/api/upload?name=a.stp", "x", {{"Cookie", CookieOf(Role::kViewer)}});
  EXPECT_EQ(reply.status, 403);
  EXPECT_EQ(CountFiles(), 0u);
}

TEST_F(ServerTest, UploadIsOpenedByItsId) {
  const std::string bytes(kMaxUpload, 'x');
  const Reply reply =
      Post("/api/upload?name=part.stp", bytes, {{"Cookie", CookieOf(Role::kOperator)}});
  ASSERT_EQ(reply.status, 200);
  const auto client = Join(Role::kOperator);
  EXPECT_FALSE(Command(client.get(), {{"id", 1}, {"command", "open"}, {"upload", "1"}})["ok"]);
  EXPECT_TRUE(Command(
      client.get(),
      {{"id", 2}, {"command", "open"}, {"upload", Json::parse(reply.body)["upload"]}})["ok"]);
  EXPECT_FALSE(AwaitEvent(client.get(), "scene").is_null());
  const std::filesystem::path own = std::filesystem::directory_iterator(folder_)->path();
  std::ifstream kept(own / "part.stp");
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
  // It does not answer the close, and steers no more all the same: its browser has the lease again.
  const auto next = Join(Role::kOperator);
  EXPECT_TRUE(AwaitEvent(next.get(), "hello")["has_lease"]);
}

TEST_F(ServerTest, SocketsOfViewersLeaveRoomForTheOwner) {
  (void)CookieOf(Role::kOperator);
  std::vector<std::unique_ptr<RawClient>> clients;
  for (std::size_t i = 0; i < Hub::kMaxViewingClients; ++i) {
    clients.push_back(Join(Role::kViewer));
    EXPECT_FALSE(AwaitEvent(clients.back().get(), "hello").is_null());
  }
  for (int i = 0; i < 20; ++i) {
    const auto last = Join(Role::kViewer);
    const auto message = last->ReadMessage();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->opcode, Message::kClose);
    EXPECT_NE(message->bytes.find("as many pages are open"), std::string::npos);
  }
  EXPECT_FALSE(AwaitEvent(Join(Role::kOperator).get(), "hello").is_null());
  clients.pop_back();
  EXPECT_FALSE(Await(clients.front().get(), [](const Json& json) {
                 return json.value("event", "") == "roles" &&
                        json["clients"].size() == Hub::kMaxViewingClients - 1;
               }).is_null());
  EXPECT_FALSE(AwaitEvent(Join(Role::kViewer).get(), "hello").is_null());
}

TEST_F(ServerTest, IdleConnectionsOfViewersLeaveRoomForTheOwner) {
  const std::string owner = CookieOf(Role::kOperator);
  const Headers known{{"Host", host()}, {"Cookie", CookieOf(Role::kViewer)}};
  std::vector<std::unique_ptr<RawClient>> idle;
  for (std::size_t i = 0; i < 2 * ConnectionTable::kMostOfViewers; ++i) {
    idle.push_back(std::make_unique<RawClient>(server_->port()));
    EXPECT_EQ(idle.back()->Ask({"GET", "/api/scene", known, ""}).status, 404);
  }
  EXPECT_EQ(Get("/api/scene", {{"Cookie", owner}}).status, 404);
  EXPECT_FALSE(AwaitEvent(Join(Role::kOperator).get(), "hello").is_null());
  EXPECT_TRUE(idle.front()->IsClosed()) << "their own oldest one made room";
}

TEST_F(ServerTest, LinkSendsOneFileAtATimeAndTheNextOneTakesItsPlace) {
  const std::string cookie = CookieOf(Role::kOperator);
  const std::string start = "POST /api/upload?name=a.stp HTTP/1.1\r\nHost: " + host() +
                            "\r\nOrigin: " + origin() + "\r\nCookie: " + cookie + "\r\n";
  RawClient slow(server_->port());
  slow.Send(start + "Content-Length: 9000\r\n\r\n" + std::string(10, 'x'));
  EXPECT_TRUE(hvas::testing::AwaitTrue([this] { return CountFiles() > 0; }));
  EXPECT_EQ(Post("/api/upload?name=b.stp", "x", {{"Cookie", cookie}}).status, 429);
  slow.Send(std::string(8990, 'x'));
  EXPECT_EQ(slow.ReadReply().status, 200);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(Post("/api/upload?name=c.stp", "x", {{"Cookie", cookie}}).status, 200);
    EXPECT_EQ(CountFiles(), 2u) << "a folder and a file";
  }
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
  EXPECT_EQ(Get("/").status, 200);
  EXPECT_FALSE(AwaitEvent(Join(Role::kOperator).get(), "hello").is_null());
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
  constexpr std::size_t kMany = 150;  // More than twice what may be open.
  strangers.reserve(kMany);
  while (strangers.size() < kMany) {
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
  std::string body;
  body.resize(50'000'000, 'x');
  EXPECT_TRUE(client.Send(body));
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
    options.patience = std::chrono::milliseconds(1000);
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

TEST_F(ImpatientServerTest, SocketThatDoesNotAnswerIsLetGoAndItsBrowserHasTheLease) {
  const auto asleep = Join(Role::kOperator);  // a headset
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

}  // namespace
}  // namespace hvas::studio
