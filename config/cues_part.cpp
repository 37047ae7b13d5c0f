// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "config/nearest.hpp"
#include "config/show_parts.hpp"

namespace footlight::config {
namespace {

std::optional<CueNumber> read_number(MappingReader& cue) {
  const auto written = cue.written("number");
  if (!written) return std::nullopt;
  const auto number = CueNumber::parse(written->text);
  if (!number) {
    cue.error(*written, in_quotes(written->text) + " is not a cue number",
              "write for example \"12.5\": digits, at most one point and six decimals");
    return std::nullopt;
  }
  if (!written->quoted) {
    cue.error(*written, "the cue number " + written->text + " is not quoted",
              "write \"" + written->text + "\": unquoted, 12.10 and 12.1 would be numbers");
    return std::nullopt;
  }
  return number;
}

std::optional<SectionIndex> read_section_name(MappingReader& cue, const std::optional<Written>& written,
                                              const ShowReading& reading) {
  const Show& show = reading.show();
  if (!written) return std::nullopt;
  const auto found = std::find_if(show.sections.begin(), show.sections.end(),
                                  [&](const Section& section) { return section.name == written->text; });
  if (found != show.sections.end()) return SectionIndex::of(found - show.sections.begin());
  if (reading.has_all_sections) {  // otherwise it may be an echo of another error
    std::vector<std::string> names;
    for (const Section& section : show.sections) names.push_back(section.name);
    cue.error(*written, "no section has the name " + in_quotes(written->text),
              suggestion(written->text, names, "sections"));
  }
  return std::nullopt;
}

void read_gate_names(MappingReader& root, Show& show) {
  for (const Written& written : root.list("gates")) {
    if (written.text.empty()) {
      root.error(written, "a gate without a name", "such as \"trap closed\"");
    } else if (std::ranges::find(show.gates, written.text) != show.gates.end()) {
      root.error(written, "a second gate has the name " + in_quotes(written.text), "once will do");
    } else if (show.gates.size() == kMostGates) {
      return root.error(written, "more than " + std::to_string(kMostGates) + " gates",
                        "one that stands for several, by their contacts in series");
    } else {
      show.gates.push_back(written.text);
    }
  }
}

/// Bits of the gates that a cue names.
std::uint32_t read_gates_of(MappingReader& cue, const Show& show) {
  std::uint32_t gates = 0;
  for (const Written& written : cue.list("gates")) {
    const auto found = std::ranges::find(show.gates, written.text);
    if (found != show.gates.end()) {
      gates |= 1U << static_cast<unsigned>(found - show.gates.begin());
    } else {
      cue.error(written, "no gate has the name " + in_quotes(written.text),
                show.gates.empty() ? "the show lists them: gates: [" + in_quotes(written.text) + "]"
                                   : suggestion(written.text, show.gates, "gates"));
    }
  }
  return gates;
}

/// A cue, and where its section is named.
struct CueEntry {
  Cue cue;
  Written section;
};

std::optional<CueEntry> read_cue(MappingReader& reader, const ShowReading& reading) {
  const Show& show = reading.show();
  Cue out;
  out.position = reader.position();
  const auto number = read_number(reader);
  const auto written = reader.written("section");
  const auto section = read_section_name(reader, written, reading);
  const auto name = reader.text("name");
  out.continue_mode = static_cast<ContinueMode>(reader.choice("continue").value_or(0));
  out.pre_wait = seconds(reader.quantity("pre_wait").value_or(0));
  out.post_wait = seconds(reader.quantity("post_wait").value_or(0));
  out.notes = reader.text("notes").value_or("");
  out.gates = read_gates_of(reader, show);
  if (!number || !section) return std::nullopt;
  out.number = *number;
  out.section = *section;
  out.name = name.value_or(show.sections[section->at()].name);
  return CueEntry{std::move(out), *written};
}

/// @param cues ascending by number
void check_order(const std::vector<CueEntry>& cues, const std::vector<Section>& sections, MappingReader& root) {
  const CueEntry* before = nullptr;
  for (const CueEntry& entry : cues) {
    if (before == nullptr || before->cue.section < entry.cue.section) {
      before = &entry;
      continue;
    }
    root.error(entry.section,
               "cue " + entry.cue.number.to_text() + " plays section " + in_quotes(entry.section.text) +
                   ", which does not come after section " + in_quotes(sections[before->cue.section.at()].name) +
                   " of cue " + before->cue.number.to_text(),
               "cues play their sections in the order of the show, each section once");
  }
}

/// Without cues one GO plays the whole show.
std::vector<Cue> cue_for_each(const std::vector<Section>& sections) {
  std::vector<Cue> out;
  for (std::size_t s = 0; s < sections.size(); ++s) {
    Cue cue;
    cue.number = *CueNumber::parse(std::to_string(s + 1));
    cue.name = sections[s].name;
    cue.section = SectionIndex::of(s);
    cue.continue_mode = s + 1 < sections.size() ? ContinueMode::auto_follow : ContinueMode::manual;
    cue.position = sections[s].position;
    out.push_back(std::move(cue));
  }
  return out;
}

LookChoice read_look(MappingReader look) {
  LookChoice out;
  const auto colour = look.written("colour");
  if (colour && colour->text != "group") {
    out.colour = parse_colour(colour->text);
    if (!out.colour)
      look.error(*colour, in_quotes(colour->text) + " is not a colour", "group, or \"#RRGGBB\" in quotes");
  }
  out.effect = static_cast<Effect>(look.choice("effect").value_or(0));
  out.brightness = static_cast<std::uint8_t>(look.integer("brightness").value_or(255));
  return out;
}

/// "4/4": counts a measure over the note that is a count.
std::optional<int> read_meter(MappingReader& music) {
  const auto written = music.written("meter");
  if (!written) return std::nullopt;
  const std::size_t slash = written->text.find('/');
  const auto beats = parse_integer(written->text.substr(0, slash));
  const auto note = slash == std::string::npos ? std::nullopt : parse_integer(written->text.substr(slash + 1));
  const bool right = beats && note && *beats >= 1 && *beats <= 64 && *note >= 1 && *note <= 64;
  if (right) return beats;
  music.error(*written, in_quotes(written->text) + " is not a meter",
              "write for example 4/4; 1 to 64 counts a measure");
  return std::nullopt;
}

struct MeterEntry {
  MappingReader reader;
  MeterChange change;
};

/// The items of `changes`; false after an error.
bool read_changes(MappingReader& music, std::vector<TempoChange>& changes, std::vector<MeterEntry>& meters) {
  double last = 0;
  for (MappingReader& reader : music.mappings("changes")) {
    const auto at = reader.quantity("at");
    const auto bpm = reader.number("tempo");
    const auto beats = read_meter(reader);
    if (!at || (reader.has("tempo") && !bpm) || (reader.has("meter") && !beats)) return false;
    if (last == 0 && *at != 1) {
      reader.error("at", "the first tempo begins at count " + plain(*at), "it begins at count 1");
      return false;
    }
    if (last == 0 && (!bpm || beats)) {
      reader.error(reader.position(), reader.path(), bpm ? "a meter at count 1" : "no tempo at count 1",
                   "the first change gives the first tempo; the first meter is music.meter");
      return false;
    }
    if (*at <= last) {
      reader.error("at", "count " + plain(*at) + " does not come after count " + plain(last),
                   "the counts increase down the list");
      return false;
    }
    if (!bpm && !beats) {
      reader.error(reader.position(), reader.path(), "nothing changes", "give a tempo or a meter");
      return false;
    }
    last = *at;
    if (bpm) changes.push_back({*at, *bpm});
    if (beats) meters.push_back({reader, {*at, *beats}});
  }
  return true;
}

}  // namespace

void read_cues(ShowReading& show, MappingReader& root) {
  std::vector<Cue>& out = show.show().cues;
  if (root.has("gates")) read_gate_names(root, show.show());
  if (!root.has("cues")) {
    out = cue_for_each(show.show().sections);
    return;
  }
  std::map<CueNumber, Position> first_at;
  std::vector<CueEntry> entries;
  for (MappingReader& reader : root.mappings("cues")) {
    auto entry = read_cue(reader, show);
    if (!entry) continue;
    const auto [first, is_new] = first_at.emplace(entry->cue.number, entry->cue.position);
    if (!is_new) {
      const auto written = reader.written("number");
      const std::string number = entry->cue.number.to_text();
      reader.error("number", "a second cue has the number " + number,
                   (written->text == number ? "" : written->text + " equals " + number + "; ") + "first in line " +
                       std::to_string(first->second.line));
      continue;
    }
    entries.push_back(std::move(*entry));
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const CueEntry& a, const CueEntry& b) { return a.cue.number < b.cue.number; });
  check_order(entries, show.show().sections, root);
  for (CueEntry& entry : entries) out.push_back(std::move(entry.cue));
}

