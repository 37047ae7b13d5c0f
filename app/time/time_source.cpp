// SPDX-License-Identifier: Apache-2.0
#include "app/time/time_source.hpp"

#include <string_view>

#include <fmt/format.h>

namespace footlight::app {

const char* const kTimeSources =
    "internal, audio:FILE, ltc:FILE, ltc:alsa:DEVICE, mtc:PORT, midi-clock:PORT, osc:PORT or osc:ADDRESS:PORT";

Result<std::unique_ptr<TimeSource>> open_time_source(const std::string& name, const std::filesystem::path& folder,
                                                     const Show& show, const Clock& clock) {
  const std::size_t colon = name.find(':');
  const std::string_view kind = std::string_view(name).substr(0, colon);
  const std::string what = colon == std::string::npos ? "" : name.substr(colon + 1);
  if (!what.empty()) {
    if (kind == "audio") return open_audio(what, folder, show.time, clock);
    if (kind == "ltc") return open_ltc(what, folder, show.time);
    if (kind == "osc") return open_osc_time(what, show.time);
    if (kind == "mtc") return open_mtc(what, show.time, clock);
    if (kind == "midi-clock") return open_midi_clock(what, show.tempo, clock);
  }
  return input_error(fmt::format("\"{}\" is no source of time ({})", name, kTimeSources));
}

}  // namespace footlight::app
