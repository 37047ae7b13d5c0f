// SPDX-License-Identifier: Apache-2.0
#include "app/time/time_options.hpp"

#include <filesystem>
#include <utility>

#include <CLI/CLI.hpp>

namespace footlight::app {

void TimeOptions::add_options(CLI::App& command) {
  command.add_option("--time", source,
                     std::string("source of time instead of the show file's: ") + kTimeSources +
                         "; what happens when it fails stands in the show file (docs/time.md)");
  command.add_option("--time-out", outs, "says where the show is: mtc:PORT, osc:ADDRESS:PORT; may be given again");
}

void TimePlaces::add_to(RunDesk& run) {
  run.add(desk);
  run.add([this](DeskView& view) { view.time_source = desk.name(); });
  for (const auto& out : outs) run.add(*out);
}

void TimePlaces::use(const Clock& run) {
  desk.use(run);
  for (const auto& out : outs) out->use(run);
}

Result<std::unique_ptr<TimePlaces>> TimeOptions::open(const Show& show, bool go, const Clock& clock) const {
  auto opened = open_source(show, go, clock);
  if (!opened) return std::move(opened).error();
  auto places = std::make_unique<TimePlaces>(TimePlaces{TimeDesk(show, std::move(opened).value(), clock)});
  for (const std::string& what : outs) {
    auto out = TimeOut::open(what, show.time);
    if (!out) return Error{out.error().kind, "--time-out: " + out.error().message};
    places->outs.push_back(std::move(out).value());
  }
  return places;
}

Result<std::unique_ptr<TimeSource>> TimeOptions::open_source(const Show& show, bool go, const Clock& clock) const {
  const std::string& name = source.empty() ? show.time.source : source;
  if (name.empty() || name == "internal") return std::unique_ptr<TimeSource>();
  auto opened = open_time_source(
      name, source.empty() ? std::filesystem::path(show.file).parent_path() : std::filesystem::path(), show, clock);
  const std::string where = source.empty() ? show.file + ": time.source: " : "--time: ";
  if (!opened) return Error{opened.error().kind, where + opened.error().message};
  if (go && !(*opened)->goes_with_the_show()) {
    return input_error(where + (*opened)->name() + " brings the cues (without --go, which would press GO before it)");
  }
  return opened;
}

}  // namespace footlight::app
