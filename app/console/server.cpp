// SPDX-License-Identifier: Apache-2.0
#include "app/console/server.hpp"

#include <utility>

#include <boost/asio/post.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "app/console/http_connection.hpp"
#include "app/console/server_works.hpp"
#include "app/console/web_socket.hpp"
#include "app/live/waiting.hpp"

namespace footlight::app {
namespace {

namespace asio = boost::asio;
using Error = boost::system::error_code;

constexpr auto kTick = std::chrono::milliseconds(40);
constexpr std::uint64_t kTicksOfRoom = 6;
constexpr auto kPause = std::chrono::milliseconds(100);     // when the system has no more files to give
constexpr auto kFarewell = std::chrono::milliseconds(300);  // for those who are connected when the run ends

}  // namespace

ServerWorks::Admission::Admission(ServerWorks& works, Caller caller) : works_(works), caller_(std::move(caller)) {
  ++works_.connected_;
  ++works_.connections_[caller_.from];
}

ServerWorks::Admission::~Admission() {
  --works_.connected_;
  const auto found = works_.connections_.find(caller_.from);
  if (--found->second == 0) works_.connections_.erase(found);
}

ServerWorks::ServerWorks(ConsoleServer::Settings settings, OrderBox& orders, AuditLog* audit, const Clock& clock)
    : settings_(std::move(settings)),
      orders_(orders),
      room_(*this, orders, audit, pairing_, settings_.rules, clock, settings_.about),
      clock_(clock) {}

ServerWorks::~ServerWorks() {
  if (!thread_.joinable()) return;
  asio::post(context_, [this] { end(); });
  thread_.join();
}

Status<> ServerWorks::listen() {
  const auto wrong = [&](const std::string& why) {
    return input_error(fmt::format("console {}:{}: {}", settings_.address, settings_.port, why));
  };
  Error error;
  const auto address = asio::ip::make_address(settings_.address, error);
  if (error) return wrong("no numeric address");
  const Tcp::endpoint end(address, settings_.port);
  acceptor_.open(end.protocol(), error);
  if (!error) acceptor_.set_option(Tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor_.bind(end, error);
  if (!error) acceptor_.listen(64, error);
  if (error) return wrong(error.message());
  port_ = acceptor_.local_endpoint().port();
  accept();
  tick();
  thread_ = std::thread([this] { run(); });
  return Done{};
}

void ServerWorks::run() {
  yield_to_the_show();
  context_.run();
}

void ServerWorks::accept() {
  acceptor_.async_accept([this](Error error, Tcp::socket socket) {
    if (ends_) return;
    if (!error) {
      take(std::move(socket));
      return accept();
    }
    pause_.expires_after(kPause);
    pause_.async_wait([this](Error stopped) {
      if (!stopped && !ends_) accept();
    });
  });
}

void ServerWorks::take(Tcp::socket socket) {
  Error error;
  const auto end = socket.remote_endpoint(error);
  if (error) return;
  const std::string from = end.address().to_string();
  const auto there = connections_.find(from);
  const std::size_t of_it = there == connections_.end() ? 0 : there->second;
  if (connected_ >= ConsoleServer::kMostConnections ||
      (!end.address().is_loopback() && of_it >= ConsoleServer::kMostOfOneAddress)) {
    return refused(from, "connection", "closed: there are too many");
  }
  socket.set_option(Tcp::no_delay(true), error);
  auto admission = std::make_shared<Admission>(*this, Caller{from, is_stranger(socket)});
  std::make_shared<HttpConnection>(*this, std::move(socket), std::move(admission))->read();
}

bool ServerWorks::is_stranger(Tcp::socket& socket) const {
  if (settings_.rules.needs_token) return false;  // nobody is trusted for where she is
  const auto owner = settings_.owner_of(socket.native_handle());
  return !owner || (*owner != ::geteuid() && *owner != 0);
}

void ServerWorks::tick() {
  ticker_.expires_after(kTick);
  ticker_.async_wait([this](Error stopped) {
    if (stopped || ends_) return;
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

void ServerWorks::end() {
  ends_ = true;
  Error error;
  acceptor_.close(error);
  ticker_.cancel();
  askers_.clear();
  for (const auto& [id, socket] : sockets_) socket->close(Room::kGoingAway, "the run has ended");
  if (sockets_.empty()) return context_.stop();
  pause_.expires_after(kFarewell);
  pause_.async_wait([this](Error) { context_.stop(); });
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
  if (!ends_) room_.leave(who);
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

template <class Work>
void ServerWorks::post(Work work) {
  if (posted_.fetch_add(1, std::memory_order_relaxed) >= kMostPosted) {
    posted_.fetch_sub(1, std::memory_order_relaxed);
    return;
  }
  asio::post(context_, [this, work = std::move(work)]() mutable {
    posted_.fetch_sub(1, std::memory_order_relaxed);
    if (!ends_) work();
  });
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

void ConsoleServer::told(const RunEvent& event) {
  works_->post([this, event] { works_->room().told(event); });
}

std::vector<std::size_t> ConsoleServer::looks_wanted() { return works_->looks_wanted(); }

void ConsoleServer::take_looks(std::size_t k, Letter looks) {
  works_->post([this, k, looks = std::move(looks)] { works_->take_looks(k, looks); });
}

}  // namespace footlight::app