void read_looks(ShowReading& show, MappingReader looks) {
  constexpr std::pair<std::string_view, LampRole> kRoles[] = {{"here", LampRole::here},
                                                              {"arrive", LampRole::arrive},
                                                              {"next", LampRole::next},
                                                              {"handover", LampRole::handover}};
  for (const auto& [key, role] : kRoles) {
    if (auto look = looks.mapping(key)) show.show().looks[role] = read_look(std::move(*look));
  }
}

void read_time(ShowReading& show, MappingReader time) {
  constexpr std::array kRates{FrameRate::fps24, FrameRate::fps25, FrameRate::fps2997_drop, FrameRate::fps30};
  TimeRules& out = show.show().time;
  out.source = time.text("source").value_or("");
  const auto rate = time.choice("frame_rate");
  if (rate) out.rate = kRates.at(static_cast<std::size_t>(*rate));
  if (const auto start = time.written("start"); start && rate) {
    const auto code = parse_timecode(start->text, out.rate);
    if (code) out.start = time_of(*code);
    if (!code) {
      time.error(*start, in_quotes(start->text) + " is no timecode of " + std::string(to_text(out.rate)) + " frames",
                 "hours, minutes, seconds and frames, as \"01:00:00:00\"");
    }
  }
  out.lost = static_cast<TimeLoss>(time.choice("lost").value_or(1));
  out.freewheel = seconds(time.quantity("freewheel").value_or(2));
}

