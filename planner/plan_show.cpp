// SPDX-License-Identifier: Apache-2.0
#include "planner/plan_show.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "planner/casting.hpp"
#include "planner/painted/walls.hpp"
#include "planner/parallel.hpp"
#include "planner/plan_notes.hpp"
#include "planner/plan_section.hpp"
#include "planner/proof.hpp"
#include "planner/refusal.hpp"
#include "planner/schedule/beats.hpp"
#include "planner/schedule/chain.hpp"
#include "planner/shortest.hpp"
#include "planner/stand_in.hpp"
#include "planner/stations.hpp"
#include "planner/validate.hpp"
#include "planner/wide_people.hpp"

namespace footlight::planner {
namespace {

Error interrupted() { return {ErrorKind::interrupted, "planning was stopped"}; }

bool has_slow_people(const Show& show) {
  return std::any_of(show.performers.begin(), show.performers.end(),
                     [](const Performer& performer) { return performer.max_speed_mps > 0; });
}

bool has_paintings(const Show& show) {
  return std::any_of(show.sections.begin(), show.sections.end(),
                     [](const Section& section) { return std::holds_alternative<PaintingSource>(section.from); });
}

class ShowPlanner {
 public:
  ShowPlanner(const Show& show, const std::vector<std::optional<Film>>& films, const Progress& progress,
              const Reuse& reuse)
      : show_(show), films_(films), progress_(progress), reuse_(reuse), limits_(show), wide_(show) {}

  Result<Planned> run() {
    FL_CHECK(films_.size() == show_.sections.size());
    if (show_.performers.empty()) return input_error(show_.file + ": error: performers: the show has nobody in it");
    if (show_.sections.empty()) return input_error(show_.file + ": error: sections: the show has no section");
    const Ways ways = ways_of(show_, wide_);
    const bool slow = has_slow_people(show_);
    if (slow) {
      for (Performer& performer : limits_.performers) performer.max_speed_mps = 0;
    }
    std::optional<Chain> chain;
    for (;;) {
      auto collected = collect_stations({&show_, &limits_, &films_, &ways, &reuse_}, progress_);
      if (!collected) return collected.error();
      stations_ = std::move(collected->stations);
      planned_.plan.sections = std::move(collected->sections);
      sections_.all += collected->count.all;
      sections_.anew += collected->count.anew;
      auto casting = casting_of(show_, stations_);
      if (!casting) return casting.error();
      if (wide_.pair_by_pair()) keep_apart_by_radius(show_, *casting);
      chain = walk_through({&limits_, &ways, &stations_, &*casting, wide_.clearance_m(), reuse_.stages, &counts_},
                           progress_);
      if (!chain) return interrupted();
      name_people(*chain);
      if (!slow || give_slow_people_slow_tracks(*chain) || slow_for_all_) break;
      slow_for_all_ = true;
      limits_ = show_;  // the slowest person's limit for everybody
      planned_ = {};
    }
    write_tracks(*chain);
    stand_in();
    describe();
    write_formations(*chain);
    const NoteTask notes{&show_, &limits_, &stations_, &*chain, &slot_, wide_.clearance_m()};
    note_what_gave_way(notes, planned_.plan);
    note_late_pins(notes, planned_.plan);
    wide_.note(planned_.plan);
    note_steps(notes, planned_.plan);
    if (slow_for_all_) {
      planned_.plan.sections.front().notes.push_back(
          "everybody walks as slowly as the slowest: no tracks are slow enough for those with limits of their own");
    }
    const auto sound = prove(*chain, planned_.plan, reuse_.stages, &facts_, progress_);
    if (!sound) return interrupted();
    note_lag(notes, planned_.plan);
    note_waits(notes, planned_.plan);
    note_marks_on_the_way(notes, planned_.plan);
    progress_.tell("validate", 0);
    planned_.plan.valid = *sound;
    if (!*sound) {
      const Verdict verdict = validate(planned_.plan);
      planned_.plan.valid = verdict.valid();
      planned_.refusal = refusal_texts(show_, planned_.plan, verdict);
      if (!verdict.valid()) {
        const std::vector<std::string> who = who_cannot_pass(notes);
        planned_.refusal.insert(planned_.refusal.begin(), who.begin(), who.end());
      }
    }
    if (const auto too_wide = wide_.too_wide(); too_wide && !planned_.plan.valid) {
      planned_.refusal.insert(planned_.refusal.begin(), *too_wide);
    }
    for (std::size_t s = 0; s < show_.sections.size(); ++s) {
      planned_.shortest.push_back(shortest_duration(limits_, *chain, SectionIndex::of(s), planned_.plan));
    }
    planned_.formations = sections_;
    planned_.pairings = counts_.pairings;
    planned_.walks = counts_.walks;
    planned_.facts = facts_;
    progress_.tell("validate", 1);
    if (progress_.stopped()) return interrupted();
    return std::move(planned_);
  }

