// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <unordered_map>

#include "app/cast/cast_room.hpp"
#include "app/cast/cast_server.hpp"
#include "app/cast/show_now.hpp"
#include "app/cast/way_finder.hpp"
#include "app/cast/worker.hpp"
#include "app/console/http_server.hpp"

namespace footlight::app {

/// What the thread of the cast's server owns. Only it is allowed in.
class CastWorks final : public HttpServer, public Mailer {
 public:
  CastWorks(CastServer::Settings settings, AuditLog* audit, const Clock& clock);
  ~CastWorks() override;

  void take_plan(std::shared_ptr<const CastPlan> cast, bool same);
  void take_word(const DeskWord& word, Instant came);
  void lost();
  void take_way(std::shared_ptr<const CastWay> way);

  void send(PersonId to, const Letter& letter) override;
  void send_state(PersonId to, const Letter& letter) override;
  void close(PersonId who, std::uint16_t code, std::string_view why) override;

  [[nodiscard]] Verdict judge(const AskedFor& asked) const override;
  void answer(const std::shared_ptr<HttpConnection>& connection, const Verdict& verdict) override;
  void take_body(HttpConnection& connection, const std::string& body) override;
  [[nodiscard]] const EmbeddedFile* file(std::string_view path) const override;
  void refused(const std::string& from, const std::string& what, const std::string& why) override;
  PersonId enter(WebSocket& socket, const Caller& caller) override;
  void leave(PersonId who) override;
  void heard(PersonId who, const std::string& message) override { room_.heard(who, message); }

 private:
  Caller caller_of(Tcp::socket&, std::string from) override { return {std::move(from), false}; }
  void begin() override { tick(); }
  bool say_farewell() override;
  void tick();
  void tell();
  [[nodiscard]] bool ask(PersonId who, const PhoneQuestion& question);
  /// What the worker says; only there.
  [[nodiscard]] std::string work_out(const std::shared_ptr<const CastPlan>& cast,
                                     const std::shared_ptr<const CastWay>& way, const PhoneQuestion& question,
                                     const WayFinder::Question& where);

  CastServer::Settings settings_;
  AuditLog* audit_;
  const Clock& clock_;
  ConsoleRules rules_;
  Pairing pairing_;  ///< of nobody: there is one code for all
  std::string code_;
  Allowance wrong_codes_{100, 20};
  Allowance refusals_{100, 5};
  CastRoom room_;
  std::unordered_map<PersonId, WebSocket*> sockets_;
  ShowNow now_;
  std::shared_ptr<const CastPlan> cast_;
  std::shared_ptr<const CastWay> way_;
  Letter show_;
  std::string show_etag_;
  Instant told_at_ = Instant::min();
  WayFinder finder_;  ///< the worker's
  Worker worker_;
};

}  // namespace footlight::app
