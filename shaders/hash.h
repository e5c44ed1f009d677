// Hashes that kernels and the host share.

#ifndef HASH_H
#define HASH_H
#include "shared.h"

#ifdef __cplusplus
#define INLINE inline
namespace vkpm {
using glm::uvec3;
#else
#define INLINE
#endif

// A bijection of 32 bits in which every input bit affects every output bit (Wellons 2018, "lowbias32").
INLINE uint hash(uint x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

INLINE uint hash(uvec3 v) { return hash(v.x ^ hash(v.y ^ hash(v.z))); }

#ifdef __cplusplus
} // namespace vkpm
#endif
#undef INLINE
#endif
