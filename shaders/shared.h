// What C++ and GLSL both read: types, and the list of features; shared_*.h have the buffers' structs and an Args struct
// per kernel.
//
// Every struct has scalar layout: the same bytes in both languages, no padding, no second copy.
// Lengths are in the units of the scene (DeviceScene.unit), directions are of unit length, radiance is in W/(m^2 sr),
// flux in W.

#ifndef SHARED_H
#define SHARED_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
#define SHARED_BEGIN namespace vkpm {
#define SHARED_END }
SHARED_BEGIN
using glm::ivec3, glm::uvec2, glm::vec2, glm::vec3, glm::vec4;
using uint = std::uint32_t;

/// A device address of an array of T.
template <class T> struct Ptr { std::uint64_t address = 0; };

#define PTR(T) Ptr<T>
#define ADDRESS(T) Ptr<T>
#define BUFFER(T)
#else
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#define SHARED_BEGIN
#define SHARED_END
#define PTR(T) T##Ptr
// In a struct that kernels copy or hand on: there, and for casts, SwiftShader fails on pointers. Read as
// TPtr(address).at[i].
#define ADDRESS(T) uvec2
#define BUFFER(T)                                                                                                      \
    layout(buffer_reference, scalar, buffer_reference_align = 4) buffer T##Ptr { T at[]; };
#endif

BUFFER(uint)
BUFFER(float)

// ---- Features: a specialization constant in GLSL, a field of Features in C++ -------------------

const uint ANY = 0xffffffffu; // a choice that is made while the kernel runs

const uint INTEGRATOR_PHOTON = 0u;
const uint INTEGRATOR_PATH = 1u;
const uint INTEGRATOR_DIRECT = 2u;
const uint INTEGRATOR_PHOTON_MAP = 3u;
const uint INTEGRATOR_LIGHT = 4u;

const uint DENSITY_KERNEL_CONSTANT = 0u;
const uint DENSITY_KERNEL_CONE = 1u;
const uint DENSITY_KERNEL_GAUSS = 2u;
const uint DENSITY_KERNEL_EPANECHNIKOV = 3u;

// id, type, name, value when nothing is known of the scene: the general program
#define FEATURES(X)                                                                                                    \
    CLASSIC_FEATURES(X)                                                                                                \
    WORLD_FEATURES(X)

#define CLASSIC_FEATURES(X)                                                                                            \
    X(0, bool, hasTriangles, true)                                                                                     \
    X(1, bool, hasSpheres, true)                                                                                       \
    X(2, bool, hasSmoothNormals, true)                                                                                 \
    X(3, uint, materialKinds, ANY) /* bits of the kinds that the scene has, see shared_kinds.h */                      \
    X(4, bool, hasTint, true)                                                                                          \
    X(5, bool, hasExactFresnel, true)                                                                                  \
    X(6, bool, hasSchlickFresnel, true)                                                                                \
    X(7, bool, hasManyLights, true)                                                                                    \
    X(8, uint, lightKinds, ANY)                                                                                        \
    X(9, bool, hasTwoSidedLights, true)                                                                                \
    X(10, bool, hasGlobalMap, true)                                                                                    \
    X(11, bool, hasCausticMap, true)                                                                                   \
    X(12, bool, hasRadiusField, true)                                                                                  \
    X(13, bool, hasNearest, true)                                                                                      \
    X(14, uint, densityKernel, ANY)                                                                                    \
    X(15, uint, integrator, ANY)                                                                                       \
    X(16, uint, stackSize, 64)                                                                                         \
    X(17, bool, hasEmissionLayer, true)                                                                                \
    X(18, bool, hasDirectLayer, true)                                                                                  \
    X(19, bool, hasSpecularLayer, true)                                                                                \
    X(20, bool, hasCausticLayer, true)                                                                                 \
    X(21, bool, hasIndirectLayer, true)                                                                                \
    X(22, bool, hasAlbedo, true)                                                                                       \
    X(23, bool, hasNormal, true)                                                                                       \
    X(24, bool, hasDepth, true)                                                                                        \
    X(25, bool, hasNoise, true)                                                                                        \
    X(26, bool, hasBias, true)                                                                                         \
    X(27, bool, checksFeatures, false) /* kernels report what they meet and are without, see feature_checks.glsl */    \
    X(28, uint, hasFarLights, 2)       /* 1: only one, that nothing hides */                                           \
    X(29, bool, hasGuide, true)                                                                                        \
    X(30, bool, hasSmoothDiffuse, true)                                                                                \
    X(31, bool, hasContact, true)                                                                                      \
    X(39, bool, hasNarrow, true)  /* surfaces that send light on in one direction or about it */                       \
    X(43, bool, hasLabels, false) /* albedo says which path brought a pixel most, see labels.glsl */

// Those that plain kernels are without, as they are without glossy lobes and without lights that have no area.
#define WORLD_FEATURES(X)                                                                                              \
    X(32, bool, hasMedia, true)                                                                                        \
    X(33, bool, hasDispersion, true)                                                                                   \
    X(34, bool, hasTouching, true)                                                                                     \
    X(35, bool, hasLens, true)                                                                                         \
    X(36, bool, hasTextures, true)                                                                                     \
    X(37, bool, hasOpacity, true)                                                                                      \
    X(38, bool, hasEmissionTextures, true)                                                                             \
    X(40, bool, hasWide, true)                                                                                         \
    X(41, bool, hasNormalMaps, true)                                                                                   \
    X(42, bool, hasMixed, true)      /* surfaces that transmit a part */                                               \
    X(44, bool, hasLightGuide, true) /* light samples of a sky may follow one, see light_guide.glsl */

#ifdef __cplusplus
struct Features {
#define X(id, type, name, value) type name = value;
    FEATURES(X)
#undef X
};
#define X(id, type, name, value) const uint id_##name = id;
FEATURES(X)
#undef X
#else
#define X(id, type, name, value) const uint id_##name = id;
FEATURES(X)
#undef X
#define X(id, type, name, value) layout(constant_id = id) const type name = value;
CLASSIC_FEATURES(X)
#ifdef PLAIN
#undef X
#define X(id, type, name, value) const type name = false;
#endif
WORLD_FEATURES(X)
#undef X
#endif

const uint NONE = 0xffffffffu;

const uint GROUP = 64u; // invocations of a work group, of every kernel

SHARED_END
#endif
