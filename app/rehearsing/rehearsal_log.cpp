// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/rehearsal_log.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>

#include "core/file_descriptor.hpp"

namespace footlight::app {
namespace {

using Kind = RehearsalEntry::Kind;
using Phase = controller::Rehearsal::Phase;

bool moves(Phase phase) { return phase == Phase::runs || phase == Phase::counts_in; }
bool resets(Phase phase) { return phase == Phase::resets || phase == Phase::reset_held; }

/// "rehearsal-20240131-193000", local time.
std::string stem_of(double since_1970_s) {
  const auto time = static_cast<std::time_t>(since_1970_s);
  std::tm local{};
  localtime_r(&time, &local);
  std::array<char, 40> text{};
  const std::size_t size = std::strftime(text.data(), text.size(), "rehearsal-%Y%m%d-%H%M%S", &local);
  return {text.data(), size};
}

}  // namespace

std::string note_line(const RehearsalEntry& note) {
  const std::string cue = note.cue.empty() ? "" : ", cue " + note.cue;
  const std::string whom = note.about == Remark::About::all ? "all" : note.whom;
  return fmt::format("count {:.4g}{}, {}: {}", note.count, cue, whom, note.text);
}

RehearsalLog::RehearsalLog(const Show& show, const std::vector<controller::CuePlay>& plays,
                           std::filesystem::path folder, std::function<double()> wall_s)
    : show_(show), plays_(plays), folder_(std::move(folder)), wall_s_(std::move(wall_s)) {}

void RehearsalLog::open() {
  const std::filesystem::path path = folder_ / kFile;
  std::ifstream old(path);
  for (std::string line; std::getline(old, line);) {
    if (auto entry = entry_from(line)) entries_.push_back(*std::move(entry));
  }
  old.close();
  if (!entries_.empty() && (entries_.front().kind != Kind::begun || entries_.front().text != show_.title)) {
    std::error_code error;
    std::filesystem::rename(path, folder_ / (stem_of(entries_.front().since_1970_s) + ".jsonl"), error);
    entries_.clear();
  }
  const auto file =
      std::make_shared<FileDescriptor>(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  if (file->get() < 0) {
    not_opened_ = fmt::format("cannot write '{}': {}", path.string(), std::strerror(errno));
  } else {
    file_ = std::make_unique<WriterThread>(
        [file](std::string_view text) { return WriterThread::write_all(file->get(), text); });
    // A line that was cut off is ended, or the next one would be part of it.
    if (!entries_.empty()) file_->put("\n");
  }
  RehearsalEntry begun;
  begun.kind = Kind::begun;
  begun.text = show_.title;
  write_down(std::move(begun));
}

std::string RehearsalLog::close() {
  RehearsalEntry ended;
  ended.kind = Kind::ended;
  if (seen_) {
    ended.position_s = to_seconds(seen_->position);
    ended.count = show_.tempo.count_at(seen_->position);
  }
  write_down(std::move(ended));
  (void)flush();
  const std::string stem = stem_of(entries_.front().since_1970_s);
  std::error_code error;
  std::filesystem::rename(folder_ / kFile, folder_ / (stem + ".jsonl"), error);
  return stem;
}

void RehearsalLog::write_down(RehearsalEntry entry) {
  entry.since_1970_s = wall_s_();
  if (file_) file_->put(json_of(entry) + "\n");
  entries_.push_back(std::move(entry));
}

std::string RehearsalLog::trouble() const {
  if (!file_) return not_opened_;
  const std::string why = file_->trouble();
  return why.empty() ? why : fmt::format("the rehearsal is not kept in '{}': {}", (folder_ / kFile).string(), why);
}

void RehearsalLog::look(const DeskView& view, RunDesk& desk) {
  if (seen_) follow(*seen_, view.show);
  seen_ = view.show;
  follow_absent(view.edit);
  if (trouble_told_) return;
  const std::string why = trouble();
  if (why.empty()) return;
  trouble_told_ = true;
  desk.tell({RunEvent::Kind::note, why + " (notes and the report stay in memory until the end)"});
}

/// Who comes after all was absent all the same.
void RehearsalLog::follow_absent(const EditView& edit) {
  for (const EditView::Absent& one : edit.absent) {
    if (!absent_.insert(one.id).second) continue;
    const auto known = std::ranges::find(show_.performers, one.id, &Performer::id);
    happened(Kind::absent, seen_->position, seen_->active >= 0 ? seen_->active : seen_->standby,
             known == show_.performers.end() ? one.id : known->name);
  }
}

void RehearsalLog::follow(const ShowState& before, const ShowState& now) {
  const bool moved = moves(before.phase);
  if (!resets(before.phase) && resets(now.phase)) {
    const auto cue = std::ranges::find_if(plays_, [&](const auto& play) { return now.reset.to < play.to; });
    happened(Kind::reset, now.reset.to, cue == plays_.end() ? -1 : static_cast<int>(cue - plays_.begin()),
             fmt::format("from count {:.4g}", show_.tempo.count_at(now.reset.from)));
  }
  if (moved && (!moves(now.phase) || now.active != before.active)) {
    const bool cut = now.active == before.active && !moves(now.phase);
    const bool not_begun = now.active < 0 && now.standby == before.active;
    const Kind kind = cut || not_begun ? Kind::hold : Kind::end;
    const Instant end = plays_[static_cast<std::size_t>(before.active)].to;
    happened(kind, kind == Kind::end ? end : now.position, before.active, not_begun ? "in the count-in" : "");
  }
  if (moves(now.phase) && (!moved || now.active != before.active)) {
    const bool held = !moved && before.active == now.active;
    happened(held ? Kind::goes_on : Kind::start, now.position, now.active,
             now.percent != 100 ? fmt::format("at {} %", now.percent) : "");
  }
}

void RehearsalLog::happened(Kind kind, Instant position, int cue, std::string text) {
  RehearsalEntry entry;
  entry.kind = kind;
  entry.position_s = to_seconds(position);
  entry.count = show_.tempo.count_at(position);
  entry.cue = number_of(cue);
  entry.text = std::move(text);
  // What ends by itself is nobody's.
  if (kind != Kind::end) entry.who = std::exchange(last_who_, "");
  write_down(std::move(entry));
}

void RehearsalLog::told(const RunEvent& event) {
  if (event.kind != RunEvent::Kind::answer && event.kind != RunEvent::Kind::alarm) return;
  const std::string verb = event.order.substr(0, event.order.find(' '));
  if (verb == "note" || verb == "notes") return;  // written down already
  RehearsalEntry entry;
  entry.kind = event.kind == RunEvent::Kind::alarm ? Kind::alarm : event.refused ? Kind::refused : Kind::order;
  entry.who = event.who.name;
  entry.text = event.kind == RunEvent::Kind::alarm ? event.text : event.order;
  if (entry.kind == Kind::refused) entry.text += ": " + event.text;
  if (entry.kind == Kind::order) last_who_ = entry.who;
  if (seen_) {
    entry.position_s = to_seconds(seen_->position);
    entry.count = show_.tempo.count_at(seen_->position);
    entry.cue = number_of(seen_->active >= 0 ? seen_->active : seen_->standby);
  }
  write_down(std::move(entry));
}

std::string RehearsalLog::number_of(int cue) const {
  return cue < 0 ? "" : plays_[static_cast<std::size_t>(cue)].cue.number.to_text();
}

RunDesk::Verb RehearsalLog::note_verb() {
  return {"note",
          "note Ana too late            at this count, about a person, a group, a cell or all; \"notes\" lists them\n",
          [this](const std::vector<std::string>& words, const Speaker& who) -> Result<std::string> {
            auto remark = read_remark(show_, words);
            if (!remark) return std::move(remark).error();
            RehearsalEntry entry;
            entry.kind = Kind::note;
            entry.who = who.name;
            entry.about = remark->about;
            entry.whom = remark->whom;
            entry.text = remark->text;
            if (seen_) {
              entry.position_s = to_seconds(seen_->position);
              entry.count = show_.tempo.count_at(seen_->position);
              entry.cue = number_of(seen_->active >= 0 ? seen_->active : seen_->standby);
            }
            std::string line = note_line(entry);
            write_down(std::move(entry));
            return line;
          }};
}

RunDesk::Verb RehearsalLog::notes_verb() const {
  return {"notes", "", [this](const std::vector<std::string>& words, const Speaker& /*who*/) -> Result<std::string> {
            if (!words.empty()) return input_error("notes: nothing is wanted after it (\"note ...\" writes one)");
            std::string list;
            for (const RehearsalEntry& entry : entries_) {
              if (entry.kind == Kind::note) list += (list.empty() ? "" : "\n") + note_line(entry);
            }
            return list.empty() ? "no notes" : list;
          }};
}

}  // namespace footlight::app
