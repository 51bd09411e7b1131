// For the sources of the server alone: Boost.Beast takes long to compile.
#pragma once

#include <memory>

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "studio/server_shared.h"

namespace hvas::studio {

/** Upgrades a connection to a WebSocket and joins it to the hub as a client, which lives as long as
 the connection. */
void StartSocketSession(Connection connection, std::shared_ptr<ServerShared> shared,
                        const Visitor& visitor, const http::request<http::empty_body>& request);

}  // namespace hvas::studio
