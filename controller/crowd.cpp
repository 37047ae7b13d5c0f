// SPDX-License-Identifier: Apache-2.0
#include "controller/crowd.hpp"

#include <algorithm>
#include <charconv>

#include "core/check.hpp"

namespace footlight::controller {
namespace {

template <class T>
void sort_unique(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

std::string count_text(double count) {
  const double rounded = std::round(count * 1000) / 1000;
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, rounded).ptr;
  return {text, end};
}

/// Cues whose play holds the instant; an instant on the border belongs to the later one, the last to the last.
std::size_t play_at(const std::vector<CuePlay>& plays, Instant time) {
  std::size_t c = 0;
  while (c + 1 < plays.size() && time >= plays[c].to) ++c;
  return c;
}

}  // namespace

Crowd::Crowd(const Show& show, const Plan& plan, const std::vector<CuePlay>& plays)
    : plan_(&plan), segment_(plan.tracks.size(), 0) {
  std::vector<Instant> starts;
  for (const auto& track : plan.tracks) {
    for (std::size_t m = 0; m < track.size(); ++m) {
      marks_.push_back(track[m].time);
      if (m + 1 < track.size() && track[m].cell != track[m + 1].cell) starts.push_back(track[m].time);
    }
    if (marks_.size() > 4'000'000) sort_unique(marks_);
    if (starts.size() > 4'000'000) sort_unique(starts);
  }
  sort_unique(marks_);
  sort_unique(starts);
  for (const Instant move : starts) {
    const double count = show.tempo.count_at(move);
    Instant since = move - show.tempo.span(count - show.announce_counts, show.announce_counts);
    const auto here = std::lower_bound(marks_.begin(), marks_.end(), move);
    if (here != marks_.begin()) since = std::max(since, *std::prev(here));
    announcements_.push_back({move, since});
  }
  find_moments(show, plays);
  name_moments(show);
  for (const PlanSection& section : plan.sections) {
    std::vector<bool>& reserve = reserve_.emplace_back(static_cast<std::size_t>(plan.stage.grid.size()), false);
    for (const CellIndex cell : plan.stage.reserve) reserve[cell.at()] = true;
    for (const CellIndex cell : section.reserve) reserve[cell.at()] = true;
  }
  FL_CHECK(!reserve_.empty());
}

void Crowd::find_moments(const Show& show, const std::vector<CuePlay>& plays) {
  (void)show;
  std::vector<Instant> times = marks_;
  // Before the first mark nobody is told anything: an announcement there is part of the opening.
  for (const Announcement& announcement : announcements_) {
    if (announcement.since > marks_.front()) times.push_back(announcement.since);
  }
  sort_unique(times);
  moments_.push_back({times.front(), true, std::nullopt, "opening"});
  std::size_t closed = 0;
  for (const Instant time : times) {
    while (closed + 1 < plays.size() && plays[closed].to <= time) {
      if (plays[closed].stands_after() && plays[closed].to > times.front()) {
        moments_.push_back({plays[closed].to, true, closed, "end of cue " + plays[closed].cue.number.to_text()});
      }
      ++closed;
    }
    moments_.push_back({time, false, play_at(plays, time), {}});
  }
}

void Crowd::name_moments(const Show& show) {
  for (Moment& moment : moments_) {
    if (!moment.cause.empty()) continue;
    const auto first_from = [&](Instant time) {
      return std::lower_bound(plan_->formations.begin(), plan_->formations.end(), time,
                              [](const Formation& formation, Instant t) { return formation.time < t; });
    };
    const bool mark = std::binary_search(marks_.begin(), marks_.end(), moment.time);
    const auto formation = mark ? first_from(moment.time) : first_from(moment.time + Duration(1));
    if (mark && formation != plan_->formations.end() && formation->time == moment.time) {
      moment.cause = formation->id;
    } else if (!mark && formation != plan_->formations.end()) {
      moment.cause = formation->id + " announced";
    } else {
      moment.cause = plan_->sections[section_at(moment)].name + " at count " +
                     count_text(show.tempo.count_at(moment.time)) + (mark ? "" : " announced");
    }
  }
}

std::optional<CellIndex> Crowd::announced(const std::vector<Mark>& track, std::size_t segment, Instant time,
                                          Instant& arrives) const {
  for (std::size_t m = segment; m + 1 < track.size(); ++m) {
    const Instant move = track[m].time;
    if (move < time || track[m].cell == track[m + 1].cell) continue;
    const auto found =
        std::lower_bound(announcements_.begin(), announcements_.end(), move,
                         [](const Announcement& announcement, Instant t) { return announcement.move < t; });
    FL_CHECK(found != announcements_.end() && found->move == move);
    if (found->since > time) return std::nullopt;
    arrives = track[m + 1].time;
    return track[m + 1].cell;
  }
  return std::nullopt;
}

void Crowd::look_at(std::size_t k, std::vector<Doing>& doing) {
  const Moment& moment = moments_.at(k);
  if (k < visited_) std::fill(segment_.begin(), segment_.end(), std::size_t{0});
  visited_ = k;
  doing.resize(plan_->tracks.size());
  for (std::size_t p = 0; p < plan_->tracks.size(); ++p) {
    const auto& track = plan_->tracks[p];
    std::size_t& m = segment_[p];
    while (m + 1 < track.size() && track[m + 1].time <= moment.time) ++m;
    Doing& d = doing[p];
    d = {track[m].cell, std::nullopt, std::nullopt, track[m].time, track[m].time};
    const bool on_the_mark = track[m].time == moment.time;
    const bool walks = m + 1 < track.size() && track[m].cell != track[m + 1].cell && !(moment.settled && on_the_mark);
    if (walks) {
      d.goal = track[m + 1].cell;
      d.arrives = track[m + 1].time;
    }
    // In a settled moment the walk that begins now is still to come.
    d.next = announced(track, walks ? m + 1 : m, moment.time, d.next_arrives);
  }
}

std::size_t Crowd::section_at(const Moment& moment) const {
  std::size_t s = 0;
  while (s + 1 < plan_->sections.size() &&
         (moment.settled ? moment.time > plan_->sections[s].end : moment.time >= plan_->sections[s].end)) {
    ++s;
  }
  return s;
}

const std::vector<bool>& Crowd::reserve_at(std::size_t k) const { return reserve_.at(section_at(moments_.at(k))); }

}  // namespace footlight::controller
