// SPDX-License-Identifier: Apache-2.0
#include "planner/plan_show.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "planner/by_hand.hpp"
#include "planner/casting.hpp"
#include "planner/parallel.hpp"
#include "planner/picture_section.hpp"
#include "planner/plan_notes.hpp"
#include "planner/plan_section.hpp"
#include "planner/proof.hpp"
#include "planner/refusal.hpp"
#include "planner/schedule/beats.hpp"
#include "planner/schedule/chain.hpp"
#include "planner/section_stage.hpp"
#include "planner/shortest.hpp"
#include "planner/stand_in.hpp"
#include "planner/validate.hpp"

namespace footlight::planner {
namespace {

Error interrupted() { return {ErrorKind::interrupted, "planning was stopped"}; }

class ShowPlanner {
 public:
  ShowPlanner(const Show& show, const std::vector<std::optional<Film>>& films, const Progress& progress,
              const Reuse& reuse)
      : show_(show),
        films_(films),
        progress_(progress),
        reuse_(reuse),
        limits_(show),
        clearance_m_(show.stage.clearance_m) {
    for (std::size_t p = 0; p < show.performers.size(); ++p) {
      const auto radius_m = [&](PerformerIndex who) { return show.performers[who.at()].radius_m; };
      const PerformerIndex who = PerformerIndex::of(p);
      if (!widest_ || radius_m(who) > radius_m(*widest_)) {
        second_ = widest_;
        widest_ = who;
      } else if (!second_ || radius_m(who) > radius_m(*second_)) {
        second_ = who;
      }
    }
    // Neighbours who stand still are a pitch apart: more cannot be planned for, and the judge has the last word.
    // What walks keep by themselves can be asked of everybody; more is asked of those alone who need it.
    pair_by_pair_ = show.stage.walk == WalkKind::straight && widest_two_m() > show.stage.grid.clearance_bound_m() &&
                    widest_two_m() > clearance_m_;
    if (!pair_by_pair_) clearance_m_ = std::max(clearance_m_, std::min(widest_two_m(), show.stage.grid.pitch_m()));
  }

