#include "studio/test/raw_client.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

namespace hvas::studio::testing {
namespace {

constexpr int kPatience = 20;  // [s]

std::string ToLower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::uint64_t BigEndian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char c : bytes) {
    value = value << 8U | static_cast<unsigned char>(c);
  }
  return value;
}

}  // namespace

RawClient::RawClient(std::uint16_t port, int receive_buffer)
    : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  const timeval patience{kPatience, 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
  if (receive_buffer > 0) {
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof(receive_buffer));
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    throw std::runtime_error("nobody listens");
  }
}

RawClient::~RawClient() {
  tls_.reset();
  ::close(socket_);
}

void RawClient::TlsEnd::operator()(ssl_st* tls) const {
  SSL_free(tls);
}

std::string RawClient::ShakeHands(const std::filesystem::path& trusted,
                                  const std::string& address) {
  SSL_CTX* context = SSL_CTX_new(TLS_client_method());
  SSL_CTX_load_verify_file(context, trusted.c_str());
  X509_VERIFY_PARAM_set1_ip_asc(SSL_CTX_get0_param(context), address.c_str());
  tls_.reset(SSL_new(context));
  SSL_CTX_free(context);  // tls_ keeps it
  SSL_set_fd(tls_.get(), socket_);
  if (SSL_connect(tls_.get()) != 1) {
    return "";
  }
  return X509_verify_cert_error_string(SSL_get_verify_result(tls_.get()));
}

std::string RawClient::PeerFingerprint() const {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  X509* certificate = SSL_get1_peer_certificate(tls_.get());
  X509_digest(certificate, EVP_sha256(), digest.data(), &size);
  X509_free(certificate);
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    text += i > 0 ? ":" : "";
    text += kDigits[digest[i] >> 4U];
    text += kDigits[digest[i] & 0xFU];
  }
  return text;
}

bool RawClient::Send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = tls_ != nullptr
                             ? SSL_write(tls_.get(), bytes.data(), static_cast<int>(bytes.size()))
                             : ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) {
      return false;
    }
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

bool RawClient::Send(const Request& request) {
  std::string text = request.method + " " + request.target + " HTTP/1.1\r\n";
  for (const auto& [name, value] : request.headers) {
    text.append(name).append(": ").append(value).append("\r\n");
  }
  if (!request.body.empty()) {
    text += "Content-Length: " + std::to_string(request.body.size()) + "\r\n";
  }
  return Send(text + "\r\n" + request.body);
}

std::int64_t RawClient::ReceiveSome(char* bytes, std::size_t size) {
  if (tls_ != nullptr) {
    return SSL_read(tls_.get(), bytes, static_cast<int>(size));
  }
  std::int64_t got = 0;
  do {  // The end of a child process interrupts it.
    got = ::recv(socket_, bytes, size, 0);
  } while (got < 0 && errno == EINTR);
  return got;
}

bool RawClient::Receive() {
  std::array<char, 65536> bytes{};
  const std::int64_t got = ReceiveSome(bytes.data(), bytes.size());
  if (got <= 0) {
    return false;
  }
  received_.append(bytes.data(), static_cast<std::size_t>(got));
  return true;
}

bool RawClient::Await(std::size_t size) {
  while (received_.size() < size) {
    if (!Receive()) {
      return false;
    }
  }
  return true;
}

Reply RawClient::ReadReply() {
  std::size_t end = 0;
  while ((end = received_.find("\r\n\r\n")) == std::string::npos) {
    if (!Receive()) {
      return {};
    }
  }
  Reply reply;
  constexpr std::size_t kBeforeStatus = 9;  // "HTTP/1.1 "
  reply.status = std::stoi(received_.substr(kBeforeStatus, 3));
  std::size_t at = received_.find("\r\n") + 2;
  while (at < end) {
    const std::size_t line_end = received_.find("\r\n", at);
    const std::size_t colon = received_.find(": ", at);
    reply.headers[ToLower(received_.substr(at, colon - at))] =
        received_.substr(colon + 2, line_end - colon - 2);
    at = line_end + 2;
  }
  received_.erase(0, end + 4);
  const auto length = reply.headers.find("content-length");
  if (length != reply.headers.end() && reply.status != 304) {
    const std::size_t size = std::stoul(length->second);
    Await(size);
    reply.body = received_.substr(0, size);
    received_.erase(0, size);
  }
  return reply;
}

Reply RawClient::Ask(const Request& request) {
  Send(request);
  return ReadReply();
}

bool RawClient::IsClosed() {
  std::array<char, 65536> bytes{};
  std::int64_t got = 0;
  do {
    errno = 0;
    got = ReceiveSome(bytes.data(), bytes.size());
  } while (got > 0);
  return got == 0 || (errno != EAGAIN && errno != EWOULDBLOCK);
}

bool RawClient::SendUpgrade(std::vector<std::pair<std::string, std::string>> headers,
                            const std::string& target) {
  headers.insert(headers.end(), {{"Connection", "Upgrade"},
                                 {"Upgrade", "websocket"},
                                 {"Sec-WebSocket-Version", "13"},
                                 {"Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="}});
  return Send({"GET", target, std::move(headers), ""});
}

bool RawClient::SendMessage(int opcode, std::string_view bytes) {
  constexpr std::size_t kShort = 126;
  constexpr std::size_t kMiddle = 1 << 16;
  std::string frame{static_cast<char>(0x80 | opcode)};
  const auto add_size = [&](int marker, int size_bytes) {
    frame += static_cast<char>(0x80 | marker);
    for (int i = size_bytes - 1; i >= 0; --i) {
      frame += static_cast<char>(bytes.size() >> (8 * i) & 0xFF);
    }
  };
  if (bytes.size() < kShort) {
    add_size(static_cast<int>(bytes.size()), 0);
  } else if (bytes.size() < kMiddle) {
    add_size(126, 2);
  } else {
    add_size(127, 8);
  }
  frame.append(4, '\0');  // a mask that changes nothing
  frame += bytes;
  return Send(frame);
}

std::optional<Message> RawClient::ReadMessage() {
  if (!Await(2)) {
    return std::nullopt;
  }
  Message message;
  message.opcode = received_[0] & 0x0F;
  std::uint64_t size = received_[1] & 0x7F;
  std::size_t start = 2;
  if (size >= 126) {
    const std::size_t size_bytes = size == 126 ? 2 : 8;
    if (!Await(start + size_bytes)) {
      return std::nullopt;
    }
    size = BigEndian(std::string_view(received_).substr(start, size_bytes));
    start += size_bytes;
  }
  if (!Await(start + size)) {
    return std::nullopt;
  }
  message.bytes = received_.substr(start, size);
  received_.erase(0, start + size);
  return message;
}

}  // namespace hvas::studio::testing
