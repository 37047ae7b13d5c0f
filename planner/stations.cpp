// SPDX-License-Identifier: Apache-2.0
#include "planner/stations.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

#include "core/parts.hpp"
#include "planner/by_hand.hpp"
#include "planner/joint_section.hpp"
#include "planner/parallel.hpp"
#include "planner/section_stage.hpp"

namespace footlight::planner {
namespace {

/// How far several pieces of work are that go on at the same time, told from the calling thread.
class Together {
 public:
  Together(std::size_t pieces, const char* stage, const Progress& progress)
      : stage_(stage), progress_(progress), caller_(std::this_thread::get_id()), shares_(pieces) {
    progress_.tell(stage_, 0);
  }
  /// Of one piece, which may report from any thread.
  [[nodiscard]] Progress of(std::size_t piece) {
    return {[this, piece](std::string_view stage, double share) { tell(piece, stage, share); }, progress_.stop};
  }

 private:
  void tell(std::size_t piece, std::string_view stage, double share) {
    if (stage != stage_) return;
    shares_[piece].store(share, std::memory_order_relaxed);
    if (std::this_thread::get_id() != caller_) return;
    double sum = 0;
    for (const auto& one : shares_) sum += one.load(std::memory_order_relaxed);
    progress_.tell(stage_, sum / static_cast<double>(shares_.size()));
  }

  std::string_view stage_;
  const Progress& progress_;
  std::thread::id caller_;
  std::vector<std::atomic<double>> shares_;
};

class StationCollector {
 public:
  StationCollector(const StationsTask& task, const Progress& progress)
      : show_(*task.show),
        limits_(*task.limits),
        films_(task.films),
        ways_(*task.ways),
        reuse_(*task.reuse),
        progress_(progress) {}

  Result<CollectedStations> run() {
    draft_videos();
    if (progress_.stopped()) return Error{ErrorKind::interrupted, "planning was stopped"};
    for (std::size_t s = 0; s < show_.sections.size(); ++s) {
      auto section = section_of(SectionIndex::of(s));
      if (!section) return section.error();
      if (auto error = append(SectionIndex::of(s), *section)) return *error;
      out_.sections.push_back(std::move(section->section));
    }
    return std::move(out_);
  }

  /// Each section may ask where the one before it leaves people.
  std::vector<bool> known() {
    std::vector<bool> out(show_.sections.size(), false);
    bool all_before = true;
    for (std::size_t s = 0; s < out.size(); ++s) {
      const SectionIndex index = SectionIndex::of(s);
      if (!all_before) out_.stations.clear();
      std::optional<SectionPlan> section = known_section(index);
      out[s] = section.has_value();
      if (!section && all_before && !has_film(show_.sections[s]) && !moves(index)) {
        auto listed = plan_section(limits_, index, std::nullopt, ways_, before(), progress_);
        if (listed) section = std::move(*listed);
      }
      all_before = all_before && section && !append(index, *section);
    }
    return out;
  }

 private:
  static bool has_film(const Section& section) {
    const auto* parts = std::get_if<PartsSource>(&section.from);
    return parts != nullptr ? needs_pictures(*parts) : !std::holds_alternative<CellsSource>(section.from);
  }
  /// Sections with a model of motion are always planned anew; their walks are kept like all others.
  [[nodiscard]] bool moves(SectionIndex index) const { return show_.sections[index.at()].motion != nullptr; }
  [[nodiscard]] const std::optional<Film>& film(SectionIndex index) const { return (*films_)[index.at()]; }
  [[nodiscard]] const Station* before() const { return out_.stations.empty() ? nullptr : &out_.stations.back(); }

  std::optional<Error> append(SectionIndex index, SectionPlan& section) {
    if (auto error = apply_overrides(show_, index, ways_, section)) return error;
    for (Station& station : section.stations) {
      if (before() != nullptr && station.arrive <= before()->depart) join(station);
      out_.stations.push_back(std::move(station));
    }
    return std::nullopt;
  }

  /// A section that begins when the one before ends has no time to walk: a film takes people as they stand, anything
  /// else cannot be walked and is refused by what it would take.
  void join(Station& station) const {
    if (station.frame) station.exact = false;
    station.arrive = before()->depart + milliseconds(1);
    station.depart = std::max(station.depart, station.arrive);
  }

