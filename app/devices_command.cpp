// SPDX-License-Identifier: Apache-2.0
#include "app/devices_command.hpp"

#include <charconv>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/commission/wipe_record.hpp"
#include "app/device_bus.hpp"
#include "app/devices_report.hpp"
#include "app/machine_wires.hpp"
#include "app/simulated_buses.hpp"
#include "app/state_folder.hpp"
#include "app/wire_check.hpp"
#include "config/nearest.hpp"
#include "config/quantity.hpp"
#include "core/clock.hpp"
#include "core/patch.hpp"

namespace footlight::app {
namespace {

using controller::BusService;

constexpr double kLongestTestS = 86'400;
constexpr const char* kShowHere = "show.yaml";

struct Options {
  DeviceBusChoice choice;
  std::string show;  ///< of `list`; empty: show.yaml if it is here, else no rig
  std::string node;
  std::string addresses;
  std::string id;
  std::string duration = "10 s";
  int from = 1;
  int to = 1;
  bool off = false;
  bool write = false;
};

template <class Number>
bool read_number(std::string_view text, Number& number, int base = 10) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return error == std::errc{} && end == text.data() + text.size();
}

/// "1-32" or "7".
Result<std::pair<std::uint16_t, std::uint16_t>> range_of(const std::string& text, std::uint16_t last) {
  const auto dash = text.find('-');
  int first = 0;
  int end = 0;
  const bool read = dash == std::string::npos ? read_number(text, first) && read_number(text, end)
                                              : read_number(std::string_view(text).substr(0, dash), first) &&
                                                    read_number(std::string_view(text).substr(dash + 1), end);
  if (!read || first < 1 || end < first || end > last) {
    return input_error(fmt::format("--addresses: {} is no range of addresses on this bus (as 1-32, within 1-{})",
                                   config::in_quotes(text), last));
  }
  return std::pair(static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(end));
}

/// Those of --addresses, or else the nodes of the rig, of which there is one at least.
Result<std::vector<std::uint16_t>> addresses_of(const DeviceBus& bus, const Options& options) {
  std::vector<std::uint16_t> out;
  if (!options.addresses.empty()) {
    const auto range = range_of(options.addresses, bus.last_address());
    if (!range) return range.error();
    for (int address = range->first; address <= range->second; ++address) {
      out.push_back(static_cast<std::uint16_t>(address));
    }
    return out;
  }
  for (const drivers::NodeAddress& node : bus.nodes()) out.push_back(node.address);
  if (!out.empty()) return out;
  return input_error("the bus \"" + bus.bus().name +
                     "\" has no nodes that are known (say which by --addresses 1-32, or give the bus's name and --show "
                     "SHOW)");
}

int list(Session& session, const Options& options) {
  Rig rig;
  if (const std::string show = options.show; !show.empty() || std::filesystem::exists(kShowHere)) {
    auto read = read_rig_of(session, show.empty() ? kShowHere : show);
    if (!read) return session.fail(read.error());
    rig = std::move(read).value();
  }
  const Rig wires = with_simulated_buses(rig);
  ManualClock clock;
  sim::SimulatedRig simulated(wires, {}, 1, clock, nullptr);
  const auto drivers = drivers_on(simulated, wires, Plan{});
  if (!drivers) return session.fail(drivers.error());
  std::vector<std::string> assumptions;
  for (const auto& driver : *drivers) assumptions.push_back(driver->assumption());
  const std::string show_file = options.show.empty() ? kShowHere : options.show;
  if (const auto changed = wipe_note(state_folder(""), show_file, rig)) session.note(*changed);
  const MachineWires machine = look_at_machine();
  std::string text = session.json ? list_json(rig, assumptions, machine) : list_text(rig, assumptions, machine);
  if (session.json) {
    session.print(text);
    return 0;
  }
  for (const drivers::Objection& objection : objections_to(rig.buses)) {
    text += fmt::format("\n{}: {}", objection.stops ? "not ready" : "to be mended", objection.text);
  }
  session.print(text);
  return 0;
}

int scan(Session& session, const Options& options) {
  auto bus = DeviceBus::open(session, options.choice);
  if (!bus) return session.fail(bus.error());
  std::pair<std::uint16_t, std::uint16_t> range{1, (*bus)->last_address()};
  if (!options.addresses.empty()) {
    const auto given = range_of(options.addresses, range.second);
    if (!given) return session.fail(given.error());
    range = *given;
  }
  BusService service((*bus)->driver(), (*bus)->nodes());
  service.scan(range.first, range.second);
  if (auto done = (*bus)->run(session, service, "scan"); !done) return session.fail(done.error());
  session.print(session.json ? scan_json(**bus, service.found()) : scan_text(**bus, service.found()));
  return 0;
}

/// "BUS/ADDRESS", or the name of a node of the rig.
Result<std::pair<std::string, int>> node_place(Session& session, const Options& options) {
  const auto slash = options.node.rfind('/');
  int address = 0;
  if (slash != std::string::npos && read_number(std::string_view(options.node).substr(slash + 1), address) &&
      address >= 1 && address <= 512) {
    return std::pair(options.node.substr(0, slash), address);
  }
  const std::string show = options.choice.show.empty() ? kShowHere : options.choice.show;
  auto rig = read_rig_of(session, show);
  if (!rig) return std::move(rig).error();
  std::vector<std::string> names;
  for (const Node& node : rig->nodes) {
    if (node.name == options.node) return std::pair(rig->buses[node.bus.at()].name, node.address);
    names.push_back(node.name);
  }
  return input_error("no node has the name " + config::in_quotes(options.node) + " (" +
                     config::suggestion(options.node, names, "nodes") + "; or BUS/ADDRESS, as can-1/7)");
}

int identify(Session& session, Options options) {
  const auto place = node_place(session, options);
  if (!place) return session.fail(place.error());
  options.choice.bus = place->first;
  auto bus = DeviceBus::open(session, options.choice);
  if (!bus) return session.fail(bus.error());
  BusService service((*bus)->driver(), (*bus)->nodes());
  service.identify(static_cast<std::uint16_t>(place->second), !options.off);
  if (auto done = (*bus)->run(session, service, "identify"); !done) return session.fail(done.error());
  const std::string name = (*bus)->name_of(static_cast<std::uint16_t>(place->second));
  if (session.json) {
    session.print(fmt::format(R"({{"bus": "{}", "address": {}, "identifies": {}}})", (*bus)->bus().name, place->second,
                              !options.off));
  } else {
    session.print(options.off ? name + " shows its looks again" : name + " shows which one it is");
  }
  return 0;
}

int set_address(Session& session, const Options& options) {
  std::optional<std::uint32_t> id;
  if (!options.id.empty()) {
    std::uint32_t number = 0;
    const bool hexadecimal = options.id.starts_with("0x");
    if (!read_number(std::string_view(options.id).substr(hexadecimal ? 2 : 0), number, hexadecimal ? 16 : 10)) {
      return session.fail(input_error("--id: " + config::in_quotes(options.id) +
                                      " is not a unique id (as footlight devices scan shows it: 0x1234ABCD)"));
    }
    id = number;
  }
  auto bus = DeviceBus::open(session, options.choice);
  if (!bus) return session.fail(bus.error());
  const int last = (*bus)->last_address();
  for (const int address : {options.from, options.to}) {
    if (address < 1 || address > last) {
      return session.fail(
          input_error(fmt::format("{} is no address on a {} bus (1-{})", address, to_text((*bus)->bus().kind), last)));
    }
  }
  const bool restart = (*bus)->bus().profile && (*bus)->bus().profile->restarts_for_address;
  BusService service((*bus)->driver(), (*bus)->nodes());
  service.set_address(static_cast<std::uint16_t>(options.from), id, static_cast<std::uint16_t>(options.to), restart);
  if (auto done = (*bus)->run(session, service, "set-address"); !done) return session.fail(done.error());
  if (session.json) {
    session.print(fmt::format(R"({{"bus": "{}", "from": {}, "to": {}, "after_restart": {}}})", (*bus)->bus().name,
                              options.from, options.to, restart));
  } else {
    session.print(restart ? fmt::format("the device has taken address {} and uses it after it was switched off and on",
                                        options.to)
                          : fmt::format("the device answers at address {} now", options.to));
  }
  return 0;
}

int health(Session& session, const Options& options) {
  auto bus = DeviceBus::open(session, options.choice);
  if (!bus) return session.fail(bus.error());
  const auto addresses = addresses_of(**bus, options);
  if (!addresses) return session.fail(addresses.error());
  BusService service((*bus)->driver(), (*bus)->nodes());
  service.ask_health(*addresses);
  if (auto done = (*bus)->run(session, service, "health"); !done) return session.fail(done.error());
  session.print(session.json ? health_json(**bus, service.health(), "") : health_text(**bus, service.health()));
  return 0;
}

int patch(Session& session, const Options& options) {
  auto bus = DeviceBus::open(session, options.choice);
  if (!bus) return session.fail(bus.error());
  const auto addresses = addresses_of(**bus, options);
  if (!addresses) return session.fail(addresses.error());
  std::map<std::uint16_t, std::uint32_t> wanted;
  for (const drivers::NodeAddress& node : (*bus)->nodes()) {
    wanted[node.address] = patch_check((*bus)->rig().nodes[node.node.at()]);
  }
  for (const std::uint16_t address : *addresses) {
    if (!options.write || wanted.contains(address)) continue;
    return session.fail(input_error(fmt::format(
        "--write: the rig has no node at address {} of bus \"{}\", so nobody knows its patch (--addresses of the rig's "
        "nodes, and the bus by its name)",
        address, (*bus)->bus().name)));
  }
  BusService service((*bus)->driver(), (*bus)->nodes());
  service.ask_patches(*addresses, options.write ? wanted : std::map<std::uint16_t, std::uint32_t>{});
  if (auto done = (*bus)->run(session, service, "patch"); !done) return session.fail(done.error());
  std::vector<NodePatch> patches;
  for (const std::uint16_t address : *addresses) {
    NodePatch& node = patches.emplace_back();
    node.address = address;
    if (const auto kept = service.kept().find(address); kept != service.kept().end()) node.kept = kept->second;
    if (const auto check = wanted.find(address); check != wanted.end()) node.wanted = check->second;
  }
  session.print(session.json ? patch_json(**bus, patches) : patch_text(**bus, patches));
  const bool all = std::ranges::all_of(patches, &NodePatch::same);
  return all ? 0
             : session.fail(device_error("bus \"" + (*bus)->bus().name + "\": not every node keeps the rig's patch"));
}

int test(Session& session, const Options& options) {
  const auto duration = config::parse_quantity(options.duration, config::Dimension::time);
  if (!duration.value || *duration.value <= 0 || *duration.value > kLongestTestS) {
    return session.fail(input_error(
        "--duration: " + (duration.value ? config::in_quotes(options.duration) + " is out of range" : duration.text) +
        " (a time, as 10 s or 5 min, at most a day)"));
  }
  auto bus = DeviceBus::open(session, options.choice);
  if (!bus) return session.fail(bus.error());
  const auto addresses = addresses_of(**bus, options);
  if (!addresses) return session.fail(addresses.error());
  BusService service((*bus)->driver(), (*bus)->nodes());
  service.test(*addresses, seconds(*duration.value));
  if (auto done = (*bus)->run(session, service, "test"); !done) return session.fail(done.error());
  std::vector<std::string> names;
  for (const auto& node : service.health()) names.push_back((*bus)->name_of(node.address));
  const std::string verdict = controller::cable_verdict(service.health(), names);
  session.print(session.json ? health_json(**bus, service.health(), verdict)
                             : health_text(**bus, service.health()) + "\n" + verdict);
  const bool all = std::ranges::all_of(service.health(), [](const auto& node) { return node.answered > 0; });
  return all ? 0 : session.fail(device_error("bus \"" + (*bus)->bus().name + "\": not every node answers"));
}

using Work = int (*)(Session&, const Options&);

void add_bus_options(CLI::App& command, Options& options) {
  command.add_option("--show", options.choice.show, "show file whose rig has the bus (default: show.yaml here)");
  command.add_option("--transport-map", options.choice.transports,
                     "where the rig's buses are today, as `footlight sim --write-map` writes it");
  command.add_option("--profile", options.choice.profile, "device profile of a Modbus URL");
  command.add_option("--bits-per-second", options.choice.bits_per_second, "speed of a URL")
      ->check(CLI::Range(1200, 4'000'000));
  command.add_option("--wire-log", options.choice.wire_log,
                     "write what goes over the wire to this .pcapng file, for Wireshark");
  command.add_flag("--sim", options.choice.simulated, "on simulated devices, in virtual time, whatever the URLs say");
  command.add_option("--faults", options.choice.faults, "with --sim: what goes wrong, as loss=5%,dead=1");
  command.add_option("--seed", options.choice.seed, "with --sim: what happens by chance depends on this number alone");
}

CLI::App* add_work(CLI::App& devices, Session& session, Chosen& chosen, const std::shared_ptr<Options>& options,
                   const char* name, const char* what, Work work) {
  CLI::App* command = devices.add_subcommand(name, what);
  session.add_options(*command, true);
  command->callback(
      [&session, &chosen, options, work] { chosen = [&session, options, work] { return work(session, *options); }; });
  return command;
}

}  // namespace

