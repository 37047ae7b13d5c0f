// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include <benchmark/benchmark.h>

namespace footlight::bench {

/// How thorough a run is.
struct Effort {
  bool quick = false;
  [[nodiscard]] int repetitions() const { return quick ? 3 : 5; }
};

/// A benchmark's name: who/job/size, which scripts/bench takes apart again.
[[nodiscard]] std::string job_name(const std::string& who, const std::string& job, long size);

/// How much `work` makes the resident memory grow at its peak, MB. 0 where the system does not tell (no /proc).
[[nodiscard]] double peak_memory_mb(const std::function<void()>& work);

/// The same, but does the work only the first time in this process for each name, since benchmarks are called several
/// times.
[[nodiscard]] double peak_memory_once_mb(const std::string& name, const std::function<void()>& work);

void register_assignment(const Effort& effort);
void register_planning(const Effort& effort);
void register_shows(const Effort& effort);
void register_motion(const Effort& effort);

/// The instances and the pictures as files for peers in other languages (tests/bench/peers.py).
void write_assignment_instances(const std::string& folder);
void write_cell_walks(const std::string& folder);
void write_pictures(const std::string& folder);

}  // namespace footlight::bench
