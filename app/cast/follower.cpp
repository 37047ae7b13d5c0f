// SPDX-License-Identifier: Apache-2.0
#include "app/cast/follower.hpp"

#include <algorithm>
#include <utility>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/live/waiting.hpp"

namespace footlight::app {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;
using Error = boost::system::error_code;

constexpr Duration kToConnect = milliseconds(5000);
constexpr Duration kToFetch = milliseconds(60'000);
constexpr Duration kFirstWait = milliseconds(250);
constexpr Duration kSlice = milliseconds(50);  // in which the end is seen
constexpr std::size_t kLongestMessage = std::size_t{4} << 20U;
constexpr unsigned kOk = 200;

}  // namespace

std::string DeskPlace::authority() const {
  const std::string name = host.find(':') == std::string::npos ? host : "[" + host + "]";
  return port == "80" ? name : name + ":" + port;
}

Result<DeskPlace> desk_place_from(const std::string& url) {
  const auto wrong = [&] {
    return input_error(
        fmt::format("\"{}\" is no desk to follow: the address that `footlight run --console` says, as "
                    "http://127.0.0.1:8440",
                    url));
  };
  constexpr std::string_view kScheme = "http://";
  if (!url.starts_with(kScheme)) return wrong();
  std::string rest = url.substr(kScheme.size());
  if (rest.ends_with('/')) rest.pop_back();
  DeskPlace out;
  const std::size_t end = rest.starts_with('[') ? rest.find(']') : std::string::npos;
  const std::size_t colon = rest.find(':', end == std::string::npos ? 0 : end);
  if (colon != std::string::npos) {
    out.port = rest.substr(colon + 1);
    rest.resize(colon);
  }
  if (end != std::string::npos && rest.size() > 2) rest = rest.substr(1, rest.size() - 2);
  out.host = rest;
  const bool number = !out.port.empty() && out.port.size() <= 5 &&
                      std::all_of(out.port.begin(), out.port.end(), [](char c) { return c >= '0' && c <= '9'; });
  const bool named = !out.host.empty() && std::none_of(out.host.begin(), out.host.end(), [](unsigned char c) {
    return c <= ' ' || c == '/' || c == '@' || c == '?' || c == '#' || c >= 0x7f;
  });
  if (!number || !named || std::stoi(out.port) > 65535) return wrong();
  return out;
}

/// One connection. Every wait has an end, and sees the follower's.
class Follower::Line {
 public:
  Line(const Settings& settings, const std::atomic<bool>& stop) : settings_(settings), stop_(stop) {}

  /// @return why not
  std::optional<std::string> open() {
    Tcp::socket& socket = beast::get_lowest_layer(socket_);
    if (auto why = connect(socket)) return why;
    socket.set_option(Tcp::no_delay(true), error_);
    socket_.set_option(websocket::stream_base::decorator([this](websocket::request_type& request) {
      request.set(http::field::origin, "http://" + settings_.desk.authority());
    }));
    socket_.read_message_max(kLongestMessage);
    const bool in = complete(socket, kToConnect, [&](auto done) {
      socket_.async_handshake(settings_.desk.authority(), "/ws", [done](Error error) { done(error); });
    });
    if (!in) return "no console answers there: " + error_.message();
    nlohmann::json hello{{"name", "cast"}, {"role", "view"}};
    if (!settings_.token.empty()) hello["token"] = settings_.token;
    const std::string text = nlohmann::json{{"hello", hello}}.dump();
    socket_.text(true);
    const bool said = complete(socket, kToConnect, [&](auto done) {
      socket_.async_write(asio::buffer(text), [done](Error error, std::size_t) { done(error); });
    });
    return said ? std::nullopt : std::optional("it hung up: " + error_.message());
  }

  /// The next message; nothing: it is gone.
  std::optional<std::string> next() {
    beast::flat_buffer buffer;
    const bool came = complete(beast::get_lowest_layer(socket_), settings_.silence, [&](auto done) {
      socket_.async_read(buffer, [done](Error error, std::size_t) { done(error); });
    });
    if (!came) return std::nullopt;
    return socket_.got_text() ? beast::buffers_to_string(buffer.data()) : std::string();
  }
  [[nodiscard]] std::string why() const {
    const auto& reason = socket_.reason();
    if (reason.code != websocket::close_code::none && reason.reason.size() > 0) {
      return std::string(reason.reason.data(), reason.reason.size());
    }
    return error_ ? error_.message() : "it says nothing";
  }

