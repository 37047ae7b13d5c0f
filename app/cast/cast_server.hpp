// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/cast/cast_plan.hpp"
#include "app/cast/desk_word.hpp"
#include "app/console/audit_log.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"

namespace footlight::app {

class CastWorks;

/// A reset move, as the phones of its people need it.
struct CastWay {
  Show counted;  ///< its tempo counts the move: count 1 is its beginning
  std::vector<std::vector<Mark>> tracks;
};

/// The code that a person types once for a phone's token, made of that token: ten characters that nobody mistakes for
/// each other, 50 bits.
[[nodiscard]] std::string join_code(const std::string& token);
/// As it was meant: capitals, no spaces and hyphens, O is 0, I and L are 1.
[[nodiscard]] std::string code_as_meant(std::string_view typed);

/// Serves the cast's phones (docs/cast.md). Nothing that comes from a phone goes anywhere but into an answer to this
/// phone. Members may be called by any thread; each hands over and returns.
class CastServer {
 public:
  struct Settings {
    std::string address = "127.0.0.1";  ///< numeric
    std::uint16_t port = 0;             ///< 0: any that is free
    std::vector<std::string> hosts{};   ///< names by which browsers may ask for it besides, with their port
    std::string token;                  ///< what phones have to know
    std::size_t most_phones = 6000;
    // Times that tests make shorter.
    Duration headers_within = milliseconds(5000);
    Duration body_within = milliseconds(10'000);
    Duration silent_for = milliseconds(20'000);
    Duration heartbeat = milliseconds(2000);
  };

  /// Listens from here on. Borrows audit and clock. @param audit null: nothing is written
  /// Errors (ErrorKind::input): the address is not one of this machine, or somebody else listens there.
  [[nodiscard]] static Result<std::unique_ptr<CastServer>> open(Settings settings, AuditLog* audit, const Clock& clock);
  ~CastServer();
  CastServer(const CastServer&) = delete;
  CastServer& operator=(const CastServer&) = delete;

  [[nodiscard]] std::uint16_t port() const;

  /// @param same whether it is what the desk plays
  void take_plan(std::shared_ptr<const CastPlan> cast, bool same);
  void take_word(const DeskWord& word, Instant came);
  /// The desk is not heard.
  void lost();
  /// @param way null: there is none any more
  void take_way(std::shared_ptr<const CastWay> way);

 private:
  explicit CastServer(std::unique_ptr<CastWorks> works);
  std::unique_ptr<CastWorks> works_;
};

}  // namespace footlight::app
