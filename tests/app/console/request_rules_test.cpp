// SPDX-License-Identifier: Apache-2.0
#include "app/console/request_rules.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace footlight::app {
namespace {

class RequestRules : public ::testing::Test {
 protected:
  RequestRules() {
    rules_.hosts.add("Desk.example:8440");
    rules_.local_names = {"localhost"};
    asked_.host = "127.0.0.1:8440";
    asked_.local = "127.0.0.1";
    asked_.local_port = ":8440";
    asked_.target = "/api/show";
    own_ = asked_;
  }
  /// POST of a code as the page sends it.
  void make_post() {
    asked_.method = AskedFor::Method::post;
    asked_.target = "/api/pair";
    asked_.content_type = "application/json";
    asked_.footlight = "1";
    asked_.origin = "http://127.0.0.1:8440";
    asked_.origins = 1;
  }
  void make_socket() {
    asked_.target = "/ws";
    asked_.upgrade = true;
    asked_.origin = "http://127.0.0.1:8440";
    asked_.origins = 1;
  }
  [[nodiscard]] int status() const { return judge(asked_, rules_, pairing_).status; }

  ConsoleRules rules_;
  Pairing pairing_;
  AskedFor asked_;
  AskedFor own_;  ///< the page's own, for the show
};

TEST_F(RequestRules, WhatThePageAsksForIsAnswered) {
  EXPECT_EQ(status(), 200);
  for (const char* target : {"/", "/app.js", "/api/plan.bin", "/api/way.bin"}) {
    asked_.target = target;
    EXPECT_EQ(status(), 200) << target;
  }
  asked_.target = "/api/looks/12.bin";
  const Verdict verdict = judge(asked_, rules_, pairing_);
  EXPECT_EQ(verdict.route, Route::looks);
  EXPECT_EQ(verdict.number, 12U);
  make_socket();
  EXPECT_EQ(judge(asked_, rules_, pairing_).route, Route::socket);
  asked_.upgrade = false;
  make_post();
  EXPECT_EQ(judge(asked_, rules_, pairing_).route, Route::pair);
}

TEST_F(RequestRules, AHostThatIsNotOnTheListIsMisdirected) {
  for (const char* host :
       {"evil.example", "evil.example:8440", "127.0.0.1", "127.0.0.1:8441", "127.0.0.1:84400", "", "localhost",
        "localhost.evil.example:8440", "127.0.0.1:8440 ", ":8440", "xlocalhost:8440", "desk.example"}) {
    asked_.host = host;
    EXPECT_EQ(status(), 421) << host;
  }
  asked_.host = "127.0.0.1:8440";
  for (const int hosts : {0, 2}) {
    asked_.hosts = hosts;
    EXPECT_EQ(status(), 421) << hosts;
  }
  asked_.hosts = 1;
  for (const char* host : {"127.0.0.1:8440", "localhost:8440", "LOCALHOST:8440", "desk.EXAMPLE:8440"}) {
    asked_.host = host;
    EXPECT_EQ(status(), 200) << host;
  }
}

TEST_F(RequestRules, AtPort80BrowsersLeaveThePortOut) {
  asked_.local_port = "";
  asked_.host = "localhost";
  EXPECT_EQ(status(), 200);
  asked_.host = "127.0.0.1";
  EXPECT_EQ(status(), 200);
  asked_.host = "evil.example";
  EXPECT_EQ(status(), 421);
}

TEST_F(RequestRules, AStrangersPageMayNeitherChangeNorListen) {
  for (const bool socket : {false, true}) {
    asked_ = own_;
    socket ? make_socket() : make_post();
    EXPECT_EQ(status(), 200);
    for (const char* origin : {"http://evil.example", "https://evil.example:8440", "null", "", "127.0.0.1:8440",
                               "http://127.0.0.1:8440.evil.example", "http://evil.example#127.0.0.1:8440", "file://",
                               "http://127.0.0.1", "ftp://127.0.0.1:8440", "http://127.0.0.1:8440/"}) {
      asked_.origin = origin;
      EXPECT_EQ(status(), 403) << origin;
    }
    asked_.origin = "https://desk.example:8440";
    EXPECT_EQ(status(), 200);
    for (const int origins : {0, 2}) {
      asked_.origins = origins;
      EXPECT_EQ(status(), 403) << origins << " Origin lines";
    }
  }
}

TEST_F(RequestRules, AForeignOriginMayNotEvenRead) {
  asked_.origin = "http://evil.example";
  asked_.origins = 1;
  EXPECT_EQ(status(), 403);
}

TEST_F(RequestRules, NoGetChangesAnythingAndOtherMethodsAreRefused) {
  make_post();
  asked_.method = AskedFor::Method::get;
  EXPECT_EQ(status(), 405);
  for (const char* target : {"/", "/api/show", "/api/plan.bin", "/api/looks/0.bin", "/api/way.bin", "/ws"}) {
    asked_.target = target;
    for (const auto method : {AskedFor::Method::post, AskedFor::Method::other}) {
      asked_.method = method;
      EXPECT_EQ(status(), 405) << target;
    }
  }
}

TEST_F(RequestRules, APostSaysThatItIsJsonAndThatItMeansIt) {
  make_post();
  asked_.content_type = "application/json; charset=utf-8";
  EXPECT_EQ(status(), 200);
  for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data",
                           "application/jsonp", "text/plain; application/json"}) {
    asked_.content_type = type;
    EXPECT_EQ(status(), 415) << type;
  }
  asked_.content_type = "application/json";
  for (const char* value : {"", "0", "yes"}) {
    asked_.footlight = value;
    EXPECT_EQ(status(), 400) << value;
  }
}

