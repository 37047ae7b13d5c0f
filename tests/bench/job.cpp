// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/job.hpp"

#include <algorithm>
#include <fstream>
#include <map>

#include <malloc.h>

namespace footlight::bench {
namespace {

/// A line of /proc/self/status, kB.
double status_kb(const std::string& key) {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    double value = 0;
    if (word == key + ":" && status >> value) return value;
  }
  return 0;
}

}  // namespace

std::string job_name(const std::string& who, const std::string& job, long size) {
  return who + "/" + job + "/" + std::to_string(size);
}

double peak_memory_mb(const std::function<void()>& work) {
  malloc_trim(0);
  {
    std::ofstream reset("/proc/self/clear_refs");  // 5: the peak starts anew from what is resident now
    reset << "5";
  }
  const double before = status_kb("VmRSS");
  work();
  return std::max(0.0, status_kb("VmHWM") - before) / 1024;
}

double peak_memory_once_mb(const std::string& name, const std::function<void()>& work) {
  static std::map<std::string, double> known;
  const auto found = known.find(name);
  if (found != known.end()) return found->second;
  return known[name] = peak_memory_mb(work);
}

}  // namespace footlight::bench
