// The camera pass.
#ifndef SHARED_CAMERA_H
#define SHARED_CAMERA_H
#include "shared.h"
#include "shared_photons.h"

SHARED_BEGIN

/// A light sample that counts if nothing stands between the two points.
struct ShadowRay {
    vec3 origin;
    uint from; // primitive that the ray leaves
    vec3 target;
    vec3 radiance;
    uint column; // of the samples, to which the radiance is added
    uint flags;  // SHADOW_...
};
const uint SHADOW_THROUGH = 1u; // through a smooth mesh, see terminator.glsl
const uint SHADOW_ENDLESS = 2u; // the target is a direction
BUFFER(ShadowRay)

/// A point whose irradiance is estimated from a photon map; it adds weight times irradiance to the samples.
struct Query {
    vec3 position;
    vec3 normal; // geometric, on the side of the viewer
    vec3 weight;
    uint column;     // of the samples; NONE: a map of narrow discs has answered
    float footprint; // radius that a pixel covers there
    uint primitive;  // that it is on
    uint lobes;      // that ask, BY_...
    uint viewer;     // direction to it, octahedral 2 x 16 bit, if a wide one does
};
const uint BY_DIFFUSE = 1u; // alone its albedo / pi is in the weight
const uint BY_WIDE = 2u;
const uint BY_GLASS = 4u, BY_INSIDE = 8u; // beside it, of rough glass: light comes from either side; seen from inside
BUFFER(Query)

/// A diffuse point that the eye sees, directly or by way of specular surfaces, where light samples and gather rays
/// start.
struct Split {
    vec3 origin;
    vec3 normal; // geometric, on the side of the viewer
    vec3 shading;
    vec3 throughput; // of what all light samples bring together, the albedo included
    uint from;       // primitive that the rays leave
    uint flags;      // as in Path; NONE: there is no such point
    float bulge;     // on the side of the normal, see terminator.glsl
    float footprint; // width of a pixel there
    uint media;      // as in Path
};
BUFFER(Split)

const uint MAX_LANES = 8u;

/// Paths of the pixels of a batch that are under way at the same time, those of a pixel in lanes of their own: slot
/// lane * pixels + i is the i-th pixel's.
struct LanePaths {
    uint firstPixel;
    uint pixels;
    uint pass;
    uint first; // path of the pixel that the first lane has; of gather rays, among those of the pixel and pass
    uint each;  // paths, or gather rays, of a pixel in a pass
    uint seed;
};

struct EyeArgs {
    PTR(DeviceScene) scene;
    PTR(Path) paths;
    PTR(float) samples; // [column][stride]
    PTR(uint) list;
    PTR(Split) splits; // become none
    LanePaths of;
    uint stride;
    uint count; // of slots
    uvec2 size;
    uint centered;  // 1: through the middle of the pixel
    uint splitting; // 1: there are splits
};

const uint SHADE_GATHER_RAYS = 1u; // in place of paths from the eye
const uint SHADE_CAUSTICS = 2u;    // ask the caustic map; photon-map integrator: it, and not the global one

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
    LanePaths of;
    uint stride;
    uint mode; // SHADE_...
    uint bounce;
    float nearDistance; // a gather ray shorter than this goes on
    float pixelAngle;   // width of a pixel over its distance
    uint integrator;    // INTEGRATOR_...
};

// What is sent from splits: a light sample and a gather ray, or, from those of further paths of a pixel, a light sample
// and then, if lights are endlessly far, a shadow ray by the cosine law.
const uint SPLIT_GATHERS = 0u;
const uint SPLIT_LIGHT = 1u;
const uint SPLIT_BEYOND = 2u;

struct SplitArgs {
    PTR(DeviceScene) scene;
    PTR(Split) splits;
    PTR(Path) paths;
    PTR(ShadowRay) shadowRays;
    PTR(uint) list;
    PTR(uint) flags;
    LanePaths of;
    uint firstSlot; // lanes before have nothing to send
    uint count;     // of slots
    uint sends;     // SPLIT_...
};

struct ShadowArgs {
    PTR(DeviceScene) scene;
    PTR(ShadowRay) shadowRays;
    PTR(float) samples; // [column][stride]
    PTR(Queue) queue;
    PTR(uint) list;
    uint stride;
};

struct SumLanesArgs {
    PTR(float) samples; // [column][stride]; the first lane gets the sum of all
    uint stride;
    uint pixels;
    uint lanes;
    uint firstColumn;
    uint endColumn;
};

const uint SHARING_BAND = 32u; // rows of pixels that share what their gather rays bring

struct ShareGathersArgs {
    PTR(DeviceScene) scene;
    PTR(Split) splits;
    PTR(float) samples; // [column][stride]
    uint stride;
    uint count; // of pixels: whole rows, in whole bands
    uint firstRow;
    uint width;     // of the picture
    uint bandShift; // rows of the first band that lie above the picture
    uint pass;
    float radius;
    float weight; // of what is gathered: paths of a pixel, of which one sends gather rays
};

struct GatherArgs {
    PhotonMap map;
    PTR(Query) queries;
    PTR(float) samples; // [column][stride]
    PTR(Queue) queue;
    PTR(uint) list;
    ADDRESS(DeviceScene) scene; // 0: discs count in full, wherever their parts lie
    uint stride;
};

SHARED_END
#endif