 private:
  void describe() {
    Plan& plan = planned_.plan;
    plan.title = show_.title;
    plan.version = show_.version;
    plan.stage = show_.stage;
    for (const Performer& performer : show_.performers) {
      const auto cover = understudy_of(show_, performer);
      if (performer.absent && !cover) continue;
      plan.performers.push_back(cover ? show_.understudies[*cover].id : performer.id);
      plan.radius_m.push_back(cover ? show_.understudies[*cover].radius_m : performer.radius_m);
      plan.max_speed_mps.push_back(cover ? show_.understudies[*cover].max_speed_mps : performer.max_speed_mps);
    }
  }

  /// slot_[k][p] is where performer p stands in the list of stop k.
  void name_people(const Chain& chain) {
    const std::size_t people = show_.performers.size();
    slot_.assign(chain.stops.size(), chain.first_place);
    for (std::size_t k = 1; k < chain.stops.size(); ++k) {
      for (std::size_t p = 0; p < people; ++p) slot_[k][p] = chain.legs[k - 1].target_of[slot_[k - 1][p]];
    }
  }

  /// The slower somebody is, the slower the track she gets, of those that people like her may have. The limits are
  /// nested, so that this order fits whenever any does.  @return false when somebody would have to walk too fast
  bool give_slow_people_slow_tracks(const Chain& chain) {
    const std::size_t people = show_.performers.size();
    std::vector<double> fastest_mps(people, 0.0);
    for (std::size_t k = 0; k < chain.legs.size(); ++k) {
      for (std::size_t p = 0; p < people; ++p) {
        const Chain::WalkTimes when = walking(chain, k, p);
        Mark before{when.start, cell_of(chain, k, p)};
        const auto walk_to = [&](const Mark& mark) {
          const double walk_m = distance(show_.stage.grid.centre(before.cell), show_.stage.grid.centre(mark.cell));
          if (walk_m > 0) fastest_mps[p] = std::max(fastest_mps[p], walk_m / to_seconds(mark.time - before.time));
          before = mark;
        };
        for (const Mark& mark : chain.marks_on_the_way(k, slot_[k][p])) walk_to(mark);
        walk_to({when.end, cell_of(chain, k + 1, p)});
      }
    }
    std::vector<std::size_t> track_of(people);
    std::iota(track_of.begin(), track_of.end(), std::size_t{0});
    const auto limit = [&](std::size_t p) {
      const double own = show_.performers[p].max_speed_mps;
      return own > 0 ? own : std::numeric_limits<double>::infinity();
    };
    std::vector<std::size_t> order = track_of;
    std::vector<std::size_t> tracks = track_of;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(chain.alike[a], limit(a)) < std::pair(chain.alike[b], limit(b));
    });
    std::stable_sort(tracks.begin(), tracks.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(chain.alike[a], fastest_mps[a]) < std::pair(chain.alike[b], fastest_mps[b]);
    });
    for (std::size_t n = 0; n < people; ++n) track_of[order[n]] = tracks[n];
    for (std::size_t p = 0; p < people; ++p) {
      if (fastest_mps[track_of[p]] > limit(p)) return false;
    }
    for (auto& slots : slot_) {
      const std::vector<std::uint32_t> before = slots;
      for (std::size_t p = 0; p < people; ++p) slots[p] = before[track_of[p]];
    }
    return true;
  }

  [[nodiscard]] CellIndex cell_of(const Chain& chain, std::size_t k, std::size_t performer) const {
    return chain.stops[k].cells[slot_[k][performer]];
  }

  /// When somebody walks between stop k and the next.
  [[nodiscard]] Chain::WalkTimes walking(const Chain& chain, std::size_t k, std::size_t performer) const {
    return chain.walk_times(k, slot_[k][performer]);
  }

  void write_tracks(const Chain& chain) {
    planned_.plan.tracks.resize(show_.performers.size());
    for (std::size_t p = 0; p < show_.performers.size(); ++p) {
      std::vector<Mark>& track = planned_.plan.tracks[p];
      // Before the first section everybody stands in the opening form.
      if (chain.stops.front().arrive > kStart) track.push_back({kStart, cell_of(chain, 0, p)});
      for (std::size_t k = 0; k < chain.stops.size(); ++k) {
        const Stop& stop = chain.stops[k];
        const CellIndex cell = cell_of(chain, k, p);
        const Instant arrive = k > 0 ? walking(chain, k - 1, p).end : stop.arrive;
        const Instant depart = k < chain.legs.size() ? walking(chain, k, p).start : stop.depart;
        track.push_back({arrive, cell});
        if (depart > arrive) track.push_back({depart, cell});
        if (k == chain.legs.size()) continue;
        const std::vector<Mark> own = chain.marks_on_the_way(k, slot_[k][p]);
        track.insert(track.end(), own.begin(), own.end());
      }
    }
  }

  /// Everything up to here is planned as if everybody came; from here on the plan has nobody who does not.
  void stand_in() {
    auto& tracks = planned_.plan.tracks;
    for (const StandIn& one : stand_ins(show_, tracks, wide_.widest_two_m() <= wide_.clearance_m())) {
      planned_.plan.sections.front().notes.push_back(stand_in_text(show_, one));
      if (!one.taker) continue;
      std::swap(tracks[one.absent.at()], tracks[one.taker->at()]);
      for (auto& slots : slot_) std::swap(slots[one.absent.at()], slots[one.taker->at()]);
    }
    std::size_t present = 0;
    for (std::size_t p = 0; p < tracks.size(); ++p) {
      if (gone(p)) continue;
      if (present != p) tracks[present] = std::move(tracks[p]);
      ++present;
    }
    tracks.resize(present);
  }

  /// Her track has nobody; an understudy takes it whole.
  [[nodiscard]] bool gone(std::size_t p) const {
    return show_.performers[p].absent && !understudy_of(show_, show_.performers[p]);
  }

  [[nodiscard]] bool in_picture(const Stop& stop, std::uint32_t slot) const {
    const CellIndex cell = stop.cells[slot];
    if (!stop.exact && cell != stop.own[slot]) return false;
    return !std::binary_search(show_.stage.reserve.begin(), show_.stage.reserve.end(), cell);
  }

  void write_formations(const Chain& chain) {
    std::vector<int> number(show_.sections.size(), 0);
    for (std::size_t k = 0; k < chain.stops.size(); ++k) {
      const Stop& stop = chain.stops[k];
      if (!stop.station) continue;
      const Station& station = stations_[*stop.station];
      Formation formation;
      formation.id = fmt::format("{}/{}", show_.sections[station.section.at()].name, ++number[station.section.at()]);
      formation.section = station.section;
      formation.count = station.count;
      formation.time = station.arrive;
      formation.frame = station.frame;
      formation.in_picture = station.in_picture - stop.given_way;
      for (std::size_t p = 0; p < show_.performers.size(); ++p) {
        if (!gone(p)) {
          formation.cells.push_back(cell_of(chain, k, p));
        } else if (in_picture(stop, slot_[k][p])) {
          --formation.in_picture;
        }
      }
      formation.key = station.key;
      formation.moved = station.moved;
      formation.pinned = static_cast<int>(station.pins.size());
      planned_.plan.formations.push_back(std::move(formation));
    }
  }

  const Show& show_;
  const std::vector<std::optional<Film>>& films_;
  const Progress& progress_;
  const Reuse& reuse_;
  StageCount sections_;
  ChainTask::Counts counts_;
  StageCount facts_;
  Show limits_;  ///< with the limits of speed that the walks are planned for
  bool slow_for_all_ = false;
  WidePeople wide_;
  std::vector<Station> stations_;
  std::vector<std::vector<std::uint32_t>> slot_;
  Planned planned_;
};

}  // namespace

Result<Planned> plan_show(const Show& show, const std::vector<std::optional<Film>>& films, const Progress& progress,
                          const Reuse& reuse) {
  const auto walled = with_painted_walls(show, films);
  auto planned = ShowPlanner(walled ? *walled : show, films, progress, reuse).run();
  if (planned && reuse.stages != nullptr) reuse.stages->forget_unused();
  return planned;
}

std::vector<bool> formations_known(const Show& show, const Reuse& reuse) {
  std::vector<bool> out(show.sections.size(), false);
  // Nobody knows the walls of a painting before it is decoded.
  if (show.performers.empty() || has_paintings(show)) return out;
  const Ways ways = ways_of(show, WidePeople(show));
  Show limits = show;
  for (Performer& performer : limits.performers) performer.max_speed_mps = 0;
  out = sections_known({&show, &limits, nullptr, &ways, &reuse});
  if (!has_slow_people(show)) return out;
  // With limits of people's own everything may have to be planned for the slowest.
  const std::vector<bool> slow = sections_known({&show, &show, nullptr, &ways, &reuse});
  for (std::size_t s = 0; s < out.size(); ++s) out[s] = out[s] && slow[s];
  return out;
}

}  // namespace footlight::planner
