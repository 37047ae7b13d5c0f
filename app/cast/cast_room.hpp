// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>

#include "app/console/room.hpp"
#include "app/paper/words.hpp"
#include "core/clock.hpp"
#include "core/index.hpp"
#include "core/result.hpp"

namespace footlight::app {

// What a phone says (docs/cast.md).
struct PhoneHello {
  std::string token;
};
struct PhonePing {
  double number = 0;
};
/// What a performer asks for.
struct PhoneQuestion {
  enum class About : std::uint8_t { part, way, where };
  About about = About::part;
  PerformerIndex who;
  Language language = Language::english;
  CellIndex cell;  ///< of `where`
};
using PhoneMessage = std::variant<PhoneHello, PhonePing, PhoneQuestion>;

/// Errors (ErrorKind::input): not UTF-8, not one JSON object of at most 512 bytes with one of the known keys, a value
/// that is none.
[[nodiscard]] Result<PhoneMessage> phone_message_from(std::string_view text);

/// The phones that are here, and what each may ask, without sockets. One thread.
class CastRoom {
 public:
  static constexpr Duration kHelloWithin = milliseconds(5000);
  static constexpr double kQuestionsAtOnce = 6;
  static constexpr double kQuestionsASecond = 0.5;

  /// @param ask hands a question over; false: there are too many  @param token what phones have to know
  CastRoom(Mailer& mailer, std::string token, const Clock& clock,
           std::function<bool(PersonId, const PhoneQuestion&)> ask);

  PersonId enter();
  void leave(PersonId who) { phones_.erase(who); }
  void heard(PersonId who, std::string_view message);
  /// Ends those who say nothing.
  void tick();
  /// To all, and to those who come later; the newest only.
  void state(Letter letter);
  [[nodiscard]] std::size_t phones() const { return phones_.size(); }

 private:
  struct Phone {
    Instant since{};
    bool welcome = false;
    Allowance messages{40, 4};
    Allowance questions{kQuestionsAtOnce, kQuestionsASecond};
  };
  void take(PersonId who, Phone& phone, const PhoneQuestion& question);

  Mailer& mailer_;
  std::string token_;
  const Clock& clock_;
  std::function<bool(PersonId, const PhoneQuestion&)> ask_;
  std::unordered_map<PersonId, Phone> phones_;
  PersonId last_ = 0;
  Letter state_;
};

}  // namespace footlight::app
