// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/bus_figures.hpp"
#include "app/live/coming_plan.hpp"
#include "app/live/cue_thread.hpp"
#include "app/live/node_board.hpp"
#include "app/live/reset_moves.hpp"
#include "app/wire_log/wire_log.hpp"
#include "controller/tempo_limit.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "core/show.hpp"
#include "drivers/registry.hpp"

namespace footlight::app {

/// Lateness of one kind of thing, in milliseconds.
struct LatenessReport {
  std::uint64_t count = 0;
  double p50_ms = 0;
  double p99_ms = 0;
  double p999_ms = 0;
  double worst_ms = 0;
};

struct LiveBusReport : BusFigures {
  std::string url;
  LatenessReport latch;             ///< of the last bit of the latches, as far as the bus can know
  LatenessReport wake;              ///< of the thread: when it woke, behind when it wanted to
  double cpu_share = 0;             ///< processor time of the thread over the time of the run
  std::uint64_t unconfirmed = 0;    ///< nodes not confirmed right at the end
  std::vector<std::string> silent;  ///< of them, nodes in quarantine
  std::string trouble;              ///< why its wire is down at the end; empty: it is not
};

struct LiveCueReport {
  std::string number;
  std::string name;
  double go_to_last_lamp_ms = 0;  ///< GO until the last bus had handed over its first latch and its time on the wire
  std::uint64_t unconfirmed = 0;  ///< nodes not confirmed right at its end
};

struct LiveReport {
  std::uint64_t markers = 0;
  std::uint64_t switches = 0;
  double duration_s = 0;  ///< of show
  double run_s = 0;       ///< of real time, from the first byte to the last
  bool finished = false;  ///< the last cue had been played
  std::uint64_t deliveries = 0;
  std::uint64_t retries = 0;
  std::uint64_t late_latches = 0;
  std::uint64_t unconfirmed = 0;  ///< nodes not confirmed right when the show had ended
  std::uint64_t late = 0;         ///< nodes not confirmed right when the next switch was lit, all switches
  double worst_skew_ms = 0;       ///< between the first and the last bus of a switch
  std::uint64_t deaf = 0;         ///< times that a bus had not heard of the cue thread and stood still
  bool real_time = false;         ///< all threads of the show got SCHED_FIFO
  LatenessReport wake;            ///< of all bus threads
  LatenessReport bare;            ///< of a thread that does nothing but sleep, in the same run
  std::vector<LiveCueReport> cues;
  std::vector<LiveBusReport> buses;
  std::vector<std::vector<LookIndex>> floor;  ///< what every node should show when the run ends, by node of the rig
};

/// How one bus is, while it runs.
struct BusView {
  std::string_view name;
  std::size_t nodes = 0;
  std::size_t unconfirmed = 0;  ///< all of them while the wire is down
  std::size_t quarantined = 0;  ///< known where LiveOptions has a board
  controller::BusCounters counters{};
  std::string trouble{};                      ///< why the wire is down, for people; empty: it is not
  std::optional<double> load{};               ///< share of the last second that its wire was taken; none: not known
  std::optional<Duration> confirmed_after{};  ///< the last switch that all nodes confirmed: so long after its latch
  // Filled in by the desk (app/readiness/bus_health.hpp).
  std::size_t silent = 0;    ///< nodes that do not answer
  std::string last_fault{};  ///< what was the matter last; empty: nothing was
  std::int64_t last_fault_unix_ms = 0;
};

/// A gate of the show, as its input tells it.
struct GateView {
  enum class State : std::uint8_t { closed, open, lost, by_word };
  std::string name;
  State state = State::lost;
};

/// What is ready and what is not (app/readiness).
struct ReadinessView {
  struct Stage {
    std::string_view name;
    std::string_view state;  ///< "SUCCESS"
    std::string text;
  };
  std::string_view scope{};  ///< empty: nobody asks
  bool armed = true;
  std::vector<Stage> stages{};
  std::string outlives{};  ///< the program: for another one that takes the run up (Readiness::outlives)
  /// A node that is exchanged for a spare.
  struct Swap {
    std::string node;
    std::string_view step;  ///< "unplug", "plug-in", "done"
    std::string text;       ///< what is to be done now
  };
  std::optional<Swap> swap{};
  /// Before a show has its buses: a lamp that somebody has to look at.
  struct Question {
    std::string text;
    std::string cell;
  };
  std::optional<Question> question{};
};

/// What stopping the show at once would do, and going on from there (docs/looks.md).
struct FreezeView {
  bool known = false;              ///< false: it is still being judged
  std::uint32_t pairs = 0;         ///< of people who may touch when the show is frozen now
  Instant none_from = kNever;      ///< show time from which on there is none
  std::uint32_t resume_pairs = 0;  ///< who may touch when it goes on after a freeze here
};

/// What has changed and does not play yet, and who does not come.
struct EditView {
  enum class State : std::uint8_t {
    none,
    planning,
    wrong,   ///< `text` says what; what plays stays as it is
    waits,   ///< for `take` or `discard`
    taking,  ///< as soon as the show stands
  };
  struct Absent {
    std::string id;
    std::string cover;  ///< who takes the way; "repaired": whoever changes least; empty: it stays empty
  };
  State state = State::none;
  std::string text{};
  std::size_t transitions = 0;  ///< that change
  std::size_t people = 0;       ///< whose walks change
  /// People whose walks have changed and who have not been told, in natural order; another list when it changes.
  std::shared_ptr<const std::vector<std::string>> untold{};
  std::vector<Absent> absent{};
};

/// What the desk sees.
struct DeskView {
  ShowState show;
  bool roll_called = false;
  std::vector<BusView> buses;
  const controller::CueSchedule* schedule = nullptr;  ///< what lamps show; not to be kept
  std::shared_ptr<const Plan> way{};                  ///< the reset move that was planned last; null: none was
  Instant now{};                                      ///< clock; `show.at` is when the cue thread said so last
  // Filled in by the desk.
  std::string time_source = "internal";
  EditView edit{};
  std::vector<GateView> gates{};
  bool emergency_hold = false;  ///< until somebody acknowledges it
  ReadinessView readiness{};
  std::vector<std::string> against{};  ///< what stands against the next GO, or holds: "trap closed: open"
  /// Of each cue, not to be kept; null: nobody asked.
  const std::vector<controller::TempoLimit>* limits = nullptr;
  FreezeView freeze{};
  std::string standby_notes{};  ///< of the cue that the next GO starts
  std::string muted{};          ///< groups whose lamps do not guide now: "kids, trumpets"
};

/// What the desk wants.
struct DeskWishes {
  std::vector<controller::Command> commands{};
  controller::Bars bars = 0;  ///< what stands against walking, from now on
  /// Who is muted from now on: one for each group of the show, last those who are in none. None: as before.
  std::optional<std::vector<bool>> muted{};
  bool ends = false;    ///< the run
  bool nobody = false;  ///< is left to want anything
};

struct LiveOptions {
  /// True: GO as soon as the roll call is over, and again whenever the show has stood for the shortest stand.
  bool go = false;
  controller::Rehearsal::Settings rehearsal{};
  /// The show begins here and stands, held, also in the middle of a walk: a run that was cut off. None: at the top.
  std::optional<Instant> position;
  /// Asked just before the first lamp, in whose clock it answers: the show goes on from here. None: `position`.
  std::function<TakenUp(Instant now)> take_up;
  /// The desk, asked again and again by the calling thread; none: the run ends with the show.
  std::function<DeskWishes(const DeskView&)> desk;
  /// What came of each command, in their order.
  std::function<void(const Answer&)> answered;
  /// A way back was planned, or could not be.
  std::function<void(const std::string& line)> reset;
  /// Before the first byte: the fastest tempo of each cue.
  std::function<void(const std::vector<controller::TempoLimit>&)> limits;
  ResetMoves::PlanWay plan_way;
  /// Told the clock of the run before anything else happens.
  std::function<void(const Clock&)> clock{};
  /// Whoever brings other plans; null: nobody. Borrowed
  PlanChanges* changes = nullptr;
  /// Told what the cue thread has published last, some fifty times a second, by a thread that waits for nobody: not for
  /// the desk either. For whoever has to know that the show lives.
  std::function<void(const ShowState& state, bool roll_called)> heartbeat;
  /// Waits for the desk, at most so long; none: the calling thread sleeps.
  std::function<void(Duration)> wait;
  const std::atomic<bool>* stop = nullptr;
  /// Under which the markers are led, told to those that can fence; 0: none. When one of them follows a newer epoch the
  /// run ends at once.
  std::uint32_t epoch = 0;
  /// Of show time, with the nodes that are not right now.
  std::function<void(double share, std::size_t unconfirmed)> progress;
  std::function<void(const std::string& line)> moment;  ///< a line for each cue and switch
  /// Told of all that goes over the wires, by the threads of the buses; borrowed. Null: nobody.
  WireLog* wire_log = nullptr;
  /// Told what becomes of every node of the rig, by the threads of the buses; borrowed. Null: nobody.
  NodeBoard* nodes = nullptr;
  /// The roll call is over: nodes that have not confirmed the opening.
  std::function<void(std::size_t unconfirmed)> ready;
};

/// Plays a show on real ports in real time: a cue thread that sleeps until the next instant, and a thread for each bus.
/// The calling thread only looks on. Whatever ends it, no lamp is made dark: nodes with a lease hold, then lose
/// guidance; the others keep what they show.
/// @param ports one for each bus, of its kind
/// @return ErrorKind::refused for a plan that is not valid or that a bus cannot carry: then nothing has been sent;
/// ErrorKind::interrupted when told to stop
[[nodiscard]] Result<LiveReport> live_run(const Show& show, const Plan& plan, const Rig& rig,
                                          const std::vector<drivers::Port>& ports, const LiveOptions& options);

}  // namespace footlight::app
