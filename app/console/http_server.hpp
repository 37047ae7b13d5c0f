// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include "app/console/embedded_files.hpp"
#include "app/console/request_rules.hpp"
#include "app/console/room.hpp"
#include "app/live/node_board.hpp"
#include "core/result.hpp"
#include "core/time.hpp"

namespace footlight::app {

class HttpConnection;
class WebSocket;

/// A server of HTTP and WebSockets: one thread of ordinary priority that owns all of its connections. What is served is
/// its heirs' affair; their members are for this thread alone, but for what is marked. An heir calls `stop` first of
/// all when it ends.
class HttpServer {
 public:
  using Tcp = boost::asio::ip::tcp;

  struct Limits {
    std::size_t connections = 128;
    std::size_t of_one_address = 32;  ///< that is not loopback
    std::size_t letters = 1024;       ///< unread by one client
    Duration headers_within = milliseconds(5000);
    Duration body_within = milliseconds(10'000);
    Duration silent_for = milliseconds(30'000);  ///< a WebSocket that does not even answer pings
  };

  /// Counts one connection as long as it lives.
  class Admission {
   public:
    Admission(HttpServer& server, Caller caller);
    ~Admission();
    Admission(const Admission&) = delete;
    Admission& operator=(const Admission&) = delete;
    [[nodiscard]] const Caller& caller() const { return caller_; }

   private:
    HttpServer& server_;
    Caller caller_;
  };

  explicit HttpServer(Limits limits);
  virtual ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Any thread, once; from here on it listens. @param what for messages: "console"  @param address numeric
  /// Errors (ErrorKind::input): the address is not one of this machine, or somebody else listens there.
  [[nodiscard]] Status<> listen(const std::string& what, const std::string& address, std::uint16_t port);
  /// Any thread.
  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Any thread: hands over; what is too much is lost.
  template <class Work>
  void post(Work work) {
    if (posted_.fetch_add(1, std::memory_order_relaxed) >= kMostPosted) {
      posted_.fetch_sub(1, std::memory_order_relaxed);
      return;
    }
    boost::asio::post(loop_->context, [this, work = std::move(work)]() mutable {
      posted_.fetch_sub(1, std::memory_order_relaxed);
      if (!ends_) work();
    });
  }

  // What connections ask.
  [[nodiscard]] const Limits& limits() const { return limits_; }
  [[nodiscard]] virtual Verdict judge(const AskedFor& asked) const = 0;
  /// A GET of a document, which is answered now or later.
  virtual void answer(const std::shared_ptr<HttpConnection>& connection, const Verdict& verdict) = 0;
  /// A POST with its whole body.
  virtual void take_body(HttpConnection& connection, const std::string& body) = 0;
  [[nodiscard]] virtual const EmbeddedFile* file(std::string_view path) const = 0;
  /// Somebody was turned away.
  virtual void refused(const std::string& from, const std::string& what, const std::string& why) = 0;
  virtual PersonId enter(WebSocket& socket, const Caller& caller) = 0;
  virtual void leave(PersonId who) = 0;
  virtual void heard(PersonId who, const std::string& message) = 0;
  /// Null: nothing is told of nodes.
  [[nodiscard]] virtual const NodeBoard* nodes() const { return nullptr; }

 protected:
  /// Ends the thread and all connections.
  void stop();
  [[nodiscard]] bool ends() const { return ends_; }
  /// For an heir's use.
  [[nodiscard]] boost::asio::steady_timer& ticker() { return loop_->ticker; }

  virtual Caller caller_of(Tcp::socket& socket, std::string from) = 0;
  /// Before anybody is let in.
  virtual void begin() {}
  /// Says goodbye to all. @return whether there is anybody to wait for
  virtual bool say_farewell() = 0;

 private:
  static constexpr int kMostPosted = 4096;

  struct Loop {
    boost::asio::io_context context{1};
    Tcp::acceptor acceptor{context};
    boost::asio::steady_timer pause{context};
    boost::asio::steady_timer ticker{context};
  };

  void run();
  void accept();
  void take(Tcp::socket socket);
  void end();

  Limits limits_;
  std::map<std::string, std::size_t> connections_;  ///< by address
  std::size_t connected_ = 0;
  std::atomic<int> posted_{0};
  std::uint16_t port_ = 0;
  bool ends_ = false;
  std::unique_ptr<Loop> loop_ = std::make_unique<Loop>();
  std::thread thread_;
};

}  // namespace footlight::app
