// SPDX-License-Identifier: Apache-2.0
#include "app/load.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
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

bool shows_nothing(const Film& film) {
  return std::ranges::all_of(film.frames, [](const Mask& frame) {
    return std::ranges::all_of(frame.words(), [](std::uint64_t word) { return word == 0; });
  });
}

Diagnostic empty_picture(const Show& show, const Section& section, const Film& film) {
  Diagnostic out;
  out.severity = Severity::warning;
  out.position = section.position;
  out.key_path = key_path(show, section, ".from");
  out.text =
      fmt::format("nothing in it is {} {}: the picture of every frame is empty and everybody waits in the reserve",
                  film.inverted ? "as dark as" : "brighter than", film.threshold);
  out.hint = film.inverted ? "a higher threshold, or threshold: otsu" : "a lower threshold, or threshold: otsu";
  return out;
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
    auto film = decode(session, section);
    if (!film) continue;
    if (film->has_value()) {
      Film& whole = **film;
      if (shows_nothing(whole)) empty.push_back(empty_picture(show, section, whole));
      lengths[i] = config::FilmLength{static_cast<int>(whole.frames.size()), whole.fps};
      films[i] = std::move(whole);
    } else if (film->error().kind != ErrorKind::input) {
      return film->error();
    } else {
      const bool video = std::holds_alternative<VideoSource>(section.from);
      diagnostics.error(section.position, key_path(show, section, video ? ".from.video" : ".from.image"),
                        film->error().message);
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

}  // namespace footlight::app
