// SPDX-License-Identifier: Apache-2.0
#include "app/freeze_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text_table.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;
using planner::Touch;
using planner::TouchCount;

constexpr std::size_t kPairsTold = 20;

double count_of(const Show& show, Instant at) { return std::round(show.tempo.count_at(at) * 100) / 100; }

double share_of(const TouchCount& count, const controller::CuePlay& play) {
  const double whole_s = to_seconds(play.to - play.from);
  return whole_s > 0 ? to_seconds(count.safe_in(play.from, play.to)) / whole_s : 1.0;
}

std::string share_text(double share) {
  // Rounded down: what is not all is not 100 %.
  return fmt::format("{:.0f} %", std::floor(share * 100));
}

std::string worst_text(const Show& show, const TouchCount& count, const controller::CuePlay& play) {
  const TouchCount::Worst worst = count.worst_in(play.from, play.to);
  if (worst.pairs == 0) return "-";
  return fmt::format("{} at count {:g}", worst.pairs, count_of(show, worst.at));
}

Json one_json(const Show& show, const TouchCount& count, const controller::CuePlay& play) {
  const TouchCount::Worst worst = count.worst_in(play.from, play.to);
  return {{"safe_share", share_of(count, play)},
          {"most_pairs", worst.pairs},
          {"most_at_count", worst.pairs > 0 ? Json(show.tempo.count_at(worst.at)) : Json(nullptr)}};
}

void add_pairs(const Show& show, const Plan& plan, const std::vector<Touch>& touches, std::string_view what,
               std::string& out) {
  if (touches.empty()) {
    out += fmt::format("{}: safe\n", what);
    return;
  }
  out += fmt::format("{}: {} pair{} may touch\n", what, touches.size(), touches.size() == 1 ? "" : "s");
  for (std::size_t k = 0; k < std::min(kPairsTold, touches.size()); ++k) {
    const Touch& touch = touches[k];
    out += fmt::format("  performers {} and {}, counts {:g} to {:g}\n", plan.performers[touch.a],
                       plan.performers[touch.b], count_of(show, touch.from), count_of(show, touch.until));
  }
  if (touches.size() > kPairsTold)
    out += fmt::format("  and {} more (--json tells all)\n", touches.size() - kPairsTold);
}

Json pairs_json(const Show& show, const Plan& plan, const std::vector<Touch>& touches) {
  Json list = Json::array();
  for (const Touch& touch : touches) {
    list.push_back({{"a", plan.performers[touch.a]},
                    {"b", plan.performers[touch.b]},
                    {"from_count", show.tempo.count_at(touch.from)},
                    {"until_count", show.tempo.count_at(touch.until)}});
  }
  return list;
}

}  // namespace

std::vector<Instant> waits_of(const std::vector<controller::CuePlay>& plays) {
  std::vector<Instant> waits;
  for (const controller::CuePlay& play : plays) {
    if (!play.gap_after) waits.push_back(play.to);
  }
  return waits;
}

std::string freeze_text(const Show& show, const Plan& plan, const planner::FreezeJudgement& judged) {
  TextTable table({"cue", "freeze safe", "most pairs that may touch", "going on safe", "most pairs that may touch"});
  for (const controller::CuePlay& play : controller::cue_plays(show, plan)) {
    const std::string name = play.cue.name.empty() ? "" : " " + play.cue.name;
    table.add({play.cue.number.to_text() + name, share_text(share_of(judged.freeze, play)),
               worst_text(show, judged.freeze, play), share_text(share_of(judged.resume, play)),
               worst_text(show, judged.resume, play)});
  }
  return table.to_text() +
         fmt::format(
             "\n{} pairs may touch in some freeze, {} when the show goes on after one, if people stop up to {:g} s "
             "late\n",
             judged.freeze_pairs, judged.resume_pairs, to_seconds(judged.late));
}

std::string freeze_json(const Show& show, const Plan& plan, const planner::FreezeJudgement& judged) {
  Json out{{"late_s", to_seconds(judged.late)},
           {"freeze_pairs", judged.freeze_pairs},
           {"resume_pairs", judged.resume_pairs},
           {"cues", Json::array()}};
  for (const controller::CuePlay& play : controller::cue_plays(show, plan)) {
    out["cues"].push_back({{"cue", play.cue.number.to_text()},
                           {"freeze", one_json(show, judged.freeze, play)},
                           {"resume", one_json(show, judged.resume, play)}});
  }
  return out.dump(1) + "\n";
}

std::string freeze_at_text(const Show& show, const Plan& plan, Instant freeze, const planner::FreezeAt& at) {
  std::string out = fmt::format("at count {:g}\n", count_of(show, freeze));
  add_pairs(show, plan, at.freeze, "freeze", out);
  add_pairs(show, plan, at.resume, "going on", out);
  return out;
}

std::string freeze_at_json(const Show& show, const Plan& plan, Instant freeze, const planner::FreezeAt& at) {
  return Json{{"count", show.tempo.count_at(freeze)},
              {"freeze", pairs_json(show, plan, at.freeze)},
              {"resume", pairs_json(show, plan, at.resume)}}
             .dump(1) +
         "\n";
}

}  // namespace footlight::app
