// SPDX-License-Identifier: Apache-2.0
#include "app/cast/way_finder.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;
using Phase = DeskWord::Phase;
using Kind = planner::WayIn::Kind;

constexpr Duration kStanding = milliseconds(60'000);  // as long as anybody may walk while the show stands
constexpr std::size_t kMostBeats = 256;

Json text_json(std::string_view kind, PerformerIndex who) { return {{"kind", kind}, {"who", who.value()}}; }
std::string said(Json where) { return Json{{"where", std::move(where)}}.dump(); }

std::string_view to_text(Kind kind) {
  constexpr std::array<std::string_view, 4> kTexts{"join", "wait", "aside", "nowhere"};
  return kTexts.at(static_cast<std::size_t>(kind));
}

/// Whole counts from the one before an instant on.
std::vector<Instant> counts_from(const TempoMap& tempo, Instant from, Instant until) {
  std::vector<Instant> out;
  for (double count = std::floor(tempo.count_at(from) + 1e-6); out.size() < kMostBeats; ++count) {
    out.push_back(tempo.at(count));
    if (out.size() >= 2 && out.back() >= until) break;
  }
  return out;
}

/// The least that anybody may walk anywhere in a stretch, in show time at a rate.
double speed_mps(const Plan& plan, Instant from, Instant to, double rate) {
  double least = plan.stage.max_speed_mps;
  for (const PlanSection& section : plan.sections) {
    if (section.max_speed_mps > 0 && section.start <= to && section.end >= from)
      least = std::min(least, section.max_speed_mps);
  }
  return least / std::max(1.0, rate);
}

}  // namespace

std::optional<Instant> stops_at(const CastPlan& cast, const DeskWord& word, Instant position) {
  std::optional<Instant> out;
  const auto no_later = [&](Instant at) { out = out ? std::min(*out, at) : at; };
  const auto& plays = cast.plays();
  for (std::size_t c = 0; c < plays.size(); ++c) {
    const bool last = c + 1 == plays.size();
    if (plays[c].cue.number.to_text() == word.cue && (plays[c].stands_after() || last)) no_later(plays[c].to);
  }
  if (word.loop) no_later(instant_at(word.loop->to_s));
  if (word.holds_at_end) no_later(cast.stands().from(position, false));
  return out;
}

void WayFinder::take(const std::shared_ptr<const CastPlan>& cast) {
  if (cast_ == cast) return;
  given_.clear();
  stretch_.reset();
  standing_.reset();
  cast_ = cast;
}

/// Ways that are over, and those from before a jump.
void WayFinder::forget(Instant position) {
  std::erase_if(given_, [&](const planner::GivenWay& way) {
    return way.marks.back().time < position || way.marks.front().time > position + kAhead;
  });
  if (given_.size() >= kMostGiven) given_.erase(given_.begin());
}

planner::WayIn WayFinder::way_while_it_runs(const Question& question, Instant latest) {
  const Instant position = question.position;
  const Instant until = std::min(latest, position + kAhead);
  const bool fits = stretch_ && stretch_from_ <= position && stretch_to_ >= std::min(latest, position + kAhead / 2);
  if (!fits) {
    std::vector<Instant> beats = counts_from(cast_->show().tempo, position, position + kAhead);
    stretch_from_ = beats.front();
    stretch_to_ = beats.back();
    stretch_ = cast_->ways().stretch(std::move(beats), to_seconds(cast_->plan().stage.lag));
  }
  const double rate = std::max(question.word.rate, question.word.tempo_percent / 100.0);
  const Instant earliest = position + seconds(rate * to_seconds(kToRead));
  forget(position);
  const planner::WayIn way = cast_->ways().find(*stretch_, {question.who, question.from, earliest, until,
                                                            speed_mps(cast_->plan(), position, until, rate), given_});
  if (way.kind == Kind::join || way.kind == Kind::aside) {
    std::erase_if(given_, [&](const planner::GivenWay& one) { return one.who == question.who; });
    given_.push_back({question.who, way.marks});
  }
  return way;
}

std::optional<planner::WayIn> WayFinder::way_while_it_stands(const Question& question) {
  const Instant position = question.position;
  if (cast_->stands().from(position, true) != position) return std::nullopt;  // in the middle of a walk
  if (!standing_ || standing_->position != position) {
    standing_ = std::make_unique<Standing>();
    standing_->position = position;
    Plan& plan = standing_->plan;
    plan = cast_->plan();
    plan.formations.clear();
    plan.transitions.clear();
    plan.sections.clear();
    const std::vector<CellIndex> cells = controller::cells_at(cast_->plan(), position);
    for (std::size_t p = 0; p < cells.size(); ++p)
      plan.tracks[p] = {{kStart, cells[p]}, {kStart + kStanding, cells[p]}};
    standing_->ways.emplace(plan);
    const double bpm = cast_->show().tempo.bpm_at(cast_->show().tempo.count_at(position));
    standing_->stretch = standing_->ways->stretch(counts_from(TempoMap(bpm), kStart, kStart + kStanding));
  }
  const double limit_mps = speed_mps(cast_->plan(), position, position, 1);
  return standing_->ways->find(*standing_->stretch,
                               {question.who, question.from, kStart, kStart + kStanding, limit_mps});
}

std::string WayFinder::answer(const std::shared_ptr<const CastPlan>& cast, const Question& question) {
  take(cast);
  const Show& show = cast->show();
  const DeskWord& word = question.word;
  if (show.performers.at(question.who.at()).absent) return said(text_json("absent", question.who));
  if (!cast->ways().can_stand(question.from)) return said(text_json("no-cell", question.who));
  if (word.phase == Phase::resets || word.phase == Phase::reset_held) return said(text_json("reset", question.who));
  const bool runs = word.phase == Phase::runs || word.phase == Phase::counts_in;
  planner::WayIn way;
  const Instant latest = stops_at(*cast, word, question.position).value_or(kNever);
  if (runs) {
    way = way_while_it_runs(question, latest);
  } else {
    auto found = way_while_it_stands(question);
    if (!found) return said(text_json("held", question.who));
    way = std::move(*found);
  }
  Json where = text_json(to_text(way.kind), question.who);
  where["at_once"] = !runs;
  if (way.marks.size() == 1 && way.kind == Kind::join) where["kind"] = "here";
  where["until_s"] = to_seconds(way.until);
  // A stop changes everything; else what lies beyond what was looked at comes in sight bit by bit.
  const Instant ask = latest <= way.until ? latest : question.position + (way.until - question.position) / 2;
  where["ask_s"] = to_seconds(runs ? ask : question.position);
  where["places"] = Json::array();
  if (way.kind == Kind::join || way.kind == Kind::aside) {
    const double bpm = show.tempo.bpm_at(show.tempo.count_at(question.position));
    Show counted;
    const Show* by = &show;
    if (!runs) {
      counted.tempo = TempoMap(bpm, show.tempo.beats_per_measure());
      counted.performers = show.performers;
      by = &counted;
    }
    where["places"] = Json::parse(places_json(*by, cast->plan(), question.who, way.marks, question.language));
  }
  return said(std::move(where));
}

}  // namespace footlight::app
