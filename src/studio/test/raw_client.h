#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

struct ssl_st;

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

  /** Speaks TLS from here on. @returns what is wrong with the server's certificate, when only those
   of a PEM file are trusted and the server should be at an address; "ok" when nothing is, "" when
   there was no handshake. */
  std::string ShakeHands(const std::filesystem::path& trusted, const std::string& address);

  /** SHA-256 of the certificate that the server has shown: "0A:1B:..". */
  [[nodiscard]] std::string PeerFingerprint() const;

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
  struct TlsEnd {
    void operator()(ssl_st* tls) const;
  };

  bool Receive();
  std::int64_t ReceiveSome(char* bytes, std::size_t size);
  bool Await(std::size_t size);

  int socket_{-1};
  std::unique_ptr<ssl_st, TlsEnd> tls_;  ///< Null: not encrypted.
  std::string received_;
};

}  // namespace hvas::studio::testing
