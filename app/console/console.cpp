// SPDX-License-Identifier: Apache-2.0
#include "app/console/console.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/console/show_document.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;
using Phase = controller::Rehearsal::Phase;

constexpr std::size_t kOrdersOfALook = 8;  // the cue thread's ring takes more, and is empty again by the next look
constexpr std::size_t kLooksOfALook = 4;
constexpr Duration kWhileItMoves = milliseconds(95);  // ten times a second, where looks come every 20 ms
constexpr Duration kWhileItStands = milliseconds(1000);
constexpr Duration kHealth = milliseconds(1000);
constexpr std::size_t kRunBytes = 4;

bool numeric(const std::string& address) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  return ::inet_pton(AF_INET, address.c_str(), bytes.data()) == 1 ||
         ::inet_pton(AF_INET6, address.c_str(), bytes.data()) == 1;
}

bool loopback(const std::string& address) { return address.starts_with("127.") || address == "::1"; }

/// As browsers write it.
std::string authority_of(const std::string& address, std::uint16_t port) {
  const bool six = address.find(':') != std::string::npos;
  const std::string host = six ? "[" + address + "]" : address;
  return port == 80 ? host : fmt::format("{}:{}", host, port);
}

}  // namespace

Result<Console::Place> Console::place_from(const std::string& place, const std::string& what) {
  Place out;
  const std::size_t colon = place.rfind(':');
  std::string port = place;
  if (colon != std::string::npos) {
    out.address = place.substr(0, colon);
    port = place.substr(colon + 1);
    if (out.address.starts_with('[') && out.address.ends_with(']')) {
      out.address = out.address.substr(1, out.address.size() - 2);
    }
    if (out.address == "localhost") out.address = "127.0.0.1";
  }
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), out.port);
  if (error != std::errc() || end != port.data() + port.size() || !numeric(out.address)) {
    return input_error(
        fmt::format("\"{}\" is no place for {}: a port, as 8440, or a numeric address of this machine and a port, as "
                    "192.168.1.5:8440 or [::1]:8440",
                    place, what));
  }
  return out;
}

Console::Console(const Show& show, const Plan& plan, const Rig& rig, const RunDesk& desk, bool leads)
    : show_(show),
      plan_(plan),
      rig_(rig),
      text_(show, plan, desk.orders().plays()),
      leads_(leads),
      board_(rig.nodes.size()) {}

Result<std::unique_ptr<Console>> Console::open(const Place& place, const std::filesystem::path& folder,
                                               const Show& show, const Plan& plan, const Rig& rig, const RunDesk& desk,
                                               bool leads) {
  std::unique_ptr<Console> console(new Console(show, plan, rig, desk, leads));
  ConsoleServer::Settings settings;
  settings.address = place.address;
  settings.port = place.port;
  settings.about = {FOOTLIGHT_VERSION, random_hex(kRunBytes), plan.show_hash, console->epoch_};
  settings.nodes = &console->board_;
  for (const std::string& host : place.hosts) settings.rules.hosts.add(host);
  settings.rules.most = place.most;
  if (loopback(place.address)) settings.rules.local_names = {"localhost"};
  settings.rules.needs_token = !loopback(place.address) || !place.hosts.empty();
  console->needs_token_ = settings.rules.needs_token;
  std::error_code ignored;  // whoever writes there next says what is wrong
  std::filesystem::create_directories(folder, ignored);
  auto token = token_in(folder / "console.token");
  if (!token) return std::move(token).error();
  settings.rules.token = std::move(token).value();
  auto audit = AuditLog::open(folder / "console.log");
  if (!audit) return std::move(audit).error();
  console->audit_ = std::move(audit).value();
  auto server = ConsoleServer::open(std::move(settings), console->orders_, console->audit_.get(), console->clock_);
  if (!server) return std::move(server).error();
  console->server_ = std::move(server).value();
  console->address_ = "http://" + authority_of(place.address, console->server_->port());
  return console;
}

void Console::plan_taken() {
  ++epoch_;
  show_told_ = false;
  way_.reset();
  state_at_ = Instant::min();
}

void Console::begin() {
  if (show_told_) plan_taken();
}

