// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/journal/journal_file.hpp"
#include "app/surfaces/surface.hpp"

namespace footlight::app {

/// Writes down what happens in a run, and where the show is: at every change and once a second while it moves. The
/// disk is the affair of a thread of its own behind a bounded queue. A disk that is full, slow or gone costs entries
/// and an alarm, never the show; when it takes something again, what was kept is written, and how much was lost.
class Journal final : public Surface {
 public:
  static constexpr std::size_t kMostWaiting = 4096;  ///< entries and places
  static constexpr Duration kPlaceEvery = milliseconds(1000);

  /// @param run `began` and `machine_start` are filled in here
  Journal(std::filesystem::path file, JournalRun run);
  ~Journal() override { close("killed"); }
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  void look(const DeskView& view, RunDesk& desk) override;
  void told(const RunEvent& event) override;
  [[nodiscard]] bool listens() const override { return false; }

  /// Another plan is led from now on. @param digest config::digest_of
  void plan_is(const std::string& digest);
  /// A change of health of a bus or its nodes, in words.
  void health_is(const std::string& change);
  /// Writes what is left. Nothing may be told any more. Harmless again and again.
  void close(const std::string& how);

 private:
  struct Batch {
    std::vector<JournalEntry> entries;
    std::vector<Place> places;
    [[nodiscard]] std::size_t size() const { return entries.size() + places.size(); }
  };
  void put(JournalEntry entry);
  void put(const Place& place);
  void tell_trouble(RunDesk& desk);
  void run();
  Status<> save(const Batch& batch);
  void keep_for_later(Batch batch, std::string why);

  const std::filesystem::path path_;
  JournalRun run_;
  // Of the calling thread.
  Instant position_{};
  Duration machine_ahead_ = Duration::max();  ///< of the run's clock
  std::optional<Instant> last_at_;            ///< when the show was at the place that was written last
  std::string last_told_;                     ///< what of the place only changes when something happens
  bool troubled_told_ = false;
  // Of its own thread.
  std::optional<JournalFile> file_;
  bool begun_ = false;
  // Shared.
  std::mutex mutex_;
  std::condition_variable news_;
  Batch waiting_;
  std::uint64_t lost_ = 0;
  std::string trouble_;  ///< why nothing is written; empty: all is well
  bool closing_ = false;
  std::thread thread_;
};

}  // namespace footlight::app
