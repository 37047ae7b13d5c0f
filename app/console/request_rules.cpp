// SPDX-License-Identifier: Apache-2.0
#include "app/console/request_rules.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <utility>

#include "core/secret.hpp"

namespace footlight::app {
namespace {

using Method = AskedFor::Method;

constexpr std::size_t kLongestTarget = 1024;

Verdict refused(int status, std::string why) { return {status, std::move(why)}; }

bool same_word(std::string_view one, std::string_view other) {
  return std::ranges::equal(one, other,
                            [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
}

/// "application/json", with or without "; charset=utf-8".
bool is_json(std::string_view type) {
  type = type.substr(0, type.find(';'));
  while (!type.empty() && type.back() == ' ') type.remove_suffix(1);
  return same_word(type, "application/json");
}

std::string_view bearer(std::string_view authorization) {
  constexpr std::string_view kScheme = "Bearer ";
  if (authorization.size() < kScheme.size() || !same_word(authorization.substr(0, kScheme.size()), "bearer "))
    return {};
  return authorization.substr(kScheme.size());
}

/// "/api/looks/12.bin" -> 12
std::optional<std::size_t> looks_number(std::string_view path) {
  constexpr std::string_view kBefore = "/api/looks/";
  constexpr std::string_view kAfter = ".bin";
  if (!path.starts_with(kBefore) || !path.ends_with(kAfter) || path.size() <= kBefore.size() + kAfter.size()) return {};
  path.remove_prefix(kBefore.size());
  path.remove_suffix(kAfter.size());
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), number);
  if (error != std::errc() || end != path.data() + path.size()) return {};
  return number;
}

/// Only letters, digits and what names of files have: nothing is decoded, so nothing can be hidden.
bool plain(std::string_view path) {
  const auto good = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '/' || c == '.' || c == '-' || c == '_';
  };
  return path.starts_with('/') && std::ranges::all_of(path, good) && path.find("..") == std::string_view::npos &&
         path.find("//") == std::string_view::npos;
}

std::optional<Verdict> route_of(std::string_view path) {
  const auto go = [](Route route) { return Verdict{200, {}, route, 0}; };
  if (path == "/ws") return go(Route::socket);
  if (path == "/api/show") return go(Route::show);
  if (path == "/api/plan.bin") return go(Route::plan);
  if (path == "/api/way.bin") return go(Route::way);
  if (path == "/api/pair") return go(Route::pair);
  if (const auto number = looks_number(path)) return Verdict{200, {}, Route::looks, *number};
  if (path.starts_with("/api/")) return std::nullopt;
  return go(Route::page);  // which of its files there are, whoever serves them knows
}

bool knows_host(const AskedFor& asked, const ConsoleRules& rules, std::string_view host) {
  if (rules.hosts.has_host(host)) return true;
  if (asked.local.empty() || !host.ends_with(asked.local_port)) return false;
  const std::string_view name = host.substr(0, host.size() - asked.local_port.size());
  return same_word(name, asked.local) ||
         std::ranges::any_of(rules.local_names, [&](const std::string& one) { return same_word(name, one); });
}

bool knows_origin(const AskedFor& asked, const ConsoleRules& rules) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (asked.origin.starts_with(scheme)) return knows_host(asked, rules, asked.origin.substr(scheme.size()));
  }
  return false;
}

std::optional<Verdict> wrong_names(const AskedFor& asked, const ConsoleRules& rules, Route route) {
  if (asked.hosts != 1 || !knows_host(asked, rules, asked.host)) {
    return refused(421, "this console is not known by that Host; ask for it by its own address, or name it with " +
                            rules.host_option);
  }
  const bool needs_origin = asked.method == Method::post || route == Route::socket;
  // An Origin that is there has to be ours wherever it stands.
  if ((needs_origin && asked.origins != 1) || asked.origins > 1 ||
      (asked.origins == 1 && !knows_origin(asked, rules))) {
    return refused(403, "only the console's own page may do this (Origin)");
  }
  return std::nullopt;
}

std::optional<Verdict> wrong_method(const AskedFor& asked, Route route) {
  if (route == Route::pair) {
    if (asked.method != Method::post) return refused(405, "POST it");
    if (!is_json(asked.content_type)) return refused(415, "Content-Type: application/json");
    if (asked.footlight != "1") return refused(400, "X-Footlight: 1 is missing");
    return std::nullopt;
  }
  if (asked.method != Method::get) return refused(405, "GET it");
  if (route == Route::socket && !asked.upgrade) return refused(426, "this is a WebSocket");
  return std::nullopt;
}

}  // namespace

std::optional<Role> role_of(const ConsoleRules& rules, const Pairing& pairing, std::string_view token, bool stranger) {
  if (!rules.token.empty() && same_secret(rules.token, token)) return rules.most;
  if (const auto role = pairing.role_of(token)) return std::min(*role, rules.most);
  if (!rules.needs_token && !stranger && token.empty()) return rules.most;
  return std::nullopt;
}

Verdict judge(const AskedFor& asked, const ConsoleRules& rules, const Pairing& pairing) {
  if (asked.target.size() > kLongestTarget) return refused(414, "no address here is so long");
  const auto found = plain(asked.target) ? route_of(asked.target) : std::nullopt;
  const Route route = found ? found->route : Route::page;
  if (auto wrong = wrong_names(asked, rules, route)) return *std::move(wrong);
  if (!found) return refused(404, "there is nothing here by that name");
  if (auto wrong = wrong_method(asked, route)) return *std::move(wrong);
  const bool open = route == Route::page || route == Route::pair || route == Route::socket;  // whose hello has a token
  if (!open && !role_of(rules, pairing, bearer(asked.authorization), asked.stranger)) {
    return refused(401, "Authorization: Bearer and a token that is good");
  }
  return *found;
}

}  // namespace footlight::app
