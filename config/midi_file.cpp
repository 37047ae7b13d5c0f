// SPDX-License-Identifier: Apache-2.0
#include "config/midi_file.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

#include "config/text_scan.hpp"

namespace footlight::config {
namespace {

constexpr double kMinute_us = 60e6;

/// Bytes with a place; reading over the end is an error that stays.
class Bytes {
 public:
  Bytes(std::string_view bytes, std::size_t first) : bytes_(bytes), first_(first) {}

  [[nodiscard]] bool at_end() const { return i_ >= bytes_.size(); }
  [[nodiscard]] bool short_of() const { return short_; }
  [[nodiscard]] std::size_t place() const { return first_ + i_; }

  std::uint32_t byte() {
    if (at_end()) {
      short_ = true;
      return 0;
    }
    return static_cast<unsigned char>(bytes_[i_++]);
  }
  std::uint32_t big_endian(int count) {
    std::uint32_t out = 0;
    for (int k = 0; k < count; ++k) out = out << 8U | byte();
    return out;
  }
  /// Seven bits a byte, at most four bytes.
  std::uint32_t variable() {
    std::uint32_t out = 0;
    for (int k = 0; k < 4; ++k) {
      const std::uint32_t next = byte();
      out = out << 7U | (next & 0x7FU);
      if ((next & 0x80U) == 0) return out;
    }
    short_ = true;
    return out;
  }
  std::string_view take(std::uint32_t count) {
    if (count > bytes_.size() - std::min(i_, bytes_.size())) {
      short_ = true;
      return {};
    }
    const std::string_view out = bytes_.substr(i_, count);
    i_ += count;
    return out;
  }
  [[nodiscard]] std::uint32_t peek() const { return at_end() ? 0 : static_cast<unsigned char>(bytes_[i_]); }

 private:
  std::string_view bytes_;
  std::size_t first_;
  std::size_t i_ = 0;
  bool short_ = false;
};

struct MetaEvent {
  std::uint64_t tick = 0;
  std::uint32_t type = 0;
  std::string_view data;
  std::size_t place = 0;
};

constexpr std::uint32_t kMarker = 0x06;
constexpr std::uint32_t kCuePoint = 0x07;
constexpr std::uint32_t kEndOfTrack = 0x2F;
constexpr std::uint32_t kTempo = 0x51;
constexpr std::uint32_t kSmpteOffset = 0x54;
constexpr std::uint32_t kTimeSignature = 0x58;

Error wrong(const std::string& file, std::size_t place, const std::string& what) {
  return input_error(fmt::format("{}: error: byte {}: {}", file, place, what));
}

bool is_told(std::uint32_t type) {
  return type == kMarker || type == kCuePoint || type == kTempo || type == kSmpteOffset || type == kTimeSignature;
}

/// Adds a track's events that matter. @return the track's length in ticks
Result<std::uint64_t> read_track(Bytes track, const std::string& file, std::vector<MetaEvent>& out) {
  std::uint64_t tick = 0;
  std::uint32_t running = 0;
  while (!track.at_end()) {
    const std::size_t place = track.place();
    tick += track.variable();
    const std::uint32_t status = (track.peek() & 0x80U) != 0 ? track.byte() : running;
    if (status == 0xFF) {
      const std::uint32_t type = track.byte();
      const std::string_view data = track.take(track.variable());
      if (!track.short_of() && is_told(type)) out.push_back({tick, type, data, place});
      if (!track.short_of() && type == kEndOfTrack) return tick;
    } else if (status == 0xF0 || status == 0xF7) {
      static_cast<void>(track.take(track.variable()));
    } else if (status >= 0x80 && status < 0xF0) {
      running = status;
      // Program change and channel pressure have one byte, the others two.
      static_cast<void>(track.take((status & 0xE0U) == 0xC0U ? 1 : 2));
    } else {
      return wrong(file, place, track.short_of() ? "the track ends in the middle of an event" : "no event begins here");
    }
    if (track.short_of()) return wrong(file, place, "the track ends in the middle of this event");
  }
  return tick;
}

/// Ticks to quarter notes.
class Ticks {
 public:
  /// @param division of the header: ticks a quarter, or SMPTE frames a second and ticks a frame
  static std::optional<Ticks> from(std::uint32_t division) {
    Ticks out;
    if ((division & 0x8000U) == 0) {
      out.a_quarter_ = division;
      return division > 0 ? std::optional(out) : std::nullopt;
    }
    const int frames = 256 - static_cast<int>(division >> 8U);
    const double ticks = division & 0xFFU;
    if ((frames != 24 && frames != 25 && frames != 29 && frames != 30) || ticks == 0) return std::nullopt;
    out.a_second_ = ticks * (frames == 29 ? 30'000.0 / 1'001.0 : frames);
    return out;
  }
  /// Ticks must not decrease from call to call, nor go back behind a change of tempo.
  [[nodiscard]] double quarter(std::uint64_t tick) const {
    if (a_second_ == 0) return static_cast<double>(tick) / a_quarter_;
    return last_quarter_ + static_cast<double>(tick - last_tick_) / a_second_ * quarters_a_minute_ / 60;
  }
  void change_tempo(std::uint64_t tick, double quarters_a_minute) {
    last_quarter_ = quarter(tick);
    last_tick_ = tick;
    quarters_a_minute_ = quarters_a_minute;
  }

