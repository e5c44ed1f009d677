// What C++ and GLSL both read: buffer structs, one Args struct per kernel, and the list of features.
//
// Every struct has scalar layout: the same bytes in both languages, no padding, no second copy.
// Lengths are in the units of the scene (DeviceScene.unit), directions are of unit length, radiance is in W/(m^2 sr), flux in W.

#ifdef __cplusplus
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
namespace vkpm {
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
#define PTR(T) T##Ptr
// In a struct that kernels copy or hand on: there, and for casts, SwiftShader fails on pointers. Read as TPtr(address).at[i].
#define ADDRESS(T) uvec2
#define BUFFER(T) layout(buffer_reference, scalar, buffer_reference_align = 4) buffer T##Ptr { T at[]; };
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

const uint KERNEL_CONSTANT = 0u;
const uint KERNEL_CONE = 1u;
const uint KERNEL_GAUSS = 2u;
const uint KERNEL_EPANECHNIKOV = 3u;

// id, name, value when nothing is known of the scene: the general program
#define FEATURES(X)                                                                                                    \
    X(0, hasTriangles, 1)                                                                                              \
    X(1, hasSpheres, 1)                                                                                                \
    X(2, hasSmoothNormals, 1)                                                                                          \
    X(3, hasMirror, 1)                                                                                                 \
    X(4, hasGlass, 1)                                                                                                  \
    X(5, hasTint, 1)                                                                                                   \
    X(6, hasExactFresnel, 1)                                                                                           \
    X(7, hasSchlickFresnel, 1)                                                                                         \
    X(8, hasManyLights, 1)                                                                                             \
    X(9, hasRectangleLights, 1)                                                                                        \
    X(10, hasTriangleLights, 1)                                                                                        \
    X(11, hasSphereLights, 1)                                                                                          \
    X(12, hasTwoSidedLights, 1)                                                                                        \
    X(13, hasGlobalMap, 1)                                                                                             \
    X(14, hasCausticMap, 1)                                                                                            \
    X(15, hasRadiusField, 1)                                                                                           \
    X(16, hasNearest, 1)                                                                                               \
    X(17, densityKernel, ANY)                                                                                          \
    X(18, integrator, ANY)                                                                                             \
    X(19, stackSize, 64)                                                                                               \
    X(20, hasEmissionLayer, 1)                                                                                         \
    X(21, hasDirectLayer, 1)                                                                                           \
    X(22, hasSpecularLayer, 1)                                                                                         \
    X(23, hasCausticLayer, 1)                                                                                          \
    X(24, hasIndirectLayer, 1)                                                                                         \
    X(25, hasAlbedo, 1)                                                                                                \
    X(26, hasNormal, 1)                                                                                                \
    X(27, hasDepth, 1)                                                                                                 \
    X(28, hasNoise, 1)                                                                                                 \
    X(29, hasDiffuse, 1)                                                                                               \
    X(30, hasBias, 1)                                                                                                  \
    X(31, checksFeatures, 0) /* kernels report what they meet and are without, see features.glsl */                    \
    X(32, hasFarLights, 2) /* 1: only one, that nothing hides */                                                       \
    X(33, hasGuide, 1)                                                                                                 \
    X(34, hasSmoothDiffuse, 1)                                                                                         \
    X(35, hasContact, 1)

#ifdef __cplusplus
struct Features {
#define X(id, name, value) uint name = value;
    FEATURES(X)
#undef X
};
#define X(id, name, value) const uint id_##name = id;
FEATURES(X)
#undef X
#else
#define X(id, name, value) const uint id_##name = id;
FEATURES(X)
#undef X
#define X(id, name, value) layout(constant_id = id) const uint name = value;
FEATURES(X)
#undef X
#endif

// ---- The scene ----------------------------------------------------------------------------------

const uint NONE = 0xffffffffu;

/// A bounding volume hierarchy node with the boxes of its two children packed in the parent.
/// A child is the index of a node, or LEAF | (count - 1) << LEAF_SHIFT | first slot of `leaves`;
/// a missing child has an inverted box.
struct Node {
    vec3 leftLow;
    vec3 leftHigh;
    vec3 rightLow;
    vec3 rightHigh;
    uint left;
    uint right;
};
const uint LEAF = 0x80000000u;
const uint LEAF_SHIFT = 27u;
const uint LEAF_FIRST = 0x07ffffffu;
BUFFER(Node)

/// A primitive as traversal reads it, in the order of the leaves:
/// a triangle a, b, c, or, if id >= DeviceScene.triangleCount, the sphere of centre a and radius b.x, whose point next to the
/// origin of coordinates is c.
struct Leaf {
    vec3 a;
    vec3 b;
    vec3 c;
    uint id;
};
BUFFER(Leaf)

/// A triangle's Leaf by the components of its vertices.
struct LeafNumbers {
    float a[3];
    float b[3];
    float c[3];
    uint id;
};
BUFFER(LeafNumbers)

/// A primitive as shading reads it, in the order of the scene: triangles first, then spheres.
/// A triangle's geometric normal is that of (b - a) x (c - a); a sphere's points outward.
struct Primitive {
    vec3 a;
    vec3 b;
    vec3 c;
    uint material;
    uint light;   // index into `lights`, or NONE
    uint normals; // index into `normals`, or NONE for a flat triangle or a sphere
};
BUFFER(Primitive)

/// Unit shading normals at the three vertices of a triangle.
struct Normals {
    vec3 a;
    vec3 b;
    vec3 c;
};
BUFFER(Normals)

const uint MATERIAL_DIFFUSE = 0u; // Lambert, both sides
const uint MATERIAL_MIRROR = 1u;  // perfect mirror, both sides
const uint MATERIAL_GLASS = 2u;   // smooth dielectric interface, its inside against the normal

struct Material {
    uint kind;
    vec3 color; // albedo, reflectance, or factor at each refraction, within [0, 1]
    float ior;    // glass: index inside / index outside
    uint schlick; // glass: 1 for Schlick's reflectance in place of the exact one
};
BUFFER(Material)

const uint LIGHT_RECTANGLE = 0u; // a + x u + y v, x and y in [0, 1]; normal u x v
const uint LIGHT_TRIANGLE = 1u;  // a, a + u, a + v; normal u x v
const uint LIGHT_SPHERE = 2u;    // centre a, radius u.x; normal outward

/// A diffuse area light; it emits `radiance` on the side of its normal, or on both.
struct Light {
    vec3 a;
    vec3 u;
    vec3 v;
    vec3 radiance;
    uint kind;
    uint twoSided;
    float area;
    float share; // of all flux, over the probability by DeviceScene.lightCdf: nearly 1
};
BUFFER(Light)

/// A sphere at which photons are aimed: those of caustics at that about a specular shape, those of far lights at that about all
/// that light falls upon.
struct Target {
    vec3 center;
    float radius;
};
BUFFER(Target)

/// A pinhole camera; the ray of film position (x, y) in [0, 1]^2, y down, has the direction
/// forward + (2 x - 1) right + (1 - 2 y) up, where |right| and |up| are the tangents of the half angles.
struct Camera {
    vec3 origin;
    vec3 forward;
    vec3 right;
    vec3 up;
};

/// Addresses of the arrays of a scene; what a scene lacks has address 0.
struct DeviceScene {
    ADDRESS(Node) nodes;
    ADDRESS(Leaf) leaves;
    ADDRESS(Primitive) primitives;
    ADDRESS(Normals) normals;
    ADDRESS(Material) materials;
    ADDRESS(Light) lights;
    ADDRESS(float) lightCdf;  // of photons: upper ends, the last is 1
    ADDRESS(float) directCdf; // of light samples, likewise
    ADDRESS(Target) targets;
    ADDRESS(uint) missing; // a bit for each feature that a kernel needed and was without, if checksFeatures
    Target lit;  // about all that light falls upon
    Target near; // about all but far lights
    uint triangleCount;
    uint lightCount;
    uint targetCount;
    float unit; // of lengths, in world units: a power of two
    Camera camera;
};
BUFFER(DeviceScene)

// ---- The film -----------------------------------------------------------------------------------

const uint LAYER_EMISSION = 0u; // L E
const uint LAYER_DIRECT = 1u;   // L D E
const uint LAYER_SPECULAR = 2u; // all of the others seen through S+
const uint LAYER_CAUSTIC = 3u;  // L S+ D E
const uint LAYER_INDIRECT = 4u; // L (S|D)* D S* D E
const uint LAYER_COUNT = 5u;

// Samples and their sums are stored column by column: a float for each pixel, then those of the next column. What a render
// does without has no column. One pass gives a pixel its radiance by layer and what it knows of the first surface seen:
// albedo, shading normal, depth (distance along the camera's axis), covered (1 if there was a surface), and an estimate of the
// bias of beauty. Sums over a run of
// passes have the squared deviations of beauty between batches of passes as well, what rounding took from the sums of the layers,
// see pixel_sum.glsl, and the square of the luminance of the bias.
#define COLUMNS(X)                                                                                                     \
    X(COLUMN_EMISSION, 0u)                                                                                             \
    X(COLUMN_DIRECT, COLUMN_EMISSION + 3u * hasEmissionLayer)                                                          \
    X(COLUMN_SPECULAR, COLUMN_DIRECT + 3u * hasDirectLayer)                                                            \
    X(COLUMN_CAUSTIC, COLUMN_SPECULAR + 3u * hasSpecularLayer)                                                         \
    X(COLUMN_INDIRECT, COLUMN_CAUSTIC + 3u * hasCausticLayer)                                                          \
    X(COLUMN_ALBEDO, COLUMN_INDIRECT + 3u * hasIndirectLayer)                                                          \
    X(COLUMN_NORMAL, COLUMN_ALBEDO + 3u * hasAlbedo)                                                                   \
    X(COLUMN_DEPTH, COLUMN_NORMAL + 3u * hasNormal)                                                                    \
    X(COLUMN_COVERED, COLUMN_DEPTH + hasDepth)                                                                         \
    X(COLUMN_BIAS, COLUMN_COVERED + hasDepth)                                                                          \
    X(SAMPLE_COLUMNS, COLUMN_BIAS + 3u * hasBias)                                                                      \
    X(COLUMN_FINE, SAMPLE_COLUMNS)                                                                                     \
    X(COLUMN_COARSE, COLUMN_FINE + 3u * hasNoise)                                                                      \
    X(COLUMN_REST, COLUMN_COARSE + 3u * hasNoise)                                                                      \
    X(COLUMN_SQUARE, COLUMN_REST + 3u * hasNoise)                                                                      \
    X(SUM_COLUMNS, COLUMN_SQUARE + hasBias)

#ifdef __cplusplus
/// Where the columns begin, and how many there are.
struct Columns : Features {
#define X(name, value) uint name;
    COLUMNS(X)
#undef X
    explicit Columns(const Features& features = {}) : Features(features) {
#define X(name, value) name = value;
        COLUMNS(X)
#undef X
    }
};
#else
#define X(name, value) const uint name = value;
COLUMNS(X)
#undef X
#endif

/// Passes begin .. end - 1.
struct PassRange {
    uint begin;
    uint end;
};

// ---- Paths: photons from the lights, rays from the eye ------------------------------------------

// Sequences of sample points of a pixel.
const uint SAMPLES_EYE = 0u;    // a point for each pass: the place in the pixel and all that follows
const uint SAMPLES_GATHER = 1u; // one for each gather ray of each pass

const uint GROUP = 64u;            // invocations of a work group, of every kernel
const uint COMPACTION_BLOCK = 64u; // places of a list that an invocation compacts

/// What a dispatch reads on the device: how many groups, and which part of a list they work on.
struct Queue {
    uint groupsX; // the first three are VkDispatchIndirectCommand
    uint groupsY;
    uint groupsZ;
    uint first; // index into the list
    uint count;
    uint base; // elements that this queue has had in earlier rounds
};
BUFFER(Queue)

/// A ray under way, of a photon or from the eye.
struct Path {
    vec3 origin;
    vec3 direction;
    vec3 throughput; // photon: its colour, relative to the flux per photon; eye: weight of the radiance it finds
    float travelled; // since the last diffuse vertex
    uint from;       // primitive that the ray leaves, or NONE
    uint flags;      // PATH_..., and the number of diffuse vertices from bit PATH_DIFFUSE_SHIFT
};
const uint PATH_EYE_SPECULAR = 1u;                  // eye: the first vertex was specular
const uint PATH_SPECULAR = 2u;                      // one specular vertex since the last diffuse one
const uint PATH_SPECULARS = 63u * PATH_SPECULAR;    // all of these that are counted
const uint PATH_THROUGH = 1u << 7;                  // goes through a smooth mesh, see terminator.glsl
const uint PATH_DIFFUSE_SHIFT = 8u;
BUFFER(Path)

/// Where a ray ends: distance in units of its direction's length, primitive or NONE, barycentric weights of b and c.
struct Hit {
    float t;
    uint primitive;
    vec2 weights;
};
BUFFER(Hit)

/// A photon where it arrived at a diffuse surface.
struct Photon {
    vec3 position;
    vec3 color;  // relative to the flux per photon
    uint normal; // geometric, on the side of arrival, octahedral 2 x 16 bit
};
BUFFER(Photon)

/// A photon of a wave in the order in which it happened to arrive, and its place: the path's how-manieth.
struct Arrival {
    Photon photon;
    uint slot;
    uint index;
};
BUFFER(Arrival)

/// What the host reads after a step: counters.
struct Status {
    uint arrivals;  // photons for the map, whether there was room or not
    uint absorbed;  // photons
    uint escaped;   // photons that left the scene or missed what they were aimed at
    uint nonfinite[LAYER_COUNT + 1u]; // samples by layer, and photons
};
const uint NONFINITE_PHOTON = LAYER_COUNT;
BUFFER(Status)

// Bits of a path's flags after a step; bit k puts the path into queue k.
const uint QUEUE_CONTINUE = 0u;
const uint PHOTON_QUEUES = 1u;
const uint QUEUE_SHADOW = 1u; // eye
const uint QUEUE_CAUSTIC = 2u;
const uint QUEUE_GLOBAL = 3u;
const uint EYE_QUEUES = 4u;

// The numbers in [0, 1) that start a photon: light, side, two for the place on the light, two for the direction, target.
const uint START_NUMBERS = 7u;
const uint START_LIGHT = 0u;
const uint START_SIDE = 1u;
const uint START_PLACE = 2u;
const uint START_DIRECTION = 4u;
const uint START_TARGET = 6u;

/// A box of such numbers, cut in the middle of an axis into children `child` (lower numbers) and `child` + 1.
struct GuideNode {
    uint axis;   // NONE: a leaf
    float lower; // part of the photons of the box that the lower half gets
    uint child;
};
BUFFER(GuideNode)

/// How a photon was started, and how useful it was.
struct Start {
    float numbers[START_NUMBERS];
    float weight;  // of its flux, had the numbers been uniform
    float sparse;  // uniform density over that of the numbers
    uint stored;   // how often it was stored,
    uint seen;     // and how often where the eye looks,
    vec3 place;    // there first
};
BUFFER(Start)

struct EmitArgs {
    PTR(DeviceScene) scene;
    PTR(Path) paths;
    PTR(uint) list;
    PTR(uint) flags;
    PTR(uint) counts; // of arrivals, by path
    PTR(Status) status;
    ADDRESS(GuideNode) guide; // 0: the numbers are uniform
    ADDRESS(Start) starts;    // 0: nobody asks
    uint firstPhoton;
    uint count;
    uint pass;
    uint seed;
    uint caustic; // 1: aimed at the targets
};

struct TraceArgs {
    PTR(DeviceScene) scene;
    PTR(Path) paths;
    PTR(Hit) hits;
    PTR(Queue) queue;
    PTR(uint) list;
};

struct ScatterArgs {
    PTR(DeviceScene) scene;
    PTR(Path) paths;
    PTR(Hit) hits;
    PTR(Arrival) arrivals;
    PTR(uint) counts; // of arrivals, by path
    PTR(Queue) queue;
    PTR(uint) list;
    PTR(uint) flags; // by place in the list
    PTR(Status) status;
    uint capacity; // of arrivals
    uint firstPhoton;
    uint pass;
    uint seed;
    uint bounce;
    uint caustic;
};

struct TallyArgs {
    PTR(Queue) queue;
    PTR(uint) flags;
    PTR(uint) sums; // [kind][block]
    uint kinds;
};

struct ScanArgs {
    PTR(uint) values; // becomes its exclusive prefix sum, with the total behind it
    PTR(Queue) queue;
    uint kinds;
    uint blockSize; // values per kind: the queue's count over this, rounded up
};

struct CompactArgs {
    PTR(Queue) queues; // one per kind; the first is the one that is compacted
    PTR(uint) list;
    PTR(uint) flags;
    PTR(uint) sums;
    PTR(Queue) nextQueues;
    PTR(uint) nextList;
    uint kinds;
};

struct PlaceArgs {
    PTR(Arrival) arrivals;
    PTR(uint) offsets; // of the wave's paths
    PTR(Photon) photons;
    PTR(Status) status;
    uint first; // place of the wave's first photon
    uint count; // of arrivals
};

// ---- The photon grid ----------------------------------------------------------------------------

/// Photons in the order of their cells' keys, where each key starts, and how far to gather.
struct PhotonMap {
    ADDRESS(Photon) photons;
    ADDRESS(uint) cells;  // cellMask + 2 entries
    ADDRESS(float) field; // binary logarithms of radii in units of `radius`, or 1 where unknown
    float cellsPerUnit; // of the widest cells
    uint cellMask;
    uint levels;  // how often a cell is split into eight
    float radius; // the greatest
    float shrink; // gather within this part of the distance of the k-th nearest, or of a pixel at least
    float photonFlux; // W per photon emitted
    float fieldPerUnit; // 0 if the radius is the same everywhere
    uint partial;       // 1: of narrow discs alone; where the field is unknown, the next map answers
    uint kernel;    // KERNEL_...
    uint nearest;   // the radius is the distance of the k-th nearest; 0: not so
};

#ifdef __cplusplus
static_assert(sizeof(PhotonMap) == 3 * 8 + 10 * 4, "no padding, as GLSL has none");
#endif
const uint MOST_LEVELS = 4u;
const uint FIELD_CELLS = 1u << 16, NARROW_FIELD_CELLS = 1u << 22; // of a map, of one of narrow discs alone: hardly two share one
const float PILOT_UNIT = 1024.0; // a logarithm of 1 in the sums

/// A photon of a pilot, and the radius that it wants.
struct WantedRadius {
    vec3 position;
    float logarithm; // negative binary one, in units of the map's radius; more than its levels: narrower than it has cells for
};
BUFFER(WantedRadius)

struct PilotArgs {
    PhotonMap map;
    PTR(uint) sums; // by cell of the field: negative logarithms, photons; then photons whose discs cannot be as narrow as they should
    PTR(WantedRadius) wanted; // in a partial map, in place of sums
    uint count;
    uint stride; // one photon of so many is looked at
    float perDisc; // photons wanted
};

struct KeysArgs {
    PTR(Photon) photons;
    PTR(uint) keys;
    PTR(uint) values;
    uint count;
    float cellsPerUnit;
    uint levels;
    uint cellMask;
};

const uint SORT_BITS = 8u;
const uint SORT_BLOCK = 4096u; // elements that a group sorts

struct SortCountArgs {
    PTR(uint) keys;
    PTR(uint) sums; // [digit][block]
    uint count;
    uint shift;
};

struct SortScatterArgs {
    PTR(uint) keys;
    PTR(uint) values;
    PTR(uint) sortedKeys;
    PTR(uint) sortedValues;
    PTR(uint) sums;
    uint count;
    uint shift;
};

struct ArrangeArgs {
    PTR(Photon) photons;
    PTR(uint) order;
    PTR(Photon) arranged;
    uint count;
};

struct CellsArgs {
    PTR(uint) keys;
    PTR(uint) cells;
    PTR(uint) crowded; // becomes 1 if a cell has more photons than MOST_PER_CELL
    uint count;
    uint cellMask;
};

const uint MOST_PER_CELL = 1024u; // photons that a gather reads of a cell at most, see crowd.glsl

struct CrowdArgs {
    PTR(uint) keys;
    PTR(uint) cells;
    PTR(uint) stays; // 1 for those that do
    uint count;
    uint pass;
};

struct ThinArgs {
    PTR(Photon) photons;
    PTR(uint) order;
    PTR(uint) keys;
    PTR(uint) cells;
    PTR(uint) places; // prefix sums of CrowdArgs.stays
    PTR(Photon) arranged;
    PTR(uint) thinnedKeys;
    uint count;
    uint pass;
};

// ---- The camera pass ----------------------------------------------------------------------------

/// A light sample that counts if nothing stands between the two points.
struct ShadowRay {
    vec3 origin;
    uint from; // primitive that the ray leaves
    vec3 target;
    vec3 radiance;
    uint column; // of the samples, to which the radiance is added
    uint through; // 1: through a smooth mesh, see terminator.glsl
};
BUFFER(ShadowRay)

/// A point whose irradiance is estimated from a photon map; it adds weight times irradiance to the samples.
struct Query {
    vec3 position;
    vec3 normal; // geometric, on the side of the viewer
    vec3 weight;
    uint column; // of the samples; NONE: a map of narrow discs has answered
    float footprint; // radius that a pixel covers there
};
BUFFER(Query)

/// A diffuse point that the eye sees, directly or by way of specular surfaces, where light samples and gather rays start.
struct Split {
    vec3 origin;
    vec3 normal; // geometric, on the side of the viewer
    vec3 shading;
    vec3 throughput; // of all gather rays together, the albedo included
    uint from;       // primitive that the rays leave
    uint flags;      // as in Path; NONE: there is no such point
    float bulge;     // on the side of the normal, see terminator.glsl
};
BUFFER(Split)

struct EyeArgs {
    PTR(DeviceScene) scene;
    PTR(Path) paths;
    PTR(float) samples; // [column][stride]
    PTR(uint) list;
    PTR(Split) splits; // become none
    uint stride;
    uvec2 size;
    uint firstPixel;
    uint count;
    uint pass;
    uint seed;
    uint centered;  // 1: through the middle of the pixel
    uint splitting; // 1: there are splits
};

struct ShadeArgs {
    PTR(DeviceScene) scene;
    PTR(Path) paths;
    PTR(Hit) hits;
    PTR(float) samples; // [column][stride]
    PTR(ShadowRay) shadowRays;
    PTR(Query) queries;
    PTR(Split) splits;
    PTR(Queue) queue;
    PTR(uint) list;
    PTR(uint) flags;
    uint stride;
    uint firstPixel;
    uint sequence; // SAMPLES_...
    uint index;    // of the sample in its sequence
    uint seed;
    uint bounce;
    uint caustics; // ask the caustic map; photon-map integrator: it, and not the global one
    float nearDistance; // a gather ray shorter than this goes on
    float pixelAngle;   // width of a pixel over its distance
    uint integrator;    // INTEGRATOR_...
};

struct SplitArgs {
    PTR(DeviceScene) scene;
    PTR(Split) splits;
    PTR(Path) paths;
    PTR(ShadowRay) shadowRays;
    PTR(uint) list;
    PTR(uint) flags;
    uint firstPixel;
    uint count;
    uint index; // of the sample in its sequence
    uint seed;
    float share; // of a gather ray and of a light sample
};

struct ShadowArgs {
    PTR(DeviceScene) scene;
    PTR(ShadowRay) shadowRays;
    PTR(float) samples; // [column][stride]
    PTR(Queue) queue;
    PTR(uint) list;
    uint stride;
};

struct GatherArgs {
    PhotonMap map;
    PTR(Query) queries;
    PTR(float) samples; // [column][stride]
    PTR(Queue) queue;
    PTR(uint) list;
    uint stride;
};

/// How the deviations of two adjacent runs of passes make those of both, see pixel_sum.glsl.
struct JoinWeights {
    float perPass;      // 1 / passes of the first run, or 0 if it has none
    uint times;         // passes of the first over those of the second: a whole number
    float fine;
    float coarse;
    uint grows; // 1: the first run is a batch like the second, and both become one of the next size
};

struct FilmArgs {
    PTR(float) samples; // [column][stride], of a pass
    PTR(float) sums;    // [column][pixels], of a run of passes; becomes those of both
    PTR(Status) status;
    uint stride;
    uint pixels;
    uint firstPixel;
    uint count;
    JoinWeights weights;
};

struct JoinArgs {
    PTR(float) sums;  // [column][pixels]; becomes those of both
    PTR(float) other; // [column][pixels]
    uint pixels;
    JoinWeights weights;
};

// ---- Where the eye looks ------------------------------------------------------------------------

const uint MARK_WORDS = 1u << 18; // of a set of cells, see marks.glsl; one more has a bit for each level in use

struct MarkArgs {
    PhotonMap map;
    PTR(Query) queries;
    PTR(Queue) queue;
    PTR(uint) list;
    PTR(uint) marks;
    float cellWidth; // of the finest level
    float reach;     // part of a query's footprint that it marks, if that is more than the map's radius there
};

struct WeighArgs {
    PTR(DeviceScene) scene;
    PTR(Split) splits;
    PTR(float) values; // [split][light of it]: luminance that it brings
    uint count; // of values
    uint lightsEach; // lights that a split is asked about
    uint stride; // one split of so many is asked
    uint seed;
};

struct UsefulArgs {
    PTR(Photon) photons;
    PTR(uint) offsets; // of the paths' photons
    PTR(uint) marks;
    PTR(Start) starts;
    uint count; // of paths
    float cellWidth;
};

// ---- Light tracing ------------------------------------------------------------------------------

/// What a photon adds to the mean radiance of the pixel that sees it.
struct Splat {
    vec3 radiance;
};
BUFFER(Splat)

struct SplatArgs {
    PTR(DeviceScene) scene;
    PTR(Photon) photons;
    PTR(Splat) splats; // by photon
    PTR(uint) pixels;  // by photon; the number of pixels if none sees it
    PTR(uint) order;   // becomes that of the photons
    PTR(uint) rays;    // becomes the number of photons that are before the film, on top of what it was
    uvec2 size;
    uint count;
    float photonFlux; // W per photon emitted
};

struct CollectArgs {
    PTR(Splat) splats;
    PTR(uint) pixels;   // sorted
    PTR(uint) order;    // of splats, by pixel
    PTR(float) samples; // [column][stride]
    uint splatCount;
    uint stride;
    uint firstPixel;
    uint count;
};

// ---- The driver audit ---------------------------------------------------------------------------

const uint AUDIT_LOOP = 0u;
const uint AUDIT_DIVERGENT = 1u;
const uint AUDIT_SHARED = 2u;
const uint AUDIT_WIDE = 3u;
const uint AUDIT_FLOAT = 4u;

struct AuditArgs {
    PTR(uint) results;
    uint count;
    uint test; // AUDIT_...
    uint trips;
};

#ifdef __cplusplus
} // namespace vkpm
#endif
