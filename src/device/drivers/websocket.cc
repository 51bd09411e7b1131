// The only file that knows Boost.Beast: it takes its time to compile.
#include "device/drivers/websocket.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <utility>
#include <vector>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>

namespace hvas::device {
namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;
using Tcp = asio::ip::tcp;

using Socket = websocket::stream<Tcp::socket, /*deflateSupported=*/false>;

constexpr std::size_t kMaxMessage = 1 << 20;  // [bytes], far above any message: a choice.

/** A connection whose handshake has been made: reads all the time, writes one message at a time.
 Lives as long as an operation of it is under way. */
class Stream : public std::enable_shared_from_this<Stream> {
 public:
  explicit Stream(Tcp::socket socket) : websocket_(std::move(socket)) {
    websocket_.text(true);
    websocket_.read_message_max(kMaxMessage);
  }

  [[nodiscard]] Socket& websocket() { return websocket_; }

  void Start() {
    is_open_ = true;
    websocket_.next_layer().set_option(Tcp::no_delay(true));
    ReadNext();
  }

  void Send(std::string text) {
    outgoing_.push_back(std::move(text));
    if (is_open_ && outgoing_.size() == 1) {
      WriteNext();
    }
  }

  std::optional<std::string> Take() {
    if (incoming_.empty()) {
      return std::nullopt;
    }
    std::string text = std::move(incoming_.front());
    incoming_.pop_front();
    return text;
  }

  [[nodiscard]] bool has_message() const { return !incoming_.empty(); }

  [[nodiscard]] bool is_open() const { return is_open_; }

  void Close() {
    is_open_ = false;
    error_code ignored;
    websocket_.next_layer().close(ignored);
  }

 private:
  void ReadNext() {
    websocket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) {
        self->Close();
        return;
      }
      self->incoming_.push_back(boost::beast::buffers_to_string(self->buffer_.data()));
      self->buffer_.consume(self->buffer_.size());
      self->ReadNext();
    });
  }

  void WriteNext() {
    websocket_.async_write(asio::buffer(outgoing_.front()),
                           [self = shared_from_this()](error_code error, std::size_t) {
                             if (error) {
                               self->Close();
                               return;
                             }
                             self->outgoing_.pop_front();
                             if (!self->outgoing_.empty()) {
                               self->WriteNext();
                             }
                           });
  }

  Socket websocket_;
  boost::beast::flat_buffer buffer_;
  std::deque<std::string> incoming_;
  std::deque<std::string> outgoing_;  // the first is on its way
  bool is_open_{false};
};

class Client final : public WebSocket {
 public:
  Client() = default;

  ~Client() override {
    if (stream_ != nullptr) {
      stream_->Close();
      context_.restart();
      context_.poll();
    }
  }

  Result<void> Connect(const std::string& host, std::uint16_t port, int timeout_ms) {
    const std::string where = fmt::format("ws://{}:{}", host, port);
    error_code error;
    Tcp::resolver resolver(context_);
    const auto places = resolver.resolve(host, std::to_string(port), error);
    if (error) {
      return Fail(ErrorCode::kNotFound, fmt::format("there is no host \"{}\"", host), where,
                  "give localhost, or a numeric address");
    }
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(timeout_ms);
    stream_ = std::make_shared<Stream>(Tcp::socket(context_));
    std::optional<error_code> outcome;
    asio::async_connect(
        stream_->websocket().next_layer(), places,
        [&outcome](error_code failure, const Tcp::endpoint&) { outcome = failure; });
    RunUntil(end, [&] { return outcome.has_value(); });
    if (!outcome || *outcome) {
      Abandon(&outcome);
      return Fail(ErrorCode::kNotFound,
                  fmt::format("no program listens on this address: {}", outcome->message()), where);
    }
    outcome.reset();
    stream_->websocket().async_handshake(fmt::format("{}:{}", host, port), "/",
                                         [&outcome](error_code failure) { outcome = failure; });
    RunUntil(end, [&] { return outcome.has_value(); });
    if (!outcome || *outcome) {
      Abandon(&outcome);
      return Fail(ErrorCode::kUnreadable,
                  fmt::format("the program on this address is not a WebSocket server: {}",
                              outcome->message()),
                  where);
    }
    stream_->Start();
    return {};
  }

