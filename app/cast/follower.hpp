// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "app/cast/desk_word.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// Where a desk is: "http://127.0.0.1:8440".
struct DeskPlace {
  std::string host;  ///< a name or a numeric address
  std::string port = "80";
  [[nodiscard]] std::string authority() const;
};
/// Errors (ErrorKind::input)
[[nodiscard]] Result<DeskPlace> desk_place_from(const std::string& url);

/// Listens to a desk's console and comes back by itself when it is lost. What it sends is in its .cpp as it stands: a
/// hello that asks to view and nothing more, and GETs of documents; there is no other way through it.
class Follower {
 public:
  /// Called by the follower's thread.
  struct Listener {
    /// A plan is played: GET /api/plan.bin, and the hash of the show that it was made of.
    std::function<void(const std::string& plan_bin, const std::string& show_hash)> plan;
    std::function<void(const DeskWord&, Instant came)> word;
    /// A reset move: GET /api/way.bin; nothing: there is none any more.
    std::function<void(const std::optional<std::string>& way_bin, const DeskWord&)> way;
    /// It is not heard any more, and why; called once until it is heard again.
    std::function<void(const std::string& why)> lost;
  };
  struct Settings {
    DeskPlace desk;
    std::string token;                                 ///< empty: none is needed
    std::size_t most_bytes = std::size_t{256} << 20U;  ///< of a document
    Duration silence = milliseconds(2500);             ///< the desk speaks once a second at least
    Duration longest_wait = milliseconds(4000);        ///< between two attempts
  };

  /// Begins at once. Borrows the clock.
  Follower(Settings settings, Listener listener, const Clock& clock);
  ~Follower();
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

 private:
  class Line;
  void run();
  bool follow(Line& line);

  Settings settings_;
  Listener listener_;
  const Clock& clock_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace footlight::app
