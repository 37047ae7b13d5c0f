// SPDX-License-Identifier: Apache-2.0
#include "app/surviving/lead_line.hpp"

#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kMostTime_ns = std::int64_t{1} << 56;  // two years

Json parsed(std::string_view line) {
  if (line.size() > kLongestLeadLine) return nullptr;
  Json document = Json::parse(line, nullptr, false);
  return document.is_object() ? document : Json(nullptr);
}

std::string written(const Json& document) {
  return document.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<std::string> text(const Json& document, const char* key) {
  if (!document.is_object() || !document.contains(key) || !document[key].is_string()) return std::nullopt;
  return document[key].get<std::string>();
}

std::optional<std::int64_t> number(const Json& document, const char* key, std::int64_t least, std::int64_t most) {
  if (!document.is_object() || !document.contains(key) || !document[key].is_number_integer()) return std::nullopt;
  if (document[key].is_number_unsigned() && document[key].get<std::uint64_t>() > static_cast<std::uint64_t>(most)) {
    return std::nullopt;
  }
  const auto value = document[key].get<std::int64_t>();
  return value >= least && value <= most ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> time(const Json& document, const char* key) {
  return number(document, key, -kMostTime_ns, kMostTime_ns);
}

std::optional<bool> truth(const Json& document, const char* key) {
  if (!document.contains(key) || !document[key].is_boolean()) return std::nullopt;
  return document[key].get<bool>();
}

std::optional<std::uint32_t> epoch(const Json& document, const char* key) {
  const auto value = number(document, key, 1, std::numeric_limits<std::uint32_t>::max());
  return value ? std::optional(static_cast<std::uint32_t>(*value)) : std::nullopt;
}

std::int64_t ns(Instant instant) { return instant.time_since_epoch().count(); }

}  // namespace

std::string line_of(const FollowRequest& request) {
  return written({{"follow", 1}, {"plan", request.plan}, {"token", request.token}});
}

std::optional<FollowRequest> follow_request(std::string_view line) {
  const Json document = parsed(line);
  const auto plan = text(document, "plan");
  const auto token = text(document, "token");
  if (number(document, "follow", 1, 1) != 1 || !plan || !token) return std::nullopt;
  return FollowRequest{*plan, *token};
}

std::string leads_line(std::uint32_t epoch) { return written({{"leads", epoch}}); }
std::optional<std::uint32_t> leads_in(std::string_view line) { return epoch(parsed(line), "leads"); }

std::string refused_line(std::string_view why) { return written({{"refused", why}}); }
std::optional<std::string> refused_in(std::string_view line) { return text(parsed(line), "refused"); }

std::string over_line(std::string_view how) { return written({{"over", how}}); }
std::optional<std::string> over_in(std::string_view line) { return text(parsed(line), "over"); }

std::string take_over_line(std::uint32_t epoch) { return written({{"take_over", epoch}}); }
std::optional<std::uint32_t> take_over_in(std::string_view line) { return epoch(parsed(line), "take_over"); }

std::string place_line(const Place& place, Duration now) {
  const auto& where = place.where;
  Json it{{"position_ns", ns(where.position)}, {"waits", where.waits},
          {"percent", where.percent},          {"over", place.over},
          {"in_reset", place.in_reset},        {"time_on", place.time.on},
          {"time_armed", place.time.armed},    {"emergency_hold", place.emergency_hold},
          {"readiness", place.readiness}};
  if (where.cue) it["cue"] = *where.cue;
  if (where.runs_since) it["runs_ns"] = now.count() - ns(*where.runs_since);
  if (where.hold_at) it["hold_at_ns"] = ns(*where.hold_at);
  if (where.step_to) it["step_to_ns"] = ns(*where.step_to);
  if (where.loop) {
    it["loop_from_ns"] = ns(where.loop->from);
    it["loop_to_ns"] = ns(where.loop->to);
  }
  return written({{"place", std::move(it)}});
}

std::optional<Place> place_in(std::string_view line, Duration now) {
  const Json document = parsed(line);
  if (!document.is_object() || !document.contains("place") || !document["place"].is_object()) return std::nullopt;
  const Json& it = document["place"];
  const auto position = time(it, "position_ns");
  const auto percent = number(it, "percent", controller::kSlowest_percent, controller::kFastest_percent);
  const auto waits = truth(it, "waits");
  const auto over = truth(it, "over");
  const auto in_reset = truth(it, "in_reset");
  const auto time_on = truth(it, "time_on");
  const auto time_armed = truth(it, "time_armed");
  const auto emergency_hold = truth(it, "emergency_hold");
  auto readiness = text(it, "readiness");
  if (!position || !percent || !waits || !over || !in_reset) return std::nullopt;
  if (!time_on || !time_armed || !emergency_hold || !readiness) return std::nullopt;
  Place place;
  place.time = {*time_on, *time_armed};
  place.emergency_hold = *emergency_hold;
  place.readiness = std::move(*readiness);
  place.at = now;
  place.over = *over;
  place.in_reset = *in_reset;
  auto& where = place.where;
  where.position = Instant(Duration(*position));
  where.percent = static_cast<int>(*percent);
  where.waits = *waits;
  if (const auto cue = number(it, "cue", 0, 1'000'000)) where.cue = static_cast<std::size_t>(*cue);
  if (const auto runs = time(it, "runs_ns")) where.runs_since = Instant(now - Duration(*runs));
  if (const auto hold = time(it, "hold_at_ns")) where.hold_at = Instant(Duration(*hold));
  if (const auto step = time(it, "step_to_ns")) where.step_to = Instant(Duration(*step));
  const auto from = time(it, "loop_from_ns");
  const auto to = time(it, "loop_to_ns");
  if (from && to && *from < *to) where.loop = {Instant(Duration(*from)), Instant(Duration(*to))};
  return place;
}

}  // namespace footlight::app
