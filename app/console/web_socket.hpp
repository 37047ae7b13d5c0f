// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "app/console/http_server.hpp"
#include "app/console/node_frame.hpp"

namespace footlight::app {

/// One client of the console. What it is too slow for does not pile up: a newer state replaces an older one, node
/// frames are made when they can leave, and who leaves too many letters unread is cut off.
class WebSocket : public std::enable_shared_from_this<WebSocket> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::string_body>;

  WebSocket(HttpServer& server, boost::beast::tcp_stream stream, std::shared_ptr<HttpServer::Admission> admission);
  ~WebSocket();
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  void accept(Request request);
  void send(const Letter& letter);
  void send_state(const Letter& letter);
  /// The nodes may have changed.
  void look_at_nodes();
  void close(std::uint16_t code, std::string_view why);

 private:
  using Error = boost::system::error_code;

  void read();
  void on_read(Error error);
  void pump();
  void write(bool text);
  void say_goodbye();

  HttpServer& server_;
  std::shared_ptr<HttpServer::Admission> admission_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  Request request_;
  boost::beast::flat_buffer buffer_;
  PersonId id_ = 0;
  std::deque<Letter> letters_;
  Letter state_;
  Letter current_;
  NodeNews nodes_;
  bool nodes_due_ = false;
  bool open_ = false;
  bool writing_ = false;
  bool closing_ = false;
  boost::beast::websocket::close_reason goodbye_;
};

}  // namespace footlight::app