void add_devices_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* devices =
      program.add_subcommand("devices", "Find, identify, readdress and test the markers on their buses");
  devices->require_subcommand(1);
  auto options = std::make_shared<Options>();
  CLI::App* command = add_work(*devices, session, chosen, options, "list",
                               "The buses and nodes of a rig, and the ports of this machine", list);
  command->add_option("SHOW", options->show, "the show file (default: show.yaml, where there is one)");
  command->footer(
      "Also what this machine has for wires: serial ports with their USB data, CAN interfaces, GPIO chips, and which "
      "bus "
      "of\nthe rig each carries. Nothing is opened that could disturb a bus.\n");

  command = add_work(*devices, session, chosen, options, "scan", "Who answers on a bus", scan);
  command->add_option("BUS", options->choice.bus, "name of a bus of the rig, or a URL")->required();
  command->add_option("--addresses", options->addresses, "only these, as 1-32");
  add_bus_options(*command, *options);
  command->footer(
      "Asks every address twice and whoever was heard four times more, by unique id where the language has one. "
      "Bounded,\nand the same devices give the same list: present, double (several at one address), ghost (heard now "
      "and then), absent.\nNo show may run on the bus meanwhile.\n\n"
      "Examples:\n  footlight devices scan rtu-1 --show my-show/show.yaml\n"
      "  footlight devices scan rtu:///dev/serial/by-id/usb-FTDI_1 --profile relay-16 --addresses 1-16\n");

  command = add_work(*devices, session, chosen, options, "identify", "Make a node show which one it is",
                     [](Session& s, const Options& o) { return identify(s, o); });
  command->add_option("NODE", options->node, "name of a node of the rig, or BUS/ADDRESS")->required();
  command->add_flag("--off", options->off, "no longer");
  add_bus_options(*command, *options);

  command = add_work(*devices, session, chosen, options, "set-address", "Give a device another address", set_address);
  command->add_option("BUS", options->choice.bus, "name of a bus of the rig, or a URL")->required();
  command->add_option("FROM", options->from, "its address now")->required();
  command->add_option("TO", options->to, "its new address, free now")->required();
  command->add_option("--id", options->id, "its unique id, where several devices share the address");
  add_bus_options(*command, *options);

  command = add_work(*devices, session, chosen, options, "health", "Battery, supply, errors and latency", health);
  command->add_option("BUS", options->choice.bus, "name of a bus of the rig, or a URL")->required();
  command->add_option("--addresses", options->addresses, "only these, as 1-32 (default: the nodes of the rig)");
  add_bus_options(*command, *options);

  command = add_work(*devices, session, chosen, options, "patch", "Which patch the nodes keep, and give them the rig's",
                     patch);
  command->add_option("BUS", options->choice.bus, "name of a bus of the rig")->required();
  command->add_option("--addresses", options->addresses, "only these, as 1-32 (default: the nodes of the rig)");
  command->add_flag("--write", options->write, "give each its patch first: its lamps are where the rig says");
  add_bus_options(*command, *options);
  command->footer(
      "A marker keeps a check of its patch, that is which of its lamps is on which cell, and at which address, over "
      "power-off.\n`run --scope live` refuses GO while one has another: a node in the wrong place, or a rig of another "
      "day.\nWrite it when commissioning has shown that the lamps are where the rig says. Exit status 4 when a node "
      "has "
      "not the\nrig's patch.\n");

  command = add_work(*devices, session, chosen, options, "test", "How far along the cable nodes answer", test);
  command->add_option("BUS", options->choice.bus, "name of a bus of the rig, or a URL")->required();
  command->add_option("--addresses", options->addresses, "only these, as 1-32 (default: the nodes of the rig)");
  command->add_option("--duration", options->duration, "as 10 s or 5 min")->capture_default_str();
  add_bus_options(*command, *options);
  command->footer(
      "Asks the nodes in turn, in the order of the rig file, which should be that of the cable, and says where the "
      "cable\nends to carry. Exit status 4 when a node never answered.\n");
}

}  // namespace footlight::app
