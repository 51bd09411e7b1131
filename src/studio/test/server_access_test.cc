// Who may come in, and what of (docs/protocol.md).
#include "studio/test/server_fixture.h"

namespace hvas::studio {
namespace {

using testing::Headers;
using testing::RawClient;
using testing::Reply;
using testing::ServerTest;

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

TEST_F(ServerTest, LinkToSteerIsExchangedOnce) {
  const std::string cookie = CookieOf(Role::kOperator);
  const Reply again = GiveToken(TokenOf(Role::kOperator));
  EXPECT_EQ(again.status, 401);
  EXPECT_EQ(again.headers.count("set-cookie"), 0u);
  EXPECT_NE(Json::parse(again.body)["error"]["remedy"], "");
  const std::string body = Json{{"token", TokenOf(Role::kOperator)}}.dump();
  EXPECT_EQ(Post("/api/session", body, {{"Cookie", cookie}}).status, 200) << "its own browser";
  EXPECT_EQ(GiveToken(TokenOf(Role::kViewer)).status, 200);
  EXPECT_EQ(GiveToken(TokenOf(Role::kViewer)).status, 200) << "for whoever has it";
}

TEST_F(ServerTest, WhoeverSteersMakesLinksForOthers) {
  const auto ask = [this](Role asks, const Json& body) {
    return Post("/api/link", body.dump(), {{"Cookie", CookieOf(asks)}});
  };
  for (const char* role : {"operator", "viewer"}) {
    const Reply made = ask(Role::kOperator, {{"role", role}});
    ASSERT_EQ(made.status, 200);
    const Json link = Json::parse(made.body);
    EXPECT_EQ(link["is_local"], true);
    EXPECT_EQ(link["origins"], Json::array({origin()}));
    EXPECT_EQ(Json::parse(GiveToken(link["token"]).body)["role"], role);
  }
  EXPECT_EQ(ask(Role::kViewer, {{"role", "viewer"}}).status, 403);
  for (const Json& wrong : {Json(), Json{{"role", "king"}}, Json{{"role", 5}}, Json::array(),
                            Json{{"role", "participant"}}}) {  // there is no study
    EXPECT_EQ(ask(Role::kOperator, wrong).status, 400) << wrong;
  }
  EXPECT_EQ(Post("/api/link", "{}").status, 401);
}

TEST_F(ServerTest, WhoOpenedTheStudioEndsTheSharing) {
  const std::string host = CookieOf(Role::kOperator);
  const std::string viewer = CookieOf(Role::kViewer);
  const auto end = [this](const std::string& cookie) {
    return Post("/api/end_sharing", "{}", {{"Cookie", cookie}}).status;
  };
  EXPECT_EQ(Post("/api/end_sharing", "{}").status, 401);
  EXPECT_EQ(end(viewer), 403);
  EXPECT_EQ(Get("/api/recordings", {{"Cookie", viewer}}).status, 200);
  EXPECT_EQ(end(host), 200);
  EXPECT_EQ(Get("/api/recordings", {{"Cookie", viewer}}).status, 401);
  EXPECT_EQ(Get("/api/recordings", {{"Cookie", host}}).status, 200);
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

}  // namespace
}  // namespace hvas::studio
