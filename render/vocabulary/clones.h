#pragma once
// Compiles a hot loop for three levels of x86-64; the loader picks one. Contraction is off (see the build),
// so every version gives the same bits. Sanitizers cannot follow the choice and get one version.

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(__clang__)
#define HILCAM_CLONES
#else
#define HILCAM_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#endif
