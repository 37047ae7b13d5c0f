// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/rehearsing/rehearsal_entry.hpp"
#include "app/surfaces/run_desk.hpp"
#include "app/surfaces/surface.hpp"
#include "app/writer_thread.hpp"
#include "controller/cue_list.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// Writes down what happens in a rehearsal, line by line as it happens, by a thread of its own: a program that is
/// killed loses nothing that the disk has taken, and the next run of the same show goes on in the same file.
class RehearsalLog final : public Surface {
 public:
  static constexpr const char* kFile = "rehearsal.jsonl";

  /// Borrows show and plays. @param folder of the state; is there  @param wall_s wall clock, seconds since 1970
  RehearsalLog(const Show& show, const std::vector<controller::CuePlay>& plays, std::filesystem::path folder,
               std::function<double()> wall_s);

  /// Reads what is there of a rehearsal of this show that was cut off; of another show it is put aside. Then says that
  /// one has begun. A disk that takes nothing costs the file, not the rehearsal: `trouble`.
  void open();
  /// Says that it has ended, and gives the file a name of its own, by its first line's time. @return that name's stem,
  /// "rehearsal-20240131-193000"
  std::string close();
  void write_down(RehearsalEntry entry);
  [[nodiscard]] const std::vector<RehearsalEntry>& entries() const { return entries_; }
  /// Why nothing is kept; empty: it is.
  [[nodiscard]] std::string trouble() const;
  /// Until all is in the file, as WriterThread::flush.
  bool flush() { return !file_ || file_->flush(); }

  void look(const DeskView& view, RunDesk& desk) override;
  void told(const RunEvent& event) override;
  void plan_taken() override { seen_.reset(); }
  [[nodiscard]] bool listens() const override { return false; }

  /// "note Ana too late" and "notes".
  [[nodiscard]] RunDesk::Verb note_verb();
  [[nodiscard]] RunDesk::Verb notes_verb() const;

 private:
  void follow_absent(const EditView& edit);
  void follow(const ShowState& before, const ShowState& now);
  void happened(RehearsalEntry::Kind kind, Instant position, int cue, std::string text = {});
  [[nodiscard]] std::string number_of(int cue) const;

  const Show& show_;
  const std::vector<controller::CuePlay>& plays_;
  std::filesystem::path folder_;
  std::function<double()> wall_s_;
  std::unique_ptr<WriterThread> file_;  ///< null: there is none
  std::string not_opened_;
  bool trouble_told_ = false;
  std::vector<RehearsalEntry> entries_;
  std::optional<ShowState> seen_;
  std::set<std::string> absent_;  ///< ids that are written down
  std::string last_who_;          ///< of the last order that was carried out, until something comes of it
};

/// "count 17, cue 2, Ana: too late"
[[nodiscard]] std::string note_line(const RehearsalEntry& note);

}  // namespace footlight::app
