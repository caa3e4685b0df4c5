// Marks a function of plain loops that is to be compiled for AVX-512, AVX2 and plain x86-64 side by side; the
// loader takes what the processor has. Contraction being off, all of them round alike: the same bits.
#pragma once

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CLOTH_VECTORISED __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLOTH_VECTORISED
#endif
