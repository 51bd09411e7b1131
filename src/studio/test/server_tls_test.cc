// Encrypted, for headsets and other machines (N11).
#include <ctime>
#include <fstream>

#include "studio/test/server_fixture.h"

namespace hvas::studio {
namespace {

using testing::kMaxUpload;
using testing::RawClient;
using testing::Reply;
using testing::ServerTest;

/** Of a server that speaks TLS, by a certificate that was made for this machine's loopback. */
ServerOptions MakeTlsOptions() {
  static const hvas::testing::TemporaryFolder folder;  // one for all
  ServerOptions options;
  options.tls = EnsureCertificate(folder.path() / "tls", {"127.0.0.1"}, std::time(nullptr))->files;
  return options;
}

class TlsServerTest : public ServerTest {
 protected:
  TlsServerTest() : TlsServerTest(std::chrono::hours(1)) {}

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
  const Reply given = GiveToken(TokenOf(Role::kViewer));
  EXPECT_EQ(given.status, 200);
  EXPECT_NE(given.headers.at("set-cookie").find("; Secure"), std::string::npos);
  const auto client = JoinAndOpen();
  const std::string cookie = CookieOf(Role::kOperator);
  const Reply scene = Get("/api/scene", {{"Cookie", cookie}});
  ASSERT_EQ(scene.status, 200);
  const Reply model = Get(Json::parse(scene.body)["glb"], {{"Cookie", cookie}});
  EXPECT_EQ(model.body.substr(0, 4), "glTF");
  EXPECT_EQ(
      Post("/api/upload?name=a.stp", std::string(kMaxUpload, 'x'), {{"Cookie", cookie}}).status,
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
  ImpatientTlsServerTest() : TlsServerTest(std::chrono::milliseconds(1000)) {}
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
    EXPECT_NE(error.message.find("encrypted"), std::string::npos) << error.message;
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

}  // namespace
}  // namespace hvas::studio
