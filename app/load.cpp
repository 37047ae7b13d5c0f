// SPDX-License-Identifier: Apache-2.0
#include "app/load.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "config/media.hpp"
#include "config/nearest.hpp"
#include "core/parts.hpp"

namespace footlight::app {
namespace {

/// Place of a section in the file, which need not be its place in time.
std::size_t place_in_file(const Show& show, const Section& section) {
  return static_cast<std::size_t>(std::count_if(show.sections.begin(), show.sections.end(), [&](const Section& other) {
    return other.position < section.position;
  }));
}

std::string key_path(const Show& show, const Section& section, const char* rest) {
  return fmt::format("sections[{}]{}", place_in_file(show, section), rest);
}

bool needs_own_length(const Section& section) {
  return section.duration_counts == 0 && std::holds_alternative<VideoSource>(section.from);
}

/// Why a film could not be had, and where that is written.
struct Undecoded {
  Position position;
  std::string key;
  Error error;
};
using Decoded = std::optional<Result<Film, Undecoded>>;

Decoded decode_drawings(const Session& session, const Show& show, const Section& section, const PartsSource& source) {
  if (!needs_pictures(source)) return std::nullopt;
  auto film = config::decode_parts(source, {}, session.stop());
  if (film) return std::move(*film);
  const std::size_t k = film.error().part;
  const Part& part = (*source.parts)[k];
  std::string key = key_path(show, section, ".from");
  if (source.parts->size() > 1) key += fmt::format(".parts[{}]", k);
  key += std::holds_alternative<Lettering>(part.drawing) ? ".text" : ".image";
  return Undecoded{part.position, key, film.error().error};
}

/// @return nothing when the source has no film
Decoded decode(const Session& session, const Show& show, const Section& section) {
  const auto of_section = [&](Result<Film> film, const char* key) -> Result<Film, Undecoded> {
    if (film) return std::move(*film);
    return Undecoded{section.position, key_path(show, section, key), film.error()};
  };
  if (const auto* video = std::get_if<VideoSource>(&section.from)) {
    return of_section(config::decode_video(*video, {}, session.stop()), ".from.video");
  }
  if (const auto* image = std::get_if<ImageSource>(&section.from)) {
    return of_section(config::decode_image(*image, {}, session.stop()), ".from.image");
  }
  if (const auto* painting = std::get_if<PaintingSource>(&section.from)) {
    return of_section(config::decode_painting(*painting, {}, session.stop()), ".from.painting");
  }
  if (const auto* parts = std::get_if<PartsSource>(&section.from)) {
    return decode_drawings(session, show, section, *parts);
  }
  return std::nullopt;
}

bool shows_nothing(const Film& film) {
  return film.rgb.empty() && std::ranges::all_of(film.frames, [](const Mask& frame) {
           return std::ranges::all_of(frame.words(), [](std::uint64_t word) { return word == 0; });
         });
}

Diagnostic empty_picture(const Show& show, const Section& section, const Film& film) {
  Diagnostic out;
  out.severity = Severity::warning;
  out.position = section.position;
  out.key_path = key_path(show, section, ".from");
  const auto* image = std::get_if<ImageSource>(&section.from);
  const std::string what =
      image != nullptr && image->picture.colour
          ? fmt::format("{} {} and {}", film.inverted ? "outside of" : "between",
                        footlight::to_text(image->picture.colour->from), footlight::to_text(image->picture.colour->to))
          : fmt::format("{} {}", film.inverted ? "as dark as" : "brighter than", film.threshold);
  out.text =
      fmt::format("nothing in it is {}: the picture of every frame is empty and everybody waits in the reserve", what);
  out.hint = image != nullptr && image->picture.colour ? "other colours"
             : film.inverted                           ? "a higher threshold, or threshold: otsu"
                                                       : "a lower threshold, or threshold: otsu";
  return out;
}

std::string without_last_newline(std::string text) {
  if (text.ends_with('\n')) text.pop_back();
  return text;
}

template <class Gone>
std::vector<bool> flags_of(std::size_t size, Gone gone) {
  std::vector<bool> out;
  for (std::size_t i = 0; i < size; ++i) out.push_back(gone(i));
  return out;
}

/// Places of a list without names at which nobody stands, as many as the plan has people too few.
std::vector<bool> empty_places(const CellsSource& listed, const Plan& plan, std::size_t section) {
  std::vector<bool> out(listed.cells.size(), false);
  std::size_t too_many = listed.cells.size() - std::min(listed.cells.size(), plan.performers.size());
  // The last one: a model of motion leads people there.
  const auto formation = std::find_if(plan.formations.rbegin(), plan.formations.rend(),
                                      [&](const Formation& one) { return one.section == SectionIndex::of(section); });
  if (formation == plan.formations.rend()) return out;
  for (std::size_t i = 0; i < out.size() && too_many > 0; ++i) {
    if (std::ranges::find(formation->cells, listed.cells[i]) != formation->cells.end()) continue;
    out[i] = true;
    --too_many;
  }
  return out;
}

template <class T>
void leave_out(std::vector<T>& list, const std::vector<bool>& gone) {
  std::size_t i = 0;
  std::erase_if(list, [&](const T&) { return gone[i++]; });
}

}  // namespace

Result<config::LoadedShow> read_show(Session& session, const std::string& file) {
  auto loaded = config::load_show(file);
  if (!loaded) return input_error(without_last_newline(loaded.error().to_text()));
  session.warn(loaded->warnings);
  return std::move(loaded).value();
}

Result<Films> decode_films(Session& session, config::LoadedShow& loaded,
                           const std::vector<std::optional<config::FilmLength>>& known) {
  Show& show = loaded.show;
  Films films(show.sections.size());
  std::vector<std::optional<config::FilmLength>> lengths(show.sections.size());
  Diagnostics diagnostics;
  std::vector<Diagnostic> empty;
  for (std::size_t i = 0; i < show.sections.size(); ++i) {
    const Section& section = show.sections[i];
    if (i < known.size() && known[i]) {
      lengths[i] = known[i];
      continue;
    }
    session.tell("decoding", static_cast<double>(i) / static_cast<double>(show.sections.size()));
    auto film = decode(session, show, section);
    if (!film) continue;
    if (film->has_value()) {
      Film& whole = **film;
      if (shows_nothing(whole) && !std::holds_alternative<PartsSource>(section.from))
        empty.push_back(empty_picture(show, section, whole));
      lengths[i] = config::FilmLength{static_cast<int>(whole.frames.size()), whole.fps};
      films[i] = std::move(whole);
    } else if (film->error().error.kind != ErrorKind::input) {
      return film->error().error;
    } else {
      diagnostics.error(film->error().position, film->error().key, film->error().error.message);
    }
  }
  if (diagnostics.has_errors()) return input_error(without_last_newline(diagnostics.to_text()));
  const auto settled = config::settle_film_lengths(show, lengths);
  if (!settled) return input_error(without_last_newline(settled.error().to_text()));
  session.tell("decoding", 1);
  session.warn(empty);
  return films;
}

Status<> spare_inputs(const config::LoadedShow& loaded, const std::string& output) {
  std::error_code error;
  for (const std::string& file : loaded.files) {
    if (std::filesystem::equivalent(file, output, error)) {
      return input_error(fmt::format("'{}' is a file that the show reads (give the output another name)", output));
    }
  }
  return Done{};
}

void take_durations(Show& show, const Plan& plan) {
  for (std::size_t i = 0; i < show.sections.size() && i < plan.sections.size(); ++i) {
    Section& section = show.sections[i];
    if (!needs_own_length(section)) continue;
    section.duration_counts = show.tempo.count_at(plan.sections[i].end) - section.start_count - section.hold_counts;
  }
}

Status<> mark_absent(Show& show, const std::vector<std::string>& ids) {
  std::vector<std::string> known;
  for (const Performer& performer : show.performers) known.push_back(performer.id);
  for (const std::string& id : ids) {
    const auto found = std::ranges::find(known, id);
    if (found == known.end()) {
      return input_error(fmt::format("--absent: there is no performer {} ({})", config::in_quotes(id),
                                     config::suggestion(id, known, "performers")));
    }
    show.performers[static_cast<std::size_t>(found - known.begin())].absent = true;
  }
  if (!ids.empty() && std::ranges::all_of(show.performers, &Performer::absent)) {
    return input_error("--absent: nobody is left (somebody has to come)");
  }
  return Done{};
}

Status<> mark_covers(Show& show, const std::vector<std::string>& covers) {
  std::vector<std::string> known;
  for (const Performer& performer : show.performers) known.push_back(performer.id);
  std::vector<std::string> who = known;
  for (const Understudy& one : show.understudies) who.push_back(one.id);
  const auto unknown = [&](const std::string& id, const std::vector<std::string>& ids) {
    return input_error(fmt::format("--cover: nobody has the id {} ({})", config::in_quotes(id),
                                   config::suggestion(id, ids, "people")));
  };
  for (const std::string& text : covers) {
    const std::size_t sign = text.find('=');
    if (sign == std::string::npos) {
      return input_error(fmt::format("--cover: {} is no cover (who is absent, then =, then who takes the way: 4=zoe)",
                                     config::in_quotes(text)));
    }
    const std::string absent = text.substr(0, sign);
    const std::string cover = text.substr(sign + 1);
    const auto found = std::ranges::find(known, absent);
    if (found == known.end()) return unknown(absent, known);
    if (std::ranges::find(who, cover) == who.end()) return unknown(cover, who);
    Performer& performer = show.performers[static_cast<std::size_t>(found - known.begin())];
    performer.absent = true;
    performer.cover = cover;
  }
  for (const Performer& performer : show.performers) {
    if (performer.cover.empty()) continue;
    const auto same = [&](const Performer& one) { return one.cover == performer.cover; };
    if (std::ranges::count_if(show.performers, same) > 1) {
      return input_error(fmt::format("--cover: {} cannot cover two people", performer.cover));
    }
    const auto self = std::ranges::find(show.performers, performer.cover, &Performer::id);
    if (self != show.performers.end() && self->absent) {
      return input_error(fmt::format("--cover: {} is absent and cannot cover {}", performer.cover, performer.id));
    }
  }
  return Done{};
}

namespace {

/// Understudies take the place of whom they cover, and her wearable; performers who cover take the wearable with them.
void take_covers(config::LoadedShow& loaded) {
  Show& show = loaded.show;
  for (std::size_t p = 0; p < show.performers.size(); ++p) {
    Performer& performer = show.performers[p];
    if (!performer.absent || performer.cover.empty()) continue;
    const auto by = std::ranges::find(show.performers, performer.cover, &Performer::id);
    if (by != show.performers.end()) {
      const auto taker = PerformerIndex::of(by - show.performers.begin());
      const auto worn_by = [](PerformerIndex who) {
        return [who](const Channel& channel) {
          return channel.kind == Channel::Kind::wearable && channel.performer == who;
        };
      };
      const auto hers = worn_by(PerformerIndex::of(p));
      const bool has_one = std::ranges::any_of(
          loaded.rig.nodes, [&](const Node& node) { return std::ranges::any_of(node.channels, hers); });
      for (Node& node : loaded.rig.nodes) {
        for (Channel& channel : node.channels) {
          if (has_one && worn_by(taker)(channel))
            channel = Channel{};
          else if (hers(channel))
            channel.performer = taker;
        }
      }
      if (has_one) by->wearable = performer.wearable;
      continue;
    }
    const auto understudy = std::ranges::find(show.understudies, performer.cover, &Understudy::id);
    if (understudy == show.understudies.end()) continue;
    performer.id = understudy->id;
    performer.name = understudy->name;
    performer.radius_m = understudy->radius_m;
    performer.max_speed_mps = understudy->max_speed_mps;
    performer.absent = false;
    performer.cover.clear();
    std::erase_if(show.understudies, [&](const Understudy& one) { return one.id == performer.id; });
  }
}

}  // namespace

void take_people(config::LoadedShow& loaded, const Plan& plan) {
  Show& show = loaded.show;
  take_covers(loaded);
  const std::size_t people = show.performers.size();
  if (plan.performers.size() == people) return;
  std::vector<std::optional<PerformerIndex>> now(people);
  std::size_t next = 0;
  for (std::size_t p = 0; p < people && next < plan.performers.size(); ++p) {
    if (show.performers[p].id == plan.performers[next]) now[p] = PerformerIndex::of(next++);
  }
  const auto gone = [&](std::size_t p) { return !now[p]; };
  for (std::size_t s = 0; s < show.sections.size(); ++s) {
    Section& section = show.sections[s];
    for (Override& by_hand : section.overrides) {
      std::erase_if(by_hand.pin, [&](const Override::Pin& pin) { return gone(pin.performer.at()); });
      for (Override::Pin& pin : by_hand.pin) pin.performer = *now[pin.performer.at()];
    }
    auto* listed = std::get_if<CellsSource>(&section.from);
    if (listed == nullptr) continue;
    const std::vector<bool> empty = listed->assigned ? flags_of(people, gone) : empty_places(*listed, plan, s);
    leave_out(listed->cells, empty);
    leave_out(listed->groups, empty);
  }
  leave_out(show.performers, flags_of(people, gone));
  for (Node& node : loaded.rig.nodes) {
    for (Channel& channel : node.channels) {
      if (channel.kind != Channel::Kind::wearable) continue;
      const auto& wearer = now[channel.performer.at()];
      channel = wearer ? Channel{Channel::Kind::wearable, {}, *wearer} : Channel{};
    }
  }
}

}  // namespace footlight::app
