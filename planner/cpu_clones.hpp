// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Before a function: it is compiled for several generations of x86-64 processors, and the program takes the best one
/// for the machine when it starts. Floating point is not contracted, so that every clone computes the same bits.
/// Sanitizers instrument the choice before they are ready for it, so that their builds have one version.
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FOOTLIGHT_CPU_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define FOOTLIGHT_CPU_CLONES
#endif