 private:
  double a_quarter_ = 0;
  double a_second_ = 0;
  std::uint64_t last_tick_ = 0;
  double last_quarter_ = 0;
  double quarters_a_minute_ = 120;
};

/// UTF-8 as it is, anything else as Latin-1 (MIDI has no word for it); one line.
std::string text_of(std::string_view data) {
  bool utf8 = true;
  for (std::size_t i = 0; i < data.size() && utf8;) {
    const std::size_t length = utf8_length(data, i);
    utf8 = length > 0;
    i += length;
  }
  std::string out;
  for (const char c : data) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7F || (!utf8 && code < 0xA0 && code >= 0x80)) {
      out += ' ';
    } else if (utf8 || code < 0x80) {
      out += c;
    } else {
      out += static_cast<char>(0xC0U | code >> 6U);
      out += static_cast<char>(0x80U | (code & 0x3FU));
    }
  }
  while (out.ends_with(' ')) out.pop_back();
  return out;
}

/// One event after another, in the order of their ticks.
std::optional<Error> add(const MetaEvent& event, const std::string& file, Ticks& ticks, ScoreEvents& out) {
  const auto at = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(event.data[i])); };
  const double quarter = ticks.quarter(event.tick);
  if (event.type == kTempo) {
    if (event.data.size() < 3) return wrong(file, event.place, "a tempo has three bytes");
    const std::uint32_t quarter_us = at(0) << 16U | at(1) << 8U | at(2);
    if (quarter_us == 0) return wrong(file, event.place, "a tempo of 0 microseconds a quarter note");
    out.tempos.push_back({quarter, kMinute_us / quarter_us});
    ticks.change_tempo(event.tick, kMinute_us / quarter_us);
  } else if (event.type == kTimeSignature) {
    if (event.data.size() < 2) return wrong(file, event.place, "a time signature has four bytes");
    if (at(0) < 1 || at(0) > 64 || at(1) > 6) {
      return wrong(file, event.place,
                   fmt::format("a time signature of {} over 2^{} (1 to 64 over 1 to 64)", at(0), at(1)));
    }
    out.meters.push_back({quarter, static_cast<int>(at(0)), 1 << at(1)});
  } else if (event.type == kSmpteOffset) {
    const bool none = std::all_of(event.data.begin(), event.data.end(), [](char c) { return (c & 0x1F) == 0; });
    if (!none) out.ignored.emplace_back("a SMPTE offset: count 1 is where the file begins");
  } else {
    std::string text = text_of(event.data);
    if (!text.empty()) out.rehearsals.push_back({quarter, std::move(text)});
  }
  return std::nullopt;
}

}  // namespace

Result<ScoreEvents> read_midi(std::string_view bytes, const std::string& file) {
  Bytes all(bytes, 0);
  if (all.take(4) != "MThd") return wrong(file, 0, "no MIDI file begins like this (MThd)");
  const std::uint32_t header_size = all.big_endian(4);
  const std::uint32_t format = all.big_endian(2);
  const std::uint32_t tracks = all.big_endian(2);
  const std::uint32_t division = all.big_endian(2);
  if (header_size < 6 || all.short_of()) return wrong(file, 4, "the header is shorter than six bytes");
  static_cast<void>(all.take(header_size - 6));
  if (format > 1) {
    return wrong(file, 8,
                 fmt::format("format {}: its tracks do not belong to one time (save it as format 0 or 1)", format));
  }
  auto ticks = Ticks::from(division);
  if (!ticks) return wrong(file, 12, fmt::format("0x{:04X} is no division of time", division));
  std::vector<MetaEvent> events;
  std::uint64_t end = 0;
  std::uint32_t found = 0;
  while (!all.at_end() && !all.short_of() && found < tracks) {
    const std::size_t place = all.place();
    const std::string_view name = all.take(4);
    const std::uint32_t size = all.big_endian(4);
    const std::size_t first = all.place();
    const std::string_view content = all.take(size);
    if (all.short_of()) return wrong(file, place, "the file ends in the middle of this chunk");
    if (name != "MTrk") continue;  // chunks of other kinds are allowed, and to be passed over
    ++found;
    const auto length = read_track(Bytes(content, first), file, events);
    if (!length) return length.error();
    end = std::max(end, *length);
  }
  if (found < tracks || found == 0) {
    return wrong(file, bytes.size(), fmt::format("the file ends after {} of {} tracks", found, tracks));
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const MetaEvent& a, const MetaEvent& b) { return a.tick < b.tick; });
  ScoreEvents out;
  for (const MetaEvent& event : events) {
    if (auto error = add(event, file, *ticks, out)) return *error;
  }
  out.end = ticks->quarter(end);
  return out;
}

}  // namespace footlight::config
