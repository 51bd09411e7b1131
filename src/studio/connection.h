// Included by the sources of the server only: Boost.Beast takes long to compile.
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

/** Limits the number of open connections. A connection without a valid session cookie keeps nobody
 out: when the table is full, the oldest of those is closed in favour of a new one. For one
 thread. */
class Guests {
 public:
  static constexpr std::size_t kMost = 64;

  /** @returns the connection's number; 0 when the table is full of authenticated connections. */
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
        it->second.stream->close();  // pending operations fail, which ends their session
        guests_.erase(it);
        return true;
      }
    }
    return false;
  }

  std::map<std::uint64_t, Guest> guests_;  ///< Key: number, hence in the order of arrival.
  std::uint64_t last_{0};
};

/** An Asio stream to one client, with or without TLS. It is one type for both, so that the layers
 above are compiled once. */
class Connection {
 public:
  using next_layer_type = boost::beast::tcp_stream;
  using executor_type = next_layer_type::executor_type;
  using Tls = boost::beast::ssl_stream<next_layer_type&>;

  Connection(boost::asio::ip::tcp::socket socket, std::shared_ptr<Guests> guests)
      : seat_(std::make_unique<Seat>(std::move(socket), std::move(guests))) {}

  /** Whether the connection table has accepted it. */
  [[nodiscard]] bool is_in() const { return seat_->number != 0; }

  /** Marks the client as authenticated: it has sent a valid session cookie. */
  void SetKnown() { seat_->guests->Know(seat_->number); }

  [[nodiscard]] bool is_tls() const { return tls_ != nullptr; }

  /** Begins TLS; all later reads and writes are encrypted. */
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
  std::unique_ptr<Tls> tls_;  ///< TLS layer over the seat's stream; null: plain TCP.
};

/** Closes the transport below a WebSocket; Boost.Beast finds it by argument-dependent lookup. */
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
