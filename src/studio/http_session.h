// Included by the sources of the server only: Boost.Beast takes long to compile.
#pragma once

#include <memory>

#include "studio/server_shared.h"

namespace hvas::studio {

/** Serves the HTTP requests of a connection, one after the other, until it closes. */
void StartHttpSession(tcp::socket socket, std::shared_ptr<ServerShared> shared);

}  // namespace hvas::studio
