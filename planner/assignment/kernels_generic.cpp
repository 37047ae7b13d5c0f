// SPDX-License-Identifier: Apache-2.0
// Compiled for every processor of its kind (planner/CMakeLists.txt).
#define FOOTLIGHT_KERNELS kGenericKernels
#include "planner/assignment/kernels.inc"
