// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <poll.h>

#include "core/time.hpp"

namespace footlight::sim {

/// The place at which other programs find a simulated bus: hands on what they say to it, and what its nodes answer to
/// them. Never blocks; used by one thread.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  /// Of the transport that finds it: "serial:///tmp/footlight/left".
  [[nodiscard]] virtual std::string url() const = 0;
  /// Adds what to wait for.
  virtual void add_handles(std::vector<pollfd>& files) const = 0;
  /// Reads what has come, writes what has been answered. @return when to call again even if nothing arrives
  virtual Instant step(Instant now) = 0;
  /// True once anybody has said anything.
  [[nodiscard]] virtual bool used() const = 0;
};

}  // namespace footlight::sim
