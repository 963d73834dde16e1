#pragma once

#include <string>

#include "http_server.hpp"

namespace slideway {

/// The page itself, whose Content-Security-Policy allows no script and no style but its own.
HttpReply start_page();

}  // namespace slideway