  Result<Planned> run() {
    FL_CHECK(films_.size() == show_.sections.size());
    if (show_.performers.empty()) return input_error(show_.file + ": error: performers: the show has nobody in it");
    if (show_.sections.empty()) return input_error(show_.file + ": error: sections: the show has no section");
    const Ways ways = ways_of();
    const bool slow = std::any_of(show_.performers.begin(), show_.performers.end(),
                                  [](const Performer& performer) { return performer.max_speed_mps > 0; });
    if (slow) {
      for (Performer& performer : limits_.performers) performer.max_speed_mps = 0;
    }
    std::optional<Chain> chain;
    for (;;) {
      if (auto error = collect_stations(ways)) return *error;
      auto casting = casting_of(show_, stations_);
      if (!casting) return casting.error();
      if (pair_by_pair_) keep_apart_by_radius(show_, *casting);
      chain = walk_through({&limits_, &ways, &stations_, &*casting, clearance_m_, reuse_.stages, &counts_}, progress_);
      if (!chain) return interrupted();
      name_people(*chain);
      if (!slow || give_slow_people_slow_tracks(*chain) || slow_for_all_) break;
      slow_for_all_ = true;
      limits_ = show_;  // the slowest person's limit for everybody
      stations_.clear();
      planned_ = {};
    }
    write_tracks(*chain);
    stand_in();
    describe();
    write_formations(*chain);
    const NoteTask notes{&show_, &limits_, &stations_, &*chain, &slot_, clearance_m_};
    note_what_gave_way(notes, planned_.plan);
    note_wide_people();
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
    if (!planned_.plan.valid && widest_two_m() > show_.stage.grid.pitch_m()) {
      planned_.refusal.insert(planned_.refusal.begin(), too_wide());
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

  /// See formations_known.
  std::vector<bool> known() {
    if (show_.performers.empty()) return std::vector<bool>(show_.sections.size(), false);
    const Ways ways = ways_of();
    Show limits = show_;
    for (Performer& performer : limits.performers) performer.max_speed_mps = 0;
    // With limits of people's own everything may have to be planned for the slowest.
    std::vector<bool> out = known(limits, ways);
    stations_.clear();
    const std::vector<bool> slow = known(show_, ways);
    for (std::size_t s = 0; s < out.size(); ++s) out[s] = out[s] && slow[s];
    return out;
  }

 private:
  [[nodiscard]] Ways ways_of() const {
    return {show_.stage, std::max(show_.stage.clearance_m / 2, show_.performers[widest_->at()].radius_m)};
  }

  std::optional<Error> collect_stations(const Ways& ways) {
    draft_videos(ways);
    if (progress_.stopped()) return interrupted();
    for (std::size_t s = 0; s < show_.sections.size(); ++s) {
      auto section = recalled_section(SectionIndex::of(s), ways);
      if (!section) return section.error();
      if (auto error = append(SectionIndex::of(s), ways, *section)) return error;
      planned_.plan.sections.push_back(std::move(section->section));
    }
    return std::nullopt;
  }

  std::optional<Error> append(SectionIndex index, const Ways& ways, SectionPlan& section) {
    if (auto error = apply_overrides(show_, index, ways, section)) return error;
    for (Station& station : section.stations) {
      if (!stations_.empty() && station.arrive <= stations_.back().depart) join(station);
      stations_.push_back(std::move(station));
    }
    return std::nullopt;
  }

  /// Formations of a section that were planned before, without the film; else anew.
  Result<SectionPlan> recalled_section(SectionIndex index, const Ways& ways) {
    const std::size_t s = index.at();
    ++sections_.all;
    if (auto plan = recall(limits_, index, ways)) return std::move(*plan);
    ++sections_.anew;
    auto section = taken_draft(index, ways);
    if (!section) section = plan_section(limits_, index, films_[s], ways, before(), progress_);
    if (*section && has_id(s)) {
      const Station* from = (*section)->begin == Begin::from_before ? before() : nullptr;
      reuse_.stages->keep(section_key(limits_, index, reuse_.film_ids[s], from), encode_section(**section));
    }
    return std::move(*section);
  }

  /// Videos planned at the same time, as if nobody had been anywhere before.
  void draft_videos(const Ways& ways) {
    drafts_.assign(show_.sections.size(), std::nullopt);
    std::vector<SectionIndex> videos;
    for (std::size_t s = 0; s < drafts_.size(); ++s) {
      const Section& section = limits_.sections[s];
      if (section.planner.model != PlannerModel::joint || !std::holds_alternative<VideoSource>(section.from)) continue;
      const bool no_gap = s > 0 && limits_.sections[s - 1].end_count() >= section.start_count;
      if (films_[s] && !no_gap && !recall_from(limits_, SectionIndex::of(s), nullptr))
        videos.push_back(SectionIndex::of(s));
    }
    if (videos.size() < 2) return;
    for_each_index(videos.size(), "joint", {{}, progress_.stop}, [&](std::size_t n) {
      const Progress quiet{{}, progress_.stop};
      drafts_[videos[n].at()] = plan_section(limits_, videos[n], films_[videos[n].at()], ways, nullptr, quiet);
    });
  }
  std::optional<Result<SectionPlan>> taken_draft(SectionIndex index, const Ways& ways) {
    auto draft = std::exchange(drafts_[index.at()], std::nullopt);
    if (draft && *draft && !fits_before(limits_, index, ways, **draft)) return std::nullopt;
    return draft;
  }

  /// Whether a plan that was made without the formation before holds with it.
  [[nodiscard]] bool fits_before(const Show& limits, SectionIndex index, const Ways& ways,
                                 const SectionPlan& plan) const {
    return plan.begin != Begin::where_best || before() == nullptr ||
           can_begin(limits, index, ways, *before(), plan.stations.front());
  }
  [[nodiscard]] bool has_id(std::size_t s) const {
    return reuse_.stages != nullptr && s < reuse_.film_ids.size() && !reuse_.film_ids[s].empty();
  }
  [[nodiscard]] const Station* before() const { return stations_.empty() ? nullptr : &stations_.back(); }
  [[nodiscard]] std::optional<SectionPlan> recall(const Show& limits, SectionIndex index, const Ways& ways) const {
    auto plan = recall_from(limits, index, nullptr);
    if (plan && fits_before(limits, index, ways, *plan)) return plan;
    return before() == nullptr ? std::nullopt : recall_from(limits, index, before());
  }
  [[nodiscard]] std::optional<SectionPlan> recall_from(const Show& limits, SectionIndex index,
                                                       const Station* from) const {
    if (!has_id(index.at())) return std::nullopt;
    const auto bytes = reuse_.stages->find(section_key(limits, index, reuse_.film_ids[index.at()], from));
    if (!bytes) return std::nullopt;
    StageReader reader(*bytes);
    SectionPlan plan = decode_section(reader, index);
    if (!reader.whole()) return std::nullopt;
    return plan;
  }

  /// Each section may ask where the one before it leaves people.
  std::vector<bool> known(const Show& limits, const Ways& ways) {
    std::vector<bool> out(show_.sections.size(), false);
    bool all_before = true;
    for (std::size_t s = 0; s < out.size(); ++s) {
      const SectionIndex index = SectionIndex::of(s);
      if (!all_before) stations_.clear();
      std::optional<SectionPlan> section = recall(limits, index, ways);
      out[s] = section.has_value();
      if (!section && all_before && !has_film(show_.sections[s])) {
        auto listed = plan_section(limits, index, std::nullopt, ways, before(), progress_);
        if (listed) section = std::move(*listed);
      }
      all_before = all_before && section && !append(index, ways, *section);
    }
    return out;
  }
  static bool has_film(const Section& section) {
    return std::holds_alternative<VideoSource>(section.from) || std::holds_alternative<ImageSource>(section.from);
  }

  /// A section that begins when the one before ends has no time to walk: a film takes people as they stand, anything
  /// else cannot be walked and is refused by what it would take.
  void join(Station& station) const {
    if (station.frame) station.exact = false;
    station.arrive = stations_.back().depart + milliseconds(1);
    station.depart = std::max(station.depart, station.arrive);
  }

  void describe() {
    Plan& plan = planned_.plan;
    plan.title = show_.title;
    plan.stage = show_.stage;
    for (const Performer& performer : show_.performers) {
      if (performer.absent) continue;
      plan.performers.push_back(performer.id);
      plan.radius_m.push_back(performer.radius_m);
      plan.max_speed_mps.push_back(performer.max_speed_mps);
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
        const double walked_s = to_seconds(when.end - when.start);
        const Grid& grid = show_.stage.grid;
        const double walk_m = distance(grid.centre(cell_of(chain, k, p)), grid.centre(cell_of(chain, k + 1, p)));
        fastest_mps[p] = std::max(fastest_mps[p], walk_m / walked_s);
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
      }
    }
  }

  /// Everything up to here is planned as if everybody came; from here on the plan has nobody who does not.
  void stand_in() {
    auto& tracks = planned_.plan.tracks;
    for (const StandIn& one : stand_ins(show_, tracks, widest_two_m() <= clearance_m_)) {
      planned_.plan.sections.front().notes.push_back(stand_in_text(show_, one));
      if (!one.taker) continue;
      std::swap(tracks[one.absent.at()], tracks[one.taker->at()]);
      for (auto& slots : slot_) std::swap(slots[one.absent.at()], slots[one.taker->at()]);
    }
    std::size_t present = 0;
    for (std::size_t p = 0; p < tracks.size(); ++p) {
      if (show_.performers[p].absent) continue;
      if (present != p) tracks[present] = std::move(tracks[p]);
      ++present;
    }
    tracks.resize(present);
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
        if (!show_.performers[p].absent) {
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

  /// No two people need more than this because of their radii.
  [[nodiscard]] double widest_two_m() const {
    if (!second_) return 0;
    return show_.performers[widest_->at()].radius_m + show_.performers[second_->at()].radius_m;
  }
  [[nodiscard]] std::string widest_two() const {
    const Performer& one = show_.performers[widest_->at()];
    const Performer& two = show_.performers[second_->at()];
    return fmt::format("performers {} and {} (radius {:g} m and {:g} m)", one.id, two.id, one.radius_m, two.radius_m);
  }
  [[nodiscard]] std::string too_wide() const {
    return section_message(show_, SectionIndex(0),
                           fmt::format("{} must keep {:g} m, and neighbouring cells are {:g} m apart", widest_two(),
                                       widest_two_m(), show_.stage.grid.pitch_m()),
                           fmt::format("smaller radii or a pitch of at least {:g} m", widest_two_m()));
  }
  void note_wide_people() {
    const double bound_m = show_.stage.grid.clearance_bound_m();
    if (pair_by_pair_ || (clearance_m_ > show_.stage.clearance_m && clearance_m_ > bound_m)) {
      planned_.plan.sections.front().notes.push_back(
          fmt::format("{} must keep {:g} m, more than the {:.3f} m that walks on this grid keep by themselves: {}",
                      widest_two(), widest_two_m(), bound_m,
                      pair_by_pair_ ? "only people of the same radius take their places, and some may have to wait"
                                    : "everybody is planned that far apart, and many may have to wait"));
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
  double clearance_m_;
  bool pair_by_pair_ = false;  ///< wide people keep the others' distance by their own radii
  std::optional<PerformerIndex> widest_;
  std::optional<PerformerIndex> second_;
  std::vector<Station> stations_;
  std::vector<std::optional<Result<SectionPlan>>> drafts_;  ///< of videos, until they are taken
  std::vector<std::vector<std::uint32_t>> slot_;
  Planned planned_;
};

}  // namespace

Result<Planned> plan_show(const Show& show, const std::vector<std::optional<Film>>& films, const Progress& progress,
                          const Reuse& reuse) {
  auto planned = ShowPlanner(show, films, progress, reuse).run();
  if (planned && reuse.stages != nullptr) reuse.stages->forget_unused();
  return planned;
}

std::vector<bool> formations_known(const Show& show, const Reuse& reuse) {
  return ShowPlanner(show, {}, {}, reuse).known();
}

}  // namespace footlight::planner
