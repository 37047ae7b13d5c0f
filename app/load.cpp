// SPDX-License-Identifier: Apache-2.0
#include "app/load.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "config/media.hpp"

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

/// Counts that a film lasts at its own speed; nothing when the file does not say how fast that is.
std::optional<double> own_length(const Show& show, const Section& section, const Film& film) {
  if (!(film.fps > 0) || film.frames.size() < 2) return std::nullopt;
  const Duration length = seconds(static_cast<double>(film.frames.size() - 1) / film.fps);
  return show.tempo.count_at(show.tempo.at(section.start_count) + length) - section.start_count;
}

void check_overlaps(const Show& show, Diagnostics& diagnostics) {
  for (std::size_t i = 1; i < show.sections.size(); ++i) {
    const Section& before = show.sections[i - 1];
    const Section& after = show.sections[i];
    if (after.start_count >= before.end_count()) continue;
    diagnostics.error(
        after.position, key_path(show, after, ".start"),
        fmt::format("section '{}' begins at count {:g}, but '{}' lasts until count {:g}{}", after.name,
                    after.start_count, before.name, before.end_count(),
                    std::holds_alternative<VideoSource>(before.from) ? " at its film's own length" : ""),
        fmt::format("start at count {:g} or later, or give '{}' a duration", before.end_count(), before.name));
  }
}

/// @return nothing when the source has no film
std::optional<Result<Film>> decode(const Session& session, const Section& section) {
  if (const auto* video = std::get_if<VideoSource>(&section.from)) {
    return config::decode_video(*video, {}, session.stop());
  }
  if (const auto* image = std::get_if<ImageSource>(&section.from)) {
    return config::decode_image(*image, {}, session.stop());
  }
  return std::nullopt;
}

std::string without_last_newline(std::string text) {
  if (text.ends_with('\n')) text.pop_back();
  return text;
}

}  // namespace

Result<config::LoadedShow> read_show(Session& session, const std::string& file) {
  auto loaded = config::load_show(file);
  if (!loaded) return input_error(without_last_newline(loaded.error().to_text()));
  session.warn(loaded->warnings);
  return std::move(loaded).value();
}

Result<Films> decode_films(Session& session, config::LoadedShow& loaded) {
  Show& show = loaded.show;
  Films films(show.sections.size());
  Diagnostics diagnostics;
  for (std::size_t i = 0; i < show.sections.size(); ++i) {
    Section& section = show.sections[i];
    session.tell("decoding", static_cast<double>(i) / static_cast<double>(show.sections.size()));
    auto film = decode(session, section);
    if (!film) continue;
    if (film->has_value()) {
      films[i] = std::move(**film);
    } else if (film->error().kind != ErrorKind::input) {
      return film->error();
    } else {
      const bool video = std::holds_alternative<VideoSource>(section.from);
      diagnostics.error(section.position, key_path(show, section, video ? ".from.video" : ".from.image"),
                        film->error().message);
    }
    if (!films[i] || !needs_own_length(section)) continue;
    if (const auto counts = own_length(show, section, *films[i])) {
      section.duration_counts = *counts;
    } else {
      diagnostics.error(section.position, key_path(show, section, ".duration"),
                        "the film does not say how fast it runs", "give the section a duration");
    }
  }
  if (!diagnostics.has_errors()) check_overlaps(show, diagnostics);
  if (diagnostics.has_errors()) return input_error(without_last_newline(diagnostics.to_text()));
  session.tell("decoding", 1);
  return films;
}

void take_durations(Show& show, const Plan& plan) {
  for (std::size_t i = 0; i < show.sections.size() && i < plan.sections.size(); ++i) {
    Section& section = show.sections[i];
    if (!needs_own_length(section)) continue;
    section.duration_counts = show.tempo.count_at(plan.sections[i].end) - section.start_count - section.hold_counts;
  }
}

}  // namespace footlight::app
