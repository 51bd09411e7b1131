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

/** A server's response. Status 0: it closed the connection without one. */
struct Reply {
  int status{0};
  std::map<std::string, std::string> headers;  ///< Names in small letters.
  std::string body;
};

/** A WebSocket message. */
struct Message {
  static constexpr int kText = 1;
  static constexpr int kBinary = 2;
  static constexpr int kClose = 8;
  static constexpr int kPing = 9;
  static constexpr int kPong = 10;
  int opcode{0};
  std::string bytes;
};

struct Request {
  std::string method{"GET"};
  std::string target{"/"};
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;  ///< Sent with its Content-Length when it is not empty.
};

/** An HTTP and WebSocket client that sends any bytes, also those that no browser would send. It
 waits at most 20 s for a response. */
class RawClient {
 public:
  /** @param receive_buffer  Size of the socket's receive buffer [bytes]; 0: the system's
   default. */
  explicit RawClient(std::uint16_t port, int receive_buffer = 0);
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  /** Begins TLS, trusting only the certificates of a PEM file.
   @param address  Address that the server's certificate has to name.
   @returns OpenSSL's verdict on the certificate: "ok", or what is wrong with it; "" when the
   handshake failed. */
  std::string ShakeHands(const std::filesystem::path& trusted, const std::string& address);

  /** SHA-256 fingerprint of the server's certificate: "0A:1B:..". */
  [[nodiscard]] std::string PeerFingerprint() const;

  /** Sends bytes or a request. @returns false when the server has closed the connection. */
  bool Send(std::string_view bytes);
  bool Send(const Request& request);

  Reply ReadReply();
  Reply Ask(const Request& request);

  /** Waits for the server to close the connection, discarding what it still sends. */
  bool IsClosed();

  /** Asks for a WebSocket as a browser does; ReadReply() then has the response. */
  bool SendUpgrade(std::vector<std::pair<std::string, std::string>> headers,
                   const std::string& target = "/ws");
  bool SendMessage(int opcode, std::string_view bytes);

  /** Reads a message; none when the connection has ended or nothing came in time. */
  std::optional<Message> ReadMessage();

 private:
  struct TlsEnd {
    void operator()(ssl_st* tls) const;
  };

  bool Receive();
  std::int64_t ReceiveSome(char* bytes, std::size_t size);
  bool Await(std::size_t size);

  int socket_{-1};
  std::unique_ptr<ssl_st, TlsEnd> tls_;  ///< Null: plain TCP.
  std::string received_;
};

}  // namespace hvas::studio::testing
