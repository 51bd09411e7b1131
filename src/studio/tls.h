#pragma once

#include <memory>

#include <boost/asio/ssl/context.hpp>

#include "base/result.h"
#include "studio/server.h"

namespace hvas::studio {

/** TLS 1.2 and above with a certificate of one's own.
 Errors (kUnreadable): a file is no PEM, is locked by a password, or the two do not belong together.
 */
[[nodiscard]] Result<std::unique_ptr<boost::asio::ssl::context>> MakeTls(const TlsFiles& files);

}  // namespace hvas::studio
