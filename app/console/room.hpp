// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "app/console/access.hpp"
#include "app/console/audit_log.hpp"
#include "app/console/client_message.hpp"
#include "app/console/order_box.hpp"
#include "app/console/request_rules.hpp"
#include "app/surfaces/surface.hpp"
#include "core/clock.hpp"

namespace footlight::app {

using PersonId = std::uint32_t;
/// A message that many may get.
using Letter = std::shared_ptr<const std::string>;

/// Brings letters to who is connected.
class Mailer {
 public:
  virtual ~Mailer() = default;
  /// In their order.
  virtual void send(PersonId to, const Letter& letter) = 0;
  /// Takes the place of an earlier state that has not left yet.
  virtual void send_state(PersonId to, const Letter& letter) = 0;
  virtual void close(PersonId who, std::uint16_t code, std::string_view why) = 0;
};

/// So many at once, then so many a second.
class Allowance {
 public:
  Allowance(double at_once, double a_second) : most_(at_once), left_(at_once), a_second_(a_second) {}
  bool take(Instant now);

 private:
  double most_;
  double left_;
  double a_second_;
  Instant at_ = Instant::min();
};

/// Who is at the console, what each may do, who has the operator's seat, and what all are told (docs/console.md, "The
/// WebSocket"), without sockets. One thread.
class Room {
 public:
  static constexpr Duration kHelloWithin = milliseconds(5000);
  static constexpr std::size_t kLogged = 200;
  static constexpr std::size_t kAlarms = 256;

  enum Close : std::uint16_t { kGoingAway = 1001, kNotUnderstood = 4400, kToken = 4401, kSlow = 4408, kFlood = 4429 };

  struct About {
    std::string version;
    std::string run;  ///< tells starts of the program apart
    std::string plan;
    std::uint32_t epoch = 1;
  };

  /// Borrows all. @param audit null: nothing is written
  Room(Mailer& mailer, OrderBox& orders, AuditLog* audit, Pairing& pairing, const ConsoleRules& rules,
       const Clock& clock, About about);

  PersonId enter(Caller caller);
  void leave(PersonId who);
  void heard(PersonId who, std::string_view message);
  /// Several times a second: whoever has not said hello goes, whose orders were lost is told.
  void tick();

  void told(const RunEvent& event);
  /// @param cue for the audit log
  void state(std::string json, std::string cue);
  void health(std::string json);
  void untold(std::string json);
  void take_plan(std::uint32_t epoch, std::string plan);
  /// What was refused before anybody came in.
  void refused(const std::string& from, const std::string& what, const std::string& why);
  /// A code was typed. @return the token and its role
  std::optional<Pairing::Paired> pair(const std::string& from, std::string_view code);

  /// She has said hello.
  [[nodiscard]] bool welcome(PersonId who) const;
  [[nodiscard]] std::size_t people() const { return people_.size(); }

 private:
  struct Person {
    Caller caller;
    std::string name{};
    Role role = Role::view;
    bool welcome = false;
    Instant since{};
    Allowance messages{200, 100};
    Allowance orders{40, 20};
    std::uint64_t lost = 0;
  };
  struct Asker {
    PersonId who = 0;
    std::optional<std::uint64_t> id;
  };
  struct Alarm {
    std::uint64_t n = 0;
    std::int64_t unix_ms = 0;
    std::string text;
    std::string acknowledged_by{};
  };

  void hello(PersonId id, Person& person, const Hello& hello);
  void take(PersonId id, Person& person, const ClientMessage& message);
  void order(PersonId id, Person& person, const OrderSaid& order);
  void seat(PersonId id, Person& person, bool take);
  void acknowledge(PersonId id, Person& person, std::uint64_t alarm);
  void make_code(PersonId id, Person& person, Role role);
  void refuse(PersonId id, const Person& person, const std::string& what, std::optional<std::uint64_t> order_id,
              const std::string& why);
  void to_all(const Letter& letter);
  void log(const RunEvent& event) { log(event, {0, std::nullopt}); }
  void log(const RunEvent& event, const Asker& asker);
  void tell_seat();
  void tell_people();
  void note(const Person& person, std::string what, std::string result);
  [[nodiscard]] Letter seat_letter() const;
  [[nodiscard]] Letter people_letter() const;
  [[nodiscard]] Letter alarms_letter() const;
  [[nodiscard]] Letter log_letter() const;

  Mailer& mailer_;
  OrderBox& orders_;
  AuditLog* audit_;
  Pairing& pairing_;
  const ConsoleRules& rules_;
  const Clock& clock_;
  About about_;
  std::map<PersonId, Person> people_;
  PersonId last_ = 0;
  std::optional<PersonId> seat_;
  std::map<std::uint64_t, Asker> asked_;  ///< by tag, until it is answered
  std::uint64_t last_tag_ = 0;
  std::uint64_t last_event_ = 0;
  std::deque<std::string> log_;
  std::deque<Alarm> alarms_;
  Letter state_;
  Letter health_;
  Letter untold_;
  std::string cue_;
};

}  // namespace footlight::app
