// For the sources of the server alone: Boost.Beast takes long to compile.
#pragma once

#include <memory>

#include "studio/server_shared.h"

namespace hvas::studio {

/** Answers the requests of a connection, one after the other, for as long as it is open. */
void StartHttpSession(tcp::socket socket, std::shared_ptr<ServerShared> shared);

}  // namespace hvas::studio
