#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/test/await_true.h"
#include "base/test/temporary_folder.h"
#include "studio/server.h"
#include "studio/session_pace.h"
#include "studio/test/raw_client.h"
#include "studio/test/small_bench.h"

namespace hvas::studio::testing {

using Headers = std::vector<std::pair<std::string, std::string>>;

inline constexpr std::uint64_t kMaxUpload = 10'000;  // [bytes]

/** A server on a free port, with nothing open. */
class ServerTest : public ::testing::Test {
 protected:
  ServerTest() : ServerTest(MakePatient()) {}

  /** A server that waits for its clients as long as no test does. */
  static ServerOptions MakePatient() {
    ServerOptions options;
    options.patience = std::chrono::hours(1);
    return options;
  }

  explicit ServerTest(ServerOptions options) : is_tls_(options.tls.has_value()) {
    options.upload_folder = folder_;
    options.max_upload = kMaxUpload;
    bench_ = std::make_unique<Workbench>(testing::SmallBench(&clock_));
    driver_ = std::make_unique<ClockDriver>(&clock_, SessionPace(&bench_->live()));
    server_ = std::make_unique<Server>(
        bench_.get(), std::vector<Example>{{"peg", "Peg", "a peg", "peg.step"}}, options);
    started_ = server_->Start().has_value();
    if (is_tls_) {
      trusted_ = options.tls->certificate;
    }
  }

  void SetUp() override { ASSERT_TRUE(started_); }

  void TearDown() override { End(); }

  void End() {
    if (server_ != nullptr) {
      bench_->Stop();
      server_->Stop();
      server_.reset();
      driver_.reset();
    }
  }

  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(server_->port()); }

  [[nodiscard]] std::string origin() const { return (is_tls_ ? "https://" : "http://") + host(); }

  /** Connects as a browser does, with TLS where the server has it. */
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

  /** The Cookie header of a browser that was admitted by the link of a role. */
  std::string CookieOf(Role role) {
    std::string& cookie = cookies_[role];
    if (cookie.empty()) {
      const std::string given = GiveToken(TokenOf(role)).headers["set-cookie"];
      cookie = given.substr(0, given.find(';'));
    }
    return cookie;
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

  /** Waits for the next text message that fits; null when none came. */
  static Json Await(RawClient* client, const std::function<bool(const Json&)>& fits) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(2);  // no claim
    while (std::chrono::steady_clock::now() < until) {  // statuses come for ever
      const auto message = client->ReadMessage();
      if (!message) {
        break;
      }
      if (message->opcode == Message::kPing) {  // Who does not answer is disconnected.
        client->SendMessage(Message::kPong, message->bytes);
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

  /** Joins as an operator and opens the small product. */
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

  /** Waits until the upload folder is empty: uploads are removed after the response. */
  [[nodiscard]] bool BecomesEmpty() const {
    return hvas::testing::AwaitTrue([this] { return CountFiles() == 0; });
  }

  hvas::testing::TemporaryFolder temporary_;
  const std::filesystem::path folder_{temporary_.path()};
  const bool is_tls_;
  std::filesystem::path trusted_;
  SteeredClock clock_;
  std::unique_ptr<Workbench> bench_;
  std::unique_ptr<ClockDriver> driver_;
  std::unique_ptr<Server> server_;
  std::map<Role, std::string> cookies_;
  bool started_{false};
};

}  // namespace hvas::studio::testing
