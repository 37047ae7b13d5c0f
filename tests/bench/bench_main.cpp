// SPDX-License-Identifier: Apache-2.0
// footlight_bench [--quick] [--write FOLDER] [Google Benchmark's options]
#include <cstdio>
#include <string_view>

#include "tests/bench/job.hpp"

int main(int argc, char** argv) {
  using namespace footlight::bench;
  Effort effort;
  int kept = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--quick") {
      effort.quick = true;
    } else if (word == "--write" && i + 1 < argc) {
      write_assignment_instances(argv[i + 1]);
      write_cell_walks(argv[i + 1]);
      write_pictures(argv[i + 1]);
      return 0;
    } else {
      argv[kept++] = argv[i];
    }
  }
  argc = kept;
#ifndef FOOTLIGHT_HAS_LEMON
  std::fprintf(stderr, "note: built without LEMON (liblemon-dev); its rows are left out\n");
#endif
  register_assignment(effort);
  register_planning(effort);
  register_shows(effort);
  register_motion(effort);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
