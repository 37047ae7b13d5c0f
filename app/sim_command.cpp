// SPDX-License-Identifier: Apache-2.0
#include "app/sim_command.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/ioctl.h>
#include <unistd.h>

#include "app/floor.hpp"
#include "app/load.hpp"
#include "config/nearest.hpp"
#include "config/output_file.hpp"
#include "config/transport_map.hpp"
#include "core/clock.hpp"
#include "sim/endpoints/served_rig.hpp"

namespace footlight::app {
namespace {

constexpr Duration kLongestWait = milliseconds(100);
constexpr Duration kFrame = milliseconds(100);
constexpr int kUsualColumns = 80;
constexpr int kLastPort = 65'535;

struct Options {
  std::string show;
  std::string folder;
  int first_port = 0;
  std::vector<std::string> can;
  std::string faults;
  std::uint64_t seed = 1;
  std::string map;
};

/// Show time from the first section to the end of the last; films whose length nobody has written count as short.
Duration show_length(const Show& show) {
  Instant end = kStart;
  for (const Section& section : show.sections) end = std::max(end, show.tempo.at(section.end_count()));
  return end - kStart;
}

/// "left=vcan0", or "can0=vcan0" where the rig says can://can0.
Status<> take_can(const std::string& text, const Rig& rig, sim::Serving& serving) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    return input_error("--can " + config::in_quotes(text) + ": not BUS=INTERFACE (as --can left=vcan0)");
  }
  std::vector<std::string> known;
  bool found = false;
  for (const Bus& bus : rig.buses) {
    if (bus.kind != BusKind::can) continue;
    known.push_back(bus.name);
    if (bus.name != name && bus.url != "can://" + name) continue;
    serving.can[bus.name] = text.substr(equals + 1);
    found = true;
  }
  if (found) return Done{};
  return input_error("--can " + config::in_quotes(text) + ": the rig has no CAN bus " + config::in_quotes(name) + " (" +
                     config::suggestion(name, known, "CAN buses") + ")");
}

Result<sim::Serving> serving_of(const Options& options, const config::LoadedShow& loaded) {
  sim::Serving serving;
  if (!options.faults.empty()) {
    auto faults = sim::Faults::parse(options.faults);
    if (!faults) return faults.error();
    serving.faults = *faults;
  }
  for (const std::string& can : options.can) {
    if (auto taken = take_can(can, loaded.rig, serving); !taken) return taken.error();
  }
  const auto tcp = std::ranges::count(loaded.rig.buses, BusKind::modbus_tcp, &Bus::kind);
  if (options.first_port != 0 && options.first_port + tcp - 1 > kLastPort) {
    return input_error(fmt::format("--ports-from {}: {} Modbus TCP buses go beyond port {} (at most {})",
                                   options.first_port, tcp, kLastPort, kLastPort - tcp + 1));
  }
  serving.folder = std::filesystem::absolute(options.folder).lexically_normal();
  serving.first_port = options.first_port;
  serving.seed = options.seed;
  serving.show_length = show_length(loaded.show);
  return serving;
}

/// What the terminal or the reader of lines sees while the markers are served.
class Window {
 public:
  Window(Session& session, const config::LoadedShow& loaded, const sim::ServedRig& served)
      : session_(session), served_(served), floor_(loaded.show, loaded.rig) {
    picture_ = !session.json && !session.quiet && isatty(STDOUT_FILENO) != 0;
  }

  void open() const {
    if (session_.json) {
      nlohmann::ordered_json line{{"serving", nlohmann::ordered_json::array()}, {"left_out", served_.left_out()}};
      for (const auto& one : served_.served()) line["serving"].push_back({{"bus", one.bus}, {"url", one.url}});
      session_.print_now(line.dump());
      return;
    }
    if (picture_) session_.print_now("\x1B[2J");
    session_.print_now(endpoints());
  }

  void see(Instant now) {
    for (const LampChange& change : floor_.look_at(served_.rig(), now)) {
      if (session_.json) session_.print(floor_.json(change));
    }
  }

  void refresh(Instant now) {
    if (session_.json) std::fflush(stdout);
    if (!picture_ || now < next_frame_) return;
    next_frame_ = now + kFrame;
    winsize size{};
    const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    session_.print_now("\x1B[H" + endpoints() + "\n" + floor_.picture(now, known ? size.ws_col : kUsualColumns) +
                       fmt::format("{:.1f} s   Ctrl-C ends\x1B[K", to_seconds(now)));
  }

