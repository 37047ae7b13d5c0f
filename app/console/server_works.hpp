// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "app/console/http_server.hpp"
#include "app/console/server.hpp"

namespace footlight::app {

/// What the console serves: its room, the documents of its show. Only the server's thread is allowed in, but for what
/// is marked.
class ServerWorks final : public HttpServer, public Mailer {
 public:
  ServerWorks(ConsoleServer::Settings settings, OrderBox& orders, AuditLog* audit, const Clock& clock);
  ~ServerWorks() override;
  /// Any thread, once. Errors: as ConsoleServer::open.
  [[nodiscard]] Status<> listen();
  /// Any thread.
  [[nodiscard]] std::vector<std::size_t> looks_wanted();

  void send(PersonId to, const Letter& letter) override;
  void send_state(PersonId to, const Letter& letter) override;
  void close(PersonId who, std::uint16_t code, std::string_view why) override;

  [[nodiscard]] Verdict judge(const AskedFor& asked) const override;
  void answer(const std::shared_ptr<HttpConnection>& connection, const Verdict& verdict) override;
  void take_body(HttpConnection& connection, const std::string& body) override;
  [[nodiscard]] const EmbeddedFile* file(std::string_view path) const override { return console_file(path); }
  /// A flood of refusals does not fill the disk: what is too much is counted.
  void refused(const std::string& from, const std::string& what, const std::string& why) override;
  PersonId enter(WebSocket& socket, const Caller& caller) override;
  void leave(PersonId who) override;
  void heard(PersonId who, const std::string& message) override { room_.heard(who, message); }
  [[nodiscard]] const NodeBoard* nodes() const override { return settings_.nodes; }

  void take_looks(std::size_t k, const Letter& looks);

  struct Documents {
    Letter show;
    Letter plan;
    Letter way;
  };
  Documents documents{};
  [[nodiscard]] Room& room() { return room_; }

 private:
  Caller caller_of(Tcp::socket& socket, std::string from) override;
  void begin() override { tick(); }
  bool say_farewell() override;
  void want_looks(std::size_t k, std::shared_ptr<HttpConnection> asker);
  [[nodiscard]] bool is_stranger(Tcp::socket& socket) const;
  void tick();

  ConsoleServer::Settings settings_;
  OrderBox& orders_;
  Pairing pairing_;
  Room room_;
  std::map<PersonId, WebSocket*> sockets_;
  std::map<std::size_t, std::vector<std::shared_ptr<HttpConnection>>> askers_;
  Allowance refusals_{100, 5};
  std::uint64_t unlogged_ = 0;
  const Clock& clock_;
  std::mutex wanted_mutex_;
  std::vector<std::size_t> wanted_;
  std::uint64_t ticks_ = 0;
};

}  // namespace footlight::app
