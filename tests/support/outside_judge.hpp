// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/film.hpp"
#include "core/plan.hpp"

namespace footlight::tests {

/// The judges of other hands: check_marks.py and theta_dev.py of the shared folder, in Python, which share no code with
/// the program. Found through FOOTLIGHT_SHARED, else in "shared" beside the repository.
class OutsideJudge {
 public:
  /// @return why they cannot be asked here; empty when they can
  [[nodiscard]] static std::string missing();

  /// A folder of its own below the test's temporary folder; it is removed at the end.
  OutsideJudge();
  ~OutsideJudge();
  OutsideJudge(const OutsideJudge&) = delete;
  OutsideJudge& operator=(const OutsideJudge&) = delete;

  /// Writes marks.csv and stage.json of a plan.
  void write(const Plan& plan) const;
  /// Writes a film's frames as pictures. @return the path to hand to theta_dev
  [[nodiscard]] std::string write(const Film& film) const;

  /// @return what the judge printed with --json
  [[nodiscard]] std::string check_marks(const std::string& options = {}) const;
  [[nodiscard]] std::string theta_dev(const std::string& film, const std::string& section) const;

 private:
  [[nodiscard]] static std::string run(const std::string& command);
  std::string folder_;
};

/// The number behind "key": in a line of JSON. @return nothing when it is null or not there
[[nodiscard]] std::optional<double> number_in(const std::string& json, const std::string& key);

}  // namespace footlight::tests
