#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hvas::studio::testing {

/** What a server answered. Status 0: it closed the connection without a word. */
struct Reply {
  int status{0};
  std::map<std::string, std::string> headers;  ///< Names in small letters.
  std::string body;
};

/** A message of a WebSocket. */
struct Message {
  static constexpr int kText = 1;
  static constexpr int kBinary = 2;
  static constexpr int kClose = 8;
  int opcode{0};
  std::string bytes;
};

struct Request {
  std::string method{"GET"};
  std::string target{"/"};
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;  ///< With its Content-Length when it is not empty.
};

/** A connection that sends whatever it is told to, also what no browser would. Waits at most 20 s
 for an answer. */
class RawClient {
 public:
  /** @param receive_buffer  How much the system takes in before it is read [bytes]; 0: as usual. */
  explicit RawClient(std::uint16_t port, int receive_buffer = 0);
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  /** False when the server has closed the connection. */
  bool Send(std::string_view bytes);
  bool Send(const Request& request);

  Reply ReadReply();
  Reply Ask(const Request& request);

  /** Whether the server ends the connection, after whatever it still sends. */
  bool IsClosed();

  /** As a browser asks for it; then ReadReply tells whether it is granted. */
  bool SendUpgrade(std::vector<std::pair<std::string, std::string>> headers,
                   const std::string& target = "/ws");
  bool SendMessage(int opcode, std::string_view bytes);

  /** None when the connection has ended, or nothing came in time. */
  std::optional<Message> ReadMessage();

 private:
  bool Receive();
  bool Await(std::size_t size);

  int socket_{-1};
  std::string received_;
};

}  // namespace hvas::studio::testing
