// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/edit/attendance.hpp"
#include "app/edit/coming_show.hpp"
#include "app/edit/file_watch.hpp"
#include "app/edit/told_list.hpp"
#include "app/live/coming_plan.hpp"
#include "app/plan_step.hpp"
#include "app/surfaces/run_desk.hpp"
#include "app/surfaces/surface.hpp"

namespace footlight::app {

/// Another show, or other people, in a run (docs/editing.md). The show's files are watched; what is said about people
/// is heard as orders: absent, present, cover, repair. What comes of either is prepared beside the show, told, and
/// taken by `take` where the show stands; what is wrong is told and changes nothing. One thread, that of the desk.
class ShowEditing final : public Surface, public PlanChanges {
 public:
  struct Run {
    PlannedShow& planned;  ///< what plays; has other contents when something is taken
    Rig& rig;              ///< with the wires of today; so has this
    std::string show_file;
    std::filesystem::path state;
    double count_in_counts = 4;
    Attendance attendance{};  ///< of what plays
  };

  /// Adds its orders to the desk.
  ShowEditing(RunDesk& desk, Run run);
  ~ShowEditing() override;

  /// Called when something has been taken, before anybody is told.
  void on_taken(std::function<void()> then) { on_taken_ = std::move(then); }

  // Surface
  void look(const DeskView& view, RunDesk& desk) override;
  [[nodiscard]] int file() const override { return watch_.file(); }
  [[nodiscard]] bool listens() const override { return false; }

  // PlanChanges
  void begin(const ShowOnWires& wires) override;
  std::unique_ptr<ComingPlan> wanted(const ShowState& state) override;
  void taken(const ShowOnWires& plays) override;
  void not_taken() override;
  void end() override;

  [[nodiscard]] EditView view() const;

 private:
  /// A way from where people stand to where the coming show has them.
  struct Way {
    Instant from{};
    Instant to{};
    std::future<Result<Plan>> planned;
    std::optional<Result<Plan>> found;
  };
  using Words = std::vector<std::string>;

  void add_orders(RunDesk& desk);
  Result<std::string> take(const Words& words);
  Result<std::string> discard();
  Result<std::string> list_changed() const;
  Result<std::string> tick(const Words& words);
  Result<std::string> absent(const Words& words);
  Result<std::string> present(const Words& words);
  Result<std::string> cover(const Words& words);
  Result<std::string> repair(const Words& words);
  [[nodiscard]] Result<std::string> person(const Words& words) const;
  [[nodiscard]] Result<std::string> standing_by(const std::string& absent, const Words& words) const;
  [[nodiscard]] std::string plays_as(const std::string& absent) const;

  void plan_again(std::string why);
  void forget_wishes();
  void start();
  void finish();
  void drop_coming();
  void stop_work();
  void tell(RunEvent::Kind kind, std::string text);
  void keep(const Status<>& written);
  [[nodiscard]] Way* way_from(const ShowState& state);
  [[nodiscard]] std::unique_ptr<ComingPlan> hand_over(Instant from, Instant to, const Plan* way);

  RunDesk& desk_;
  std::function<void()> on_taken_;
  Run run_;
  FileWatch watch_;
  ToldList told_;
  PlayingNow playing_;
  std::optional<controller::Stands> stands_;  ///< of the plan that plays
  Show everybody_;                            ///< performers and understudies, whoever is absent

  // Who does not come, by the operator's word.
  Attendance wanted_;     ///< as it was said
  Attendance made_with_;  ///< of what is being prepared, or is ready
  Attendance plays_;

  std::string why_;  ///< what is being prepared, or was
  bool again_ = false;
  std::atomic<bool> given_up_{false};
  std::future<Result<std::unique_ptr<ComingShow>>> work_;
  std::unique_ptr<ComingShow> coming_;
  std::string error_;  ///< why there is none
  bool take_ = false;
  bool placed_ = false;  ///< people stand where the coming plan wants them, by the operator's word
  bool handing_over_ = false;
  std::string walks_;  ///< to the plan that is being taken, for people
  std::atomic<bool> way_given_up_{false};
  std::optional<Way> way_;
};

}  // namespace footlight::app
