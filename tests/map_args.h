// What the shader tests' kernels read: the arguments of a map, and its elements where a vector is not enough.
//
// Read by C++ and GLSL like shared_*.h.
#ifndef MAP_ARGS_H
#define MAP_ARGS_H
#include "shared_paths.h"
#include "shared_photons.h"
#include "shared_scene.h"

SHARED_BEGIN

struct MapArgs {
    ADDRESS(uint) xs; // their types are the kernel's
    ADDRESS(uint) ys;
    PTR(DeviceScene) scene;
    PhotonMap photons;
    uint count;
};

struct VectorPair {
    vec3 a;
    vec3 b;
};

/// A ray that leaves a primitive.
struct StartCase {
    vec3 origin;
    vec3 direction;
    uint from;
};

struct BoxCase {
    vec3 origin;
    vec3 direction;
    vec3 low;
    vec3 high;
};

struct TriangleCase {
    vec3 origin;
    vec3 direction;
    vec3 a;
    vec3 b;
    vec3 c;
};

struct SphereCase {
    vec3 origin;
    vec3 direction;
    vec3 center;
    float radius;
    vec3 pole;
};

struct OffsetCase {
    vec3 position;
    vec3 magnitude;
    vec3 normal;
};

/// A place on a primitive, and a direction in which to leave it.
struct LeavingCase {
    Primitive primitive;
    vec2 weights; // triangle
    vec3 along;   // sphere: a point near its surface
    vec3 direction;
};

struct Leaving {
    vec3 origin;
    vec3 normal;
    float t; // at which the ray hits the primitive again
};

struct SurfaceCase {
    Path path;
    Hit hit;
};

struct SurfaceValues {
    vec3 position;
    vec3 magnitude;
    vec3 normal;
    vec3 shading;
    uint material;
    uint light;
};

struct TextureCase {
    uint texture;
    vec2 coordinates;
};

struct ScatterCase {
    Material material;
    vec3 normal;
    vec3 shading;
    vec3 direction;
    float u;
};

struct ScatterValues {
    vec3 direction;
    vec3 weight;
    vec3 normal;
    float radianceScale;
};

struct GlossyCase {
    Material material;
    vec3 wo;
    vec3 wi;
    vec2 u;
    float choice;
};

struct GlossyValues {
    vec3 direction;
    vec3 weight;
    float pdf;
    vec3 value; // times the cosine of wi
    float pdfAt;
};

struct CorrectionCase {
    vec3 wi;
    vec3 wo;
    vec3 normal;
    vec3 geometric;
};

struct LightValues {
    vec3 position;
    vec3 magnitude;
    vec3 normal;
};

struct LightSampleValues {
    vec3 position;
    vec3 magnitude;
    vec3 normal;
    float inversePdf;
};

struct EmittedCase {
    Light light;
    vec3 normal;
    vec3 direction;
};

struct AimCase {
    vec3 position;
    vec3 normal;
    vec2 u;
    float choice;
};

struct GuideStartArgs {
    PTR(PrimarySample) starts;
    ADDRESS(GuideNode) guide;
    uint count;
};

struct IsMarkedArgs {
    PTR(Photon) photons; // places
    PTR(uint) marks;
    PTR(uint) marked; // 1 if so
    uint count;
    float cellWidth;
};

struct CameraCase {
    Camera camera;
    vec2 film;
};

SHARED_END
#endif
