// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "app/console/server.hpp"

namespace footlight::app {

class HttpConnection;
class WebSocket;

/// What the thread of the server owns. Only it is allowed in, but for what is marked.
class ServerWorks final : public Mailer {
 public:
  using Tcp = boost::asio::ip::tcp;

  /// Counts one connection as long as it lives.
  class Admission {
   public:
    Admission(ServerWorks& works, Caller caller);
    ~Admission();
    Admission(const Admission&) = delete;
    Admission& operator=(const Admission&) = delete;
    [[nodiscard]] const Caller& caller() const { return caller_; }

   private:
    ServerWorks& works_;
    Caller caller_;
  };

  ServerWorks(ConsoleServer::Settings settings, OrderBox& orders, AuditLog* audit, const Clock& clock);
  ~ServerWorks() override;
  /// Any thread, once. Errors: as ConsoleServer::open.
  [[nodiscard]] Status<> listen();

  // Any thread.
  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Hands over; what is too much is lost.
  template <class Work>
  void post(Work work);
  [[nodiscard]] std::vector<std::size_t> looks_wanted();

  void send(PersonId to, const Letter& letter) override;
  void send_state(PersonId to, const Letter& letter) override;
  void close(PersonId who, std::uint16_t code, std::string_view why) override;

  PersonId enter(WebSocket& socket, const Caller& caller);
  void leave(PersonId who);
  void want_looks(std::size_t k, std::shared_ptr<HttpConnection> asker);
  void take_looks(std::size_t k, const Letter& looks);
  /// A flood of refusals does not fill the disk: what is too much is counted.
  void refused(const std::string& from, const std::string& what, const std::string& why);

  struct Documents {
    Letter show;
    Letter plan;
    Letter way;
  };
  Documents documents{};
  [[nodiscard]] const ConsoleServer::Settings& settings() const { return settings_; }
  [[nodiscard]] Room& room() { return room_; }
  [[nodiscard]] const Pairing& pairing() const { return pairing_; }

 private:
  static constexpr int kMostPosted = 4096;

  void run();
  void accept();
  void take(Tcp::socket socket);
  [[nodiscard]] bool is_stranger(Tcp::socket& socket) const;
  void tick();
  void end();

  ConsoleServer::Settings settings_;
  OrderBox& orders_;
  Pairing pairing_;
  Room room_;
  std::map<PersonId, WebSocket*> sockets_;
  std::map<std::string, std::size_t> connections_;  ///< by address
  std::size_t connected_ = 0;
  std::map<std::size_t, std::vector<std::shared_ptr<HttpConnection>>> askers_;
  Allowance refusals_{100, 5};
  std::uint64_t unlogged_ = 0;
  const Clock& clock_;
  std::mutex wanted_mutex_;
  std::vector<std::size_t> wanted_;
  std::atomic<int> posted_{0};
  std::uint64_t ticks_ = 0;
  std::uint16_t port_ = 0;
  bool ends_ = false;
  boost::asio::io_context context_{1};
  Tcp::acceptor acceptor_{context_};
  boost::asio::steady_timer ticker_{context_};
  boost::asio::steady_timer pause_{context_};
  std::thread thread_;
};

}  // namespace footlight::app
