// SPDX-License-Identifier: Apache-2.0
#include "app/surfaces/orders.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "app/surfaces/show_timecode.hpp"

namespace footlight::app {

using controller::Command;
using Kind = Command::Kind;

const std::string_view kOrders =
    "go, or an empty line         the standby cue; goes on after a hold; confirms and lights a reset move\n"
    "hold, hold freeze            the show stands at once, in the middle of a walk if need be\n"
    "hold end; run on             it will stand where everybody next stands; takes that back\n"
    "back; top                    to the beginning of this cue, or of the one before; of the show\n"
    "jump cue 12                  also: jump section ring, jump count 17.5, jump time 1:23.5 or 01:00:12:05\n"
    "loop section ring; loop off  also: loop cue 12, loop counts 17 33\n"
    "tempo 80                     25 to 200 % of the written tempo, as far as the cue's walks are proved for\n"
    "step                         one count, and stands\n"
    "placed                       people stand where they must be, by your word: no reset move\n"
    "cancel                       the jump that was asked for\n"
    "ok                           inputs that were switched off because they were stuck count again\n"
    "time on; time off            follows the source of time, again; goes by its own clock\n"
    "time here                    the way to where people next stand after the source of time\n"
    "state; help; quit            what is; this; ends the run and makes no lamp dark\n";

namespace {

std::vector<std::string> words_of(std::string_view line) {
  std::string lower(line);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::istringstream stream(lower);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::optional<double> number_in(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value > -1e6 && value < 1e6)) return std::nullopt;
  return value;
}

/// "83.5", "1:23.5", "1:02:03": s
std::optional<double> time_in(std::string_view text) {
  double value_s = 0;
  for (int parts = 0; parts < 3; ++parts) {
    const std::size_t colon = text.find(':');
    const auto part = number_in(text.substr(0, colon));
    if (!part || *part < 0 || ((parts > 0 || colon != std::string_view::npos) && parts > 0 && *part >= 60)) {
      return std::nullopt;
    }
    value_s = value_s * 60 + *part;
    if (colon == std::string_view::npos) return value_s;
    text.remove_prefix(colon + 1);
  }
  return std::nullopt;
}

/// "01:00:12:05", "01:00:12;05": with frames, as no time in seconds is written.
bool names_frames(std::string_view text) {
  return std::ranges::count(text, ':') == 3 || text.find_first_of(";,") != std::string_view::npos;
}

/// "a timecode from 01:00:00:00 to 01:08:12:00 (25 frames a second)"
std::string codes_of(const TimeRules& rules, Instant from, Instant to) {
  const auto code = [&](Instant at) { return timecode_text(rules.start + at.time_since_epoch(), rules.rate); };
  return fmt::format("a timecode from {} to {} ({} frames a second)", code(from), code(to), to_text(rules.rate));
}

std::string rest_of(const std::vector<std::string>& words, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < words.size(); ++i) text += (i > first ? " " : "") + words[i];
  return text;
}

std::string lower(std::string text) { return rest_of(words_of(text), 0); }

const std::map<std::string, Kind>& plain_orders() {
  static const std::map<std::string, Kind> kOrders{
      {"", Kind::go},
      {"go", Kind::go},
      {"hold", Kind::hold},
      {"hold freeze", Kind::hold},
      {"hold end", Kind::hold_at_end},
      {"hold at the end", Kind::hold_at_end},
      {"run on", Kind::run_on},
      {"back", Kind::back},
      {"loop off", Kind::loop_off},
      {"step", Kind::step},
      {"placed", Kind::placed},
      {"cancel", Kind::cancel},
      {"ok", Kind::acknowledge},
      {"time on", Kind::follow},
      {"time off", Kind::unfollow},
      {"time here", Kind::join},
  };
  return kOrders;
}

}  // namespace

Orders::Orders(const Show& show, const Plan& plan)
    : show_(show), plan_(plan), plays_(controller::cue_plays(show, plan)) {}

