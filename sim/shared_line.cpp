// SPDX-License-Identifier: Apache-2.0
#include "sim/shared_line.hpp"

#include <algorithm>
#include <utility>

namespace footlight::sim {

Instant SharedLine::say(int speaker, std::vector<std::uint8_t> bytes, Instant start) {
  FL_CHECK(!bytes.empty());
  if (free_.empty()) {
    free_.push_back(talks_.size());
    talks_.emplace_back();
  }
  const std::size_t place = free_.back();
  free_.pop_back();
  const Instant end = start + time_of(bytes.size());
  talks_[place] = {speaker, start, end, kNever, kStart, std::move(bytes), false};
  around_.world.schedule(start, *this, 2 * place);
  return end;
}

void SharedLine::cut(int speaker) {
  for (Talk& talk : talks_) {
    if (talk.speaker != speaker || !talk.under_way) continue;
    talk.garbled_from = std::min(talk.garbled_from, around_.world.now());
    talk.garbled_until = talk.end;
  }
}

Instant SharedLine::quiet_at() const {
  Instant quiet = around_.world.now();
  for (const Talk& talk : talks_) {
    if (talk.under_way) quiet = std::max(quiet, talk.end);
  }
  return quiet;
}

void SharedLine::act(std::uint64_t token) {
  const std::size_t place = token / 2;
  if (token % 2 == 0) {
    begin(talks_[place]);
    around_.world.schedule(talks_[place].end, *this, token + 1);
    return;
  }
  Talk talk = std::exchange(talks_[place], {});  // listeners may say something new
  free_.push_back(place);
  finish(talk);
}

void SharedLine::begin(Talk& talk) {
  for (Talk& other : talks_) {
    if (!other.under_way || other.end <= talk.start) continue;
    const Instant until = std::min(talk.end, other.end);
    for (Talk* both : {&talk, &other}) {
      both->garbled_from = std::min(both->garbled_from, talk.start);
      both->garbled_until = std::max(both->garbled_until, until);
    }
  }
  talk.under_way = true;
  ++use_.frames;
  const Instant from = std::max(talk.start, used_until_);
  const Instant until = talk.end + gap_;
  if (until > from) use_.busy += until - from;
  used_until_ = std::max(used_until_, until);
}

void SharedLine::garble(Talk& talk) {
  const Duration character = time_of(1);
  const auto first = std::max<Duration::rep>(0, (talk.garbled_from - talk.start) / character);
  for (auto i = static_cast<std::size_t>(first); i < talk.bytes.size(); ++i) {
    if (talk.start + time_of(i) >= talk.garbled_until) break;
    talk.bytes[i] ^= static_cast<std::uint8_t>(1 + around_.timing.below(255));
  }
}

void SharedLine::finish(Talk& talk) {
  std::string note;
  const auto add = [&note](std::string_view what) { note.append(note.empty() ? "" : ", ").append(what); };
  if (talk.garbled_from < talk.garbled_until) {
    garble(talk);
    add("garbled");
  }
  if (around_.faults.corrupted()) {
    const auto bit = around_.faults.below(talk.bytes.size() * 8);
    talk.bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    add("corrupt");
  }
  const bool twice = around_.faults.duplicated();
  if (twice) add("heard twice");
  listener_.draw_losses(talk.speaker, note);
  if (around_.trace.on()) {
    around_.trace.line(around_.world.now(), bus_.name, talk.speaker == kController ? '>' : '<', to_hex(talk.bytes),
                       note);
  }
  listener_.heard(talk.speaker, talk.bytes, false);
  if (twice) listener_.heard(talk.speaker, talk.bytes, true);
}

}  // namespace footlight::sim
