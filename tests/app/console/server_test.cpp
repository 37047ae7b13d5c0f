// SPDX-License-Identifier: Apache-2.0
#include "app/console/server.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/app/console/raw_client.hpp"
#include "tests/support/mutated.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using tests::RawClient;

class ServerTest : public ::testing::Test {
 protected:
  void open(ConsoleServer::Settings settings = {}) {
    settings.rules.local_names = {"localhost"};
    settings.about = {"0.1", "run1", "abc", 1};
    settings.nodes = &board_;
    auto server = ConsoleServer::open(std::move(settings), orders_, audit_.get(), clock_);
    ASSERT_TRUE(server) << server.error().message;
    server_ = std::move(server).value();
    server_->take_show(1, "abc", std::make_shared<const std::string>(R"({"title":"t"})"),
                       std::make_shared<const std::string>("FLPMplan"));
    server_->state(R"({"state":{"phase":"stands"}})", "1");
  }
  [[nodiscard]] RawClient client() const { return RawClient(server_->port()); }
  /// A WebSocket that has said hello.
  [[nodiscard]] std::unique_ptr<RawClient> person(const std::string& name, const std::string& token = "") const {
    auto one = std::make_unique<RawClient>(server_->port());
    EXPECT_TRUE(one->open());
    one->say(R"({"hello":{"name":")" + name + R"(","token":")" + token + "\"}}");
    EXPECT_THAT(one->heard("welcome"), HasSubstr("run1"));
    return one;
  }
  /// The answer to a request on a connection of its own.
  [[nodiscard]] std::string answer(const std::string& request) const {
    RawClient one = client();
    one.send(request);
    return one.response();
  }
  [[nodiscard]] std::string post(const std::string& body, const std::string& more) const {
    const std::string host = client().host();
    return answer("POST /api/pair HTTP/1.1\r\nHost: " + host + "\r\nOrigin: http://" + host +
                  "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" + more + "\r\n" + body);
  }
  static constexpr const char* kHeaders = "Content-Type: application/json\r\nX-Footlight: 1\r\n";

  test::TemporaryFolder folder_;
  SteadyClock clock_;
  NodeBoard board_{100'000 / 32};
  OrderBox orders_;
  std::unique_ptr<AuditLog> audit_ = AuditLog::open(folder_ / "console.log").value();
  std::unique_ptr<ConsoleServer> server_;
};

TEST_F(ServerTest, ThePageAndTheDocumentsAreServedWithEveryHeaderThatGuardsThem) {
  open();
  RawClient one = client();
  for (const char* target : {"/", "/app.js", "/app.css", "/api/show", "/api/plan.bin"}) {
    one.send(one.get(target));
    const std::string response = one.response();
    EXPECT_THAT(response, StartsWith("HTTP/1.1 200 OK\r\n")) << target;
    for (const char* header :
         {"Content-Security-Policy: default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
          "object-src 'none'\r\n",
          "X-Content-Type-Options: nosniff\r\n", "Referrer-Policy: no-referrer\r\n",
          "Cross-Origin-Resource-Policy: same-origin\r\n"}) {
      EXPECT_THAT(response, HasSubstr(header)) << target;
    }
    EXPECT_THAT(response, Not(HasSubstr("Access-Control"))) << target;
    EXPECT_THAT(response, Not(HasSubstr("Set-Cookie"))) << target;
  }
  one.send(one.get("/api/show"));
  EXPECT_THAT(one.response(), HasSubstr("\r\n\r\n{\"title\":\"t\"}")) << "one connection serves again and again";
  one.send(one.get("/api/plan.bin"));
  EXPECT_THAT(one.response(), HasSubstr("Cache-Control: no-store"));
  EXPECT_THAT(answer(client().get("/api/way.bin")), StartsWith("HTTP/1.1 404 "));
}