TEST_F(RequestRules, WhereATokenIsNeededNothingOfTheShowIsToldWithoutOne) {
  rules_.needs_token = true;
  rules_.token = std::string(64, 'a');
  const std::string paired = [&] {
    const std::string code = pairing_.make(Role::view, kStart);
    return pairing_.redeem(code, kStart)->token;
  }();
  for (const char* target : {"/api/show", "/api/plan.bin", "/api/looks/0.bin", "/api/way.bin"}) {
    asked_.target = target;
    const std::vector<std::string> wrong{"",
                                         "Bearer",
                                         "Bearer ",
                                         "Basic " + rules_.token,
                                         rules_.token,
                                         "Bearer  " + rules_.token,
                                         "Bearer " + std::string(64, 'b')};
    for (const std::string& said : wrong) {
      asked_.authorization = said;
      EXPECT_EQ(status(), 401) << target << " " << said;
    }
    const std::string good = "Bearer " + rules_.token;
    asked_.authorization = good;
    EXPECT_EQ(status(), 200) << target;
    const std::string phone = "bearer " + paired;
    asked_.authorization = phone;
    EXPECT_EQ(status(), 200) << target;
  }
  asked_.authorization = "";
  asked_.target = "/app.js";
  EXPECT_EQ(status(), 200) << "the page tells nothing of the show";
}

TEST_F(RequestRules, ATokenInTheAddressIsNoToken) {
  rules_.needs_token = true;
  rules_.token = std::string(64, 'a');
  const std::string target = "/api/show?token=" + rules_.token;
  asked_.target = target;
  EXPECT_EQ(status(), 404);
}

TEST_F(RequestRules, RolesComeFromTokens) {
  EXPECT_EQ(role_of(rules_, pairing_, "", false), Role::admin) << "this machine alone";
  EXPECT_EQ(role_of(rules_, pairing_, "x", false), std::nullopt) << "whoever names a token means it";
  EXPECT_EQ(role_of(rules_, pairing_, "", true), std::nullopt) << "another user of this machine";
  rules_.needs_token = true;
  EXPECT_EQ(role_of(rules_, pairing_, "", false), std::nullopt);
  rules_.token = std::string(64, 'a');
  EXPECT_EQ(role_of(rules_, pairing_, "", false), std::nullopt);
  EXPECT_EQ(role_of(rules_, pairing_, rules_.token, false), Role::admin);
  EXPECT_EQ(role_of(rules_, pairing_, rules_.token, true), Role::admin);
  rules_.most = Role::view;
  EXPECT_EQ(role_of(rules_, pairing_, rules_.token, false), Role::view);
  const auto paired = pairing_.redeem(pairing_.make(Role::operate, kStart), kStart);
  ASSERT_TRUE(paired);
  EXPECT_EQ(role_of(rules_, pairing_, paired->token, false), Role::view);
}

TEST_F(RequestRules, AddressesThatAreNotPlainLeadNowhere) {
  const std::vector<std::string> targets{"",
                                         "*",
                                         "api/show",
                                         "/../etc/passwd",
                                         "/..",
                                         "/a/../b",
                                         "/%2e%2e/etc/passwd",
                                         "/.%2e/",
                                         "//etc/passwd",
                                         "/api//show",
                                         "/api/",
                                         "/api/nothing",
                                         "/api/looks/",
                                         "/api/looks/.bin",
                                         "/api/looks/-1.bin",
                                         "/api/looks/1",
                                         "/api/looks/1.bin/",
                                         "/api/looks/99999999999999999999.bin",
                                         "/api/looks/0x1.bin",
                                         "/api/looks/ 1.bin",
                                         "/api/show?x=1",
                                         "/api/show#x",
                                         "/a\\b",
                                         "http://127.0.0.1:8440/api/show",
                                         "/\xff",
                                         "/a;b",
                                         "/~root",
                                         std::string("/a\0b", 4)};
  for (const std::string& target : targets) {
    asked_.target = target;
    EXPECT_EQ(status(), 404) << target;
  }
  const std::string longest = "/" + std::string(1024, 'a');
  asked_.target = longest;
  EXPECT_EQ(status(), 414);
}

TEST_F(RequestRules, AWebSocketHasToBeOne) {
  make_socket();
  asked_.upgrade = false;
  EXPECT_EQ(status(), 426);
}

}  // namespace
}  // namespace footlight::app
