#include "studio/tls.h"

#include <string>

namespace hvas::studio {

namespace asio = boost::asio;

Result<std::unique_ptr<asio::ssl::context>> MakeTls(const TlsFiles& files) {
  auto tls = std::make_unique<asio::ssl::context>(asio::ssl::context::tls_server);
  SSL_CTX_set_min_proto_version(tls->native_handle(), TLS1_2_VERSION);
  boost::system::error_code error;
  tls->set_password_callback([](std::size_t, asio::ssl::context::password_purpose) { return ""; },
                             error);
  tls->use_certificate_chain_file(files.certificate.string(), error);
  if (error) {
    return Fail(ErrorCode::kUnreadable, "the certificate is unusable: " + error.message(),
                files.certificate.string(),
                "give --certificate a PEM file that begins with the server's own certificate");
  }
  tls->use_private_key_file(files.key.string(), asio::ssl::context::pem, error);
  if (error) {
    return Fail(ErrorCode::kUnreadable, "the key is unusable: " + error.message(),
                files.key.string(),
                "give --key the private key of the certificate, in PEM format without a password");
  }
  return tls;
}

}  // namespace hvas::studio