  void close(Instant now) const {
    if (session_.json) session_.print_now(floor_.json(now));
  }

 private:
  [[nodiscard]] std::string endpoints() const {
    std::string text;
    for (const auto& one : served_.served()) text += fmt::format("  {:<16} {}\x1B[K\n", one.bus, one.url);
    for (const std::string& bus : served_.left_out()) {
      text += fmt::format("  {:<16} not served: CAN needs an interface (--can {}=vcan0)\x1B[K\n", bus, bus);
    }
    if (picture_) return text;
    std::string plain;
    for (std::size_t at = 0, end = 0; at < text.size(); at = end + 3) {
      end = std::min(text.find("\x1B[K", at), text.size());
      plain += text.substr(at, end - at);
    }
    return plain;
  }

  Session& session_;
  const sim::ServedRig& served_;
  Floor floor_;
  bool picture_ = false;
  Instant next_frame_ = kStart;
};

Status<> write_map(Session& session, const Options& options, const config::LoadedShow& loaded,
                   const sim::ServedRig& served) {
  if (options.map.empty()) return Done{};
  if (auto spared = spare_inputs(loaded, options.map); !spared) return spared;
  std::vector<config::BusTransport> transports;
  for (const auto& one : served.served()) transports.push_back({one.bus, one.url});
  auto written = config::write_file(
      options.map,
      config::transport_map_text(transports, "where `footlight sim` serves the markers of " + options.show));
  if (written) session.note("footlight run " + options.show + " --transport-map " + options.map + " plays to them");
  return written;
}

int run(Session& session, const Options& options) {
  const auto loaded = read_show(session, options.show);
  if (!loaded) return session.fail(loaded.error());
  const auto serving = serving_of(options, *loaded);
  if (!serving) return session.fail(serving.error());
  const SteadyClock clock;
  const auto served = sim::ServedRig::open(loaded->rig, *serving, clock, nullptr);
  if (!served) return session.fail(served.error());
  if (auto written = write_map(session, options, *loaded, **served); !written) return session.fail(written.error());
  Window window(session, *loaded, **served);
  window.open();
  while (!session.stopped() && std::ferror(stdout) == 0) {
    (*served)->step(kLongestWait, [&](Instant now) { window.see(now); });
    window.refresh((*served)->now());
  }
  window.close((*served)->now());
  return 0;
}

}  // namespace

void add_sim_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("sim", "Serve the rig's markers, simulated, to other programs");
  auto options = std::make_shared<Options>();
  options->folder = (std::filesystem::temp_directory_path() / fmt::format("footlight-{}", getuid())).string();
  command->add_option("SHOW", options->show, "show file (YAML)")->required();
  command->add_option("--dir", options->folder, "folder for the links to the serial ports, one named as each bus")
      ->capture_default_str();
  command->add_option("--ports-from", options->first_port, "Modbus TCP on this loopback port and those after it")
      ->check(CLI::Range(1, kLastPort))
      ->default_str("any that are free");
  command->add_option("--can", options->can, "BUS=INTERFACE: serve a CAN bus on a SocketCAN interface, as left=vcan0");
  command->add_option("--faults", options->faults,
                      "what goes wrong, for example loss=5%,reboot=2 (also corrupt, duplicate, delay, dead, until)");
  command->add_option("--seed", options->seed, "what happens by chance depends on this number")->capture_default_str();
  command->add_option("--write-map", options->map, "write where the buses are, for `footlight run --transport-map`");
  session.add_options(*command, true);
  command->footer(
      "Serial and Modbus RTU buses are pseudo-terminals behind links in --dir, Modbus TCP buses gateways on "
      "127.0.0.1.\n"
      "Every byte takes the time that it takes on the wire. A terminal shows the floor, upstage at the top; --json\n"
      "prints where the buses are, then a line for each lamp that changes, at the end the whole floor. SIGINT ends "
      "it.\n\n"
      "Examples:\n  footlight sim show.yaml --write-map map.yaml\n"
      "  footlight run show.yaml --transport-map map.yaml\n"
      "  mbpoll -m rtu -b 115200 -P even -a 1 -0 -r 64 -c 6 /tmp/footlight-0/stage-left\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
