// SPDX-License-Identifier: Apache-2.0
#include "app/console/http_server.hpp"

#include <fmt/format.h>

#include "app/console/http_connection.hpp"
#include "app/live/waiting.hpp"
#include "core/check.hpp"

namespace footlight::app {
namespace {

namespace asio = boost::asio;
using Error = boost::system::error_code;

constexpr auto kPause = std::chrono::milliseconds(100);     // when the system has no more files to give
constexpr auto kFarewell = std::chrono::milliseconds(300);  // for those who are connected when it ends
constexpr int kBacklog = 1024;                              // a house full of phones comes back at once

}  // namespace

HttpServer::Admission::Admission(HttpServer& server, Caller caller) : server_(server), caller_(std::move(caller)) {
  ++server_.connected_;
  ++server_.connections_[caller_.from];
}

HttpServer::Admission::~Admission() {
  --server_.connected_;
  const auto found = server_.connections_.find(caller_.from);
  if (--found->second == 0) server_.connections_.erase(found);
}

HttpServer::HttpServer(Limits limits) : limits_(limits) {}
HttpServer::~HttpServer() { FL_CHECK(!thread_.joinable()); }

Status<> HttpServer::listen(const std::string& what, const std::string& address, std::uint16_t port) {
  const auto wrong = [&](const std::string& why) {
    return input_error(fmt::format("{} {}:{}: {}", what, address, port, why));
  };
  Error error;
  const auto numeric = asio::ip::make_address(address, error);
  if (error) return wrong("no numeric address");
  const Tcp::endpoint end(numeric, port);
  Tcp::acceptor& acceptor = loop_->acceptor;
  acceptor.open(end.protocol(), error);
  if (!error) acceptor.set_option(Tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(end, error);
  if (!error) acceptor.listen(kBacklog, error);
  if (error) return wrong(error.message());
  port_ = acceptor.local_endpoint().port();
  begin();
  accept();
  thread_ = std::thread([this] { run(); });
  return Done{};
}

void HttpServer::run() {
  yield_to_the_show();
  loop_->context.run();
}

void HttpServer::accept() {
  loop_->acceptor.async_accept([this](Error error, Tcp::socket socket) {
    if (ends_) return;
    if (!error) {
      take(std::move(socket));
      return accept();
    }
    loop_->pause.expires_after(kPause);
    loop_->pause.async_wait([this](Error stopped) {
      if (!stopped && !ends_) accept();
    });
  });
}

void HttpServer::take(Tcp::socket socket) {
  Error error;
  const auto end = socket.remote_endpoint(error);
  if (error) return;
  const std::string from = end.address().to_string();
  const auto there = connections_.find(from);
  const std::size_t of_it = there == connections_.end() ? 0 : there->second;
  if (connected_ >= limits_.connections || (!end.address().is_loopback() && of_it >= limits_.of_one_address)) {
    return refused(from, "connection", "closed: there are too many");
  }
  socket.set_option(Tcp::no_delay(true), error);
  auto admission = std::make_shared<Admission>(*this, caller_of(socket, from));
  std::make_shared<HttpConnection>(*this, std::move(socket), std::move(admission))->read();
}

void HttpServer::end() {
  ends_ = true;
  Error error;
  loop_->acceptor.close(error);
  if (!say_farewell()) return loop_->context.stop();
  loop_->pause.expires_after(kFarewell);
  loop_->pause.async_wait([this](Error) { loop_->context.stop(); });
}

void HttpServer::stop() {
  if (thread_.joinable()) {
    asio::post(loop_->context, [this] { end(); });
    thread_.join();
  }
  loop_.reset();  // connections that are left take their leave while there is somebody to take it from
}

}  // namespace footlight::app
