#include "studio/connection.h"

namespace hvas::studio {

std::string Connection::AddressOf(const boost::asio::ip::tcp::socket& socket) {
  boost::system::error_code failed;
  const auto end = socket.remote_endpoint(failed);
  return failed ? std::string() : end.address().to_string();
}

void Connection::Read(const BufferList<boost::asio::mutable_buffer>& buffers, Done done) {
  if (tls_ != nullptr) {
    tls_->async_read_some(buffers, std::move(done));
  } else {
    slot_->stream.async_read_some(buffers, std::move(done));
  }
}

void Connection::Write(const BufferList<boost::asio::const_buffer>& buffers, Done done) {
  if (tls_ != nullptr) {
    tls_->async_write_some(buffers, std::move(done));
  } else {
    slot_->stream.async_write_some(buffers, std::move(done));
  }
}

}  // namespace hvas::studio
