// SPDX-License-Identifier: Apache-2.0
#include "app/journal/journal.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "app/surfaces/run_desk.hpp"
#include "core/clock.hpp"
#include "core/machine_time.hpp"

namespace footlight::app {
namespace {

constexpr auto kTryAgain = std::chrono::seconds(1);

/// A place, without what a moving position changes by itself.
std::string fixed_part(const ShowState& state, const Place& place) {
  const auto& where = state.where;
  const auto ns = [](const std::optional<Instant>& at) { return at ? at->time_since_epoch().count() : -1; };
  std::string text = fmt::format("{} {} {} {} {} {} {}", static_cast<int>(state.phase), where.cue.value_or(999'999),
                                 where.runs_since.has_value(), where.percent, ns(where.hold_at), ns(where.step_to),
                                 where.loop.has_value());
  if (where.loop) text += fmt::format(" {} {}", ns(where.loop->from), ns(where.loop->to));
  if (!where.runs_since) text += fmt::format(" {} {}", ns(where.position), where.waits);
  text += fmt::format(" {} {} {} {}", place.time.on, place.time.armed, place.emergency_hold, place.readiness);
  return text;
}

}  // namespace

Journal::Journal(std::filesystem::path file, JournalRun run) : path_(std::move(file)), run_(std::move(run)) {
  run_.began = wall_time();
  run_.machine_start = machine_start();
  thread_ = std::thread([this] { this->run(); });
}

// ---- the calling thread

void Journal::told(const RunEvent& event) {
  JournalEntry entry;
  entry.kind = to_text(event.kind);
  entry.text = event.text;
  if (event.kind == RunEvent::Kind::answer) {
    entry.who = event.who.name;
    entry.order = event.order;
    entry.refused = event.refused;
  }
  put(std::move(entry));
}

void Journal::plan_is(const std::string& digest) {
  JournalEntry entry;
  entry.kind = "plan";
  entry.text = digest;
  put(std::move(entry));
}

void Journal::health_is(const std::string& change) {
  JournalEntry entry;
  entry.kind = "health";
  entry.text = change;
  put(std::move(entry));
}

void Journal::look(const DeskView& view, RunDesk& desk) {
  const ShowState& state = view.show;
  position_ = state.position;
  // The state is up to 50 ms old when it is seen: the least difference is the one of the clocks.
  machine_ahead_ = std::min(machine_ahead_, machine_time() - state.at.time_since_epoch());
  const Place place = place_of(view, machine_ahead_);
  std::string fixed = fixed_part(state, place);
  const bool moves = place.where.runs_since.has_value() || place.in_reset;
  if (!last_at_ || fixed != last_told_ || (moves && state.at - *last_at_ >= kPlaceEvery)) {
    last_at_ = state.at;
    last_told_ = std::move(fixed);
    put(place);
  }
  tell_trouble(desk);
}

void Journal::tell_trouble(RunDesk& desk) {
  std::string trouble;
  std::uint64_t lost = 0;
  {
    const std::lock_guard lock(mutex_);
    trouble = trouble_;
    lost = trouble_.empty() ? std::exchange(lost_, 0) : 0;
  }
  if (!trouble.empty() && !troubled_told_) {
    desk.tell({RunEvent::Kind::alarm,
               fmt::format("the journal '{}' takes nothing: {}; the show goes on", path_.string(), trouble)});
  }
  if (trouble.empty() && troubled_told_) {
    desk.tell({RunEvent::Kind::note, fmt::format("the journal is written again; {} entries are lost", lost)});
  }
  troubled_told_ = !trouble.empty();
}

void Journal::put(JournalEntry entry) {
  entry.wall = wall_time();
  entry.machine = machine_time();
  entry.position = position_;
  const std::lock_guard lock(mutex_);
  if (waiting_.size() < kMostWaiting) {
    waiting_.entries.push_back(std::move(entry));
  } else {
    ++lost_;
  }
  news_.notify_one();
}

void Journal::put(const Place& place) {
  const std::lock_guard lock(mutex_);
  // Of places that wait for a slow disk only the last one is worth anything.
  if (waiting_.size() >= kMostWaiting) waiting_.places.clear();
  waiting_.places.push_back(place);
  news_.notify_one();
}

void Journal::close(const std::string& how) {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    news_.notify_one();
  }
  thread_.join();
  if (file_ && begun_) (void)file_->end(wall_time(), how);
}

// ---- its own thread

void Journal::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    if (trouble_.empty()) {
      news_.wait(lock, [&] { return closing_ || waiting_.size() > 0; });
    } else {
      news_.wait_for(lock, kTryAgain, [&] { return closing_; });
    }
    const bool last = closing_;
    Batch batch = std::exchange(waiting_, {});
    lock.unlock();
    auto saved = save(batch);
    lock.lock();
    if (saved) {
      trouble_.clear();
    } else {
      keep_for_later(std::move(batch), std::move(saved).error().message);
    }
    if (last) return;
  }
}

Status<> Journal::save(const Batch& batch) {
  if (!file_) {
    auto opened = JournalFile::open(path_);
    if (!opened) return std::move(opened).error();
    file_.emplace(std::move(opened).value());
  }
  if (!begun_) {
    if (auto begun = file_->begin(run_); !begun) return begun;
    begun_ = true;
  }
  if (batch.size() == 0) return Done{};
  return file_->write(batch.entries, batch.places);
}

/// Under the lock. What came first is kept, as far as there is room.
void Journal::keep_for_later(Batch batch, std::string why) {
  trouble_ = std::move(why);
  const std::size_t room = kMostWaiting - std::min(kMostWaiting, waiting_.size());
  if (batch.entries.size() > room) {
    lost_ += batch.entries.size() - room;
    batch.entries.resize(room);
  }
  std::ranges::move(waiting_.entries, std::back_inserter(batch.entries));
  waiting_.entries = std::move(batch.entries);
  if (waiting_.places.empty() && !batch.places.empty()) waiting_.places = {batch.places.back()};
}

}  // namespace footlight::app
