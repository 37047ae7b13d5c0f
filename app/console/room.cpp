// SPDX-License-Identifier: Apache-2.0
#include "app/console/room.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostUnanswered = 1024;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }
Letter letter_of(const Json& json) { return std::make_shared<const std::string>(text_of(json)); }

std::int64_t unix_ms() { return std::chrono::duration_cast<std::chrono::milliseconds>(wall_time()).count(); }

}  // namespace

bool Allowance::take(Instant now) {
  if (at_ != Instant::min()) left_ = std::min(most_, left_ + to_seconds(now - at_) * a_second_);
  at_ = now;
  if (left_ < 1) return false;
  left_ -= 1;
  return true;
}

Room::Room(Mailer& mailer, OrderBox& orders, AuditLog* audit, Pairing& pairing, const ConsoleRules& rules,
           const Clock& clock, About about)
    : mailer_(mailer),
      orders_(orders),
      audit_(audit),
      pairing_(pairing),
      rules_(rules),
      clock_(clock),
      about_(std::move(about)) {}

void Room::note(const Person& person, std::string what, std::string result) {
  if (audit_ == nullptr) return;
  const std::string role(person.welcome ? to_text(person.role) : "");
  audit_->add({person.name, person.caller.from, role, std::move(what), std::move(result), cue_, about_.plan});
}

void Room::refused(const std::string& from, const std::string& what, const std::string& why) {
  if (audit_ != nullptr) audit_->add({"", from, "", what, "refused: " + why, cue_, about_.plan});
}

std::optional<Pairing::Paired> Room::pair(const std::string& from, std::string_view code) {
  auto paired = pairing_.redeem(code, clock_.now());
  if (audit_ != nullptr) {
    const std::string role(paired ? to_text(paired->role) : "");
    audit_->add({"", from, role, "code", paired ? "good" : "refused: the code is not good", cue_, about_.plan});
  }
  return paired;
}

PersonId Room::enter(Caller caller) {
  const PersonId id = ++last_;
  Person person{std::move(caller)};
  person.since = clock_.now();
  people_.emplace(id, std::move(person));
  return id;
}

void Room::leave(PersonId who) {
  const auto found = people_.find(who);
  if (found == people_.end()) return;
  const bool was_here = found->second.welcome;
  if (was_here) note(found->second, "leaves", seat_ == who ? "the seat is empty" : "");
  people_.erase(found);
  if (seat_ == who) {
    seat_.reset();
    tell_seat();
  }
  if (was_here) tell_people();
}

bool Room::welcome(PersonId who) const {
  const auto found = people_.find(who);
  return found != people_.end() && found->second.welcome;
}

void Room::heard(PersonId who, std::string_view message) {
  const auto found = people_.find(who);
  if (found == people_.end()) return;
  Person& person = found->second;
  if (!person.messages.take(clock_.now())) {
    note(person, "messages", "closed: a flood");
    return mailer_.close(who, kFlood, "too many messages");
  }
  const auto understood = client_message_from(message);
  if (!understood) {
    note(person, "message", "closed: " + understood.error().message);
    return mailer_.close(who, kNotUnderstood, understood.error().message);
  }
  if (const auto* said = std::get_if<Hello>(&*understood); said != nullptr) return hello(who, person, *said);
  if (!person.welcome) {
    note(person, "message", "closed: no hello");
    return mailer_.close(who, kNotUnderstood, "hello comes first");
  }
  take(who, person, *understood);
}

void Room::hello(PersonId id, Person& person, const Hello& hello) {
  if (person.welcome) return mailer_.close(id, kNotUnderstood, "hello has been said");
  const auto role = role_of(rules_, pairing_, hello.token, person.caller.stranger);
  person.name = hello.name;
  if (!role) {
    note(person, "hello", "refused: token");
    return mailer_.close(id, kToken, "the token is not good");
  }
  person.role = std::min(*role, hello.most);
  person.welcome = true;
  note(person, "hello", "welcome");
  mailer_.send(id, letter_of({{"welcome",
                               {{"you", id},
                                {"role", to_text(person.role)},
                                {"version", about_.version},
                                {"plan", about_.plan},
                                {"epoch", about_.epoch},
                                {"run", about_.run}}}}));
  if (state_) mailer_.send_state(id, state_);
  mailer_.send(id, seat_letter());
  mailer_.send(id, log_letter());
  mailer_.send(id, alarms_letter());
  if (health_) mailer_.send(id, health_);
  if (untold_) mailer_.send(id, untold_);
  tell_people();
}

