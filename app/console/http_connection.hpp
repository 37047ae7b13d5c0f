// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "app/console/http_server.hpp"

namespace footlight::app {

/// One connection that speaks HTTP, until it ends or becomes a WebSocket.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(HttpServer& server, HttpServer::Tcp::socket socket, std::shared_ptr<HttpServer::Admission> admission);
  void read();
  [[nodiscard]] const Caller& caller() const { return admission_->caller(); }

  // Answers; one for each request.
  /// @param missing what to say where there is none  @param etag empty: it is never kept, else whoever has it already
  /// is told so
  void answer_document(const Letter& document, std::string_view type, int missing = 503, const std::string& etag = {});
  void take_looks(const Letter& looks);
  void refuse(int status, const std::string& why);
  /// It is answered later: nothing runs out until then.
  void wait_for_answer() { stream_.expires_never(); }

 private:
  using Error = boost::system::error_code;
  using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;
  using Response = boost::beast::http::response<boost::beast::http::span_body<const char>>;

  static constexpr std::size_t kHeaders = std::size_t{16} * 1024;
  static constexpr std::size_t kBody = std::size_t{64} * 1024;
  static constexpr int kMostRequests = 1000;  ///< of one connection

  void on_headers(Error error);
  void on_body(Error error);
  [[nodiscard]] AskedFor asked() const;
  void answer(const Verdict& verdict);
  void answer_page();
  void respond(int status, std::string_view type, std::string_view body, Letter owner, std::string_view etag = {});
  void on_written(Error error);
  void drain();
  void become_socket();

  HttpServer& server_;
  std::shared_ptr<HttpServer::Admission> admission_;
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_{kHeaders + 1024};
  std::optional<Parser> parser_;
  std::optional<Response> response_;
  Letter owner_;            ///< of the response's body
  std::string local_;       ///< AskedFor::local
  std::string local_port_;  ///< AskedFor::local_port
  int requests_ = 0;
  bool last_ = false;  ///< the connection ends behind this response
  std::size_t drained_ = 0;
  std::array<char, 4096> rest_{};
};

}  // namespace footlight::app
