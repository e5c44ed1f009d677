// Owen-scrambled Sobol points (Burley 2020), a pure function of sequence, index and dimension.
#ifndef RANDOM_GLSL
#define RANDOM_GLSL
#include "common.glsl"
#include "hash.h"

struct Sampler {
    uint index; // of the point in its sequence
    uint seed;  // of the sequence
};

uint hash(uint a, uint b) { return hash(a ^ (hash(b) + 0x9e3779b9u + (a << 6) + (a >> 2))); }

// Owen scrambling of the bit-reversed x: each bit is flipped by a hash of the bits below it
// (Laine & Karras 2011, with the constants of Vegdahl 2021).
uint scrambleReversed(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Owen scrambling: each bit is flipped by a hash of the bits above it.
uint owenScramble(uint x, uint seed) { return bitfieldReverse(scrambleReversed(bitfieldReverse(x), seed)); }

// Second dimension of the Sobol sequence: Pascal's matrix modulo 2 times the bit-reversed index.
// By Lucas' theorem the matrix is a Kronecker power, so five exchanges of half the bits multiply by it.
uint sobolSecond(uint index) {
    index ^= (index & 0xaaaaaaaau) >> 1;
    index ^= (index & 0xccccccccu) >> 2;
    index ^= (index & 0xf0f0f0f0u) >> 4;
    index ^= (index & 0xff00ff00u) >> 8;
    index ^= (index & 0xffff0000u) >> 16;
    return bitfieldReverse(index);
}

// The 24 high bits as a float in [0, 1).
float unitFloat(uint x) { return float(x >> 8) * (1.0 / 16777216.0); }

// A choice in [0, 1) that is the same for the same ray and number.
float choiceOfRay(vec3 origin, vec3 direction, uint number) {
    uint bits = hash(floatBitsToUint(origin)) ^ hash(floatBitsToUint(direction) + uvec3(0x9e3779b9u));
    return unitFloat(hash(bits ^ hash(number)));
}

// A point in [0, 1)^2; each dimension pair has its own shuffle and scrambling.
vec2 sample2(Sampler s, uint dimension) {
    uint seed = hash(s.seed, dimension);
    uint index = owenScramble(s.index, seed);
    uint x = scrambleReversed(index, hash(seed ^ 0x68bc21ebu));
    uint y = owenScramble(sobolSecond(index), hash(seed ^ 0x02e5be93u));
    return vec2(unitFloat(bitfieldReverse(x)), unitFloat(y));
}

// A point of one of the sequences (SAMPLES_...) of a pixel.
Sampler pixelSampler(uint pixel, uint index, uint seed, uint sequence) {
    return Sampler(index, hash(hash(seed, 0x70697865u + sequence), pixel));
}

// The sequence of a pass of photons; its points are the photons.
Sampler photonSampler(uint photon, uint pass, uint seed, uint map) {
    return Sampler(photon, hash(hash(seed, 0x70686f74u + map), pass));
}

#endif
