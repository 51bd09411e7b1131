// For the sources of the server alone: Boost.Beast takes long to compile.
#pragma once

#include <memory>

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "studio/server_shared.h"

namespace hvas::studio {

/** Makes a client of a connection whose request asks for a WebSocket; it lives as long as the
 connection does. */
void StartSocketSession(Connection connection, std::shared_ptr<ServerShared> shared, Role role,
                        const http::request<http::empty_body>& request);

}  // namespace hvas::studio