  struct Fetched {
    unsigned status = 0;  ///< 0: no answer
    std::string bytes;
  };
  /// A document, by a connection of its own.
  Fetched fetch(const std::string& target) {
    Tcp::socket socket(context_);
    if (connect(socket)) return {};
    http::request<http::empty_body> request(http::verb::get, target, 11);
    request.set(http::field::host, settings_.desk.authority());
    if (!settings_.token.empty()) request.set(http::field::authorization, "Bearer " + settings_.token);
    request.set(http::field::connection, "close");
    http::response_parser<http::string_body> parser;
    parser.body_limit(settings_.most_bytes);
    beast::flat_buffer buffer;
    const bool sent = complete(socket, kToConnect, [&](auto done) {
      http::async_write(socket, request, [done](Error error, std::size_t) { done(error); });
    });
    const bool came = sent && complete(socket, kToFetch, [&](auto done) {
                        http::async_read(socket, buffer, parser, [done](Error error, std::size_t) { done(error); });
                      });
    if (!came) return {};
    return {parser.get().result_int(), std::move(parser.get().body())};
  }

 private:
  std::optional<std::string> connect(Tcp::socket& socket) {
    Tcp::resolver resolver(context_);
    const auto ends = resolver.resolve(settings_.desk.host, settings_.desk.port, error_);
    if (error_) return error_.message();
    const bool connected = complete(socket, kToConnect, [&](auto done) {
      asio::async_connect(socket, ends, [done](Error error, const Tcp::endpoint&) { done(error); });
    });
    return connected ? std::nullopt : std::optional(error_.message());
  }

  /// Runs one operation to its end, or cuts its socket off.
  template <class Begin>
  bool complete(Tcp::socket& socket, Duration within, Begin begin) {
    bool over = false;
    begin([&](Error error) {
      over = true;
      error_ = error;
    });
    const auto go_on = [&](Duration time) {
      context_.restart();
      context_.run_for(time);
    };
    for (Duration left = within; !over && left.count() > 0 && !stop_; left -= kSlice) go_on(kSlice);
    if (over) return !error_;
    Error ignored;
    socket.close(ignored);
    while (!over) go_on(kSlice);  // what was begun has to end before its memory does
    error_ = asio::error::timed_out;
    return false;
  }

  const Settings& settings_;
  const std::atomic<bool>& stop_;
  asio::io_context context_{1};
  websocket::stream<Tcp::socket> socket_{context_};
  Error error_;
};

Follower::Follower(Settings settings, Listener listener, const Clock& clock)
    : settings_(std::move(settings)), listener_(std::move(listener)), clock_(clock), thread_([this] { run(); }) {}

Follower::~Follower() {
  stop_ = true;
  thread_.join();
}

void Follower::run() {
  yield_to_the_show();
  Duration wait = kFirstWait;
  while (!stop_) {
    Line line(settings_, stop_);
    auto why = line.open();
    if (!why) {
      if (follow(line)) wait = kFirstWait;
      why = line.why();
    }
    if (stop_) return;
    listener_.lost(*why);
    for (Duration left = wait; left.count() > 0 && !stop_; left -= kSlice) std::this_thread::sleep_for(kSlice);
    wait = std::min(2 * wait, settings_.longest_wait);
  }
}

/// @return whether the desk has let it in
bool Follower::follow(Line& line) {
  std::optional<DeskMessage::Welcome> welcome;
  bool plan_due = false;
  std::optional<std::string> way;
  std::optional<DeskWord::Loop> way_between;
  while (auto text = line.next()) {
    const DeskMessage message = desk_message_from(*text);
    if (message.welcome) welcome = message.welcome;
    if (message.plan && welcome) welcome->plan = *message.plan;
    plan_due = plan_due || message.welcome || message.epoch;
    if (plan_due && welcome) {
      const auto fetched = line.fetch("/api/plan.bin");
      plan_due = fetched.status != kOk;  // a run that has only begun has none yet
      if (!plan_due) listener_.plan(fetched.bytes, welcome->plan);
    }
    if (!message.state || plan_due || !welcome) continue;
    const DeskWord& word = *message.state;
    if (!word.way && way) {
      way.reset();
      listener_.way(way, word);
    } else if (word.way && (!way || (word.way_between && word.way_between != way_between))) {
      const auto fetched = line.fetch("/api/way.bin");
      way_between = word.way_between;
      if (fetched.status == kOk && (!way || *way != fetched.bytes)) {
        way = fetched.bytes;
        listener_.way(way, word);
      }
    }
    listener_.word(word, clock_.now());
  }
  return welcome.has_value();
}

}  // namespace footlight::app
