// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/rehearsing.hpp"

#include <utility>

#include <CLI/CLI.hpp>

#include "app/rehearsing/rehearsal_report.hpp"
#include "config/output_file.hpp"

namespace footlight::app {

void RehearsingOptions::add_options(CLI::App& command) {
  command.add_option("--rehearsal-report", report,
                     "what was rehearsed, held and noted, when the run ends: .html, .json or .txt (always also in the "
                     "state folder)");
}

Rehearsing::Rehearsing(const Show& show, const Plan& plan, RunDesk& desk, const std::filesystem::path& state,
                       RehearsingOptions options)
    : show_(show),
      state_(state),
      options_(std::move(options)),
      plays_(desk.orders().plays()),
      freeze_(plan, waits_of(plays_)),
      log_(show_, plays_, state_, [] { return to_seconds(wall_time()); }),
      mutes_(show_),
      pace_(show_, clock_) {
  log_.open();
  desk.add([this](DeskView& view) {
    view.freeze = freeze_.look(view);
    view.limits = limits_.empty() ? nullptr : &limits_;
  });
  desk.add(*this);
  desk.add(log_);
  desk.add(log_.note_verb());
  desk.add(log_.notes_verb());
  mutes_.add_to(desk);
  pace_.add_to(desk);
}

std::vector<std::string> Rehearsing::finish(const LiveReport* live) {
  const std::string stem = log_.close();
  const RehearsalReport report = report_of(show_, plays_, log_.entries(), live);
  std::vector<std::string> trouble;
  const auto write = [&](const std::filesystem::path& file, const std::string& text) {
    if (auto written = config::write_file(file, text); !written) trouble.push_back(written.error().message);
  };
  write(state_ / (stem + ".txt"), rehearsal_text(report));
  write(state_ / (stem + ".json"), rehearsal_json(report));
  write(state_ / (stem + ".html"), rehearsal_html(report));
  if (options_.report.empty()) return trouble;
  const std::filesystem::path file(options_.report);
  write(file, file.extension() == ".json"  ? rehearsal_json(report)
              : file.extension() == ".txt" ? rehearsal_text(report)
                                           : rehearsal_html(report));
  return trouble;
}

}  // namespace footlight::app