Result<Order> Orders::from(std::string_view line) const {
  const std::vector<std::string> words = words_of(line);
  const std::string text = rest_of(words, 0);
  Order order;
  if (const auto plain = plain_orders().find(text); plain != plain_orders().end()) {
    order.command.kind = plain->second;
    return order;
  }
  if (text == "quit") return Order{Order::Kind::quit, {}};
  if (text == "top") {
    order.command.kind = Kind::jump;
    order.command.position = plays_.front().from;
    return order;
  }
  if (words.front() == "tempo") {
    std::string number = words.size() == 2 ? words[1] : words.size() == 3 && words[2] == "%" ? words[1] : "";
    if (number.ends_with('%')) number.pop_back();
    const auto percent = number_in(number);
    if (!percent || *percent < controller::kSlowest_percent || *percent > controller::kFastest_percent) {
      return input_error("tempo: a percentage from 25 to 200 is wanted, as in \"tempo 80\"");
    }
    order.command.kind = Kind::tempo;
    order.command.percent = static_cast<int>(*percent);
    return order;
  }
  if (words.front() == "jump" || words.front() == "loop") {
    auto where = stretch(words.front(), words);
    if (!where) return std::move(where).error();
    order.command.kind = words.front() == "jump" ? Kind::jump : Kind::loop;
    order.command.position = where->from;
    order.command.until = where->to;
    return order;
  }
  return input_error(fmt::format("\"{}\" is no order (\"help\" lists them)", text));
}

/// The end of the frame: where people stand at any instant of it they stand there then.
std::optional<Instant> Orders::position_of(std::string_view timecode) const {
  const auto code = parse_timecode(timecode, show_.time.rate);
  if (!code) return std::nullopt;
  const Instant from = plays_.front().from;
  const Instant to = plays_.back().to;
  const Duration frame = frame_time(show_.time.rate);
  const Instant at(in_show(time_of(*code), show_.time));
  if (at > to || at + frame <= from) return std::nullopt;
  return std::clamp(at + frame - Duration(1), from, to);
}

Result<Orders::Stretch> Orders::stretch(std::string_view verb, const std::vector<std::string>& words) const {
  const std::string what = words.size() > 1 ? words[1] : "";
  const std::string which = rest_of(words, 2);
  const Stretch show{plays_.front().from, plays_.back().to};
  if (what == "cue") {
    const auto number = CueNumber::parse(which);
    std::string all;
    for (const controller::CuePlay& play : plays_) {
      if (number == play.cue.number) return Stretch{play.from, play.to};
      all += (all.empty() ? "" : ", ") + play.cue.number.to_text();
    }
    return input_error(fmt::format("{}: no cue \"{}\" (there are {})", verb, which, all));
  }
  if (what == "section") {
    std::string all;
    for (const PlanSection& section : plan_.sections) {
      if (lower(section.name) == which) return Stretch{section.start, section.end};
      all += (all.empty() ? "" : ", ") + section.name;
    }
    return input_error(fmt::format("{}: no section \"{}\" (there are {})", verb, which, all));
  }
  const auto on_the_show = [&](Instant at) { return at >= show.from && at <= show.to; };
  if (verb == "loop" && what == "counts" && words.size() == 4) {
    const auto from = number_in(words[2]);
    const auto to = number_in(words[3]);
    if (from && to && *from < *to && on_the_show(show_.tempo.at(*from)) && on_the_show(show_.tempo.at(*to))) {
      return Stretch{show_.tempo.at(*from), show_.tempo.at(*to)};
    }
    return input_error(
        fmt::format("loop: two ascending counts from {:.6g} to {:.6g} are wanted, as in \"loop counts 17 33\"",
                    show_.tempo.count_at(show.from), show_.tempo.count_at(show.to)));
  }
  if (verb == "jump" && what == "count") {
    const auto count = number_in(which);
    if (count && on_the_show(show_.tempo.at(*count))) return Stretch{show_.tempo.at(*count), show.to};
    return input_error(fmt::format("jump: a count from {:.6g} to {:.6g} is wanted", show_.tempo.count_at(show.from),
                                   show_.tempo.count_at(show.to)));
  }
  if (verb == "jump" && what == "time" && names_frames(which)) {
    const auto position = position_of(which);
    if (position) return Stretch{*position, show.to};
    return input_error(fmt::format("jump: {} is wanted, or a time as in \"jump time 1:23.5\"",
                                   codes_of(show_.time, show.from, show.to)));
  }
  if (verb == "jump" && what == "time") {
    const auto time_s = time_in(which);
    if (time_s && on_the_show(instant_at(*time_s))) return Stretch{instant_at(*time_s), show.to};
    return input_error(fmt::format("jump: a time from {:.3f} to {:.3f} s is wanted, as in \"jump time 1:23.5\"",
                                   to_seconds(show.from), to_seconds(show.to)));
  }
  return input_error(verb == "jump" ? "jump: cue, section, count or time is wanted, as in \"jump cue 12\""
                                    : "loop: cue, section, counts or off is wanted, as in \"loop counts 17 33\"");
}

}  // namespace footlight::app
