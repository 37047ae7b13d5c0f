// SPDX-License-Identifier: Apache-2.0
#include "app/cast/cast_server.hpp"

#include <cctype>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/cast/cast_files.hpp"
#include "app/cast/cast_works.hpp"
#include "app/console/client_message.hpp"
#include "app/console/http_connection.hpp"
#include "app/console/web_socket.hpp"
#include "core/secret.hpp"
#include "core/sha256.hpp"

namespace footlight::app {
namespace {

using Error = boost::system::error_code;
using About = PhoneQuestion::About;

constexpr auto kTick = std::chrono::milliseconds(250);
constexpr std::string_view kJson = "application/json";
constexpr std::size_t kMostQuestions = 512;  // waiting
constexpr std::size_t kMostUnread = 16;      // letters of one phone: a slow phone is not waited for

HttpServer::Limits limits_of(const CastServer::Settings& settings) {
  HttpServer::Limits limits;
  limits.connections = settings.most_phones;
  limits.letters = kMostUnread;
  limits.headers_within = settings.headers_within;
  limits.body_within = settings.body_within;
  limits.silent_for = settings.silent_for;
  return limits;
}

Letter letter(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

bool loopback(const std::string& address) { return address.starts_with("127.") || address == "::1"; }

}  // namespace

std::string join_code(const std::string& token) {
  constexpr std::string_view kDigits = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";  // Crockford's base 32
  constexpr std::size_t kLength = 10;
  const auto digest = Sha256().text("footlight cast code").text(token).digest();
  std::string code;
  for (std::size_t i = 0; i < kLength; ++i) code += kDigits[digest[i] % kDigits.size()];
  return code;
}

std::string code_as_meant(std::string_view typed) {
  std::string code;
  for (const char c : typed) {
    const auto big = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (c == ' ' || c == '-') continue;
    code += big == 'O' ? '0' : big == 'I' || big == 'L' ? '1' : big;
  }
  return code;
}

CastWorks::CastWorks(CastServer::Settings settings, AuditLog* audit, const Clock& clock)
    : HttpServer(limits_of(settings)),
      settings_(std::move(settings)),
      audit_(audit),
      clock_(clock),
      code_(join_code(settings_.token)),
      room_(*this, settings_.token, clock,
            [this](PersonId who, const PhoneQuestion& question) { return ask(who, question); }),
      worker_(kMostQuestions) {
  for (const std::string& host : settings_.hosts) rules_.hosts.add(host);
  if (loopback(settings_.address)) rules_.local_names = {"localhost"};
  rules_.needs_token = true;  // names are nobody else's business, wherever a phone, or a proxy, is
  rules_.token = settings_.token;
  rules_.most = Role::view;
  rules_.host_option = "--host";
}

CastWorks::~CastWorks() {
  worker_.end();  // it hands over to what stops now
  stop();
}

void CastWorks::tick() {
  ticker().expires_after(kTick);
  ticker().async_wait([this](Error stopped) {
    if (stopped || ends()) return;
    room_.tick();
    if (told_at_ == Instant::min() || clock_.now() - told_at_ >= settings_.heartbeat) tell();
    tick();
  });
}

bool CastWorks::say_farewell() {
  ticker().cancel();
  for (const auto& [id, socket] : sockets_) socket->close(Room::kGoingAway, "the cast's pages have ended");
  return !sockets_.empty();
}

void CastWorks::tell() {
  told_at_ = clock_.now();
  std::optional<double> stops_s;
  if (cast_) {
    const auto stops = stops_at(*cast_, now_.word(), instant_at(now_.position_s(told_at_)));
    if (stops) stops_s = to_seconds(*stops);
  }
  room_.state(letter(now_.json(told_at_, stops_s)));
}

void CastWorks::take_plan(std::shared_ptr<const CastPlan> cast, bool same) {
  if (cast != cast_) {
    cast_ = std::move(cast);
    show_ = letter(cast_->show_json());
    show_etag_ = "\"" + Sha256().text(*show_).hex() + "\"";
  }
  now_.take_plan(same);
  tell();
}

void CastWorks::take_word(const DeskWord& word, Instant came) {
  if (now_.take(word, came)) tell();
}

void CastWorks::lost() {
  if (now_.lost()) tell();
}

void CastWorks::take_way(std::shared_ptr<const CastWay> way) {
  way_ = std::move(way);
  if (now_.take_way(way_ != nullptr)) tell();
}

void CastWorks::send(PersonId to, const Letter& letter) {
  if (const auto found = sockets_.find(to); found != sockets_.end()) found->second->send(letter);
}

void CastWorks::send_state(PersonId to, const Letter& letter) {
  if (const auto found = sockets_.find(to); found != sockets_.end()) found->second->send_state(letter);
}

void CastWorks::close(PersonId who, std::uint16_t code, std::string_view why) {
  if (const auto found = sockets_.find(who); found != sockets_.end()) found->second->close(code, why);
}

PersonId CastWorks::enter(WebSocket& socket, const Caller&) {
  const PersonId id = room_.enter();
  sockets_[id] = &socket;
  return id;
}

void CastWorks::leave(PersonId who) {
  sockets_.erase(who);
  room_.leave(who);
}

void CastWorks::refused(const std::string& from, const std::string& what, const std::string& why) {
  if (audit_ == nullptr || !refusals_.take(clock_.now())) return;
  audit_->add({"", from, "", what, "refused: " + why});
}

const EmbeddedFile* CastWorks::file(std::string_view path) const { return cast_file(path); }

/// The console's rules; of its documents there is only the show.
Verdict CastWorks::judge(const AskedFor& asked) const {
  Verdict verdict = app::judge(asked, rules_, pairing_);
  const bool here = verdict.route == Route::page || verdict.route == Route::show || verdict.route == Route::pair ||
                    verdict.route == Route::socket;
  if (verdict.status < 400 && !here) return {404, "there is nothing here by that name"};
  return verdict;
}

void CastWorks::answer(const std::shared_ptr<HttpConnection>& connection, const Verdict&) {
  connection->answer_document(show_, kJson, 503, show_etag_);
}

void CastWorks::take_body(HttpConnection& connection, const std::string& body) {
  const auto code = code_from(body);
  if (!code) return connection.refuse(400, R"({"code": "K7MXQ-2TDRV"})");
  if (!same_secret(code_, code_as_meant(*code))) {
    // Whoever guesses is slowed down, and with her whoever types; a phone that is in stays in.
    const bool often = !wrong_codes_.take(clock_.now());
    return connection.refuse(
        often ? 429 : 403, often ? "too many wrong codes: try again in a minute" : "this is not the code of this cast");
  }
  connection.answer_document(letter(nlohmann::json{{"token", settings_.token}}.dump()), kJson);
}

bool CastWorks::ask(PersonId who, const PhoneQuestion& question) {
  const auto say = [&](std::string text) {
    send(who, letter(std::move(text)));
    return true;
  };
  if (!cast_ || question.who.at() >= cast_->plan().tracks.size()) return say(R"({"stale":true})");
  if (question.about == About::where && !now_.heard()) return say(R"({"where":{"kind":"not-heard"}})");
  if (question.about == About::where && !now_.same_plan()) return say(R"({"where":{"kind":"other-plan"}})");
  if (question.about == About::way && !way_) return say(R"({"stale":true})");
  const Instant position = instant_at(now_.position_s(clock_.now()));
  return worker_.add(
      [this, who, question, cast = cast_, way = way_,
       where = WayFinder::Question{question.who, question.cell, question.language, now_.word(), position}] {
        std::string text = work_out(cast, way, question, where);
        post([this, who, text = std::move(text)]() mutable { send(who, letter(std::move(text))); });
      });
}

std::string CastWorks::work_out(const std::shared_ptr<const CastPlan>& cast, const std::shared_ptr<const CastWay>& way,
                                const PhoneQuestion& question, const WayFinder::Question& where) {
  if (question.about == About::part) return R"({"part":)" + cast->part_json(question.who, question.language) + "}";
  if (question.about == About::where) return finder_.answer(cast, where);
  return fmt::format(
      R"({{"way":{{"who":{},"places":{}}}}})", question.who.value(),
      places_json(way->counted, cast->plan(), question.who, way->tracks.at(question.who.at()), question.language));
}

Result<std::unique_ptr<CastServer>> CastServer::open(Settings settings, AuditLog* audit, const Clock& clock) {
  const std::string address = settings.address;
  const std::uint16_t port = settings.port;
  auto works = std::make_unique<CastWorks>(std::move(settings), audit, clock);
  if (auto listening = works->listen("cast", address, port); !listening) return std::move(listening).error();
  return std::unique_ptr<CastServer>(new CastServer(std::move(works)));
}

CastServer::CastServer(std::unique_ptr<CastWorks> works) : works_(std::move(works)) {}
CastServer::~CastServer() = default;

std::uint16_t CastServer::port() const { return works_->port(); }

void CastServer::take_plan(std::shared_ptr<const CastPlan> cast, bool same) {
  works_->post([this, cast = std::move(cast), same] { works_->take_plan(cast, same); });
}
void CastServer::take_word(const DeskWord& word, Instant came) {
  works_->post([this, word, came] { works_->take_word(word, came); });
}
void CastServer::lost() {
  works_->post([this] { works_->lost(); });
}
void CastServer::take_way(std::shared_ptr<const CastWay> way) {
  works_->post([this, way = std::move(way)] { works_->take_way(way); });
}

}  // namespace footlight::app
