#include "studio/socket_session.h"

#include <deque>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include "base/clock.h"

namespace hvas::studio {
namespace {

constexpr std::size_t kMostMessage = 64 << 10;  // to the server
constexpr std::size_t kMostQueued = 16 << 20;   // of text to a client that does not read

/** Text is kept until it is sent; frames are few, by the hub's credit. */
class SocketSession final : public ClientLink, public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(Connection connection, std::shared_ptr<ServerShared> shared, Role role)
      : socket_(std::move(connection)), shared_(std::move(shared)), role_(role) {}

  ~SocketSession() override { Leave(); }

  void Run(const http::request<http::empty_body>& request) {
    // Whoever has gone without a word, or sleeps, is asked after half the time, and let go of.
    const auto patience = shared_->options.patience;
    socket_.set_option(websocket::stream_base::timeout{patience, patience, true});
    socket_.read_message_max(kMostMessage);
    socket_.auto_fragment(false);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (!error) {
        self->Enter();
      }
    });
  }

  void SendText(std::string text) override {
    if (queued_ + text.size() > kMostQueued) {
      CutOff();
      return;
    }
    Push({std::move(text), true});
  }

  void SendFrames(std::string bytes) override { Push({std::move(bytes), false}); }

  void Close(const std::string& reason) override {
    if (std::exchange(is_closing_, true)) {
      return;
    }
    constexpr std::size_t kLongestReason = 120;  // [bytes]; RFC 6455 allows 123.
    const websocket::close_reason why(websocket::close_code::policy_error,
                                      reason.substr(0, kLongestReason));
    socket_.async_close(why, [self = shared_from_this()](error_code) {});
    LeaveSoon();
  }

 private:
  struct Message {
    std::string bytes;
    bool is_text;
  };

  void Enter() {
    auto joined = shared_->hub.Join(role_, this);
    if (!joined) {
      Close(joined.error().message);
      return;
    }
    id_ = std::move(*joined);
    Read();
  }

  /** Of a client that reads nothing, not even why it has to go. */
  void CutOff() {
    if (!std::exchange(is_closing_, true)) {
      beast::get_lowest_layer(socket_).close();
      LeaveSoon();
    }
  }

  /** Not at once: the hub may be just telling everybody something. Whoever has to go does not keep
   its lease until it has answered. */
  void LeaveSoon() {
    asio::post(socket_.get_executor(), [self = shared_from_this()] { self->Leave(); });
  }

  void Leave() {
    if (!id_.empty()) {
      shared_->hub.Leave(std::exchange(id_, ""));
    }
  }

  void Read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) {
        self->Leave();
        return;
      }
      const std::string message = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      if (self->socket_.got_text()) {
        self->shared_->hub.OnText(self->id_, message, MonotonicNs());
      } else {
        self->shared_->hub.OnBinary(self->id_, message);
      }
      if (!self->is_closing_) {
        self->Read();
      }
    });
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

  websocket::stream<Connection> socket_;
  std::shared_ptr<ServerShared> shared_;
  Role role_;
  std::string id_;
  beast::flat_buffer buffer_;
  std::deque<Message> queue_;
  std::size_t queued_{0};
  bool is_closing_{false};
};

}  // namespace

void StartSocketSession(Connection connection, std::shared_ptr<ServerShared> shared, Role role,
                        const http::request<http::empty_body>& request) {
  std::make_shared<SocketSession>(std::move(connection), std::move(shared), role)->Run(request);
}

}  // namespace hvas::studio
