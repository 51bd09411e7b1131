#include "studio/test/server_fixture.h"

namespace hvas::studio {
namespace {

using testing::Message;
using testing::RawClient;
using testing::Reply;
using testing::Request;
using testing::ServerTest;

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
  for (std::size_t i = 0; i < Hub::kMaxUnseen; ++i) {
    const auto message = next_frame();
    ASSERT_TRUE(message);
    std::memcpy(&seq, message->bytes.data() + offsetof(protocol::Header, seq), sizeof(seq));
  }
  // No further one, until these have been seen: a status comes every second, and no frame before.
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
  End();  // does not wait for them: the server would have an hour's patience
  EXPECT_TRUE(looking->IsClosed());
  EXPECT_TRUE(idle.IsClosed());
  EXPECT_TRUE(uploading.IsClosed());
}

TEST_F(ServerTest, NextStartHasTheSameAddressAndKnowsWhoHasComeIn) {
  const auto serve = [this](Workbench* bench) {
    ServerOptions options;
    options.upload_folder = folder_;
    options.access_file = temporary_ / "access.json";
    return std::make_unique<Server>(bench, std::vector<Example>(), options);
  };
  End();
  Workbench bench(testing::SmallBench());
  server_ = serve(&bench);
  ASSERT_TRUE(server_->Start());
  EXPECT_FALSE(server_->has_kept_links());
  const std::string link = server_->LinkFor(Role::kOperator);
  const std::string cookie = CookieOf(Role::kOperator);
  server_.reset();  // what is kept does not wait for the end: it was written as they came in

  server_ = serve(&bench);
  ASSERT_TRUE(server_->Start());
  EXPECT_TRUE(server_->has_kept_links());
  EXPECT_EQ(server_->LinkFor(Role::kOperator), link);
  EXPECT_EQ(Get("/api/scene", {{"Cookie", cookie}}).status, 404) << "nothing is open, but let in";
  const std::string token = Json{{"token", TokenOf(Role::kOperator)}}.dump();
  EXPECT_EQ(Post("/api/session", token, {{"Cookie", cookie}}).status, 200);
  EXPECT_EQ(GiveToken(TokenOf(Role::kOperator)).status, 401) << "another browser";

  const auto other = serve(&bench);  // the port is taken
  ASSERT_TRUE(other->Start());
  EXPECT_FALSE(other->has_kept_links());
  EXPECT_NE(other->port(), server_->port());
  other->Stop();
  server_->Stop();
  server_.reset();
  bench.Stop();
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
