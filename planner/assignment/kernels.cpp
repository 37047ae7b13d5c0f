// SPDX-License-Identifier: Apache-2.0
#include "planner/assignment/kernels.hpp"

#include <atomic>

#include "core/check.hpp"

namespace footlight::planner::assignment {

extern const Kernels kGenericKernels;
#if defined(FOOTLIGHT_X86_KERNELS)
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;
#endif

namespace {

const Kernels& kernels_for(Instructions wanted) {
#if defined(FOOTLIGHT_X86_KERNELS)
  if (wanted == Instructions::avx512) return kAvx512Kernels;
  if (wanted == Instructions::avx2) return kAvx2Kernels;
#endif
  return kGenericKernels;
}

const Kernels* widest_kernels() {
  for (const Instructions wanted : {Instructions::avx512, Instructions::avx2}) {
    if (has_instructions(wanted)) return &kernels_for(wanted);
  }
  return &kGenericKernels;
}

std::atomic<const Kernels*>& used_kernels() {
  static std::atomic<const Kernels*> used = widest_kernels();
  return used;
}

}  // namespace

bool has_instructions(Instructions wanted) {
  if (wanted == Instructions::generic) return true;
#if defined(FOOTLIGHT_X86_KERNELS)
  return wanted == Instructions::avx512 ? __builtin_cpu_supports("avx512f") != 0 : __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

const Kernels& kernels() { return *used_kernels().load(std::memory_order_relaxed); }

void use_instructions(Instructions wanted) {
  FL_CHECK(has_instructions(wanted));
  used_kernels().store(&kernels_for(wanted), std::memory_order_relaxed);
}

}  // namespace footlight::planner::assignment
