// SPDX-License-Identifier: Apache-2.0
#include "app/remote/remote_control.hpp"

#include <optional>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/remote/interlocks.hpp"
#include "app/remote/msc_surface.hpp"
#include "app/remote/osc_surface.hpp"
#include "app/remote/panel.hpp"
#include "app/remote/panel_surface.hpp"
#include "config/remote_file.hpp"

namespace footlight::app {
namespace {

Result<std::unique_ptr<drivers::GpioLine>> open_line(const config::GpioPlace& place, drivers::GpioSettings settings) {
  return drivers::open_gpio(place.chip, place.offset, settings);
}

Status<> gates_are_told(const RemoteOptions& options, const Show& show) {
  if (!options.file.empty() || options.gates_by_people || show.gates.empty()) return Done{};
  std::string names;
  for (const std::string& gate : show.gates) names += (names.empty() ? "" : ", ") + gate;
  return input_error("nothing tells the gates of this show: " + names +
                     " (--remote FILE with an input for each; --gates-by-people where people watch them)");
}

/// "trap closed by word", "trap closed by input"
Result<std::string> answer_for_gate(Interlocks& interlocks, const std::vector<std::string>& words) {
  const bool by = words.size() >= 3 && words[words.size() - 2] == "by";
  const bool word = by && words.back() == "word";
  if (!word && !(by && words.back() == "input")) {
    return input_error("gate: as in \"gate trap closed by word\", and \"by input\" to take it back");
  }
  std::string name;
  for (std::size_t i = 0; i + 2 < words.size(); ++i) name += (i > 0 ? " " : "") + words[i];
  return interlocks.by_word(name, word);
}

}  // namespace

struct RemoteControl::Parts {
  Parts(config::Remote settings, const Show& show, const Clock& clock)
      : remote(std::move(settings)), interlocks(show.gates, remote, clock.now()), panel(remote, interlocks) {}

  config::Remote remote;
  Interlocks interlocks;
  Panel panel;
  std::unique_ptr<OscSurface> osc;
  std::unique_ptr<MscSurface> msc;
  std::unique_ptr<PanelSurface> lines;
};

RemoteControl::RemoteControl(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
RemoteControl::~RemoteControl() = default;

void RemoteControl::take_up_emergency_hold() { parts_->interlocks.take_up_emergency_hold(); }

void RemoteOptions::add_options(CLI::App& command) {
  command.add_option("--remote", file,
                     "YAML file: OSC, MIDI Show Control, buttons, gates, cue lights and tallies (docs/remote.md)");
  command.add_flag("--gates-by-people", gates_by_people,
                   "the gates of the show are closed by the word of people who watch them");
}

Result<std::unique_ptr<RemoteControl>> RemoteControl::open(const RemoteOptions& options, const Show& show,
                                                           const Plan& plan, RunDesk& desk, const Clock& clock,
                                                           bool listens) {
  if (auto told = gates_are_told(options, show); !told) return std::move(told).error();
  config::Remote remote;
  if (!options.file.empty()) {
    auto read = config::read_remote(options.file, show);
    if (!read) return input_error(read.error().to_text());
    remote = std::move(read).value();
  }
  auto parts = std::make_unique<Parts>(std::move(remote), show, clock);
  if (options.gates_by_people) {
    for (const std::string& gate : show.gates) (void)parts->interlocks.by_word(gate, true);
  }
  if (parts->remote.osc) {
    auto osc = OscSurface::open(*parts->remote.osc, show, plan, desk, parts->interlocks, parts->panel, clock, listens);
    if (!osc) return std::move(osc).error();
    parts->osc = std::move(osc).value();
    desk.add(*parts->osc);
  }
  if (parts->remote.midi) {
    auto msc = MscSurface::open(*parts->remote.midi, clock, listens);
    if (!msc) return std::move(msc).error();
    parts->msc = std::move(msc).value();
    desk.add(*parts->msc);
  }
  auto lines = PanelSurface::open(parts->remote, parts->interlocks, parts->panel, clock, listens, open_line);
  if (!lines) return std::move(lines).error();
  parts->lines = std::move(lines).value();
  desk.add(*parts->lines);  // the last: what others have said of gates counts in the same look
  // Before the first look nobody knows how anything is.
  desk.bar(parts->interlocks.bars(), true);
  desk.add([&interlocks = parts->interlocks](DeskView& view) {
    view.gates = interlocks.gates();
    view.emergency_hold = interlocks.emergency_hold();
    for (std::string& text : interlocks.text_of(view.show.barred)) view.against.push_back(std::move(text));
  });
  if (!show.gates.empty()) {
    desk.add({"gate", "gate trap closed by word     you answer for it; \"by input\" takes that back\n",
              [&interlocks = parts->interlocks](const std::vector<std::string>& words, const Speaker&) {
                return answer_for_gate(interlocks, words);
              }});
  }
  if (!parts->remote.cue_lights.empty()) {
    desk.add({"standby", "standby; standby off         the cue lights flash; they do not\n",
              [&panel = parts->panel](const std::vector<std::string>& words, const Speaker&) {
                return panel.standby(words);
              }});
  }
  return std::unique_ptr<RemoteControl>(new RemoteControl(std::move(parts)));
}

}  // namespace footlight::app
