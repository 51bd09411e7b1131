// Included by the sources of the server only: Boost.Beast takes long to compile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/teardown.hpp>

#include "studio/connection_table.h"

namespace hvas::studio {

/** An Asio stream to one client, with or without TLS. It is one type for both, so that the layers
 above are compiled once. */
class Connection {
 public:
  using next_layer_type = boost::beast::tcp_stream;
  using executor_type = next_layer_type::executor_type;
  using Tls = boost::beast::ssl_stream<next_layer_type&>;

  Connection(boost::asio::ip::tcp::socket socket, std::shared_ptr<ConnectionTable> table)
      : slot_(std::make_unique<Slot>(std::move(socket), std::move(table))) {}

  /** Takes a place of its visitor's (ConnectionTable::Enter). */
  [[nodiscard]] bool Enter(const Visitor& visitor) {
    return slot_->table->Enter(slot_->number, visitor);
  }

  void SetIdle(bool is_idle) { slot_->table->SetIdle(slot_->number, is_idle); }

  /** IP address of the client. */
  [[nodiscard]] const std::string& address() const { return slot_->address; }

  [[nodiscard]] bool is_tls() const { return tls_ != nullptr; }

  /** Begins TLS; all later reads and writes are encrypted. */
  Tls& BeginTls(boost::asio::ssl::context* context) {
    tls_ = std::make_unique<Tls>(slot_->stream, *context);
    return *tls_;
  }

  [[nodiscard]] Tls& tls() { return *tls_; }

  executor_type get_executor() noexcept { return slot_->stream.get_executor(); }

  next_layer_type& next_layer() noexcept { return slot_->stream; }

  const next_layer_type& next_layer() const noexcept { return slot_->stream; }

  template <typename Buffers, typename Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    Read(BufferList<boost::asio::mutable_buffer>(buffers), Erase(std::forward<Handler>(handler)));
  }

  template <typename Buffers, typename Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    Write(BufferList<boost::asio::const_buffer>(buffers), Erase(std::forward<Handler>(handler)));
  }

 private:
  struct Slot {
    Slot(boost::asio::ip::tcp::socket socket, std::shared_ptr<ConnectionTable> given)
        : stream(std::move(socket)),
          table(std::move(given)),
          address(AddressOf(stream.socket())),
          number(table->Add(address, [this] { stream.close(); })) {}

    ~Slot() { table->Remove(number); }

    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;

    boost::beast::tcp_stream stream;
    std::shared_ptr<ConnectionTable> table;
    std::string address;
    std::uint64_t number;
  };

  static std::string AddressOf(const boost::asio::ip::tcp::socket& socket);

  using Done = std::function<void(boost::beast::error_code, std::size_t)>;

  /** The first buffers of a sequence: an operation may transfer less than it is asked to. */
  template <typename Buffer>
  class BufferList {
   public:
    using value_type = Buffer;

    template <typename Buffers>
    explicit BufferList(const Buffers& buffers) {
      const auto end = boost::asio::buffer_sequence_end(buffers);
      for (auto it = boost::asio::buffer_sequence_begin(buffers);
           it != end && count_ < items_.size(); ++it) {
        items_[count_++] = *it;
      }
    }

    [[nodiscard]] const Buffer* begin() const { return items_.data(); }

    [[nodiscard]] const Buffer* end() const { return items_.data() + count_; }

   private:
    std::array<Buffer, 8> items_{};  // a message has a header and few pieces of a body
    std::size_t count_{0};
  };

  /** One type for the handlers of all operations, so that those of the transport are compiled once.
   It is called once, and what it holds is released before. */
  template <typename Handler>
  static Done Erase(Handler&& handler) {
    using Held = std::decay_t<Handler>;
    return [held = std::make_shared<std::optional<Held>>(std::forward<Handler>(handler))](
               boost::beast::error_code error, std::size_t bytes) {
      Held called = std::move(**held);
      held->reset();
      called(error, bytes);
    };
  }

  void Read(const BufferList<boost::asio::mutable_buffer>& buffers, Done done);
  void Write(const BufferList<boost::asio::const_buffer>& buffers, Done done);

  std::unique_ptr<Slot> slot_;
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