void Console::look(const DeskView& view, RunDesk& desk) {
  if (!show_told_) tell_show(view);
  for (SaidOrder& order : orders_.take(kOrdersOfALook)) {
    desk.say(order.line, {controller::GoSource::page, std::move(order.who), order.tag});
  }
  if (view.way != way_) {
    way_ = view.way;
    server_->take_way(way_ ? std::make_shared<const std::string>(plan_bytes(*way_, epoch_)) : nullptr);
  }
  tell_looks(view);
  tell_state(view);
  tell_health(view);
  tell_untold(view);
}

void Console::tell_show(const DeskView& view) {
  show_told_ = true;
  const ShownShow shown{show_, plan_, &rig_, view.schedule, &limits_, epoch_};
  server_->take_show(epoch_, plan_.show_hash, std::make_shared<const std::string>(show_json(shown)),
                     std::make_shared<const std::string>(plan_bytes(plan_, epoch_)));
}

void Console::tell_looks(const DeskView& view) {
  for (const std::size_t k : server_->looks_wanted()) looks_wanted_.push_back(k);
  for (std::size_t i = 0; i < kLooksOfALook && !looks_wanted_.empty(); ++i) {
    const std::size_t k = looks_wanted_.front();
    looks_wanted_.erase(looks_wanted_.begin());
    auto looks = view.schedule == nullptr ? std::nullopt : looks_bytes(*view.schedule, rig_.nodes.size(), k, epoch_);
    server_->take_looks(k, looks ? std::make_shared<const std::string>(*std::move(looks)) : nullptr);
  }
}

void Console::tell_state(const DeskView& view) {
  const ShowState& state = view.show;
  const bool moves = state.phase == Phase::runs || state.phase == Phase::counts_in || state.phase == Phase::resets;
  const Duration every = moves ? kWhileItMoves : kWhileItStands;
  std::string changes = StateText::changes(view);
  if (changes == state_ && state_at_ != Instant::min() && state.at - state_at_ < every) return;
  state_ = std::move(changes);
  state_at_ = state.at;
  const int cue = state.active >= 0 ? state.active : state.standby;
  const auto& plays = text_.plays();
  server_->state(text_.json(view), cue < 0 ? "" : plays[static_cast<std::size_t>(cue)].cue.number.to_text());
}

void Console::tell_health(const DeskView& view) {
  if (health_at_ != Instant::min() && view.show.at - health_at_ < kHealth) return;
  health_at_ = view.show.at;
  Json buses = Json::array();
  for (const BusView& bus : view.buses) {
    const controller::BusCounters& counted = bus.counters;
    Json last = nullptr;
    if (!bus.last_fault.empty()) last = {{"text", bus.last_fault}, {"unix_ms", bus.last_fault_unix_ms}};
    buses.push_back(
        {{"name", bus.name},
         {"nodes", bus.nodes},
         {"unconfirmed", bus.unconfirmed},
         {"quarantined", bus.quarantined},
         {"silent", bus.silent},
         {"trouble", bus.trouble},
         {"last_fault", std::move(last)},
         {"load", bus.load ? Json(*bus.load) : Json(nullptr)},
         {"confirmed_after_ms", bus.confirmed_after ? Json(to_seconds(*bus.confirmed_after) * 1e3) : Json(nullptr)},
         {"deliveries", counted.deliveries},
         {"unverified", counted.unverified},
         {"retries", counted.retries},
         {"misses", counted.misses},
         {"boots", counted.boots},
         {"latches", counted.latches},
         {"late_latches", counted.late_latches},
         {"worst_lateness_ms", to_seconds(counted.worst_lateness) * 1e3}});
  }
  std::string text =
      Json{{"health", {{"buses", std::move(buses)}}}}.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text == health_) return;
  health_ = text;
  server_->health(std::move(text));
}

/// Who has to be told, by name: too long for a state that is told ten times a second.
void Console::tell_untold(const DeskView& view) {
  if (view.edit.untold == nullptr || view.edit.untold == untold_) return;
  untold_ = view.edit.untold;
  server_->untold(Json{{"untold", *untold_}}.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace footlight::app
