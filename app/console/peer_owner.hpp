// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <sys/types.h>

namespace footlight::app {

/// Who owns the other end of a TCP connection within this machine, as the kernel knows it (sock_diag(7), one look-up by
/// both addresses). Nothing where it does not say: the other end is elsewhere or gone, or the system has no such
/// interface.
[[nodiscard]] std::optional<uid_t> owner_of_peer(int socket);

}  // namespace footlight::app