  void Send(std::string text) override {
    stream_->Send(std::move(text));
    Poll();
  }

  std::optional<std::string> Receive(std::int64_t timeout_ns) override {
    Poll();
    if (timeout_ns > 0) {
      RunUntil(std::chrono::steady_clock::now() + std::chrono::nanoseconds(timeout_ns),
               [this] { return stream_->has_message() || !stream_->is_open(); });
    }
    return stream_->Take();
  }

  [[nodiscard]] bool is_open() const override { return stream_->is_open(); }

 private:
  void Poll() {
    context_.restart();
    context_.poll();
  }

  template <typename Predicate>
  void RunUntil(std::chrono::steady_clock::time_point end, Predicate is_done) {
    while (!is_done() && std::chrono::steady_clock::now() < end) {
      context_.restart();
      context_.run_one_until(end);
    }
  }

  /** Ends an operation that takes too long, so that it lets go of what it was given. */
  void Abandon(std::optional<error_code>* outcome) {
    stream_->Close();
    Poll();
    if (!*outcome || !**outcome) {
      *outcome = make_error_code(boost::system::errc::timed_out);
    }
  }

  asio::io_context context_;
  std::shared_ptr<Stream> stream_;
};

class Server final : public WebSocketServer {
 public:
  Server() : acceptor_(context_) {}

  Result<void> Listen(std::uint16_t port) {
    const Tcp::endpoint place(asio::ip::address_v4::loopback(), port);
    error_code error;
    acceptor_.open(place.protocol(), error);
    acceptor_.set_option(asio::socket_base::reuse_address(true), error);
    acceptor_.bind(place, error);
    if (!error) {
      acceptor_.listen(asio::socket_base::max_listen_connections, error);
    }
    if (error) {
      return Fail(ErrorCode::kOutOfResource, error.message(), fmt::format("TCP port {}", port),
                  "give another port");
    }
    AcceptNext();
    return {};
  }

  [[nodiscard]] std::uint16_t port() const override { return acceptor_.local_endpoint().port(); }

  void Serve(const std::function<std::string()>& greet,
             const std::function<std::optional<std::string>(const std::string&)>& answer) override {
    Poll();
    for (const auto& stream : std::exchange(fresh_, {})) {
      stream->Send(greet());
      streams_.push_back(stream);
    }
    for (const auto& stream : streams_) {
      while (const auto text = stream->Take()) {
        if (auto reply = answer(*text)) {
          stream->Send(std::move(*reply));
        }
      }
    }
    Poll();
    std::erase_if(streams_, [](const auto& stream) { return !stream->is_open(); });
  }

  void Drop() override {
    for (const auto& stream : streams_) {
      stream->Close();
    }
    streams_.clear();
    Poll();
  }

 private:
  void Poll() {
    context_.restart();
    context_.poll();
  }

  void AcceptNext() {
    acceptor_.async_accept([this](error_code error, Tcp::socket socket) {
      if (error) {
        return;
      }
      auto stream = std::make_shared<Stream>(std::move(socket));
      stream->websocket().async_accept([this, stream](error_code failure) {
        if (!failure) {
          stream->Start();
          fresh_.push_back(stream);
        }
      });
      AcceptNext();
    });
  }

  asio::io_context context_;
  Tcp::acceptor acceptor_;
  std::vector<std::shared_ptr<Stream>> fresh_;  // not greeted yet
  std::vector<std::shared_ptr<Stream>> streams_;
};

}  // namespace

Result<std::unique_ptr<WebSocket>> WebSocket::Connect(const std::string& host, std::uint16_t port,
                                                      int timeout_ms) {
  auto client = std::make_unique<Client>();
  if (const auto connected = client->Connect(host, port, timeout_ms); !connected) {
    return Unexpected(connected.error());
  }
  return client;
}

Result<std::unique_ptr<WebSocketServer>> WebSocketServer::Listen(std::uint16_t port) {
  auto server = std::make_unique<Server>();
  if (const auto listening = server->Listen(port); !listening) {
    return Unexpected(listening.error());
  }
  return server;
}

}  // namespace hvas::device
