// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/live/live_run.hpp"
#include "controller/cue_list.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// Says where the show is and what comes next, for the line under the cursor and for other programs.
class StateText {
 public:
  /// Borrows all.
  StateText(const Show& show, const Plan& plan, const std::vector<controller::CuePlay>& plays)
      : show_(show), plan_(plan), plays_(plays) {}

  /// "ring 4:2 count 14 | 100 % | cue 2 Ring runs, GO for 3 Arrow in 3.2 s | all 12 nodes right"
  [[nodiscard]] std::string line(const DeskView& view) const;
  /// One line of JSON: docs/live.md.
  [[nodiscard]] std::string json(const DeskView& view) const;
  /// Another text whenever something has changed that is not the position alone.
  [[nodiscard]] static std::string changes(const DeskView& view);
  [[nodiscard]] const std::vector<controller::CuePlay>& plays() const { return plays_; }
  /// What a phase is called.
  [[nodiscard]] static std::string_view to_text(controller::Rehearsal::Phase phase);

  /// What happens now, or what GO would do.
  [[nodiscard]] std::string what_happens(const ShowState& state) const;

 private:
  [[nodiscard]] std::string freeze(const DeskView& view) const;
  [[nodiscard]] nlohmann::ordered_json time_of(const DeskView& view) const;
  [[nodiscard]] std::string time_line(const DeskView& view) const;
  [[nodiscard]] std::string timecode_at(Instant position) const;
  [[nodiscard]] std::string buses(const std::vector<BusView>& buses) const;
  /// What has changed, who is absent, who has to be told: " | 3 absent"; empty: nothing.
  [[nodiscard]] static std::string edit(const EditView& edit);
  [[nodiscard]] std::string_view section_at(Instant position) const;
  [[nodiscard]] std::string cue(int cue) const;

  const Show& show_;
  const Plan& plan_;
  const std::vector<controller::CuePlay>& plays_;
};

}  // namespace footlight::app
