#include "studio/socket_session.h"

#include <deque>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include "base/clock.h"

namespace hvas::studio {
namespace {

constexpr std::size_t kMaxMessage = 64 << 10;  // from the client [bytes]
constexpr std::size_t kMaxQueued = 16 << 20;   // text for a client that does not read [bytes]

/** Session of a WebSocket. Text is queued until sent; the hub's credits limit the queued frames. */
class SocketSession final : public ClientLink, public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(Connection connection, std::shared_ptr<ServerShared> shared, const Visitor& visitor)
      : address_(connection.address()),
        socket_(std::move(connection)),
        shared_(std::move(shared)),
        visitor_(visitor) {}

  ~SocketSession() override { Leave(); }

  void Run(const http::request<http::empty_body>& request) {
    cookie_ = std::string(request[http::field::cookie]);
    // A silent peer gets a ping after half of this time, and is disconnected at its end.
    const auto patience = shared_->options.patience;
    socket_.set_option(websocket::stream_base::timeout{patience, patience, true});
    socket_.read_message_max(kMaxMessage);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (!error) {
        self->Enter();
      }
    });
  }

  void SendText(std::string text) override {
    if (queued_ + text.size() > kMaxQueued) {
      Abort();
      return;
    }
    Push({std::move(text), true});
  }

  [[nodiscard]] bool is_admitted() const override {
    return shared_->access->FindVisitor(cookie_).has_value();
  }

  [[nodiscard]] std::string address() const override { return address_; }

  void SendFrames(std::string bytes) override { Push({std::move(bytes), false}); }

  void Close(const std::string& reason) override {
    if (std::exchange(is_closing_, true)) {
      return;
    }
    constexpr std::size_t kLongestReason = 120;  // [bytes]; RFC 6455 allows 123.
    const websocket::close_reason why(websocket::close_code::policy_error,
                                      reason.substr(0, kLongestReason));
    socket_.async_close(why, [self = shared_from_this()](error_code) {});
    PostLeave();
  }

 private:
  struct Message {
    std::string bytes;
    bool is_text;
  };

  void Enter() {
    auto joined = shared_->hub.Join(visitor_, this, MonotonicNs());
    if (!joined) {
      Close(joined.error().message);
      return;
    }
    id_ = std::move(*joined);
    Read();
  }

  /** Closes the connection of a client that does not read, without a closing handshake. */
  void Abort() {
    if (!std::exchange(is_closing_, true)) {
      beast::get_lowest_layer(socket_).close();
      PostLeave();
    }
  }

  /** Leaves in a later call, because the hub may be in the middle of a broadcast; but before the
   closing handshake, so that the lease is free at once. */
  void PostLeave() {
    asio::post(socket_.get_executor(), [self = shared_from_this()] { self->Leave(); });
  }

  void Leave() {
    if (!id_.empty()) {
      shared_->hub.Leave(std::exchange(id_, ""), MonotonicNs());
    }
  }

  void Read() {
    is_reading_ = true;
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      self->is_reading_ = false;
      if (error) {
        self->Leave();
        return;
      }
      std::string message = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      self->Receive({std::move(message), self->socket_.got_text()});
    });
  }

  /** Looks for what may not wait; all else is handled in a later call, so that the messages that
   have come from all clients are looked at before any of them is handled. */
  void Receive(Message message) {
    Hub& hub = shared_->hub;
    if (message.is_text && hub.TrySwitchForcesOff(id_, message.bytes, MonotonicNs())) {
      std::erase_if(received_, [&](const Message& one) {
        return one.is_text && hub.TryRefuseForcesOn(id_, one.bytes);
      });
    } else {
      received_.push_back(std::move(message));
      PostHandle();
    }
    ReadOn();
  }

  /** Reads on unless so many messages wait that the client has to. */
  void ReadOn() {
    constexpr std::size_t kMostReceived = 16;  // A megabyte: a choice.
    if (!is_closing_ && !is_reading_ && received_.size() < kMostReceived) {
      Read();
    }
  }

  void PostHandle() {
    asio::post(socket_.get_executor(), [self = shared_from_this()] { self->Handle(); });
  }

  void Handle() {
    if (received_.empty() || is_closing_) {
      return;
    }
    const Message message = std::move(received_.front());
    received_.pop_front();
    if (message.is_text) {
      shared_->hub.OnText(id_, message.bytes, MonotonicNs());
    } else {
      shared_->hub.OnBinary(id_, message.bytes);
    }
    ReadOn();
  }

  void Push(Message message) {
    if (is_closing_) {
      return;
    }
    queued_ += message.bytes.size();
    queue_.push_back(std::move(message));
    if (queue_.size() == 1) {
      Write();
    }
  }

  void Write() {
    const Message& message = queue_.front();
    socket_.text(message.is_text);
    socket_.async_write(asio::buffer(message.bytes),
                        [self = shared_from_this()](error_code error, std::size_t) {
                          if (error) {
                            self->Leave();
                            self->queue_.clear();
                            return;
                          }
                          self->queued_ -= self->queue_.front().bytes.size();
                          self->queue_.pop_front();
                          if (!self->queue_.empty()) {
                            self->Write();
                          }
                        });
  }

  const std::string address_;
  websocket::stream<Connection, /*deflateSupported=*/false> socket_;
  std::shared_ptr<ServerShared> shared_;
  const Visitor visitor_;
  std::string cookie_;  ///< Cookie header of the browser.
  std::string id_;
  beast::flat_buffer buffer_;
  std::deque<Message> queue_;     ///< To be sent.
  std::deque<Message> received_;  ///< To be handled.
  bool is_reading_{false};
  std::size_t queued_{0};
  bool is_closing_{false};
};

}  // namespace

void StartSocketSession(Connection connection, std::shared_ptr<ServerShared> shared,
                        const Visitor& visitor, const http::request<http::empty_body>& request) {
  std::make_shared<SocketSession>(std::move(connection), std::move(shared), visitor)->Run(request);
}

}  // namespace hvas::studio
