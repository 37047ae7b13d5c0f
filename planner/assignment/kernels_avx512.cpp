// SPDX-License-Identifier: Apache-2.0
// Compiled for AVX-512 (planner/CMakeLists.txt).
#define FOOTLIGHT_KERNELS kAvx512Kernels
#include "planner/assignment/kernels.inc"
