// SPDX-License-Identifier: Apache-2.0
#include "config/remote_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>

#include <arpa/inet.h>

#include "config/mapping_reader.hpp"
#include "config/nearest.hpp"

namespace footlight::config {
namespace {

constexpr std::size_t kMaxRemoteBytes = std::size_t{1} << 18U;
constexpr std::array<int, 7> kFormats{0x01, 0x10, 0x20, 0x30, 0x40, 0x50, 0x60};  // MSC 1.0, 4.1

/// An address of numbers as the kernel writes it; empty: it is none.
std::string plain_address(const std::string& text) {
  std::array<char, INET6_ADDRSTRLEN> out{};
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  for (const int family : {AF_INET, AF_INET6}) {
    if (::inet_pton(family, text.c_str(), bytes.data()) == 1) {
      return ::inet_ntop(family, bytes.data(), out.data(), out.size());
    }
  }
  return {};
}

bool is_loopback(const std::string& address) { return address.starts_with("127.") || address == "::1"; }

std::optional<int> number_in(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

class RemoteReading {
 public:
  RemoteReading(const std::filesystem::path& file, const Show& show) : folder_(file.parent_path()), show_(show) {}

  Remote read(MappingReader& root) {
    (void)root.integer("remote");
    if (root.has("osc")) {
      if (auto osc = root.mapping("osc")) read_osc(*osc);
    }
    if (root.has("midi")) {
      if (auto midi = root.mapping("midi")) read_midi(*midi);
    }
    for (MappingReader& light : root.mappings("cue_lights")) read_cue_light(light);
    for (MappingReader& button : root.mappings("buttons")) read_button(button);
    for (MappingReader& gate : root.mappings("gates")) read_gate(gate);
    for (MappingReader& tally : root.mappings("tallies")) read_tally(tally);
    check_gates(root);
    return std::move(out_);
  }

 private:
  void read_osc(MappingReader& reader) {
    OscRemote osc;
    osc.listen.port = static_cast<std::uint16_t>(reader.integer("port").value_or(0));
    osc.listen.address = address_in(reader, reader.written("address"));
    for (const Written& written : reader.list("from")) osc.from.push_back(address_in(reader, written));
    if (const auto token = reader.text("token")) osc.token_file = (folder_ / *token).string();
    osc.reply_port = static_cast<std::uint16_t>(reader.has("replies") ? reader.integer("replies").value_or(0) : 0);
    for (const Written& written : reader.list("state")) osc.state.push_back(place_in(reader, written));
    osc.rate_hz = reader.number("rate").value_or(10);
    if (!is_loopback(osc.listen.address) && !osc.listen.address.empty()) {
      if (osc.from.empty()) {
        reader.error("address", "others may send, and nobody says who",
                     "from: [10.0.0.4], the addresses that are heard");
      }
      if (osc.token_file.empty())
        reader.error("address", "others may send, and OSC has no identity", "token: osc.token");
    }
    if (osc.from.empty()) osc.from = {"127.0.0.1", "::1"};
    out_.osc = std::move(osc);
  }

  static std::string address_in(MappingReader& reader, const std::optional<Written>& written) {
    if (!written) return {};
    std::string address = plain_address(written->text);
    if (address.empty()) {
      reader.error(*written, in_quotes(written->text) + " is no address", "numbers, as 10.0.0.4 or fe80::1");
    }
    return address;
  }

  static NetworkPlace place_in(MappingReader& reader, const Written& written) {
    const auto colon = written.text.rfind(':');
    const auto port = number_in(colon == std::string::npos ? "" : std::string_view(written.text).substr(colon + 1));
    std::string host = written.text.substr(0, colon);
    if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    const std::string address = plain_address(host);
    if (address.empty() || !port || *port < 1 || *port > 65535) {
      reader.error(written, in_quotes(written.text) + " is no address with a port",
                   "as 10.0.0.4:53001, [fe80::1]:53001");
      return {};
    }
    return {address, static_cast<std::uint16_t>(*port)};
  }

  void read_midi(MappingReader& reader) {
    MidiRemote midi;
    midi.port = reader.text("port").value_or("");
    midi.device = reader.integer("device").value_or(0);
    midi.format = kFormats.at(static_cast<std::size_t>(reader.choice("format").value_or(0)));
    std::set<int> numbers;
    for (MappingReader& macro : reader.mappings("macros")) {
      const auto number = macro.integer("number");
      const auto order = macro.text("order");
      if (!number || !order) continue;
      if (!numbers.insert(*number).second) {
        macro.error("number", "a second macro has the number " + std::to_string(*number), "one order for each");
      }
      midi.macros.push_back({*number, *order});
    }
    out_.midi = std::move(midi);
  }

  void read_button(MappingReader& reader) {
    RemoteButton button;
    const auto name = reader.text("name");
    const auto does = reader.choice("does");
    button.does = static_cast<RemoteButton::Does>(does.value_or(0));
    if (reader.has("order")) button.order = reader.text("order").value_or("");
    if (reader.has("cue_light")) button.cue_light = reader.text("cue_light").value_or("");
    button.input = input_in(reader, {});
    if (!name || !does) return;
    button.name = *name;
    if (!names_.insert(*name).second)
      reader.error("name", "a second button has the name " + in_quotes(*name), "unique");
    const bool orders = button.does == RemoteButton::Does::order;
    if (orders && button.order.empty()) reader.error("does", "no order is given", "order: hold end");
    if (!orders && reader.has("order")) wrong_key(reader, "order", "does: order");
    if (reader.has("cue_light")) check_cue_light(reader, button);
    if (orders || button.does == RemoteButton::Does::go || button.does == RemoteButton::Does::acknowledge) {
      if (reader.has("lost_after")) wrong_key(reader, "lost_after", "hold buttons and gates use it");
    }
    out_.buttons.push_back(std::move(button));
  }

  static void wrong_key(MappingReader& reader, std::string_view key, const std::string& right) {
    reader.error(reader.key_position(key), reader.path(key), "the key has no meaning here", right);
  }

  void check_cue_light(MappingReader& reader, const RemoteButton& button) const {
    if (button.does != RemoteButton::Does::acknowledge) return wrong_key(reader, "cue_light", "does: acknowledge");
    std::vector<std::string> names;
    for (const CueLightLines& light : out_.cue_lights) names.push_back(light.name);
    if (std::ranges::find(names, button.cue_light) != names.end()) return;
    reader.error("cue_light", "no cue light has the name " + in_quotes(button.cue_light),
                 suggestion(button.cue_light, names, "cue lights"));
  }

  void read_gate(MappingReader& reader) {
    const auto written = reader.written("gate");
    RemoteGate gate;
    gate.input = input_in(reader, milliseconds(2500));
    if (!written) return;
    const auto found = std::ranges::find(show_.gates, written->text);
    gate.gate = static_cast<std::size_t>(found - show_.gates.begin());
    if (found == show_.gates.end()) {
      return reader.error(*written, "the show has no gate " + in_quotes(written->text),
                          suggestion(written->text, show_.gates, "gates"));
    }
    if (!gates_.insert(gate.gate).second) {
      return reader.error(*written, "the gate " + in_quotes(written->text) + " is told twice", "one input for each");
    }
    out_.gates.push_back(gate);
  }

  void read_cue_light(MappingReader& reader) {
    const auto name = reader.text("name");
    const bool low = reader.choice("active").value_or(0) == 1;
    CueLightLines light{name.value_or(""), line_in(reader, "red", low), line_in(reader, "green", low)};
    if (!name) return;
    if (!lights_.insert(*name).second)
      reader.error("name", "a second cue light has the name " + in_quotes(*name), "unique");
    out_.cue_lights.push_back(std::move(light));
  }

  void read_tally(MappingReader& reader) {
    const auto shows = reader.choice("shows");
    const bool low = reader.choice("active").value_or(0) == 1;
    const GpioPlace line = line_in(reader, "line", low);
    if (shows) out_.tallies.push_back({static_cast<TallyLine::Shows>(*shows), line});
  }

  RemoteInput input_in(MappingReader& reader, Duration lost_after) {
    RemoteInput input;
    const bool low = reader.choice("active").value_or(0) == 1;
    const int pull = reader.choice("pull").value_or(0);
    if (reader.has("line")) {
      input.line = line_in(reader, "line", low);
      input.line->pull = static_cast<GpioPlace::Pull>(pull);
      if (reader.has("lost_after")) wrong_key(reader, "lost_after", "only what is told by OSC falls silent");
      return input;
    }
    if (!reader.has("osc")) return input;
    if (reader.boolean("osc") == false) reader.error("osc", "nothing tells it", "osc: true, or a line");
    input.lost_after = lost_after;
    if (reader.has("lost_after")) input.lost_after = seconds(reader.quantity("lost_after").value_or(1));
    if (!out_.osc) reader.error("osc", "nobody listens to OSC", "the key osc of this file");
    for (const char* key : {"active", "pull"}) {
      if (reader.has(key)) wrong_key(reader, key, "only a line has a level");
    }
    return input;
  }

  GpioPlace line_in(MappingReader& reader, std::string_view key, bool active_low) {
    GpioPlace place;
    place.active_low = active_low;
    const auto written = reader.written(key);
    if (!written) return place;
    const auto colon = written->text.rfind(':');
    const auto offset = number_in(colon == std::string::npos ? "" : std::string_view(written->text).substr(colon + 1));
    if (!offset || *offset < 0 || colon == 0) {
      reader.error(*written, in_quotes(written->text) + " is no GPIO line", "chip and number, as gpiochip0:17");
      return place;
    }
    place.chip = written->text.substr(0, colon);
    place.offset = static_cast<unsigned>(*offset);
    if (!lines_.emplace(place.chip, place.offset).second) {
      reader.error(*written, "the line " + in_quotes(written->text) + " is used twice", "one use for each line");
    }
    return place;
  }

  /// A gate that a cue needs and that nothing tells would never let it run.
  void check_gates(MappingReader& root) const {
    if (root.reading().diagnostics.has_errors()) return;
    for (std::size_t g = 0; g < show_.gates.size(); ++g) {
      if (gates_.contains(g)) continue;
      root.error("gates", "nothing tells the show's gate " + in_quotes(show_.gates[g]),
                 "- {gate: " + show_.gates[g] + ", line: gpiochip0:17}");
    }
  }

  std::filesystem::path folder_;
  const Show& show_;
  Remote out_;
  std::set<std::string> names_;
  std::set<std::string> lights_;
  std::set<std::size_t> gates_;
  std::set<std::pair<std::string, unsigned>> lines_;
};

}  // namespace

Result<Remote, Diagnostics> read_remote(const std::filesystem::path& file, const Show& show) {
  Diagnostics diagnostics;
  Reading reading{file.string(), diagnostics};
  const auto bytes = read_bounded(file, kMaxRemoteBytes);
  if (!bytes) {
    diagnostics.error({reading.file, 0, 0}, "", bytes.error().message);
    return diagnostics;
  }
  Remote remote;
  if (auto root = read_root(reading, *bytes, remote_listing())) remote = RemoteReading(file, show).read(*root);
  if (diagnostics.has_errors()) return diagnostics;
  return remote;
}

}  // namespace footlight::config