void Room::take(PersonId id, Person& person, const ClientMessage& message) {
  if (const auto* said = std::get_if<OrderSaid>(&message); said != nullptr) return order(id, person, *said);
  if (const auto* wish = std::get_if<SeatWish>(&message); wish != nullptr) return seat(id, person, wish->take);
  if (const auto* alarm = std::get_if<Acknowledge>(&message); alarm != nullptr) {
    return acknowledge(id, person, alarm->alarm);
  }
  if (const auto* wish = std::get_if<PairWish>(&message); wish != nullptr) return make_code(id, person, wish->role);
  if (const auto* ping = std::get_if<Ping>(&message); ping != nullptr) {
    mailer_.send(id, letter_of({{"pong", ping->number}}));
  }
}

void Room::refuse(PersonId id, const Person& person, const std::string& what, std::optional<std::uint64_t> order_id,
                  const std::string& why) {
  note(person, what, "refused: " + why);
  RunEvent event{RunEvent::Kind::answer, why};
  event.order = what;
  event.who.name = person.name;
  event.refused = true;
  Json json = Json::parse(json_of(event));
  if (order_id) json["answer"]["id"] = *order_id;
  json["unix_ms"] = unix_ms();
  mailer_.send(id, letter_of(json));
}

void Room::order(PersonId id, Person& person, const OrderSaid& order) {
  const auto refuse_it = [&](const std::string& why) { refuse(id, person, order.line, order.id, why); };
  if (person.role == Role::view) return refuse_it("who views gives no orders");
  const bool hold = is_hold(order.line);
  if (!hold) {
    if (!person.orders.take(clock_.now())) {
      ++person.lost;
      return;
    }
    if (seat_ && *seat_ != id) return refuse_it("somebody else has the seat: take it first");
    if (verb_of(order.line) == "quit" && person.role != Role::admin) return refuse_it("only an admin ends the run");
    if (!seat_) seat(id, person, true);
  }
  const std::uint64_t tag = ++last_tag_;
  if (!orders_.put({order.line, person.name, tag}, hold)) {
    ++person.lost;
    return;
  }
  note(person, "order " + order.line, "said");
  asked_[tag] = {id, order.id};
  if (asked_.size() > kMostUnanswered) asked_.erase(asked_.begin());
}

void Room::seat(PersonId id, Person& person, bool take) {
  const std::string what = take ? "seat take" : "seat leave";
  if (person.role == Role::view) return refuse(id, person, what, {}, "who views has no seat");
  if (!take && seat_ != id) return refuse(id, person, what, {}, "you do not have it");
  if (take && seat_ == id) return;
  std::string text = person.name + (take ? " has the operator's seat" : " has left the operator's seat");
  if (take && seat_) text += ", which " + people_.at(*seat_).name + " had";
  note(person, what, text);
  seat_ = take ? std::optional(id) : std::nullopt;
  tell_seat();
  log({RunEvent::Kind::note, std::move(text)});
}

void Room::acknowledge(PersonId id, Person& person, std::uint64_t alarm) {
  const std::string what = fmt::format("acknowledge {}", alarm);
  if (person.role == Role::view) return refuse(id, person, what, {}, "who views acknowledges nothing");
  const auto found = std::ranges::find(alarms_, alarm, &Alarm::n);
  if (found == alarms_.end()) return refuse(id, person, what, {}, "there is no such alarm");
  if (!found->acknowledged_by.empty()) return;
  found->acknowledged_by = person.name;
  note(person, what, found->text);
  to_all(alarms_letter());
}

void Room::make_code(PersonId id, Person& person, Role role) {
  const std::string what = fmt::format("pair {}", to_text(role));
  if (person.role != Role::admin) return refuse(id, person, what, {}, "only an admin makes codes");
  note(person, what, "a code was made");
  const std::string code = pairing_.make(role, clock_.now());
  const auto good_for = std::chrono::duration_cast<std::chrono::seconds>(Pairing::kGoodFor).count();
  mailer_.send(id, letter_of({{"code", {{"code", code}, {"role", to_text(role)}, {"seconds", good_for}}}}));
}

