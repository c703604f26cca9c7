// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Compiles a function twice, for AVX2 and for the baseline; the loader picks. The two give the
/// same bits, since fused multiply-adds are off. Sanitizers cannot start a program with such picks;
/// clang, which does not say whether they are on, is used for them only.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(__clang__) || \
    !defined(__x86_64__)
#define EYRIE_SIMD_CLONES
#else
#define EYRIE_SIMD_CLONES __attribute__((target_clones("avx2", "default")))
#endif