void read_music(ShowReading& show, MappingReader music) {
  const int beats = read_meter(music).value_or(4);
  const double pickup = music.quantity("pickup").value_or(0);
  if (pickup >= beats) {
    music.error("pickup", "a pick-up of " + plain(pickup) + " counts is no shorter than a measure",
                "fewer than " + std::to_string(beats) + " counts");
    return;
  }
  std::vector<TempoChange> changes;
  std::vector<MeterEntry> meters;
  if (!music.has("changes")) {
    changes.push_back({1, music.number("tempo").value_or(120)});
  } else {
    if (music.has("tempo")) {
      music.error(music.key_position("tempo"), music.path("tempo"), "does not go with \"changes\"",
                  "give one tempo or a list of changes");
    }
    if (!read_changes(music, changes, meters)) return;
  }
  auto map = TempoMap::from(std::move(changes), beats, pickup);
  if (!map) {
    if (!music.reading().diagnostics.has_errors()) music.error("changes", map.error().message);
    return;
  }
  for (MeterEntry& entry : meters) {
    const auto changed = map->change_meter(entry.change.count, entry.change.beats);
    if (!changed) return entry.reader.error("meter", changed.error().message, "a meter changes where a measure begins");
  }
  show.show().tempo = std::move(*map);
}

}  // namespace footlight::config
