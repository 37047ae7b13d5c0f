// SPDX-License-Identifier: Apache-2.0
#include "app/console/server.hpp"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/console/client_message.hpp"
#include "app/console/http_connection.hpp"
#include "app/console/server_works.hpp"
#include "app/console/web_socket.hpp"

namespace footlight::app {
namespace {

using Error = boost::system::error_code;

constexpr auto kTick = std::chrono::milliseconds(40);
constexpr std::uint64_t kTicksOfRoom = 6;
constexpr std::string_view kJson = "application/json";
constexpr std::string_view kBytes = "application/octet-stream";

HttpServer::Limits limits_of(const ConsoleServer::Settings& settings) {
  HttpServer::Limits limits;
  limits.connections = ConsoleServer::kMostConnections;
  limits.of_one_address = ConsoleServer::kMostOfOneAddress;
  limits.headers_within = settings.headers_within;
  limits.body_within = settings.body_within;
  limits.silent_for = settings.silent_for;
  return limits;
}

}  // namespace

ServerWorks::ServerWorks(ConsoleServer::Settings settings, OrderBox& orders, AuditLog* audit, const Clock& clock)
    : HttpServer(limits_of(settings)),
      settings_(std::move(settings)),
      orders_(orders),
      room_(*this, orders, audit, pairing_, settings_.rules, clock, settings_.about),
      clock_(clock) {}

ServerWorks::~ServerWorks() { stop(); }

Status<> ServerWorks::listen() { return HttpServer::listen("console", settings_.address, settings_.port); }

Verdict ServerWorks::judge(const AskedFor& asked) const { return app::judge(asked, settings_.rules, pairing_); }

void ServerWorks::answer(const std::shared_ptr<HttpConnection>& connection, const Verdict& verdict) {
  switch (verdict.route) {
    case Route::show:
      return connection->answer_document(documents.show, kJson);
    case Route::plan:
      return connection->answer_document(documents.plan, kBytes);
    case Route::way:
      return connection->answer_document(documents.way, kBytes, 404);
    case Route::looks:
      connection->wait_for_answer();
      return want_looks(verdict.number, connection);
    case Route::page:
    case Route::socket:
    case Route::pair:
      return;  // the connection's own
  }
}

void ServerWorks::take_body(HttpConnection& connection, const std::string& body) {
  const auto code = code_from(body);
  if (!code) return connection.refuse(400, code.error().message);
  const auto paired = room_.pair(connection.caller().from, *code);
  if (!paired) return connection.refuse(403, "the code is not good, or no longer: ask for another one");
  const nlohmann::ordered_json json{{"token", paired->token}, {"role", to_text(paired->role)}};
  connection.answer_document(std::make_shared<const std::string>(json.dump()), kJson);
}

Caller ServerWorks::caller_of(Tcp::socket& socket, std::string from) { return {std::move(from), is_stranger(socket)}; }

bool ServerWorks::is_stranger(Tcp::socket& socket) const {
  if (settings_.rules.needs_token) return false;  // nobody is trusted for where she is
  const auto owner = settings_.owner_of(socket.native_handle());
  return !owner || (*owner != ::geteuid() && *owner != 0);
}

void ServerWorks::tick() {
  ticker().expires_after(kTick);
  ticker().async_wait([this](Error stopped) {
    if (stopped || ends()) return;
    for (const auto& [id, socket] : sockets_) {
      if (room_.welcome(id)) socket->look_at_nodes();
    }
    if (++ticks_ % kTicksOfRoom == 0) room_.tick();
    if (unlogged_ > 0 && refusals_.take(clock_.now())) {
      room_.refused("", fmt::format("{} more", std::exchange(unlogged_, 0)), "not written one by one");
    }
    tick();
  });
}

bool ServerWorks::say_farewell() {
  ticker().cancel();
  askers_.clear();
  for (const auto& [id, socket] : sockets_) socket->close(Room::kGoingAway, "the run has ended");
  return !sockets_.empty();
}

void ServerWorks::send(PersonId to, const Letter& letter) {
  if (const auto found = sockets_.find(to); found != sockets_.end()) found->second->send(letter);
}

void ServerWorks::send_state(PersonId to, const Letter& letter) {
  if (const auto found = sockets_.find(to); found != sockets_.end()) found->second->send_state(letter);
}

void ServerWorks::close(PersonId who, std::uint16_t code, std::string_view why) {
  if (const auto found = sockets_.find(who); found != sockets_.end()) found->second->close(code, why);
}

PersonId ServerWorks::enter(WebSocket& socket, const Caller& caller) {
  const PersonId id = room_.enter(caller);
  sockets_[id] = &socket;
  return id;
}

void ServerWorks::leave(PersonId who) {
  sockets_.erase(who);
  if (!ends()) room_.leave(who);
}

void ServerWorks::refused(const std::string& from, const std::string& what, const std::string& why) {
  if (refusals_.take(clock_.now())) return room_.refused(from, what, why);
  ++unlogged_;
}

void ServerWorks::want_looks(std::size_t k, std::shared_ptr<HttpConnection> asker) {
  auto& askers = askers_[k];
  askers.push_back(std::move(asker));
  if (askers.size() > 1) return;
  {
    const std::lock_guard lock(wanted_mutex_);
    wanted_.push_back(k);  // not more than there are connections
  }
  orders_.wake();
}

void ServerWorks::take_looks(std::size_t k, const Letter& looks) {
  const auto found = askers_.extract(k);
  if (found.empty()) return;
  for (const auto& asker : found.mapped()) asker->take_looks(looks);
}

std::vector<std::size_t> ServerWorks::looks_wanted() {
  const std::lock_guard lock(wanted_mutex_);
  return std::exchange(wanted_, {});
}

Result<std::unique_ptr<ConsoleServer>> ConsoleServer::open(Settings settings, OrderBox& orders, AuditLog* audit,
                                                           const Clock& clock) {
  auto works = std::make_unique<ServerWorks>(std::move(settings), orders, audit, clock);
  if (auto listening = works->listen(); !listening) return std::move(listening).error();
  return std::unique_ptr<ConsoleServer>(new ConsoleServer(std::move(works)));
}

ConsoleServer::ConsoleServer(std::unique_ptr<ServerWorks> works) : works_(std::move(works)) {}
ConsoleServer::~ConsoleServer() = default;

std::uint16_t ConsoleServer::port() const { return works_->port(); }

void ConsoleServer::take_show(std::uint32_t epoch, const std::string& plan_hash, Letter show, Letter plan) {
  works_->post([this, epoch, plan_hash, show = std::move(show), plan = std::move(plan)] {
    works_->documents = {show, plan, nullptr};
    works_->room().take_plan(epoch, plan_hash);
  });
}

void ConsoleServer::take_way(Letter way) {
  works_->post([this, way = std::move(way)] { works_->documents.way = way; });
}

void ConsoleServer::state(std::string json, std::string cue) {
  works_->post([this, json = std::move(json), cue = std::move(cue)]() mutable {
    works_->room().state(std::move(json), std::move(cue));
  });
}

void ConsoleServer::health(std::string json) {
  works_->post([this, json = std::move(json)]() mutable { works_->room().health(std::move(json)); });
}

void ConsoleServer::untold(std::string json) {
  works_->post([this, json = std::move(json)]() mutable { works_->room().untold(std::move(json)); });
}

void ConsoleServer::told(const RunEvent& event) {
  works_->post([this, event] { works_->room().told(event); });
}

std::vector<std::size_t> ConsoleServer::looks_wanted() { return works_->looks_wanted(); }

void ConsoleServer::take_looks(std::size_t k, Letter looks) {
  works_->post([this, k, looks = std::move(looks)] { works_->take_looks(k, looks); });
}

}  // namespace footlight::app
