// SPDX-License-Identifier: Apache-2.0
#include "app/console/http_connection.hpp"

#include <utility>

#include <boost/beast/websocket/rfc6455.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/console/embedded_files.hpp"
#include "app/console/web_socket.hpp"

namespace footlight::app {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;

constexpr auto kToWrite = std::chrono::seconds(60);  // the largest document to the slowest client
constexpr auto kToDrain = std::chrono::seconds(1);
constexpr std::size_t kMostDrained = std::size_t{1} << 20U;

constexpr std::string_view kPolicy =
    "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; object-src 'none'";
constexpr std::string_view kJson = "application/json";
constexpr std::string_view kBytes = "application/octet-stream";

beast::string_view view(std::string_view text) { return {text.data(), text.size()}; }
std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

template <class Fields>
void add_headers(Fields& fields, bool document) {
  fields.set("Content-Security-Policy", view(kPolicy));
  fields.set("X-Content-Type-Options", "nosniff");
  fields.set("Referrer-Policy", "no-referrer");
  fields.set("Cross-Origin-Resource-Policy", "same-origin");
  fields.set("Cross-Origin-Opener-Policy", "same-origin");
  fields.set(http::field::cache_control, document ? "no-store" : "no-cache");
}

}  // namespace

HttpConnection::HttpConnection(HttpServer& server, HttpServer::Tcp::socket socket,
                               std::shared_ptr<HttpServer::Admission> admission)
    : server_(server), admission_(std::move(admission)), stream_(std::move(socket)) {
  boost::system::error_code error;
  const auto end = stream_.socket().local_endpoint(error);
  if (error) return;  // gone already
  local_ = end.address().is_v6() ? "[" + end.address().to_string() + "]" : end.address().to_string();
  if (end.port() != 80) local_port_ = fmt::format(":{}", end.port());
}

void HttpConnection::read() {
  parser_.emplace();
  parser_->header_limit(kHeaders);
  parser_->body_limit(kBody);
  stream_.expires_after(server_.limits().headers_within);  // for all of them, however they drip in
  http::async_read_header(stream_, buffer_, *parser_,
                          [self = shared_from_this()](Error error, std::size_t) { self->on_headers(error); });
}

AskedFor HttpConnection::asked() const {
  const auto& request = parser_->get();
  const auto field = [&](beast::string_view name) { return view(request[name]); };
  AskedFor asked;
  asked.method = request.method() == http::verb::get    ? AskedFor::Method::get
                 : request.method() == http::verb::post ? AskedFor::Method::post
                                                        : AskedFor::Method::other;
  asked.target = view(request.target());
  asked.host = field("Host");
  asked.hosts = static_cast<int>(request.count(http::field::host));
  asked.origin = field("Origin");
  asked.origins = static_cast<int>(request.count(http::field::origin));
  asked.authorization = field("Authorization");
  asked.content_type = field("Content-Type");
  asked.footlight = field("X-Footlight");
  asked.upgrade = beast::websocket::is_upgrade(request);
  asked.stranger = admission_->caller().stranger;
  asked.local = local_;
  asked.local_port = local_port_;
  return asked;
}

void HttpConnection::on_headers(Error error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return refuse(431, "at most 16 KiB of headers");
  }
  if (error == http::error::body_limit) return refuse(413, "at most 64 KiB of body");
  if (error && error.category() == http::make_error_code(http::error::bad_target).category() &&
      error != http::error::end_of_stream && error != http::error::partial_message) {
    return refuse(400, "this is not HTTP/1.1: " + error.message());
  }
  if (error) return;  // gone, or too slow
  const Verdict verdict = server_.judge(asked());
  if (verdict.status >= 400) return refuse(verdict.status, verdict.why);
  if (verdict.route == Route::pair) {
    stream_.expires_after(server_.limits().body_within);
    return http::async_read(stream_, buffer_, *parser_,
                            [self = shared_from_this()](Error failed, std::size_t) { self->on_body(failed); });
  }
  const auto length = parser_->content_length();
  if (parser_->chunked() || (length && *length > 0)) return refuse(400, "a GET has no body");
  answer(verdict);
}