void Room::tick() {
  const Instant now = clock_.now();
  std::vector<PersonId> silent;
  for (auto& [id, person] : people_) {
    if (!person.welcome && now - person.since > kHelloWithin) silent.push_back(id);
    if (person.lost == 0) continue;
    note(person, fmt::format("{} orders", person.lost), "lost: too many");
    mailer_.send(id, letter_of({{"lost", std::exchange(person.lost, 0)}}));
  }
  for (const PersonId id : silent) mailer_.close(id, kNotUnderstood, "no hello in time");
}

void Room::told(const RunEvent& event) {
  if (event.kind != RunEvent::Kind::answer) return log(event);
  const auto asked = asked_.find(event.who.tag);
  const bool ours = event.who.input == controller::GoSource::page && asked != asked_.end();
  if (!ours) return log(event);
  const Asker asker = asked->second;
  asked_.erase(asked);
  const auto person = people_.find(asker.who);
  if (audit_ != nullptr) {
    const bool here = person != people_.end();
    audit_->add({event.who.name, here ? person->second.caller.from : "",
                 std::string(here ? to_text(person->second.role) : ""), "order " + event.order,
                 (event.refused ? "refused: " : "") + event.text, cue_, about_.plan});
  }
  log(event, asker);
}

/// To all, and for those who come later; who has asked gets her own id back.
void Room::log(const RunEvent& event, const Asker& asker) {
  Json json = Json::parse(json_of(event));
  json["n"] = ++last_event_;
  json["unix_ms"] = unix_ms();
  log_.push_back(text_of(json));
  if (log_.size() > kLogged) log_.pop_front();
  const auto letter = std::make_shared<const std::string>(log_.back());
  for (const auto& [id, person] : people_) {
    if (!person.welcome) continue;
    if (id == asker.who && asker.id) json["answer"]["id"] = *asker.id;
    mailer_.send(id, id == asker.who && asker.id ? letter_of(json) : letter);
  }
  if (event.kind != RunEvent::Kind::alarm) return;
  alarms_.push_back({last_event_, json["unix_ms"].get<std::int64_t>(), event.text});
  if (alarms_.size() > kAlarms) alarms_.pop_front();
  to_all(alarms_letter());
}

void Room::state(std::string json, std::string cue) {
  cue_ = std::move(cue);
  state_ = std::make_shared<const std::string>(std::move(json));
  for (const auto& [id, person] : people_) {
    if (person.welcome) mailer_.send_state(id, state_);
  }
}

void Room::health(std::string json) {
  health_ = std::make_shared<const std::string>(std::move(json));
  to_all(health_);
}

void Room::untold(std::string json) {
  untold_ = std::make_shared<const std::string>(std::move(json));
  to_all(untold_);
}

void Room::take_plan(std::uint32_t epoch, std::string plan) {
  about_.epoch = epoch;
  about_.plan = std::move(plan);
  to_all(letter_of({{"epoch", epoch}, {"plan", about_.plan}}));
}

void Room::to_all(const Letter& letter) {
  for (const auto& [id, person] : people_) {
    if (person.welcome) mailer_.send(id, letter);
  }
}

void Room::tell_seat() { to_all(seat_letter()); }
void Room::tell_people() { to_all(people_letter()); }

Letter Room::seat_letter() const {
  if (!seat_) return letter_of({{"seat", nullptr}});
  return letter_of({{"seat", {{"holder", *seat_}, {"name", people_.at(*seat_).name}}}});
}

Letter Room::people_letter() const {
  Json people = Json::array();
  for (const auto& [id, person] : people_) {
    if (person.welcome) people.push_back({{"id", id}, {"name", person.name}, {"role", to_text(person.role)}});
  }
  return letter_of({{"people", std::move(people)}});
}

Letter Room::alarms_letter() const {
  Json alarms = Json::array();
  for (const Alarm& alarm : alarms_) {
    Json one{{"n", alarm.n}, {"text", alarm.text}, {"unix_ms", alarm.unix_ms}, {"acknowledged_by", nullptr}};
    if (!alarm.acknowledged_by.empty()) one["acknowledged_by"] = alarm.acknowledged_by;
    alarms.push_back(std::move(one));
  }
  return letter_of({{"alarms", std::move(alarms)}});
}

Letter Room::log_letter() const {
  std::string text = R"({"log":[)";
  for (const std::string& line : log_) text += (&line == &log_.front() ? "" : ",") + line;
  return std::make_shared<const std::string>(text + "]}");
}

}  // namespace footlight::app
