// For the sources of the server alone: Boost.Beast takes long to compile.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/teardown.hpp>

namespace hvas::studio {

/** Who is in: so many connections, and no more. Whoever holds one open without having shown a
 cookie keeps nobody out: the one of them that came first goes when another one comes. One thread's.
 */
class Guests {
 public:
  static constexpr std::size_t kMost = 64;  ///< Addresses that are remembered: a choice.

  /** @returns its number; 0 when all that are here are known, and there is no room. */
  std::uint64_t Add(boost::beast::tcp_stream* stream) {
    if (guests_.size() >= kMost && !MakeRoom()) {
      return 0;
    }
    guests_[++last_] = {stream, false};
    return last_;
  }

  void Know(std::uint64_t number) {
    if (const auto found = guests_.find(number); found != guests_.end()) {
      found->second.is_known = true;
    }
  }

  void Remove(std::uint64_t number) { guests_.erase(number); }

 private:
  struct Guest {
    boost::beast::tcp_stream* stream{nullptr};
    bool is_known{false};
  };

  bool MakeRoom() {
    for (auto it = guests_.begin(); it != guests_.end(); ++it) {
      if (!it->second.is_known) {
        it->second.stream->close();  // whoever waits for it is told, and lets it go
        guests_.erase(it);
        return true;
      }
    }
    return false;
  }

  std::map<std::uint64_t, Guest> guests_;  ///< In the order in which they came.
  std::uint64_t last_{0};
};

/** A stream of Asio's to one client, with TLS or without: one type for both, so that all above it
 is compiled once. */
class Connection {
 public:
  using next_layer_type = boost::beast::tcp_stream;
  using executor_type = next_layer_type::executor_type;
  using Tls = boost::beast::ssl_stream<next_layer_type&>;

  Connection(boost::asio::ip::tcp::socket socket, std::shared_ptr<Guests> guests)
      : seat_(std::make_unique<Seat>(std::move(socket), std::move(guests))) {}

  /** False: there is no room for it. */
  [[nodiscard]] bool is_in() const { return seat_->number != 0; }

  /** Whoever it is has shown a cookie of this server's. */
  void SetKnown() { seat_->guests->Know(seat_->number); }

  [[nodiscard]] bool is_tls() const { return tls_ != nullptr; }

  /** From here on all is encrypted. */
  Tls& BeginTls(boost::asio::ssl::context* context) {
    tls_ = std::make_unique<Tls>(seat_->stream, *context);
    return *tls_;
  }

  [[nodiscard]] Tls& tls() { return *tls_; }

  executor_type get_executor() noexcept { return seat_->stream.get_executor(); }

  next_layer_type& next_layer() noexcept { return seat_->stream; }

  const next_layer_type& next_layer() const noexcept { return seat_->stream; }

  template <typename Buffers, typename Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    if (tls_ != nullptr) {
      tls_->async_read_some(buffers, std::forward<Handler>(handler));
    } else {
      seat_->stream.async_read_some(buffers, std::forward<Handler>(handler));
    }
  }

  template <typename Buffers, typename Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    if (tls_ != nullptr) {
      tls_->async_write_some(buffers, std::forward<Handler>(handler));
    } else {
      seat_->stream.async_write_some(buffers, std::forward<Handler>(handler));
    }
  }

 private:
  struct Seat {
    Seat(boost::asio::ip::tcp::socket socket, std::shared_ptr<Guests> given)
        : stream(std::move(socket)), guests(std::move(given)), number(guests->Add(&stream)) {}

    ~Seat() { guests->Remove(number); }

    Seat(const Seat&) = delete;
    Seat& operator=(const Seat&) = delete;

    boost::beast::tcp_stream stream;
    std::shared_ptr<Guests> guests;
    std::uint64_t number;
  };

  std::unique_ptr<Seat> seat_;
  std::unique_ptr<Tls> tls_;  ///< Over the seat's stream; null: nothing is encrypted.
};

/** Found by boost::beast::websocket where a WebSocket over a Connection has ended. */
template <typename Handler>
void async_teardown(boost::beast::role_type role, Connection& connection, Handler&& handler) {
  using boost::beast::websocket::async_teardown;
  if (connection.is_tls()) {
    connection.tls().async_shutdown(std::forward<Handler>(handler));
  } else {
    async_teardown(role, connection.next_layer(), std::forward<Handler>(handler));
  }
}

}  // namespace hvas::studio
