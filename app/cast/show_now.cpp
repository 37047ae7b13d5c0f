// SPDX-License-Identifier: Apache-2.0
#include "app/cast/show_now.hpp"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;
using Phase = DeskWord::Phase;

double way_rate(const DeskWord& word) { return word.phase == Phase::resets && !word.goes_in_s ? word.rate : 0; }
double show_rate(const DeskWord& word) { return word.phase == Phase::runs ? word.rate : 0; }

/// Whether what was told is not what has become of it `by_s` later.
bool off(const std::optional<double>& before, double by_s, const std::optional<double>& now) {
  if (!before || !now) return before.has_value() != now.has_value();
  return std::abs(*before + by_s - *now) > ShowNow::kAllowed_s;
}

}  // namespace

double ShowNow::position_s(Instant now) const {
  if (at_ == Instant::min()) return word_.position_s;
  return word_.position_s + show_rate(word_) * to_seconds(now - at_);
}

/// What phones would show at that instant by what they were told before.
bool ShowNow::differs(const DeskWord& word, Instant came) const {
  const double since_s = to_seconds(came - at_);
  DeskWord by_itself = word_;
  by_itself.position_s = word.position_s;
  by_itself.way_s = word.way_s;
  by_itself.goes_in_s = word.goes_in_s;
  if (by_itself != word) return true;
  return std::abs(position_s(came) - word.position_s) > kAllowed_s ||
         off(word_.way_s, way_rate(word_) * since_s, word.way_s) || off(word_.goes_in_s, -since_s, word.goes_in_s);
}

bool ShowNow::take(const DeskWord& word, Instant came) {
  if (heard_ && !differs(word, came)) return false;
  word_ = word;
  at_ = came;
  heard_ = true;
  return true;
}

bool ShowNow::lost() { return std::exchange(heard_, false); }

void ShowNow::take_plan(bool same) {
  same_plan_ = same;
  ++epoch_;
}

bool ShowNow::take_way(bool there) {
  if (there) ++ways_;
  return std::exchange(way_, there) || there;
}

std::string ShowNow::json(Instant now, std::optional<double> stops_s) const {
  const auto ms = [](Instant at) { return std::round(to_seconds(at) * 1e4) / 10; };
  const auto or_null = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
  Json state{{"heard", heard_}, {"same_plan", same_plan_}, {"epoch", epoch_}, {"now_ms", ms(now)}};
  if (at_ != Instant::min()) {
    state["phase"] = to_text(word_.phase);
    state["at_ms"] = ms(at_);
    state["position_s"] = word_.position_s;
    state["rate"] = show_rate(word_);
    state["goes_at_ms"] = word_.goes_in_s ? Json(ms(at_ + seconds(*word_.goes_in_s))) : Json(nullptr);
    state["stops_s"] = or_null(stops_s);
    state["holds_at_end"] = word_.holds_at_end;
    state["cue"] = word_.cue;
    state["standby"] = word_.standby;
    state["tempo_percent"] = word_.tempo_percent;
    state["loop"] = word_.loop ? Json{{"from_s", word_.loop->from_s}, {"to_s", word_.loop->to_s}} : Json(nullptr);
    state["way"] = way_ ? Json{{"n", ways_}, {"at_s", or_null(word_.way_s)}, {"rate", way_rate(word_)}} : Json(nullptr);
  }
  return Json{{"state", std::move(state)}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace footlight::app