TEST_F(ServerTest, ARunThatHasOnlyBegunSaysSo) {
  auto server = ConsoleServer::open({}, orders_, nullptr, clock_);
  ASSERT_TRUE(server);
  RawClient one(server.value()->port());
  one.send(one.get("/api/show"));
  EXPECT_THAT(one.response(), AllOf(StartsWith("HTTP/1.1 503 "), HasSubstr("the run has only begun: ask again")));
}

TEST_F(ServerTest, ThePageIsNotSentAgainToWhoHasIt) {
  open();
  const std::string first = answer(client().get("/app.js"));
  const std::size_t at = first.find("ETag: ");
  ASSERT_NE(at, std::string::npos);
  const std::string etag = first.substr(at + 6, first.find("\r\n", at) - at - 6);
  const std::string again = answer(client().get("/app.js", "If-None-Match: " + etag + "\r\n"));
  EXPECT_THAT(again, StartsWith("HTTP/1.1 304 "));
  EXPECT_TRUE(again.ends_with("\r\n\r\n"));
}

TEST_F(ServerTest, WhatIsForbiddenIsRefusedOverTheWire) {
  open();
  const std::string host = client().host();
  const std::string ok = "Host: " + host + "\r\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"GET /api/show HTTP/1.1\r\nHost: evil.example\r\n\r\n", "421 "},
      {"GET /api/show HTTP/1.1\r\n\r\n", "421 "},
      {"GET /api/show HTTP/1.1\r\n" + ok + ok + "\r\n", "421 "},
      {"GET /api/show HTTP/1.1\r\n" + ok + "Origin: http://evil.example\r\n\r\n", "403 "},
      {client().upgrade("Origin: http://evil.example\r\n"), "403 "},
      {"GET /ws HTTP/1.1\r\n" + ok +
           "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
       "403 "},
      {"GET /ws HTTP/1.1\r\n" + ok + "Origin: http://" + host + "\r\n\r\n", "426 "},
      {"DELETE /api/show HTTP/1.1\r\n" + ok + "\r\n", "405 "},
      {"OPTIONS /api/pair HTTP/1.1\r\n" + ok + "Origin: http://" + host + "\r\n\r\n", "405 "},
      {"HEAD / HTTP/1.1\r\n" + ok + "\r\n", "405 "},
      {"GET /api/pair HTTP/1.1\r\n" + ok + "\r\n", "405 "},
      {"GET /../../etc/passwd HTTP/1.1\r\n" + ok + "\r\n", "404 "},
      {"GET /%2e%2e/%2e%2e/etc/passwd HTTP/1.1\r\n" + ok + "\r\n", "404 "},
      {"GET /api/show HTTP/1.1\r\n" + ok + "Content-Length: 5\r\n\r\nhello", "400 "},
      {"GET /api/show HTTP/1.1\r\n" + ok + "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n", "400 "},
      {"GET /api/show HTTP/1.1\r\n" + ok + "Content-Length: 1\r\nContent-Length: 2\r\n\r\n", "400 "},
      {"rubbish\r\n\r\n", "400 "},
      {"GET /api/show HTTP/9.9\r\n" + ok + "\r\n", "400 "},
      {"GET /api/show HTTP/1.1\r\n" + ok +
           "X: a\x01"
           "b\r\n\r\n",
       "400 "},
      {"GET /api/show HTTP/1.1\r\n" + ok + "X: " + std::string(16 * 1024, 'a') + "\r\n\r\n", "431 "},
      {"POST /api/pair HTTP/1.1\r\n" + ok + "Origin: http://" + host + "\r\n" + kHeaders +
           "Content-Length: 65537\r\n\r\n",
       "413 "},
      {"POST /api/pair HTTP/1.1\r\n" + ok + "Origin: http://" + host + "\r\n" + kHeaders +
           "Content-Length: 18446744073709551615\r\n\r\n",
       "413 "},
  };
  for (const auto& [request, status] : cases) {
    RawClient one = client();
    one.send(request);
    const std::string all = one.rest();
    EXPECT_THAT(all, StartsWith("HTTP/1.1 " + status)) << request.substr(0, 300);
    EXPECT_FALSE(one.timed_out()) << "the connection ends: " << request.substr(0, 300);
    EXPECT_THAT(all, HasSubstr("X-Content-Type-Options: nosniff")) << request.substr(0, 300);
  }
  EXPECT_TRUE(orders_.take(10).empty());
}