  /// Formations of a section that were planned before, without the film; else anew.
  Result<SectionPlan> section_of(SectionIndex index) {
    out_.count.add();
    if (auto plan = known_section(index)) return std::move(*plan);
    out_.count.add_anew();
    auto section = taken_draft(index);
    if (!section) section = plan_section(limits_, index, film(index), ways_, before(), progress_);
    if (*section && has_id(index)) {
      const Station* from = (*section)->begin == Begin::from_before ? before() : nullptr;
      reuse_.stages->keep(section_key(limits_, index, reuse_.film_ids[index.at()], from), encode_section(**section));
    }
    return std::move(*section);
  }

  [[nodiscard]] bool has_id(SectionIndex index) const {
    return reuse_.stages != nullptr && index.at() < reuse_.film_ids.size() && !reuse_.film_ids[index.at()].empty() &&
           !moves(index);
  }
  [[nodiscard]] std::optional<SectionPlan> known_section(SectionIndex index) const {
    auto plan = known_from(index, nullptr);
    if (plan && fits_before(index, *plan)) return plan;
    return before() == nullptr ? std::nullopt : known_from(index, before());
  }
  [[nodiscard]] std::optional<SectionPlan> known_from(SectionIndex index, const Station* from) const {
    if (!has_id(index)) return std::nullopt;
    const auto bytes = reuse_.stages->find(section_key(limits_, index, reuse_.film_ids[index.at()], from));
    if (!bytes) return std::nullopt;
    StageReader reader(*bytes);
    SectionPlan plan = decode_section(reader, index);
    if (!reader.whole()) return std::nullopt;
    return plan;
  }
  /// Whether a plan that was made without the formation before holds with it.
  [[nodiscard]] bool fits_before(SectionIndex index, const SectionPlan& plan) const {
    if (plan.begin != Begin::where_best || before() == nullptr) return true;
    const Station& first = plan.stations.front();
    return recall(
        reuse_.stages, begin_key(limits_, index, *before(), first), nullptr,
        [](StageReader& reader) { return reader.get<bool>(); },
        [](bool fits) { return StageWriter().add(fits).take(); },
        [&] { return can_begin(limits_, index, ways_, *before(), first); });
  }

  void draft_videos() {
    drafts_.assign(show_.sections.size(), std::nullopt);
    std::vector<SectionIndex> videos;
    for (std::size_t s = 0; s < drafts_.size(); ++s) {
      const Section& section = limits_.sections[s];
      if (section.planner.model != PlannerModel::joint || !std::holds_alternative<VideoSource>(section.from)) continue;
      const SectionIndex index = SectionIndex::of(s);
      const bool no_gap = s > 0 && limits_.sections[s - 1].end_count() >= section.start_count;
      if (film(index) && !no_gap && !known_from(index, nullptr)) videos.push_back(index);
    }
    if (videos.size() < 2) return;
    Together together(videos.size(), "joint", progress_);
    for_each_index(videos.size(), "joint", {{}, progress_.stop}, [&](std::size_t n) {
      drafts_[videos[n].at()] = plan_section(limits_, videos[n], film(videos[n]), ways_, nullptr, together.of(n));
    });
    progress_.tell("joint", 1);
  }
  std::optional<Result<SectionPlan>> taken_draft(SectionIndex index) {
    auto draft = std::exchange(drafts_[index.at()], std::nullopt);
    if (draft && *draft && !fits_before(index, **draft)) return std::nullopt;
    return draft;
  }

  const Show& show_;
  const Show& limits_;
  const std::vector<std::optional<Film>>* films_;
  const Ways& ways_;
  const Reuse& reuse_;
  const Progress& progress_;
  CollectedStations out_;
  std::vector<std::optional<Result<SectionPlan>>> drafts_;  ///< of videos, until they are taken
};

}  // namespace

Result<CollectedStations> collect_stations(const StationsTask& task, const Progress& progress) {
  return StationCollector(task, progress).run();
}

std::vector<bool> sections_known(const StationsTask& task) { return StationCollector(task, {}).known(); }

}  // namespace footlight::planner
