// SPDX-License-Identifier: Apache-2.0
#include "app/console/web_socket.hpp"

#include <utility>

#include <boost/beast/core/buffers_to_string.hpp>

namespace footlight::app {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

constexpr auto kHandshake = std::chrono::seconds(5);
constexpr std::size_t kLongestReason = 120;  // RFC 6455, 5.5: a control frame has at most 125 bytes, two are the code

}  // namespace

WebSocket::WebSocket(HttpServer& server, beast::tcp_stream stream, std::shared_ptr<HttpServer::Admission> admission)
    : server_(server), admission_(std::move(admission)), stream_(std::move(stream)) {}

WebSocket::~WebSocket() {
  if (id_ != 0) server_.leave(id_);
}

void WebSocket::accept(Request request) {
  request_ = std::move(request);
  websocket::stream_base::timeout timeout{};
  timeout.handshake_timeout = kHandshake;
  timeout.idle_timeout = server_.limits().silent_for;
  timeout.keep_alive_pings = true;
  stream_.set_option(timeout);
  stream_.read_message_max(kLongestMessage);
  stream_.auto_fragment(false);  // what is written is in memory as a whole
  stream_.async_accept(request_, [self = shared_from_this()](Error error) {
    if (error) return;
    self->request_ = {};
    self->open_ = true;
    self->id_ = self->server_.enter(*self, self->admission_->caller());
    self->read();
  });
}

void WebSocket::read() {
  stream_.async_read(buffer_, [self = shared_from_this()](Error error, std::size_t) { self->on_read(error); });
}

void WebSocket::on_read(Error error) {
  if (error) {
    open_ = false;
    return;
  }
  if (closing_) {
    buffer_.clear();
    return read();  // until the other side has answered
  }
  if (!stream_.got_text()) {
    close(Room::kNotUnderstood, "text, not bytes");
    return read();
  }
  const std::string message = beast::buffers_to_string(buffer_.data());
  buffer_.clear();
  server_.heard(id_, message);
  read();
}

void WebSocket::send(const Letter& letter) {
  if (closing_ || !open_) return;
  if (letters_.size() >= server_.limits().letters) {
    // No farewell can reach who reads nothing.
    closing_ = true;
    server_.refused(admission_->caller().from, "reading", "cut off: too slow");
    beast::get_lowest_layer(stream_).close();
    return;
  }
  letters_.push_back(letter);
  pump();
}

void WebSocket::send_state(const Letter& letter) {
  if (closing_ || !open_) return;
  state_ = letter;
  pump();
}

void WebSocket::look_at_nodes() {
  if (closing_ || !open_ || server_.nodes() == nullptr) return;
  nodes_due_ = true;
  pump();
}

void WebSocket::pump() {
  if (writing_ || !open_) return;
  if (closing_) return say_goodbye();
  if (!letters_.empty()) {
    current_ = std::move(letters_.front());
    letters_.pop_front();
    return write(true);
  }
  if (state_) {
    current_ = std::exchange(state_, nullptr);
    return write(true);
  }
  if (!std::exchange(nodes_due_, false)) return;
  auto frame = nodes_.frame(*server_.nodes());
  if (!frame) return;
  current_ = std::make_shared<const std::string>(*std::move(frame));
  write(false);
}

void WebSocket::write(bool text) {
  writing_ = true;
  stream_.text(text);
  stream_.async_write(boost::asio::buffer(*current_), [self = shared_from_this()](Error error, std::size_t) {
    self->writing_ = false;
    if (error) {
      self->open_ = false;
      return;
    }
    self->pump();
  });
}

void WebSocket::close(std::uint16_t code, std::string_view why) {
  if (closing_) return;
  closing_ = true;
  letters_.clear();
  state_.reset();
  why = why.substr(0, kLongestReason);
  goodbye_ = {static_cast<websocket::close_code>(code), beast::string_view(why.data(), why.size())};
  if (open_ && !writing_) say_goodbye();
}

void WebSocket::say_goodbye() {
  open_ = false;
  stream_.async_close(goodbye_, [self = shared_from_this()](Error) {});
}

}  // namespace footlight::app