void HttpConnection::answer(const Verdict& verdict) {
  switch (verdict.route) {
    case Route::page:
      return answer_page();
    case Route::socket:
      return become_socket();
    default:
      return server_.answer(shared_from_this(), verdict);
  }
}

void HttpConnection::on_body(Error error) {
  if (error == http::error::body_limit) return refuse(413, "at most 64 KiB of body");
  if (error) return;
  server_.take_body(*this, parser_->get().body());
}

void HttpConnection::answer_page() {
  const EmbeddedFile* file = server_.file(view(parser_->get().target()));
  if (file == nullptr) return refuse(404, "there is nothing here by that name");
  const std::string etag = fmt::format("\"{}\"", file->sha256);
  const bool known = view(parser_->get()[http::field::if_none_match]) == etag;
  respond(known ? 304 : 200, content_type_of(file->path), known ? std::string_view() : file->bytes, nullptr, etag);
}

void HttpConnection::answer_document(const Letter& document, std::string_view type, int missing,
                                     const std::string& etag) {
  if (!document) return refuse(missing, missing == 404 ? "there is none now" : "the run has only begun: ask again");
  const bool known = !etag.empty() && view(parser_->get()[http::field::if_none_match]) == etag;
  respond(known ? 304 : 200, type, known ? std::string_view() : *document, document, etag);
}

void HttpConnection::take_looks(const Letter& looks) {
  if (!looks) return refuse(404, "there is no such switch");
  answer_document(looks, kBytes);
}

void HttpConnection::refuse(int status, const std::string& why) {
  std::string what = "request";
  if (parser_->is_header_done()) {
    const auto target = view(parser_->get().target());
    what = fmt::format("{} {}", view(parser_->get().method_string()), target.substr(0, 200));
  }
  if (status != 404 && status != 503)
    server_.refused(admission_->caller().from, what, fmt::format("{} {}", status, why));
  last_ = true;
  const nlohmann::ordered_json json{{"error", why}};
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  const auto body = std::make_shared<const std::string>(json.dump(-1, ' ', false, kReplace));
  respond(status, kJson, *body, body);
}

void HttpConnection::respond(int status, std::string_view type, std::string_view body, Letter owner,
                             std::string_view etag) {
  ++requests_;
  last_ = last_ || !parser_->is_done() || !parser_->keep_alive() || requests_ >= kMostRequests;
  owner_ = std::move(owner);
  response_.emplace(static_cast<http::status>(status), 11);
  add_headers(*response_, etag.empty());
  response_->set(http::field::content_type, view(type));
  if (!etag.empty()) response_->set(http::field::etag, view(etag));
  if (status == 401) response_->set(http::field::www_authenticate, "Bearer");
  response_->body() = {body.data(), body.size()};
  response_->keep_alive(!last_);
  response_->prepare_payload();
  stream_.expires_after(kToWrite);
  http::async_write(stream_, *response_,
                    [self = shared_from_this()](Error error, std::size_t) { self->on_written(error); });
}

void HttpConnection::on_written(Error error) {
  if (error) return;
  response_.reset();
  owner_.reset();
  if (!last_) return read();
  // Whoever still sends would else never read why she was refused.
  stream_.socket().shutdown(HttpServer::Tcp::socket::shutdown_send, error);
  stream_.expires_after(kToDrain);
  drain();
}

void HttpConnection::drain() {
  stream_.async_read_some(boost::asio::buffer(rest_), [self = shared_from_this()](Error error, std::size_t bytes) {
    self->drained_ += bytes;
    if (!error && self->drained_ < kMostDrained) self->drain();
  });
}

void HttpConnection::become_socket() {
  stream_.expires_never();
  auto socket = std::make_shared<WebSocket>(server_, std::move(stream_), std::move(admission_));
  socket->accept(parser_->release());
}

}  // namespace footlight::app
