// SPDX-License-Identifier: Apache-2.0
#include "app/run_command.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commission/wipe_record.hpp"
#include "app/console/console_options.hpp"
#include "app/edit/show_editing.hpp"
#include "app/growing_file.hpp"
#include "app/live/live_report.hpp"
#include "app/live/live_run.hpp"
#include "app/plan_step.hpp"
#include "app/readiness/preflight.hpp"
#include "app/readiness/readiness_surface.hpp"
#include "app/rehearsing/rehearsing.hpp"
#include "app/remote/remote_control.hpp"
#include "app/reset_way.hpp"
#include "app/simulated_buses.hpp"
#include "app/sound/heard_count_in.hpp"
#include "app/speaking.hpp"
#include "app/state_folder.hpp"
#include "app/surfaces/prompt_desk.hpp"
#include "app/surviving/supervisor.hpp"
#include "app/surviving/surviving.hpp"
#include "app/time/time_options.hpp"
#include "app/wire_check.hpp"
#include "app/wire_log/wire_recorder.hpp"
#include "app/writer_thread.hpp"
#include "config/output_file.hpp"
#include "config/plan_digest.hpp"
#include "config/transport_map.hpp"
#include "core/clock.hpp"
#include "core/file_descriptor.hpp"

namespace footlight::app {
namespace {

constexpr Duration kPortsWithin = milliseconds(10'000);
constexpr Duration kPortsAgain = milliseconds(50);
constexpr Duration kSilence = milliseconds(2000);  // of the cue thread, before it is taken for dead

struct Options {
  PlanChoice choice;
  std::string transports;
  std::string wire_log;
  std::string state;
  bool go = false;
  bool status_lines = false;
  std::optional<double> count_in_counts;
  double go_guard_s = 1;
  ConsoleOptions console;
  SurvivingOptions surviving;
  RemoteOptions remote;
  ReadyOptions ready;
  RehearsingOptions rehearsing;
  SoundOptions sound;
  TimeOptions time;

  /// Nobody has to be counted in where GO presses itself.
  [[nodiscard]] double count_in() const { return count_in_counts.value_or(go ? 0 : 4); }
};

Status<> find_buses(const Options& options, Rig& rig) {
  if (!options.transports.empty()) {
    if (auto taken = config::take_transports(options.transports, rig); !taken) {
      return input_error(taken.error().to_text());
    }
  }
  std::string without;
  for (const Bus& bus : rig.buses) {
    if (bus.simulated()) without += (without.empty() ? "" : ", ") + bus.name;
  }
  if (without.empty()) return Done{};
  return input_error("no wire for these buses: " + without +
                     " (a real URL in the rig or in --transport-map; `footlight sim --write-map` writes one, "
                     "`footlight dryrun` needs none)");
}

/// Every port or none; all that the machine refuses is told at once.
Result<std::vector<drivers::Port>> open_ports(const Rig& rig) {
  std::vector<drivers::Port> ports;
  std::string refused;
  ErrorKind kind = ErrorKind::input;
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    auto port = drivers::open_port(rig.buses[b], drivers::node_addresses(rig, BusIndex::of(b)));
    if (port) {
      ports.push_back(std::move(port).value());
      continue;
    }
    refused += (refused.empty() ? "" : "\n") + port.error().message;
    if (port.error().kind == ErrorKind::device) kind = ErrorKind::device;
  }
  if (!refused.empty()) return Error{kind, refused};
  return ports;
}

/// A run that is taken up may find a port that the kernel, or a hub, has not given back yet.
Result<std::vector<drivers::Port>> open_ports_again(Session& session, const Rig& rig, bool taken_up) {
  const SteadyClock clock;
  const Instant until = clock.now() + (taken_up ? kPortsWithin : Duration{});
  auto ports = open_ports(rig);
  while (!ports && ports.error().kind == ErrorKind::device && clock.now() < until && !session.stopped()) {
    std::this_thread::sleep_for(kPortsAgain);
    ports = open_ports(rig);
  }
  return ports;
}

std::string nodes_text(std::size_t nodes) { return fmt::format("{} node{}", nodes, nodes == 1 ? "" : "s"); }

/// What this run leaves behind for `footlight bundle`. A disk that takes nothing costs a note, not the show.
class Traces {
 public:
  Traces(Session& session, const Options& options, const PlannedShow& planned, const Rig& rig)
      : session_(session), folder_(state_folder(options.state)) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    const auto file = std::make_shared<FileDescriptor>(
        ::open((folder_ / "moments.txt").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
    moments_ = std::make_unique<WriterThread>(
        [file](std::string_view text) { return WriterThread::write_all(file->get(), text); });
    nlohmann::ordered_json run{{"version", FOOTLIGHT_VERSION},
                               {"started_since_1970_s", to_seconds(wall_time())},
                               {"show", std::filesystem::absolute(options.choice.show).string()},
                               {"plan_of", planned.plan().show_hash},
                               {"buses", nlohmann::ordered_json::array()}};
    for (const Bus& bus : rig.buses) run["buses"].push_back({{"name", bus.name}, {"url", bus.url}});
    write("run.json", run.dump(2) + "\n");
    std::filesystem::remove(folder_ / "report.json", error);
  }
  void moment(const std::string& line) { moments_->put(line + "\n"); }
  void write(const char* name, const std::string& text) {
    if (auto written = config::write_file(folder_ / name, text); !written) session_.note(written.error().message);
  }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::filesystem::path ring() const { return folder_ / "wires"; }

 private:
  Session& session_;
  std::filesystem::path folder_;
  std::unique_ptr<WriterThread> moments_;
};

void tell_limits(Session& session, const Show& show, const Plan& plan,
                 const std::vector<controller::TempoLimit>& limits) {
  const auto plays = controller::cue_plays(show, plan);
  for (std::size_t c = 0; c < limits.size(); ++c) {
    if (limits[c].because.empty()) continue;
    session.note(fmt::format("cue {}: tempo at most {} %: {}", plays[c].cue.number.to_text(), limits[c].percent,
                             limits[c].because));
  }
}

std::string how_it_ended(const Result<LiveReport>& report) {
  if (report) return report->finished ? kOver : kQuit;
  return report.error().kind == ErrorKind::interrupted ? "interrupted" : report.error().message;
}

/// Nothing without --sound, and where there is no loudspeaker: that costs a note.
Result<std::unique_ptr<HeardCountIn>> heard(Session& session, const Options& options, const Show& show,
                                            const Clock& clock) {
  if (options.sound.to.empty()) return std::unique_ptr<HeardCountIn>();
  auto sound = HeardCountIn::open(show, options.sound, options.count_in(), clock);
  if (sound) {
    if (!(*sound)->lacks().empty()) session.note((*sound)->lacks());
    return sound;
  }
  if (sound.error().kind == ErrorKind::input) return std::move(sound).error();
  session.note(sound.error().message + ": the count-in is not heard (--sound FILE.wav writes it)");
  return std::unique_ptr<HeardCountIn>();
}

Result<LiveReport> play(Session& session, const Options& options, PlannedShow& planned, Rig& rig,
                        const std::vector<drivers::Port>& ports, Traces& traces, WireLog* wire_log,
                        const std::optional<CutOff>& cut, Readiness& readiness, TimePlaces& time,
                        const Attendance& attendance, RunDesk& desk, Console* console) {
  const auto journal = journal_in(state_folder(options.state));
  const std::uint32_t epoch = cut && cut->epoch != 0 ? cut->epoch : next_epoch(journal);
  const Show& show = planned.loaded.show;
  time.add_to(desk);
  PromptDesk prompt(session, show, planned.plan(), desk, options.status_lines, !options.go);
  desk.add(prompt);
  const SteadyClock clock;
  const auto remote = RemoteControl::open(options.remote, show, planned.plan(), desk, clock, !options.go);
  if (!remote) return remote.error();
  if (cut && cut->place.emergency_hold) (*remote)->take_up_emergency_hold();
  ShowEditing editing(desk,
                      {planned, rig, options.choice.show, state_folder(options.state), options.count_in(), attendance});
  desk.add(editing);
  LiveOptions live;
  NodeBoard board(rig.nodes.size());
  live.nodes = console != nullptr ? &console->nodes() : &board;
  Surviving surviving(journal, std::filesystem::absolute(options.choice.show).string(),
                      config::digest_of(planned.plan()), epoch);
  if (auto opened = surviving.open_door(options.surviving, [&](const std::string& line) { session.note(line); });
      !opened) {
    return std::move(opened).error();
  }
  surviving.join(desk);
  live.heartbeat = [&](const ShowState& state, bool roll_called) { surviving.beat(state, roll_called); };
  live.epoch = epoch;
  BusHealth health(rig, *live.nodes, desk, [&](const std::string& line) { surviving.journal().health_is(line); });
  desk.add(health);
  ReadinessSurface ready(readiness, rig, *live.nodes, health, desk, options.go);
  desk.add(ready);
  if (cut) surviving.take_up(*cut, options.surviving.after, desk, live);
  live.changes = &editing;
  editing.on_taken([&] { surviving.plan_is(config::digest_of(planned.plan())); });
  live.go = options.go;
  live.rehearsal = {options.count_in(), seconds(options.go_guard_s)};
  const SteadyClock sound_clock;
  auto sound = heard(session, options, show, sound_clock);
  if (!sound) return std::move(sound).error();
  if (*sound) {
    desk.add(**sound);
    live.rehearsal.before_count_in = options.sound.ahead();
  }
  live.stop = session.stop();
  live.wire_log = wire_log;
  Rehearsing rehearsing(show, planned.plan(), desk, traces.folder(), options.rehearsing);
  live.desk = [&](DeskView view) {
    view.edit = editing.view();
    DeskWishes wishes = desk.look(view);
    wishes.ends = wishes.ends || surviving.handed_over();
    return wishes;
  };
  live.answered = [&](const Answer& answer) { desk.answered(answer); };
  live.clock = [&](const Clock& run) { time.use(run); };
  live.wait = [&](Duration most) { desk.wait(most); };
  live.reset = [&](const std::string& line) {
    traces.moment(line);
    desk.tell({RunEvent::Kind::reset, line});
  };
  live.plan_way = [&](Instant from, Instant to, const std::atomic<bool>& abandoned) {
    return plan_reset_way(show, planned.plan(), from, to, std::max(1.0, options.count_in()), abandoned);
  };
  live.limits = [&](const std::vector<controller::TempoLimit>& limits) {
    rehearsing.set_limits(limits);
    tell_limits(session, show, planned.plan(), limits);
    if (console != nullptr) console->take_limits(limits);
  };
  live.ready = [&](std::size_t unconfirmed) {
    session.note(unconfirmed == 0 ? "every node shows the opening"
                                  : nodes_text(unconfirmed) + " of the rig not confirmed to show the opening");
  };
  const bool keys = !options.go && RawTerminal::there();
  live.progress = [&, keys](double share, std::size_t unconfirmed) {
    if (keys) return;  // the desk has the line
    session.tell(unconfirmed == 0 ? "show" : "show, " + nodes_text(unconfirmed) + " not right,", share);
  };
  live.moment = [&](const std::string& line) {
    traces.moment(line);
    desk.tell({RunEvent::Kind::moment, line});
  };
  auto report = live_run(show, planned.plan(), rig, ports, live);
  surviving.close(how_it_ended(report));
  if (report && surviving.handed_over()) report = refusal("an understudy leads now: this run has stood back");
  session.clear_line();
  for (const std::string& trouble : rehearsing.finish(report ? &*report : nullptr)) session.note(trouble);
  return report;
}

Status<> keep(Session& session, WireRecorder& recorder, std::optional<GrowingFile>& file) {
  recorder.close();
  if (recorder.dropped() > 0) {
    session.note(fmt::format("{} packets are not in the wire logs: the disk was too slow", recorder.dropped()));
  }
  if (!recorder.whole()) session.note("the wire logs of the last ten minutes are not whole: the disk took no more");
  return file ? file->keep() : Status<>(Done{});
}

/// What planning this show has given before, for whatever is edited while it runs.
std::string stages_for_edits(const Options& options) {
  const std::filesystem::path folder = state_folder(options.state);
  const std::string stages = (folder / "coming.stages").string();
  const std::string plan = options.choice.plan.empty() ? plan_file_beside(options.choice.show) : options.choice.plan;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::filesystem::copy_file(stage_file_beside(plan), stages, std::filesystem::copy_options::update_existing, error);
  return stages;
}

/// Who was absent when the run was cut off that is taken up, and the plan that played then; else nobody.
Attendance attendance_of(const Options& options, PlanChoice& choice) {
  const std::filesystem::path folder = state_folder(options.state);
  if (!options.surviving.resume) {
    forget_taken(folder);
    return {};
  }
  return take_up_taken(folder, choice);
}

int run_show(Session& session, const Options& options) {
  if (options.surviving.supervised) {
    return supervise("/proc/self/exe", own_arguments(), kSilence, [&](const std::string& line) { session.note(line); });
  }
  PlanChoice choice = options.choice;
  choice.stages = stages_for_edits(options);
  const Attendance attendance = attendance_of(options, choice);
  auto planned = plan_for(session, choice, false);
  if (!planned) return session.fail(planned.error());
  if (planned->keep_stages) (void)planned->keep_stages();  // else the first edit is planned from nothing
  // A plan that is not proved, or whose lamps cannot be lit in time, never opens a wire.
  if (const auto refused = refusal_of(planned->planned)) return session.fail(*refused);
  std::optional<CutOff> cut;
  if (options.surviving.resume) {
    std::string told;
    auto found = find_cut_off(journal_in(state_folder(options.state)), config::digest_of(planned->plan()), told);
    if (!found) return session.fail(found.error());
    cut = *found;
    if (!told.empty()) session.note(told);
  }
  if (!options.surviving.understudy.empty()) {
    auto taken = follow_lead(
        options.surviving, config::digest_of(planned->plan()), [&](const std::string& line) { session.note(line); },
        session.stop());
    if (!taken) return session.fail(taken.error());
    cut = *taken;
  }
  Rig rig = planned->loaded.rig;
  if (auto found = find_buses(options, rig); !found) return session.fail(found.error());
  if (auto lit = check_delivery(planned->loaded.show, planned->plan(), rig); !lit) return session.fail(lit.error());
  if (auto wires = check_wires(session, rig.buses); !wires) return session.fail(wires.error());
  Readiness readiness(options.ready.scope);
  const SteadyClock clock;
  const Show& show = planned->loaded.show;
  RunDesk desk(show, planned->plan());
  std::unique_ptr<Console> console;
  if (options.ready.scope != Scope::none) {
    auto opened =
        options.console.open(session, state_folder(options.state), show, planned->plan(), rig, desk, !options.go);
    if (!opened) return session.fail(opened.error());
    console = std::move(opened).value();
  }
  EarlyDesk early(show, planned->plan(), rig, readiness, clock);
  if (console) early.add(*console);
  BusesToAsk wires{rig};
  // Whatever was so before the machine was started again, somebody has to look.
  if (cut) wires.outlived = cut->same_start ? cut->place.readiness : "";
  if (auto ready = preflight(session, wires, show, readiness, early); !ready) return session.fail(ready.error());
  if (options.ready.scope == Scope::none) {
    session.print(session.json ? stages_json(readiness) : stages_text(readiness));
    return 0;
  }
  if (console) console->begin();
  const auto time = options.time.open(planned->loaded.show, options.go, clock);
  if (!time) return session.fail(time.error());
  const auto ports = open_ports_again(session, rig, cut.has_value());
  if (!ports) return session.fail(ports.error());
  const std::string unfenced = unfenced_text(rig.buses);
  readiness.tell(Readiness::Stage::buses, unfenced.empty() ? Readiness::State::success : Readiness::State::warning,
                 fmt::format("{} open{}{}", rig.buses.size(), unfenced.empty() ? "" : "; ", unfenced));
  if (const auto changed = wipe_note(state_folder(options.state), options.choice.show, rig)) session.note(*changed);
  Traces traces(session, options, *planned, rig);
  std::optional<GrowingFile> file;
  if (!options.wire_log.empty()) {
    if (auto spared = spare_inputs(planned->loaded, options.wire_log); !spared) return session.fail(spared.error());
    if (auto opened = file.emplace("wire log", options.wire_log).open(); !opened) return session.fail(opened.error());
  }
  for (const std::string& line : prepare_for_real_time()) session.note(line);
  auto recorder = WireRecorder::open(rig, {traces.ring(), file ? &file->stream() : nullptr}, clock);
  if (!recorder) {
    session.note(recorder.error().message);
    recorder = WireRecorder::open(rig, {{}, file ? &file->stream() : nullptr}, clock);
    if (!recorder) return session.fail(recorder.error());
  }
  const auto report = play(session, options, *planned, rig, *ports, traces, recorder->get(), cut, readiness, **time,
                           attendance, desk, console.get());
  console.reset();  // tells the pages that the run is over
  if (auto kept = keep(session, **recorder, file); !kept) return session.fail(kept.error());
  if (!report) return session.fail(report.error());
  traces.write("report.json", live_json(*report, rig));
  if (options.status_lines) {
    session.print_now(
        nlohmann::ordered_json{{"report", nlohmann::ordered_json::parse(live_json(*report, rig))}}.dump());
  } else {
    session.print(session.json ? live_json(*report, rig) : live_text(*report));
  }
  if (report->unconfirmed > 0) return session.fail(device_error(live_failure(*report)));
  return 0;
}

/// Nobody who leads the show waits for who reads what it says.
int run(Session& session, const Options& options) {
  Speaking speaking;
  const int status = run_show(session, options);
  const auto said = speaking.end();
  return said || status != 0 ? status : session.fail(said.error());
}

}  // namespace

void add_run_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("run", "Play the show on its real buses, in real time");
  auto options = std::make_shared<Options>();
  options->choice.add_options(*command);
  command->add_option("--transport-map", options->transports,
                      "YAML file: where buses are here and today, instead of where the rig says");
  command->add_flag("--go", options->go, "press GO when all nodes have answered, and whenever the show waits");
  command
      ->add_option("--count-in", options->count_in_counts,
                   "counts before each GO takes effect, a hold is left and a reset move begins (4; with --go 0)")
      ->check(CLI::Range(0.0, 64.0));
  command->add_option("--go-guard", options->go_guard_s, "least time between two GOs, s")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  command->add_flag("--status-lines", options->status_lines,
                    "every line on stdout is a JSON document: state, answer, moment, reset, and the report at last");
  options->console.add_options(*command);
  command->add_option("--wire-log", options->wire_log,
                      "write all that goes over the wires to this pcapng file, for Wireshark");
  command->add_option("--state", options->state, "folder for the last ten minutes of every wire and what the run said")
      ->default_str("~/.local/state/footlight");
  options->surviving.add_options(*command);
  options->remote.add_options(*command);
  options->ready.add_options(*command);
  options->rehearsing.add_options(*command);
  options->sound.add_options(*command);
  options->time.add_options(*command);
  session.add_options(*command, true);
  command->footer(
      "In a terminal Space is GO and ? tells the other keys: hold, back, jump, loop, tempo. Else stdin is read in\n"
      "lines, \"help\" lists them, and an empty line is GO. HOLD IS NO EMERGENCY STOP: somebody must watch the stage.\n"
      "BACK, a jump and the end of a loop first light a planned way for everybody, confirmed by GO.\n\n"
      "At first the look table is uploaded, every node asked and the opening lit. A plan that is refused never "
      "reaches\n"
      "a marker. At the end every node has to have confirmed what it shows: exit status 4 when one has not, or when a\n"
      "bus cannot be opened. SIGINT ends it and makes no lamp dark: markers hold, then lose guidance.\n\n"
      "Examples:\n  footlight run show.yaml\n  footlight sim show.yaml --write-map map.yaml &\n"
      "  footlight run show.yaml --transport-map map.yaml --go\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
