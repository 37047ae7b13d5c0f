// SPDX-License-Identifier: Apache-2.0
// Compiled for AVX2 (planner/CMakeLists.txt).
#define FOOTLIGHT_KERNELS kAvx2Kernels
#include "planner/assignment/kernels.inc"
