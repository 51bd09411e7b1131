#pragma once

#include <memory>

#include <boost/asio/ssl/context.hpp>

#include "base/result.h"
#include "studio/server.h"

namespace hvas::studio {

/** Makes the context of a server for TLS 1.2 and above.
 Errors: kUnreadable when a file is not in PEM format or needs a password, or when the key does not
 belong to the certificate. */
[[nodiscard]] Result<std::unique_ptr<boost::asio::ssl::context>> MakeTls(const TlsFiles& files);

}  // namespace hvas::studio