TEST_F(ServerTest, ABodyThatGrowsInChunksIsCutOff) {
  open();
  RawClient one = client();
  one.send("POST /api/pair HTTP/1.1\r\nHost: " + one.host() + "\r\nOrigin: http://" + one.host() + "\r\n" + kHeaders +
           "Transfer-Encoding: chunked\r\n\r\n");
  const std::string chunk = "4000\r\n" + std::string(0x4000, 'a') + "\r\n";
  for (int i = 0; i < 6; ++i) one.send(chunk);
  EXPECT_THAT(one.rest(), StartsWith("HTTP/1.1 413 "));
}

TEST_F(ServerTest, WhoDripsHeadersOrABodyIsCutOff) {
  ConsoleServer::Settings settings;
  settings.headers_within = milliseconds(300);
  settings.body_within = milliseconds(300);
  open(std::move(settings));
  RawClient silent = client();
  RawClient slow = client();
  RawClient half = client();
  half.send("POST /api/pair HTTP/1.1\r\nHost: " + half.host() + "\r\nOrigin: http://" + half.host() + "\r\n" +
            kHeaders + "Content-Length: 20\r\n\r\n{\"code\"");
  bool cut = false;
  const std::string request = slow.get("/api/show", "X-Long: " + std::string(4000, 'a') + "\r\n");
  for (std::size_t i = 0; i < request.size() && !cut; ++i) {
    cut = !slow.send(request.substr(i, 1));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_TRUE(cut) << "a byte at a time does not keep it open";
  EXPECT_EQ(silent.rest(), "");
  EXPECT_EQ(half.rest(), "");
  EXPECT_FALSE(silent.timed_out());
  EXPECT_FALSE(half.timed_out());
}

TEST_F(ServerTest, ThereAreAtMost128Connections) {
  open();
  std::vector<std::unique_ptr<RawClient>> many;
  for (std::size_t i = 0; i < ConsoleServer::kMostConnections; ++i) {
    many.push_back(std::make_unique<RawClient>(server_->port()));
    many.back()->send(many.back()->get("/api/show"));
    EXPECT_THAT(many.back()->response(), StartsWith("HTTP/1.1 200"));
  }
  RawClient more = client();
  more.send(more.get("/api/show"));
  EXPECT_EQ(more.rest(), "");
  EXPECT_FALSE(more.timed_out());
  many.resize(100);
  std::string answered;
  while (answered.empty()) answered = answer(client().get("/api/show"));
  EXPECT_THAT(answered, StartsWith("HTTP/1.1 200")) << "who leaves makes room";
}

TEST_F(ServerTest, OnAnotherAddressATokenIsAskedForAndAPhonePairsOnce) {
  ConsoleServer::Settings settings;
  settings.rules.needs_token = true;
  settings.rules.token = std::string(64, 'a');
  open(std::move(settings));
  EXPECT_THAT(answer(client().get("/api/show")), StartsWith("HTTP/1.1 401 "));
  EXPECT_THAT(answer(client().get("/api/show", "Authorization: Bearer " + std::string(64, 'b') + "\r\n")),
              StartsWith("HTTP/1.1 401 "));
  EXPECT_THAT(answer(client().get("/api/show?token=" + std::string(64, 'a'))), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(answer(client().get("/api/show", "Authorization: Bearer " + std::string(64, 'a') + "\r\n")),
              StartsWith("HTTP/1.1 200 "));
  RawClient stranger = client();
  ASSERT_TRUE(stranger.open());
  stranger.say(R"({"hello":{"name":"Eve"}})");
  EXPECT_EQ(stranger.farewell(), Room::kToken);
  const auto admin = person("Ana", std::string(64, 'a'));
  admin->say(R"({"pair":"operate"})");
  const auto code = nlohmann::json::parse(admin->heard("code"))["code"]["code"].get<std::string>();
  EXPECT_THAT(post(R"({"code":"x"})", kHeaders), StartsWith("HTTP/1.1 403 "));
  EXPECT_THAT(post("{\"code\":\"" + code + "\"}", "X-Footlight: 1\r\n"), StartsWith("HTTP/1.1 415 "));
  EXPECT_THAT(post("{\"code\":\"" + code + "\"}", "Content-Type: application/json\r\n"), StartsWith("HTTP/1.1 400 "));
  const std::string paired = post("{\"code\":\"" + code + "\"}", kHeaders);
  ASSERT_THAT(paired, StartsWith("HTTP/1.1 200 "));
  const auto json = nlohmann::json::parse(paired.substr(paired.find("\r\n\r\n") + 4));
  EXPECT_EQ(json["role"], "operate");
  EXPECT_THAT(post("{\"code\":\"" + code + "\"}", kHeaders), StartsWith("HTTP/1.1 403 ")) << "it is used up";
  const auto phone = person("Ben", json["token"].get<std::string>());
  phone->say(R"({"order":"hold","id":3})");
  while (orders_.take(1).empty()) std::this_thread::yield();
  server_.reset();
  audit_.reset();
  const std::string log = folder_.read("console.log");
  EXPECT_THAT(log, Not(HasSubstr(std::string(64, 'a')))) << "no token in the log";
  EXPECT_THAT(log, Not(HasSubstr(json["token"].get<std::string>())));
  EXPECT_THAT(log, HasSubstr(R"("who":"Ben","from":"127.0.0.1","role":"operate","what":"order hold")"));
}

TEST_F(ServerTest, AnotherUserOfThisMachineNeedsTheToken) {
  ConsoleServer::Settings settings;
  settings.rules.token = std::string(64, 'a');
  std::atomic<int> owner{-1};
  settings.owner_of = [&](int socket) {
    EXPECT_EQ(owner_of_peer(socket), ::geteuid()) << "the kernel knows who the test is";
    return owner < 0 ? std::nullopt : std::optional<uid_t>(owner.load());
  };
  open(std::move(settings));
  for (const int who : {-1, 65534}) {
    owner = who;
    if (::geteuid() == 65534) continue;
    EXPECT_THAT(answer(client().get("/api/show")), StartsWith("HTTP/1.1 401 ")) << who;
    RawClient stranger = client();
    ASSERT_TRUE(stranger.open());
    stranger.say(R"({"hello":{"name":"Eve"}})");
    EXPECT_EQ(stranger.farewell(), Room::kToken) << who;
    EXPECT_THAT(answer(client().get("/api/show", "Authorization: Bearer " + std::string(64, 'a') + "\r\n")),
                StartsWith("HTTP/1.1 200 "));
  }
  owner = 0;
  EXPECT_THAT(answer(client().get("/api/show")), StartsWith("HTTP/1.1 200 ")) << "root";
  owner = static_cast<int>(::geteuid());
  EXPECT_THAT(answer(client().get("/api/show")), StartsWith("HTTP/1.1 200 "));
}

TEST_F(ServerTest, AnOrderGoesToTheDeskAndItsAnswerBack) {
  open();
  const auto ana = person("Ana");
  const auto ben = person("Ben");
  ana->say(R"({"order":"tempo 80","id":9})");
  std::vector<SaidOrder> said;
  while (said.empty()) said = orders_.take(1);
  EXPECT_EQ(said[0].line, "tempo 80");
  RunEvent event{RunEvent::Kind::answer, "done"};
  event.order = said[0].line;
  event.who = {controller::GoSource::page, said[0].who, said[0].tag};
  server_->told(event);
  EXPECT_THAT(ana->heard("answer"), HasSubstr(R"("id":9)"));
  EXPECT_THAT(ben->heard("answer"), Not(HasSubstr(R"("id")")));
  server_->state(R"({"state":{"phase":"runs"}})", "1");
  EXPECT_EQ(ben->heard("runs"), R"({"state":{"phase":"runs"}})");
}

TEST_F(ServerTest, LooksComeFromWhoHasTheSchedule) {
  open();
  RawClient one = client();
  RawClient other = client();
  one.send(one.get("/api/looks/3.bin"));
  other.send(other.get("/api/looks/3.bin"));
  std::vector<std::size_t> wanted;
  while (wanted.empty()) wanted = server_->looks_wanted();
  EXPECT_EQ(wanted, std::vector<std::size_t>{3});
  server_->take_looks(3, std::make_shared<const std::string>("FLLKlooks"));
  EXPECT_THAT(one.response(), HasSubstr("\r\n\r\nFLLKlooks"));
  one.send(one.get("/api/looks/4.bin"));
  while (true) {
    wanted = server_->looks_wanted();
    for (const std::size_t k : wanted) server_->take_looks(k, nullptr);
    if (std::ranges::find(wanted, std::size_t{4}) != wanted.end()) break;
  }
  EXPECT_THAT(one.response(), StartsWith("HTTP/1.1 404 "));
}

TEST_F(ServerTest, NodesAreToldWholeThenAsTheyChange) {
  open();
  const auto ana = person("Ana");
  const auto frame = [&] {
    RawClient::Frame next = ana->next();
    while (next.kind == 1) next = ana->next();
    return next.payload;
  };
  EXPECT_EQ(frame().size(), 24U);
  board_.put(5, {1, NodeBoard::kRight});
  const std::string change = frame();
  ASSERT_EQ(change.size(), 24U);
  EXPECT_EQ(change[1], 0);
  EXPECT_EQ(change[8], 5);
}

TEST_F(ServerTest, FramesThatNoBrowserSendsEndTheConnection) {
  open();
  const std::string hello = RawClient::frame(R"({"hello":{"name":"Ana"}})");
  const std::vector<std::pair<std::string, std::vector<int>>> cases{
      {std::string("\x81\x05hello", 7), {1002}},                                      // not masked
      {std::string("\x91\x80\0\0\0\0", 6), {1002}},                                   // a reserved bit
      {std::string("\x83\x80\0\0\0\0", 6), {1002}},                                   // a reserved kind
      {std::string("\x80\x80\0\0\0\0", 6), {1002}},                                   // goes on with nothing
      {std::string("\x89\xfe\x01\0\0\0\0\0", 8), {1002}},                             // a ping of 256 bytes
      {std::string("\x09\x80\0\0\0\0", 6), {1002}},                                   // a ping in pieces
      {RawClient::frame("\xff\xfe"), {1007}},                                         // not UTF-8
      {RawClient::frame(std::string(5000, 'a')), {1009}},                             // too long
      {std::string("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14), {1009}},  // 2^63 - 1 bytes to come
      {std::string("\x81\xff\xff\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14), {1002, 1009}},
      {hello + RawClient::frame("\x01\x02", '\x82'), {Room::kNotUnderstood}},  // bytes
      {hello + RawClient::frame("{"), {Room::kNotUnderstood}},
      {RawClient::frame(R"({"order":"go"})"), {Room::kNotUnderstood}},  // no hello
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    RawClient one = client();
    ASSERT_TRUE(one.open());
    one.send(cases[i].first);
    EXPECT_THAT(cases[i].second, testing::Contains(one.farewell())) << i;
    EXPECT_FALSE(one.timed_out()) << i;
  }
  EXPECT_TRUE(orders_.take(10).empty());
  EXPECT_THAT(answer(client().get("/api/show")), StartsWith("HTTP/1.1 200")) << "it serves on";
}

TEST_F(ServerTest, AMessageInPiecesIsBoundedAsAWhole) {
  open();
  RawClient one = client();
  ASSERT_TRUE(one.open());
  one.send(RawClient::frame(std::string(3000, ' '), '\x01'));
  one.send(RawClient::frame(std::string(3000, ' '), '\x80'));
  EXPECT_EQ(one.farewell(), 1009);
}

TEST_F(ServerTest, WhoReadsNothingIsCutOffAndDelaysNobody) {
  open();
  const auto slow = person("Slow");
  const auto quick = person("Quick");
  const std::string text(20'000, 'x');
  constexpr int kEvents = 3000;
  std::atomic<int> heard{0};
  std::atomic<bool> ended{false};
  std::thread reader([&] {
    while (heard < kEvents && !quick->heard("note").empty()) ++heard;
    ended = true;
  });
  for (int i = 0; i < kEvents; ++i) {
    server_->told({RunEvent::Kind::note, text});
    while (i - heard.load() > 200 && !ended) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  reader.join();
  EXPECT_EQ(heard.load(), kEvents);
  std::string last = "x";
  while (!last.empty()) last = slow->heard("note");
  EXPECT_FALSE(slow->timed_out()) << "it has been cut off";
}

TEST_F(ServerTest, TheEndOfTheRunIsToldToAll) {
  open();
  const auto ana = person("Ana");
  std::thread ends([&] { server_.reset(); });
  EXPECT_EQ(ana->farewell(), Room::kGoingAway);
  ends.join();
}

TEST_F(ServerTest, AnAddressThatIsTakenOrNotOursIsRefused) {
  open();
  ConsoleServer::Settings settings;
  settings.port = server_->port();
  const auto second = ConsoleServer::open(settings, orders_, nullptr, clock_);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().message, "console 127.0.0.1:" + std::to_string(settings.port) + ": Address already in use");
  settings.address = "192.0.2.1";
  EXPECT_EQ(ConsoleServer::open(settings, orders_, nullptr, clock_).error().message,
            "console 192.0.2.1:" + std::to_string(settings.port) + ": Cannot assign requested address");
}

TEST_F(ServerTest, NoMutationOfARequestOrAFrameDoesHarm) {
  ConsoleServer::Settings settings;
  settings.headers_within = milliseconds(20);
  settings.body_within = milliseconds(20);
  open(std::move(settings));
  const std::string host = client().host();
  const std::array<std::string, 3> seeds{
      client().get("/api/show", "Accept: */*\r\nConnection: close\r\n"),
      "POST /api/pair HTTP/1.1\r\nHost: " + host + "\r\nOrigin: http://" + host + "\r\n" + kHeaders +
          "Connection: close\r\nContent-Length: 19\r\n\r\n{\"code\":\"12345678\"}",
      RawClient::frame(R"({"hello":{"name":"Ana"}})") + RawClient::frame(R"({"ping":1})") +
          std::string("\x88\x82\0\0\0\0\x03\xe8", 8)};
  int answered = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const std::size_t kind = seed % seeds.size();
    RawClient one = client();
    if (kind == 2 && !one.open()) continue;
    one.send(test::mutated(seeds[kind], Rng(seed), "\r\n: /\x00\x7f\xff"));
    if (kind == 2) continue;  // gone before it is answered
    answered += one.rest().starts_with("HTTP/1.1 ") ? 1 : 0;
    EXPECT_FALSE(one.timed_out()) << seed;
  }
  EXPECT_GT(answered, 200);
  EXPECT_TRUE(orders_.take(10).empty()) << "no mutation becomes an order";
  EXPECT_THAT(answer(client().get("/api/show")), AnyOf(StartsWith("HTTP/1.1 200"), "")) << "it serves on";
}

}  // namespace
}  // namespace footlight::app
